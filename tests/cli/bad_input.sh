#!/usr/bin/env bash
# Every mistake gets its one line on standard error and exit status 1 or 2, and leaves nothing under the output's name.
#   tests/cli/bad_input.sh TUMBLE_BINARY SOURCE_FOLDER
set -uo pipefail
tumble=$(realpath "$1")
source=$(realpath "$2")
work=$(mktemp -d)
mounted=
trap '[ -n "$mounted" ] && umount "$mounted"; chmod -R u+w "$work"; rm -rf "$work"' EXIT
cd "$work"
failures=0
cases=0
cp "$source/examples/lab_mill_55cm.toml" mill.toml

fail() { failures=$((failures + 1)); echo "FAILED: $*"; }

# refused STATUS PATTERN OUTPUT COMMAND...: the command ends with STATUS, one line that holds PATTERN, no OUTPUT.
refused() {
  local status=$1 pattern=$2 output=$3
  shift 3
  cases=$((cases + 1))
  timeout 120 "$@" >out.txt 2>err.txt
  local got=$?
  [ "$got" -eq "$status" ] || fail "$* : exit status $got, expected $status ($(head -c 300 err.txt))"
  local lines
  lines=$(grep -c '^tumble: ' err.txt)
  [ "$lines" -eq 1 ] || fail "$* : $lines error lines instead of one ($(head -c 300 err.txt))"
  grep -q -- "$pattern" err.txt || fail "$* : says \"$(head -c 300 err.txt)\", expected \"$pattern\""
  [ -z "$output" ] || [ ! -e "$output" ] || fail "$* : left $output behind"
}
with() { sed "$1" mill.toml >"$2"; }  # a mill with one thing wrong
simulate() { refused "$1" "$2" run.h5 "$tumble" simulate "$3" -o run.h5 --quiet "${@:4}"; rm -f run.h5.part; }

# --- the command line
refused 2 'verb\|subcommand' "" "$tumble"
refused 2 'simulat: unknown verb; known:.*simulate' "" "$tumble" simulat mill.toml -o run.h5
refused 2 'output' "" "$tumble" simulate mill.toml
refused 2 'ship' "" "$tumble" simulate mill.toml -o run.h5 --ship
refused 2 'cohesin: is no effect; the nearest is cohesion' "" "$tumble" effects cohesin

# --- MILL.toml
simulate 2 'missing.toml' missing.toml
simulate 2 'folder\|directory' .
with 's/diameter = 0.545/diamter = 0.545/' wrong.toml && simulate 2 'wrong.toml:4: mill.diamter.*mill.diameter' wrong.toml
with 's/diameter = 0.545/diameter = -0.545/' wrong.toml && simulate 2 'wrong.toml:4: mill.diameter' wrong.toml
with 's/diameter = 0.545/diameter = "wide"/' wrong.toml && simulate 2 'wrong.toml:4: mill.diameter' wrong.toml
with 's/diameter = 0.545/diameter = = 1/' wrong.toml && simulate 2 'wrong.toml:4' wrong.toml
with 's/count = 112/filling = 0.95/' wrong.toml && simulate 2 'charge.filling' wrong.toml
with 's/width = 0.02 /width = 0.2 /' wrong.toml && simulate 2 'overlap' wrong.toml
with 's/radius = 0.025/radius = 0.3/' wrong.toml && simulate 2 'does not fit' wrong.toml
with 's/time_step = "auto"/time_step = 1e-3/' wrong.toml && simulate 2 'wrong.toml:[0-9]*: run.time_step' wrong.toml
simulate 2 'mill.sped' mill.toml --set mill.sped=0.7
simulate 2 'mill.speed' mill.toml --set mill.speed=fast
simulate 2 'mill.speed' mill.toml --set mill.speed
simulate 2 'hertz' mill.toml --set contact.law=herz
simulate 2 'rolling_resistance' mill.toml --set effects.rolling_resistence.coefficient=0.05
simulate 2 'rolling_resistance.coefficient' mill.toml --set effects.rolling_resistance.coefficient=-1

