"""The largest map ÷ the smallest at the same view, without anti-aliasing and with coverage."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..measure import drawing, interleaved
from ..workload import KINDS

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload

VIEWS = ("overview", "oblique", "close", "worst")


def measure(work: Workload, records: Records) -> None:
    names = list(work.sizes)
    smallest, largest = names[0], names[-1]
    if smallest == largest:
        return
    for kind in KINDS:
        work.say(f"{kind} {largest} ÷ {smallest}")
        small, large = (work.renderer(work.scene(kind, size)) for size in (smallest, largest))
        for view in VIEWS:
            camera = work.views[view]
            times = interleaved(
                work.runs_of(largest),
                drawing(small, camera, "none", "scale_small"),
                drawing(large, camera, "none", "scale_large"),
                drawing(small, camera, "coverage", "scale_coverage_small"),
                drawing(large, camera, "coverage", "scale_coverage_large"),
            )
            records.at(f"{kind} {largest}", view).update(
                **times,
                scale=times["scale_large_ms"] / times["scale_small_ms"],
                scale_coverage=times["scale_coverage_large_ms"] / times["scale_coverage_small_ms"],
            )
