"""Scenes that combine styles, ground and camera freely: a level of each factor makes one (`FACTORS`).

Each has polygons with a hole below lines that cross them, themselves and one another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

import decalgl as dg
from covering import pair
from decalgl.strokes import Hatch, StrokeStyle
from scenes import View
from shapes import circle, flat_terrain, star, tints, uneven_terrain, walk
from styled import BANDS, BROWN, GREY, TEAL, dashes, fill, stroke, styled

if TYPE_CHECKING:
    from collections.abc import Mapping

    from decalgl.strokes import Stroke

FACTORS = {
    "index": ("grid", "bvh", "thoeny"),
    "antialias": ("none", "coverage", "thoeny", "msaa", "ssaa", "fxaa"),
    "terrain": ("flat", "slope", "rugged"),
    "camera": ("above", "oblique", "far", "orthographic"),
    "corner": ("round", "miter", "bevel"),
    "cap": ("round", "butt", "square"),
    "pattern": ("none", "dashes", "arrows"),
    "bands": ("none", "bands"),
    "casing": ("none", "casing"),
    "outline": ("none", "normal", "inset", "offset"),
    "outline_order": ("layer", "feature"),
    "hatch": ("none", "parallel", "crossed"),
    "alpha": ("opaque", "translucent"),
    "order": ("feature", "size", "own"),
    "slope": ("none", "thoeny", "tangent"),
    "width": ("one", "each"),
    "color": ("one", "each"),
}
# Where there is no outline, it has no order.
EXCLUDED = frozenset({pair("outline", "none", "outline_order", "feature")})
SIZE = (160, 120)
HALF = 100.0  # metres of the ground
LINES, POLYGONS = 12, 8
PATTERNS = {
    "none": None,
    "dashes": dashes(11.3, (0.0, 6.9), (8.3, 10.1), offset=1.7),
    "arrows": dashes(13.1, (0.0, 8.2, 0.4, 0.4), (8.2, 13.1, 1.0, 0.0)),
}
HATCHES = {"none": None, "parallel": Hatch(7.1, 2.9, 30.0), "crossed": Hatch(9.3, 2.3, 50.0, True)}


def combined(row: Mapping[str, str]) -> View:
    """The scene of a row of factors and its view; index and antialias are left to the renderer."""
    scene = dg.Scene(_terrain(row["terrain"]))
    order: Any = row["order"] if row["order"] != "own" else None
    generator = np.random.default_rng(5)
    places = np.stack([np.tile([-57.3, -19.1, 20.3, 58.7], 2), np.repeat([-24.7, 26.1], 4)], axis=1)
    rings = [
        [circle(x, y, 15.0 + i, 7, 0.2 * i), circle(x - 4.3, y + 2.1, 5.0, 4, 0.5)]
        for i, (x, y) in enumerate(places.tolist())
    ]
    styled(
        scene,
        "polygons",
        rings,
        fill=fill(POLYGONS, _tints(row, POLYGONS, 51), [HATCHES[row["hatch"]]]),
        stroke=None if row["outline"] == "none" else _stroke(row, POLYGONS, 3.1, 52),
        outline_mode="normal" if row["outline"] == "none" else row["outline"],
        outline_order=row["outline_order"],
        order=generator.permutation(POLYGONS) if order is None else order,
    )
    lines = [[walk(generator, generator.uniform(-60, 60, 2) * (1, 0.7), 9.13, 12)] for _ in range(LINES - 2)]
    lines += [[star(x, 4.0, 21.0, 7, 0.2)] for x in (-41.0, 33.0)]
    styled(
        scene,
        "lines",
        lines,
        stroke=_stroke(row, LINES, 4.7, 53),
        casing=_stroke(row, LINES, 8.3, 54) if row["casing"] == "casing" else None,
        order=generator.permutation(LINES) if order is None else order,
    )
    return View(scene, _camera(row["camera"]), SIZE)


def _tints(row: Mapping[str, str], count: int, seed: int) -> Any:
    translucent = row["alpha"] == "translucent"
    if row["color"] == "each":
        return tints(count, seed, (0.3, 0.9) if translucent else 1.0)
    return (*(BROWN, GREY, TEAL)[seed % 3], 0.6 if translucent else 1.0)


def _stroke(row: Mapping[str, str], count: int, width: float, seed: int) -> Stroke:
    style = StrokeStyle(
        cast(Literal["round", "miter", "bevel"], row["corner"]),
        cast(Literal["round", "butt", "square"], row["cap"]),
        slope_correction=cast(Literal["none", "thoeny", "tangent"], row["slope"]),
        pattern=PATTERNS[row["pattern"]],
        bands=BANDS if row["bands"] == "bands" else (),
    )
    widths = width * np.linspace(0.3, 1.6, count) if row["width"] == "each" else width
    return stroke(count, widths, _tints(row, count, seed), style)


def _terrain(kind: str) -> dg.Terrain:
    if kind == "flat":
        return flat_terrain(HALF)
    if kind == "rugged":
        return uneven_terrain(HALF, 30.0, samples=17)
    east, north = np.meshgrid(np.linspace(-1.0, 1.0, 11), np.linspace(1.0, -1.0, 11))
    ground = (35.0 * east + 20.0 * north).astype(np.float32)
    return dg.Terrain(ground, -HALF, HALF, HALF / 5, HALF / 5)


def _camera(kind: str) -> dg.Camera:
    if kind == "above":
        return dg.Camera.top_down((-80.0, -60.0, 80.0, 60.0))
    if kind == "oblique":
        return dg.Camera.orbit((0.0, 0.0, 0.0), 150.0, 200.0, 35.0)
    if kind == "far":
        return dg.Camera.orbit((0.0, 0.0, 0.0), 450.0, 160.0, 55.0)
    return dg.Camera((120.0, -200.0, 160.0), (0.0, 0.0, 0.0), fov=None, view_height=120.0)
