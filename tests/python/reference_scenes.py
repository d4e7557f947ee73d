"""Small scenes and cameras for the tests of the reference, free of the package's own classes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]


@dataclass
class Features:
    kind: str
    coords: FloatArray
    part_offsets: NDArray[np.int64]
    feature_offsets: NDArray[np.int64]
    rows: NDArray[np.int64]


@dataclass
class Style:
    corner: str = "round"
    cap: str = "round"
    miter_limit: float = 40.0
    slope_correction: str = "none"
    pattern: Any = None
    bands: tuple[Any, ...] = ()


@dataclass
class Stroke:
    colors: NDArray[np.uint8]
    widths: FloatArray
    styles: tuple[Style, ...] = (Style(),)
    style_of: NDArray[np.int64] | None = None
    units: str = "m"
    limits: Any = None
    follows_view: bool = False


@dataclass
class Fill:
    colors: NDArray[np.uint8]
    hatches: tuple[Any, ...] = (None,)
    hatch_of: NDArray[np.int64] | None = None


@dataclass
class Layer:
    features: Features
    draw_order: NDArray[np.int64]
    fill: Fill | None = None
    stroke: Stroke | None = None
    casing: Stroke | None = None
    outline_mode: str = "normal"
    outline_order: str = "layer"


@dataclass
class Terrain:
    x0: float
    y0: float
    dx: float
    dy: float


@dataclass
class Scene:
    heights: NDArray[np.float32]
    terrain: Terrain
    layers: list[Layer] = field(default_factory=list)


@dataclass
class Camera:
    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)
    fov: float | None = 45.0
    view_height: float | None = None


def make_layer(
    kind: str,
    features: list[list[Any]],
    *,
    width: Any = 0.0,
    colors: Any = None,
    style: Style | None = None,
) -> Layer:
    """A layer of features, each a list of parts, each a list of (x, y). Polygons with a width have outlines too."""
    parts = [np.asarray(part, dtype=np.float64).reshape(-1, 2) for feature in features for part in feature]
    count = len(features)
    if colors is None:
        colors = [(255, 255, 255, 255)] * count
    table = Features(
        kind,
        np.concatenate([np.empty((0, 2)), *parts]),
        np.cumsum([0] + [len(part) for part in parts]),
        np.cumsum([0] + [len(feature) for feature in features]),
        np.arange(count) * 10,
    )
    given = np.array(colors, dtype=np.uint8).reshape(-1, 4)
    widths = np.broadcast_to(np.asarray(width, dtype=np.float64), (count,)).copy()
    layer = Layer(table, np.arange(count))
    if kind == "polygons":
        layer.fill = Fill(given)
    if kind == "lines" or widths.any():
        layer.stroke = Stroke(given, widths, (style or Style(),))
    return layer


def square(x: float, y: float, side: float) -> list[tuple[float, float]]:
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


def flat_scene(half: float = 100.0, height: float = 0.0) -> Scene:
    return Scene(np.full((2, 2), height, dtype=np.float32), Terrain(-half, half, 2 * half, 2 * half))


def plan_camera(view_height: float, x: float = 0.0, y: float = 0.0) -> Camera:
    return Camera((x, y, 1000.0), (x, y, 0.0), up=(0.0, 1.0, 0.0), fov=None, view_height=view_height)


def rough_scene(seed: int, rows: int, columns: int, holes: float, offset: float = 0.0) -> Scene:
    generator = np.random.default_rng(seed)
    heights = generator.uniform(0, 40, (rows, columns)).astype(np.float32)
    heights[generator.random((rows, columns)) < holes] = np.nan
    return Scene(heights, Terrain(offset - 50.0, offset / 3 + 60.0, 10.0, 7.0))


def star_features(count: int, seed: int) -> list[list[FloatArray]]:
    generator = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, 23, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    features = []
    for _ in range(count):
        radii = generator.uniform(2, 20) * generator.uniform(0.4, 1, (23, 1))
        features.append([generator.uniform(0, 100, 2) + radii * circle])
    return features
