#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs what is missing, builds, runs the Charpy test on every engine, prints the table and leaves the
# plots, and the table of all methods beside the published figures, in examples/charpy/out. Then every
# scene, in both engines, with its replay in examples/scenes/out.
#   examples/run.sh [OPTIONS OF charpy]     with options: that run only, as `charpy --help` says
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cmake/install-packages.sh
cmake --preset release >/dev/null
cmake --build --preset release --target charpy charpy-bullet-double charpy-bullet-float charpy-ode-double scenes
if [ $# -gt 0 ]; then
    exec build/release/bin/charpy "$@"
fi
out=examples/charpy/out
mkdir -p "$out"
build/release/bin/charpy --table "$out" >/dev/null
build/release/bin/charpy --json "$out/results.json" | tee "$out/table.txt"
build/release/bin/charpy --frame 0.0001 --csv "$out/history.csv" --plots "$out" >/dev/null
build/release/bin/scenes --out examples/scenes/out
