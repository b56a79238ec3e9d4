#!/usr/bin/env bash
# What the command promises of campaigns: a sweep or a calibration that was killed at any moment goes on to the bytes of
# an undisturbed one, the number of threads does not show, and held-out data do not move the fit.
#   tests/cli/sweep.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
mill=$source/examples/slice_mill_55cm.toml
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }

short=(--set run.spin_up=0.1 --set run.revolutions=0.3 --set run.frames_per_second=50 --set charge.count=60)
sweep=(sweep "$mill" --vary mill.speed=0.6:1.0:0.1 --repeat 3 "${short[@]}" --quiet)
"$tumble" "${sweep[@]}" --threads 1 -o a.h5 --csv a.csv || fail "the sweep"
[ "$(wc -l <a.csv)" -eq 16 ] || fail "5 speeds and 3 repeats are 15 rows, not $(wc -l <a.csv) lines with the header"
[ "$(head -1 a.csv | cut -d, -f1-6)" = mill.speed,seed,torque_N_m,torque_se_N_m,power_W,toe_deg ] || fail "the columns"
[ "$(sed -n 16p a.csv | cut -d, -f1,2)" = 1,3 ] || fail "the range does not end with its end"

# Killed again and again, then left alone.
killed=0
for wait in 0.05 0.1 0.2 0.3 0.4; do
  "$tumble" "${sweep[@]}" --resume -o b.h5 --csv b.csv &
  sleep "$wait"
  kill -9 $! 2>/dev/null && killed=$((killed + 1))
  wait $! 2>/dev/null
done
[ "$killed" -gt 0 ] || fail "no sweep was killed"
"$tumble" "${sweep[@]}" --resume -o b.h5 --csv b.csv || fail "the resumed sweep"
for end in h5 csv html; do same a.$end b.$end; done
[ ! -e b.h5.runs ] || fail "b.h5.runs is left behind"
"$tumble" "${sweep[@]}" --resume -o b.h5 --csv b.csv || fail "a complete sweep is not done at once"
"$tumble" "${sweep[@]}" --resume -o b.h5 --csv b.csv --json >b.json || fail "a complete sweep tells no summary"
"$tumble" "${sweep[@]}" --force -o b.h5 --csv b.csv --json >again.json || fail "the sweep by force"
same b.json again.json
grep -q '"mill.speed": 0.6' b.json || fail "the summary holds no points: $(cat b.json)"
# Figures of a complete sweep: nothing is run again, what is there stays, what is missing comes with the same bytes.
"$tumble" "${sweep[@]}" --resume -o b.h5 --figures fig || fail "figures of a complete sweep"
[ "$(ls fig | tr '\n' ' ')" = 'power.csv power.pdf power.svg toe_shoulder.csv toe_shoulder.pdf toe_shoulder.svg torque.csv torque.pdf torque.svg ' ] ||
  fail "the figures: $(ls fig)"
[ "$(wc -l <fig/torque.csv)" -eq 6 ] || fail "5 speeds are 5 points: $(cat fig/torque.csv)"
cp -r fig first
rm fig/torque.pdf fig/power.svg
echo mine >fig/power.csv
rm b.csv b.html
"$tumble" "${sweep[@]}" --resume -o b.h5 --csv b.csv --figures fig || fail "figures once more"
[ "$(cat fig/power.csv)" = mine ] || fail "a figure that was there was replaced"
for file in torque.pdf power.svg; do same first/$file fig/$file; done
for end in csv html; do same a.$end b.$end; done
"$tumble" "${sweep[@]}" -o d.h5 --figures third --threads 2 || fail "a sweep with figures"
diff -r first third >/dev/null || fail "figures differ with the number of threads, or from those of a file"
refused 'third/power.svg: exists' sweep "$mill" --vary mill.speed=0.6,0.7 "${short[@]}" -o c.h5 --figures third
refused 'figures: no varied key has numbers' sweep "$mill" --vary mill.lifters.profile=rectangle,none -o c.h5 --figures fig
refused 'of something else' sweep "$mill" --vary mill.speed=0.6,0.7 "${short[@]}" --resume -o b.h5
refused exists sweep "$mill" --vary mill.speed=0.6,0.7 "${short[@]}" -o b.h5
refused 'more than a million' sweep "$mill" --vary mill.speed=0.1:1.1:0.0001 --vary contact.friction=0.1:0.9:0.0005 -o c.h5
refused 'did you mean mill.speed' sweep "$mill" --vary mill.sped=0.1,0.2 -o c.h5
refused 'give one of local, slurm' sweep "$mill" --vary mill.speed=0.1,0.2 --engine sluurm -o c.h5

refused 'says the same as mill.speed; vary one' sweep "$mill" --vary mill.speed=0.6,0.7 --vary mill.speed_rpm=30,40 -o c.h5
refused 'value 0.60 twice' sweep "$mill" --vary mill.speed=0.6,0.60 -o c.h5
refused 'does not lead from' sweep "$mill" --vary mill.speed=0.6:1.0:0 -o c.h5
refused 'does not lead from' sweep "$mill" --vary mill.speed=0.6:1.0:-0.1 -o c.h5
refused 'must be numbers' sweep "$mill" --vary mill.speed=0.6:nan:0.1 -o c.h5
refused 'effects.rolling_resistance.coefficient: is 2' sweep "$mill" \
  --vary effects.rolling_resistance.coefficient=0:2:1 -o c.h5
