"""Polygons that overlap: 2000 of them bring CesiumJS from 60 to 9 frames a second (its issue #13726).

opaque_stack    opaque polygons that overlap ÷ as many side by side
half_ms         translucent at alpha 0.5, where a few hide what is behind
faint_ms        as faint as 8 bits can be, so that every one of them shows; seconds, so it is drawn once
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from .. import shapes
from ..measure import SMALL_PICTURE, drawing, interleaved

if TYPE_CHECKING:
    from ..measure import Times
    from ..records import Records
    from ..workload import Workload

BOUNDS = (0.0, 0.0, 16_000.0, 9_000.0)
CAMERA = dg.Camera.top_down(BOUNDS)
FAINTEST = 1.0 / 255.0


def measure(work: Workload, records: Records) -> None:
    for depth in work.depths:
        work.say(f"{depth} overlapping polygons")
        overlapping, apart = shapes.stack(BOUNDS, depth), shapes.disjoint(BOUNDS, depth)
        drawn = {
            "opaque": _scene(overlapping, 1.0),
            "disjoint": _scene(apart, 1.0),
            "half": _scene(overlapping, 0.5),
        }
        measures = [drawing(work.renderer(scene), CAMERA, "none", name) for name, scene in drawn.items()]
        times = interleaved(work.runs, *measures)
        records.at(f"stack of {depth}", "overview").update(
            polygons=depth,
            **times,
            **_once(work.renderer(_scene(overlapping, FAINTEST)), "faint"),
            opaque_stack=times["opaque_ms"] / times["disjoint_ms"],
        )


def _once(renderer: dg.Renderer, name: str) -> Times:
    """The time of the first picture after a tiny one, for which shaders are compiled."""
    size = renderer.size
    for picture in (SMALL_PICTURE, size):
        renderer.set_picture(picture, "none")
        times = drawing(renderer, CAMERA, "none", name)()
    return times


def _scene(table: dg.FeatureTable, alpha: float) -> dg.Scene:
    scene = dg.Scene(dg.Terrain.flat(BOUNDS))
    scene.add_polygons(table, column=np.arange(len(table)), cmap="turbo", alpha=alpha)
    return scene
