"""Draws the picture of docs/techniques/volume.md: `python docs/images/volumes.py`.

volume.png    above, a hillside; below, its artefacts: draw order lost by groups="colors", and arcs as chords
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image
from shapely import LineString, box

import decalgl as dg

FOLDER = Path(__file__).resolve().parent
ABOVE, BELOW = (918, 360), (225, 225)
GAP = 6


def hills() -> dg.Terrain:
    """1 km of hills."""
    x, y = np.meshgrid(np.linspace(0.0, 7.0, 101), np.linspace(0.0, 7.0, 101))
    return dg.Terrain((60.0 * np.sin(x) * np.cos(0.8 * y)).astype(np.float32), 0.0, 1000.0, 10.0, 10.0)


def hillside() -> dg.Frame:
    """Fields and a road, four samples a pixel."""
    scene = dg.Scene(hills())
    volume = dg.Volume()
    fields = [box(80 * i, 80 * j, 80 * i + 80, 80 * j + 80) for i in range(1, 11) for j in range(1, 11)]
    tints = ["#8fb573", "#c9c06a", "#a9c98a", "#d8a85f"]
    scene.add_polygons(fields, color=[tints[(3 * i + i // 10) % 4] for i in range(100)], technique=volume)
    t = np.linspace(0.0, 1.0, 60)
    road = LineString(np.column_stack([40 + 920 * t, 500 + 260 * np.sin(9 * t)]))
    scene.add_lines([road], width=14, width_units="m", color="#7a2e2e", technique=volume)
    scene.add_lines([road], width=6, width_units="m", color="white", technique=volume)
    return scene.render(
        dg.Camera.orbit((500.0, 500.0, 0.0), 950.0, 200.0, 28.0), size=ABOVE, antialias="ssaa"
    )


def bars(groups: str) -> dg.Frame:
    """Bars of two colours in turn, each over those before it."""
    scene = dg.Scene(dg.Terrain.flat((0.0, 0.0, 100.0, 100.0)))
    shapes = [box(8 + 9 * i, 15, 28 + 9 * i, 85) for i in range(8)]
    technique = dg.Volume(groups=groups)  # type: ignore[arg-type]
    scene.add_polygons(shapes, color=["#c8553d", "#2d6a8e"] * 4, technique=technique)
    return scene.render(dg.Camera.top_down((0.0, 0.0, 100.0, 100.0)), size=BELOW, antialias="ssaa")


def arc(step: float) -> dg.Frame:
    """A wide corner."""
    scene = dg.Scene(dg.Terrain.flat((0.0, 0.0, 100.0, 100.0)))
    bend = LineString([(25, 20), (50, 70), (75, 20)])
    technique = dg.Volume(arc_step=step)
    scene.add_lines([bend], width=34, width_units="m", color="#4a6b3a", technique=technique)
    return scene.render(dg.Camera.top_down((0.0, 0.0, 100.0, 100.0)), size=BELOW, antialias="ssaa")


def main() -> None:
    sheet = np.full((ABOVE[1] + GAP + BELOW[1], ABOVE[0], 3), 255, dtype=np.uint8)
    sheet[: ABOVE[1]] = hillside().image[..., :3]
    for i, frame in enumerate([bars("exact"), bars("colors"), arc(11.25), arc(60.0)]):
        left = i * (BELOW[0] + GAP)
        sheet[ABOVE[1] + GAP :, left : left + BELOW[0]] = frame.image[..., :3]
    Image.fromarray(sheet).save(FOLDER / "volume.png", optimize=True)


if __name__ == "__main__":
    main()
