#!/usr/bin/env bash
# What --engine slurm promises, on a whole Slurm of the test's own: whatever dies on the way (a task, the command, the
# controller), a sweep ends with the bytes of one on this machine's cores, and so does a diagnosis' library; Ctrl-C leaves
# nothing in Slurm's queue; what goes wrong is said in one line.
#   tests/cli/slurm.sh TUMBLE_BINARY SOURCE_FOLDER
if ! PATH=$PATH:/usr/sbin command -v sbatch slurmctld slurmd munged >/dev/null; then
  echo "skipped: Slurm is not installed (apt-get install slurmctld slurmd munge slurm-client)"
  exit 77
fi
source "$(dirname "$0")/promises.sh"
source "$source/tests/cli/one_machine_slurm.sh"
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }
wait_until() {  # SECONDS COMMAND...
  for _ in $(seq $((10 * $1))); do
    "${@:2}" && return
    sleep 0.1
  done
  fail "not within $1 s: ${*:2}; $(tail -qn 1 err.txt "$cluster"/*.log 2>/dev/null)"
  return 1
}
jobs_there() { [ -n "$(squeue --noheader)" ]; }
none_there() { ! jobs_there; }
stopped_with() {  # STATUS PATTERN COMMAND...
  "${@:3}" >out.txt 2>err.txt
  local got=$?
  [ $got -eq "$1" ] && [ "$(wc -l <err.txt)" -eq 1 ] && grep -q -- "$2" err.txt ||
    fail "${*:3} : expected one line with \"$2\" and status $1, got $got: $(head -c 600 err.txt)"
}

start_slurm "$work/cluster" || { fail "Slurm"; exit 1; }
trap 'stop_slurm; rm -rf "$work"' EXIT
folder="it's 100% \$(touch owned) a;b"  # no shell and no pattern of Slurm's may see a name
mkdir "$folder"
cat >"$folder/mill.toml" <<'CONF'
[mill]
diameter = 0.2
speed = 0.7
[mill.lifters]
count = 6
profile = "rectangle"
height = 0.01
width = 0.01
[charge]
count = 12
balls = [ { radius = 0.012, mass = 0.056, share = 1 } ]
[contact]
normal_stiffness = 8000
tangential_stiffness = 6000
friction = 0.2
restitution = 0.7
[run]
spin_up = 1
revolutions = 4
frames_per_second = 100
seed = 2
CONF

# 500 runs, through everything.
sweep=(sweep "$folder/mill.toml" --vary mill.speed=0.5:0.9:0.1 --vary contact.friction=0.1:0.3:0.05 --repeat 20 --quiet
  --set run.spin_up=0.5 --set run.revolutions=5)
"$tumble" "${sweep[@]}" -o local.h5 --csv local.csv || fail "the local sweep"
[ "$(wc -l <local.csv)" -eq 501 ] || fail "not 500 runs"
by_slurm=("${sweep[@]}" --engine slurm --resume -o "$folder/s.h5" --csv "$folder/s.csv")
start() {
  "$tumble" "${by_slurm[@]}" 2>err.txt &
  command_pid=$!
}
finished() { cat "$folder"/s.h5.slurm/*.task-* 2>/dev/null | grep -c '"run"'; }
more_than() { [ "$(finished)" -gt "$1" ]; }

start
wait_until 300 more_than 10
kill -INT $command_pid
wait $command_pid
[ $? -eq 1 ] && grep -q 'finished runs are kept; go on with' err.txt || fail "Ctrl-C: $(cat err.txt)"
wait_until 20 none_there
kept=$(finished)
start
wait_until 300 more_than $((kept + 20))
kill -9 $command_pid
wait $command_pid 2>/dev/null
jobs_there || fail "the jobs of a start that was killed are gone"
jobs=$(squeue --noheader -o %F | sort -u)
start
sleep 3
[ "$(squeue --noheader -o %F | sort -u)" = "$jobs" ] || fail "jobs that were there are submitted again: $(squeue)"
kill_worker() { kill -9 "$(pgrep -f "^$tumble task $PWD/.*s.h5.slurm/[0-9]*.json" | tail -n 1)" 2>/dev/null; }
wait_until 300 kill_worker
wait_until 300 more_than $((kept + 60))
stop_controller
sleep 2
start_controller
wait $command_pid || fail "the sweep by Slurm: $(cat err.txt)"
same local.h5 "$folder/s.h5"
same local.csv "$folder/s.csv"
same local.html "$folder/s.html"
[ "$(ls "$folder" | tr '\n' ' ')" = 'mill.toml s.csv s.h5 s.html ' ] || fail "left behind: $(ls "$folder")"
wait_until 20 none_there
[ ! -e owned ] && [ ! -e "$folder/owned" ] || fail "a shell has seen a folder's name"

# Tasks that cannot do their work: three rounds, then an end.
mkdir broken
cp "$tumble" broken/submit
printf '#!/bin/sh\necho "no licence for this node" >&2\nexit 3\n' >broken/tumble
chmod +x broken/tumble
few=(sweep "$folder/mill.toml" --vary mill.speed=0.6,0.7,0.8 --set run.revolutions=1 --quiet --engine slurm -o few.h5)
stopped_with 1 '3 of 3 pieces of work have no result, and 3 rounds .* no licence for this node' broken/submit "${few[@]}"
wait_until 20 none_there
SBATCH_PARTITION=nowhere stopped_with 1 'nvalid partition' "$tumble" "${few[@]}"
stopped_with 1 'squeue cannot be run .*install Slurm' env PATH=/nowhere "$tumble" "${few[@]}"
[ ! -e few.h5 ] || fail "a sweep without results left its file"

# A library of signatures: the same files.
"$tumble" simulate "$folder/mill.toml" -o run.h5 --quiet || fail "a run to be measured"
"$tumble" analyse run.h5 -o motion.h5 --csv csv --quiet || fail "its motion"
printf '[[experiment]]\nname = "E"\nmotion = "motion.h5"\n[uncertain]\n"contact.friction" = 0.03\n' >experiments.toml
diagnosis() { exec "$tumble" diagnose "$folder/mill.toml" --measured experiments.toml --blocks 2 --seeds 4 --quiet "$@" 2>err.txt; }
diagnosis --engine slurm --library "$folder/lib" -o "$folder/by slurm" &
command_pid=$!
made() { find "$1" -name '*.h5' 2>/dev/null | wc -l; }
wait_until 300 test -d "$folder/by slurm/slurm"
library_there() { [ ! -d "$folder/by slurm/slurm" ]; }
wait_until 600 library_there
kill -INT $command_pid  # what comes now does not hang on the engine
wait $command_pid
wait_until 20 none_there
chunks=$(made "$folder/lib")
[ "$chunks" -gt 10 ] || fail "a library of $chunks files"
diagnosis --library lib -o local &
command_pid=$!
library_there() { [ "$(made lib)" -ge "$chunks" ]; }
wait_until 600 library_there
kill -INT $command_pid
wait $command_pid
diff -r lib "$folder/lib" >/dev/null || fail "the libraries differ: $(diff -rq lib "$folder/lib")"

stop_controller
stopped_with 1 'Slurm says "slurm_load_jobs error: Unable to contact' "$tumble" "${few[@]}"

[ "$failures" -eq 0 ] && echo "Slurm's sweep and library are this machine's"
[ "$failures" -eq 0 ]
