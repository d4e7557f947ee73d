"""One more layer, and none: the isolines cut by elevation into layers that are added one by one.

layer    terrain, layers and composing with k + 1 layers ÷ with k; the median step
empty    terrain and composing of a scene without layers ÷ of the one with all
"""

from __future__ import annotations

import itertools
import statistics
from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from ..measure import drawing, interleaved
from ..workload import add_lines, line_table

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload

MOST_LAYERS = 8
VIEWS = ("overview", "close")


def measure(work: Workload, records: Records) -> None:
    work.say(f"up to {MOST_LAYERS} layers")
    pieces = _cut(line_table(work.contours("isolines", work.middle)), MOST_LAYERS)
    renderers = [work.renderer(_scene(work.ground, pieces[:count])) for count in range(MOST_LAYERS + 1)]
    for view in VIEWS:
        drawn = [drawing(one, work.views[view], "none", str(count)) for count, one in enumerate(renderers)]
        times = interleaved(work.runs, *drawn)
        frames = [times[f"{count}_ms"] + times[f"{count}_ground_ms"] for count in range(MOST_LAYERS + 1)]
        steps = [after / before for before, after in itertools.pairwise(frames[1:])]
        ground = times[f"{MOST_LAYERS}_ground_ms"]
        records.at(f"{MOST_LAYERS} layers of isolines {work.middle}", view).update(
            frame_ms=frames,
            layer=statistics.median(steps),
            empty_ms=frames[0],
            ground_ms=ground,
            empty=frames[0] / ground,
        )


def _scene(ground: dg.Terrain, layers: list[dg.FeatureTable]) -> dg.Scene:
    scene = dg.Scene(ground)
    for layer in layers:
        add_lines(scene, layer)
    return scene


def _cut(table: dg.FeatureTable, count: int) -> list[dg.FeatureTable]:
    """Runs of consecutive lines with about equally many vertices each."""
    goals = len(table.coords) * np.arange(count + 1) // count
    ends = np.searchsorted(table.part_offsets, goals)
    return [_run(table, first, last) for first, last in itertools.pairwise(ends.tolist())]


def _run(table: dg.FeatureTable, first: int, last: int) -> dg.FeatureTable:
    offsets = table.part_offsets[first : last + 1]
    each = np.arange(last - first + 1)
    return dg.FeatureTable(
        "lines", table.coords[offsets[0] : offsets[-1]], offsets - offsets[0], each, each[:-1]
    )
