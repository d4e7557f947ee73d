"""The keys of a legend: matplotlib artists that look like a layer's features.

polygons   a patch: fill or hatch, outline        lines   a line: casing, bands or marks, dashes, caps
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ._colors import Rgba
    from .layer import Layer
    from .strokes import Hatch, LinePattern, Stroke, StrokeStyle

# Lines have widths in metres and legends have none: the widest line of a layer is drawn this wide, in points.
WIDEST_LINE, THINNEST_LINE = 5.0, 0.75
WIDEST_OUTLINE = 2.0
LONGEST_PERIOD = 10.0  # points, so that a key shows a pattern twice


@dataclass(frozen=True)
class _Entry:
    """A line of a legend: its text, its colour from 0 to 1, and a feature that looks like it, None without any."""

    label: str
    color: Rgba
    feature: int | None


def plain(text: str) -> str:
    """A text of the user's data, in which a dollar begins no formula."""
    return text.replace("$", r"\$")


def keys(layer: Layer) -> list[Any]:
    """An artist with a label for each entry of the layer's legend."""
    make = _patch if layer.kind == "polygons" else _line
    return [make(layer, entry) for entry in _entries(layer)]


def _entries(layer: Layer) -> list[_Entry]:
    coloring = layer.legend_coloring
    first = 0 if len(layer.features) else None
    if coloring.kind == "listed":
        return []
    colors = [_share(color) for color in coloring.label_colors]
    if coloring.kind == "single":
        return [_Entry(plain(layer.name), colors[0], first)]
    places, features = np.unique(coloring.label_of, return_index=True)
    feature_of = dict(zip(places.tolist(), features.tolist(), strict=True))
    return [
        _Entry(plain(label), color, feature_of.get(place))
        for place, (label, color) in enumerate(zip(coloring.labels, colors, strict=True))
    ]


def _patch(layer: Layer, entry: _Entry) -> Any:
    from matplotlib.patches import Patch

    feature = 0 if entry.feature is None else entry.feature
    if layer.legend_coloring is layer.coloring:
        color: Any = entry.color
    else:
        color = (
            _share(layer.fill.colors[feature]) if layer.fill is not None and len(layer.features) else "none"
        )
    hatch = _hatch_of(layer, feature)
    patch = Patch(facecolor="none" if hatch else color, edgecolor="none", label=entry.label)
    if hatch is not None:
        patch.set_hatch(_hatch_symbol(hatch))
        # Before matplotlib 3.11 hatches have the colour of the edge.
        getattr(patch, "set_hatchcolor", patch.set_edgecolor)(color)
        patch.set_linewidth(0.0)
    stroke = layer.stroke
    if stroke is None or not len(layer.features) or not stroke.colors[feature, 3]:
        return patch
    edge = entry.color if layer.legend_coloring is not layer.coloring else _share(stroke.colors[feature])
    width = _points(stroke.widths[feature], stroke, WIDEST_OUTLINE)
    patch.set_edgecolor(edge)
    patch.set_linewidth(width)
    patch.set_linestyle(_linestyle(_style_of(stroke, feature), stroke.widths[feature], width))
    return patch


def _line(layer: Layer, entry: _Entry) -> Any:
    from matplotlib.lines import Line2D

    stroke = layer.stroke
    if stroke is None or not len(layer.features):
        return Line2D([], [], color=entry.color, label=entry.label)
    feature = 0 if entry.feature is None else entry.feature
    style = _style_of(stroke, feature)
    width = _points(stroke.widths[feature], stroke, WIDEST_LINE)
    line = Line2D([], [], color=entry.color, linewidth=width, label=entry.label)
    line.set_linestyle(_linestyle(style, stroke.widths[feature], width))
    caps: dict[str, Any] = {"round": "round", "butt": "butt", "square": "projecting"}
    line.set_solid_capstyle(caps[style.cap])
    line.set_dash_capstyle("butt")
    effects = _effects(layer, feature, style, width, entry.color)
    if effects:
        line.set_path_effects(effects)
    return line


