#!/usr/bin/env bash
# What `tumble compare` promises: every kind of input, one line for each that is wrong, nothing half-written, a summary that
# agrees with the files.
#   tests/cli/compare.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
get() { grep -o "\"$1\": [^,]*" "$2" | head -1 | cut -d' ' -f2-; }

short=(--set run.spin_up=0.2 --set run.revolutions=0.6 --set run.frames_per_second=60)
done_by simulate "$source/examples/lab_mill_55cm.toml" -o a.h5 "${short[@]}"
done_by simulate "$source/examples/lab_mill_55cm.toml" -o b.h5 "${short[@]}" --set contact.friction=0.5 --set run.seed=2
done_by analyse b.h5 -o b_motion.h5

# Runs, with their films; the summary is what the file begins with.
done_by compare a.h5 b.h5 -o runs --json
cp out.txt summary.json
[ -s runs/report.html ] && [ -s runs/deviation.json ] || fail "compare left no report"
for key in verdict value difference; do
  [ "$(get $key summary.json)" = "$(get $key runs/deviation.json)" ] || fail "--json and deviation.json differ in $key"
done
[ "$(grep -o 'data:video/mp4' runs/report.html | wc -l)" -eq 2 ] || fail "the report of two runs does not hold two films"
[ "$(wc -c <runs/report.html)" -lt 13000000 ] || fail "the report is too large for a mail"
for far in 'http:' 'https:' 'src="[^d]'; do
  grep -o "$far[^\" ]*" runs/report.html | grep -qv 'www.w3.org/2000/svg\|github.com/leeoniya/uPlot' && fail "the report reaches outside: $far"
done

# The same run by way of a motion file: the same numbers, and no film of it.
done_by compare a.h5 b_motion.h5 -o mixed --no-films
same() { grep -A20 '"name": "toe_deg"' "$1" | grep -m1 '"z"'; }
[ "$(same runs/deviation.json)" = "$(same mixed/deviation.json)" ] || fail "a motion file gives another z than its run"
grep -q 'data:video' mixed/report.html && fail "--no-films left a film"

# Twice the same: no difference at all.
done_by compare b.h5 b_motion.h5 -o twice --no-films --json
[ "$(get verdict out.txt)" = '"agree"' ] && [ "$(get value out.txt)" = 0.0 ] || fail "a run differs from itself: $(head -3 out.txt)"

# Replaced only by force, and then whole; what else is in the folder stays.
echo mine >runs/notes.txt
cp runs/report.html before.html
refused 'exists; remove it or add --force' compare a.h5 b.h5 -o runs
cmp -s runs/report.html before.html || fail "a refused comparison touched the report"
done_by compare a.h5 b_motion.h5 -o runs --force --no-films
cmp -s runs/report.html before.html && fail "--force kept the report"
[ "$(cat runs/notes.txt)" = mine ] || fail "--force took what is not compare's"

# What is wrong: one line each, and no folder left behind.
refused 'nowhere.h5: does not exist' compare a.h5 nowhere.h5 -o none
head -c 100000 b.h5 >cut.h5
refused 'cut.h5' compare a.h5 cut.h5 -o none
head -c 60000 b_motion.h5 >cut_motion.h5
refused 'cut_motion.h5' compare cut_motion.h5 a.h5 -o none
echo "not a film" >film.mp4
refused 'film.mp4: cannot be read as a film' compare film.mp4 a.h5 -o none
refused 'does not exist; make it first' compare a.h5 b.h5 -o no/such/place
refused 'is a file; give a folder' compare a.h5 b.h5 -o a.h5
refused 'nothing.toml' compare a.h5 b.h5 -o none --mill nothing.toml
refused 'no ball 999; its balls are numbered from 0 to 111' compare a.h5 b.h5 -o none --balls-b 999 --no-films
refused 'recorded-fps' compare a.h5 b.h5 -o none --recorded-fps -3
[ ! -e none ] || fail "a refused comparison left its folder"

[ "$failures" -eq 0 ] && echo "compare is as promised"
[ "$failures" -eq 0 ]
