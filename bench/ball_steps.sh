#!/usr/bin/env bash
# Million ball-steps per second of CPU on one core, with everything recorded: from the difference of two lengths of the
# same run, so that start-up, packing and spin-up cancel. Prints each repetition and the median.
#   bench/ball_steps.sh [MILL.toml] [REPETITIONS]
set -euo pipefail
cd "$(dirname "$0")/.."
mill=${1:-examples/lab_mill_55cm.toml}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

run() {  # REVOLUTIONS -> user seconds, balls, steps
  local TIMEFORMAT=%U
  { time ${TUMBLE:-build/release/cli/tumble} simulate "$mill" -o "$work/run.h5" --force --quiet --json --threads 1 \
      --set run.spin_up=0.1 --set run.revolutions="$1" >"$work/json"; } 2>"$work/time"
  awk -v seconds="$(tail -n 1 "$work/time")" '
    /"balls"/ { balls = $2 + 0 } /"time_step_s"/ { dt = $2 + 0 } /"speed_rpm"/ { rpm = $2 + 0 }
    END { print seconds, balls, '"$1"' * 60 / rpm / dt }' "$work/json"
}
for _ in $(seq "${2:-5}"); do
  echo "$(run 1) $(run 9)"
done | awk '{ print ($6 - $3) * $2 / ($4 - $1) / 1e6 }' | tee "$work/all"
sort -n "$work/all" | awk '{ v[NR] = $1 } END { print "median", v[int((NR + 1) / 2)], "million ball-steps per CPU second" }'
