#!/usr/bin/env bash
# What the command promises of its outputs: replaced only with --force, a complete run is resumed at once, and the same
# quantity is the same number whichever verb tells it.
#   tests/cli/outputs.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
number() { grep -o "\"$1\": [-0-9.e+]*" "$2" | cut -d' ' -f2; }

run=("$source/examples/lab_mill_55cm.toml" -o run.h5 --set run.spin_up=0.1 --set run.revolutions=0.3)
done_by simulate "${run[@]}" --json
cp out.txt simulate.json
cp run.h5 first.h5
refused exists simulate "${run[@]}"

# --resume: a complete run is done, another config's run is in the way, --force makes way for it.
done_by simulate "${run[@]}" --resume
cmp -s run.h5 first.h5 || fail "--resume touched a complete run"
refused 'another config' simulate "${run[@]}" --set mill.speed=0.6 --resume
done_by simulate "${run[@]}" --set mill.speed=0.6 --resume --force
cmp -s run.h5 first.h5 && fail "--resume --force kept the other run"
cp first.h5 run.h5

# Folders of tables and of pictures.
done_by analyse run.h5 -o motion.h5 --csv tables --json
cp out.txt analyse.json
refused 'summary.json: exists' analyse run.h5 -o other.h5 --csv tables
[ ! -e other.h5 ] || fail "a refused analysis left other.h5"
done_by analyse run.h5 -o other.h5 --csv tables --force
done_by render run.h5 -o pictures/ --size 320x180
refused 'frame_000000.png: exists' render run.h5 -o pictures --size 320x180
done_by render run.h5 -o pictures --size 320x180 --force
done_by render run.h5 -o filmed/ --size 320x180 --theme film --look-seed 3 --threads 1
done_by render run.h5 -o filmed_again/ --size 320x180 --theme film --look-seed 3 --threads 2
cmp filmed/frame_000001.png filmed_again/frame_000001.png || fail "a filmed picture depends on the number of threads"
# Parts of a film are drawn side by side, and trails reach back over their ends.
for threads in 1 3; do
  done_by render run.h5 -o threads_$threads.mp4 --size 320x180 --slow 3 --overlay toe,tracks --threads $threads
done
cmp threads_1.mp4 threads_3.mp4 || fail "a film depends on the number of threads"
ldd "$(dirname "$tumble")/tumble-render" | grep opencv && fail "tumble-render loads OpenCV: a rendering starts four times as slowly"
looks=(--size 320x180 --theme light --colour force --overlay all)
done_by render run.h5 -o looks/ "${looks[@]}" --threads 1
done_by render run.h5 -o looks_again/ "${looks[@]}" --threads 2
cmp looks/frame_000009.png looks_again/frame_000009.png || fail "a picture with all overlays depends on the number of threads"
refused 'streamlines' render run.h5 -o film.mp4 --overlay toes # names what there is
refused 'size' render run.h5 -o film.mp4 --size 4294968576x720 # 2^32 + 1280

for key in torque_N_m torque_closure_N_m; do
  verdict=$(awk -v a="$(number $key simulate.json)" -v b="$(number $key analyse.json)" \
    'BEGIN { d = a - b; print (a != 0 && d * d < 1e-14 * a * a) ? "same" : "differ" }')
  [ "$verdict" = same ] || fail "$key: simulate says $(number $key simulate.json), analyse $(number $key analyse.json)"
done

[ "$failures" -eq 0 ] && echo "outputs are as promised"
[ "$failures" -eq 0 ]
