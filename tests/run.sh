#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs what is missing, builds, and runs every test; then compiles every public header alone, with the
# second compiler. The benchmarks are compiled without being made (bench/run.sh makes them).
#   tests/run.sh [PRESET ...]     presets of CMakePresets.json; default: release
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cmake/install-packages.sh
for preset in "${@:-release}"; do
    echo "== $preset"
    cmake --preset "$preset" -DDUCTILE_TESTS=ON -DDUCTILE_EXAMPLES=ON -DDUCTILE_BENCH=SYNTAX >/dev/null
    cmake --build --preset "$preset"
    ctest --preset "$preset" -j "$(nproc)"
done
echo "== headers"
cmake --preset clang -DDUCTILE_TESTS=ON -DDUCTILE_EXAMPLES=OFF -DDUCTILE_BENCH=OFF >/dev/null
cmake --build --preset clang --target headers
