"""Clipmap textures, solution by solution: Taibo et al. 2014, sections 5.2 and 5.3, on three sets of isolines.

memory      bytes of what tiles are drawn from, and of all
generate    milliseconds of preparing
rebuild     milliseconds of drawing all tiles of a view anew
draw        milliseconds of the same view once its tiles are there
width       milliseconds that another width takes: preparing and drawing anew
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..measure import draw, timed
from ..workload import add_lines, line_table

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload

SOLUTIONS = ("1", "2", "3a", "3b", "4a", "4b", "4b polar")
# Shares of the lines, as the paper's data sets differ in size.
SETS = (0.1, 0.3, 1.0)
VIEW = "oblique"


def measure(work: Workload, records: Records) -> None:
    size = next(iter(work.sizes))
    table = line_table(work.contours("isolines", size))
    for share in SETS:
        lines = _share(table, share)
        name = f"isolines, {100 * share:.0f} % of {size}"
        for solution in SOLUTIONS:
            work.say(f"{name}, solution {solution}")
            records.at(name, VIEW, f"clipmap {solution}").update(_measured(work, lines, solution))


def _measured(work: Workload, lines: dg.FeatureTable, solution: Any) -> dict[str, float]:
    renderer = dg.Renderer(size=work.picture, antialias="none")
    scene = _scene(work, lines, solution, 1.0)
    generate = timed(lambda: renderer.preprocess(scene))
    camera = work.views[VIEW]
    first = draw(renderer, camera, "none").stats
    again = draw(renderer, camera, "none").stats
    wider = _scene(work, lines, solution, 2.0)
    width = timed(lambda: renderer.preprocess(wider)) + _passes(
        draw(renderer, camera, "none"), "clipmap tiles"
    )
    return {
        "segments": first.counts["segments"],
        "prepared_bytes": first.counts["prepared_bytes"],
        "bytes": first.bytes["clipmap"],
        "generate_ms": generate,
        "rebuild_ms": sum(one["ms"] for one in first.passes if one["name"] == "clipmap tiles"),
        "draw_ms": sum(one["ms"] for one in again.passes if one["name"] == "clipmap"),
        "width_ms": width,
    }


def _passes(frame: dg.Frame, name: str) -> float:
    return float(sum(one["ms"] for one in frame.stats.passes if one["name"] == name))


def _scene(work: Workload, lines: dg.FeatureTable, solution: Any, wider: float) -> dg.Scene:
    scene = dg.Scene(work.ground)
    add_lines(scene, lines, technique=dg.Clipmap(solution=solution), width=6.0 * wider)
    return scene


def _share(table: dg.FeatureTable, share: float) -> dg.FeatureTable:
    """The first of the lines."""
    count = max(1, round(share * len(table.rows)))
    offsets = table.part_offsets[: count + 1]
    each = np.arange(count + 1)
    return dg.FeatureTable("lines", table.coords[: offsets[-1]], offsets, each, each[:-1])
