"""Every scene from everywhere.

S           layers without anti-aliasing ÷ floor, a pass that reads depth and writes a colour everywhere
S_levels    layers with coverage, to which coarser levels of detail are open, ÷ floor
AA          layers with coverage ÷ without
levels      layers with coverage far away ÷ in the overview: many segments share a pixel
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..measure import drawing, floor, interleaved
from ..workload import KINDS

if TYPE_CHECKING:
    import decalgl as dg

    from ..measure import Times
    from ..records import Records
    from ..workload import Workload


def measure(work: Workload, records: Records) -> None:
    for kind in KINDS:
        for size in work.sizes:
            scene = f"{kind} {size}"
            work.say(scene)
            renderer = work.renderer(work.scene(kind, size))
            for view, camera in work.views.items():
                records.at(scene, view).update(at_view(renderer, camera, work.runs_of(size)))
            far, overview = (records.at(scene, view) for view in ("far", "overview"))
            far["levels"] = far["coverage_ms"] / overview["coverage_ms"]


def at_view(renderer: dg.Renderer, camera: dg.Camera, runs: int) -> Times:
    """Times and ratios of a scene at one view."""
    none = drawing(renderer, camera, "none", "none")
    coverage = drawing(renderer, camera, "coverage", "coverage")
    times = interleaved(runs, none, floor(renderer), coverage)
    return {
        **times,
        "S": times["none_ms"] / times["floor_ms"],
        "S_levels": times["coverage_ms"] / times["floor_ms"],
        "AA": times["coverage_ms"] / times["none_ms"],
    }
