"""The papers' indexes ÷ ours: the pass without anti-aliasing at every view, and what they cost to prepare.

bvh       Zechmeister's grid of trees
thoeny    Thöny's clustered line buffer, for lines alone
"""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING

from ..measure import drawing, interleaved, preprocessing
from ..workload import KINDS

if TYPE_CHECKING:
    import decalgl as dg

    from ..records import Records
    from ..workload import Workload

INDEXES = {"isolines": ("bvh", "thoeny"), "iso-bands": ("bvh",)}


def measure(work: Workload, records: Records) -> None:
    for kind in KINDS:
        name = f"{kind} {work.middle}"
        scene = work.scene(kind, work.middle)
        grid = work.renderer(scene)
        for index in INDEXES[kind]:
            work.say(f"{name}, {index}")
            _compare(work, records, name, scene, grid, index)


def _compare(
    work: Workload, records: Records, name: str, scene: dg.Scene, grid: dg.Renderer, index: str
) -> None:
    prepared = preprocessing(scene, 1, index=index)
    other = work.renderer(scene, index)
    ratios = []
    for view, camera in work.views.items():
        times = interleaved(
            work.runs, drawing(grid, camera, "none", "grid"), drawing(other, camera, "none", "bvh")
        )
        ratios.append(times["bvh_ms"] / times["grid_ms"])
        records.at(name, view, index).update(**times, bvh_grid=ratios[-1])
    lowest, middle = min(ratios), statistics.median(ratios)
    records.at(name, None, index).update(**prepared, bvh_grid_min=lowest, bvh_grid_median=middle)
