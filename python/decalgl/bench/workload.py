"""What is measured: a terrain, its contours in several sizes, the size of the picture, and how often.

The real ground is San Francisco bay (SRTM, one arc-second), fetched from PyPI (fetch.py). A
test runs the same suites on a few hills.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from . import cameras, contours, fetch, folders

if TYPE_CHECKING:
    from pathlib import Path

    from .contours import Arrays, Say

KINDS = ("isolines", "iso-bands")
LINE_WIDTH = 6.0
LINE_COLOR = "#7a5a36"
BAND_CMAP = "terrain"


@dataclass(frozen=True)
class Size:
    """Metres between contours that give about so many segments, and the most runs that this is worth."""

    line_step: float
    band_step: float
    most_runs: int = 1000


SIZES = {"1M": Size(36.0, 76.0), "5M": Size(7.3, 14.2), "31M": Size(1.16, 2.29, most_runs=3)}


@dataclass(frozen=True)
class Workload:
    """One run of the benchmark.

    sizes: by name, from the smallest to the largest.
    middle: the name of the size at which indexes, layers and shapes are compared.
    folder: where contours are kept.
    towns: whose roads are measured; none: streets at random.
    depths: of the stacks of polygons. ring: vertices and holes of the spiked ring.
    """

    ground: dg.Terrain
    folder: Path
    sizes: dict[str, Size]
    middle: str
    say: Say
    picture: tuple[int, int] = (1920, 1080)
    runs: int = 5
    depths: tuple[int, ...] = (10, 50, 100, 500, 1000, 2000)
    ring: tuple[int, int] = (5_000_000, 10_000)
    towns: tuple[str, ...] = ("helsinki", "monaco")

    def runs_of(self, size: str) -> int:
        """How often to measure at a size."""
        return min(self.runs, self.sizes[size].most_runs)

    def contours(self, kind: str, size: str) -> Arrays:
        """The arrays of isolines or iso-bands, traced where they are not yet kept."""
        path = self.contours_path(kind, size)
        steps = self.sizes[size]
        if kind == "isolines":
            return contours.isolines(self.ground, steps.line_step, path, self.say)
        return contours.isobands(self.ground, steps.band_step, path, self.say)

    def contours_path(self, kind: str, size: str) -> Path:
        """Where the contours are kept; other samples or another step make another file."""
        rows, columns = self.ground.shape
        steps = self.sizes[size]
        step = steps.line_step if kind == "isolines" else steps.band_step
        return self.folder / f"{kind}_{rows}x{columns}_{step:g}m.npz"

    def scene(self, kind: str, size: str) -> dg.Scene:
        """The terrain under its isolines, 6 m wide, or its opaque iso-bands, coloured by height."""
        scene = dg.Scene(self.ground)
        add_contours(scene, kind, self.contours(kind, size))
        return scene

    def renderer(self, scene: dg.Scene, index: str = "grid", **options: Any) -> dg.Renderer:
        """A renderer that has prepared the scene."""
        renderer = dg.Renderer(size=self.picture, index=index, **options)
        renderer.preprocess(scene)
        return renderer

    @functools.cached_property
    def views(self) -> dict[str, dg.Camera]:
        """What every scene is drawn from; the worst view is that of the smallest isolines, for all alike."""
        smallest = self.contours("isolines", next(iter(self.sizes)))["coordinates"]
        return {**cameras.fixed_views(self.ground), "worst": cameras.worst(self.ground, smallest)}


def add_contours(scene: dg.Scene, kind: str, arrays: Arrays, **looks: Any) -> dg.Layer:
    """Adds contours as a layer. looks: keywords of the layer beside or in place of the usual ones."""
    if kind == "isolines":
        return add_lines(scene, line_table(arrays), **looks)
    rows = np.arange(len(arrays["heights"]))
    table = dg.FeatureTable(
        "polygons", arrays["coordinates"], arrays["part_offsets"], arrays["feature_offsets"], rows
    )
    return scene.add_polygons(table, column=arrays["heights"], cmap=BAND_CMAP, **looks)


def add_lines(scene: dg.Scene, table: dg.FeatureTable, **looks: Any) -> dg.Layer:
    """Adds isolines as a layer."""
    return scene.add_lines(table, **{"color": LINE_COLOR, "width": LINE_WIDTH, "width_units": "m", **looks})


def line_table(arrays: Arrays) -> dg.FeatureTable:
    """The arrays of isolines as features."""
    each = np.arange(len(arrays["offsets"]))
    return dg.FeatureTable("lines", arrays["coordinates"], arrays["offsets"], each, each[:-1])


def real_ground() -> dg.Terrain:
    """3597 x 3577 samples, warped to metres; fetched where it is missing."""
    (path,) = fetch.fetch("sf", folders.data())
    return _without_rim(dg.Terrain.open(path))


def town_file(town: str) -> Path:
    """A town's extract of OpenStreetMap, fetched where it is missing."""
    (path,) = fetch.fetch(town, folders.data())
    return path


def _without_rim(ground: dg.Terrain) -> dg.Terrain:
    """The middle of a terrain whose rim has holes since it was warped.

    Tiles with holes are drawn in full, which would make every frame several times as dear as its view asks for.
    """
    hole = np.isnan(ground.z)
    top, left = 0, 0
    bottom, right = hole.shape
    while hole[top:bottom, left:right].any():
        part = hole[top:bottom, left:right]
        shares = [side.mean() for side in (part[0], part[-1], part[:, 0], part[:, -1])]
        worst = int(np.argmax(shares))
        top, bottom = top + (worst == 0), bottom - (worst == 1)
        left, right = left + (worst == 2), right - (worst == 3)
    x0, y0 = ground.x0 + left * ground.dx, ground.y0 - top * ground.dy
    return dg.Terrain(ground.z[top:bottom, left:right], x0, y0, ground.dx, ground.dy, ground.crs)
