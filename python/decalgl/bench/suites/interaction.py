"""Changes of a prepared map of short lines, up to a million: the isolines, cut into lines of a few segments.

restyle     new colours of all features ÷ a frame          filter    half of them hidden ÷ a frame
edit        a hundred neighbours moved ÷ a frame           lens      the lens moved, and drawn ÷ a frame
reorder     all features in another draw order ÷ a frame
restyled    the first picture after new colours ÷ a frame: where it shows levels of detail, they are coloured anew
widen       other widths of all features ÷ a frame
widened     the first picture after that ÷ a frame: levels of detail are found anew
"""

from __future__ import annotations

import itertools
import time
from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

from ..measure import draw, interleaved
from ..workload import LINE_WIDTH, add_lines, line_table

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..measure import Measure
    from ..records import Records
    from ..workload import Workload

SEGMENTS = 5  # of a line
MOST_FEATURES = 1_000_000
EDITED = 100
COLORS = ("crimson", "teal")
WIDTHS = (0.9 * LINE_WIDTH, LINE_WIDTH)
# By index, anti-aliasing and view; far away with coverage there is nothing but levels of detail.
CASES = {
    "grid": (("none", "overview"), ("coverage", "overview"), ("coverage", "far")),
    "bvh": (("none", "overview"),),
}
CHANGES = ("restyle", "restyled", "widen", "widened", "filter", "edit", "lens", "reorder")
TECHNIQUES = {"grid": "static", "bvh": "bvh"}


def measure(work: Workload, records: Records) -> None:
    table = _short_lines(line_table(work.contours("isolines", work.middle)))
    work.say(f"{len(table):,} features")
    scene = dg.Scene(work.ground)
    layer = add_lines(scene, table, widest=LINE_WIDTH)
    for index, cases in CASES.items():
        renderer = work.renderer(scene, index)
        for antialias, view in cases:
            draw(renderer, work.views[view], antialias)
            times = interleaved(work.runs, *_changes(renderer, layer, work, antialias, view))
            name = "" if index == "grid" else f', index="{index}"'
            record = records.at(f"{len(table):,} short lines, {antialias}{name}", view, TECHNIQUES[index])
            record.update(times)
            for change in CHANGES:
                record[change] = times[f"{change}_ms"] / times["frame_ms"]
        del renderer


def _changes(
    renderer: dg.Renderer, layer: dg.Layer, work: Workload, antialias: str, view: str
) -> list[Measure]:
    count = len(layer.features)
    random = np.random.default_rng(1)
    colors, widths = itertools.cycle(COLORS), itertools.cycle(WIDTHS)
    firsts = itertools.cycle(range(0, max(count - EDITED, 1), EDITED))

    def edit() -> None:
        first = next(firsts)
        rows = layer.rows[first : first + EDITED].tolist()
        renderer.edit(layer, move=dict.fromkeys(rows, (3.0, -2.0)))

    def set_lens() -> dict[str, float]:
        renderer.lens = dg.Lens(circle=(0, 0, 1), styles={layer.index: {"color": "black"}})
        renderer.render()
        return {}

    def remove_lens() -> dict[str, float]:
        renderer.lens = None
        return {}

    def look() -> None:
        assert renderer.lens is not None
        x, y = random.uniform(0.3, 0.7, 2) * work.picture
        renderer.lens = renderer.lens.moved(circle=(x, y, work.picture[1] / 4))
        renderer.render()

    return [
        _timed("frame", lambda: draw(renderer, work.views[view], antialias)),
        _timed("restyle", lambda: renderer.restyle(layer, color=next(colors))),
        _timed("restyled", renderer.render),
        _timed("widen", lambda: renderer.restyle(layer, width=next(widths))),
        _timed("widened", renderer.render),
        _timed("filter", lambda: renderer.restyle(layer, visible=random.random(count) < 0.5)),
        _timed("reorder", lambda: renderer.restyle(layer, order=random.random(count))),
        _timed("edit", edit),
        set_lens,
        _timed("lens", look),
        remove_lens,
    ]


def _timed(name: str, act: Callable[[], object]) -> Measure:
    def run() -> dict[str, float]:
        started = time.perf_counter()
        act()
        return {f"{name}_ms": 1e3 * (time.perf_counter() - started)}

    return run


def _short_lines(table: dg.FeatureTable) -> dg.FeatureTable:
    """Lines of SEGMENTS segments, each from where the one before it ends; what is left over of a line is left out."""
    segments = np.diff(table.part_offsets) - 1
    pieces = np.maximum(segments // SEGMENTS, 0)
    starts = np.repeat(table.part_offsets[:-1], pieces) + SEGMENTS * (
        np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    )
    starts = starts[:MOST_FEATURES]
    coords = table.coords[(starts[:, None] + np.arange(SEGMENTS + 1)).ravel()]
    features = np.arange(len(starts) + 1)
    return dg.FeatureTable("lines", coords, (SEGMENTS + 1) * features, features, features[:-1])