# --- shells and effects
shell() { refused 2 "$1" shell.svg "$tumble" shell mill.toml -o shell.svg "${@:2}"; }
polygon() { shell "$1" --set mill.lifters.profile=polygon --set "mill.lifters.points=$2"; }
polygon 'crosses itself' '[[0,-0.01],[0.02,0.01],[0.02,-0.01],[0,0.01]]'
polygon 'from the leading to the trailing foot' '[[0,0.01],[0.02,0.01],[0.02,-0.01],[0,-0.01]]'
polygon 'are 2, must be 3' '[[0,-0.01],[0.02,0.01]]'
polygon 'found 5, must be a list' 5
polygon 'points\[1\]: found a list, must be \[height, across\]' '[[0,-0.01],[0.02],[0,0.01]]'
polygon 'points\[1\]: found nan' '[[0,-0.01],[0.02,nan],[0,0.01]]'
shell 'points: are missing' --set mill.lifters.profile=polygon
shell 'reaches the mill' --set mill.lifters.height=0.3
shell 'overlap' --set mill.lifters.count=90
shell 'has no meaning for a wave' --set mill.lifters.profile=wave --set mill.lifters.leading_angle_deg=20
with 's/rectangle/wave/; /^height/d' wrong.toml && refused 2 'lifters.height: is missing' shell.svg "$tumble" shell wrong.toml -o shell.svg
for number in mill.lifters.height mill.speed charge.count effects.hertz_contact.share effects.cohesion.force; do
  shell "$number: found a list" --set "$number=[1]"
done
shell 'viscosity: is -1' --set effects.fluid_drag.viscosity=-1
shell 'drop: is 1.5, must lie between' --set effects.impact_restitution.drop=1.5
shell 'share: is 2, must lie between 0 and 1' --set effects.hertz_contact.share=2
shell 'names lifter 18, the mill.s lifters are 0 to 17' --set 'effects.missing_lifters.lifters=[18]'
shell 'lifters: found 3.5, must be a list' --set effects.missing_lifters.lifters=3.5
shell 'order: is 1.5, must be whole' --set effects.speed_ripple.amplitude=0.1 --set effects.speed_ripple.order=1.5
refused 2 'give SHELL.svg or SHELL.csv' shell.pdf "$tumble" shell mill.toml -o shell.pdf
refused 2 '--chord' shell.csv "$tumble" shell mill.toml -o shell.csv --chord 0

# --- outputs
refused 2 'nowhere' "" "$tumble" simulate mill.toml -o nowhere/run.h5
refused 2 'folder' "" "$tumble" simulate mill.toml -o .
echo precious >run.h5
refused 2 'exists' "" "$tumble" simulate mill.toml -o run.h5
[ "$(cat run.h5)" = precious ] || fail "an output that exists was touched without --force"
rm run.h5
if [ "$(id -u)" -ne 0 ]; then
  mkdir locked && chmod a-w locked
  refused 2 'locked' locked/run.h5 "$tumble" simulate mill.toml -o locked/run.h5
  refused 2 'locked' locked/out "$tumble" run mill.toml -o locked/out
fi

# --- run files and films
"$tumble" simulate mill.toml -o good.h5 --quiet --set run.spin_up=0.1 --set run.revolutions=0.5 || fail "the good run"
head -c 60000 good.h5 >cut.h5
head -c 300 good.h5 >stump.h5
echo 'this is no film' >text.mp4
: >empty.mp4
cp text.mp4 text.h5
for verb in "render FILE -o film.mp4" "analyse FILE -o motion.h5"; do
  for file in missing.h5 cut.h5 stump.h5; do
    refused 2 "$file" "${verb##* }" "$tumble" ${verb/FILE/$file} --quiet
  done
