#!/usr/bin/env bash
# Fails where clang-tidy (.clang-tidy) finds something in a source file. Needs clang-tidy and a configured
# build/release; slow, so it is not part of .ci/run.
#   scripts/check_tidy.sh [ROOM_OR_FILE ...]    default: every room
set -euo pipefail
cd "$(dirname "$0")/.."
build=${TUMBLE_BUILD:-build/release}
[ -e "$build/compile_commands.json" ] || cmake --preset release >/dev/null
git ls-files -- "${@:-.}" | grep '\.cpp$' | grep -v '^tests/' |
  xargs -P "$(nproc)" -n 1 clang-tidy-14 -p "$build" --quiet 2> >(grep -v 'warnings generated\|warnings treated' >&2)
