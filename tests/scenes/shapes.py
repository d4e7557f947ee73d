"""What the scenes are made of: ground, rings and lines by formula, and the ways to add them to a scene."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

import decalgl as dg

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]


# Ground


def waves(rows: int, columns: int, relief: float, seed: int = 1) -> NDArray[np.float32]:
    """Heights of rolling hills, (rows, columns) metres: waves of falling length and height, about +-relief."""
    generator = np.random.default_rng(seed)
    y, x = np.mgrid[0:rows, 0:columns] / max(rows, columns, 2)
    heights = np.zeros((rows, columns))
    for octave in range(7):
        for _ in range(3):
            angle, phase = generator.uniform(0.0, 2.0 * np.pi, 2)
            across = x * np.cos(angle) + y * np.sin(angle)
            heights += np.sin(2.0 * np.pi * 1.5 * 2.0**octave * across + phase) / 2.0**octave
    return (heights * relief / 4.0).astype(np.float32)


def hills_terrain(
    rows: int = 193, columns: int = 257, step: float = 10.0, relief: float = 150.0
) -> dg.Terrain:
    """Hills around the origin, `step` metres between samples."""
    return dg.Terrain(
        waves(rows, columns, relief), -step * (columns - 1) / 2, step * (rows - 1) / 2, step, 0.9 * step
    )


def flat_terrain(half: float, x: float = 0.0, y: float = 0.0) -> dg.Terrain:
    """Level ground from (x - half, y - half) to (x + half, y + half)."""
    return dg.Terrain.flat((x - half, y - half, x + half, y + half))


def uneven_terrain(
    half: float, relief: float, x: float = 0.0, y: float = 0.0, samples: int = 33
) -> dg.Terrain:
    step = 2.0 * half / (samples - 1)
    return dg.Terrain(waves(samples, samples, relief, seed=4), x - half, y + half, step, step)


# Features


def rough_ring(seed: int, x: float, y: float, radius: float, count: int = 400) -> shapely.Polygon:
    """A ring with details of all sizes."""
    generator = np.random.default_rng(seed)
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    waves = np.arange(2, count // 4)
    phase, size = generator.uniform(0, 2 * np.pi, len(waves)), generator.normal(size=len(waves)) / waves
    r = radius * (1.0 + 0.25 * (size[:, None] * np.cos(waves[:, None] * angle + phase[:, None])).sum(axis=0))
    return shapely.Polygon(np.column_stack([x + r * np.cos(angle), y + r * np.sin(angle)]))


def circle(x: float, y: float, radius: float, corners: int = 24, turn: float = 0.0) -> FloatArray:
    """A regular polygon, (corners, 2)."""
    angle = turn + np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)


def star(x: float, y: float, radius: float, points: int = 5, turn: float = 0.0) -> FloatArray:
    """A star drawn in one stroke, which crosses itself: even-odd leaves its middle open."""
    return circle(x, y, radius, points, turn)[np.arange(points) * 2 % points]


def blob(generator: np.random.Generator, x: float, y: float, radius: float, corners: int = 40) -> FloatArray:
    """A ring of uneven radius around a point."""
    factors = generator.uniform(0.55, 1.0, (corners, 1))
    return np.array([x, y]) + (circle(0.0, 0.0, radius, corners) * factors)


def walk(generator: np.random.Generator, start: FloatArray, step: float, count: int) -> FloatArray:
    """A winding line of `count` segments, (count + 1, 2)."""
    heading = generator.uniform(0.0, 2.0 * np.pi) + np.cumsum(generator.normal(0.0, 0.5, count))
    moves = step * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    points: FloatArray = start + np.concatenate([np.zeros((1, 2)), np.cumsum(moves, axis=0)])
    return points


def partition(
    bounds: tuple[float, float, float, float], columns: int, rows: int, seed: int = 5, edge_points: int = 5
) -> list[shapely.Polygon]:
    """Cells that fill `bounds` without a gap: shaken corners, crooked borders that neighbours share exactly."""
    generator = np.random.default_rng(seed)
    x0, y0, x1, y1 = bounds
    shaken = generator.uniform(-0.35, 0.35, (rows + 1, columns + 1, 2))
    rim = np.zeros((rows + 1, columns + 1), dtype=np.bool_)
    rim[[0, -1], :] = rim[:, [0, -1]] = True
    shaken[rim] = 0.0
    row, column = np.mgrid[0 : rows + 1, 0 : columns + 1]
    size = np.array([(x1 - x0) / columns, (y1 - y0) / rows])
    corners = np.stack([column, row], axis=-1) * size + shaken * size + (x0, y0)

    def border(a: FloatArray, b: FloatArray, straight: bool) -> FloatArray:
        t = np.linspace(0.0, 1.0, edge_points + 1)[1:-1, None]
        points = a + t * (b - a)
        return points if straight else points + generator.uniform(-0.06, 0.06, points.shape) * size

    across = [[border(corners[r, c], corners[r, c + 1], rim[r, c] and rim[r, c + 1]) for c in range(columns)]
              for r in range(rows + 1)]  # fmt: skip
    upwards = [[border(corners[r, c], corners[r + 1, c], rim[r, c] and rim[r + 1, c]) for c in range(columns + 1)]
               for r in range(rows)]  # fmt: skip
    return [
        shapely.Polygon(np.concatenate([
            corners[r, c][None], across[r][c], corners[r, c + 1][None], upwards[r][c + 1],
            corners[r + 1, c + 1][None], across[r + 1][c][::-1], corners[r + 1, c][None], upwards[r][c][::-1],
        ]))
        for r in range(rows)
        for c in range(columns)
    ]  # fmt: skip


def rings(features: list[list[FloatArray]], kind: str = "polygons") -> dg.FeatureTable:
    """A table of features, each a list of parts."""
    parts = [np.asarray(part, dtype=np.float64).reshape(-1, 2) for feature in features for part in feature]
    return dg.FeatureTable(
        "polygons" if kind == "polygons" else "lines",
        np.concatenate(parts),
        np.cumsum([0] + [len(part) for part in parts]),
        np.cumsum([0] + [len(feature) for feature in features]),
        np.arange(len(features)),
    )


def lines(features: list[FloatArray]) -> dg.FeatureTable:
    """A table of lines of one part each."""
    return rings([[feature] for feature in features], "lines")


def tints(count: int, seed: int, alpha: float | tuple[float, float] = 1.0) -> list[tuple[float, ...]]:
    """Colours that tell features apart, from 0 to 1, of one alpha or of alphas in a range."""
    generator = np.random.default_rng(seed)
    colors = generator.uniform(0.1, 1.0, (count, 4))
    colors[:, 3] = generator.uniform(*alpha, count) if isinstance(alpha, tuple) else alpha
    return [tuple(color) for color in colors.tolist()]


def add_blobs(scene: dg.Scene, reach: float, count: int, alpha: float | tuple[float, float] = 1.0) -> None:
    """Uneven polygons with a hole each, from reach / 40 to reach / 5 in size."""
    generator = np.random.default_rng(21)
    features = []
    for _ in range(count):
        x, y = generator.uniform(-reach, reach, 2)
        radius = reach * 10.0 ** generator.uniform(-1.6, -0.7)
        features.append([blob(generator, x, y, radius), blob(generator, x, y, 0.4 * radius, 15)])
    scene.add_polygons(rings(features), name="blobs", color=tints(count, 22, alpha))


def add_stars(scene: dg.Scene, reach: float, count: int) -> None:
    """Self-crossing stars of 5 to 13 points."""
    generator = np.random.default_rng(31)
    features = []
    for i in range(count):
        x, y = generator.uniform(-reach, reach, 2)
        radius = reach * generator.uniform(0.02, 0.12)
        features.append([star(x, y, radius, 5 + 2 * (i % 5), generator.uniform(0.0, 7.0))])
    scene.add_polygons(rings(features), name="stars", color=tints(count, 32))


def nested_rings(x: float, y: float, radius: float, depth: int) -> list[FloatArray]:
    """Rings inside one another: every second one is a hole."""
    return [
        circle(x, y, radius * (depth - i) / depth, 16, 0.1 * i)[:: 1 if i % 2 == 0 else -1]
        for i in range(depth)
    ]


def add_walks(
    scene: dg.Scene, reach: float, count: int, width: Any, alpha: float = 1.0, seed: int = 41
) -> None:
    """Winding lines that start anywhere."""
    generator = np.random.default_rng(seed)
    found = [walk(generator, generator.uniform(-reach, reach, 2), reach / 40, 25) for _ in range(count)]
    scene.add_lines(
        lines(found), name=f"walks {seed}", width=width, width_units="m", color=tints(count, seed + 1, alpha)
    )


def repainted(scene: dg.Scene, relief: dg.Relief) -> dg.Scene:
    """The same terrain and layers under another relief."""
    copy = dg.Scene(scene.terrain, scene.exaggeration, relief)
    copy._layers.extend(scene.layers)
    return copy


def drawn_by(scene: dg.Scene, technique: dg.Technique) -> dg.Scene:
    """The same terrain and layers, drawn by another technique."""
    copy = dg.Scene(scene.terrain, scene.exaggeration, scene.relief)
    for layer in scene.layers:
        copy._layers.append(dataclasses.replace(layer, technique=technique))
    return copy


def with_features(scene: dg.Scene, tables: list[dg.FeatureTable]) -> dg.Scene:
    """The same terrain and styles over other geometry, a table a layer."""
    copy = dg.Scene(scene.terrain, scene.exaggeration, scene.relief)
    for layer, table in zip(scene.layers, tables, strict=True):
        copy._layers.append(dataclasses.replace(layer, features=table))
    return copy
