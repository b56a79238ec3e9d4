#!/usr/bin/env bash
# What `tumble render` promises of its views: stills, drawings, films of other kinds, cameras, several runs side by side,
# parts of a run; and which options it refuses where they would mean nothing.
#   tests/cli/views.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"

mill=("$source/examples/lab_mill_55cm.toml" --set run.spin_up=0.1)
done_by simulate "${mill[@]}" -o a.h5 --set run.revolutions=0.3 --json # 0.44 s
balls=$(grep -o '"balls": [0-9]*' out.txt | cut -d' ' -f2)
done_by simulate "${mill[@]}" -o b.h5 --set run.revolutions=0.25 --set mill.speed=0.9
small=(--size 320x180)

# Stills: the middle unless told, and the same picture as a film has at that moment.
done_by render a.h5 -o still.png "${small[@]}" --at 0.1
done_by render a.h5 -o again.png "${small[@]}" --at 0.1 --threads 1
done_by render a.h5 -o middle.png "${small[@]}"
cmp -s still.png again.png || fail "a still depends on the number of threads"
cmp -s still.png middle.png && fail "--at changes nothing"
done_by render a.h5 -o still.svg --at 0.1
[ "$(grep -c 'fill="url(#light)"' still.svg)" = "$balls" ] || fail "still.svg has another number of balls than $balls"
grep -q '>Ball speed, m/s</text>' still.svg || fail "still.svg has no text"
done_by render a.h5 -o still.pdf --at 0.1
[ "$(head -c5 still.pdf)" = '%PDF-' ] || fail "still.pdf is no PDF"

# Parts of a run: 0.1 s at 60 frames/s are 7 pictures, every 0.02 s of it 6, four times slower at 25 frames/s 11.
frames_of() { done_by render "$@" --json --force && grep -o '"frames": [0-9]*' out.txt | cut -d' ' -f2; }
[ "$(frames_of a.h5 -o part/ "${small[@]}" --from 0.1 --for 0.1)" = 7 ] || fail "--for 0.1 is not 7 frames"
[ "$(frames_of a.h5 -o every/ "${small[@]}" --from 0.1 --for 0.1 --every 0.02)" = 6 ] || fail "--every 0.02 is not 6 frames"
[ "$(frames_of a.h5 -o part.gif --from 0.1 --for 0.1 --slow 4)" = 11 ] || fail "part.gif is not 11 frames"
[ "$(head -c6 part.gif)" = GIF89a ] || fail "part.gif is no GIF"
[ "$(frames_of a.h5 -o part.webm "${small[@]}" --for 0.1)" = 7 ] || fail "part.webm is not 7 frames"

# Cameras change the picture, runs side by side end with the shortest.
for view in "--camera shell" "--camera ball:7" "--zoom 2"; do
  # shellcheck disable=SC2086
  done_by render a.h5 -o view.png "${small[@]}" --at 0.1 $view --force
  cmp -s still.png view.png && fail "$view changes nothing"
done
long=$(frames_of a.h5 -o long/ "${small[@]}" --every 0.05) both=$(frames_of a.h5 b.h5 -o both/ "${small[@]}" --every 0.05)
[ "$both" -lt "$long" ] || fail "two runs have $both pictures, the longer one alone $long"
done_by render a.h5 b.h5 -o both.svg
for label in '0.7 of critical speed' '0.9 of critical speed'; do
  grep -q ">$label</text>" both.svg || fail "both.svg does not say \"$label\""
done

# All that can be drawn, on paper: as pixels, and as shapes with each word once; each run of a sheet has its own mean.
all=(--at 0.1 --theme light --colour force --overlay all)
done_by render a.h5 -o all.png "${small[@]}" "${all[@]}" --camera shell
done_by render a.h5 -o all_mirrored.png "${small[@]}" "${all[@]}" --camera shell --mirror --threads 1
cmp -s all.png all_mirrored.png && fail "--mirror changes nothing"
done_by render a.h5 -o all.svg "${all[@]}" --camera shell
for words in 'free surface' 'mean flow' occupancy CoC departure toe shoulder gravity 'Largest contact force, N'; do
  [ "$(grep -c ">$words</text>" all.svg)" = 1 ] || fail "all.svg does not say \"$words\" once"
done
grep -q 'rect width="1280" height="720" fill="#fff' all.svg || fail "all.svg is not on white paper"
done_by render a.h5 b.h5 -o both_all.svg "${all[@]}"
[ "$(grep -c '>CoC</text>' both_all.svg)" = 2 ] || fail "both_all.svg does not have two centres of circulation"

refused 'ball 4000' render a.h5 -o view.png --camera ball:4000 --force
refused 'ball:N' render a.h5 -o view.png --camera ball --force
refused '\--at' render a.h5 -o film.mp4 --at 1
refused '\--at' render a.h5 -o late.png --at 100
refused '\--from' render a.h5 -o late.mp4 --from 100
refused '\--fps' render a.h5 -o still2.png --fps 30
refused '\--preset' render a.h5 -o film.webm --preset fast
refused '\--crf' render a.h5 -o film.gif --crf 20
refused 'hundredths' render a.h5 -o film.gif --fps 60
refused 'osmesa' render a.h5 -o still2.png --context vulkan
refused '\.webm' render a.h5 -o film.avi
refused 'one run' render a.h5 b.h5 -o film.mp4 --theme film
ls | grep -E 'late|film|still2' && fail "something refused left a file"

[ "$failures" -eq 0 ] && echo "views are as promised"
[ "$failures" -eq 0 ]
