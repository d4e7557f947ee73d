"""Stability: how far each technique's pictures are from the reference while one number is driven to the extreme.

A pixel is right where its colour lies between those that the reference sees near its centre: within a fiftieth of a
pixel, which is rounding, or within a whole one, which is blur, simplification or a coarse grid of distances. Of
filtered pictures it is the mean over the pixel's area that is compared, and that over the areas around it.
"""

from __future__ import annotations

import functools
import math
import multiprocessing
import os
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg
from decalgl import reference as ref

from ..bench.comparison import VERDICTS
from . import plots
from .extremes import EXTREMES, SIZE
from .part import Figure, Table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from concurrent.futures import Executor

    from numpy.typing import NDArray

    from .extremes import Case, Extreme
    from .part import Context, Row

    FloatArray = NDArray[np.float64]
    BoolArray = NDArray[np.bool_]

# Pixels, and steps of colours from 0 to 1: what rounding to bytes may take, and what coverage may be off at joints.
ROUNDING, NEAR = 0.02, 1.0
SLACK, COVERAGE_SLACK = 2.5 / 255.0, 0.05
# Shares of the picture's pixels: how many may be off by more than a verdict allows.
MOST_ROUGH, MOST_FAR = 0.001, 0.02
EXACT, TOLERABLE, GRACEFUL, WARNS, REFUSES, FAILS = VERDICTS
SHORT = {
    EXACT: "exact",
    TOLERABLE: "within",
    GRACEFUL: "graceful",
    WARNS: "warns",
    REFUSES: "refuses",
    FAILS: "fails",
}
MOST_WORKERS = 8  # each may hold some gigabytes
# Of a quick report every so many pixels are judged: no divisor of a row's, so that they are scattered.
EVERY = 13
LEAST_DRAWN = 1e-5  # where curves of shares meet the axis

TITLE = "Stability"
ABOUT = (
    f"Small scenes of {SIZE[0]} x {SIZE[1]} pixels in which one number goes to the extreme, each drawn by every"
    " technique at the centres of pixels and compared with the reference. Rough is the share of pixels whose colour the"
    f" reference does not see within {ROUNDING:g} pixels of the centre, far the share where it does not within a whole"
    f" pixel. With coverage, rough is more than {COVERAGE_SLACK:g} from the mean over the pixel's area, and far as much"
    f" from those over all areas within a pixel of it. Exact: at most {MOST_ROUGH:.1%} are rough. Within tolerance: at"
    f" most {MOST_ROUGH:.1%} are far. Degrades gracefully: at most {MOST_FAR:.0%} are far. Warns: more are far, and a"
    " warning says so; refuses: an error does. Fails: more are far, and nothing says so. Verdicts follow from the rows"
    f" alone. A quick report judges one of {EVERY} pixels."
)


@dataclass(frozen=True)
class Sight:
    """What the reference sees of a pixel: colours in steps x steps places up to `reach` pixels from its centre.

    samples: each way over the area of a pixel, whose mean is taken; 1 for the place itself. slack: by which a colour
    may be off.
    """

    reach: float = 0.0
    steps: int = 1
    samples: int = 1
    slack: float = SLACK


# What is neither within one nor the other of the first two is rough, what is not within the last either is far. The
# first is quick, and explains most pixels.
POINTS = (Sight(), Sight(ROUNDING, 5), Sight(NEAR, 5))
AREAS = (
    Sight(samples=8),
    Sight(samples=16, slack=COVERAGE_SLACK),
    Sight(NEAR, 5, 8, COVERAGE_SLACK),
)


@dataclass(frozen=True)
class Way:
    """A technique as it is driven.

    sights: what its pictures are held against. follows_view: its widths are those on the screen. kinds: "both" or
    "lines". one_look: all lines are opaque and of one colour, as networks draw features that look the same as one, and
    Thöny the nearest line. looks: what it makes of corners and caps. most: of some extremes, the largest value that it
    is driven to, where more would take hours.
    """

    technique: dg.Technique
    options: dict[str, Any] = field(default_factory=dict)
    sights: tuple[Sight, ...] = POINTS
    follows_view: bool = False
    kinds: str = "both"
    one_look: bool = False
    looks: dict[str, Any] = field(default_factory=dict)
    most: dict[str, float] = field(default_factory=dict)

    def drives(self, extreme: Extreme, value: float, case: Case) -> bool:
        """Whether it is asked to draw a case."""
        return value <= self.most.get(extreme.name, math.inf) and (self.kinds == "both" or bool(case.lines))

    def scene(self, case: Case) -> dg.Scene:
        """The case as this technique draws it."""
        return case.scene(
            self.technique,
            follows_view=self.follows_view,
            one_look=self.one_look,
            kinds=self.kinds,
            looks=self.looks,
        )


