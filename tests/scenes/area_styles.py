"""Views of outlines, hatches and lines on slopes, ordinary and hostile (styles.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

import decalgl as dg
from decalgl.strokes import Hatch, StrokeStyle
from shapes import circle, nested_rings, partition, star, tints, uneven_terrain, walk
from style_views import named
from styled import (
    BANDS,
    BROWN,
    CAPS,
    CORNERS,
    GREY,
    TEAL,
    above,
    aslant,
    dashes,
    fill,
    flat_ground,
    grid,
    stroke,
    styled,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from scenes import View

    FloatArray = NDArray[np.float64]

MODES = ("normal", "inset", "offset")


# Outlines


def holed(places: FloatArray) -> list[list[FloatArray]]:
    """At each place (n, 2) a heptagon with two holes, one of them small."""
    return [
        [circle(x, y, 11.0, 7, 0.2), circle(x - 3, y + 2, 4.0, 4, 0.5), circle(x + 5, y - 3, 1.2, 5)]
        for x, y in places
    ]


@named
def outlines() -> View:
    """Every corner on every side of the rings, over translucent fills."""
    scene = flat_ground()
    places = grid(5, 3)
    for row, mode in enumerate(MODES):
        styles = [StrokeStyle(corner) for corner in CORNERS]
        styled(
            scene, "polygons", holed(places[row]), fill=fill(5, (*TEAL, 0.5)), outline_mode=mode,
            stroke=stroke(5, 1.5, tints(5, 30, 0.8), styles),
        )  # fmt: skip
    return above(scene)


@named
def wide_outlines() -> View:
    """Outlines wider than their polygons and holes."""
    scene = flat_ground()
    places = grid(5, 3)
    widths = np.array([4.0, 7.0, 9.0, 15.0, 30.0])
    for row, mode in enumerate(MODES):
        styled(
            scene, "polygons", holed(places[row]), fill=fill(5, tints(5, 31)), outline_mode=mode,
            stroke=stroke(5, widths, (*BROWN, 0.6), StrokeStyle("miter" if row != 1 else "round")),
        )  # fmt: skip
    return above(scene)


def odd_rings() -> list[list[FloatArray]]:
    """Nested rings, stars and bow ties that cross themselves, rings that overlap, touch and repeat."""
    bow_tie = np.array([(-60.0, 18.0), (-35.0, 40.0), (-35.0, 18.0), (-60.0, 40.0)])
    touching = np.array([(0.0, 18.0), (14.0, 28.0), (0.0, 38.0), (0.0, 18.0), (-14.0, 38.0), (-14.0, 22.0)])
    box = np.array([(35.13, 14.84), (55.13, 14.84), (55.13, 34.84), (35.13, 34.84)])
    return [
        nested_rings(-50.0, -18.0, 24.0, 5),
        [star(0.0, -18.0, 24.0, 7)],
        [star(50.0, -18.0, 24.0, 5, 0.3)],
        [bow_tie],
        [touching],
        [box, box + 8.0, box + 4.0, box + 4.0],
    ]


@named
def inset_odd_rings() -> View:
    """Outlines on the inside of rings that nest and cross themselves."""
    scene = flat_ground()
    styled(
        scene, "polygons", odd_rings(), fill=fill(6, (*TEAL, 0.4)), outline_mode="inset",
        stroke=stroke(6, 2.0, (0.7, 0.1, 0.1, 0.8), [StrokeStyle("miter"), StrokeStyle("bevel")]),
    )  # fmt: skip
    return above(scene)


@named
def offset_odd_rings() -> View:
    """The same on the outside, dashed, without fills."""
    scene = flat_ground()
    styles = [StrokeStyle(corner, pattern=dashes(6.0, (0.0, 4.0))) for corner in CORNERS]
    styled(scene, "polygons", odd_rings(), outline_mode="offset", stroke=stroke(6, 2.0, tints(6, 33), styles))
    return above(scene)


@named
def outline_orders() -> View:
    """Overlapping polygons in an order of their own: each outline over its own fill, or all over all."""
    scene = flat_ground()
    for x, order in ((-40.0, "layer"), (40.0, "feature")):
        places = np.array((x, 0.0)) + np.random.default_rng(34).uniform(-24, 24, (12, 2))
        styled(
            scene, "polygons", holed(places), fill=fill(12, tints(12, 35, 0.8)), outline_order=order,
            stroke=stroke(12, 2.0, (*GREY, 0.8), StrokeStyle("miter", bands=BANDS)),
            order=np.random.default_rng(36).permutation(12),
        )  # fmt: skip
    return above(scene)


@named
def outlines_of_neighbours() -> View:
    """A partition whose cells have insets, over one another's borders nothing shows."""
    scene = flat_ground()
    cells = [[np.asarray(cell.exterior.coords)[:-1]] for cell in partition((-90, -60, 90, 60), 10, 7)]
    styled(
        scene, "polygons", cells, fill=fill(70, tints(70, 37)), outline_mode="inset",
        stroke=stroke(70, 1.5, tints(70, 38)),
    )  # fmt: skip
    return aslant(scene)


