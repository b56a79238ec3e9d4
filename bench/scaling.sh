#!/usr/bin/env bash
# What things cost and how runs scale, on the peers' mill (race_mill.cpp) as a user has it: medians of ratios within
# alternating pairs, with their range.
#   bench/scaling.sh [--pairs 5] [threads] [together] [effects] [frames] [startup] [memory]      all of them by default
#   threads   one thread against two at 15000 balls, wall time
#   together  runs done by two processes at a time against one by one, 15000 balls, wall time
#   effects   each effect alone with its typical values against none, 148 balls, user-CPU time per ball-step
#   frames    200 frames a second in a run file against none at all, user and system time
#   startup   tumble simulate with 112 balls: reading, packing, one frame; wall time
#   memory    the most memory of a process, per ball, at 1000000 balls that have just begun to fall, and at 150000
# Environment: that of race.sh, and TUMBLE (build/release/cli/tumble).
set -euo pipefail
cd "$(dirname "$0")/.."
pairs=5
if [[ ${1:-} == --pairs ]]; then
  pairs=$2
  shift 2
fi
tumble=${TUMBLE:-build/release/cli/tumble}
source bench/race_common.sh

mill() { "$race_mill" "$1" "$2" 1e-4 0.7 0.1 "${@:3}"; }              # CASE STEPS [THREADS] [OPTIONS]
value() { awk -v key="$1" '{ for (k = 1; k < NF; ++k) if ($k == key) print $(k + 1) }'; }  # KEY, of what mill prints
cpu() { awk '{ for (k = 1; k < NF; ++k) if ($k ~ /^(user|system)_s$/) t += $(k + 1) } END { print t }'; }
over() { awk -v a="$1" -v b="$2" 'BEGIN { if (a > 0 && b > 0) print a / b }'; }  # nothing, of a run that failed

threads() {
  local folder
  folder=$(case_of 15000)
  for _ in $(seq "$pairs"); do
    over "$(mill "$folder" 2000 1 | value wall_s)" "$(mill "$folder" 2000 2 | value wall_s)"
  done >"$work/ratios"
  echo "two threads, 15000 balls: $(median <"$work/ratios") times one thread"
}

together() {
  local folder alone
  folder=$(case_of 15000)
  for _ in $(seq "$pairs"); do
    alone=$(mill "$folder" 2000 1 | value wall_s)
    mill "$folder" 2000 1 >"$work/first" &
    mill "$folder" 2000 1 >"$work/second"
    wait
    cat "$work/first" "$work/second" | value wall_s | sort -g | tail -n 1 | awk -v one="$alone" 'one > 0 { print 2 * one / $1 }'
  done >"$work/ratios"
  echo "two runs at a time, 15000 balls: $(median <"$work/ratios") times one"
}

effects() {
  local folder effect
  folder=$(case_of 148)
  for effect in $("$tumble" effects --json | sed -n 's/^ \{6\}"name": "\(.*\)",$/\1/p'); do
    # A shorter step where an effect asks for it.
    local dt=1e-4
    "$race_mill" "$folder" 50 $dt 0.7 0.1 --effect "$effect" >"$work/log" 2>&1 || dt=5e-5
    for _ in $(seq "$pairs"); do
      over "$("$race_mill" "$folder" 100000 $dt 0.7 0.1 --effect "$effect" | value user_s)" \
        "$("$race_mill" "$folder" 100000 $dt 0.7 0.1 | value user_s)"
    done >"$work/ratios"
    printf '%-20s %s times none (dt %s s)\n' "$effect" "$(median <"$work/ratios")" $dt
  done
}

frames() {
  local balls folder steps
  for balls in 148 1500 15000; do
    folder=$(case_of $balls)
    steps=$((15000000 / balls / 50 * 50))
    for _ in $(seq "$pairs"); do
      over "$(mill "$folder" $steps | cpu)" "$(mill "$folder" $steps 1 --frames none | cpu)"
    done >"$work/ratios"
    echo "frames at 200/s, $balls balls: $(median <"$work/ratios") times none"
  done
}

startup() {
  local TIMEFORMAT=%R
  for _ in $(seq "$pairs"); do
    { time "$tumble" simulate examples/lab_mill_55cm.toml -o "$work/run.h5" --force --quiet --threads 1 \
      --set charge.count=112 --set run.spin_up=0 --set run.revolutions=0.001; } 2>&1
  done >"$work/seconds"
  echo "start-up and packing of 112 balls: $(median <"$work/seconds") s"
}

memory() {
  local peak
  gen lattice 1000000 "$work/lattice"
  gen export "$work/lattice/lattice.csv" "$work/lattice"
  peak=$(mill "$work/lattice" 200 1 --kernels best | value peak_bytes)
  echo "memory, 1000000 balls, the mill alone: $((peak / 1000000)) bytes a ball"
  peak=$(mill "$work/lattice" 200 | value peak_bytes)
  echo "memory, 1000000 balls, with checkpoint and run file: $((peak / 1000000)) bytes a ball"
  rm -r "$work/lattice"
  peak=$(mill "$(case_of 150000)" 500 1 --kernels best | value peak_bytes)
  echo "memory, 150000 balls, the mill alone: $((peak / 150000)) bytes a ball"
  peak=$(mill "$(case_of 150000)" 500 | value peak_bytes)
  echo "memory, 150000 balls, with checkpoint and run file: $((peak / 150000)) bytes a ball"
}

if (($# == 0)); then set -- threads together effects frames startup memory; fi
for part; do
  case $part in
    threads | together | effects | frames | startup | memory) $part ;;
    *) echo "unknown part $part; see the head of $0" >&2; exit 2 ;;
  esac
done
