#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# The page of all scenes: each scene has its picture, what is doubted is said, another run keeps what it
# does not show anew, and one that is refused leaves the page as it was, or none.
# Usage: scenes_index.sh PATH_TO_SCENES
set -u
scenes=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
failed=0
check() { # what, words of a condition
    "${@:2}" || { failed=1; echo "FAILED: $1"; }
}
page=scenes/out/index.html
has() { grep -qF -- "$1" "$page"; }
hasnt() { ! has "$1"; }

"$scenes" tension --part none --out scenes/out >/dev/null 2>&1
check "a part that is not there leaves no page" [ ! -e $page ]
"$scenes" tension --out scenes/out >/dev/null
check "both engines are there" has '<section id="tension-ode">'
check "its picture" has '<a href="tension-held-bullet.html"><img src="tension.jpg"'
check "which is there" [ -s scenes/out/tension.jpg ]
check "nothing is doubted" hasnt 'does not vouch'
"$scenes" gate --engine bullet --frame 0.1 --out scenes/out >/dev/null
check "another scene is added" has '<section id="gate-bullet">'
check "it is doubted" has 'does not vouch'
check "the first stays" has 'href="tension-held-ode.html"'
cp $page before
"$scenes" gate --part none --out scenes/out >/dev/null 2>&1
check "a part that is not there leaves the page as it was" cmp -s $page before
mkdir -p charpy/out
echo 'table <of> Charpy' >charpy/out/table.txt
touch charpy/out/speed.png
"$scenes" tension --engine ode --out scenes/out >/dev/null
check "the Charpy test" has 'table &lt;of> Charpy'
check "with its plots" has '<img src="../../charpy/out/speed.png"'
check "each is there once" [ "$(grep -c '<section id="tension-ode">' $page)" -eq 1 ]
exit $failed
