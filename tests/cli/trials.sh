#!/usr/bin/env bash
# What blind trials promise: seals that anybody can check, data in which nothing but the numbers differs from kind to
# kind, the same bytes for any number of threads and after an interruption, tampering that is noticed, and a score.
#   tests/cli/trials.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
cat >mill.toml <<'EOF'
[mill]
diameter = 0.3
speed = 0.6
[mill.lifters]
count = 8
profile = "rectangle"
height = 0.01
width = 0.012
[charge]
count = 40
balls = [ { radius = 0.012, mass = 0.056, share = 1.0 } ]
[contact]
normal_stiffness = 3e4
tangential_stiffness = 2e4
[contact.wall]
restitution = 0.5
[run]
spin_up = 0.7
EOF
make=(trials make --mill mill.toml --speeds 0.6 --hold-out-speeds none --hold-out-fillings 0.3 --revolutions 0.5)
kinds=single,none,pair,unknown,turn_locked,artefact

# By chance: seals, names, and that nothing tells the kinds apart.
done_by "${make[@]}" -o blind --n 12 --kind $kinds
(cd blind-keys && sha256sum --check --quiet ../blind/seals.txt >/dev/null) || fail "sha256sum does not accept the seals"
[ "$(ls blind | tr '\n' ' ')" = "$(printf '%04d ' {1..12})seals.txt " ] || fail "the folder: $(ls blind)"
[ "$(cat blind-keys/*.json | grep -c '"kind"')" -eq 12 ] || fail "the keys: $(ls blind-keys)"
looks() {  # of one trial, all that is no number of the data
  (cd "blind/$1" || exit
    stat -c '%n %Y %a' . * && cat mill.toml && wc -l <experiment_1_torque.csv && head -qn1 ./*.csv
    sed -E 's/^(torque_N_m = ).*/\1/' experiments.toml
    sed 1d experiment_1.csv | awk -F, '{ sub(/-/, "", $4); print NF, length($4), $7 ~ /\.[0-9][0-9]$/ }' | sort -u
    cut -d, -f1,2 experiment_1.csv | sort -u)
}
looks 0001 >first.txt
[ "$(wc -l <first.txt)" -gt 200 ] || fail "a trial holds little: $(cat first.txt)"
for trial in blind/0*; do
  looks "$(basename "$trial")" >other.txt
  cmp -s first.txt other.txt || fail "$trial looks otherwise than the first: $(diff first.txt other.txt | head -3)"
done
[ "$(stat -c %Y blind/0001/mill.toml)" -eq 946684800 ] || fail "files bear their date"
grep -rqiE 'rolling|cohesion|drag|camera|magnus|magnet|pocket|swirl|spray|jet|tube|glass|missing|kind' blind/0* &&
  fail "data name an effect: $(grep -rliE 'rolling|cohesion|drag|camera|magnus' blind/0* | head -1)"
cmp -s blind/0001/experiment_1.csv blind/0002/experiment_1.csv && fail "two trials are the same"
done_by simulate blind/0001/mill.toml --set run.revolutions=0.01 --set run.spin_up=0 -o m.h5

# By a seed: killed again and again, with any number of threads, the same bytes.
seeded=("${make[@]}" --n 6 --kind $kinds --seed 7)
done_by "${seeded[@]}" -o whole --threads 1
for wait in 0.2 0.4 0.6; do
  "$tumble" "${seeded[@]}" -o cut --resume --quiet &
  sleep "$wait"
  kill -9 $! 2>/dev/null
  wait $! 2>/dev/null
done
done_by "${seeded[@]}" -o cut --resume
diff -r whole cut >diff.txt && diff -r whole-keys cut-keys >>diff.txt || fail "resumed trials differ: $(head -3 diff.txt)"
# Killed before anything was published: while the plan or a key was being written.
mkdir half half-keys && echo x >half-keys/plan.txt.part
done_by "${seeded[@]}" -o half --resume
rm half/seals.txt && mv half-keys/0001.json half-keys/0001.json.part && done_by "${seeded[@]}" -o half --resume
diff -rq whole half >diff.txt || fail "trials begun afresh differ: $(head -3 diff.txt)"
refused 'is not empty' "${seeded[@]}" -o cut
refused 'of other trials' "${seeded[@]}" -o cut --resume --set run.spin_up=0.6
done_by "${seeded[@]}" -o cut --force

