"""Extremes: small scenes in which one number is driven as far as it goes, and everything else stays ordinary.

`EXTREMES` lists them. Each makes, from a value, ground, features and a camera that shows what the value does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from decalgl.camera import Camera
from decalgl.features import FeatureTable
from decalgl.scene import Relief, Scene
from decalgl.terrain import Terrain

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from decalgl.techniques import Technique

    FloatArray = NDArray[np.float64]
    Rings = list[list[FloatArray]]  # features of parts

SIZE = (96, 64)
BLACK = Relief(color="black", strength=0.0)
ONE_LOOK = "white"
COLORS = [(0.9, 0.2, 0.2), (0.2, 0.8, 0.3), (0.3, 0.4, 1.0), (0.9, 0.8, 0.2), (0.7, 0.3, 0.9)]


@dataclass(frozen=True)
class Case:
    """What is drawn: ground, features and a camera.

    polygons, lines: features, each a list of parts (n, 2), in metres. width: metres of the lines. pixel: metres that
    a pixel shows at the middle of the picture. looks: further keywords of the lines.
    """

    terrain: Terrain
    camera: Camera
    pixel: float
    polygons: Rings = field(default_factory=list)
    lines: Rings = field(default_factory=list)
    width: float = 1.5
    alpha: float = 1.0
    exaggeration: float = 1.0
    looks: dict[str, Any] = field(default_factory=dict)

    def scene(
        self, technique: Technique, *, follows_view: bool, one_look: bool, kinds: str, looks: dict[str, Any]
    ) -> Scene:
        """The case drawn by a technique.

        follows_view: lines have widths on the screen, as wide as theirs in the middle of the picture. one_look: all
        lines are opaque and of one colour. kinds: "both" or "lines". looks: further keywords of lines, unless the case
        has some.
        """
        scene = Scene(self.terrain, self.exaggeration, BLACK)
        if self.polygons and kinds == "both":
            table = _table("polygons", self.polygons)
            scene.add_polygons(table, color=self._tints(len(table)), technique=technique)
        if self.lines:
            table = _table("lines", self.lines)
            width = {"width": self.width, "width_units": "m"}
            if follows_view:
                width = {"width": self.width / self.pixel, "width_units": "px"}
            scene.add_lines(
                table,
                color=ONE_LOOK if one_look else self._tints(len(table)),
                technique=technique,
                **{**width, **(self.looks or looks)},
            )
        return scene

    def _tints(self, count: int) -> list[tuple[float, ...]]:
        return [(*COLORS[i % len(COLORS)], self.alpha) for i in range(count)]


@dataclass(frozen=True)
class Extreme:
    """A number and the values that it is driven through; quick: those of a quick report.

    unit: of the values, for axes.
    """

    name: str
    title: str
    unit: str
    values: tuple[float, ...]
    quick: tuple[float, ...]
    make: Callable[[float], Case] = field(repr=False)


def _table(kind: Any, features: Rings) -> FeatureTable:
    parts = [part for feature in features for part in feature]
    return FeatureTable(
        kind,
        np.concatenate(parts),
        np.cumsum([0] + [len(part) for part in parts]),
        np.cumsum([0] + [len(feature) for feature in features]),
        np.arange(len(features)),
    )


# Ground and cameras


def hills(half: float, relief: float, x: float = 0.0, y: float = 0.0) -> Terrain:
    """33 x 33 samples around (x, y), whose middle one is 0 m high."""
    samples = 33
    v, u = np.mgrid[-1.0 : 1.0 : samples * 1j, -1.0 : 1.0 : samples * 1j]
    heights = np.sin(5.0 * u + 3.0 * v) + np.sin(2.0 * u - 6.0 * v) + 0.3 * np.sin(17.0 * u + 13.0 * v)
    step = 2.0 * half / (samples - 1)
    return Terrain((0.4 * relief * heights).astype(np.float32), x - half, y + half, step, step)


def seen_from(
    height: float,
    distance: float,
    elevation: float = 45.0,
    target: Sequence[float] = (0.0, 0.0, 0.0),
    azimuth: float = 200.0,
) -> tuple[Camera, float]:
    """A camera whose picture is so many metres high at the target, and metres a pixel there."""
    fov = math.degrees(2.0 * math.atan(height / 2.0 / distance))
    return Camera.orbit(target, distance, azimuth, elevation, fov), height / SIZE[1]


# Features


def _cells(half: float, count: int, x: float = 0.0, y: float = 0.0) -> Rings:
    """Quadrilaterals with shaken corners that fill a square without a gap."""
    generator = np.random.default_rng(7)
    step = 2.0 * half / count
    corners = np.stack(np.meshgrid(np.arange(count + 1.0), np.arange(count + 1.0), indexing="xy"), axis=-1)
    corners += generator.uniform(-0.3, 0.3, corners.shape)
    corners = corners * step - half + (x, y)
    return [
        [np.stack([corners[r, c], corners[r, c + 1], corners[r + 1, c + 1], corners[r + 1, c]])]
        for r in range(count)
        for c in range(count)
    ]


def _walks(reach: float, step: float, count: int, x: float = 0.0, y: float = 0.0) -> Rings:
    generator = np.random.default_rng(11)
    middle = np.array([x, y])
    found: Rings = []
    for _ in range(count):
        heading = generator.uniform(0.0, 2.0 * np.pi) + np.cumsum(generator.normal(0.0, 0.5, 12))
        moves = step * np.stack([np.cos(heading), np.sin(heading)], axis=1)
        start = middle + generator.uniform(-reach, reach, (1, 2))
        found.append([np.cumsum(np.concatenate([start, moves]), axis=0)])
    return found


def circle(radius: float, corners: int, turn: float = 0.0) -> FloatArray:
    """A ring of so many corners around (0, 0), (corners, 2)."""
    angle = turn + np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


# The extremes


def _coordinates(value: float) -> Case:
    x, y = value, -0.93 * value
    camera, pixel = seen_from(90.0, 150.0, target=(x, y, 0.0))
    return Case(hills(100.0, 8.0, x, y), camera, pixel, _cells(40.0, 5, x, y), _walks(30.0, 5.0, 6, x, y))


def _feature_size(value: float) -> Case:
    half = 500_000.0
    size = 2.0 * half / value
    camera, pixel = seen_from(1.5 * size, 4.0 * size, 50.0)
    return Case(hills(half, 2000.0), camera, pixel, _cells(0.6 * size, 5), _walks(0.4 * size, 0.07 * size, 5),
                0.03 * size)  # fmt: skip


def _vees(value: float) -> Rings:
    turned = math.radians(value)
    arm = np.array([50.0 * math.cos(turned), 50.0 * math.sin(turned)])
    return [[np.array([(30.0, y), (-20.0, y), (arm[0] - 20.0, y + arm[1])])] for y in (-25.3, 4.7)]


def _angle(value: float) -> Case:
    camera, pixel = seen_from(110.0, 160.0, 60.0)
    return Case(hills(100.0, 8.0), camera, pixel, lines=_vees(value), width=7.0)


def _miter(value: float) -> Case:
    camera, pixel = seen_from(110.0, 160.0, 60.0)
    return Case(hills(100.0, 8.0), camera, pixel, lines=_vees(value), width=7.0,
                looks={"corner": "miter", "miter_limit": 5.0})  # fmt: skip


def _width_ratio(value: float) -> Case:
    """A winding line whose middle, all of it up to a thousand segments, is of segments so short."""
    width = 10.0
    count = max(2, round(120.0 * value / width))
    short = min(count, 1000)
    t = 0.5 + (np.arange(short + 1) - short / 2.0) / count
    t = (
        np.concatenate([np.linspace(0.0, t[0], 20)[:-1], t, np.linspace(t[-1], 1.0, 20)[1:]])
        if short < count
        else t
    )
    generator = np.random.default_rng(3)
    shaken = 0.2 * width / value * generator.uniform(-1.0, 1.0, (len(t), 2))
    path = np.stack([120.0 * t - 60.0, 25.0 * np.sin(9.0 * t)], axis=1) + np.minimum(shaken, 3.0)
    camera, pixel = seen_from(90.0, 150.0)
    return Case(hills(100.0, 8.0), camera, pixel, lines=[[path]], width=width)


def _line_width(value: float) -> Case:
    camera, pixel = seen_from(90.0, 150.0)
    return Case(hills(100.0, 8.0), camera, pixel, lines=_walks(30.0, 5.0, 6), width=value * pixel)


def _distance(value: float) -> Case:
    height = min(0.6 * value, 400.0)
    camera, pixel = seen_from(height, value, 50.0)
    return Case(hills(1000.0, 60.0), camera, pixel, _cells(0.6 * height, 6), _walks(0.4 * height, 0.06 * height, 5),
                0.025 * height)  # fmt: skip


def _tilt(value: float) -> Case:
    camera, pixel = seen_from(60.0, 300.0, value)
    return Case(hills(5000.0, 0.0), camera, pixel, _cells(400.0, 20), _walks(200.0, 20.0, 12), 4.0)


def _slope(value: float) -> Case:
    steep = math.tan(math.radians(value))
    x = np.arange(-10, 11) * 5.0
    heights = np.tile(steep * x, (21, 1)).astype(np.float32)
    height = 60.0 * math.hypot(1.0, steep)
    camera, pixel = seen_from(height, 2.0 * height, 35.0, azimuth=250.0)
    return Case(
        Terrain(heights, -50.0, 50.0, 5.0, 5.0), camera, pixel, _cells(30.0, 5), _walks(25.0, 4.0, 5), 1.5
    )


def _exaggeration(value: float) -> Case:
    height = 90.0 + 12.0 * value
    camera, pixel = seen_from(height, 2.0 * height, 40.0)
    return Case(
        hills(100.0, 8.0), camera, pixel, _cells(60.0, 5), _walks(50.0, 6.0, 6), 2.0, exaggeration=value
    )


def _overlap(value: float) -> Case:
    count = round(value)
    generator = np.random.default_rng(13)
    places = generator.uniform(-6.0, 6.0, (count, 2))
    turns = generator.uniform(0.0, 6.0, count)
    triangles: Rings = [[circle(22.0, 3, turn) + place] for turn, place in zip(turns, places, strict=True)]
    ends = generator.uniform(-40.0, 40.0, (count, 2))
    strokes: Rings = [[np.stack([-end, end])] for end in ends]
    camera, pixel = seen_from(90.0, 150.0, 70.0)
    return Case(
        hills(100.0, 8.0), camera, pixel, triangles, strokes, 3.0, alpha=max(min(0.5, 4.0 / count), 0.02)
    )


def _nesting(value: float) -> Case:
    depth = round(value)
    rings = [circle(42.0 * (depth - i) / depth, 24, 0.1 * i) for i in range(depth)]
    camera, pixel = seen_from(90.0, 150.0, 70.0)
    return Case(hills(100.0, 8.0), camera, pixel, [rings])


def _coincident(value: float) -> Case:
    height = 30.0 * value
    camera, pixel = seen_from(height, 2.0 * height, 70.0)
    left = np.array([(-60.0, -50.0), (0.0, -50.0), (0.3 * value, 0.0), (0.0, 50.0), (-60.0, 50.0)])
    right = np.array([(60.0, -50.0), (60.0, 50.0), (value, 50.0), (1.3 * value, 0.0), (value, -50.0)])
    lines: Rings = [[np.array([(-60.0, y), (60.0, y + value)])] for y in (0.0, 4.0 * value)]
    return Case(hills(100.0, 0.0), camera, pixel, [[left], [right]], lines, 2.0 * value)


def _sliver(value: float) -> Case:
    features: Rings = []
    for turn in (0.3, 1.4, 2.6):
        along, aside = np.array([math.cos(turn), math.sin(turn)]), np.array([-math.sin(turn), math.cos(turn)])
        start = -0.3 * value * along
        features.append([np.stack([start + 6.0 * aside, start - 6.0 * aside, 0.7 * value * along])])
    camera, pixel = seen_from(90.0, 150.0, 60.0)
    lines: Rings = [[np.array([(-0.3 * value, -0.2 * value + 5.0), (0.6 * value, 0.4 * value + 5.0)])]]
    return Case(hills(100.0, 8.0), camera, pixel, features, lines, 3.0)


def _vertices(value: float) -> Case:
    count = round(value)
    generator = np.random.default_rng(17)
    radius = (
        25.0
        + 15.0 * generator.random((count, 1)) * min(1.0, 300.0 / count)
        + 5.0 * np.sin(np.linspace(0.0, 40.0 * np.pi, count))[:, None]
    )
    ring = radius * circle(1.0, count)
    camera, pixel = seen_from(100.0, 150.0, 65.0)
    return Case(
        hills(100.0, 8.0), camera, pixel, [[ring]], [[np.concatenate([ring * 1.2, ring[:1] * 1.2])]], 1.0
    )


def _holes(value: float) -> Case:
    side = max(1, round(math.sqrt(value)))
    step = 80.0 / side
    places = (np.arange(side) + 0.5) * step - 40.0
    holes = [circle(0.35 * step, 5, 0.2) + np.array([x, y]) for x in places for y in places]
    camera, pixel = seen_from(100.0, 150.0, 70.0)
    return Case(hills(100.0, 8.0), camera, pixel, [[circle(60.0, 8), *holes]])


def _powers(first: int, last: int, step: int = 1) -> tuple[float, ...]:
    return tuple(10.0**power for power in range(first, last + 1, step))


EXTREMES = (
    Extreme("coordinates", "magnitude of coordinates", "m", _powers(0, 9), (1e8, 1e9), _coordinates),
    Extreme(
        "feature size", "ground ÷ feature", "", _powers(1, 10), (1e1, 1e5), _feature_size
    ),
    Extreme("angle", "angle at a round joint", "degrees", (179.99, 150, 90, 30, 10, 3, 1, 0.1, 0.01, 0.0),
            (1, 0.0), _angle),
    Extreme("miter", "angle at a miter", "degrees", (179.99, 150, 90, 30, 10, 6, 5, 1, 0.0), (6, 1), _miter),
    Extreme("width ÷ length", "line width ÷ segment length", "", _powers(-2, 4), (0.1, 100), _width_ratio),
    Extreme("line width", "line width on the screen", "pixels", _powers(-3, 4), (1e-2, 1e2), _line_width),
    Extreme("distance", "distance of the eye", "m", (0.5, *_powers(0, 7)), (0.5, 1e7), _distance),
    Extreme("tilt", "elevation of the eye above the ground", "degrees",
            (90, 45, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05), (90, 0.2), _tilt),
    Extreme("slope", "slope of the ground", "degrees", (0, 30, 60, 80, 85, 89, 89.9, 89.99), (30, 89.9), _slope),
    Extreme("exaggeration", "exaggeration of the ground", "", (0, *_powers(0, 5)), (1, 1000), _exaggeration),
    Extreme("overlap", "translucent features over one pixel", "", _powers(0, 5), (1, 100), _overlap),
    Extreme("nesting", "rings inside one another", "", _powers(0, 3), (10, 100), _nesting),
    Extreme("coincident", "gap between borders", "m", _powers(-7, 1)[::-1], (1, 1e-6), _coincident),
    Extreme("sliver", "length of slivers 4 m wide", "m", _powers(2, 11), (1e2, 1e8), _sliver),
    Extreme("vertices", "vertices of a ring", "", _powers(1, 6), (1e2, 1e4), _vertices),
    Extreme("holes", "holes of a polygon", "", _powers(0, 5), (1e2, 1e3), _holes),
)  # fmt: skip
