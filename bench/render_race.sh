#!/usr/bin/env bash
# Races whole programs that draw the same discs into films of 1280x720 px, crf 20: `tumble render` from a run file of the
# scene (scene_run.cpp), with all that it draws by default, beside those of the rendering peers that are installed. User
# and system CPU of the whole process, start included; programs take turns, ratios are within a turn. Then what the films
# are worth (SSIM against the pictures before coding), where tumble's time goes, large scenes, and threads.
#   bench/render_race.sh [--size 148,1500] [--frames 150] [--turns 5] [--peers mpl_fast,mpl_naive,pv_avi,vtk_mp4]
#                        [--parts race,quality,cost,large,threads]
# The peers need (Debian): python3-matplotlib ffmpeg xvfb xauth paraview python3-paraview. Environment: TUMBLE_PEERS
# (default ../shared/peers), TUMBLE (build/release/cli/tumble), BENCH (build/release/bench), PYTHON (/usr/bin/python3).
set -euo pipefail
shopt -s inherit_errexit
cd "$(dirname "$0")/.."
sizes=148,1500 frames=150 turns=5 peers=mpl_fast,pv_avi parts=race,quality,cost,large,threads
while (($#)); do
  case $1 in
    --size) sizes=$2 ;;
    --frames) frames=$2 ;;
    --turns) turns=$2 ;;
    --peers) peers=$2 ;;
    --parts) parts=$2 ;;
    *) echo "unknown option $1; see the head of $0" >&2; exit 2 ;;
  esac
  shift 2
done
folder=${TUMBLE_PEERS:-../shared/peers}/render
tumble=${TUMBLE:-build/release/cli/tumble} bench=${BENCH:-build/release/bench} python=${PYTHON:-/usr/bin/python3}
for program in "$tumble" "$bench/scene_run" "$bench/render_cost"; do
  [[ -x $program ]] || { echo "no $program: build it, or set TUMBLE and BENCH" >&2; exit 1; }
done
[[ -f $folder/gen_frames.py ]] || { echo "no peers in $folder: set TUMBLE_PEERS; without them there is no scene" >&2; exit 0; }
"$python" -c 'import numpy' 2>/dev/null || { echo "no numpy for $python: install python3-numpy, or set PYTHON" >&2; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work
source bench/median.sh

missing_of() {  # PEER -> what it lacks, in a line; nothing where it can run
  local needed
  case $1 in
    mpl_*) needed=ffmpeg; "$python" -c 'import matplotlib' 2>/dev/null || { echo python3-matplotlib; return; } ;;
    vtk_mp4) needed='xvfb-run ffmpeg'; "$python" -c 'import vtkmodules' 2>/dev/null || { echo python3-paraview; return; } ;;
    pv_avi) needed='xvfb-run pvbatch' ;;
    *) echo "knowledge of it: there are mpl_fast, mpl_naive, pv_avi, vtk_mp4"; return ;;
  esac
  for program in $needed; do command -v "$program" >/dev/null || { echo "$program"; return; }; done
}

scene() {  # BALLS FRAMES -> the scene's name, made once
  local name=$work/s$1_$2
  if [[ ! -f $name.h5 ]]; then
    "$python" "$folder/gen_frames.py" "$1" "$2" "$name.npz"
    "$bench/scene_run" "$name.f32" "$name.h5"
  fi
  echo "$name"
}

film() {  # SCENE OUTPUT OPTIONS...: one film frame for each of the scene's frames
  "$tumble" render "$1.h5" -o "$2" --fps 25 --slow 4 --force --quiet "${@:3}"
}

peer() {  # PEER SCENE FRAMES
  local screen=(xvfb-run -a -s '-screen 0 1400x900x24')
  case $1 in
    mpl_*) "$python" "$folder/$1.py" "$2.npz" "$3" "$work/$1.mp4" ;;
    vtk_mp4) "${screen[@]}" "$python" "$folder/vtk_glyph.py" "$2.npz" "$3" "$work/$1.mp4" ;;
    pv_avi) "${screen[@]}" pvbatch "$folder/pv_batch.py" "$2.npz" "$3" "$work/$1.avi" ;;
  esac
}

timed() {  # FORMAT COMMAND...; the program's own words are kept for when it fails
  local TIMEFORMAT=$1
  { time "${@:2}" >"$work/log" 2>&1; } 2>&1 || { echo "$2 $3 failed:" >&2; tail -n 3 "$work/log" >&2; return 1; }
}
cpu_ms() {  # FRAMES COMMAND... -> CPU milliseconds a frame
  timed '%U %S' "${@:2}" | awk -v f="$1" '{ print 1000 * ($1 + $2) / f }'
}
wall_s() { timed %R "$@"; }

has() { [[ ,$parts, == *,"$1",* ]]; }

