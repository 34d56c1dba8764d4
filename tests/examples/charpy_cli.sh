#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# charpy's command line: bad input gives one clear line, a non-zero exit and no file.
# Usage: charpy_cli.sh PATH_TO_CHARPY
set -u
charpy=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
passed=0
failed=0

check() { # what, condition's exit status
    if [ "$2" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $1"; fi
}

refuses() { # words the one line must contain, arguments
    local words=$1
    shift
    "$charpy" "$@" >out 2>err
    local status=$?
    [ $status -ne 0 ]; check "$*: exits non-zero" $?
    [ "$(wc -l <err)" -eq 1 ] && [ ! -s out ]; check "$*: one line, got: $(cat err out)" $?
    grep -qF -- "$words" err; check "$*: says '$words', got: $(cat err)" $?
    [ "$(ls | grep -cvE '^(out|err)$')" -eq 0 ]; check "$*: leaves nothing behind: $(ls)" $?
}

one="--engine bullet --method plastic-hinge"
refuses '--height = -0.01 m: must be finite and > 0' $one --height -0.01
refuses '--yield-stress = nan Pa: must be finite and > 0' $one --yield-stress nan
refuses '--dt = 0 s: must be finite and > 0' $one --dt 0
refuses '--dt = -0.001 s: must be finite and > 0' $one --dt -0.001
refuses '--notch = 0.012 m: must be in (0, 0.01) m' $one --notch 0.012
refuses '--hammer-thickness = -1 m' $one --hammer-thickness -1
refuses '--friction = -0.5' $one --friction -0.5
refuses '--parts = 3: must be an even number' $one --parts 3
refuses '--max-plastic-rotation = 0 rad' $one --max-plastic-rotation 0
refuses '--method: rubber not in' --engine bullet --method rubber
refuses '--engine: physx not in' --engine physx
refuses '--solver = direct: must be mlcp or si with --engine bullet' $one --solver direct
refuses '--precision = float: must be double with --engine ode' --engine ode --precision float
refuses '--method = spring2: must be rigid, spring, hinge-motor' --engine ode --method spring2
refuses '--json = /nowhere/at/all.json: cannot be written' $one --json /nowhere/at/all.json --csv good.csv
refuses '--csv = /nowhere/at/all.csv: cannot be written' $one --json good.json --csv /nowhere/at/all.csv
refuses '--json = .: is a folder' $one --json .
refuses '--yield-stress' $one --yield-stress strong
refuses '--no-such-option' $one --no-such-option

"$charpy" --engine bullet --method plastic-hinge --json out.json --csv out.csv >out 2>err
check "a good run exits with zero" $?
for key in engine solver precision method dt_s friction steps wall_s hammer_loss_J plastic_work_J \
    plastic_rotation_rad specimen_kinetic_J friction_work_J unexplained_J broken residual_max; do
    grep -q "\"$key\":" out.json; check "the JSON has $key" $?
done
[ "$(wc -l <out.csv)" -gt 100 ]; check "the history has samples" $?
"$charpy" --help | grep -q -- '--yield-stress.*\[Pa\]'; check "the help states units" $?

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
