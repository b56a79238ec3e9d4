#!/usr/bin/env bash
# Races whole programs over the same mill from the same states, on one core: tumble as a user has it, with run file and
# all (race_mill.cpp), beside LIGGGHTS and YADE where they are installed. Alternating pairs; each measurement is the
# difference in user-CPU seconds of a short and a long run, so that start-up cancels. Prints medians over the pairs with
# their range. The machine's speed drifts: the ratio within a pair is what counts.
#   bench/race.sh [--size 148,1500,15000] [--pairs 5] [--peers liggghts,yade] [--ratio 0.7] [--friction 0.1]
#                 [--time-step 1e-4] [--state FILE]     FILE: a state in the peers' format; instead of --size
# Sizes that the peers have no state of are made first; 150000 takes seven minutes. Environment: TUMBLE_PEERS (default
# ../shared/peers), RACE_MILL (build/release/bench/race_mill), RACE_STATES (build/race).
set -euo pipefail
cd "$(dirname "$0")/.."
sizes=148,1500,15000 pairs=5 rivals=liggghts,yade ratio=0.7 friction=0.1 dt=1e-4 state=
while (($#)); do
  case $1 in
    --size) sizes=$2 ;;
    --pairs) pairs=$2 ;;
    --peers) rivals=$2 ;;
    --ratio) ratio=$2 ;;
    --friction) friction=$2 ;;
    --time-step) dt=$2 ;;
    --state) state=$(realpath "$2") ;;
    *) echo "unknown option $1; see the head of $0" >&2; exit 2 ;;
  esac
  shift 2
done
source bench/race_common.sh

run() {  # PROGRAM CASE STEPS
  if [[ $1 == tumble ]]; then
    "$race_mill" "$2" "$3" "$dt" "$ratio" "$friction" 1
  else
    "$peers/$1/run.sh" "$2" "$3" "$dt" "$ratio" "$friction" 1
  fi
}

user_seconds() {  # PROGRAM CASE STEPS; the program's own words are kept for when it fails
  local TIMEFORMAT=%U
  { time run "$@" >"$work/$1.log" 2>&1; } 2>&1
}

speed() {  # PROGRAM CASE BALLS STEPS -> million ball-steps per user-CPU second
  local short long
  short=$(user_seconds "$1" "$2" "$frame") && long=$(user_seconds "$1" "$2" $((frame + $4))) &&
    awk -v s="$short" -v l="$long" -v n="$3" -v k="$4" 'BEGIN { print n * k / 1e6 / (l - s > 1e-3 ? l - s : 1e-3) }'
}

frame=$(awk -v dt="$dt" 'BEGIN { print int(0.005 / dt + 0.5) }')  # steps between frames; lengths are whole frames
printf '%8s %-9s %-26s %-26s %s\n' balls peer 'tumble, M/user-s' 'peer, M/user-s' 'ratio of a pair'
[[ -z $state ]] || sizes=$( (zcat -f "$state" || true) | awk '$2 == "N" { print $3; exit }')
for balls in ${sizes//,/ }; do
  folder=$(case_of "$balls" "$state")
  # 7 million ball-steps take the peers some 3 to 7 s; tumble gets eight times as many.
  frames=$(awk -v n="$balls" -v f="$frame" 'BEGIN { k = int(7e6 / n / f); print (k > 1 ? k : 1) }')
  for peer in ${rivals//,/ }; do
    if ! command -v "$peer" >/dev/null; then
      printf '%8s %-9s is not installed; see %s\n' "$balls" "$peer" "$peers/$peer/run.sh"
      continue
    fi
    : >"$work/pairs"
    for _ in $(seq "$pairs"); do
      if ! ours=$(speed tumble "$folder" "$balls" $((8 * frames * frame))) ||
        ! theirs=$(speed "$peer" "$folder" "$balls" $((frames * frame))); then
        printf '%8s %-9s failed:\n' "$balls" "$peer"
        tail -n 3 "$work/tumble.log" "$work/$peer.log"
        continue 2
      fi
      echo "$ours $theirs" >>"$work/pairs"
    done
    printf '%8s %-9s %-26s %-26s %s\n' "$balls" "$peer" "$(awk '{ print $1 }' "$work/pairs" | median)" \
      "$(awk '{ print $2 }' "$work/pairs" | median)" "$(awk '{ print $1 / $2 }' "$work/pairs" | median)"
  done
done
