"""LOOPS: the experiments of the paper, on the contours of the smallest size, and what details that no view shows save.

primitives   table 2: triangles ÷ segments of isolines, by the index of LOCALIS and by others, in four views
bvh          figure 16: the paper's indexes along a flight, step by step, ÷ the fitted one
detail       half a pixel of tolerance ÷ full detail; and ÷ the static index, which draws everything
prepared     preparing, by the size of the map: isolines of 1, 2, 4 and 8 million segments in a whole run
"""

from __future__ import annotations

import dataclasses
import statistics
from typing import TYPE_CHECKING

import decalgl as dg

from .. import cameras, contours
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
    "tri fitted": dg.Loops(bvh="fitted"),
    "cells": dg.Loops(),
}
# Figure 16. The rest of table 1 takes more than a shader can read where lines are wide and cells narrow.
INDEXES = (
    "constant",
    "descending",
    "ascending",
    "flat6",
    "size-efficient",
    "efficient",
    "even",
    "fitted",
    None,
)
FULL = dg.Detail(screen=None, uniform=0.0)
LINE = {"width": 1.0}
FLIGHT = 12


def measure(work: Workload, records: Records) -> None:
    smallest = next(iter(work.sizes))
    for kind in KINDS:
        _compare_detail(work, records, kind, smallest)
    _compare_primitives(work, records, smallest)
    _compare_indexes(work, records, smallest)
    for doubling in range(4 if len(work.sizes) > 2 else 2):
        _prepare(work, records, doubling)


# Which passes make a picture: making the cells is what a view that moves takes beside drawing.
PARTS = {"": ("static", "loops", "loops: cells"), "_cells": ("loops: cells",), "_terrain": ("terrain",)}


def scene_of(work: Workload, kind: str, size: str, technique: str | dg.Technique) -> dg.Scene:
    """The terrain under its contours, lines a metre wide."""
    scene = dg.Scene(work.ground)
    looks = LINE if kind == "isolines" else {}
    add_contours(scene, kind, work.contours(kind, size), technique=technique, **looks)
    return scene


def passes(renderer: dg.Renderer, path: list[dg.Camera], name: str) -> Measure:
    """Measures passes over some views, each a view that is new: the layers' as `name`_ms, of these what makes cells as
    `name`_cells_ms, the terrain's as `name`_terrain_ms.
    """

    def measured() -> Times:
        sums = dict.fromkeys(PARTS, 0.0)
        for camera in path:
            _leave(renderer, camera)
            for one in draw(renderer, camera, "none").stats.passes:
                for part, names in PARTS.items():
                    sums[part] += one["ms"] * (one["name"] in names)
        return {f"{name}{part}_ms": ms / len(path) for part, ms in sums.items()}

    return measured


def _leave(renderer: dg.Renderer, camera: dg.Camera) -> None:
    """Looks elsewhere, so that nothing is left of the view."""
    x, y, z = camera.eye
    renderer.update(dataclasses.replace(camera, eye=(x + 1.0, y, z)))


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
            active=draw(half, path[0], "none").stats.counts["loops_primitives"],
            loops_detail=times["half_ms"] / times["full_ms"],
            loops_static=times["half_ms"] / times["static_ms"],
            loops_standing=(times["half_ms"] - times["half_cells_ms"]) / times["static_ms"],
        )


def _compare_primitives(work: Workload, records: Records, size: str) -> None:
    views = ("overview", "oblique", "close", "worst")
    first: Times = {}
    for name, technique in DRAWN.items():
        work.say(f"isolines {size}, {name}")
        renderer = work.renderer(scene_of(work, "isolines", size, technique))
        times = _drawn(renderer, [work.views[view] for view in views])
        for view in views:
            times |= interleaved(1, passes(renderer, [work.views[view]], view))
        first = first or times
        records.at(f"isolines {size}", None, f"loops {name}").update(
            **times,
            loops_seg_time=times["loops_ms"] / first["loops_ms"],
            loops_seg_primitives=times["loops_primitives"] / first["loops_primitives"],
            loops_seg_bytes=times["loops_bytes"] / first["loops_bytes"],
        )


def _compare_indexes(work: Workload, records: Records, size: str) -> None:
    found: dict[str, Times] = {}
    flight = cameras.flight(work.ground.bounds, FLIGHT)
    for bvh in INDEXES:
        name = bvh or "cells"
        work.say(f"iso-bands {size}, {name}")
        try:
            renderer = work.renderer(scene_of(work, "iso-bands", size, dg.Loops(bvh=bvh)))
        except dg.MemoryLimitError:
            continue  # an index larger than shaders can read has no row
        steps = [_drawn(renderer, [camera]) for camera in flight]
        for place, step in enumerate(steps, start=1):
            times = {f"step_{part}": step[f"loops_{part}"] for part in ("ms", "cells_ms", "terrain_ms")}
            records.at(f"iso-bands {size}", f"step {place}", f"loops {name}").update(times)
        means = {
            each: statistics.fmean(step[each] for step in steps) for each in steps[0] if each.endswith("_ms")
        }
        found[name] = {**steps[0], **means}  # counts are those of the first view
    # Not beside the constant one, as the paper's figure has it: that may be too large.
    fitted = found["fitted"]
    for name, times in found.items():
        records.at(f"iso-bands {size}", None, f"loops {name}").update(
            **times,
            loops_fitted_time=times["loops_ms"] / fitted["loops_ms"],
            loops_fitted_bytes=times["loops_bytes"] / fitted["loops_bytes"],
        )


def _drawn(renderer: dg.Renderer, path: list[dg.Camera]) -> Times:
    """What the index holds, and the median of some rounds over all views."""
    measured = passes(renderer, path, "loops")
    rounds = [measured() for _ in range(2)]
    counts = draw(renderer, path[0], "none").stats.counts
    held = {name: float(value) for name, value in counts.items() if name.startswith("loops_")}
    middle = {name: statistics.median(each[name] for each in rounds) for name in rounds[0]}
    return {**held, **middle, "segments": counts["segments"]}


def _prepare(work: Workload, records: Records, doubling: int) -> None:
    smallest = next(iter(work.sizes.values())).line_step
    step = smallest / 2**doubling
    rows, columns = work.ground.shape
    path = work.folder / f"isolines_{rows}x{columns}_{step:g}m.npz"
    arrays = contours.isolines(work.ground, step, path, work.say)
    scene = dg.Scene(work.ground)
    add_contours(scene, "isolines", arrays, technique="loops", **LINE)
    work.say(f"isolines every {step:g} m, preparing")
    times = preprocessing(scene, 1)
    records.at(f"isolines every {step:g} m", None, "loops").update(
        loops_prepare_ms=times["preprocess_ms"],
        radix_sort_ms=times["radix_sort_ms"],
        segments=times["segments"],
        loops_P=times["P"],
        loops_bytes_per_segment=times["bytes_per_segment"],
    )
