#!/bin/bash
# Builds a wheel from scratch, installs it into an empty environment and draws a picture there.
#
#     tests/wheel/run.sh [PYTHON]
set -euo pipefail

python="${1:-python3}"
source="$(cd "$(dirname "$0")/../.." && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

export PIP_DISABLE_PIP_VERSION_CHECK=1
"$python" -m pip wheel --quiet --no-deps --wheel-dir "$scratch" "$source"
"$python" -m venv "$scratch/venv"
"$scratch/venv/bin/pip" install --quiet "$scratch"/decalgl-*.whl
cd "$scratch"
"$scratch/venv/bin/python" - <<'PYTHON'
import decalgl as dg

scene = dg.Scene(dg.Terrain.flat((0, 0, 100, 100)))
scene.add_polygons(([[20, 20], [80, 20], [80, 80], [20, 80]], [0, 4]), color="red")
frame = scene.render(dg.Camera.top_down((0, 0, 100, 100)), size=(50, 50), antialias="none")
assert tuple(frame.image[25, 25]) == (255, 0, 0, 255), frame.image[25, 25]
assert (frame.ids == 0).sum() == 900, (frame.ids == 0).sum()
print(f"decalgl {dg.__version__} draws from a wheel")
PYTHON
