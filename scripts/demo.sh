#!/usr/bin/env bash
# From a fresh Debian 12 to a mill: installs what is needed, builds, and runs the main job on a bundled example.
#   scripts/demo.sh [OUTPUT_FOLDER]     default: out/demo
set -euo pipefail
cd "$(dirname "$0")/.."
output=${1:-out/demo}

scripts/setup.sh
cmake --preset release -DTUMBLE_TESTS=OFF -DTUMBLE_WARNINGS_AS_ERRORS=OFF >/dev/null
cmake --build --preset release --target tumble
mkdir -p "$(dirname "$output")"
build/release/cli/tumble run examples/lab_mill_55cm.toml -o "$output" --force
echo "
A mill of 0.545 m, 8 revolutions at 0.7 of critical speed. Look at
  $output/report.html   open it in a browser: film, charge profile, torque
  $output/film.mp4      the animation
  $output/run.h5        every frame, with torque, power and energies
  $output/motion.h5     what the analyser found in the film"