if has race; then
  printf '%6s %-10s %-24s %-24s %-24s %-22s %s\n' balls peer 'peer, CPU ms/frame' 'tumble, medium' 'tumble, default' \
    'ratio at medium' 'ratio by default'
  for balls in ${sizes//,/ }; do
    name=$(scene "$balls" "$frames")
    for rival in ${peers//,/ }; do
      missing=$(missing_of "$rival")
      if [[ -n $missing ]]; then
        printf '%6s %-10s cannot run: it needs %s\n' "$balls" "$rival" "$missing"
        continue
      fi
      : >"$work/turns"
      for _ in $(seq "$turns"); do
        theirs=$(cpu_ms "$frames" peer "$rival" "$name" "$frames") || continue  # Xvfb may not come up in time
        medium=$(cpu_ms "$frames" film "$name" "$work/medium.mp4" --threads 1 --preset medium)
        default=$(cpu_ms "$frames" film "$name" "$work/default.mp4" --threads 1)
        echo "$theirs $medium $default" >>"$work/turns"
      done
      printf '%6s %-10s %-24s %-24s %-24s %-22s %s\n' "$balls" "$rival" "$(awk '{ print $1 }' "$work/turns" | median)" \
        "$(awk '{ print $2 }' "$work/turns" | median)" "$(awk '{ print $3 }' "$work/turns" | median)" \
        "$(awk '{ print $2 / $1 }' "$work/turns" | median)" "$(awk '{ print $3 / $1 }' "$work/turns" | median)"
    done
  done
fi

ssim() {  # FILM RAW MATRIX: of the film against pictures before coding, all planes; they are coded by this matrix
  ffmpeg -hide_banner -nostdin -i "$1" "${@:4}" -i "$2" -lavfi \
    "[1:v]scale=out_color_matrix=$3:out_range=tv,format=yuv420p,settb=1/25,setpts=N[raw];[0:v]format=yuv420p,settb=1/25,setpts=N[film];[film][raw]ssim" \
    -f null - 2>&1 | sed -n 's/.*SSIM.*All:\([0-9.]*\).*/\1/p'
}

if has quality; then
  if ! command -v ffmpeg >/dev/null; then
    echo 'quality cannot be told: it needs ffmpeg'
  else
    printf '\n%6s %-18s %-9s %s\n' balls film SSIM bytes/frame
    for balls in ${sizes//,/ }; do
      name=$(scene "$balls" "$frames")
      mkdir "$work/raw"
      film "$name" "$work/raw/"
      for preset in medium veryfast; do  # veryfast is the default
        film "$name" "$work/$preset.mp4" --preset "$preset"
        printf '%6s %-18s %-9s %s\n' "$balls" "tumble, $preset" \
          "$(ssim "$work/$preset.mp4" "$work/raw/frame_%06d.png" bt709 -framerate 25)" \
          "$(($(stat -c %s "$work/$preset.mp4") / frames))"
      done
      rm -r "$work/raw"
      [[ -z $(missing_of mpl_fast) ]] || continue
      sed -e "s/libx264/ffv1/; s/'-crf', '20', '-pix_fmt', 'yuv420p'/'-pix_fmt', 'bgr0'/" "$folder/mpl_fast.py" >"$work/raw.py"
      "$python" "$work/raw.py" "$name.npz" "$frames" "$work/raw.mkv"
      "$python" "$folder/mpl_fast.py" "$name.npz" "$frames" "$work/mpl.mp4"
      printf '%6s %-18s %-9s %s\n' "$balls" 'matplotlib, medium' "$(ssim "$work/mpl.mp4" "$work/raw.mkv" bt601)" \
        "$(($(stat -c %s "$work/mpl.mp4") / frames))"
    done
  fi
fi

if has cost; then
  printf '\nwhere the time goes, CPU ms a frame:\n'
  for balls in ${sizes//,/ }; do
    for preset in medium veryfast; do
      printf '%6s %-9s ' "$balls" "$preset"
      "$bench/render_cost" "$(scene "$balls" "$frames").h5" --preset "$preset"
    done
  done
fi

if has large; then
  name=$(scene 15000 "$frames")
  large=(film "$name" "$work/large.mp4" --size 1920x1080 --threads 2)
  for _ in $(seq "$turns"); do timed '%R %U %S' "${large[@]}"; done >"$work/turns"
  printf '\n15,000 balls at 1920x1080, two threads: %s frames a second by the clock, %s CPU ms a frame\n' \
    "$(awk -v f="$frames" '{ print f / $1 }' "$work/turns" | median)" \
    "$(awk -v f="$frames" '{ print 1000 * ($2 + $3) / f }' "$work/turns" | median)"
fi

if has threads; then
  for balls in ${sizes//,/ }; do
    name=$(scene "$balls" 600)
    : >"$work/turns"
    for _ in $(seq "$turns"); do
      one=$(wall_s film "$name" "$work/one.mp4" --threads 1)
      two=$(wall_s film "$name" "$work/two.mp4" --threads 2)
      awk -v one="$one" -v two="$two" 'BEGIN { print one / two }' >>"$work/turns"
      cmp "$work/one.mp4" "$work/two.mp4" || { echo "two threads draw another film than one" >&2; exit 1; }
    done
    printf '%6s balls, 600 frames: two threads are %s times as fast as one, by the clock, with the same bytes\n' "$balls" \
      "$(median <"$work/turns")"
  done
fi
