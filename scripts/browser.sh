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
expect() {  # WHAT JSON JQ-CONDITION
  echo "$1 in Chromium: $2"
  jq -e "$3" <<<"$2" >/dev/null || { echo "$1: not as it should be; expected $3" >&2; exit 1; }
}
