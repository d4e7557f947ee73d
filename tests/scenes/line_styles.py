"""Views of every corner, cap, pattern, band and casing of lines, ordinary and hostile (styles.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg
from decalgl.strokes import StrokeStyle
from shapes import circle, flat_terrain, partition, star, tints, walk
from style_views import named
from styled import (
    BANDS,
    CAPS,
    CORNERS,
    above,
    aslant,
    bend,
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

# Plain


@named
def plain() -> View:
    """Fills and round strokes alone, some of them translucent."""
    scene = flat_ground()
    cells = [[np.asarray(cell.exterior.coords)[:-1]] for cell in partition((-70, -40, 70, 40), 9, 6)]
    styled(scene, "polygons", cells, fill=fill(54, tints(54, 3)))
    generator = np.random.default_rng(4)
    found = [[walk(generator, generator.uniform(-60, 60, 2) * (1, 0.5), 5.0, 15)] for _ in range(20)]
    styled(scene, "lines", found, stroke=stroke(20, np.linspace(0.3, 6.0, 20), tints(20, 5, (0.3, 1.0))))
    return above(scene)


# Corners and caps


@named
def corner_angles() -> View:
    """Every corner at turns from none to an exact reversal, to both sides."""
    scene = flat_ground()
    turns = np.linspace(0.0, 180.0, 13)
    places = grid(13, 6)
    features = [
        [bend(places[row, column], turn if row % 2 == 0 else -turn, 4.5)]
        for row in range(6)
        for column, turn in enumerate(turns)
    ]
    styles = [StrokeStyle(corner, "butt") for corner in CORNERS]
    of = np.repeat(np.arange(6) // 2, 13)
    styled(scene, "lines", features, stroke=stroke(78, 3.0, tints(78, 11), styles, of))
    return above(scene)


@named
def miter_limits() -> View:
    """Sharp corners below, at and above their limits, which are angles between the segments."""
    scene = flat_ground()
    places = grid(10, 4)
    limits = (5.0, 20.0, 55.0, 100.0)
    features = [
        [bend(places[row, column] - (3.0, 0.0), 180.0 - opening, 6.0)]
        for row in range(4)
        for column, opening in enumerate((3.0, 8.0, 17.0, 23.0, 40.0, 53.0, 57.0, 90.0, 97.0, 103.0))
    ]
    styles = [StrokeStyle("miter", "butt", miter_limit=limit) for limit in limits]
    styled(
        scene, "lines", features, stroke=stroke(40, 1.5, tints(40, 12), styles, np.repeat(np.arange(4), 10))
    )
    return above(scene)


@named
def caps_and_corners() -> View:
    """Zigzags of every corner with every cap."""
    scene = flat_ground()
    places = grid(3, 3)
    zigzag = np.array(
        [(-22.0, -6.0), (-15.0, 7.0), (-9.0, -7.0), (0.0, -7.0), (9.0, 6.0), (12.0, -8.0), (22.0, 3.0)]
    )
    features = [[places[row, column] + zigzag] for row in range(3) for column in range(3)]
    styles = [StrokeStyle(corner, cap) for corner in CORNERS for cap in CAPS]
    styled(scene, "lines", features, stroke=stroke(9, 5.0, tints(9, 13, 0.6), styles))
    return above(scene)


@named
def short_segments() -> View:
    """Wide strokes over segments much shorter than they are wide: arcs, spirals and crooked ends."""
    scene = flat_ground()
    places = grid(6, 3)
    generator = np.random.default_rng(14)
    features = []
    for row in range(3):
        for column in range(6):
            if column < 3:
                angle = np.linspace(0.0, 5.0, 90)
                shape = (2.0 + 1.5 * column) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
            else:
                shape = walk(generator, np.zeros(2), 0.25 * (column - 2), 24)
            features.append([places[row, column] + shape])
    styles = [StrokeStyle(corner, "butt") for corner in CORNERS]
    styled(
        scene, "lines", features, stroke=stroke(18, 8.0, tints(18, 15), styles, np.repeat(np.arange(3), 6))
    )
    return above(scene)


@named
def dots() -> View:
    """Lines of one vertex, repeated or not, of no length and nearly none, with every cap."""
    scene = flat_ground()
    places = grid(8, 3)
    features = [
        [np.repeat(places[row, column][None], 1 + column % 3, axis=0)]
        for row in range(3)
        for column in range(8)
    ]
    styles = [StrokeStyle(cap=cap) for cap in CAPS]
    widths = np.tile(np.geomspace(0.2, 18.0, 8), 3)
    styled(
        scene,
        "lines",
        features,
        stroke=stroke(24, widths, tints(24, 16, 0.7), styles, np.repeat(np.arange(3), 8)),
    )
    return above(scene)


@named
def dots_with_marks() -> View:
    """Lines of one vertex are as wide as their pattern is where it begins; some with bands, some on slopes."""
    scene = flat_ground()
    places = grid(8, 6)
    features = [[places[row, column][None]] for row in range(6) for column in range(8)]
    styles = [
        StrokeStyle(
            cap=CAPS[row % 3],
            pattern=dashes(9.0, (1.0, 5.0, 0.2, 1.0), (6.0, 7.0), offset=1.2 * column),
            bands=BANDS if row >= 3 else (),
            slope_correction="tangent" if column % 2 else "none",
        )
        for row in range(6)
        for column in range(8)
    ]
    styled(
        scene,
        "lines",
        features,
        stroke=stroke(48, np.tile(np.geomspace(3.0, 9.0, 8), 6), tints(48, 16, 0.7), styles, np.arange(48)),
    )
    return above(scene)


@named
def closed_lines() -> View:
    """Lines that end where they began have a corner there; those of two segments have caps."""
    scene = flat_ground()
    places = grid(6, 3)
    features = []
    for row in range(3):
        for column in range(6):
            ring = circle(0.0, 0.0, 9.0, 3 + column, 0.3)
            if column == 5:
                ring = np.array([(-8.0, -3.0), (8.0, 5.0)])
            features.append([places[row, column] + np.concatenate([ring, ring[:1]])])
    styles = [
        StrokeStyle(corner, cap) for corner, cap in zip(CORNERS, ("square", "butt", "square"), strict=True)
    ]
    styled(
        scene, "lines", features, stroke=stroke(18, 4.0, tints(18, 17), styles, np.repeat(np.arange(3), 6))
    )
    return above(scene)


# Composition


@named
def crossing_lines() -> View:
    """Translucent lines that cross themselves and one another: each is one coat of paint."""
    scene = flat_ground()
    generator = np.random.default_rng(18)
    features = [[star(x, y, 24.0, 7, 0.2)] for x in (-45.0, 0.0, 45.0) for y in (-12.0, 12.0)]
    features += [[walk(generator, generator.uniform(-30, 30, 2), 4.0, 40)] for _ in range(6)]
    styles = [StrokeStyle(corner, cap) for corner, cap in zip(CORNERS, CAPS, strict=True)]
    styled(scene, "lines", features, stroke=stroke(12, 5.0, tints(12, 19, 0.4), styles))
    return above(scene)


@named
def casings() -> View:
    """Casings of all lines lie under all strokes, and show through translucent ones."""
    scene = flat_ground()
    generator = np.random.default_rng(20)
    features = [[walk(generator, generator.uniform(-60, 60, 2) * (1, 0.5), 7.0, 14)] for _ in range(14)]
    widths = np.linspace(2.0, 6.0, 14)
    inner = stroke(14, widths, tints(14, 21, (0.3, 0.8)), StrokeStyle("miter", "butt"))
    outer = stroke(14, widths + 2.0, (0.1, 0.1, 0.1, 0.7), StrokeStyle("round", "butt"))
    styled(scene, "lines", features, stroke=inner, casing=outer)
    return aslant(scene)


@named
def bands() -> View:
    """Colours across lines with corners and caps of every kind, under the lines' own alpha."""
    scene = flat_ground()
    places = grid(3, 3)
    hook = np.array([(-20.0, -4.0), (-4.0, -4.0), (2.0, 6.0), (12.0, 6.0), (6.0, -5.0), (20.0, -5.0)])
    features = [[places[row, column] + hook] for row in range(3) for column in range(3)]
    styles = [StrokeStyle(corner, cap, bands=BANDS) for corner in CORNERS for cap in CAPS]
    colors = np.tile((0.0, 0.0, 0.0, 1.0), (9, 1))
    colors[::2, 3] = 0.6
    styled(scene, "lines", features, stroke=stroke(9, 8.0, colors, styles))
    return above(scene)


