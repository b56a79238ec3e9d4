#!/usr/bin/env bash
# Measured data that cannot be right are refused in one line that tells where, what and what would be right, before any
# simulation; data in order are read, a film once.
#   tests/cli/measurements.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
cases=0
sed 's/^seed.*/seed = 3/; s/^revolutions.*/revolutions = 1.2/' "$source/examples/lab_mill_55cm.toml" >mill.toml

"$tumble" simulate mill.toml -o run.h5 --quiet --set run.frames_per_second=250 || fail "the run"
"$tumble" analyse run.h5 -o motion.h5 --csv csv --quiet || fail "its motion"
slices=9.97 # of the mill's length: docs/conventions.md
awk -F, -v n=$slices 'NR == 1 { print "time_s,torque_N_m" } NR > 1 { print $1 "," $2 * n }' csv/torque.csv >torque.csv
# The columns of the contract, with the mill's angle beside them.
awk -F, 'NR == FNR { angle[$1] = $3; next }
         FNR == 1 { print "frame,time_s,id,x_m,y_m,radius_m,mill_angle_deg"; next }
         { printf "%s,%s,%s,%s,%s,%s,%s\n", $1, $2, $3, $4, $5, $8, angle[$1] }' csv/profile.csv csv/tracks.csv >good.csv

# bad_data PATTERN 'EXPERIMENT LINES': one experiment that holds these lines.
bad_data() {
  cases=$((cases + 1))
  printf '[[experiment]]\nname = "E"\nset = { "charge.count" = 112 }\n%b\n' "$2" >experiments.toml
  rm -rf out
  timeout 120 "$tumble" calibrate mill.toml --measured experiments.toml --fit contact.friction=0.05:0.3 -o out --quiet \
    >out.txt 2>err.txt
  local got=$?
  [ "$got" -eq 2 ] || fail "$2 : exit status $got, expected 2 ($(head -c 400 err.txt))"
  [ "$(grep -c '^tumble: ' err.txt)" -eq 1 ] || fail "$2 : not one error line ($(head -c 400 err.txt))"
  grep -q -- "$1" err.txt || fail "$2 : says \"$(head -c 400 err.txt)\", expected \"$1\""
  [ ! -e out ] || fail "$2 : left the output behind"
}
# tracks PATTERN AWK: the good tracks with something done to them.
tracks() {
  awk -F, -v OFS=, "NR == 1 { print; next } $2 { print }" good.csv >bad.csv
  bad_data "$1" 'tracks = "bad.csv"'
}

tracks 'bad.csv:52:[0-9]*: x_m is "nan"' 'NR == 52 { $4 = "nan" }'
tracks 'bad.csv:52:[0-9]*: y_m is "inf"' 'NR == 52 { $5 = "inf" }'
tracks 'bad.csv:2:[0-9]*: x_m, y_m are .*metres' '{ $4 *= 1000; $5 *= 1000 }'
tracks 'bad.csv: balls come as far as .* times too small' '{ $4 /= 1000; $5 /= 1000 }'
tracks 'turns at .* as if given in ms' '{ $2 *= 1000 }'
tracks 'bad.csv:300:1: 4 fields where the header names 7' 'NR == 300 { print $1, $2, $3, $4; next }'
tracks 'bad.csv:1[0-9][0-9]:[0-9]*: time_s is .* must not fall' '$1 == 1 { $2 = -0.5 }'
tracks 'bad.csv:3:[0-9]*: ball 0 is in frame 0 twice' 'NR == 3 { $3 = 0 }'
tracks 'clockwise' '{ $4 = -$4; $7 = 180 - $7 }'
tracks 'turns at 36.* rev/min, MILL.toml and set have 40' '{ $2 *= 1.12 }'
tracks '80 balls where MILL.toml and set have 112' '$3 >= 80 { next }'
head -1 good.csv >bad.csv
bad_data 'bad.csv: has no rows' 'tracks = "bad.csv"'
cut -d, -f1-4 good.csv >bad.csv
bad_data 'bad.csv: has no column y_m' 'tracks = "bad.csv"'
bad_data 'no such file' 'tracks = "absent.csv"'

awk -F, 'NR == 9 { print "0.0001," $2; next } { print }' torque.csv >bad.csv
bad_data 'bad.csv:9:1: time_s is 0.0001 after .* must grow' 'torque_series = "bad.csv"'
awk -F, 'NR == 9 { print $1 ",NaN"; next } { print }' torque.csv >bad.csv
bad_data 'bad.csv:9:[0-9]*: torque_N_m is "NaN"' 'torque_series = "bad.csv"'
bad_data 'must lie between .* the whole mill' 'torque_N_m = 0.09'
bad_data 'must lie between .* the whole mill' 'power_W = 300000'
bad_data 'torque and frames of the same experiment' 'tracks = "good.csv"\ntorque_N_m = 60'
bad_data 'torque_uncertainty_N_m is 1e-07, less than a millionth' 'torque_N_m = 90\ntorque_uncertainty_N_m = 1e-7'
bad_data 'toe_uncertainty_deg is 1e-05' 'toe_deg = 230\ntoe_uncertainty_deg = 1e-5'
bad_data 'brings no data' ''
bad_data 'holds out every experiment' 'torque_N_m = 90\nhold_out = true'
bad_data 'contact.friction: is 1e-09, less than a millionth of its value' 'torque_N_m = 90\n[uncertain]\n"contact.friction" = 1e-9'

# What is in order is read: the toe of tracks is the toe of the run that they come from.
printf '[[experiment]]\nname = "E"\ntracks = "good.csv"\ntorque_series = "torque.csv"\n' >experiments.toml
"$tumble" calibrate mill.toml --measured experiments.toml --fit contact.friction=0.05:0.3 -o out --quiet --simulations 15 \
  --repeat 2 --set run.spin_up=0.3 --set run.revolutions=0.5 || fail "tracks and torque series in order"
toe=$(sed -n 's/.*"toe_deg": \([0-9.]*\).*/\1/p' csv/summary.json)
[ -n "$toe" ] && grep -q "\"measured\": ${toe%?}" out/calibration.json || fail "the toe of the tracks is not $toe"

echo "$cases kinds of bad data tried, $failures not refused as they should be"
[ "$failures" -eq 0 ]
