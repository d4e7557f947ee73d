"""What looks cost: the same lines and polygons with every style, and with every way of anti-aliasing, in every index.

style    the layers' pass without anti-aliasing ÷ that of plain ones (Zechmeister 2020, figures 5.14 and 5.16)
mode     a whole frame with a mode of anti-aliasing ÷ one without (his figure 5.9)

Plain are round opaque lines of one width and even opaque fills. Every group of styles takes turns with
them, in pictures of a quarter of the pixels, as there are many.
"""

from __future__ import annotations

import dataclasses
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

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
    "a width each": {"width": lambda count: LINE_WIDTH * (0.5 + np.arange(count) % 8 / 8.0)},
    "a colour each": {"color": lambda count: [("navy", "crimson", "teal")[i % 3] for i in range(count)]},
    "dashed": {"dash": DASH},
    "stippled": {"dash": dg.Pattern.stipple("1101", step=6.0)},
    "arrows": {"dash": dg.Pattern.arrows(every=60.0, length=20.0, shaft=0.3)},
    "bands": {"bands": [(0.5, "white"), (1.0, "black")]},
    "casing": {"casing": dg.Casing(width=LINE_WIDTH / 3.0)},
    "tangent": {"slope_correction": "tangent"},
    "thoeny": {"slope_correction": "thoeny"},
    "order by size": {"order": "size"},
}
FILL_STYLES: dict[str, Looks] = {
    "outlines": {"outline": dg.Outline(**OUTLINE)},
    "outlines each over its fill": {"outline": dg.Outline(order="feature", **OUTLINE)},
    "inset outlines": {"outline": dg.Outline(mode="inset", **OUTLINE)},
    "offset outlines": {"outline": dg.Outline(mode="offset", **OUTLINE)},
    "hatch": {"hatch": dg.Hatch(spacing=60.0, width=20.0)},
    "crossed hatch": {"hatch": dg.Hatch(spacing=60.0, width=20.0, crossed=True)},
    "alpha 0.5": {"alpha": 0.5},
    "order by size": {"order": "size"},
}
# By what they are of, and by index; Thöny's is for lines alone.
STYLES = {"isolines": LINE_STYLES, "iso-bands": FILL_STYLES}
INDEXES = {"isolines": ("grid", "bvh", "thoeny"), "iso-bands": ("grid", "bvh")}
# Ways of anti-aliasing, by what a renderer is made with. Thöny's coverage is of lines alone.
MODES: tuple[tuple[Looks, tuple[str, ...]], ...] = (
    ({"samples": 4}, ("coverage", "fxaa", "msaa", "ssaa")),
    ({"samples": 8}, ("msaa", "ssaa")),
    ({"coverage": "thoeny"}, ("coverage",)),
)
FEW = 2  # rounds of what takes many passes
PATIENCE = 1.0  # seconds: frames that take longer need no round before those that count


def measure(work: Workload, records: Records) -> None:
    width, height = work.picture
    work = dataclasses.replace(work, picture=(width // 2, height // 2))
    for kind, indexes in INDEXES.items():
        for index in indexes:
            _styles(work, records, kind, index)
            _modes(work, records, kind, index)


def _styles(work: Workload, records: Records, kind: str, index: str) -> None:
    plain = work.renderer(_scene(work, kind, {}), index)
    styles = STYLES[kind]
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


def _modes(work: Workload, records: Records, kind: str, index: str) -> None:
    """Each beside none."""
    scene = _scene(work, kind, {})
    for options, modes in MODES:
        if "coverage" in options and kind != "isolines":
            continue
        names = {mode: _name(mode, options) for mode in modes}
        work.say(f"{kind}, {index}: {', '.join(names.values())}")
        renderer = work.renderer(scene, index, **options)
        for view in VIEWS:
            drawn = {"none": "none", **names}
            measures = [drawing(renderer, work.views[view], mode, name) for mode, name in drawn.items()]
            try:
                times = interleaved(min(work.runs, FEW), *measures, patience=PATIENCE)
            except dg.UnsupportedError as error:
                work.say(f"{view}: {error}")  # trees of very many lines, by Thöny's coverage: no row
                continue
            for name in names.values():
                mode_ms, none_ms = times[f"{name}_frame_ms"], times["none_frame_ms"]
                _record(work, records, kind, name, view, index).update(
                    mode_ms=mode_ms,
                    none_ms=none_ms,
                    mode=mode_ms / none_ms,
                    mode_layers_ms=times[f"{name}_ms"],
                )


def _name(mode: str, options: Looks) -> str:
    """Such as msaa 8, or coverage thoeny."""
    if mode in ("msaa", "ssaa"):
        return f"{mode} {options['samples']}"
    return f"{mode} thoeny" if "coverage" in options else mode


def _record(work: Workload, records: Records, kind: str, name: str, view: str, index: str) -> dict[str, Any]:
    technique = "static" if index == "grid" else index
    return records.at(f"{kind} {work.middle}, {name}", view, technique)


def _scene(work: Workload, kind: str, looks: Looks) -> dg.Scene:
    """looks: keywords, or what makes one of the number of features."""
    scene = dg.Scene(work.ground)
    arrays = work.contours(kind, work.middle)
    count = len(arrays["heights"]) if kind == "iso-bands" else len(arrays["offsets"]) - 1
    given = {name: look(count) if callable(look) else look for name, look in looks.items()}
    add_contours(scene, kind, arrays, **given)
    return scene


def _batches(names: Iterable[str]) -> list[tuple[str, ...]]:
    left = list(names)
    return [tuple(left[i : i + TOGETHER]) for i in range(0, len(left), TOGETHER)]
