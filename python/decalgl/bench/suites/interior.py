"""The inside of a polygon: a picture within one iso-band ÷ the same picture within a rectangle over the map.

Neither shows an edge. The rectangle is the least that an index can be asked: one header in every cell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from .. import cameras
from ..measure import draw, drawing, interleaved

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload


def measure(work: Workload, records: Records) -> None:
    work.say(f"inside the iso-bands {work.middle}")
    camera = cameras.interior(work.ground, work.contours("iso-bands", work.middle)["coordinates"])
    bands = work.renderer(work.scene("iso-bands", work.middle))
    rectangle = work.renderer(_rectangle(work.ground))
    for renderer in (bands, rectangle):
        _require_one_feature(draw(renderer, camera, "none"))
    times = interleaved(
        work.runs,
        *(
            drawing(renderer, camera, antialias, f"{name}_{antialias}")
            for antialias in ("none", "coverage")
            for name, renderer in (("bands", bands), ("rectangle", rectangle))
        ),
    )
    records.at(f"iso-bands {work.middle}", "interior").update(
        **times,
        interior=times["bands_none_ms"] / times["rectangle_none_ms"],
        interior_coverage=times["bands_coverage_ms"] / times["rectangle_coverage_ms"],
    )


def _rectangle(ground: dg.Terrain) -> dg.Scene:
    x0, y0, x1, y1 = ground.bounds
    corners = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    scene = dg.Scene(ground)
    scene.add_polygons((corners, np.array([0, 4])))
    return scene


def _require_one_feature(frame: dg.Frame) -> None:
    found = np.unique(frame.ids)
    if len(found) != 1 or found[0] < 0:
        raise ValueError(
            f"The picture should lie inside one polygon, but it shows {len(found)} of -1 for none and ids."
        )
