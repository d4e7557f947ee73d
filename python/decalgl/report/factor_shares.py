"""Figures of Zechmeister 2020, chapter 5, that no single factor tells: shares by kind of decal, step and anti-aliasing.

5.6     shares of memory, preparing and drawing by kind of decal
5.7     drawing while everything is out of view, by kind
5.9     shares of drawing that anti-aliasing takes
5.11    a part of the picture, enlarged, by mode of anti-aliasing
5.14b   static lines by width and opacity     5.15c   dynamic lines by width, opacity and colours
5.17c   the steps of dynamic lines by resolution
"""

from __future__ import annotations

import itertools
import statistics
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..bench.measure import LAYER_PASSES, draw, timed
from . import derive, plots
from .factor_list import scene_of
from .part import Figure

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from .factor_list import Maps
    from .part import Context, Row

KINDS = ("exterior rings", "interior rings", "static lines", "dynamic lines")
PIXELS: dict[str, Any] = {"width": 2.0, "width_units": "px", "technique": "dynamic"}
MODES = {"static lines": ("none", "msaa", "coverage"), "dynamic lines": ("none", "fxaa", "coverage")}
PART, TIMES = 48, 8  # pixels of what is enlarged, and how much
SHARES = "Of memory, preparing and drawing, with static or dynamic lines beside the polygons; each kind measured alone."
AGAINST = "What anti-aliasing adds to a frame with none, as a share of the frame; msaa of 4 samples."
WIDTHS, OPACITIES = (1.0, 4.0, 16.0), (1.0, 0.5, 0.25)


def rows(context: Context, maps: Maps) -> Iterator[Row]:
    """What each figure shows, one value a row."""
    oblique = maps.cameras["oblique"]
    for kind in KINDS:
        seen = _measured(context, _of_kind(maps, kind), oblique, maps.size)
        yield {"figure": "5.6", "kind": kind, **seen.row("memory_bytes", "update_ms", "render_ms")}
        away = _measured(context, _of_kind(maps, kind, 0.9), maps.nothing, maps.size)
        yield {"figure": "5.7", "kind": kind, **away.row("render_ms")}
    for kind, modes in MODES.items():
        for mode in modes:
            found = _measured(context, _of_kind(maps, kind), oblique, maps.size, mode)
            picture = context.save_picture(f"enlarged {kind} {mode}", found.enlarged())
            yield {"figure": "5.9", "kind": kind, "mode": mode, "picture": picture, **found.row("frame_ms")}
    yield from _of_widths(context, maps, oblique)
    for share in (0.5, 1.0, 2.0):
        width, height = (round(share * pixels) for pixels in maps.size)
        found = _measured(context, _of_kind(maps, "dynamic lines"), oblique, (width, height), "fxaa")
        for name, ms in found.steps.items():
            yield {"figure": "5.17c", "kind": name, "resolution": f"{width} x {height}", "render_ms": ms}


def _of_widths(context: Context, maps: Maps, camera: dg.Camera) -> Iterator[Row]:
    many = list(np.resize(["crimson", "navy", "teal"], len(maps.lines)))
    few = context.chosen((0,), (0, 1), (0, 1, 2))
    for width, opacity in itertools.product([WIDTHS[i] for i in few], [OPACITIES[i] for i in few]):
        words = {"width": f"{width:g}", "opacity": f"{opacity:g}"}
        static = scene_of(maps, None, maps.lines, width=width * maps.line_width, alpha=opacity)
        for index, kind in (("bvh", "published"), ("grid", "ours")):
            found = _measured(context, static, camera, maps.size, index=index)
            yield {"figure": "5.14b", **words, "kind": kind, **found.row("render_ms")}
        for color, kind in (("#7a5a36", "one colour"), (many, "many colours")):
            looks = {**PIXELS, "width": width, "alpha": opacity, "color": color}
            found = _measured(context, scene_of(maps, None, maps.lines, **looks), camera, maps.size)
            yield {"figure": "5.15c", **words, "kind": kind, **found.row("render_ms")}


def _of_kind(maps: Maps, kind: str, share: float = 1.0) -> dg.Scene:
    """Interior rings alone are polygons: a hole is one as good as what lies around it."""
    polygons, lines = (maps.shrunk(each, share) for each in (maps.polygons, maps.lines))
    if kind == "exterior rings":
        return scene_of(maps, derive.without_holes(polygons))
    if kind == "interior rings":
        return scene_of(maps, derive.holes(polygons))
    return scene_of(maps, None, lines, **(PIXELS if kind == "dynamic lines" else {}))