# Hatches


@named
def hatches() -> View:
    """Level, upright, slanting and crossed, wide and far below a pixel."""
    scene = flat_ground()
    found: list[Hatch | None] = [
        Hatch(spacing, 0.4 * spacing, angle, crossed)
        for spacing, crossed in ((3.0, False), (5.0, True), (0.3, False))
        for angle in (0.0, 45.0, 90.0, 30.0)
    ]
    places = grid(6, 2).reshape(-1, 2)
    features = [[circle(x, y, 16.0, 9), circle(x, y, 5.0, 5)] for x, y in places]
    outline = stroke(12, 0.8, (*GREY, 1.0))
    styled(scene, "polygons", features, fill=fill(12, tints(12, 39, (0.5, 1.0)), found), stroke=outline)
    return above(scene)


@named
def hatches_aslant() -> View:
    """Hatches over even fills, seen obliquely on uneven ground."""
    scene = dg.Scene(uneven_terrain(100.0, 10.0))
    cells = [[np.asarray(cell.exterior.coords)[:-1]] for cell in partition((-90, -90, 90, 90), 6, 6)]
    found = [None, Hatch(6.0, 1.5, 30.0), Hatch(8.0, 2.0, 45.0, True)]
    styled(scene, "polygons", cells, fill=fill(36, (0.9, 0.8, 0.5)))
    styled(scene, "polygons", cells, fill=fill(36, tints(36, 40, 0.8), found))
    return aslant(scene)


# Slopes


def steep_ground() -> dg.Scene:
    return dg.Scene(uneven_terrain(100.0, 45.0, samples=17))


def on_slopes(correction: Literal["thoeny", "tangent"]) -> View:
    scene = steep_ground()
    generator = np.random.default_rng(41)
    features = [[walk(generator, generator.uniform(-70, 70, 2), 9.13, 16)] for _ in range(24)]
    styles = [
        StrokeStyle("round", "round", slope_correction=correction),
        StrokeStyle("miter", "butt", slope_correction=correction, miter_limit=30.0),
        StrokeStyle("bevel", "butt", slope_correction=correction, pattern=dashes(7.0, (0.0, 4.5))),
        StrokeStyle("round", "butt", slope_correction=correction, bands=BANDS),
    ]
    styled(scene, "lines", features, stroke=stroke(24, 5.0, tints(24, 42, (0.5, 1.0)), styles))
    cells = [
        [circle(x, y, 14.0, 7), circle(x, y, 6.0, 4)] for x in (-50.0, 0.0, 50.0) for y in (-50.0, 0.0, 50.0)
    ]
    rim = StrokeStyle("miter", slope_correction=correction)
    styled(scene, "polygons", cells, stroke=stroke(9, 2.0, (*GREY, 0.9), rim), outline_mode="inset")
    return aslant(scene, 150.0, 40.0)


