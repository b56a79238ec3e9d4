#!/usr/bin/env bash
# Opens a report in headless Chromium, as a reader would from disk: the film must play (a duration, a decoded frame that
# is not blank), the plots must be drawn and the console must stay silent.
# Then that page, a sweep's and one of an experiment are looked over: three widths, dark and light, keys, paper.
#   scripts/check_browser.sh [FOLDER of `tumble run` [FOLDER for pictures]]    default: a short run of the paper's mill
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/browser.sh

if [ $# -ge 1 ]; then
  folder=$(realpath "$1")
else
  folder=$work/run
  build/release/cli/tumble run examples/lab_mill_55cm.toml -o "$folder" --quiet \
    --set run.spin_up=0.5 --set run.revolutions=1
fi

pictures=${2:-}
if [ -n "$pictures" ]; then mkdir -p "$pictures"; fi
open_browser

# What the first video of the page shows in the middle of its length, decoded.
look='const done = arguments[0], v = document.querySelector("video"); v.muted = true;
  const fail = () => done({ error: v.error ? v.error.message : "does not load" });
  const seen = () => { const c = document.createElement("canvas"); c.width = v.videoWidth; c.height = v.videoHeight;
    const g = c.getContext("2d"); g.drawImage(v, 0, 0);
    const p = g.getImageData(0, 0, c.width, c.height).data; let n = 0, s = 0, q = 0;
    for (let i = 1; i < p.length; i += 4) { n++; s += p[i]; q += p[i] * p[i]; }
    done({ duration: v.duration, width: c.width, height: c.height, spread: Math.sqrt(q / n - s * s / n / n),
           plots: document.querySelectorAll("canvas").length }); };
  const seek = () => { v.onseeked = seen; v.currentTime = v.duration / 2; };
  v.onerror = fail; if (v.error) fail(); else if (v.readyState >= 2) seek(); else { v.onloadeddata = seek; v.load(); }'
see() { run_async "$look"; }

visit "file://$folder/report.html"
expect report.html "$(see)" '.duration > 0 and .spread > 10 and .plots > 0'
expect "report.html's console" "$(console)" 'length == 0'

echo "<video src='file://$folder/film.mp4'></video>" >"$work/film.html"
visit "file://$work/film.html"
expect film.mp4 "$(see)" '.duration > 0 and .spread > 10'

tumble=build/release/cli/tumble
"$tumble" sweep examples/slice_mill_55cm.toml --vary mill.speed=0.6:0.9:0.1 --repeat 2 --quiet -o "$work/sweep.h5" \
  --set run.spin_up=0.2 --set run.revolutions=0.5 --set run.frames_per_second=50
"$tumble" parameters drop examples/experiments/drop.csv -o "$work/drop.html" --quiet >/dev/null
look_over "file://$folder/report.html" run "$pictures"
look_over "file://$work/sweep.html" sweep "$pictures"
look_over "file://$work/drop.html" drop "$pictures"
echo "the pages are as they should be"
