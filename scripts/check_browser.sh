#!/usr/bin/env bash
# Opens a report in headless Chromium, as a reader would from disk: the film must play (a duration, a decoded frame that
# is not blank), the plots must be drawn and the console must stay silent.
#   scripts/check_browser.sh [FOLDER of `tumble run` [SCREENSHOT.png [WIDTH]]]    default: a short run of the paper's mill
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
port=$((20000 + RANDOM % 20000))
session=
leave() {
  [ -z "$session" ] || call DELETE "$session" >/dev/null || true  # ends the browser
  kill "$driver" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap leave EXIT
HOME=$work chromedriver --port=$port --log-level=SEVERE >"$work/driver.log" 2>&1 &
driver=$!

if [ $# -ge 1 ]; then
  folder=$(realpath "$1")
else
  folder=$work/run
  build/release/cli/tumble run examples/lab_mill_55cm.toml -o "$folder" --quiet \
    --set run.spin_up=0.5 --set run.revolutions=1
fi

call() {  # METHOD PATH [JSON] -> the answer's value (W3C WebDriver)
  curl -sS -X "$1" "http://127.0.0.1:$port$2" -H 'Content-Type: application/json' ${3:+-d "$3"} | jq -c .value
}
for _ in $(seq 50); do call GET /status >/dev/null 2>&1 && break; sleep 0.2; done

session=/session/$(call POST /session "$(jq -n --arg profile "$work/profile" --arg width "${3:-1280}" '
  { capabilities: { alwaysMatch: { "goog:loggingPrefs": { browser: "ALL" }, timeouts: { script: 60000 },
    "goog:chromeOptions": { binary: "/usr/bin/chromium", args: [ "--headless", "--no-sandbox", "--disable-gpu",
      "--no-first-run", "--disable-quic", "--disable-background-networking", "--disable-component-update",
      "--disable-sync", "--allow-file-access-from-files", "--window-size=\($width),1600",
      "--user-data-dir=\($profile)" ] } } } }')" | jq -r .sessionId)
visit() { call POST "$session/url" "$(jq -n --arg url "$1" '{ url: $url }')" >/dev/null; }

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
see() { call POST "$session/execute/async" "$(jq -n --arg script "$look" '{ script: $script, args: [] }')"; }
expect() {  # WHAT JSON JQ-CONDITION
  echo "$1 in Chromium: $2"
  jq -e "$3" <<<"$2" >/dev/null || { echo "$1: not as it should be; expected $3" >&2; exit 1; }
}

visit "file://$folder/report.html"
expect report.html "$(see)" '.duration > 0 and .spread > 10 and .plots > 0'
messages=$(call POST "$session/se/log" '{ "type": "browser" }')
expect "report.html's console" "$messages" 'length == 0'
if [ $# -ge 2 ]; then call GET "$session/screenshot" | jq -r . | base64 -d >"$2"; fi

echo "<video src='file://$folder/film.mp4'></video>" >"$work/film.html"
visit "file://$work/film.html"
expect film.mp4 "$(see)" '.duration > 0 and .spread > 10'