refused 'c.html: is named for two outputs' sweep "$mill" --vary mill.speed=0.6,0.7 -o c.html
refused 'c.h5: is named for two outputs' sweep "$mill" --vary mill.speed=0.6,0.7 -o c.h5 --csv ./c.h5
cp "$mill" input.toml
refused 'is the input itself' sweep input.toml --vary mill.speed=0.6,0.7 -o c.h5 --csv input.toml --force
cmp -s "$mill" input.toml || fail "the input was replaced"
for bad in '' $'mill.speed,power_W\n0.6,nan' $'mill.speed,power_W\n0.6' $'mill.speed,power_W\n0.6,' $'mill.sped,power_W\n0.6,5'; do
  printf '%s\n' "$bad" >m.csv
  refused 'm.csv' sweep "$mill" --vary mill.speed=0.6,0.7 --measured m.csv -o c.h5
done
refused 'is a folder; give an EXPERIMENTS.toml' sweep "$mill" --vary mill.speed=0.6,0.7 --measured . -o c.h5
for left in c.*; do [ -e "$left" ] && fail "a refused sweep left $left"; done

experiments() {  # POWER of the held-out one
  for speed in 0.6 0.8; do
    printf '[[experiment]]\nname = "%s"\nset = { "mill.speed" = %s }\npower_W = %s\npower_uncertainty_W = 0.5\n' $speed $speed 12
  done
  printf '[[experiment]]\nname = "out"\nhold_out = true\nset = { "mill.speed" = 0.7 }\npower_W = %s\n' "$1"
}
experiments 14 >e.toml
experiments 20 >f.toml
fit=(calibrate "$mill" --fit contact.friction=0.05:0.5 "${short[@]}" --simulations 12 --repeat 2 --quiet)
"$tumble" "${fit[@]}" --measured e.toml --threads 1 -o one || fail "the calibration"
for wait in 0.1 0.3; do
  "$tumble" "${fit[@]}" --measured e.toml --resume -o two &
  sleep "$wait"
  kill -9 $! 2>/dev/null
  wait $! 2>/dev/null
done
"$tumble" "${fit[@]}" --measured e.toml --resume -o two || fail "the resumed calibration"
for file in model.toml calibration.json report.html runs.csv; do same one/$file two/$file; done
"$tumble" "${fit[@]}" --measured f.toml -o three || fail "the calibration with other held-out data"
same one/model.toml three/model.toml
same one/runs.csv three/runs.csv
"$tumble" "${fit[@]}" --measured e.toml -o one --resume --json >one.json || fail "a complete calibration is not done at once"
same one.json one/calibration.json
cmp -s one/calibration.json three/calibration.json && fail "held-out data are not reported"
"$tumble" simulate one/model.toml -o run.h5 --quiet || fail "model.toml does not run"
refused 'which --fit mill.speed_rpm would change' calibrate "$mill" --fit mill.speed_rpm=20:30 --measured e.toml -o four
refused 'need at least' calibrate "$mill" --fit contact.friction=0.1:0.5 --measured e.toml --simulations 3 -o four
refused 'LOW:HIGH' calibrate "$mill" --fit contact.friction=0.5:0.1 --measured e.toml -o four
refused 'between the ends.*charge.count.*whole' calibrate "$mill" --fit charge.count=50:100 --measured e.toml -o four
refused 'says the same as' calibrate "$mill" --fit charge.count=50:99 --fit charge.filling=0.1:0.3 --measured e.toml -o four
refused 'friction: is -1' calibrate "$mill" --fit contact.friction=-1:0.5 --measured e.toml -o four
refused 'share: is 2' calibrate "$mill" --fit effects.hertz_contact.share=0:2 --measured e.toml -o four

# Each mistake in EXPERIMENTS.toml names the experiment and what is wrong.
wrong() {  # PATTERN LINES
  printf '[[experiment]]\nname = "J35"\n%s\n' "$2" >wrong.toml
  refused "wrong.toml:[0-9]*: $1" calibrate "$mill" --fit contact.friction=0.1:0.5 --measured wrong.toml -o four
}
wrong 'J35: mill.sped: unknown key' $'set = { "mill.sped" = 0.7 }\npower_W = 5'
wrong 'J35: effects.cohesion.force: is -1' $'set = { "effects.cohesion.force" = -1 }\npower_W = 5'
wrong 'J35: power_W: must be a number' 'power_W = [5]'
wrong 'J35: toe_uncertainty: unknown key; did you mean toe_uncertainty_deg' $'toe_deg = 230\ntoe_uncertainty = 2'
wrong 'J35: film: no such file' 'film = "nowhere.mp4"'
wrong 'J35: .: is a folder; give a motion file' 'motion = "."'
for bad in '' 'time_s,torque_N_m' $'time_s,torque_N_m\n0,1\n1,' $'time_s,torque_N_m\n0,nan' $'time_s,torque_N_m\n1,1\n0,1'; do
  printf '%s\n' "$bad" >series.csv
  wrong 'J35: series.csv' 'torque_series = "series.csv"'
done
printf '[[experiment]]\nname = "film"\nfilm = "wrong.toml"\n' >film.toml
refused 'one/model.toml: exists' calibrate "$mill" --fit contact.friction=0.1:0.5 --measured film.toml -o one  # before the film is read
[ ! -e four ] || fail "a refused calibration left its folder"

[ "$failures" -eq 0 ] && echo "campaigns are as promised"
[ "$failures" -eq 0 ]