# Other data, one trial each.
done_by "${make[@]}" -o scalars --n 1 --kind physics --data scalars
grep -q '^toe_deg = ' scalars/0001/experiments.toml && [ "$(ls scalars/0001 | wc -l)" -eq 2 ] || fail "scalars: $(ls scalars/0001)"
done_by trials make --mill mill.toml --speeds 0.6 --hold-out-speeds none --hold-out-fillings none --revolutions 0.05 -o films --n 1 --kind artefact --data films --fps 100 --size 320x320
[ -s films/0001/experiment_1.mp4 ] && [ ! -e films/0001/experiment_1.h5 ] || fail "films: $(ls films/0001)"

# Scores.
verdict() {  # TRIAL VERDICT NAME
  mkdir -p "verdicts/$1"
  echo "{\"verdict\": \"$2\", \"effects\": [{\"name\": \"$3\", \"parameters\": {}}], \"ranking\": [{\"name\": \"$3\", \"probability\": 0.9}]}" >"verdicts/$1/verdict.json"
}
for key in whole-keys/*.json; do
  trial=$(basename "$key" .json)
  name=$(grep -m1 '"name"' "$key" | cut -d'"' -f4)
  verdict "$trial" missing_effect "$name"
done
first=$(grep -l '"kind": "single"' whole-keys/*.json)
"$tumble" trials score whole whole-keys verdicts >score.txt 2>err.txt || fail "score: $(cat err.txt)"
grep -q '^6 trials, all seals hold: 1 artefact from tracks' score.txt || fail "$(head -1 score.txt)"
grep -qE '^  1 .*100\.0 %  34\.2 % to 100\.0 % +2  >= 95 % +met$' score.txt || fail "bar 1: $(grep '^  1 ' score.txt)"
grep -qE '^  4 .* 0\.0 % .* 1  >= 97 % +MISSED$' score.txt || fail "bar 4: $(grep '^  4 ' score.txt)"
rm "verdicts/$(basename "$first" .json)/verdict.json"
"$tumble" trials score whole whole-keys verdicts --json | jq -e '.bars[0].measured == 0.5 and (.no_verdict | length) == 1' >/dev/null || fail "a missing verdict is not wrong"

# Tampering.
cp -r whole-keys bent
sed -i 's/"strength": 0/"strength": 1/' "bent/$(basename "$first")"
cmp -s "bent/$(basename "$first")" "$first" && sed -i 's/"strength": /"strength": 0.0000001e-/' "bent/$(basename "$first")"
refused 'is not the key that was sealed' trials score whole bent verdicts
cp -r whole-keys more && sed 's/"trial": "0001"/"trial": "0007"/' more/0001.json >more/0007.json
refused '0007.json: was never sealed' trials score whole more verdicts
cp -r whole-keys less && rm less/0002.json
refused '0002.json: no such file' trials score whole less verdicts

# Mistakes.
refused 'is "sinlge"; give one of single' "${make[@]}" -o x --n 1 --kind sinlge
refused 'is "pictures"; give one of tracks' "${make[@]}" -o x --n 1 --kind none --data pictures
refused '0.6 and speed 0.6 are the same mill' "${make[@]}" -o x --n 1 --kind none --speeds 0.6,0.6
refused 'give numbers above 0' "${make[@]}" -o x --n 1 --kind none --speeds 0.6,fast
refused 'is what each experiment sets' "${make[@]}" -o x --n 1 --kind none --uncertain charge.filling=0.01
refused 'KEY=SD' "${make[@]}" -o x --n 1 --kind none --uncertain contact.friction
[ ! -e x ] || fail "a refused command left a folder"
exit $((failures > 0))
