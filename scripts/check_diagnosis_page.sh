#!/usr/bin/env bash
# Uses reports of made-up diagnoses (bench/diagnosis_pages) in headless Chromium as a reader would: narrow and wide, dark and
# light, on paper, by mouse and by keys. Maps must be drawn, nothing may be wider than the window, the console stays silent.
#   scripts/check_diagnosis_page.sh [FOLDER for pictures [FILM.mp4 to show in them]]
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/browser.sh

pictures=${1:-}
if [ -n "$pictures" ]; then mkdir -p "$pictures"; fi
mkdir "$work/pages"
build/release/bench/diagnosis_pages "$work/pages" ${2:+--film "$2"}

# Every kind: its title and its parts, as wide as the window and no wider.
parts='const shown = s => document.querySelectorAll(s).length;
  return { title: document.querySelector("h1").textContent, maps: shown(".map-button"), drawn: shown(".map-button svg:has(path)"),
    bars: shown(".ranking .bar"), gaps: shown(".gaps .dot.before"), plots: shown("canvas"), added: shown(".lines ins"), next: shown(".next"),
    wider: document.documentElement.scrollWidth - innerWidth }'
open_browser 1280 1400
check() {  # KIND JQ-CONDITION
  local size
  for size in "400 900" "1280 1400" "2500 1400"; do
    # shellcheck disable=SC2086
    layout $size
    visit "file://$work/pages/$1.html"
    expect "$1 at ${size% *} px" "$(run "$parts")" "(.title | length > 10) and .wider <= 0 and (.drawn == 2 * .maps or .drawn == .maps and .added == 0) and $2"
    if [ -n "$pictures" ]; then full_screenshot "$pictures/$1_${size% *}.png"; fi
  done
  expect "the console of $1" "$(console)" 'length == 0'
}
check missing_effect '.maps == 30 and .gaps == 5 and .plots >= 5 and .added >= 2 and .next == 0'
check mixture '.maps == 30 and .added >= 4'
check artefact '.maps == 30 and .added >= 2'
check agreement '.maps == 30 and .drawn == 30 and .added == 0'
check unknown '.maps == 30 and .added == 0 and .next == 1'
check ambiguous '.maps == 0 and .added >= 2 and .next == 1'
check power_only '.maps == 0 and .gaps == 13 and .plots == 3'
check bare '.maps == 0 and .bars == 1'

open_browser 1280 1400
visit "file://$work/pages/mixture.html"
# The large maps: of the choice, by pointer and by keys, in pockets too.
expect "the map that shows most" "$(run 'return { text: document.getElementById("map-title").textContent }')" '.text | test("^Pockets")'
down=$(printf '\xee\x80\x95') right=$(printf '\xee\x80\x94')  # WebDriver's arrow keys, U+E015 and U+E014
reading='return { text: document.getElementById("map-reading").textContent, marked: document.querySelectorAll(".maps .cursor").length }'
keys '.maps svg' "$right"
expect "a pocket by keys" "$(run "$reading")" '.marked == 2 and (.text | test("^lifter [0-9]+: measured .* before .* z = .* after .* z = "))'
click '.map-button[data-map="0"]'
expect "another map" "$(run 'return { text: document.getElementById("map-title").textContent, pressed: document.querySelectorAll(".map-button[aria-pressed=true]").length }')" \
  '(.text | test("^Occupancy, J35-50")) and .pressed == 1'
keys '.maps svg' "$down$down$right"
expect "a cell by keys" "$(run "$reading")" '.marked == 2 and (.text | test("^[0-9]+°, 0[.][0-9]+ R: measured "))'
expect "what the page asked for" "$(run 'return performance.getEntriesByType("resource").map(e => e.name).filter(n => !n.startsWith("data:") && !n.startsWith("blob:"))')" 'length == 0'

look_over "file://$work/pages/missing_effect.html" diagnosis "$pictures"
echo "the pages of diagnoses are as they should be"
