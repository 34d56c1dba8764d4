#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Compiles the scenes to one file, out/live.html, that opens from disk: WebAssembly by Debian's
# emscripten, of Bullet's sources from Debian, in the replay page. Installs what is missing; what it
# makes on the way is in build/live, and only what has changed is made again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
root=$(cd ../.. && pwd)
work=$root/build/live
mkdir -p "$work" out

packages=(emscripten node-acorn libeigen3-dev nlohmann-json3-dev make npm)
if ! dpkg -s emscripten node-acorn libeigen3-dev nlohmann-json3-dev make >/dev/null 2>&1 || ! command -v npm >/dev/null; then
    sudo=()
    [ "$(id -u)" -eq 0 ] || sudo=(sudo)
    "${sudo[@]}" apt-get update -qq
    "${sudo[@]}" apt-get install -y -qq --no-install-recommends "${packages[@]}"
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

# these headers alone: the machine's other ones are not for WebAssembly
mkdir -p "$work/include" "$work/page"
ln -sfn /usr/include/eigen3/Eigen "$work/include/Eigen"
ln -sfn /usr/include/nlohmann "$work/include/nlohmann"
make -C "$work" -f "$root/examples/live/Makefile" --no-print-directory ROOT="$root" BULLET="$bullet" \
    -j"${JOBS:-$(nproc)}" live.js

page=$root/examples/replay/page
cp -r "$page/package.json" "$page/package-lock.json" "$page/build.mjs" "$page/src" "$work/page"
cmp -s "$page/package-lock.json" "$work/page/node_modules/of.json" || {
    npm ci --prefix "$work/page" --no-audit --no-fund --ignore-scripts --loglevel=error
    cp "$page/package-lock.json" "$work/page/node_modules/of.json"
}
npm run --silent --prefix "$work/page" build -- "$work/replay.html"
node page.mjs "$work" out/live.html
