#!/usr/bin/env bash
# Frames of film per second of CPU on one core, all included: start, decoding, camera, balls, paths, statistics, files.
# The film, 300 frames, is made in DIR first unless it is there; then it is analysed. Prints each repetition and the median.
#   bench/analyse_speed.sh [DIR] [REPETITIONS]
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
dir=${1:-$work}
[[ -f $dir/film.given.toml ]] ||
  ${MAKE_FILMS:-build/release/bench/make_films} film --seed 2 --level 1 --seconds 3 --fps 100 --out "$dir/film.mp4" >"$work/log"
for _ in $(seq "${2:-3}"); do
  TIMEFORMAT='%U %S'
  { time ${TUMBLE:-build/release/cli/tumble} analyse "$dir/film.mp4" --mill "$dir/film.given.toml" --recorded-fps 100 \
      -o "$work/motion.h5" --csv "$work/csv" --force --quiet --threads 1; } 2>"$work/time"
  frames=$(awk -F'[:,]' '/"frames"/ { print $2 + 0; exit }' "$work/csv/summary.json")
  awk -v n="$frames" '{ t = $1 + $2 } END { printf "%.1f frames per CPU second, %.1f ms a frame, %d frames\n", n / t, 1000 * t / n, n }' "$work/time"
done | tee "$work/all"
sort -n "$work/all" | awk '{ v[NR] = $1 } END { print "median", v[int((NR + 1) / 2)], "frames per CPU second" }'
