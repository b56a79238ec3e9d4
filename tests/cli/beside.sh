#!/usr/bin/env bash
# What `tumble render --beside` promises: a run beside its own film coincides with it, whichever way the film's mill turns,
# with lifters in phase; the same pictures for any number of threads; one line for what is wrong.
#   tests/cli/beside.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
get() { grep -o "\"$1\": [^,]*" "$2" | head -1 | cut -d' ' -f2-; }
check() { awk "BEGIN { exit !($1) }" || fail "$2"; }  # EXPRESSION MESSAGE

done_by simulate "$source/examples/lab_mill_55cm.toml" -o run.h5 --set run.spin_up=0.6 --set run.revolutions=0.35 \
  --set run.frames_per_second=100
for turning in counter_clockwise clockwise; do
  [ $turning = clockwise ] && mirror=--mirror || mirror=
  done_by render run.h5 -o $turning.mp4 --fps 100 --overlay none --colour steel $mirror
  done_by analyse $turning.mp4 --mill "$source/examples/lab_mill_55cm.toml" -o $turning.h5
  # Begun within two degrees of the lifters' place: 8.2 ms at 40.5 rev/min.
  done_by render run.h5 -o ${turning}_phase/ --beside $turning.h5 --as wipe --size 320x180 --fps 10 --json
  check "$(get run_from_s out.txt) < 0.0082" "$turning: the run begins $(get run_from_s out.txt) s late"
  done_by render run.h5 -o $turning/ --beside $turning.h5 --as difference --size 640x360 --fps 10 --run-from 0 --json
  cp out.txt $turning.json
  check "$(get only_film $turning.json) < 0.06 && $(get only_simulation $turning.json) < 0.06" \
    "$turning: a run differs from its own film: $(get only_film $turning.json) $(get only_simulation $turning.json)"
done
# The run turns as the film does: what a wipe shows of it is itself a film of a clockwise mill.
done_by render run.h5 -o wiped.mp4 --beside clockwise.h5 --as wipe --wipe-at 0 --overlay none --fps 100
done_by analyse wiped.mp4 --mill "$source/examples/lab_mill_55cm.toml" -o wiped.h5 --json
[ "$(get rotation out.txt)" = '"clockwise"' ] || fail "beside a clockwise film the run turns $(get rotation out.txt)"
# Another run of that mill is no match, so that the check above means something.
done_by simulate "$source/examples/lab_mill_55cm.toml" -o other.h5 --set run.spin_up=0.6 --set run.revolutions=0.35 \
  --set run.frames_per_second=100 --set run.seed=7
done_by render other.h5 -o other/ --beside clockwise.h5 --as difference --size 640x360 --fps 10 --run-from 0 --json
check "$(get only_film out.txt) > 0.12" "another run matches the film too: $(get only_film out.txt)"

# All views, at any number of threads.
for view in side overlay wipe; do
  done_by render run.h5 -o one_$view/ --beside clockwise.h5 --as $view --size 640x360 --fps 10 --threads 1
  done_by render run.h5 -o two_$view/ --beside clockwise.h5 --as $view --size 640x360 --fps 10 --threads 2
  cmp -s one_$view/frame_000003.png two_$view/frame_000003.png || fail "$view: a picture depends on the number of threads"
done
done_by render run.h5 -o pictures/ --overlay none --colour steel --fps 10
cp pictures/frame_000003.png still.png
done_by render run.h5 -o still/ --beside still.png --as overlay --size 360x640
[ "$(ls still | wc -l)" -eq 1 ] || fail "one still gives $(ls still | wc -l) pictures"

refused 'nowhere.mp4: does not exist' render run.h5 -o no.mp4 --beside nowhere.mp4
refused 'is a run' render run.h5 -o no.mp4 --beside run.h5
refused '--as: is "above"' render run.h5 -o no.mp4 --beside clockwise.h5 --as above
refused 'between 0 and the run' render run.h5 -o no.mp4 --beside clockwise.h5 --run-from 9
refused 'between 0 and 1' render run.h5 -o no.mp4 --beside clockwise.h5 --as wipe --wipe-at 3
refused 'does not go with --beside' render run.h5 -o no.mp4 --beside clockwise.h5 --theme film
refused 'light does not go with --beside' render run.h5 -o no.mp4 --beside clockwise.h5 --theme light
refused 'shows one run' render run.h5 run.h5 -o no.mp4 --beside clockwise.h5
refused 'FRAMES/' render run.h5 -o no.svg --beside clockwise.h5
refused 'leave out --camera' render run.h5 -o no.mp4 --beside clockwise.h5 --camera shell
refused 'steel' render run.h5 -o no.mp4 --beside clockwise.h5 --colour force
rm clockwise.mp4
refused 'which is not there' render run.h5 -o no.mp4 --beside clockwise.h5
[ ! -e no.mp4 ] && [ ! -e no.svg ] || fail "a refused film was written"

[ "$failures" -eq 0 ] && echo "beside is as promised"
[ "$failures" -eq 0 ]
