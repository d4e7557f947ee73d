"""Scaling: time and memory over segments, pixels, layers, overlap and threads, with the exponents that fit."""

from __future__ import annotations

import functools
import math
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..bench import measure
from . import plots
from .part import Figure, Table, byte_count, number

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from ..bench.measure import Measure, Times
    from .part import Context, Row

TITLE = "Scaling"
ABOUT = (
    "One number grows and everything else stays: segments in the map under one view, pixels of the picture, layers"
    " over one another, translucent polygons over one pixel, threads that prepare. Times of drawing are those of the"
    " layers' own passes, updates included, medians of interleaved rounds. An exponent is the slope of log time over"
    " log count: 0 where the count does not matter, 1 where twice as much takes twice as long."
)
GROUND_PASSES = ("upload", "terrain", "compose", "readback")
LINE = 100  # segments
STEP = 10.0  # metres: 3e7 segments 6 m wide cover the ground four and a half times
HALF = 10_000.0
MOST_REPEATED = 5e6  # of a count: what is larger is drawn in one round
UNKNOWN_SPREAD = 0.1  # of times of one round, as a share


@dataclass(frozen=True)
class Way:
    """A technique; most: segments up to which it is asked, in a tiny, quick and full report; 0: not at all.

    fills: whether it draws polygons. layers: that it is asked for.
    """

    technique: dg.Technique
    most: tuple[float, float, float]
    options: dict[str, Any] = field(default_factory=dict)
    antialias: str = "none"
    pixels: bool = False
    fills: bool = True
    layers: int = 16


WAYS = {
    "static": Way(dg.Static(), (1e5, 1e6, 3e7), layers=256),
    "static coverage": Way(dg.Static(), (0, 1e5, 3e7), antialias="coverage", layers=256),
    "static bvh": Way(dg.Static(), (0, 1e5, 1e7), {"index": "bvh"}, layers=256),
    "static thoeny": Way(dg.Static(), (0, 1e4, 1e6), {"index": "thoeny"}, layers=256),
    "dynamic bins": Way(dg.Dynamic(method="bins"), (1e4, 1e5, 1e7), pixels=True, fills=False),
    "dynamic lists": Way(dg.Dynamic(method="lists"), (0, 1e4, 1e6), pixels=True, fills=False),
    "loops": Way(dg.Loops(), (0, 1e5, 1e6), layers=256),
    "volume": Way(dg.Volume(), (0, 1e4, 1e6)),
    "clipmap": Way(dg.Clipmap(), (0, 1e5, 1e6)),
    "distance_field": Way(dg.DistanceField(), (0, 1e4, 1e6), fills=False),
}


def rows(context: Context) -> list[Row]:
    """A row for each count of each sweep and technique. Raises DecalError."""
    sweeps = (_over_segments, _over_pixels, _over_layers, _over_overlap, _over_threads)
    found: list[Row] = []
    for sweep in sweeps:
        found += context.kept(f"scaling{sweep.__name__}", functools.partial(sweep, context))
    return found


# Sweeps


def _ways(context: Context, segments: float) -> dict[str, Way]:
    """The techniques that are asked for so many segments."""
    place = context.chosen(0, 1, 2)
    return {name: way for name, way in WAYS.items() if segments <= way.most[place]}


def _over_segments(context: Context) -> list[Row]:
    found: list[Row] = []
    for count in context.chosen([1e3, 1e4], [1e4, 1e5, 1e6], [1e4, 1e5, 1e6, 1e7, 3e7]):
        context.say(f"scaling: {count:g} segments")
        ways = _ways(context, count)
        scenes = {name: _lines_scene(way, round(count)) for name, way in ways.items()}
        found += _measured(context, "segments", count, scenes, ways, context.picture)
    return found


def _over_pixels(context: Context) -> list[Row]:
    found: list[Row] = []
    ways = _ways(context, 10_000)
    scenes = {name: _lines_scene(way, 10_000) for name, way in ways.items()}
    sizes = context.chosen(
        [(160, 90), (320, 180)],
        [(160, 90), (320, 180), (640, 360)],
        [(320, 180), (640, 360), (1280, 720), (2560, 1440), (3840, 2160)],
    )
    for size in sizes:
        context.say(f"scaling: {size[0]} x {size[1]} pixels")
        found += _measured(context, "pixels", size[0] * size[1], scenes, ways, size)
    return found


def _over_layers(context: Context) -> list[Row]:
    found: list[Row] = []
    for count in context.chosen([1, 4], [1, 16], [1, 4, 16, 64, 256]):
        context.say(f"scaling: {count} layers")
        ways = {name: way for name, way in _ways(context, 20_000).items() if count <= way.layers}
        scenes = {name: _lines_scene(way, 20_000, count) for name, way in ways.items()}
        found += _measured(context, "layers", count, scenes, ways, context.picture)
    return found


