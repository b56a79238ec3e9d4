#!/usr/bin/env bash
# Uses the page of `tumble compare` in headless Chromium as a reader would: by mouse and by keys, narrow and wide, light and
# dark, on paper. Everything must answer, nothing may be wider than the window, and the console must stay silent.
#   scripts/check_compare_page.sh [FOLDER of `tumble compare` with two films [FOLDER for pictures]]
#   default: two short runs of the paper's mill, of which one has more friction
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/browser.sh

tumble=$(realpath build/release/cli/tumble)
if [ $# -ge 1 ]; then
  folder=$(realpath "$1")
else
  folder=$work/compare
  for friction in 0.1 0.3; do
    "$tumble" simulate examples/lab_mill_55cm_triangular.toml -o "$work/$friction.h5" --quiet --set contact.friction=$friction \
      --set run.spin_up=0.5 --set run.revolutions=2 --set run.frames_per_second=100
  done
  "$tumble" compare "$work/0.1.h5" "$work/0.3.h5" -o "$folder" --quiet
fi
pictures=${2:-}
if [ -n "$pictures" ]; then mkdir -p "$pictures"; fi
picture() { if [ -n "$pictures" ]; then screenshot "$pictures/$1.png"; fi; }
page=file://$folder/report.html
all_shown='return { lines: document.querySelectorAll("#map .layer-shade rect").length,
  plots: document.querySelectorAll("canvas").length, rows: document.querySelectorAll("#quantities tbody tr").length,
  wider: document.documentElement.scrollWidth - innerWidth,
  parts: document.querySelectorAll("#path-picture path").length }'

for size in "400 900" "1280 1600" "2500 1400"; do
  # shellcheck disable=SC2086
  open_browser $size
  visit "$page"
  # shellcheck disable=SC2086
  layout $size
  expect "the page at ${size% *} px" "$(run "$all_shown")" '.lines > 100 and .plots > 6 and .rows > 10 and .wider <= 0 and .parts == 2'
done
look_over "$page" compare "$pictures"

open_browser 1280 1400
visit "$page"
# The map by keys, by its chooser and by its layers.
down=$(printf '\xee\x80\x95') right=$(printf '\xee\x80\x94')  # WebDriver's arrow keys, U+E015 and U+E014
reading='return { text: document.getElementById("map-reading").textContent }'
keys '#map' "$down$right$right"
expect "the map by keys" "$(run "$reading")" '.text | test("°, .* R: A .*, B ")'
before=$(run "$reading")
click '#map-of option:nth-child(2)'
expect "another map" "$(jq -n --argjson a "$before" --argjson b "$(run "$reading")" '{ changed: ($a != $b) }')" '.changed'
click '#map-z'
expect "the map in standard errors" "$(run 'return { text: document.querySelector("#map .scale").textContent }')" '.text | test("se")'
expect "velocities as arrows" "$(run 'return { arrows: document.querySelector("#map > .arrows").getAttribute("d").length }')" '.arrows > 1000'
hidden='const of = s => [...document.querySelectorAll(s)].filter(e => getComputedStyle(e).display == "none").length;
  return { arrows: of(".pictures .arrows"), path: of("#map .path") }'
expect "layers at first" "$(run "$hidden")" '.arrows == 0 and .path > 0'
click '[data-layer=arrows]'
click '[data-layer=path]'
expect "layers after clicks" "$(run "$hidden")" '.arrows == 2 and .path == 0'
picture layers
# A line of a plot by its name in the legend, by mouse and by keys.
off='return { off: document.querySelectorAll(".u-legend .u-off").length }'
click '.u-legend .u-series:nth-child(2) th'
expect "a line hidden by click" "$(run "$off")" '.off == 1'
keys '.u-legend .u-series:nth-child(2) th' ' '
expect "and shown by a key" "$(run "$off")" '.off == 0'
# Paths: both choosers keep the same rank.
click '#path-a option:nth-child(1)'
expect "paths" "$(run 'return { a: document.getElementById("path-a").value, b: document.getElementById("path-b").value }')" '.a == "0" and .b == "0"'
# Films in step.
films='const done = arguments[0], all = [...document.querySelectorAll("video")], slider = document.getElementById("film-time");
  const ready = () => all.every(v => v.readyState >= 2);
  const seen = v => { const c = document.createElement("canvas"); c.width = v.videoWidth; c.height = v.videoHeight;
    const g = c.getContext("2d"); g.drawImage(v, 0, 0); const p = g.getImageData(0, 0, c.width, c.height).data;
    let n = 0, s = 0, q = 0; for (let i = 1; i < p.length; i += 4) { n++; s += p[i]; q += p[i] * p[i]; }
    return Math.sqrt(q / n - s * s / n / n); };
  const look = () => {
    slider.value = 500; slider.dispatchEvent(new Event("input"));
    setTimeout(() => {
      const slid = all.map(v => v.currentTime / v.duration), spread = all.map(seen);
      document.getElementById("film-play").click();
      setTimeout(() => {
        const times = all.map(v => v.currentTime), playing = all.every(v => !v.paused);
        document.getElementById("film-play").click();
        done({ films: all.length, slid, spread, playing, apart: Math.abs(times[0] - times[1]), paused: all.every(v => v.paused) });
      }, 1500);
    }, 1000);
  };
  const wait = () => ready() ? look() : setTimeout(wait, 100); wait();'
expect "films" "$(run_async "$films")" '.films == 2 and (.slid | all(. > 0.4 and . < 0.6)) and (.spread | all(. > 10)) and .playing and .paused and .apart < 0.15'
keys '#film-play' '.'
expect "a picture on by key" "$(run 'return [...document.querySelectorAll("video")].map(v => v.currentTime)')" '(.[0] - .[1]) * (.[0] - .[1]) < 0.01'
expect "the console after all that" "$(console)" 'length == 0'
# Nothing comes from elsewhere.
expect "what the page asked for" "$(run 'return performance.getEntriesByType("resource").map(e => e.name).filter(n => !n.startsWith("data:") && !n.startsWith("blob:"))')" 'length == 0'

pdf "$work/page.pdf"
expect "on paper" "{ \"pages\": $(grep -aoE '/Type ?/Page\b' "$work/page.pdf" | wc -l) }" '.pages >= 3 and .pages <= 14'
if [ -n "$pictures" ]; then cp "$work/page.pdf" "$pictures/"; fi

open_browser 1280 1600 dark
visit "$page"
expect "in the dark" "$(run 'return { back: getComputedStyle(document.documentElement).backgroundColor }')" '.back == "rgb(22, 24, 27)"'
picture dark
echo "the page of compare is as it should be"
