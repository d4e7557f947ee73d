"""What scenes of styles are made of: strokes, fills and layers without styling keywords, patterns, places, views."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

import decalgl as dg
from decalgl.strokes import (
    ColorBand,
    Fill,
    Hatch,
    LinePattern,
    PatternMark,
    Stroke,
    StrokeStyle,
)
from scenes import View
from shapes import flat_terrain, rings

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    Kind = Literal["polygons", "lines"]

SIZE = (320, 180)
# Half the ground that a picture of `SIZE` shows from above, metres: two pixels a metre.
HALF = (80.0, 45.0)


def _bytes(count: int, color: Any) -> NDArray[np.uint8]:
    """Colours (count, 4) of one (R, G, B[, A]) from 0 to 1, or of one a feature."""
    given = np.asarray(color, dtype=np.float64)
    if given.shape[-1] == 3:
        given = np.concatenate([given, np.ones((*given.shape[:-1], 1))], axis=-1)
    return np.rint(255 * np.broadcast_to(given, (count, 4))).astype(np.uint8)


def stroke(
    count: int,
    width: Any,
    color: Any,
    styles: StrokeStyle | Sequence[StrokeStyle] | None = None,
    style_of: Any = None,
) -> Stroke:
    """Strokes of `count` features: one width and colour for all or one each; several styles go round by turns."""
    found = (styles,) if isinstance(styles, StrokeStyle) else tuple(styles or (StrokeStyle(),))
    if style_of is None and len(found) > 1:
        style_of = np.arange(count) % len(found)
    return Stroke(
        _bytes(count, color),
        np.broadcast_to(np.asarray(width, dtype=np.float64), (count,)).copy(),
        found,
        None if style_of is None else np.asarray(style_of, dtype=np.uint32),
    )


def fill(count: int, color: Any, hatches: Sequence[Hatch | None] | None = None) -> Fill:
    """Fills of `count` features: one colour for all or one each; several hatches go round by turns."""
    if hatches is None:
        return Fill(_bytes(count, color))
    return Fill(_bytes(count, color), tuple(hatches), np.arange(count, dtype=np.uint32) % len(hatches))


def styled(
    scene: dg.Scene,
    kind: Kind,
    geometry: list[list[FloatArray]],
    *,
    fill: Fill | None = None,
    stroke: Stroke | None = None,
    casing: Stroke | None = None,
    outline_mode: str = "normal",
    outline_order: str = "layer",
    order: Any = "feature",
) -> dg.Layer:
    """Adds a layer of resolved styles: features, each a list of parts (n, 2)."""
    table = rings(geometry, kind)
    if kind == "polygons":
        plain = scene.add_polygons(table, order=order)
    else:
        plain = scene.add_lines(table, width=1.0, width_units="m", order=order)
    changes: dict[str, Any] = {
        "fill": fill,
        "stroke": stroke,
        "casing": casing,
        "outline_mode": outline_mode,
        "outline_order": outline_order,
    }
    layer = dataclasses.replace(plain, **changes)
    scene._layers[-1] = layer
    return layer


def above(scene: dg.Scene, x: float = 0.0, y: float = 0.0) -> View:
    """Straight down on the ground around a place, two pixels a metre."""
    bounds = (x - HALF[0], y - HALF[1], x + HALF[0], y + HALF[1])
    return View(scene, dg.Camera.top_down(bounds), SIZE)


def aslant(scene: dg.Scene, distance: float = 130.0, elevation: float = 35.0) -> View:
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), distance, 200.0, elevation), SIZE)


def flat_ground() -> dg.Scene:
    return dg.Scene(flat_terrain(100.0))


def grid(columns: int, rows: int) -> FloatArray:
    """Places (rows, columns, 2) over the picture, row 0 at the top, off the middle of pixels."""
    x = HALF[0] * (2 * np.arange(columns) + 1.013 - columns) / columns
    y = HALF[1] * (rows - 1.017 - 2 * np.arange(rows)) / rows
    return np.stack(np.meshgrid(x, y), axis=-1)


def dashes(period: float, *marks: tuple[float, ...], offset: float = 0.0) -> LinePattern:
    """A pattern of marks (begin, end[, begin_width, end_width]) in metres."""
    return LinePattern(period, tuple(PatternMark(*mark) for mark in marks), offset)


def bend(at: FloatArray, turn: float, arm: float, heading: float = 25.0) -> FloatArray:
    """Two segments that meet at a place with a turn in degrees; 180 comes back exactly."""
    into = np.radians(heading)
    start = at - arm * np.array([np.cos(into), np.sin(into)])
    if turn == 180.0:
        return np.array([start, at, start])
    if turn == 0.0:
        return np.array([start, at, at + (at - start)])
    out = into + np.radians(turn)
    return np.array([start, at, at + arm * np.array([np.cos(out), np.sin(out)])])


CORNERS = ("round", "miter", "bevel")
CAPS = ("round", "butt", "square")
BANDS = (
    ColorBand(0.2, (250, 240, 40, 255)),
    ColorBand(0.45, (30, 30, 30, 128)),
    ColorBand(0.5, (255, 255, 255, 255)),
    ColorBand(1.0, (200, 40, 40, 200)),
)
TEAL, BROWN, GREY = (0.1, 0.5, 0.5), (0.5, 0.3, 0.1), (0.3, 0.3, 0.35)
