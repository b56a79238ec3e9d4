#!/usr/bin/env bash
# Installs what is needed, builds and runs all tests.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh test
cmake --preset release -DTUMBLE_TESTS=ON -DTUMBLE_WARNINGS_AS_ERRORS=ON >/dev/null
cmake --build --preset release --target all_tests
ctest --preset release -j "$(nproc)"
scripts/check_browser.sh
scripts/check_compare_page.sh