# Of what is cut into triangles: cutting takes the square of the number of holes, and volumes a mask for each feature.
TRIANGLES = {"overlap": 1e3, "nesting": 100.0, "holes": 1e4, "vertices": 1e5}
COVERAGE = {"antialias": "coverage"}
# Of what the reference looks at 256 times for each pixel.
AREAS_MOST = {"overlap": 100.0, "vertices": 1e5, "holes": 1e4}
WAYS = {
    "static": Way(dg.Static()),
    "static coverage": Way(dg.Static(), COVERAGE, AREAS, most=AREAS_MOST),
    "static bvh": Way(dg.Static(), {"index": "bvh"}),
    "static thoeny": Way(dg.Static(), {"index": "thoeny"}, one_look=True),
    "dynamic bins": Way(dg.Dynamic(method="bins"), follows_view=True, kinds="lines"),
    "dynamic lists": Way(dg.Dynamic(method="lists"), follows_view=True, kinds="lines"),
    "dynamic coverage": Way(
        dg.Dynamic(method="bins"), COVERAGE, AREAS, follows_view=True, kinds="lines", most=AREAS_MOST
    ),
    "loops": Way(dg.Loops()),
    "volume": Way(dg.Volume(), most=TRIANGLES),
    # Its joints are miters, from right angles on bevels, and its ends have no caps.
    "clipmap": Way(
        dg.Clipmap(), looks={"corner": "miter", "miter_limit": 90.0, "cap": "butt"}, most=TRIANGLES
    ),
    "distance_field": Way(dg.DistanceField(), kinds="lines", one_look=True),
}
# Why a technique is off where it is, by the worst that happens to it.
REASONS = {
    (
        "feature size",
        "*",
    ): "vertices are kept on a lattice over the whole terrain; finer detail is rounded away",
    ("coincident", "*"): "the gap is smaller than the lattice that vertices are kept on",
    (
        "coordinates",
        "*",
    ): "maps reach to 1e9 m, 25 times around the Earth; what lies beyond is taken for a mistake",
    (
        "sliver",
        "*",
    ): "from 1e10 m on its end lies beyond 1e9 m, farther than maps reach",
    ("miter", "loops"): "draws round corners alone",
    ("miter", "distance_field"): "draws round corners alone",
    **dict.fromkeys(
        (("overlap", "static bvh"), ("overlap", "static thoeny")),
        "trees of boxes repeat each feature in every cell, up to the driver's largest array",
    ),
    ("overlap", "loops"): "each cell of a view names all features over it, up to the driver's largest array",
    ("overlap", "dynamic lists"): "a pixel's list has room for 60,000 segments",
    **dict.fromkeys(
        (("vertices", "static bvh"), ("vertices", "static thoeny")),
        "its trees of boxes have more nodes than an array that shaders read",
    ),
    ("overlap", "volume"): "each colour is blended into bytes, and rounding adds up",
    ("overlap", "clipmap"): "each feature is blended into bytes, and rounding adds up",
    ("*", "loops"): "simplified by up to half a pixel, as was asked for",
    ("*", "clipmap"): "textures are filtered, and texels end where there are 2^20 along the terrain",
    ("*", "volume"): "a mesh is rasterised: vertices snap to 1/256 of a pixel, and depths to float32",
    **dict.fromkeys(
        (("*", "static coverage"), ("*", "dynamic coverage")),
        "64 samples a pixel; where facets are smaller than pixels, on the planes that 16 rays meet",
    ),
    ("*", "*"): "vertices are rounded to a lattice",
}


def rows(context: Context) -> list[Row]:
    """A row for each extreme, value and technique: `rough` and `far`, or an `error`; and the `verdict`."""
    found: list[Row] = []
    with judges() as pool:
        for extreme in context.chosen(EXTREMES[:2], EXTREMES, EXTREMES):
            context.say(f"stability: {extreme.title}")
            values = context.chosen(extreme.quick[:1], extreme.quick, extreme.values)
            asked = [(extreme.name, value, technique) for value in values for technique in WAYS]
            row_of = functools.partial(_row, every=judged_pixels(context))
            measure = functools.partial(_driven, pool, row_of, asked)
            found += context.kept(f"stability_{extreme.name}", measure)
    return found


def judges() -> ProcessPoolExecutor:
    """Processes for pictures to be judged in: the reference takes most of the time, on one core."""
    workers = min(MOST_WORKERS, len(os.sched_getaffinity(0)))
    return ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"))


