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

check() { # condition's exit status, before what `$(...)` in the words would make of it; what
    if [ "$1" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $2"; fi
}

refuses() { # words the one line must contain, arguments
    local words=$1
    shift
    "$charpy" "$@" >out 2>err
    local status=$?
    [ $status -ne 0 ]; check $? "$*: exits non-zero"
    [ "$(wc -l <err)" -eq 1 ] && [ ! -s out ]; check $? "$*: one line, got: $(cat err out)"
    grep -qF -- "$words" err; check $? "$*: says '$words', got: $(cat err)"
    [ "$(ls | grep -cvE '^(out|err)$')" -eq 0 ]; check $? "$*: leaves nothing behind: $(ls)"
}

one="--engine bullet --method plastic-hinge"
refuses '--height = -0.01 m: must be finite and > 0' $one --height -0.01
refuses '--yield-stress = nan Pa: must be finite and > 0' $one --yield-stress nan
refuses '--frame = 0 s: must be finite and > 0' $one --frame 0
refuses '--frame = -0.001 s: must be finite and > 0' $one --frame -0.001
refuses '--tolerance = 0: must be finite and > 0' $one --tolerance 0
refuses '--notch = 0.012 m: must be in (0, 0.01) m' $one --notch 0.012
refuses '--hammer-thickness = -1 m' $one --hammer-thickness -1
refuses '--friction = -0.5' $one --friction -0.5
refuses '--parts = 3: must be an even number' $one --parts 3
refuses '--max-plastic-rotation = 0 rad' $one --max-plastic-rotation 0
refuses '--method: rubber not in' --engine bullet --method rubber
refuses '--engine: physx not in' --engine physx
refuses '--solver = direct: must be mlcp, island, si or nncg with --engine bullet' $one --solver direct
refuses '--solver = nncg: must be direct or quick with --engine ode' --engine ode --solver nncg
refuses '--solver: newton not in' $one --solver newton
refuses '--hammer-thickness = 0.04 m: must be in [0.002, 0.04) m' $one --hammer-thickness 0.04
refuses '--hammer-thickness = 0.025 m' $one --hammer-thickness 0.025 --draft 0.005
refuses '--hammer-thickness = 0 m' $one --hammer-thickness 0
refuses '--draft = -0.01 m: must be finite and >= 0' $one --draft -0.01
refuses '--nose-width: must be left out here' $one --draft 0 --nose-width 0.003
refuses '--nose-width = 0.03 m' $one --nose-width 0.03
refuses '--anvil-gap = 0.06 m: must be in (0, 0.055) m' $one --anvil-gap 0.06
refuses '--restitution = 1.5: must be in [0, 1]' $one --restitution 1.5
refuses '--restitution = -0.1: must be in [0, 1]' $one --restitution -0.1
refuses '--iterations = 0: must be >= 1' $one --iterations 0
refuses '--iterations: must be left out here, it acts on iterative solvers' --engine ode --iterations 50
refuses '--max-plastic-rotation: must be left out here' --method hinge-motor --max-plastic-rotation 1.5
refuses '--frame: must be left out here' --method hinge-motor --frame 0.01
refuses '--tolerance: must be left out here' --method rigid --tolerance 0.1
refuses '--youngs-modulus: must be left out here' $one --youngs-modulus 100e9
refuses '--youngs-modulus = 0 Pa: must be finite and > 0' --method elastic-plastic --youngs-modulus 0
refuses '--parts: must be left out here' --method rigid --parts 4
refuses '--ccd: maybe not in' $one --ccd maybe
refuses '--table = /dev/null/figures: cannot be made' --table /dev/null/figures
refuses '--engine: must be left out here' --engine ode --table figures
refuses '--precision = float: must be double with --engine ode' --engine ode --precision float
refuses '--json = /nowhere/at/all.json: cannot be written' $one --json /nowhere/at/all.json --csv good.csv
refuses '--csv = /nowhere/at/all.csv: cannot be written' $one --json good.json --csv /nowhere/at/all.csv
refuses '--json = .: is no regular file' $one --json .
pipes=$(mktemp -d)
mkfifo "$pipes/pipe"
refuses "--json = $pipes/pipe: is no regular file" $one --json "$pipes/pipe"
[ -p "$pipes/pipe" ]; check $? "a pipe stays one"
rm -r "$pipes"
refuses '--yield-stress' $one --yield-stress strong
refuses '--no-such-option' $one --no-such-option

"$charpy" --engine bullet --method plastic-hinge --frame 0.0001 --json out.json --csv out.csv >out 2>err
check $? "a good run exits with zero"
for key in engine solver precision method frame_s friction solves wall_s hammer_loss_J plastic_work_J \
    plastic_rotation_rad specimen_kinetic_J friction_work_J unexplained_J broken believed left_J; do
    grep -q "\"$key\":" out.json; check $? "the JSON has $key"
done
[ "$(wc -l <out.csv)" -gt 100 ]; check $? "the history has samples"
"$charpy" --engine ode --method elastic-plastic-2 --ccd on >out 2>err
check $? "a run with --ccd exits with zero"
grep -q -- '--ccd on: no effect' out; check $? "--ccd says that it has no effect"
"$charpy" --table figures >out 2>err
check $? "the table of published figures exits with zero"
for file in published.txt published.md published.csv; do
    for method in rigid zero-limits spring spring2 hinge-motor plastic-hinge elastic-plastic elastic-plastic-2; do
        [ "$(grep -cE "[ ,|]$method[ ,|]" figures/$file)" -ge 4 ]; check $? "$file has $method on every engine"
    done
done
"$charpy" --help | grep -q -- '--yield-stress.*\[Pa\]'; check $? "the help states units"

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
