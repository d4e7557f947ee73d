"""Lines of 2 pixels on the screen: lists ÷ bins from few to many segments, and what the update of a view takes.

bins, lists   what all passes of the technique take, without anti-aliasing: the update of the view and the drawing
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from ..measure import draw, interleaved
from ..workload import LINE_COLOR, line_table

if TYPE_CHECKING:
    from ..contours import Arrays
    from ..measure import Measure
    from ..records import Records
    from ..workload import Workload

WIDTH = 2.0
VIEWS = ("overview", "oblique", "close")
SHARES = (0.01, 0.1, 1.0)
STEPS = ("simplify", "compact vertices", "cull", "compact segments", "project", "bins")
UPDATE = {f"dynamic: {step}" for step in STEPS}


def measure(work: Workload, records: Records) -> None:
    size = next(iter(work.sizes))
    arrays = work.contours("isolines", size)
    for share in SHARES:
        scene_name = f"pixel lines {share:g} of {size}"
        work.say(scene_name)
        table = some_lines(arrays, share)
        renderers = {
            method: work.renderer(scene_of(work.ground, table, method)) for method in ("bins", "lists")
        }
        for view in VIEWS:
            camera = work.views[view]
            times = interleaved(
                work.runs,
                *(passes_of(renderers[method], camera, "none", method) for method in renderers),
                passes_of(renderers["bins"], camera, "coverage", "coverage"),
            )
            counts = draw(renderers["bins"], camera, "none").stats.to_dict()["counts"]
            records.at(scene_name, view, "dynamic").update(
                **times,
                segments=counts["segments"],
                matched_segments=counts["dynamic_segments"],
                tile_entries=counts["dynamic_tile_entries"],
                D=times["lists_ms"] / times["bins_ms"],
                update_share=times["bins_update_ms"] / times["bins_ms"],
            )


def some_lines(arrays: Arrays, share: float) -> dg.FeatureTable:
    """Every so many-th line."""
    table = line_table(arrays)
    step = round(1.0 / share)
    places = np.arange(0, len(table.rows), step)
    ends = table.part_offsets[places + 1] - table.part_offsets[places]
    vertices = np.concatenate([np.arange(table.part_offsets[i], table.part_offsets[i + 1]) for i in places])
    offsets = np.concatenate([[0], np.cumsum(ends)])
    each = np.arange(len(places) + 1)
    return dg.FeatureTable("lines", table.coords[vertices], offsets, each, each[:-1])


def scene_of(ground: dg.Terrain, table: dg.FeatureTable, method: str) -> dg.Scene:
    """The terrain under lines of a constant width on the screen."""
    scene = dg.Scene(ground)
    technique = dg.Dynamic(method=method)  # type: ignore[arg-type]
    scene.add_lines(table, color=LINE_COLOR, width=WIDTH, technique=technique)
    return scene


def passes_of(renderer: dg.Renderer, camera: dg.Camera, antialias: str, name: str) -> Measure:
    """Measures a frame: `name`_ms of all passes of dynamic lines, `name`_update_ms of those that are the update's."""

    def measured() -> dict[str, float]:
        passes = draw(renderer, camera, antialias).stats.passes
        names = [one["name"] for one in passes]
        whole = passes[: names.index("silhouettes")] if "silhouettes" in names else passes
        update = sum(one["ms"] for one in whole if one["name"] in UPDATE)
        drawing = sum(one["ms"] for one in whole if one["name"] == "dynamic")
        return {f"{name}_ms": update + drawing, f"{name}_update_ms": update}

    return measured