def _over_overlap(context: Context) -> list[Row]:
    found: list[Row] = []
    ways = {name: way for name, way in _ways(context, 1).items() if way.fills}
    for count in context.chosen([1, 10], [1, 30], [1, 10, 100, 1000]):
        context.say(f"scaling: {count} polygons over one another")
        scenes = {name: _stack_scene(way, count) for name, way in ways.items()}
        found += _measured(context, "overlap", count, scenes, ways, context.picture)
    return found


def _over_threads(context: Context) -> list[Row]:
    cores = len(os.sched_getaffinity(0))
    counts = [2**power for power in range(cores.bit_length()) if 2**power <= cores]
    scene = _lines_scene(WAYS["static"], context.chosen(10_000, 500_000, 5_000_000))
    context.say(f"scaling: up to {cores} threads")
    measures: list[Measure] = [_preparing(scene, threads) for threads in counts]
    times = measure.interleaved(context.runs, *measures)
    words = {"sweep": "threads", "technique": "static"}
    return [
        {"scene": f"threads {threads}", **words, "count": threads, **_own(times, f"{threads}")}
        for threads in counts
    ]


def _preparing(scene: dg.Scene, threads: int) -> Measure:
    def run() -> Times:
        renderer = dg.Renderer(size=measure.SMALL_PICTURE, threads=threads)
        return {f"{threads} prepare_ms": measure.timed(lambda: renderer.preprocess(scene))}

    return run


def _measured(
    context: Context,
    sweep: str,
    count: float,
    scenes: Mapping[str, dg.Scene],
    ways: Mapping[str, Way],
    size: tuple[int, int],
) -> list[Row]:
    """A row for each scene: its preparing, measured once, and its drawing in turns with that of the others."""
    found: dict[str, Row] = {}
    measures: list[Measure] = []
    for name, scene in scenes.items():
        row: Row = {"scene": f"{sweep} {count:g}", "sweep": sweep, "technique": name, "count": count}
        found[name] = row
        renderer = dg.Renderer(size=size, antialias=ways[name].antialias, **ways[name].options)
        try:
            row["prepare_ms"] = measure.timed(functools.partial(renderer.preprocess, scene))
            renderer.update(_camera())
            stats = renderer.render().stats
        except dg.DecalError as error:
            row["error"] = str(error)
            continue
        row["held_bytes"] = sum(n for owner, n in stats.bytes.items() if owner not in ("terrain", "frame"))
        measures += [_drawing(renderer, ways[name].antialias, name), _floor(renderer, name)]
    runs = context.runs if count <= MOST_REPEATED else 1
    times = measure.interleaved(runs, *measures) if measures else {}
    return [{**row, **_own(times, name)} for name, row in found.items()]


def _drawing(renderer: dg.Renderer, antialias: str, name: str) -> Measure:
    def run() -> Times:
        passes = measure.draw(renderer, _camera(), antialias).stats.passes
        return {f"{name} draw_ms": sum(one["ms"] for one in passes if one["name"] not in GROUND_PASSES)}

    return run


def _floor(renderer: dg.Renderer, name: str) -> Measure:
    return lambda: {f"{name} floor_ms": renderer.time_floor()}


def _own(times: Times, name: str) -> Times:
    """Those of one measure, without its name; names may hold spaces, and begin as others do."""
    words = {key: key.rpartition(" ") for key in times}
    return {own: times[key] for key, (whose, _, own) in words.items() if whose == name}


# Scenes


def _ground() -> dg.Terrain:
    y, x = np.mgrid[-1.0:1.0:129j, -1.0:1.0:129j]
    heights = 150.0 * (np.sin(5.0 * x + 3.0 * y) + np.sin(4.0 * x - 7.0 * y))
    step = 2.0 * HALF / 128
    return dg.Terrain(heights.astype(np.float32), -HALF, HALF, step, step)


def _camera() -> dg.Camera:
    return dg.Camera.look_at((-1500.0, -6500.0, 3500.0), (0.0, 0.0, 0.0), fov=45.0)


