#!/usr/bin/env bash
# Fails where a tracked source is not as clang-format would have it.
set -euo pipefail
cd "$(dirname "$0")/.."
git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