def judged_pixels(context: Context) -> int:
    """Of how many pixels one is judged."""
    return EVERY if context.size == "quick" else 1


def _driven(
    pool: Executor,
    row_of: Callable[[tuple[str, float, str]], Row | None],
    asked: Sequence[tuple[str, float, str]],
) -> list[Row]:
    return [row for row in pool.map(row_of, asked) if row is not None]


def _row(asked: tuple[str, float, str], every: int) -> Row | None:
    """Of an extreme, a value and a technique; None where it is not asked to draw that."""
    name, value, technique = asked
    (extreme,) = (one for one in EXTREMES if one.name == name)
    way, case = WAYS[technique], extreme.make(value)
    if not way.drives(extreme, value, case):
        return None
    words = {"scene": f"{name} {value:g}", "extreme": name, "technique": technique}
    return {**words, "value": value, **judged(way, case, every)}


def judged(way: Way, case: Case, every: int = 1) -> Row:
    """How far the picture of a case is from the reference: `rough`, `far`, `warning` and `verdict`, or an `error`.

    every: of so many pixels one is judged.
    """
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always", dg.DecalWarning)
            scene = way.scene(case)
            options: dict[str, Any] = {"antialias": "none", "background": None, **way.options}
            frame = scene.render(case.camera, SIZE, **options)
    except dg.DecalError as error:
        return {"verdict": REFUSES, "error": str(error)}
    drawn = frame.image[..., :3].reshape(-1, 3) / 255.0
    pixels = wrong = np.arange(0, len(drawn), every)
    left = []
    for sight in way.sights:
        wrong = wrong[~_explained(scene, case, drawn, wrong, sight)]
        left.append(len(wrong) / len(pixels))
    shares = {"rough": left[-2], "far": left[-1]}
    row: Row = {**shares, "verdict": verdict_of(**shares, warns=bool(said))}
    return {**row, "warning": str(said[0].message)} if said else row


def verdict_of(rough: float, far: float, warns: bool) -> str:
    """What shares of pixels that are off by more than rounding, and by more than a pixel, are called."""
    if rough <= MOST_ROUGH:
        return EXACT
    if far <= MOST_ROUGH:
        return TOLERABLE
    if far <= MOST_FAR:
        return GRACEFUL
    return WARNS if warns else FAILS


def _explained(
    scene: dg.Scene, case: Case, drawn: FloatArray, pixels: NDArray[np.int64], sight: Sight
) -> BoolArray:
    """Which of some pixels have a colour between those that are seen of them."""
    if len(pixels) == 0:
        return np.zeros(0, dtype=np.bool_)
    centres = ref.pixel_centres((0, 0, *SIZE))[pixels]
    places = _square(np.linspace(-sight.reach, sight.reach, sight.steps))
    found = np.stack([reference_means(scene, case, centres + place, sight.samples) for place in places])
    low, high = found.min(axis=0) - sight.slack, found.max(axis=0) + sight.slack
    between: BoolArray = ((drawn[pixels] >= low) & (drawn[pixels] <= high)).all(axis=1)
    return between


def _square(steps: FloatArray) -> FloatArray:
    """All pairs of some numbers, (n, 2)."""
    x, y = np.meshgrid(steps, steps)
    return np.stack([x.ravel(), y.ravel()], axis=1)


def reference_means(scene: dg.Scene, case: Case, points: FloatArray, samples: int) -> FloatArray:
    """What the reference sees in the areas of a pixel around picture positions (n, 2): mean colours (n, 3)."""
    places = _square((np.arange(samples) + 0.5) / samples - 0.5)
    # A row of samples at a time: the reference holds some hundred bytes for each.
    rows = [
        reference_colors(scene, case, (points[:, None] + row).reshape(-1, 2)).reshape(len(points), -1, 3)
        for row in np.split(places, samples)
    ]
    means: FloatArray = np.concatenate(rows, axis=1).mean(axis=1)
    return means


def reference_colors(scene: dg.Scene, case: Case, points: FloatArray) -> FloatArray:
    """What the reference sees at picture positions (n, 2): colours (n, 3) over black ground."""
    surface = ref.raycast(scene, case.camera, SIZE, points)
    slopes = ref.slopes_of(scene, case.camera, SIZE, surface)
    colors: FloatArray = ref.composite(scene, surface.world[..., :2].reshape(-1, 2), slopes)[:, :3]
    return colors


def figures(rows: Sequence[Row]) -> list[Figure]:
    """The table of verdicts, then curves of each extreme."""
    return [_verdict_figure(rows), _reason_table(rows), *(curves(rows, one) for one in _driven_in(rows))]


