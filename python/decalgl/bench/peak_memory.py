"""How much memory preparing takes at its peak: python -m decalgl.bench.peak_memory KIND FILE XMIN YMIN XMAX YMAX

Run by the suite `memory`. The process's peak is set back before the layers are prepared, on level ground, so
that what is seen is theirs alone: their index, and all that is held while it is made.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

import decalgl as dg

from .workload import add_contours

STATUS = Path("/proc/self/status")


def main() -> None:
    kind, path, *bounds = sys.argv[1:]
    west, south, east, north = map(float, bounds)
    scene = dg.Scene(dg.Terrain.flat((west, south, east, north)))
    with np.load(path) as stored:
        add_contours(scene, kind, dict(stored))
    table = scene.layers[0].features
    renderer = dg.Renderer()
    Path("/proc/self/clear_refs").write_text("5")  # the peak is what is held now
    before = of_process("VmRSS")
    renderer.preprocess(scene)
    peak = of_process("VmHWM") - before
    held = table.coords.nbytes + table.part_offsets.nbytes + table.feature_offsets.nbytes
    print(json.dumps({"peak_bytes": peak, "input_bytes": held}))


def of_process(name: str) -> int:
    """Bytes that this process holds (VmRSS), or held at its peak (VmHWM)."""
    lines = STATUS.read_text().splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith(f"{name}:"))


if __name__ == "__main__":
    main()
