#!/usr/bin/env bash
# What a task of a job array costs, beside the simulations in it: 200 tasks of one run of no length, on a Slurm of the
# script's own on this machine. Processor time is that of slurmd, slurmstepd, slurmctld and the task itself.
#   bench/slurm_task.sh TUMBLE_BINARY [TASKS]
set -euo pipefail
tumble=$(realpath "$1")
tasks=${2:-200}
here=$(realpath "$(dirname "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source "$here/../tests/cli/one_machine_slurm.sh"
cd "$work"
start_slurm "$work/cluster"
trap 'stop_slurm; rm -rf "$work"' EXIT

processor_s() {  # of the processes and of their children that have ended
  cat /proc/"$slurmctld_pid"/stat /proc/"$slurmd_pid"/stat | awk -v hz="$(getconf CLK_TCK)" '{ s += $14 + $15 + $16 + $17 } END { print s / hz }'
}
measure() {  # NAME COMMAND...
  local before after start
  before=$(processor_s)
  start=$(date +%s.%N)
  sbatch --quiet --array=0-$((tasks - 1)) --output=log --open-mode=append "$work/task.sh" "${@:2}"
  while [ -n "$(squeue --noheader)" ]; do sleep 0.5; done
  after=$(processor_s)
  awk -v n="$tasks" -v b="$before" -v a="$after" -v s="$start" -v e="$(date +%s.%N)" -v cores="$(nproc)" -v what="$1" \
    'BEGIN { printf "%s: %.3f s of processor, %.2f s of a core reserved, a task\n", what, (a - b) / n, (e - s) * cores / n }'
}
printf '#!/bin/sh\nexec "$@" "$SLURM_ARRAY_TASK_ID"\n' >task.sh
measure "an empty task" /bin/true
# The manifest that a sweep of a million runs would hand to its thousand tasks, with nothing to simulate.
printf '{"tumble":"%s","kind":"sweep","plan":{"mill":"[mill]\\ndiameter = 0.5\\n","varied":[],"first_seed":1,"repeats":1000000},"per_task":0,"pieces":[%s]}' \
  "$("$tumble" --version | cut -d' ' -f2)" "$(seq -s, 0 999999)" >1.json
measure "a task of tumble that reads a million numbers" "$tumble" task "$work/1.json"
cat log
