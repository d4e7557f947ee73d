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
SHARES = (0.03, 0.1, 1.0)  # of the smallest isolines
PICTURES = (2.0 / 3.0, 1.0, 2.0)  # of the run's picture: 1280 x 720 to 3840 x 2160
STEPS = ("simplify", "compact vertices", "cull", "compact segments", "project", "bins")


def measure(work: Workload, records: Records) -> None:
    smallest = next(iter(work.sizes))
    small, *larger = ((round(scale * work.picture[0]), round(scale * work.picture[1])) for scale in PICTURES)
    arrays = work.contours("isolines", smallest)
    for share in SHARES:
        table = some_lines(arrays, share)
        measure_scene(work, records, table, f"pixel lines {share:g} of {smallest}", small)
    table = some_lines(arrays, SHARES[1])
    for width, height in larger:
        name = f"pixel lines {SHARES[1]:g} of {smallest}, {width} x {height}"
        measure_scene(work, records, table, name, (width, height))
    if work.middle != smallest:
        table = line_table(work.contours("isolines", work.middle))
        measure_scene(work, records, table, f"pixel lines of {work.middle}", small)


def measure_scene(
    work: Workload, records: Records, table: dg.FeatureTable, name: str, picture: tuple[int, int]
) -> None:
    """Measures lists, bins and bins with coverage in all views; lists that do not fit are left out."""
    work.say(name)
    scenes = {method: scene_of(work.ground, table, method) for method in ("bins", "lists")}
    renderers = {method: work.renderer(scene) for method, scene in scenes.items()}
    for renderer in renderers.values():
        renderer.set_picture(picture, "none")
    for view in VIEWS:
        camera = work.views[view]
        measures = [
            passes_of(renderers["bins"], camera, "none", "bins"),
            passes_of(renderers["bins"], camera, "coverage", "coverage"),
        ]
        fits = lists_fit(renderers["lists"], camera)
        if fits:
            measures.append(passes_of(renderers["lists"], camera, "none", "lists"))
        times = interleaved(work.runs, *measures)
        stats = draw(renderers["bins"], camera, "none").stats
        counts = stats.counts
        figures = {
            **times,
            "segments": counts["segments"],
            "matched_vertices": counts["dynamic_vertices"],
            "kept_vertices": counts["dynamic_kept_vertices"],
            "matched_segments": counts["dynamic_segments"],
            "tile_entries": counts["dynamic_tile_entries"],
            "update_share": times["bins_update_ms"] / times["bins_ms"],
            "bytes_per_vertex": stats.bytes["dynamic"] / counts["dynamic_vertices"],
        }
        if fits:
            figures["D"] = times["lists_ms"] / times["bins_ms"]
        records.at(name, view, "dynamic").update(**figures)


def lists_fit(renderer: dg.Renderer, camera: dg.Camera) -> bool:
    """Whether the driver binds the lists of a view at once."""
    try:
        draw(renderer, camera, "none")
    except MemoryError:
        return False
    return True


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
    """Measures a frame: `name`_ms of all passes, `name`_update_ms of the update of the view, and each step of it."""

    def measured() -> dict[str, float]:
        passes = draw(renderer, camera, antialias).stats.passes
        names = [one["name"] for one in passes]
        whole = passes[: names.index("silhouettes")] if "silhouettes" in names else passes
        steps = {step: sum(one["ms"] for one in whole if one["name"] == f"dynamic: {step}") for step in STEPS}
        drawing = sum(one["ms"] for one in whole if one["name"] == "dynamic")
        update = sum(steps.values())
        each = {f"{name}_{step.replace(' ', '_')}_ms": ms for step, ms in steps.items()}
        return {f"{name}_ms": update + drawing, f"{name}_update_ms": update, **each}

    return measured
