"""Where the pictures of the report are taken from: views onto the fullest place of a map, and paths through it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from ..bench import cameras

if TYPE_CHECKING:
    from .case_studies import Map
    from .part import Context


def chosen(context: Context, drawn: Map) -> dict[str, dg.Camera]:
    """The views that a report of this size is made of."""
    every = views(drawn)
    names = context.chosen(("close",), ("oblique",), ("overview", "oblique", "close", "grazing"))
    return {name: every[name] for name in names}


def views(drawn: Map) -> dict[str, dg.Camera]:
    """overview: all from above. oblique: all, tilted. close: a tenth of the map. grazing: along the ground."""
    ground = drawn.ground
    wide = ground.bounds[2] - ground.bounds[0]
    target = fullest_place(drawn)
    middle = ((ground.bounds[0] + ground.bounds[2]) / 2, (ground.bounds[1] + ground.bounds[3]) / 2, target[2])
    return {
        "overview": dg.Camera.top_down(ground.bounds),
        "oblique": dg.Camera.orbit(middle, distance=0.9 * wide, azimuth=200, elevation=40),
        "close": dg.Camera.orbit(target, distance=0.12 * wide, azimuth=200, elevation=50),
        "grazing": dg.Camera.orbit(target, distance=0.15 * wide, azimuth=200, elevation=12),
    }


def fullest_place(drawn: Map) -> tuple[float, float, float]:
    """On the ground, in the middle of the fullest part of the map."""
    points = np.concatenate([layer.features.coords for layer in drawn.scene().layers])
    xmin, ymin, xmax, ymax = drawn.ground.bounds
    room = 0.15 * min(xmax - xmin, ymax - ymin)
    inner = (xmin + room, ymin + room, xmax - room, ymax - room)
    x0, y0, x1, y1 = cameras.fullest(points, inner, 8)
    return cameras.on_ground(drawn.ground, (x0 + x1) / 2, (y0 + y1) / 2)
