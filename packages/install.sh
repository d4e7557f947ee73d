#!/bin/bash
# Installs the packages of debian.txt that are missing; where it may not, it says how to.
set -euo pipefail

list="$(dirname "$0")/debian.txt"
missing=()
while read -r package; do
    if ! dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed; then
        missing+=("$package")
    fi
done < <(sed 's/#.*//; /^[[:space:]]*$/d' "$list")

if ((${#missing[@]} == 0)); then
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
        echo "These Debian packages are missing, and installing them needs root. Run this, then make again:" >&2
        echo "    sudo apt-get update && sudo apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo -n)
fi

echo "Installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
