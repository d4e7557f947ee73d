"""Made-up polygons that real maps have none of: one ring of millions of vertices, and stacks that overlap.

    spiked ring                          stack            the same, disjoint

        /\\   /\\   /\\                     _____
     __/  \\_/  \\_/  \\__                 _|__   |          o   o   o
     \\   o  o  o  o   /                |  | |  |
     /__ o  o  o  o __\\                |__|_|__|          o   o   o
       \\/ \\  / \\  / \\/                   |_____|

All come from seeded generators and are the same on every machine.
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

VERTICES_A_SPIKE = 2500
HOLE_VERTICES = 24
BLOB_VERTICES = 48


def spiked_ring(bounds: Bounds, vertices: int, holes: int) -> dg.FeatureTable:
    """One polygon: a ring of `vertices` whose spikes reach over half the way inwards, and round holes within.

    The ring is star-shaped, as its angle only ever grows, and the holes lie inside the spikes' roots: nothing
    crosses. With 5 M vertices over 100 km its segments are as long as those of isolines.
    """
    west, south, east, north = bounds
    middle = np.array([(west + east) / 2.0, (south + north) / 2.0])
    reach = 0.48 * min(east - west, north - south)
    turn = np.arange(vertices) / vertices
    spike = turn * max(3, round(vertices / VERTICES_A_SPIKE))
    inwards = np.abs(2.0 * (spike % 1.0) - 1.0)
    ripple = sum(math.ldexp(1.0, -i) * np.sin(2.0 * math.pi * turn * 7.0 * 5.0**i) for i in range(5))
    radius = reach * (0.95 - 0.45 * inwards + 0.02 * ripple)
    ring = middle + radius[:, None] * _directions(turn)
    room = 0.4 * reach
    parts = [ring, *_holes(middle, room, holes)]
    ends = np.cumsum([0, *map(len, parts)])
    return dg.FeatureTable(
        "polygons", np.concatenate(parts), ends, np.array([0, len(parts)]), np.zeros(1, int)
    )


def _holes(middle: Points, room: float, count: int) -> list[Points]:
    """Circles on the points of a lattice that lie within `room` metres of the middle."""
    spacing = room * math.sqrt(math.pi / (1.1 * count))
    steps = np.arange(-math.ceil(room / spacing), math.ceil(room / spacing) + 1)
    lattice = spacing * np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    nearest = np.argsort(np.hypot(*lattice.T), kind="stable")[:count]
    circle = 0.3 * spacing * _directions(np.arange(HOLE_VERTICES) / HOLE_VERTICES)
    return [middle + centre + circle for centre in lattice[nearest]]


def stack(bounds: Bounds, count: int) -> dg.FeatureTable:
    """`count` wobbly polygons that all lie over the middle of the bounds and cover most of it."""
    centres = 0.5 + np.random.default_rng(1).uniform(-0.1, 0.1, (count, 2))
    return _blobs(bounds, centres, 0.5)


def disjoint(bounds: Bounds, count: int) -> dg.FeatureTable:
    """The polygons of `stack`, small and side by side."""
    side = math.ceil(math.sqrt(count))
    places = np.column_stack([np.arange(count) % side, np.arange(count) // side])
    return _blobs(bounds, (places + 0.5) / side, 0.35 / side)


def _blobs(bounds: Bounds, centres: Points, radius: float) -> dg.FeatureTable:
    """Polygons around centres (n, 2) in the unit square, which is spread over the bounds."""
    count = len(centres)
    turn = np.arange(BLOB_VERTICES) / BLOB_VERTICES
    phase = np.random.default_rng(2).uniform(0.0, 2.0 * math.pi, (count, 1))
    wobble = 0.2 * np.sin(6.0 * math.pi * turn + phase) + 0.1 * np.sin(14.0 * math.pi * turn + 2.0 * phase)
    unit = centres[:, None, :] + (radius * (1.0 + wobble))[:, :, None] * _directions(turn)
    west, south, east, north = bounds
    points = np.array([west, south]) + unit.reshape(-1, 2) * np.array([east - west, north - south])
    offsets = BLOB_VERTICES * np.arange(count + 1)
    return dg.FeatureTable("polygons", points, offsets, np.arange(count + 1), np.arange(count))


def _directions(turn: Points) -> Points:
    """Unit vectors (n, 2) after so many turns."""
    return np.column_stack([np.cos(2.0 * math.pi * turn), np.sin(2.0 * math.pi * turn)])
