#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Compiles the page of live.cpp to one file, out/live.html, that opens from disk: WebAssembly by
# Debian's emscripten, of Bullet's sources from Debian. Installs what is missing; what it makes on the
# way is in build/live. Three minutes, half a minute where only the page changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
root=$(cd ../.. && pwd)
work=$root/build/live
mkdir -p "$work" out

if ! command -v em++ >/dev/null || ! dpkg -s node-acorn libeigen3-dev >/dev/null 2>&1; then
    sudo=()
    [ "$(id -u)" -eq 0 ] || sudo=(sudo)
    "${sudo[@]}" apt-get update -qq
    "${sudo[@]}" apt-get install -y -qq --no-install-recommends emscripten node-acorn libeigen3-dev
fi
# Node.js that is not Debian's does not look where Debian has emscripten's modules
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}

if ! compgen -G "$work/bullet3-*/src" >/dev/null; then
    # the sources of Debian's own archives, by lists of our own: the machine's stay as they are
    mkdir -p "$work/apt/parts" "$work/apt/lists/partial"
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
        [ -f "$list" ] && grep -q 'debian\.org/debian\|/debian ' "$list" || continue
        name=$(basename "$list")
        if [[ $name == *.sources ]]; then
            sed 's/^Types:.*/Types: deb-src/' "$list" >"$work/apt/parts/$name"
        else
            sed -n 's/^deb /deb-src /p' "$list" | grep -E 'debian\.org/debian|/debian ' >"$work/apt/parts/${name%.list}.list"
        fi
    done
    apt=(apt-get -qq -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$work/apt/parts"
        -o "Dir::State::Lists=$work/apt/lists" -o APT::Sandbox::User=root)
    "${apt[@]}" update
    (cd "$work" && "${apt[@]}" source --download-only bullet && tar xf bullet_*.orig.tar.*)
fi
bullet=$(echo "$work"/bullet3-*/src)

flags=(-O2 -fexceptions -DBT_USE_DOUBLE_PRECISION)
objects=()
for part in btLinearMathAll btBulletCollisionAll btBulletDynamicsAll; do
    object=$work/$part.o
    objects+=("$object")
    [ -s "$object" ] && continue
    echo "Bullet: $part"
    em++ -std=c++17 -w "${flags[@]}" -I"$bullet" -c "$bullet/$part.cpp" -o "$object.part"
    mv "$object.part" "$object"
done
echo "live.cpp"
em++ -std=c++20 "${flags[@]}" -Wall -Wextra -I"$root/include" -I"$root/adapters/bullet/include" \
    -isystem "$bullet" -isystem /usr/include/eigen3 -c live.cpp -o "$work/live.o"
em++ "${flags[@]}" "$work/live.o" "${objects[@]}" -o "$work/live.js" -sMODULARIZE=1 -sEXPORT_NAME=makeLive \
    -sSINGLE_FILE=1 -sALLOW_MEMORY_GROWTH=1 -sENVIRONMENT=web \
    -sEXPORTED_FUNCTIONS=_live_wish,_live_start,_live_step,_live_state \
    -sEXPORTED_RUNTIME_METHODS=UTF8ToString,HEAPF64
awk -v made="$work/live.js" '/<!--script-->/ {
    print "<script>"
    while ((getline line < made) > 0) print line
    while ((getline line < "page.js") > 0) print line
    print "</script>"
    next
} { print }' page.html >"$work/live.html"
mv "$work/live.html" out/live.html
echo "open examples/live/out/live.html ($(($(stat -c %s out/live.html) / 1000)) kB)"
