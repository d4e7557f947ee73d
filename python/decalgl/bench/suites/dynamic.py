"""Lines of 2 pixels on the screen: what they cost from few to many segments, in small and large pictures.

bins, lists   what all passes of the technique take, without anti-aliasing: the update of the view and the drawing
share_...     of what bins take, what each step of the update takes (figure 5.17c of the thesis)
simplified    bins with all vertices ÷ bins with those that the simplification leaves
elsewhere     processor time of a frame that shows ground beside all lines ÷ one of the ground alone
bytes         of the technique, by vertex, and those that grow with the picture, by pixel
"""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from .. import cameras
from ..measure import draw, interleaved
from ..workload import LINE_COLOR, line_table

if TYPE_CHECKING:
    from ..contours import Arrays
    from ..measure import Measure, Times
    from ..records import Records
    from ..workload import Workload

WIDTH = 2.0
VIEWS = ("overview", "oblique", "close")
PICTURES = (2.0 / 3.0, 1.0, 2.0)  # of the run's picture: 1280 x 720 to 3840 x 2160
STEPS = ("simplify", "compact vertices", "cull", "compact segments", "project", "bins")
PATIENCE = 10.0  # seconds: frames that take longer need no round before those that count
# Segments of a piece of a line, of which fewer lines are made: few lines lie as the many do.
PIECE = 100
# What each method holds for a view.
OF_VIEW = {way: f"dynamic: {way}" for way in ("bins", "lists")}


@dataclass(frozen=True)
class Lines:
    """A share of the isolines of a size. In pictures up to so many: what is measured there."""

    share: float
    size: str
    lists_in: int
    coverage_in: int
    runs: int = 1000


def measure(work: Workload, records: Records) -> None:
    smallest = next(iter(work.sizes))
    chosen = [Lines(0.01, smallest, 2, 3), Lines(0.1, smallest, 2, 2), Lines(1.0, smallest, 2, 2, 2)]
    if work.middle != smallest:
        chosen.append(Lines(1.0, work.middle, 1, 1, 1))
    for lines in chosen:
        arrays = work.contours("isolines", lines.size)
        table = some_lines(arrays, lines.share)
        name = f"pixel lines, {lines.share:g} of {lines.size}"
        for place, scale in enumerate(PICTURES):
            picture = (round(scale * work.picture[0]), round(scale * work.picture[1]))
            measure_scene(work, records, table, f"{name}, {picture[0]} x {picture[1]}", picture, lines, place)
        if lines.share == 1.0:
            measure_elsewhere(work, records, table, name)
    measure_simplification(work, records, some_lines(work.contours("isolines", smallest), 1.0), smallest)


def measure_scene(
    work: Workload,
    records: Records,
    table: dg.FeatureTable,
    name: str,
    picture: tuple[int, int],
    lines: Lines,
    place: int,
) -> None:
    """Measures bins, bins with coverage and lists in all views; lists that do not fit are left out."""
    work.say(name)
    ways = ("bins", "lists") if place < lines.lists_in else ("bins",)
    renderers = {way: renderer_of(work, table, dg.Dynamic(method=way)) for way in ways}  # type: ignore[arg-type]
    for renderer in renderers.values():
        renderer.set_picture(picture, "none")
    for view in VIEWS:
        camera = work.views[view]
        measures = [passes_of(renderers["bins"], camera, "none", "bins")]
        if place < lines.coverage_in:
            measures.append(passes_of(renderers["bins"], camera, "coverage", "coverage"))
        held = lists_held(renderers["lists"], camera, picture) if "lists" in ways else {}
        if held:
            measures.append(passes_of(renderers["lists"], camera, "none", "lists"))
        times = interleaved(min(work.runs, lines.runs), *measures, patience=PATIENCE)
        records.at(name, view, "dynamic").update(
            {
                "picture": f"{picture[0]} x {picture[1]}",
                **held,
                **times,
                **ratios_of(times),
                **sizes_of(draw(renderers["bins"], camera, "none").stats, "bins", picture),
            }
        )


def ratios_of(times: Times) -> Times:
    """Of one view."""
    whole = times["bins_ms"]
    steps = {step: f"bins_{step.replace(' ', '_')}_ms" for step in STEPS}
    ratios = {f"share_{step.replace(' ', '_')}": times[name] / whole for step, name in steps.items()}
    ratios["update_share"] = times["bins_update_ms"] / whole
    if "lists_ms" in times:
        ratios["D"] = times["lists_ms"] / whole
    if "coverage_ms" in times:
        ratios["filtered"] = times["coverage_ms"] / whole
    return ratios


