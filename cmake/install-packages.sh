#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs what is missing of debian-packages.txt, beside this script: what is neither a package nor a
# command that is there. Does nothing, and needs no network, where everything is.
set -euo pipefail
list=$(dirname "${BASH_SOURCE[0]}")/debian-packages.txt
missing=()
while read -r package; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    # npm, for one, comes with Node.js where that is not Debian's
    [ "$status" = installed ] || command -v "$package" >/dev/null || missing+=("$package")
done < <(grep -vE '^(#|$)' "$list")
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing: ${missing[*]}"
sudo=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "cannot install without root or sudo; needed: ${missing[*]}" >&2
        exit 1
    }
    sudo=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"
