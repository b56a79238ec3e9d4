#!/usr/bin/env bash
# Opens a report in headless Chromium, as a reader would from disk: the film must play (a duration, a decoded frame that
# is not blank) and the console must stay silent.
#   scripts/check_browser.sh [FOLDER of `tumble run`]    default: a short run of the paper's mill
set -euo pipefail
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ $# -ge 1 ]; then
  folder=$(realpath "$1")
else
  folder=$work/run
  build/release/cli/tumble run examples/lab_mill_55cm.toml -o "$folder" --quiet \
    --set run.spin_up=0.5 --set run.revolutions=1
fi

browse() {  # URL -> the page's DOM on standard output, console messages in $work/console
  HOME=$work chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking \
    --disable-component-update --disable-sync --disable-quic --allow-file-access-from-files \
    --user-data-dir="$work/profile" --enable-logging=stderr --virtual-time-budget="${2:-5000}" --dump-dom "$1" 2>"$work/log"
  grep 'CONSOLE' "$work/log" >"$work/console" || true
}

browse "file://$folder/report.html" >"$work/dom"
if [ -s "$work/console" ]; then
  echo "report.html: the browser's console is not silent:" >&2
  cat "$work/console" >&2
  exit 1
fi
grep -q '<video' "$work/dom" || { echo "report.html: no film in it" >&2; exit 1; }
grep -q '<canvas' "$work/dom" || { echo "report.html: no plot was drawn" >&2; exit 1; }

# Real time, not virtual: decoding takes as long as it takes. The page writes what it saw into its title.
cat >"$work/film.html" <<HTML
<video id=v muted src="file://$folder/film.mp4"></video><pre id=seen>nothing</pre><script>
const v = document.getElementById('v'), seen = document.getElementById('seen');
v.onerror = () => seen.textContent = 'error ' + v.error.message;
v.onloadeddata = () => { v.currentTime = v.duration / 2; };
v.onseeked = () => {
  const c = document.createElement('canvas'); c.width = v.videoWidth; c.height = v.videoHeight;
  const g = c.getContext('2d'); g.drawImage(v, 0, 0);
  const p = g.getImageData(0, 0, c.width, c.height).data; let n = 0, s = 0, q = 0;
  for (let i = 0; i < p.length; i += 4) { n++; s += p[i + 1]; q += p[i + 1] * p[i + 1]; }
  seen.textContent = 'duration ' + v.duration.toFixed(3) + ' size ' + c.width + 'x' + c.height +
    ' spread ' + Math.sqrt(q / n - s * s / n / n).toFixed(1);
};
</script>
HTML
browse "file://$work/film.html" 20000 >"$work/dom"
seen=$(sed -n 's/.*<pre id="seen">\([^<]*\)<.*/\1/p' "$work/dom")
echo "film.mp4 in Chromium: $seen"
[[ $seen =~ duration\ ([0-9.]+)\ size\ ([0-9]+)x([0-9]+)\ spread\ ([0-9.]+) ]] || exit 1
awk -v d="${BASH_REMATCH[1]}" -v s="${BASH_REMATCH[4]}" 'BEGIN { exit !(d > 0 && s > 10) }' || {
  echo "film.mp4: no picture in it" >&2
  exit 1
}
echo "report.html in Chromium: film and plots drawn, console silent"
