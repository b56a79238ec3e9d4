#!/usr/bin/env bash
# What `tumble diagnose` promises of its input and output: what cannot be right is refused in one line before anything is
# simulated or written; a diagnosis that was interrupted goes on with what is there, to the same verdict; what it leaves.
#   tests/cli/diagnose.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
cases=0

cat >mill.toml <<'END'
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
END
done_by simulate mill.toml -o run.h5
done_by analyse run.h5 -o motion.h5 --csv csv
awk -F, 'NR == FNR { angle[$1] = $3; next }
         FNR == 1 { print "frame,time_s,id,x_m,y_m,radius_m,mill_angle_deg"; next }
         { printf "%s,%s,%s,%s,%s,%s,%s\n", $1, $2, $3, $4, $5, $8, angle[$1] }' csv/profile.csv csv/tracks.csv >good.csv
cut -d, -f1,2 csv/torque.csv >torque.csv
uncertain='[uncertain]\n"contact.friction" = 0.03\n'

in=lib
diagnosis() { echo diagnose mill.toml --measured experiments.toml --library $in --blocks 2 --seeds 4; }
# bad PATTERN 'LINES of an experiment [and further tables]'
bad() {
  cases=$((cases + 1))
  printf '[[experiment]]\nname = "E"\n%b\n' "$2" >experiments.toml
  timeout 300 "$tumble" $(diagnosis) --quiet -o out >out.txt 2>err.txt
  local got=$?
  [ "$got" -eq 2 ] || fail "$2 : exit status $got, expected 2 ($(head -c 300 err.txt))"
  [ "$(wc -l <err.txt)" -eq 1 ] || fail "$2 : not one line ($(head -c 300 err.txt))"
  grep -q -- "$1" err.txt || fail "$2 : says \"$(head -c 300 err.txt)\", expected \"$1\""
  [ -z "$(find out lib -type f -not -path 'out/films/*' 2>/dev/null)" ] || fail "$2 : wrote something"
}
# tracks PATTERN AWK: the good tracks with something done to them.
tracks() {
  awk -F, -v OFS=, "NR == 1 { print; next } $2 { print }" good.csv >bad.csv
  bad "$1" 'tracks = "bad.csv"'
}
tracks 'experiments.toml:1: E: bad.csv:20:[0-9]*: x_m is "nan"' 'NR == 20 { $4 = "nan" }'
tracks 'E: bad.csv:2:[0-9]*: x_m, y_m are .* give metres' '{ $4 *= 1000; $5 *= 1000 }'
tracks 'E: .*as if given in ms' '{ $2 *= 1000 }'
tracks 'E: bad.csv:20:1: 4 fields where the header names 7' 'NR == 20 { print $1, $2, $3, $4; next }'
tracks 'E: bad.csv:[0-9]*:[0-9]*: time_s is .* must not fall' '$1 == 1 { $2 = -0.5 }'
cut -d, -f1-4 good.csv >bad.csv
bad 'E: bad.csv: has no column y_m' 'tracks = "bad.csv"'
awk -F, 'NR == 9 { print "0.0001," $2; next } { print }' torque.csv >bad.csv
bad 'E: bad.csv:9:1: time_s is 0.0001 after .* must grow' 'torque_series = "bad.csv"'
bad 'E: .*must lie between .* the whole mill' 'torque_N_m = 180'
bad 'experiments.toml:1: E: brings no data' ''
bad 'experiments.toml: holds out every experiment' 'tracks = "good.csv"\nhold_out = true'
bad 'experiments.toml:4: E: torque_uncertainty_N_m is 1e-12, less than a millionth' \
  'torque_N_m = 0.2\ntorque_uncertainty_N_m = 1e-12'
bad 'experiments.toml:4: E: torque_uncertainty_N_m: found 0, must be > 0' 'torque_N_m = 0.2\ntorque_uncertainty_N_m = 0'
bad 'experiments.toml:5: .*contact.friction: is 1e-12, less than a millionth' \
  'tracks = "good.csv"\n[uncertain]\n"contact.friction" = 1e-12'
bad 'experiments.toml:5: .*contact.friction: found 0, must be a standard deviation' \
  'tracks = "good.csv"\n[uncertain]\n"contact.friction" = 0'
bad 'experiments.toml:5: .*did you mean contact.friction?' 'tracks = "good.csv"\n[uncertain]\n"contact.frition" = 0.1'
bad 'experiments.toml:5: .*fluid_drag.viscosity: is uncertain about 0, which leaves no room' \
  'tracks = "good.csv"\n[uncertain]\n"effects.fluid_drag.viscosity" = 0.1'

bad 'experiments.toml:5: .*time_step: is uncertain about a value that MILL.toml does not give' \
  'tracks = "good.csv"\n[uncertain]\n"run.time_step" = 1e-5'

# The film of another mill.
done_by render run.h5 -o film.mp4 --fps 100 --overlay none --colour steel --size 480x480
cp mill.toml ours.toml
sed -i 's/^count = 6/count = 7/' mill.toml
bad 'E: film.mp4: .* repeats 6 times a turn, .*lifters.count = 7 does not' 'film = "film.mp4"'
rm -rf out  # what was seen in the film is kept
mv ours.toml mill.toml

# Interrupted while the library grows; then the same command goes on with what is there, to the same verdict.
printf '[[experiment]]\nname = "E 1"\ntracks = "good.csv"\ntorque_series = "torque.csv"\n%b' "$uncertain" >experiments.toml
"$tumble" $(diagnosis) --quiet -o out >out.txt 2>err.txt &
for _ in $(seq 600); do
  [ "$(find lib -name '*.h5' 2>/dev/null | wc -l)" -ge 2 ] && break
  sleep 0.1
done
kill -INT $!
wait $!
[ $? -eq 1 ] || fail "an interrupted diagnosis: $(cat err.txt)"
grep -q 'the same command goes on' err.txt || fail "an interrupted diagnosis says $(cat err.txt)"
[ ! -e out/verdict.json ] && [ ! -e out/runs ] || fail "an interrupted diagnosis leaves $(ls out)"
chunks() { find lib -type f -printf '%p %T@\n' | sort; }
chunks >kept.txt
done_by $(diagnosis) -o out
[ -z "$(comm -23 kept.txt <(chunks))" ] || fail "was simulated again: $(comm -23 kept.txt <(chunks))"
in=fresh
done_by $(diagnosis) -o whole --threads 1
in=lib
for file in model.toml runs/E_1-before.h5; do cmp out/$file whole/$file || fail "$file differs from the undisturbed one"; done
verdict() { sed 's/"seconds": [0-9.e+-]*/"seconds"/; s/"simulations": [0-9]*/"simulations"/' $1/verdict.json; }
[ "$(verdict out)" = "$(verdict whole)" ] || fail "the verdict differs from the undisturbed one"

# What is there stays, unless by force; what an older diagnosis left does not.
[ ! -e out/runs.part ] || fail "out/runs.part is left behind"
refused 'exists; remove it or add --force' $(diagnosis) -o out
rm out/*.*
refused 'out/runs: exists' $(diagnosis) -o out
touch out/film.mp4 out/model_tabulated.toml out/runs/old-after.h5 out/runs/mine.h5
done_by $(diagnosis) -o out --force
[ ! -e out/film.mp4 ] && [ ! -e out/runs/old-after.h5 ] || fail "an older diagnosis' files are left"
[ -e out/runs/mine.h5 ] || fail "a file that is no run of a diagnosis was removed"

echo "$cases kinds of bad input tried, $failures failures"
[ "$failures" -eq 0 ]
