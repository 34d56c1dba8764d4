#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Installs what is missing of debian-packages.txt, beside this script. Does nothing, and needs no
# network, where everything is there.
set -euo pipefail
list=$(dirname "${BASH_SOURCE[0]}")/debian-packages.txt
missing=()
while read -r package; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
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
