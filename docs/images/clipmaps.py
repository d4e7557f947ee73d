"""Draws the picture of docs/techniques/clipmap.md: `python docs/images/clipmaps.py`.

clipmap.png    one view by solution 4b, by solution 1, with twelve tiles, and with one sample a pixel
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from shapely import LineString, box

import decalgl as dg

FOLDER = Path(__file__).resolve().parent
SIZE = (480, 250)
GAP = 6


def scene(**options: Any) -> dg.Scene:
    """4 km of hills with fields and roads."""
    x, y = np.meshgrid(np.linspace(0.0, 9.0, 201), np.linspace(0.0, 9.0, 201))
    result = dg.Scene(dg.Terrain((60.0 * np.sin(x) * np.cos(y)).astype(np.float32), 0.0, 4000.0, 20.0, 20.0))
    technique = dg.Clipmap(**options)
    fields = [box(200 * i, 200 * j, 200 * i + 200, 200 * j + 200) for i in range(20) for j in range(20)]
    tints = ["#b5cf9b", "#d9d3a0", "#c6dcae", "#e3c99a"]
    result.add_polygons(fields, color=[tints[(3 * i + i // 20) % 4] for i in range(400)], technique=technique)
    t = np.linspace(0.0, 4000.0, 200)
    roads = [
        LineString(np.column_stack([t, 400.0 * k + 120.0 * np.sin(t / 300.0 + k)])) for k in range(1, 10)
    ]
    roads.append(LineString([(500, 0), (900, 500), (650, 900), (1300, 1600), (1000, 2600), (2200, 4000)]))
    result.add_lines(roads, width=12, width_units="m", color="#7a2e2e", technique=technique)
    return result


def main() -> None:
    camera = dg.Camera.look_at((700.0, 100.0, 190.0), (1300.0, 1900.0, 0.0))
    cases: list[dict[str, Any]] = [{}, {"solution": "1"}, {"tiles_a_frame": 12}, {"anisotropy": 1}]
    pictures = [scene(**case).render(camera, size=SIZE, antialias="none").image[..., :3] for case in cases]
    sheet = np.full((2 * SIZE[1] + GAP, 2 * SIZE[0] + GAP, 3), 255, dtype=np.uint8)
    for i, picture in enumerate(pictures):
        row, column = divmod(i, 2)
        top, left = row * (SIZE[1] + GAP), column * (SIZE[0] + GAP)
        sheet[top : top + SIZE[1], left : left + SIZE[0]] = picture
    Image.fromarray(sheet).save(FOLDER / "clipmap.png", optimize=True)


if __name__ == "__main__":
    main()
