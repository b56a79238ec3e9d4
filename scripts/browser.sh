# Headless Chromium through chromedriver, for the scripts that open a report as a reader would. Sourced; sets `work` (a
# folder that goes at the end) and gives: open_browser [WIDTH [HEIGHT]], visit URL, call METHOD PATH [JSON], run SCRIPT,
# run_async SCRIPT, keys SELECTOR TEXT, click SELECTOR, console, screenshot FILE, pdf FILE, expect WHAT JSON JQ-CONDITION.
work=$(mktemp -d)
port=$((20000 + RANDOM % 20000))
session=
driver=
leave() {
  close_browser
  kill "$driver" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap leave EXIT
HOME=$work chromedriver --port=$port --log-level=SEVERE >"$work/driver.log" 2>&1 &
driver=$!

call() {  # METHOD PATH [JSON] -> the answer's value (W3C WebDriver)
  curl -sS -X "$1" "http://127.0.0.1:$port$2" -H 'Content-Type: application/json' ${3:+-d "$3"} | jq -c .value
}
close_browser() {
  [ -z "$session" ] || call DELETE "$session" >/dev/null || true
  session=
}
open_browser() {  # [WIDTH [HEIGHT [dark]]]
  close_browser
  for _ in $(seq 50); do call GET /status >/dev/null 2>&1 && break; sleep 0.2; done
  session=/session/$(call POST /session "$(jq -n --arg profile "$work/profile" --arg size "${1:-1280},${2:-1600}" --arg dark "${3:-}" '
    { capabilities: { alwaysMatch: { "goog:loggingPrefs": { browser: "ALL" }, timeouts: { script: 60000 },
      "goog:chromeOptions": { binary: "/usr/bin/chromium", args: ([ "--headless", "--no-sandbox", "--disable-gpu",
        "--no-first-run", "--disable-quic", "--disable-background-networking", "--disable-component-update",
        "--disable-sync", "--allow-file-access-from-files", "--hide-scrollbars", "--window-size=\($size)",
        "--user-data-dir=\($profile)" ] + (if $dark == "" then [] else [ "--blink-settings=preferredColorScheme=0" ] end)) } } } }')" | jq -r .sessionId)
}
visit() { call POST "$session/url" "$(jq -n --arg url "$1" '{ url: $url }')" >/dev/null; }
run() { call POST "$session/execute/sync" "$(jq -n --arg script "$1" '{ script: $script, args: [] }')"; }
run_async() { call POST "$session/execute/async" "$(jq -n --arg script "$1" '{ script: $script, args: [] }')"; }
element() {
  call POST "$session/element" "$(jq -n --arg css "$1" '{ using: "css selector", value: $css }')" | jq -r '.[]'
}
click() { call POST "$session/element/$(element "$1")/click" '{}' >/dev/null; }
keys() { call POST "$session/element/$(element "$1")/value" "$(jq -n --arg text "$2" '{ text: $text }')" >/dev/null; }
console() { call POST "$session/se/log" '{ "type": "browser" }'; }
screenshot() { call GET "$session/screenshot" | jq -r . | base64 -d >"$1"; }
pdf() { call POST "$session/print" '{ "background": true, "page": { "width": 21, "height": 29.7 } }' | jq -r . | base64 -d >"$1"; }
# Chromium's window is never narrower than 500: the page is laid out for a width of its own.
layout() {  # WIDTH HEIGHT
  call POST "$session/goog/cdp/execute" "$(jq -n --argjson w "$1" --argjson h "$2" '{ cmd: "Emulation.setDeviceMetricsOverride",
    params: { width: $w, height: $h, deviceScaleFactor: 1, mobile: false } }')" >/dev/null
  sleep 0.5
}
# The whole page, however long.
full_screenshot() { # FILE
  call POST "$session/goog/cdp/execute" '{ "cmd": "Page.captureScreenshot", "params": { "captureBeyondViewport": true } }' |
    jq -r .data | base64 -d >"$1"
}
# Any page of ours: usable at any width, dark and light by its button and by keys, remembered, light on paper, silent.
# Pictures of it, NAME_WIDTH_THEME.png and NAME.pdf, go to FOLDER.
look_over() {  # URL NAME [FOLDER]
  # Every plot is drawn with the colours in force: its grid has them, pixel by pixel.
  local state='const root = document.documentElement, hex = getComputedStyle(root).getPropertyValue("--grid").trim().slice(1);
    const grid = [0, 2, 4].map(i => parseInt(hex.slice(i, i + 2), 16));
    const plots = [...document.querySelectorAll("canvas")].map(c => {
      const copy = document.createElement("canvas");
      copy.width = c.width;
      copy.height = c.height;
      const g = copy.getContext("2d", { willReadFrequently: true });
      g.drawImage(c, 0, 0);
      const p = g.getImageData(0, 0, c.width, c.height).data;
      let n = 0;
      for (let i = 0; i < p.length; i += 4) n += p[i] == grid[0] && p[i + 1] == grid[1] && p[i + 2] == grid[2] && p[i + 3] == 255;
      return n > 100; });
    return { theme: root.dataset.theme, paper: getComputedStyle(root).backgroundColor, plots: plots.length,
      drawn: plots.length > 0 && plots.every(p => p), pressed: document.getElementById("theme").getAttribute("aria-pressed"), wider: root.scrollWidth - innerWidth }'
  local light='.theme == "light" and .paper == "rgb(253, 252, 250)" and .pressed == "false" and .drawn and .wider <= 0'
  local dark='.theme == "dark" and .paper == "rgb(22, 24, 27)" and .pressed == "true" and .drawn and .wider <= 0'
  local width height
  for size in "400 900" "1280 1400" "2500 1400"; do
    read -r width height <<<"$size"
    open_browser "$width" "$height"
    visit "$1"
    layout "$width" "$height"
    expect "$2 at $width px" "$(run "$state")" "$light"
    if [ -n "${3:-}" ]; then full_screenshot "$3/$2_${width}_light.png"; fi
    click '#theme'
    sleep 0.2
    expect "$2 at $width px, dark" "$(run "$state")" "$dark"
    if [ -n "${3:-}" ]; then full_screenshot "$3/$2_${width}_dark.png"; fi
    visit "$1"
    expect "$2, remembered" "$(run "$state")" '.theme == "dark"'
    run 'localStorage.clear()' >/dev/null
    expect "the console of $2 at $width px" "$(console)" 'length == 0'
  done
  expect "$2 for the printer" "$(run_async "const done = arguments[0], state = () => { $state };
    dispatchEvent(new Event('beforeprint'));
    setTimeout(() => { const on = state(); dispatchEvent(new Event('afterprint')); setTimeout(() => done({ on, after: state() }), 100); }, 100);")" \
    '.on.theme == "light" and .on.drawn and .after.theme == "dark" and .after.drawn'
  pdf "$work/page.pdf"
  if [ -n "${3:-}" ]; then cp "$work/page.pdf" "$3/$2.pdf"; fi

  # By keys alone: the first stop skips to the results, the second is the button; a plot reads and zooms.
  open_browser 1280 1400
  visit "$1"
  local tab=$'\xee\x80\x84' right=$'\xee\x80\x94' enter=$'\xee\x80\x87'  # WebDriver's keys, U+E004, U+E014, U+E007
  keys body "$tab"
  expect "$2's first stop" "$(run 'return { at: document.activeElement.className, seen: document.activeElement.getBoundingClientRect().top >= 0 }')" '.at == "skip" and .seen'
  keys .skip "$tab"
  keys '#theme' "$enter"
  expect "$2, dark by keys" "$(run "$state")" '.theme == "dark"'
  local values='return { value: document.querySelector(".u-legend .u-series .u-value").textContent }'
  keys .plot "$right"
  expect "$2's first plot by keys" "$(run "$values")" '.value | test("[0-9]")'
  keys .plot '+'
  keys .plot '0'
  expect "$2's stops" "$(run 'return { bare: [...document.querySelectorAll("a, button, input, select, summary, video[controls], .plot, .map, .scroll")].filter(e => e.tabIndex < 0 && e.id != "content").length }')" '.bare == 0'
  run 'localStorage.clear()' >/dev/null
  # In a sandbox, as some mail programs show it, storage is refused: the button works all the same, without a word.
  echo "<iframe sandbox='allow-scripts' width=900 height=800 src='$1'></iframe>" >"$work/sandbox.html"
  visit "file://$work/sandbox.html"
  call POST "$session/frame" '{ "id": 0 }' >/dev/null
  click '#theme'
  expect "$2 in a sandbox" "$(run 'return { theme: document.documentElement.dataset.theme }')" '.theme == "dark"'
  call POST "$session/frame" '{ "id": null }' >/dev/null
  expect "the console of $2 in the end" "$(console)" 'length == 0'
}
expect() {  # WHAT JSON JQ-CONDITION
  echo "$1 in Chromium: $2"
  jq -e "$3" <<<"$2" >/dev/null || { echo "$1: not as it should be; expected $3" >&2; exit 1; }
}