def _driven_in(rows: Sequence[Row]) -> list[Extreme]:
    names = {row["extreme"] for row in rows}
    return [extreme for extreme in EXTREMES if extreme.name in names]


def _of(rows: Sequence[Row], extreme: Extreme, technique: str) -> list[Row]:
    return [row for row in rows if row["extreme"] == extreme.name and row["technique"] == technique]


def _worst(rows: Sequence[Row]) -> Row:
    return max(rows, key=lambda row: VERDICTS.index(row["verdict"]))


def _verdict_figure(rows: Sequence[Row]) -> Figure:
    return Figure(
        "Verdicts",
        "The worst over the values driven through, from the first value on at which it was given, and the worst of the"
        " other values.",
        table=verdicts(rows),
    )


def verdicts(rows: Sequence[Row]) -> Table:
    """What each technique comes to, extreme by extreme."""
    lines = []
    for extreme in _driven_in(rows):
        cells = [f"{extreme.title}, {_range(extreme, rows)}"]
        for technique in WAYS:
            own = _of(rows, extreme, technique)
            cells.append(_cell(own) if own else "–")
        lines.append(cells)
    return Table(["extreme", *WAYS], lines)


def _cell(own: list[Row]) -> str:
    """Such as: exact; at 1e9 refuses."""
    worst = _worst(own)["verdict"]
    those = [row for row in own if row["verdict"] == worst]
    others = [row for row in own if row["verdict"] != worst]
    if worst == EXACT or not others:
        return SHORT[worst]
    values = [f"{row['value']:g}" for row in those]
    in_a_row = own.index(those[-1]) - own.index(those[0]) == len(those) - 1
    shown = f"{values[0]} … {values[-1]}" if in_a_row and len(values) > 2 else ", ".join(values)
    return f"{SHORT[_worst(others)['verdict']]}; at {shown} {SHORT[worst]}"


def _range(extreme: Extreme, rows: Sequence[Row]) -> str:
    values = [row["value"] for row in rows if row["extreme"] == extreme.name]
    return f"{values[0]:g} … {values[-1]:g}{' ' if extreme.unit else ''}{extreme.unit}"


def _reason_table(rows: Sequence[Row]) -> Figure:
    lines = []
    for extreme in _driven_in(rows):
        for technique in WAYS:
            own = _of(rows, extreme, technique)
            if not own or _worst(own)["verdict"] == EXACT:
                continue
            worst = _worst(own)
            said = worst.get("error") or worst.get("warning") or ""
            lines.append([extreme.title, technique, _cell(own), _reason(extreme.name, worst), said])
    return Figure(
        "Where techniques begin to be off, and why",
        "What they say themselves is the error or the warning that was raised.",
        table=Table(["extreme", "technique", "verdict", "why", "what it says"], lines),
    )


def _reason(extreme: str, worst: Row) -> str:
    """What a technique always does explains a picture that is off, and no refusal."""
    technique = worst["technique"]
    known = [(extreme, technique), (extreme, "*")]
    if worst["verdict"] != REFUSES:
        known += [("*", technique), ("*", "*")]
    return next((REASONS[key] for key in known if key in REASONS), "")


def curves(rows: Sequence[Row], extreme: Extreme) -> Figure:
    """Shares of pixels that are off over the values of an extreme, for each technique."""
    figure, axes = plots.new()
    for place, technique in enumerate(WAYS):
        own = [row for row in _of(rows, extreme, technique) if "far" in row]
        if not own:
            continue
        color, marker = plots.look(technique, place)
        values = [row["value"] for row in own]
        for name, style in (("far", "-"), ("rough", ":")):
            shares = [max(row[name], LEAST_DRAWN) for row in own]
            label = technique if name == "far" else None
            axes.plot(values, shares, style, color=color, marker=marker, ms=4, lw=1.4, label=label)
    if min(row["value"] for row in rows if row["extreme"] == extreme.name) > 0.0:
        axes.set_xscale("log")
    else:
        axes.set_xscale("symlog", linthresh=0.01)
    axes.set_yscale("log")
    axes.set_ylim(0.7 * LEAST_DRAWN, 1.4)
    axes.set_xlabel(f"{extreme.title}, {extreme.unit}" if extreme.unit else extreme.title)
    axes.set_ylabel("share of pixels")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    caption = (
        "Lines: off by more than a pixel; dotted: by more than rounding, with coverage by more than"
        f" {COVERAGE_SLACK:g}. At the bottom: none."
    )
    return Figure(f"Error over {extreme.title}", caption, plots.svg(figure))