def _lines_scene(way: Way, segments: int, layers: int = 1) -> dg.Scene:
    """Walks of a hundred segments all over the ground, shared out among layers."""
    scene = dg.Scene(_ground())
    for layer in range(layers):
        table = _walks(max(1, segments // LINE // layers), layer)
        width = {"width": 2.0, "width_units": "px"} if way.pixels else {"width": 6.0, "width_units": "m"}
        scene.add_lines(table, color="#7a5a36", technique=way.technique, **width)  # type: ignore[arg-type]
    return scene


def _walks(count: int, seed: int) -> dg.FeatureTable:
    generator = np.random.default_rng(seed)
    turns = generator.normal(0.0, 0.4, (count, LINE)).astype(np.float32)
    heading = generator.uniform(0.0, 2.0 * np.pi, (count, 1)).astype(np.float32) + np.cumsum(turns, axis=1)
    coords = np.empty((count, LINE + 1, 2))
    coords[:, 0] = generator.uniform(-0.95 * HALF, 0.95 * HALF, (count, 2))
    coords[:, 1:, 0] = coords[:, :1, 0] + np.cumsum(STEP * np.cos(heading), axis=1)
    coords[:, 1:, 1] = coords[:, :1, 1] + np.cumsum(STEP * np.sin(heading), axis=1)
    each = np.arange(count + 1)
    return dg.FeatureTable("lines", coords.reshape(-1, 2), (LINE + 1) * each, each, each[:-1])


def _stack_scene(way: Way, count: int) -> dg.Scene:
    """Translucent rings of 60 corners around one place."""
    generator = np.random.default_rng(5)
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    radius = generator.uniform(2000.0, 3000.0, (count, 1))
    coords = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    each = np.arange(count + 1)
    table = dg.FeatureTable("polygons", coords.reshape(-1, 2), 60 * each, each, each[:-1])
    scene = dg.Scene(_ground())
    scene.add_polygons(
        table, color="#1b6ca8", alpha=max(0.02, min(0.5, 4.0 / count)), technique=way.technique
    )
    return scene


# Exponents


@dataclass(frozen=True)
class Exponent:
    """The slope of log y over log x, and its standard error."""

    slope: float
    error: float

    def __str__(self) -> str:
        return f"{self.slope:.2f} ± {self.error:.2f}"


def exponent(points: Sequence[tuple[float, float, float]]) -> Exponent | None:
    """Fitted to (count, value, spread of the value as a share); None for fewer than two counts.

    The error is what the spreads and the distances from the line leave open.
    """
    if len({count for count, _, _ in points}) < 2:
        return None
    x = np.log([count for count, _, _ in points])
    y = np.log([value for _, value, _ in points])
    spreads = np.array([spread for _, _, spread in points])
    weights = (x - x.mean()) / ((x - x.mean()) ** 2).sum()
    slope = float(weights @ y)
    off = y - y.mean() - slope * (x - x.mean())
    free = len(x) - 2
    scatter = float((off**2).sum() / free * (weights**2).sum()) if free > 0 else 0.0
    return Exponent(slope, math.sqrt(scatter + float(((weights * spreads) ** 2).sum())))


# Figures

SWEEPS: dict[str, tuple[str, tuple[tuple[str, str], ...]]] = {
    "segments": (
        "segments",
        (("draw_ms", "drawing, ms"), ("prepare_ms", "preparing, ms"), ("held_bytes", "bytes")),
    ),
    "pixels": ("pixels", (("draw_ms", "drawing, ms"), ("held_bytes", "bytes"))),
    "layers": ("layers", (("draw_ms", "drawing, ms"), ("held_bytes", "bytes"))),
    "overlap": ("polygons over one pixel", (("draw_ms", "drawing, ms"), ("held_bytes", "bytes"))),
    "threads": ("threads", (("prepare_ms", "preparing, ms"),)),
}


def figures(rows: Sequence[Row]) -> list[Figure]:
    """A plot for each count and value, and a table of all exponents."""
    found = [
        over(rows, sweep, name)
        for sweep, (_, values) in SWEEPS.items()
        for name, _ in values
        if any(row["sweep"] == sweep and name in row for row in rows)
    ]
    caption = "With their standard errors; times in milliseconds."
    return [Figure("Exponents", caption, table=exponents(rows)), *found]


def over(rows: Sequence[Row], sweep: str, name: str) -> Figure:
    """A value over what a sweep counts, for each technique."""
    axis, values = SWEEPS[sweep]
    label = dict(values)[name]
    lines = {way: [(x, y) for x, y, _ in points] for way, points in _series(rows, sweep, name).items()}
    refused = [f"{row['technique']} at {row['count']:g}: {row['error']}" for row in rows
               if row["sweep"] == sweep and "error" in row]  # fmt: skip
    caption = f"{label.capitalize()} over {axis}." + (f" Refused: {'; '.join(refused)}" if refused else "")
    return Figure(
        f"{label.split(',')[0].capitalize()} over {axis}", caption, plots.curves(lines, axis, label)
    )


def _series(rows: Sequence[Row], sweep: str, name: str) -> dict[str, list[tuple[float, float, float]]]:
    """(count, value, spread) by technique."""
    found: dict[str, list[tuple[float, float, float]]] = {}
    for row in rows:
        if row["sweep"] == sweep and row.get(name, 0.0) > 0.0:
            unknown = UNKNOWN_SPREAD if name.endswith("_ms") else 0.0
            point = (row["count"], row[name], row.get(f"{name}_spread", unknown))
            found.setdefault(row["technique"], []).append(point)
    return found


def exponents(rows: Sequence[Row]) -> Table:
    """What fits the first and last values of each sweep and technique."""
    lines = []
    for sweep, (axis, values) in SWEEPS.items():
        for name, label in values:
            for way, points in _series(rows, sweep, name).items():
                fitted = exponent(points)
                if fitted is None:
                    continue
                show: Callable[[float], str] = byte_count if name.endswith("_bytes") else number
                first, last = points[0], points[-1]
                lines.append(
                    [axis, label.split(",")[0], way, f"{first[0]:g} … {last[0]:g}", show(first[1]), show(last[1]),
                     str(fitted)]
                )  # fmt: skip
    columns = ["over", "what", "technique", "from … to", "first", "last", "exponent"]
    return Table(columns, lines)
