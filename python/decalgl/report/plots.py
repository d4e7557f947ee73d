"""Plots in one look, as SVG to be put into a page: scatters with a front of best points, and curves.

matplotlib draws them without a screen; the same numbers give the same bytes.
"""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Techniques look alike in all plots: colour and marker.
LOOKS = {
    "static": ("#1b6ca8", "o"),
    "static bvh": ("#d1495b", "s"),
    "static thoeny": ("#edae49", "D"),
    "dynamic": ("#7b2d8b", "^"),
    "loops": ("#2a9d5c", "v"),
    "volume": ("#8d6e4b", "P"),
    "clipmap": ("#5f6b73", "X"),
    "distance_field": ("#e07a1f", "*"),
    "static coverage": ("#18a3a3", "<"),
    "dynamic bins": ("#7b2d8b", "^"),
    "dynamic lists": ("#b0407f", ">"),
    "dynamic coverage": ("#c79ae0", "p"),
}
OTHERS = (
    "#1b6ca8",
    "#d1495b",
    "#edae49",
    "#7b2d8b",
    "#2a9d5c",
    "#8d6e4b",
    "#5f6b73",
    "#e07a1f",
    "#18a3a3",
    "#b0407f",
)
MARKERS = "osD^vPX*<>"
FEW_POWERS = 300.0
INK, GRID = "#2b2f33", "#dfe3e6"
STYLE: Any = {
    "svg.hashsalt": "decalgl",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 10,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": "#9aa3a9",
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": GRID,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 9,
}
PROLOGUE = re.compile(r"^.*?(?=<svg)|<metadata>.*?</metadata>", re.DOTALL)


@dataclass(frozen=True)
class Point:
    """A measured point: group: a technique or another kind. link: the address of its picture."""

    x: float
    y: float
    group: str
    label: str
    link: str = ""


def new(width: float = 7.4, height: float = 4.4) -> tuple[Figure, Axes]:
    """An empty plot, inches wide and high, to be drawn on and given to `svg`."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        return figure, figure.add_subplot()


def svg(figure: Figure) -> str:
    """The plot as an SVG element that takes the width that it is given."""
    import matplotlib as mpl
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    text = io.StringIO()
    canvas: Any = FigureCanvasSVG(figure)
    with mpl.rc_context(STYLE):
        canvas.print_svg(text, metadata={"Date": None, "Creator": None})
    drawn = PROLOGUE.sub("", text.getvalue())
    head, rest = drawn.split(">", 1)
    head = re.sub(r' (width|height)="[^"]*"', "", head)
    return f"{head}>{rest}".rstrip() + "\n"


def scatter(
    points: Sequence[Point],
    x_label: str,
    y_label: str,
    log: str = "xy",
    front: bool = True,
) -> str:
    """Points by group, each a link to its picture. front: a line along those that no other beats in both, as SVG."""
    figure, axes = new()
    for place, group in enumerate(dict.fromkeys(point.group for point in points)):
        some = [point for point in points if point.group == group]
        color, marker = look(group, place)
        drawn = axes.scatter(
            [point.x for point in some],
            [point.y for point in some],
            s=70 if marker == "*" else 38,
            c=color,
            marker=marker,
            label=group,
            edgecolors="white",
            linewidths=0.6,
            zorder=3,
        )
        drawn.set_urls([point.link or None for point in some])
    if front:
        best = pareto(points)
        axes.plot(
            [point.x for point in best],
            [point.y for point in best],
            color="#9aa3a9",
            lw=1.2,
            ls="--",
            zorder=2,
        )
        for place, point in enumerate(best):
            axes.annotate(
                point.label,
                (point.x, point.y),
                textcoords="offset points",
                xytext=(6, 5 if place % 2 == 0 else -11),
                fontsize=8,
                zorder=4,
            )
    _finish(axes, x_label, y_label, log)
    _explain(figure)
    return svg(figure)


def curves(
    series: Mapping[str, Iterable[tuple[float, float]]],
    x_label: str,
    y_label: str,
    log: str = "xy",
    marks: bool = True,
    ticks: Sequence[str] = (),
) -> str:
    """A line for each series of (x, y), as SVG. ticks: what stands at x = 0, 1, 2 ..."""
    from matplotlib.ticker import MaxNLocator

    figure, axes = new()
    whole = True
    for place, (name, line) in enumerate(series.items()):
        color, marker = look(name, place)
        xs, ys = zip(*line, strict=True)
        whole = whole and all(isinstance(x, int) for x in xs)
        axes.plot(xs, ys, color=color, marker=marker if marks else None, ms=5, lw=1.6, label=name)
    _finish(axes, x_label, y_label, log)
    if ticks:
        axes.set_xticks(range(len(ticks)), list(ticks))
    elif whole and "x" not in log:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    if len(series) > 1:
        _explain(figure)
    return svg(figure)


def bars(groups: Mapping[str, Mapping[str, float]], y_label: str, log: str = "") -> str:
    """A cluster of bars for each group, a colour for each name in it, as SVG."""
    figure, axes = new()
    names = list(dict.fromkeys(name for group in groups.values() for name in group))
    width = 0.8 / max(1, len(names))
    for place, name in enumerate(names):
        places = [
            i + (place - (len(names) - 1) / 2) * width
            for i, group in enumerate(groups.values())
            if name in group
        ]
        heights = [group[name] for group in groups.values() if name in group]
        axes.bar(places, heights, width, label=name, color=look(name, place)[0])
    _finish(axes, "", y_label, log)
    axes.grid(visible=False, axis="x")
    axes.set_xticks(
        range(len(groups)),
        list(groups),
        rotation=20 if len(groups) > 4 else 0,
        ha="right" if len(groups) > 4 else "center",
    )
    if len(names) > 1:
        _explain(figure)
    return svg(figure)


def pareto(points: Iterable[Point]) -> list[Point]:
    """The points of which no other has both a smaller x and a smaller y, from left to right."""
    best: list[Point] = []
    for point in sorted(points, key=lambda each: (each.x, each.y)):
        if not best or point.y < best[-1].y:
            best.append(point)
    return best


def look(name: str, place: int = 0) -> tuple[str, str]:
    """Colour and marker of a technique, or of the place in a row of other names."""
    return LOOKS.get(name, (OTHERS[place % len(OTHERS)], MARKERS[place % len(MARKERS)]))


def _explain(figure: Figure) -> None:
    """A legend below the plot, where there is room on narrow windows too."""
    import matplotlib as mpl

    with mpl.rc_context(STYLE):
        figure.legend(loc="outside lower center", ncols=4)


def _label_log(axis: Axis, limits: tuple[float, float]) -> None:
    """Plain numbers at 1, 2 and 5 where an axis spans few powers of ten."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

    low, high = limits
    if low <= 0.0 or high / low > FEW_POWERS:
        return
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FormatStrFormatter("%g"))
    axis.set_minor_formatter(NullFormatter())


def _finish(axes: Axes, x_label: str, y_label: str, log: str) -> None:
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    if "x" in log:
        axes.set_xscale("log")
        _label_log(axes.xaxis, axes.get_xlim())
    if "y" in log:
        axes.set_yscale("log")
        _label_log(axes.yaxis, axes.get_ylim())
    axes.grid(visible=True, color=GRID)
