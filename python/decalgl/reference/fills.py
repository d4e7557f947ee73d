"""Which polygons hold which points of the map, even-odd over all rings of a feature, in float64; and hatches.

A point is inside when a ray towards +x crosses an odd number of edges. An edge counts for y_low <= y < y_high
and is evaluated from its lower end whatever its direction, so a point on a border that two features share is
inside exactly one of them. Points come in strips:

      strip        near edges overlap the strip in x: tested point by point over their y range.
    |  . .  |  /   far edges lie right of the strip: each turns a run of sorted points over, which
    | . /   | /    costs two events, not a test for every point.
    |  / .  |/     Edges left of the strip are never crossed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .points import Strip, candidate_pairs

if TYPE_CHECKING:
    from .contract import BoolArray, FeaturesLike, FloatArray, HatchLike, IntArray


@dataclass(frozen=True)
class Edges:
    """Edges of the rings of many polygons: start and end (edges, 2), feature (edges,)."""

    start: FloatArray
    end: FloatArray
    feature: IntArray

    @staticmethod
    def of(features: FeaturesLike, wanted: BoolArray) -> Edges:
        """All edges of the wanted features, mask (features,); rings are closed implicitly."""
        coords = np.asarray(features.coords, dtype=np.float64).reshape(-1, 2)
        parts = np.asarray(features.part_offsets, dtype=np.int64)
        first, lengths = parts[:-1], np.diff(parts)
        filled = lengths > 0
        owner = np.repeat(np.arange(len(features.rows)), np.diff(features.feature_offsets))
        feature = np.repeat(owner, lengths)
        following = np.arange(1, len(coords) + 1)
        following[parts[1:][filled] - 1] = first[filled]
        return Edges(coords, coords[following], feature)[np.flatnonzero(wanted[feature])]

    def __getitem__(self, which: IntArray) -> Edges:
        return Edges(self.start[which], self.end[which], self.feature[which])

    def beside(self, xy: FloatArray) -> Edges:
        """The edges that rays from any of the points (n, 2) may cross."""
        places = xy[np.isfinite(xy).all(axis=1)]
        if not len(places):
            return self
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        kept = (high >= places.min(axis=0)).all(axis=1) & (low[:, 1] <= places[:, 1].max())
        return self[np.flatnonzero(kept)]


def inside_polygons(edges: Edges, points: Strip) -> IntArray:
    """Keys feature * n + point of the points inside polygons, even-odd, ascending."""
    upward = edges.start[:, 1] < edges.end[:, 1]
    low = np.where(upward[:, None], edges.start, edges.end)
    high = np.where(upward[:, None], edges.end, edges.start)
    first = np.searchsorted(points.y, low[:, 1], side="left")
    last = np.searchsorted(points.y, high[:, 1], side="left")
    left, right = np.minimum(low[:, 0], high[:, 0]), np.maximum(low[:, 0], high[:, 0])
    crossed = (first < last) & (right >= points.x.min())
    far = np.flatnonzero(crossed & (left > points.x.max()))
    near = np.flatnonzero(crossed & (left <= points.x.max()))
    keys = [_beyond_strip(edges.feature[far], first[far], last[far], len(points.y))]
    low, high, feature = low[near], high[near], edges.feature[near]
    for owner, point in candidate_pairs(first[near], last[near]):
        side = (high[owner, 0] - low[owner, 0]) * (points.y[point] - low[owner, 1]) - (
            points.x[point] - low[owner, 0]
        ) * (high[owner, 1] - low[owner, 1])
        crossing = side > 0
        keys.append(_odd(feature[owner[crossing]] * len(points.y) + point[crossing]))
    return _odd(np.concatenate(keys))


def _beyond_strip(feature: IntArray, first: IntArray, last: IntArray, count: int) -> IntArray:
    """Keys feature * count + point with an odd number of edges over them, each from first to last."""
    stride = count + 1
    events = _odd(np.concatenate([feature * stride + first, feature * stride + last]))
    # Every edge has two events of its feature, so the rest pair up within features too.
    owner, start = np.divmod(events[0::2], stride)
    stop = events[1::2] - owner * stride
    lengths = stop - start
    shift = np.repeat(owner * count + start - (np.cumsum(lengths) - lengths), lengths)
    inside: IntArray = np.arange(len(shift)) + shift
    return inside


def _odd(keys: IntArray) -> IntArray:
    """Distinct keys, ascending, of those that occur an odd number of times."""
    distinct, counts = np.unique(keys, return_counts=True)
    odd: IntArray = distinct[counts % 2 == 1]
    return odd


def hatch_clearance(hatch: HatchLike, xy: FloatArray) -> FloatArray:
    """How far (n,) inside the lines of a hatch points (n, 2) of the scene are, less than 0 beside them."""
    angle = np.radians(hatch.angle)
    x, y = xy[:, 0], xy[:, 1]
    clearance = _lines_clearance(hatch, -x * np.sin(angle) + y * np.cos(angle))
    if hatch.crossed:
        clearance = np.maximum(clearance, _lines_clearance(hatch, x * np.cos(angle) + y * np.sin(angle)))
    return clearance


def _lines_clearance(hatch: HatchLike, across: FloatArray) -> FloatArray:
    clearance: FloatArray = hatch.width / 2 - np.abs(
        across - hatch.spacing * np.round(across / hatch.spacing)
    )
    return clearance