def _effects(layer: Layer, feature: int, style: StrokeStyle, width: float, color: Rgba) -> list[Any]:
    """What a line's key is drawn as in place of a plain line: its casing, then its bands or marks or itself."""
    from matplotlib.patheffects import Stroke as Effect

    effects: list[Any] = []
    casing, stroke = layer.casing, layer.stroke
    if casing is not None and stroke is not None and casing.colors[feature, 3]:
        wider = min(width * casing.widths[feature] / stroke.widths[feature], width + WIDEST_LINE)
        solid = {"dash_offset": 0.0, "dash_list": None}
        effects.append(Effect(linewidth=wider, dashes=solid, **_paint(_share(casing.colors[feature]))))
    for band in reversed(style.bands):
        red, green, blue, alpha = (channel / 255.0 for channel in band.color)
        own = (red, green, blue, alpha * color[3])
        effects.append(Effect(linewidth=width * band.reach, **_paint(own)))
    if style.pattern is not None and not style.bands and _is_tapered(style.pattern):
        effects.append(_tapered_marks(style.pattern))
    elif effects and not style.bands:
        effects.append(Effect(snap=False))
    return effects


def _paint(color: Rgba) -> dict[str, Any]:
    # Lines that are not moved to whole pixels lie evenly on their casings.
    return {"foreground": color[:3], "alpha": color[3], "snap": False}


def _is_tapered(pattern: LinePattern) -> bool:
    return any(mark.begin_width != 1.0 or mark.end_width != 1.0 for mark in pattern.marks)


def _tapered_marks(pattern: LinePattern) -> Any:
    """A path effect that draws a pattern's trapezoids along a key, two periods of them."""
    from matplotlib.path import Path
    from matplotlib.patheffects import AbstractPathEffect
    from matplotlib.transforms import IdentityTransform

    class Marks(AbstractPathEffect):
        def draw_path(self, renderer: Any, gc: Any, tpath: Any, affine: Any, rgbFace: Any = None) -> None:  # noqa: ARG002, N803
            (x0, y), (x1, _) = tpath.transformed(affine).vertices[[0, -1]]
            scale, half = 0.5 * (x1 - x0) / pattern.period, 0.5 * gc.get_linewidth()
            own = renderer.new_gc()
            own.copy_properties(gc)
            own.set_linewidth(0.0)
            for mark in pattern.marks:
                for start in (x0, 0.5 * (x0 + x1)):
                    begin, end = start + scale * mark.begin, start + scale * mark.end
                    low, high = half * mark.begin_width, half * mark.end_width
                    corners = [(begin, y - low), (end, y - high), (end, y + high), (begin, y + low)]
                    shape = Path([*corners, corners[0]], closed=True)
                    renderer.draw_path(own, shape, IdentityTransform(), gc.get_rgb())
            own.restore()

    return Marks()


def _share(color: NDArray[np.uint8]) -> Rgba:
    red, green, blue, alpha = (color / 255.0).tolist()
    return red, green, blue, alpha


def _style_of(stroke: Stroke, feature: int) -> StrokeStyle:
    return stroke.styles[0 if stroke.style_of is None else stroke.style_of[feature]]


def _hatch_of(layer: Layer, feature: int) -> Hatch | None:
    fill = layer.fill
    if fill is None:
        return None
    if fill.hatch_of is None:
        return fill.hatches[0]
    return fill.hatches[fill.hatch_of[feature]] if len(fill.hatch_of) else None


def _hatch_symbol(hatch: Hatch) -> str:
    """matplotlib's hatch of the nearest angle."""
    turn = round(hatch.angle / 45.0) % 4
    return (("++", "xx")[turn % 2] if hatch.crossed else ("--", "//", "||", "\\\\")[turn]) * 2


def _points(width: float, stroke: Stroke, most: float) -> float:
    """How wide a line is in a legend."""
    return max(THINNEST_LINE, most * float(width) / float(stroke.widths.max()))


def _linestyle(style: StrokeStyle, width: float, points: float) -> Any:
    """matplotlib's (offset, lengths on and off), in multiples of the line's width there."""
    pattern = style.pattern
    if pattern is None:
        return "solid"
    runs = _runs((mark.begin, mark.end) for mark in pattern.marks)
    lengths = []
    for (begin, end), (following, _) in zip(
        runs, [*runs[1:], (runs[0][0] + pattern.period, 0.0)], strict=True
    ):
        lengths += [end - begin, following - end]
    # In points a key shows the pattern to scale, or smaller where it would not fit.
    scale = min(points / float(width), LONGEST_PERIOD / pattern.period) / points
    offset = (pattern.offset - runs[0][0]) * scale
    return offset, [length * scale for length in lengths]


def _runs(marks: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Marks in order, those that touch as one."""
    runs: list[tuple[float, float]] = []
    for begin, end in sorted(marks):
        if runs and begin <= runs[-1][1]:
            runs[-1] = (runs[-1][0], max(end, runs[-1][1]))
        else:
            runs.append((begin, end))
    return runs