@named
def many_styles() -> View:
    """A layer whose features differ in everything, in an order of its own."""
    scene = flat_ground()
    generator = np.random.default_rng(22)
    features = [[walk(generator, generator.uniform(-60, 60, 2) * (1, 0.5), 6.13, 12)] for _ in range(36)]
    patterns = (None, dashes(5.0, (0.0, 3.0)), dashes(8.0, (0.0, 6.0, 1.0, 0.2)))
    styles = [
        StrokeStyle(corner, cap, pattern=patterns[(i + j) % 3], bands=BANDS if (i + 2 * j) % 4 == 0 else ())
        for i, corner in enumerate(CORNERS)
        for j, cap in enumerate(CAPS)
    ]
    colors = tints(36, 23, (0.4, 1.0))
    widths = generator.uniform(0.5, 6.0, 36)
    styled(
        scene, "lines", features, stroke=stroke(36, widths, colors, styles), order=generator.permutation(36)
    )
    return above(scene)


# Patterns


@named
def dash_periods() -> View:
    """Periods from far below a pixel to longer than the line."""
    scene = flat_ground()
    periods = np.geomspace(0.06, 600.0, 18)
    y = np.linspace(-40.0, 40.0, 18)
    features = [[np.array([(-75.0, a), (0.3, a + 1.0), (75.0, a - 1.0)])] for a in y]
    styles = [
        StrokeStyle("miter", "butt", pattern=dashes(period, (0.0, 0.6 * period), offset=0.3 * period))
        for period in periods
    ]
    styled(scene, "lines", features, stroke=stroke(18, 2.5, tints(18, 24), styles))
    return above(scene)


