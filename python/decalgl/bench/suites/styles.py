"""What looks cost: the same lines and polygons with every style, and with every way of anti-aliasing.

style    the layers' pass without anti-aliasing ÷ that of plain ones (Zechmeister 2020, figures 5.14 and 5.16)
mode     a whole frame with a mode of anti-aliasing ÷ one without (his figure 5.9)

Plain are round opaque lines of one width and even opaque fills. Every group of styles takes turns with
them, in pictures of a quarter of the pixels, as there are many.
"""

from __future__ import annotations

import dataclasses
import itertools
from typing import TYPE_CHECKING, Any

import decalgl as dg

from ..measure import drawing, interleaved
from ..workload import LINE_WIDTH, add_contours

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..records import Records
    from ..workload import Workload

    Looks = dict[str, Any]

VIEWS = ("close", "oblique")
TOGETHER = 5  # scenes that are held at once
DASH = (20.0, 10.0)
OUTLINE: Looks = {"width": LINE_WIDTH, "width_units": "m"}
LINE_STYLES: dict[str, Looks] = {
    **{
        f"width x{times}, alpha {alpha:g}": {"width": times * LINE_WIDTH, "alpha": alpha}
        for times, alpha in itertools.product((1, 4, 16), (1.0, 0.5, 0.25))
        if (times, alpha) != (1, 1.0)
    },
    "miter": {"corner": "miter"},
    "bevel": {"corner": "bevel"},
    "butt": {"cap": "butt"},
    "square": {"cap": "square"},
    "dashed": {"dash": DASH},
    "bands": {"bands": [(0.5, "white"), (1.0, "black")]},
    "casing": {"casing": dg.Casing(width=LINE_WIDTH / 3.0)},
    "tangent": {"slope_correction": "tangent"},
    "thoeny": {"slope_correction": "thoeny"},
}
FILL_STYLES: dict[str, Looks] = {
    "outlines": {"outline": dg.Outline(**OUTLINE)},
    "inset outlines": {"outline": dg.Outline(mode="inset", **OUTLINE)},
    "offset outlines": {"outline": dg.Outline(mode="offset", **OUTLINE)},
    "hatch": {"hatch": dg.Hatch(spacing=60.0, width=20.0)},
}
TREE_STYLES = ("miter", "dashed")
MODES = ("coverage", "fxaa", "msaa", "ssaa")
SAMPLES = 4
FEW = 2  # rounds of what takes many passes


def measure(work: Workload, records: Records) -> None:
    width, height = work.picture
    work = dataclasses.replace(work, picture=(width // 2, height // 2))
    for kind, styles in (("isolines", LINE_STYLES), ("iso-bands", FILL_STYLES)):
        _styles(work, records, kind, styles, "grid")
        _modes(work, records, kind)
    _styles(work, records, "isolines", {name: LINE_STYLES[name] for name in TREE_STYLES}, "bvh")
    _slow_coverage(work, records)


def _styles(work: Workload, records: Records, kind: str, styles: dict[str, Looks], index: str) -> None:
    plain = work.renderer(_scene(work, kind, {}), index)
    for group in _batches(styles):
        work.say(f"{kind}, {index}: {', '.join(group)}")
        renderers = {name: work.renderer(_scene(work, kind, styles[name]), index) for name in group}
        for view in VIEWS:
            measures = [drawing(one, work.views[view], "none", name) for name, one in renderers.items()]
            times = interleaved(work.runs, drawing(plain, work.views[view], "none", "plain"), *measures)
            for name in group:
                style_ms, plain_ms = times[f"{name}_ms"], times["plain_ms"]
                _record(work, records, kind, name, view, index).update(
                    style_ms=style_ms, plain_ms=plain_ms, style=style_ms / plain_ms
                )


def _modes(work: Workload, records: Records, kind: str) -> None:
    work.say(f"{kind}: {', '.join(MODES)}")
    renderer = work.renderer(_scene(work, kind, {}), samples=SAMPLES)
    for view in VIEWS:
        measures = [drawing(renderer, work.views[view], mode, mode) for mode in ("none", *MODES)]
        times = interleaved(min(work.runs, FEW), *measures)
        for mode in MODES:
            _record_mode(work, records, kind, mode, view, "grid", times)


def _slow_coverage(work: Workload, records: Records) -> None:
    """Lines alone, and once: Thöny's, which looks into all cells around, and that of trees, with 64 walks a pixel."""
    scene = _scene(work, "isolines", {})
    options: dict[str, tuple[str, Looks]] = {
        "coverage thoeny": ("grid", {"coverage": "thoeny"}),
        "coverage": ("bvh", {}),
    }
    for mode, (index, chosen) in options.items():
        work.say(f"isolines, {index}: {mode}")
        renderer = work.renderer(scene, index, **chosen)
        for view in VIEWS:
            none = drawing(renderer, work.views[view], "none", "none")
            times = interleaved(1, none, drawing(renderer, work.views[view], "coverage", mode))
            _record_mode(work, records, "isolines", mode, view, index, times)


def _record_mode(
    work: Workload, records: Records, kind: str, mode: str, view: str, index: str, times: dict[str, float]
) -> None:
    mode_ms, none_ms = times[f"{mode}_frame_ms"], times["none_frame_ms"]
    found = _record(work, records, kind, mode, view, index)
    found.update(mode_ms=mode_ms, none_ms=none_ms, mode=mode_ms / none_ms, mode_layers_ms=times[f"{mode}_ms"])


def _record(work: Workload, records: Records, kind: str, name: str, view: str, index: str) -> dict[str, Any]:
    technique = "static" if index == "grid" else index
    return records.at(f"{kind} {work.middle}, {name}", view, technique)


def _scene(work: Workload, kind: str, looks: Looks) -> dg.Scene:
    scene = dg.Scene(work.ground)
    add_contours(scene, kind, work.contours(kind, work.middle), **looks)
    return scene


def _batches(names: Iterable[str]) -> list[tuple[str, ...]]:
    left = list(names)
    return [tuple(left[i : i + TOGETHER]) for i in range(0, len(left), TOGETHER)]