@dataclass(frozen=True)
class _Found:
    """Medians over some frames, by the names of rows; steps: milliseconds of passes, terrain and reading apart."""

    values: dict[str, float]
    steps: dict[str, float]
    image: NDArray[np.uint8]

    def row(self, *names: str) -> Row:
        return {name: self.values[name] for name in names}

    def enlarged(self) -> NDArray[np.uint8]:
        """The middle of the picture."""
        top, left = ((count - PART) // 2 for count in self.image.shape[:2])
        part = self.image[max(0, top) : top + PART, max(0, left) : left + PART]
        return part.repeat(TIMES, axis=0).repeat(TIMES, axis=1)


def _measured(
    context: Context,
    scene: dg.Scene,
    camera: dg.Camera,
    size: tuple[int, int],
    mode: str = "none",
    index: Any = "grid",
) -> _Found:
    renderer = dg.Renderer(size, index=index, samples=4)
    update = timed(lambda: renderer.preprocess(scene))
    frames = [draw(renderer, camera, mode) for _ in range(1 + context.runs)][1:]
    times = [_times(frame.stats.passes) for frame in frames]
    steps = {name: statistics.median(each.get(name, 0.0) for each in times) for name in times[0]}
    frame = statistics.median(sum(each.values()) for each in times)
    layers = statistics.median(
        sum(each.values()) - each.get("terrain", 0.0) - each["compose"] for each in times
    )
    held = sum(count for name, count in frames[0].stats.bytes.items() if name in LAYER_PASSES)
    values = {"memory_bytes": held, "update_ms": update, "frame_ms": frame, "render_ms": layers}
    own = {name: ms for name, ms in steps.items() if name not in ("terrain", "readback")}
    return _Found(values, own, frames[0].image[..., :3])


def _times(passes: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    found: dict[str, float] = {}
    for one in passes:
        found[one["name"]] = found.get(one["name"], 0.0) + one["ms"]
    return found


def figures(rows: Sequence[Row]) -> list[Figure]:
    """A figure for each of the thesis's."""
    own = {
        name: [row for row in rows if row.get("figure") == name]
        for name in dict.fromkeys(row.get("figure") for row in rows)
    }
    if not own.get("5.6"):
        return []
    return [
        Figure("Figure 5.6: kinds of decals", SHARES, plots.bars(_shares(own["5.6"]), "share")),
        Figure(
            "Figure 5.7: everything out of view",
            "Drawing by kind of decal, while the camera looks at a corner that nothing lies on.",
            plots.bars({"out of view": {row["kind"]: row["render_ms"] for row in own["5.7"]}}, "ms"),
        ),
        Figure(
            "Figure 5.9: anti-aliasing", AGAINST, plots.bars(_of_antialias(own["5.9"]), "share of the frame")
        ),
        Figure(
            "Figure 5.11: a part, enlarged",
            f"The middle of the picture, {PART} pixels wide.",
            pictures={f"{row['kind']}, {row['mode']}": row["picture"] for row in own["5.9"]},
        ),
        _widths("Figure 5.14b: static lines by width and opacity", own["5.14b"]),
        _widths("Figure 5.15c: dynamic lines by width, opacity and colours", own["5.15c"]),
        Figure(
            "Figure 5.17c: steps of dynamic lines by resolution",
            "With FXAA, terrain apart.",
            plots.bars(_by(own["5.17c"], "resolution", "kind"), "ms"),
        ),
    ]


def _by(rows: Sequence[Row], group: str, name: str) -> dict[str, dict[str, float]]:
    found: dict[str, dict[str, float]] = {}
    for row in rows:
        found.setdefault(row[group], {})[row[name]] = row["render_ms"]
    return found


def _shares(rows: Sequence[Row]) -> dict[str, dict[str, float]]:
    """Of static lines with both kinds of polygons, and of dynamic lines with them."""
    found = {}
    for lines in ("static lines", "dynamic lines"):
        own = [row for row in rows if row["kind"] in (*KINDS[:2], lines)]
        for column, name in (
            ("memory_bytes", "memory"),
            ("update_ms", "preparing"),
            ("render_ms", "drawing"),
        ):
            whole = sum(row[column] for row in own)
            found[f"{name}, {lines.split()[0]}"] = {row["kind"]: row[column] / whole for row in own}
    return found


def _of_antialias(rows: Sequence[Row]) -> dict[str, dict[str, float]]:
    """What of a frame anti-aliasing adds to one with none."""
    plain = {row["kind"]: row["frame_ms"] for row in rows if row["mode"] == "none"}
    found: dict[str, dict[str, float]] = {}
    for row in rows:
        if row["mode"] != "none":
            found.setdefault(row["kind"], {})[row["mode"]] = max(
                0.0, 1.0 - plain[row["kind"]] / row["frame_ms"]
            )
    return found


def _widths(title: str, rows: Sequence[Row]) -> Figure:
    series: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        series.setdefault(f"{row['kind']}, {row['opacity']}", []).append(
            (float(row["width"]), row["render_ms"])
        )
    return Figure(
        title,
        "Milliseconds of drawing over the width, by opacity.",
        plots.curves(series, "times as wide", "ms"),
    )