@named
def tangent_slopes() -> View:
    """Strokes as wide as they are on steep ground."""
    return on_slopes("tangent")


@named
def dashes_up_slopes() -> View:
    """Patterns by lengths on steep ground: segments over many triangles, rings, and lines with lengths on the map."""
    scene = steep_ground()
    ends = np.array([(-85.0, -14.0), (-20.0, -1.0), (85.0, 16.0)])
    ways = [
        [ends[:: 1 if i % 2 else -1] + np.array([0.0, y])] for i, y in enumerate(np.linspace(-60.0, 60.0, 12))
    ]
    patterns = (dashes(9.0, (0.0, 5.0), offset=2.0), dashes(11.0, (1.0, 8.0, 1.0, 0.2)))
    styles = [
        StrokeStyle(CORNERS[i % 3], CAPS[i // 2 % 3], slope_correction=correction, pattern=patterns[i % 2])
        for i, correction in enumerate(("tangent", "tangent", "none", "tangent", "tangent", "thoeny"))
    ]
    looks = stroke(12, 4.0, tints(12, 44, 0.8), styles)
    under = stroke(12, 6.0, (*GREY, 1.0), StrokeStyle(slope_correction="tangent"))
    styled(scene, "lines", ways, stroke=looks, casing=under)
    rings = [[circle(x, y, 17.0, 4), circle(x, y, 8.0, 3)] for x in (-50.0, 0.0, 50.0) for y in (-30.0, 30.0)]
    rim = StrokeStyle("round", slope_correction="tangent", pattern=patterns[0])
    tinted = fill(6, tints(6, 45, 0.4))
    styled(scene, "polygons", rings, fill=tinted, stroke=stroke(6, 3.0, (*GREY, 0.9), rim))
    return aslant(scene, 170.0, 50.0)


@named
def strokes_along_rows() -> View:
    """Level strokes from above, along rows of samples: creases that no place on the map shows."""
    scene = steep_ground()
    ways = [[np.array([(-85.0, y), (85.0, y)])] for y in np.linspace(-60.0, 60.0, 12)]
    corrections: tuple[Literal["tangent", "none", "thoeny"], ...] = ("tangent", "none", "thoeny")
    styles = [
        StrokeStyle(corner, "butt", slope_correction=correction, pattern=dashes(9.0, (0.0, 5.0)))
        for corner, correction in zip(CORNERS, corrections, strict=True)
    ]
    under = stroke(12, 6.0, (*GREY, 1.0), StrokeStyle(slope_correction="tangent"))
    styled(scene, "lines", ways, stroke=stroke(12, 4.0, tints(12, 44, 0.8), styles), casing=under)
    return above(scene)


@named
def thoeny_slopes() -> View:
    """Strokes narrowed on steep ground as it is seen from the side."""
    return on_slopes("thoeny")


@named
def steep_miters() -> View:
    """Corners too sharp for miters on the map, which a slope of 63 degrees opens."""
    x = np.linspace(-100.0, 100.0, 21)
    ground = np.tile(2.0 * x, (21, 1)).astype(np.float32)
    scene = dg.Scene(dg.Terrain(ground, -100.0, 100.0, 10.0, 10.0))
    half = np.radians(np.linspace(11.0, 19.0, 12))
    arms = 20.0 * np.stack([np.sin(half), -np.cos(half)], axis=1)
    places = grid(6, 2).reshape(-1, 2)
    features = [
        [place + np.array([arm * (-1.0, 1.0), (0.0, 0.0), arm])]
        for place, arm in zip(places, arms, strict=True)
    ]
    style = StrokeStyle("miter", "butt", slope_correction="tangent")
    styled(scene, "lines", features, stroke=stroke(12, 6.0, tints(12, 43), style))
    return above(scene)
