#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs what is missing, builds the benchmarks, runs them with progress and time left, stores the
# results with the machine they are of, and draws them.
#   bench/run.sh [--quick] [--name NAME | --out FOLDER]     results in bench/results/NAME or in FOLDER
# NAME: default the processor's name, with -quick where quick. --quick takes five minutes on two idle
# cores, the full run up to an hour. Redraw stored results with bench/plot.py bench/results/NAME;
# it and bench/compare.py read tables packed with gzip, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
quick=()
name=
out=
while [ $# -gt 0 ]; do
    case $1 in
        --quick) quick=(--quick) ;;
        --name | --out)
            [ $# -ge 2 ] || { echo "$1: a name is missing" >&2; exit 2; }
            if [ "$1" = --name ]; then name=$2; else out=$2; fi
            shift
            ;;
        *) echo "usage: bench/run.sh [--quick] [--name NAME | --out FOLDER]" >&2; exit 2 ;;
    esac
    shift
done
if [ -z "$name" ]; then
    name=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -1 | tr '[:upper:] ' '[:lower:]-' |
        tr -cd 'a-z0-9-')
    name=${name:-machine}${quick:+-quick}
fi

cmake/install-packages.sh
cmake --preset release -DDUCTILE_BENCH=ON >/dev/null
cmake --build --preset release --target \
    {pareto,scaling,joint_cost,structures,detail,instructions}-{bullet-double,bullet-float,ode-double} \
    {frames,members}-{bullet-double,bullet-float}
out=${out:-bench/results/$name}
mkdir -p "$out"
# the interpreter for which Debian packages matplotlib
for question in frames detail pareto cost instructions members; do
    /usr/bin/python3 bench/$question.py --bin build/release/bin --build build/release --out "$out" \
        ${quick[@]+"${quick[@]}"}
done
/usr/bin/python3 bench/plot.py "$out"