@named
def dashes_around_corners() -> View:
    """Dashes over corners and caps of every kind, on open and closed lines."""
    scene = flat_ground()
    places = grid(3, 3)
    features = []
    for row in range(3):
        for column in range(3):
            ring = circle(0.0, 0.0, 10.0, 5 + row, 0.2)
            spiral = np.array([(14.0, -8.0), (20.0, 9.0), (24.0, -9.0), (15.0, 0.0)]) - (2.0, 0.0)
            features.append(
                [
                    places[row, column] - (6, 0) + np.concatenate([ring, ring[:1]]),
                    places[row, column] + spiral,
                ]
            )
    styles = [
        StrokeStyle(corner, cap, pattern=dashes(7.3, (0.0, 3.9), (4.7, 6.1), offset=1.17))
        for corner in CORNERS
        for cap in CAPS
    ]
    styled(scene, "lines", features, stroke=stroke(9, 4.0, tints(9, 25), styles))
    return above(scene)


@named
def arrows_and_stipples() -> View:
    """Tapered marks: arrows, spindles, and marks that overlap."""
    scene = flat_ground()
    patterns = [
        dashes(9.0, (0.0, 6.0, 1.0, 0.0)),
        dashes(9.0, (0.0, 5.0, 0.3, 0.3), (5.0, 9.0, 1.0, 0.0)),
        dashes(6.0, (0.0, 3.0, 0.0, 1.0), (3.0, 6.0, 1.0, 0.0)),
        dashes(8.0, (0.0, 8.0, 0.2, 0.2), (1.0, 2.0), (4.0, 7.0, 0.5, 0.9)),
        dashes(2.5, (0.0, 1.25)),
        dashes(11.0, (2.0, 9.0, 0.1, 1.0)),
    ]
    y = np.linspace(-35.0, 35.0, 6)
    features = [
        [np.array([(-75.0, a - 4), (-25.0, a + 4), (10.0, a - 3), (30.0, a + 3), (75.0, a)])] for a in y
    ]
    styles = [StrokeStyle("round", "round", pattern=pattern) for pattern in patterns]
    styled(scene, "lines", features, stroke=stroke(6, 6.0, tints(6, 26), styles))
    return above(scene)


@named
def far_dashes() -> View:
    """Dashes at the end of a line of a thousand kilometres, far from the origin."""
    x, y = 4.2e6, -3.1e6
    scene = dg.Scene(flat_terrain(100.0, x, y))
    generator = np.random.default_rng(27)
    features = []
    for i in range(8):
        near = np.array([x, y]) + np.array(
            [(-90.0, 10.0 * i - 38.0), (0.0, 10.0 * i - 33.0), (90.0, 10.0 * i - 38.0)]
        )
        far = near[0] + (-1e6, 2e4 * (i - 4)) + generator.uniform(-1e3, 1e3, 2)
        features.append([np.concatenate([far[None], near])])
    styles = [
        StrokeStyle("miter", "butt", pattern=dashes(period, (0.0, 0.5 * period)))
        for period in (3.0, 7.7, 40.0)
    ]
    styled(scene, "lines", features, stroke=stroke(8, 3.0, tints(8, 28), styles))
    return above(scene, x, y)


@named
def touching_parts() -> View:
    """Parts of a line that begin where the one before ends, at it and on it: both have ends there, and no corner."""
    scene = flat_ground()
    places = grid(6, 3)
    parts = [
        np.array([(-9.0, -8.0), (1.0, -5.0), (0.0, 0.0)]),
        np.array([(0.0, 0.0), (9.0, 3.0)]),
        np.array([(9.0, 3.0), (2.0, 9.0), (-8.0, 4.0), (0.0, 0.0)]),
        np.array([(0.0, 0.0), (-8.0, 0.0)]),
    ]
    features = [[places[row, column] + part for part in parts] for row in range(3) for column in range(6)]
    patterns = (None, dashes(5.0, (0.0, 3.0)))
    styles = [
        StrokeStyle(corner, cap, pattern=pattern)
        for pattern in patterns
        for corner in CORNERS
        for cap in CAPS
    ]
    styled(scene, "lines", features, stroke=stroke(18, 4.0, tints(18, 29, 0.5), styles))
    return above(scene)