def sizes_of(stats: dg.Stats, way: str, picture: tuple[int, int]) -> dict[str, float]:
    """Counts and bytes of one view."""
    counts = stats.counts
    of_view = stats.objects[OF_VIEW[way]]
    return {
        "segments": counts["segments"],
        "matched_vertices": counts["dynamic_vertices"],
        "kept_vertices": counts["dynamic_kept_vertices"],
        "seen_segments": counts["dynamic_segments"],
        "tile_entries": counts["dynamic_tile_entries"],
        f"{way}_bytes": stats.bytes["dynamic"],
        f"{way}_bytes_per_vertex": (stats.bytes["dynamic"] - of_view) / counts["dynamic_vertices"],
        f"{way}_bytes_per_pixel": of_view / (picture[0] * picture[1]),
    }


def measure_elsewhere(work: Workload, records: Records, table: dg.FeatureTable, name: str) -> None:
    """A view of a place without lines costs what the ground does."""
    camera = cameras.interior(work.ground, table.coords)
    with_lines = renderer_of(work, table, dg.Dynamic())
    ground = work.renderer(dg.Scene(work.ground))
    times = interleaved(
        max(work.runs, 3), whole_frame(with_lines, camera, "elsewhere"), whole_frame(ground, camera, "ground")
    )
    stats = draw(with_lines, camera, "none").stats
    records.at(name, "elsewhere", "dynamic").update(
        segments=stats.counts["segments"],
        seen_segments=stats.counts["dynamic_segments"],
        elsewhere=times["elsewhere_ms"] / times["ground_ms"],
        **times,
    )


def measure_simplification(work: Workload, records: Records, table: dg.FeatureTable, size: str) -> None:
    """What is saved by leaving out vertices that fall together."""
    picture = (round(PICTURES[0] * work.picture[0]), round(PICTURES[0] * work.picture[1]))
    cells = {"simple": dg.Dynamic(method="bins"), "every": dg.Dynamic(method="bins", cell=0.0)}
    renderers = {name: renderer_of(work, table, technique) for name, technique in cells.items()}
    for renderer in renderers.values():
        renderer.set_picture(picture, "none")
    for view in VIEWS:
        camera = work.views[view]
        times = interleaved(
            min(work.runs, 2),
            *(passes_of(renderer, camera, "none", name) for name, renderer in renderers.items()),
        )
        counts = draw(renderers["simple"], camera, "none").stats.counts
        records.at(f"pixel lines of {size}, simplified", view, "dynamic").update(
            segments=counts["segments"],
            matched_vertices=counts["dynamic_vertices"],
            kept_vertices=counts["dynamic_kept_vertices"],
            seen_segments=counts["dynamic_segments"],
            simplified=times["every_ms"] / times["simple_ms"],
            **times,
        )


def lists_held(renderer: dg.Renderer, camera: dg.Camera, picture: tuple[int, int]) -> dict[str, float]:
    """What the lists of a view hold, grown to what it needs; nothing where the driver cannot bind them."""
    try:
        return sizes_of(draw(renderer, camera, "none").stats, "lists", picture)
    except MemoryError:
        return {}


def some_lines(arrays: Arrays, share: float) -> dg.FeatureTable:
    """Every so many-th piece of the lines, or all lines as they are."""
    if share == 1.0:
        return line_table(arrays)
    offsets = arrays["offsets"]
    pieces = [np.arange(first, end - 1, PIECE) for first, end in itertools.pairwise(offsets)]
    starts = np.concatenate(pieces)
    ends = np.minimum(starts + PIECE + 1, np.repeat(offsets[1:], [len(one) for one in pieces]))
    chosen = np.arange(0, len(starts), round(1.0 / share))
    vertices = np.concatenate([np.arange(starts[i], ends[i]) for i in chosen])
    parts = np.concatenate([[0], np.cumsum(ends[chosen] - starts[chosen])])
    each = np.arange(len(parts))
    return dg.FeatureTable("lines", arrays["coordinates"][vertices], parts, each, each[:-1])


def renderer_of(work: Workload, table: dg.FeatureTable, technique: dg.Dynamic) -> dg.Renderer:
    """Of the terrain under lines of a constant width on the screen."""
    scene = dg.Scene(work.ground)
    scene.add_lines(table, color=LINE_COLOR, width=WIDTH, technique=technique)
    return work.renderer(scene)


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


def whole_frame(renderer: dg.Renderer, camera: dg.Camera, name: str) -> Measure:
    """Measures the processor time of a frame with all that is done for it, which other work disturbs less."""

    def measured() -> dict[str, float]:
        started = time.process_time()
        draw(renderer, camera, "none")
        return {f"{name}_ms": 1000.0 * (time.process_time() - started)}

    return measured
