"""Where the pictures are taken from: views of San Francisco bay, and places found by what lies there.

overview    all of the map from above                   worst       2 km where the map is fullest
oblique     over the bay to the horizon                 far         the map as high as 200 of 1080 pixels
close       4 km from the hills with most lines         interior    a place without a vertex far around
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Points = NDArray[np.float64]
    Bounds = tuple[float, float, float, float]
    Point = tuple[float, float, float]

FOV = 45.0
ASPECT = 16.0 / 9.0
FAR_SHARE = 200.0 / 1080.0
WORST_WIDTH = 2000.0


def fixed_views(ground: dg.Terrain) -> dict[str, dg.Camera]:
    """The views that do not depend on what lies on the terrain."""
    x0, y0, x1, y1 = ground.bounds
    middle = ((x0 + x1) / 2, (y0 + y1) / 2, 0.0)
    bay = (middle[0], middle[1] + 10_000.0, 0.0)
    return {
        "overview": dg.Camera.top_down(ground.bounds),
        "oblique": dg.Camera.orbit(bay, distance=60_000, azimuth=200, elevation=25),
        "close": dg.Camera.orbit((-2000.0, 38_000.0, 300.0), distance=4000, azimuth=200, elevation=35),
        "far": _showing(middle, ASPECT * (y1 - y0) / FAR_SHARE, elevation=60),
    }


def worst(ground: dg.Terrain, points: Points) -> dg.Camera:
    """Onto the fullest sixteenth of the fullest 1/256 of the map, about 2 km across."""
    block = fullest(points, ground.bounds, 16)
    x0, y0, x1, y1 = fullest(points, block, 4)
    return _showing(on_ground(ground, (x0 + x1) / 2, (y0 + y1) / 2), WORST_WIDTH, elevation=45)


def interior(ground: dg.Terrain, points: Points) -> dg.Camera:
    """Onto the place that is farthest from all vertices, holes and rims, and none of them in the picture."""
    x, y, room = _emptiest(ground, points)
    return _showing(on_ground(ground, x, y), min(WORST_WIDTH, room / 2.0), elevation=45)


def zoom(target: Point, far: float, close: float, steps: int) -> list[dg.Camera]:
    """From far away to close to a place, each step nearer by the same factor (Zechmeister 2020, figure 5.8)."""
    distances = far * (close / far) ** np.linspace(0.0, 1.0, steps)
    return [dg.Camera.orbit(target, float(distance), 200, 45) for distance in distances]


def flight(bounds: Bounds, steps: int) -> list[dg.Camera]:
    """The four phases of LOOPS's section 6.4: zooming in, along at one height, looking around, through a valley."""
    x0, y0, x1, y1 = bounds
    wide, middle = x1 - x0, np.array([(x0 + x1) / 2, (y0 + y1) / 2])
    path = []
    for t in (np.arange(steps) + 0.5) / steps:
        part = 4.0 * t % 1.0
        if t < 0.25:
            path.append(dg.Camera.orbit((*middle, 0.0), wide * 1.5 * 0.05**part, 200, 45))
        elif t < 0.5:
            x, y = middle[0] + wide * 0.4 * (part - 0.5), middle[1]
            path.append(dg.Camera.orbit((x, y, 0.0), wide * 0.075, 200, 45))
        elif t < 0.75:
            eye = (*middle, wide * 0.05)
            angle = 2.0 * np.pi * part
            target = (middle[0] + wide * np.sin(angle), middle[1] + wide * np.cos(angle), -0.25 * wide)
            path.append(dg.Camera.look_at(eye, target))
        else:
            x, y = middle + wide * 0.2 * part
            path.append(dg.Camera.orbit((x, y, 0.0), wide * 0.03, 45, 20))
    return path


def flyover(ground: dg.Terrain, steps: int) -> list[dg.Camera]:
    """From the south-west to the north-east low over the ground, looking ahead and down (as Thöny 2018 flies)."""
    x0, y0, x1, y1 = ground.bounds
    wide, high = x1 - x0, y1 - y0
    path = []
    for t in np.linspace(0.1, 0.75, steps):
        x, y, z = on_ground(ground, x0 + t * wide, y0 + t * high)
        ahead = on_ground(ground, x0 + (t + 0.12) * wide, y0 + (t + 0.12) * high)
        path.append(dg.Camera.look_at((x, y, max(z, ahead[2]) + 0.04 * wide), ahead))
    return path


def _showing(target: tuple[float, float, float], width: float, elevation: float) -> dg.Camera:
    """A camera whose picture is `width` metres wide at the target."""
    distance = width / (2.0 * ASPECT * math.tan(math.radians(FOV) / 2.0))
    return dg.Camera.orbit(target, distance=distance, azimuth=200, elevation=elevation, fov=FOV)


def on_ground(ground: dg.Terrain, x: float, y: float) -> tuple[float, float, float]:
    row, column = round((ground.y0 - y) / ground.dy), round((x - ground.x0) / ground.dx)
    return (x, y, float(np.nan_to_num(ground.z[row, column])))


def _counts(points: Points, bounds: Bounds, divisions: int) -> NDArray[np.int64]:
    x0, y0, x1, y1 = bounds
    counts, _, _ = np.histogram2d(points[:, 0], points[:, 1], bins=divisions, range=((x0, x1), (y0, y1)))
    return np.asarray(counts, np.int64)


def fullest(points: Points, bounds: Bounds, divisions: int) -> Bounds:
    """The box with the most points of divisions x divisions."""
    counts = _counts(points, bounds, divisions)
    column, row = np.unravel_index(np.argmax(counts), counts.shape)
    x0, y0, x1, y1 = bounds
    wide, high = (x1 - x0) / divisions, (y1 - y0) / divisions
    west, south = x0 + float(column) * wide, y0 + float(row) * high
    return (west, south, west + wide, south + high)


def _emptiest(ground: dg.Terrain, points: Points, divisions: int = 256) -> tuple[float, float, float]:
    """(x, y, metres of free room around): boxes with vertices or holes grow until one place is left."""
    x0, y0, x1, y1 = ground.bounds
    rows, columns = np.nonzero(np.isnan(ground.z))
    holes = np.column_stack([x0 + ground.dx * columns, y1 - ground.dy * rows])
    full = (_counts(points, ground.bounds, divisions) + _counts(holes, ground.bounds, divisions)) > 0
    rounds = 0
    while not (grown := _grown(full)).all():
        full, rounds = grown, rounds + 1
    column, row = np.argwhere(~full)[0] + 0.5
    wide, high = (x1 - x0) / divisions, (y1 - y0) / divisions
    return x0 + column * wide, y0 + row * high, rounds * min(wide, high)


def _grown(full: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Boxes that are full or beside a full one; all around the map counts as full."""
    padded = np.pad(full, 1, constant_values=True)
    rows, columns = full.shape
    shifts = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return np.asarray(np.logical_or.reduce(shifts))