done
refused 2 'text.h5' film.mp4 "$tumble" render text.h5 -o film.mp4
refused 2 'run file\|folder\|directory' film.mp4 "$tumble" render . -o film.mp4
printf 'track,frame,x_px,y_px,r_px\n1,0,100,far,8\n' >far.csv
refused 2 'far.csv:2:9: y_px is "far"' motion.h5 "$tumble" analyse far.csv -o motion.h5
printf 'track,frame,x_px,y_px,r_px\n1,0,100,100,8\n1,1,101,100,8\n' >short.csv
refused 2 'short.csv: the mill.s axis cannot be told' motion.h5 "$tumble" analyse short.csv -o motion.h5
refused 2 '--centre-px: is "640"; give u,v' motion.h5 "$tumble" analyse short.csv -o motion.h5 --centre-px 640
refused 2 '--metres-per-pixel: must be' motion.h5 "$tumble" analyse short.csv -o motion.h5 --metres-per-pixel 0
refused 2 'text.mp4' motion.h5 "$tumble" analyse text.mp4 -o motion.h5
refused 2 'empty.mp4' motion.h5 "$tumble" analyse empty.mp4 -o motion.h5
mkdir stills
refused 2 'stills' motion.h5 "$tumble" analyse stills -o motion.h5
refused 2 'size' film.mp4 "$tumble" render good.h5 -o film.mp4 --size 1281x720
refused 2 'overlay' film.mp4 "$tumble" render good.h5 -o film.mp4 --overlay toes
refused 2 'theme' film.mp4 "$tumble" render good.h5 -o film.mp4 --theme cinema
refused 2 'preset\|fastest' film.mp4 "$tumble" render good.h5 -o film.mp4 --preset fastest
refused 2 'avi' film.avi "$tumble" render good.h5 -o film.avi
"$tumble" render good.h5 -o good.mp4 --quiet --size 640x360 || fail "the good film"
# A film of no frames: a container whose index promises nothing.
"$tumble" render good.h5 -o good.mp4 --quiet --size 640x360 --force && head -c 2000 good.mp4 >broken.mp4
refused 2 'broken.mp4' motion.h5 "$tumble" analyse broken.mp4 -o motion.h5

# --- a full disk: a tmpfs where this is allowed, else a limit on file sizes
mkdir full
if mount -t tmpfs -o size=300k none full 2>/dev/null; then
  mounted=$work/full
  refused 1 'full/run.h5' full/run.h5 "$tumble" simulate mill.toml -o full/run.h5 --quiet
  rm -f full/*
  refused 1 'full/film.mp4' full/film.mp4 "$tumble" render good.h5 -o full/film.mp4 --quiet
  [ ! -e full/film.mp4.part ] || fail "a full disk left film.mp4.part"
fi
refused 1 'run.h5' run.h5 bash -c "ulimit -f 200; exec '$tumble' simulate mill.toml -o run.h5 --quiet"
rm -f run.h5.part

# interrupted_after SECONDS FILE COMMAND...: Ctrl-C so long after FILE has appeared.
cat >interrupted_after <<'SCRIPT'
#!/usr/bin/env bash
"${@:3}" & command=$!
for _ in $(seq 600); do [ -e "$2" ] && break; sleep 0.1; done
sleep "$1"
kill -INT "$command"
wait "$command"
SCRIPT
chmod +x interrupted_after

# --- Ctrl-C in the middle, then --resume to the same bytes as undisturbed
long=(mill.toml --quiet --set run.spin_up=0.2 --set run.revolutions=40)
# Late enough for a checkpoint, which comes two seconds after the start: without one --resume would start afresh.
refused 1 'interrupted.*--resume' stopped.h5 ./interrupted_after 2.5 stopped.h5.part "$tumble" simulate "${long[@]}" -o stopped.h5 --threads 1
[ -e stopped.h5.part ] || fail "Ctrl-C lost the interrupted run"
"$tumble" simulate "${long[@]}" -o stopped.h5 --resume || fail "resume after Ctrl-C"
"$tumble" simulate "${long[@]}" -o whole.h5
cmp -s stopped.h5 whole.h5 || fail "a resumed run differs from an undisturbed one"
refused 1 'interrupted' film.mp4 ./interrupted_after 0.3 film.mp4.part "$tumble" render whole.h5 -o film.mp4 --slow 20 --quiet
[ ! -e film.mp4.part ] || fail "Ctrl-C left film.mp4.part"

# --- a closed pipe
"$tumble" simulate mill.toml -o piped.h5 --json --quiet --set run.spin_up=0.1 --set run.revolutions=0.2 | true
[ "${PIPESTATUS[0]}" -le 1 ] || fail "a closed pipe gives status ${PIPESTATUS[0]}"

echo "$cases mistakes tried, $failures not refused as they should be"
[ "$failures" -eq 0 ]
