"""Draws the pictures of docs/techniques/loops.md: `python docs/images/loops.py`.

loops_orders.jpg     figure 14 of the paper: levels by two orders of removal, with heat maps of active primitives
loops_cameras.jpg    figure 13: what a fixed camera sees of the levels of one that comes closer
"""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

import decalgl as dg

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parents[1] / "examples"))

import honolulu  # noqa: E402

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[np.uint8]

SIZE = (350, 262)
FULL = dg.Detail(screen=None, uniform=0.0)
COARSE = 400.0  # metres
HOTTEST = 30.0  # primitives


class Drawer:
    """Land cover with outlines, by one order of removal."""

    def __init__(self, order: str) -> None:
        self._terrain = dg.Terrain.open(honolulu.DEM)
        scene = dg.Scene(self._terrain, relief=dg.Relief(strength=0.4, on_layers=0.5))
        outline = dg.Outline(width=14.0, width_units="m", color="#333333")
        self._layer = scene.add_polygons(
            honolulu.land_cover(),
            column="material",
            cmap=honolulu.PALETTE,
            outline=outline,
            technique=dg.Loops(order=order, bvh="fitted"),
        )
        self._renderer = dg.Renderer(size=SIZE)
        self._renderer.preprocess(scene)

    @property
    def middle(self) -> tuple[float, float]:
        """Of the terrain."""
        x0, y0, x1, y1 = self._terrain.bounds
        return (x0 + x1) / 2.0, (y0 + y1) / 2.0

    def draw(self, camera: dg.Camera, detail: dg.Detail) -> Picture:
        """The layer, or with a heat map what stands in its place."""
        self._renderer.set_picture(SIZE, "coverage" if detail.shows == "layers" else "none")
        self._renderer.restyle(
            self._layer, technique=dataclasses.replace(self._layer.technique, detail=detail)
        )
        self._renderer.update(camera)
        picture: Picture = self._renderer.render().image[..., :3]
        return picture

    def column(self, camera: dg.Camera, detail: dg.Detail) -> list[Picture]:
        """The layer, and below it how many primitives are active."""
        heat = dataclasses.replace(detail, shows="active", heat_top=HOTTEST)
        return [self.draw(camera, detail), self.draw(camera, heat)]


def draw_orders() -> None:
    """All details, two uniform levels, and a lens; two rows for each order."""
    rows: list[list[Picture]] = []
    for order in ("douglas_peucker", "wang_mueller"):
        drawer = Drawer(order)
        x, y = drawer.middle
        view = (x - 9000.0, y - 6000.0, x + 3000.0, y + 3000.0)
        lens = (x - 3000.0, y - 1500.0, 1800.0)
        details = [
            FULL,
            dg.Detail(screen=None, uniform=0.25 * COARSE),
            dg.Detail(screen=None, uniform=COARSE),
            dg.Detail(screen=None, uniform=COARSE, lens=lens),
        ]
        columns = [drawer.column(dg.Camera.top_down(view), detail) for detail in details]
        rows += [[column[row] for column in columns] for row in range(2)]
    save(rows, "loops_orders.jpg")


def draw_cameras() -> None:
    """Four distances of the first camera, whose pictures would all look alike, as the second camera sees them."""
    drawer = Drawer("douglas_peucker")
    x, y = drawer.middle
    target = (x - 3000.0, y - 1500.0, 100.0)
    watching = dg.Camera.orbit(target, distance=9000.0, azimuth=200.0, elevation=45.0)
    columns = []
    for distance in (1_152_000.0, 288_000.0, 72_000.0, 9000.0):
        coming = dg.Camera.orbit(target, distance=distance, azimuth=200.0, elevation=45.0)
        columns.append(drawer.column(watching, dg.Detail(screen=1.0, camera=coming)))
    save([[column[row] for column in columns] for row in range(2)], "loops_cameras.jpg")


def save(rows: list[list[Picture]], name: str) -> None:
    picture = np.vstack([np.hstack(row) for row in rows])
    Image.fromarray(picture).save(FOLDER / name, quality=84, optimize=True, progressive=True)


if __name__ == "__main__":
    draw_orders()
    draw_cameras()
