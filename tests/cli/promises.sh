# What the scripts beside this one share: a folder of their own, failures that are counted, commands that must succeed or
# be refused with one line. Sourced with the script's own arguments: TUMBLE_BINARY SOURCE_FOLDER.
set -uo pipefail
tumble=$(realpath "$1")
source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0
fail() { failures=$((failures + 1)); echo "FAILED: $*"; }
done_by() { "$tumble" "$@" --quiet >out.txt 2>err.txt || fail "$* : $(head -c 300 err.txt)"; }
refused() {  # PATTERN COMMAND...
  "$tumble" "${@:2}" --quiet >out.txt 2>err.txt
  local status=$?
  [ $status -eq 2 ] && [ "$(wc -l <err.txt)" -eq 1 ] && grep -q -- "$1" err.txt ||
    fail "${*:2} : expected one line with \"$1\" and status 2, got $status: $(head -c 300 err.txt)"
}
