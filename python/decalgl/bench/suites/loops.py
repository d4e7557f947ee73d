"""LOOPS: the experiments of the paper, on the contours of the smallest size, and what details that no view shows save.

primitives   table 2: triangles ÷ segments of isolines, by the index of LOCALIS and by others
bvh          figure 16: the paper's indexes along a flight, ÷ its constant one
detail       half a pixel of tolerance ÷ full detail; and ÷ the static index, which draws everything
prepared     nanoseconds a segment, by the size of the map
"""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING

import decalgl as dg

from .. import cameras
from ..measure import draw, interleaved, preprocessing
from ..workload import KINDS, add_contours

if TYPE_CHECKING:
    from ..measure import Measure, Times
    from ..records import Records
    from ..workload import Workload

# Table 2; "replica" is the index of LOCALIS.
DRAWN = {
    "seg replica": dg.Loops(primitives="seg", bvh="replica"),
    "tri replica": dg.Loops(bvh="replica"),
    "tri constant": dg.Loops(bvh="constant"),
    "tri fitted": dg.Loops(),
}
# Figure 16. The rest of table 1 takes more than a shader can read where lines are wide and cells narrow.
INDEXES = ("constant", "descending", "ascending", "flat6", "size-efficient", "efficient", "even", "fitted")
FULL = dg.Detail(screen=None, uniform=0.0)
LINE = {"width": 1.0}
FLIGHT = 12


def measure(work: Workload, records: Records) -> None:
    smallest = next(iter(work.sizes))
    for kind in KINDS:
        _compare_detail(work, records, kind, smallest)
    _compare_primitives(work, records, smallest)
    _compare_indexes(work, records, smallest)
    for kind in KINDS:
        for size in list(work.sizes)[:2]:
            _prepare(work, records, kind, size)


def scene_of(work: Workload, kind: str, size: str, technique: str | dg.Technique) -> dg.Scene:
    """The terrain under its contours, lines a metre wide."""
    scene = dg.Scene(work.ground)
    looks = LINE if kind == "isolines" else {}
    add_contours(scene, kind, work.contours(kind, size), technique=technique, **looks)
    return scene


def passes(renderer: dg.Renderer, path: list[dg.Camera], name: str) -> Measure:
    """Measures the layers' passes over some views, their sum as `name`_ms, that of the terrain as `name`_terrain_ms."""

    def measured() -> Times:
        layers = terrain = 0.0
        for camera in path:
            for one in draw(renderer, camera, "none").stats.passes:
                layers += one["ms"] * (one["name"] in ("static", "loops"))
                terrain += one["ms"] * (one["name"] == "terrain")
        return {f"{name}_ms": layers / len(path), f"{name}_terrain_ms": terrain / len(path)}

    return measured


def _compare_detail(work: Workload, records: Records, kind: str, size: str) -> None:
    work.say(f"{kind} {size}, levels of detail")
    static = work.renderer(scene_of(work, kind, size, "static"))
    full = work.renderer(scene_of(work, kind, size, dg.Loops(detail=FULL)))
    half = work.renderer(scene_of(work, kind, size, "loops"))
    views = {
        **{name: [camera] for name, camera in work.views.items()},
        "flight": cameras.flight(work.ground.bounds, FLIGHT),
    }
    for view, path in views.items():
        times = interleaved(
            work.runs_of(size),
            passes(static, path, "static"),
            passes(full, path, "full"),
            passes(half, path, "half"),
        )
        records.at(f"{kind} {size}", view, "loops").update(
            **times,
            loops_detail=times["half_ms"] / times["full_ms"],
            loops_static=times["half_ms"] / times["static_ms"],
        )


def _compare_primitives(work: Workload, records: Records, size: str) -> None:
    path = [work.views[name] for name in ("overview", "oblique", "close", "worst")]
    first: Times = {}
    for name, technique in DRAWN.items():
        work.say(f"isolines {size}, {name}")
        times = _drawn(work, scene_of(work, "isolines", size, technique), path)
        first = first or times
        records.at(f"isolines {size}", None, f"loops {name}").update(
            **times,
            loops_seg_time=times["loops_ms"] / first["loops_ms"],
            loops_seg_primitives=times["loops_primitives"] / first["loops_primitives"],
            loops_seg_bytes=times["loops_bytes"] / first["loops_bytes"],
        )


def _compare_indexes(work: Workload, records: Records, size: str) -> None:
    constant: Times = {}
    flight = cameras.flight(work.ground.bounds, FLIGHT)
    for name in INDEXES:
        work.say(f"iso-bands {size}, {name}")
        try:
            times = _drawn(work, scene_of(work, "iso-bands", size, dg.Loops(bvh=name)), flight)
        except dg.MemoryLimitError:
            continue  # an index larger than shaders can read has no row
        constant = times if name == "constant" else constant
        record = records.at(f"iso-bands {size}", None, f"loops {name}")
        record.update(**times)
        if constant:
            record.update(
                loops_constant_time=times["loops_ms"] / constant["loops_ms"],
                loops_constant_bytes=times["loops_bytes"] / constant["loops_bytes"],
            )


def _drawn(work: Workload, scene: dg.Scene, path: list[dg.Camera]) -> Times:
    """What the index holds, and the median of some rounds over all views."""
    renderer = work.renderer(scene)
    measured = passes(renderer, path, "loops")
    rounds = [measured() for _ in range(2)]
    counts = draw(renderer, path[0], "none").stats.counts
    held = {name: float(value) for name, value in counts.items() if name.startswith("loops_")}
    return {
        **held,
        "loops_ms": statistics.median(each["loops_ms"] for each in rounds),
        "segments": counts["segments"],
    }


def _prepare(work: Workload, records: Records, kind: str, size: str) -> None:
    work.say(f"{kind} {size}, preparing")
    times = preprocessing(scene_of(work, kind, size, "loops"), 1)
    records.at(f"{kind} {size}", None, "loops").update(
        loops_prepare_ms=times["preprocess_ms"],
        radix_sort_ms=times["radix_sort_ms"],
        segments=times["segments"],
        loops_P=times["P"],
        loops_bytes_per_segment=times["bytes_per_segment"],
    )
