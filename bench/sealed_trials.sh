#!/usr/bin/env bash
# Sealed trials from end to end: made, diagnosed two at a time, scored. What was interrupted goes on.
#   bench/sealed_trials.sh build/release/cli/tumble FOLDER COUNT KINDS [options of `tumble trials make`]
# FOLDER gets trials, trials-keys, verdicts and score.txt; the library of signatures is kept beside FOLDER, for other
# FOLDERs with the same mill and conditions.
set -euo pipefail
tumble=$(realpath "${1:?give the program}")
folder=${2:?give a folder} count=${3:?give the number of trials} kinds=${4:?give what may hide}
shift 4
library=$(dirname "$folder")/library
mkdir -p "$folder/verdicts"

resume=()
[[ -d $folder/trials-keys ]] && resume=(--resume)
"$tumble" trials make -o "$folder/trials" --n "$count" --kind "$kinds" "${resume[@]}" "$@"

verdict() {  # OPTIONS...: on trial $number
  [[ -f $folder/verdicts/$number/verdict.json ]] || "$tumble" diagnose "$folder/trials/$number/mill.toml" \
    --measured "$folder/trials/$number/experiments.toml" -o "$folder/verdicts/$number" --library "$library" --force "$@" \
    2>"$folder/verdicts/$number.log" || echo "trial $number: no verdict, see $folder/verdicts/$number.log" >&2
}
number=0001 verdict  # fills the library with all cores
one_core() { number=$1 verdict --threads 1 --quiet; }
export tumble folder library
export -f verdict one_core
seq -f %04g 2 "$count" | xargs -P "$(nproc)" -I{} bash -c 'one_core {}'

"$tumble" trials score "$folder/trials" "$folder/trials-keys" "$folder/verdicts" | tee "$folder/score.txt"
