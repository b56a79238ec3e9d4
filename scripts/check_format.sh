#!/usr/bin/env bash
# Fails where a source is not as clang-format would have it.
set -euo pipefail
cd "$(dirname "$0")/.."
find analysis cli core diagnose io render sim tests -name '*.h' -o -name '*.cpp' | xargs clang-format --dry-run --Werror
