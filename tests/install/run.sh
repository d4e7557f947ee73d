#!/bin/bash
# Installs what a build folder holds into a fresh prefix, then builds and runs a project that finds it there.
#
#     tests/install/run.sh BUILD_FOLDER [BUILD_TYPE]
set -euo pipefail

build="$1"
type="${2:-Release}"
source="$(cd "$(dirname "$0")" && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --component development --prefix "$scratch/prefix" >/dev/null
cmake -S "$source" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE="$type"
cmake --build "$scratch/build"
"$scratch/build/consumer"
