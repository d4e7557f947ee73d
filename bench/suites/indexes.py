"""The papers' index ÷ ours: one pass without anti-aliasing at every view, and what it costs to prepare."""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING

import decalgl as dg

from ..measure import drawing, interleaved, preprocessing
from ..workload import KINDS

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload

TECHNIQUE = "static_bvh"


def measure(work: Workload, records: Records) -> None:
    if not hasattr(dg, "BvhIndex"):
        work.say("there is no second index to compare with")
        return
    for kind in KINDS:
        work.say(f"{kind} {work.middle}")
        name, scene = f"{kind} {work.middle}", work.scene(kind, work.middle)
        prepared = preprocessing(scene, 1, index="bvh")
        grid, bvh = work.renderer(scene), work.renderer(scene, "bvh")
        ratios = []
        for view, camera in work.views.items():
            times = interleaved(
                work.runs, drawing(grid, camera, "none", "grid"), drawing(bvh, camera, "none", "bvh")
            )
            ratios.append(times["bvh_ms"] / times["grid_ms"])
            records.at(name, view, TECHNIQUE).update(**times, bvh_grid=ratios[-1])
        lowest, middle = min(ratios), statistics.median(ratios)
        records.at(name, None, TECHNIQUE).update(**prepared, bvh_grid_min=lowest, bvh_grid_median=middle)
