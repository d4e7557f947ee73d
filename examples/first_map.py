"""A map from nothing but arrays: a hill of NumPy, a lake and a path of shapely.

python examples/first_map.py [--out first_map.png]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import shapely

import decalgl as dg


def hill(size: int = 201, step: float = 10.0) -> dg.Terrain:
    """A hill of 400 m in the middle of a square of 2 km; the transform is rasterio's, as six numbers."""
    offset = (np.arange(size) - size // 2) * step
    distance = np.hypot(offset[None, :], offset[:, None])
    heights = 400.0 * np.exp(-((distance / 450.0) ** 2))
    half = size * step / 2
    return dg.Terrain.from_array(heights, transform=(step, 0.0, -half, 0.0, -step, half))


def main() -> None:
    parser = argparse.ArgumentParser(description="Draw a hill, a lake and a path.")
    parser.add_argument("--out", type=Path, default=Path("first_map.png"))
    out = parser.parse_args().out

    scene = dg.Scene(hill())
    lake = shapely.Point(-500, -450).buffer(180)
    scene.add_polygons([lake], color="#7fb2d1")

    turn = np.linspace(0.0, 6.0 * np.pi, 400)  # three times around the hill, up to its top
    radius = np.linspace(800.0, 20.0, 400)
    path = shapely.LineString(np.column_stack([radius * np.cos(turn), radius * np.sin(turn)]))
    scene.add_lines([path], color="crimson", width=12, width_units="m")

    camera = dg.Camera.orbit(target=(0, 0, 100), distance=2200, azimuth=200, elevation=35)
    scene.render(camera, size=(960, 540), antialias="coverage").save(out)
    print(out)


if __name__ == "__main__":
    main()
