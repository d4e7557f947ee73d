"""Which features hold which points of the map, decided in float64.

Polygons are even-odd over all rings of a feature: a point is inside when a ray towards +x crosses an
odd number of edges. An edge counts for y_low <= y < y_high and is evaluated from its lower end
whatever its direction, so a point on a border that two features share is inside exactly one of them.
Lines hold the points whose distance to any of their segments is at most half the width.

Points are cut into strips of equal counts along x and sorted by y within each:

      strip        near edges overlap the strip in x: tested point by point over their y range.
    |  . .  |  /   far edges lie right of the strip: each turns a run of sorted points over, which
    | . /   | /    costs two events, not a test for every point.
    |  / .  |/     Edges left of the strip are never crossed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .contract import BoolArray, FeaturesLike, FloatArray, IntArray, LayerLike, draw_ranks

if TYPE_CHECKING:
    from collections.abc import Iterator

# Pairs of an edge and a point that are held at once.
PAIR_LIMIT = 2_000_000
POINTS_PER_STRIP = 4096
MOST_STRIPS = 64


@dataclass(frozen=True)
class Membership:
    """The features of each of n points, bottom to top in the layer's draw order.

    offsets: (n + 1,); the features of point i are features[offsets[i]:offsets[i + 1]].
    features: (pairs,) indices into the layer's feature table.
    """

    offsets: IntArray
    features: IntArray

    def at(self, point: int) -> IntArray:
        """Features that hold one point, bottom to top."""
        return self.features[self.offsets[point] : self.offsets[point + 1]]

    def inside(self, feature: int) -> BoolArray:
        """Mask (n,) of the points that one feature holds."""
        points = np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))
        mask = np.zeros(len(self.offsets) - 1, dtype=np.bool_)
        mask[points[self.features == feature]] = True
        return mask

    def topmost(self) -> IntArray:
        """Topmost feature (n,) of each point, -1 where there is none."""
        top = np.full(len(self.offsets) - 1, -1, dtype=np.int64)
        filled = self.offsets[1:] > self.offsets[:-1]
        top[filled] = self.features[self.offsets[1:][filled] - 1]
        return top


def membership(layer: LayerLike, xy: FloatArray, only: BoolArray | None = None) -> Membership:
    """Features of a layer at map points xy (n, 2), metres; NaN points are in none.

    only: mask (features,) of the features to look at, all by default. Widths of lines are the
    layer's, colours are not looked at.
    """
    features = layer.features
    count = len(features.rows)
    segments = Segments.of(features)
    if only is not None:
        segments = segments[np.flatnonzero(only[segments.feature])]
    half_widths = np.asarray(layer.widths, dtype=np.float64) / 2
    segments = _in_range(segments, half_widths if features.kind == "lines" else None, xy)
    ranks = draw_ranks(layer)
    keys = []
    for points in strips(xy):
        if features.kind == "polygons":
            pairs = _inside_polygons(segments, points)
        else:
            pairs = _inside_lines(segments, half_widths, points)
        feature, rank = np.divmod(pairs, len(points.index))
        keys.append(points.index[rank] * count + ranks[feature])
    ordered = np.sort(np.concatenate(keys)) if keys else np.empty(0, dtype=np.int64)
    point, rank = np.divmod(ordered, max(count, 1))
    offsets = np.searchsorted(point, np.arange(len(xy) + 1)).astype(np.int64)
    return Membership(offsets, np.asarray(layer.draw_order, dtype=np.int64)[rank])


def _in_range(segments: Segments, half_widths: FloatArray | None, xy: FloatArray) -> Segments:
    """The segments that can matter to any of the points: strokes near them, or edges beside them.

    half_widths: (features,) of lines, None for polygons, whose edges count far to the right too.
    """
    places = xy[np.isfinite(xy).all(axis=1)]
    if not len(places):
        return segments
    reach = 0.0 if half_widths is None else half_widths[segments.feature][:, None]
    low, high = (
        np.minimum(segments.start, segments.end) - reach,
        np.maximum(segments.start, segments.end) + reach,
    )
    kept = (high >= places.min(axis=0)).all(axis=1) & (low[:, 1] <= places[:, 1].max())
    if half_widths is not None:
        kept &= low[:, 0] <= places[:, 0].max()
    return segments[np.flatnonzero(kept)]


@dataclass(frozen=True)
class Segments:
    """Segments of many features: start and end (segments, 2), feature (segments,)."""

    start: FloatArray
    end: FloatArray
    feature: IntArray

    @staticmethod
    def of(features: FeaturesLike) -> Segments:
        """Ring edges of polygons, closed implicitly, or the segments of lines.

        A line of one point is a segment of length zero.
        """
        coords = np.asarray(features.coords, dtype=np.float64).reshape(-1, 2)
        parts = np.asarray(features.part_offsets, dtype=np.int64)
        first, lengths = parts[:-1], np.diff(parts)
        filled = lengths > 0
        owner = np.repeat(np.arange(len(features.rows)), np.diff(features.feature_offsets))
        feature = np.repeat(owner, lengths)
        following = np.arange(1, len(coords) + 1)
        last = parts[1:][filled] - 1
        following[last] = first[filled]
        segments = Segments(coords, coords[following], feature)
        if features.kind == "polygons":
            return segments
        keep = np.ones(len(coords), dtype=np.bool_)
        keep[last[lengths[filled] > 1]] = False
        return segments[np.flatnonzero(keep)]

    def __getitem__(self, which: IntArray) -> Segments:
        return Segments(self.start[which], self.end[which], self.feature[which])


@dataclass(frozen=True)
class Strip:
    """Points (n,) between two x, sorted by y; index tells which points of the caller they are."""

    x: FloatArray
    y: FloatArray
    index: IntArray


def strips(xy: FloatArray) -> Iterator[Strip]:
    """Cut finite points (n, 2) into strips of nearly equal counts."""
    index = np.flatnonzero(np.isfinite(xy).all(axis=1))
    if not len(index):
        return
    index = index[np.argsort(xy[index, 0], kind="stable")]
    strip_count = int(np.clip(len(index) // POINTS_PER_STRIP, 1, MOST_STRIPS))
    for part in np.array_split(index, strip_count):
        ordered = part[np.argsort(xy[part, 1], kind="stable")]
        yield Strip(xy[ordered, 0], xy[ordered, 1], ordered)


def candidate_pairs(first: IntArray, last: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """All (i, j) with first[i] <= j < last[i], in batches of about PAIR_LIMIT."""
    counts = np.maximum(last - first, 0)
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    start = done = 0
    while done < total:
        stop = max(int(np.searchsorted(ends, done + PAIR_LIMIT, side="right")), start + 1)
        batch = counts[start:stop]
        owner = np.repeat(np.arange(start, stop), batch)
        shift = np.repeat(first[start:stop] - (np.cumsum(batch) - batch), batch)
        yield owner, np.arange(len(owner)) + shift
        start, done = stop, int(ends[stop - 1])


def segment_distance(x: FloatArray, y: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Distance (n,) of points (x, y) to segments start, end (n, 2), pair by pair."""
    along_x, along_y = end[:, 0] - start[:, 0], end[:, 1] - start[:, 1]
    from_x, from_y = x - start[:, 0], y - start[:, 1]
    length_squared = along_x * along_x + along_y * along_y
    with np.errstate(invalid="ignore", divide="ignore"):
        position = (from_x * along_x + from_y * along_y) / length_squared
    position = np.where(length_squared > 0, np.clip(position, 0.0, 1.0), 0.0)
    return np.hypot(from_x - position * along_x, from_y - position * along_y)


def _inside_lines(segments: Segments, half_widths: FloatArray, points: Strip) -> IntArray:
    """Keys feature * n + point of the points no farther from lines than half their width."""
    reach = half_widths[segments.feature]
    x = np.sort(np.stack([segments.start[:, 0], segments.end[:, 0]]), axis=0)
    y = np.sort(np.stack([segments.start[:, 1], segments.end[:, 1]]), axis=0)
    near = np.flatnonzero((x[0] - reach <= points.x.max()) & (x[1] + reach >= points.x.min()))
    segments, reach = segments[near], reach[near]
    first = np.searchsorted(points.y, y[0, near] - reach, side="left")
    last = np.searchsorted(points.y, y[1, near] + reach, side="right")
    keys = [np.empty(0, dtype=np.int64)]
    for owner, point in candidate_pairs(first, last):
        x_of, y_of = points.x[point], points.y[point]
        close = segment_distance(x_of, y_of, segments.start[owner], segments.end[owner]) <= reach[owner]
        keys.append(np.unique(segments.feature[owner[close]] * len(points.y) + point[close]))
    return np.unique(np.concatenate(keys))


def _inside_polygons(segments: Segments, points: Strip) -> IntArray:
    """Keys feature * n + point of the points inside polygons, even-odd."""
    upward = segments.start[:, 1] < segments.end[:, 1]
    low = np.where(upward[:, None], segments.start, segments.end)
    high = np.where(upward[:, None], segments.end, segments.start)
    first = np.searchsorted(points.y, low[:, 1], side="left")
    last = np.searchsorted(points.y, high[:, 1], side="left")
    left, right = np.minimum(low[:, 0], high[:, 0]), np.maximum(low[:, 0], high[:, 0])
    crossed = (first < last) & (right >= points.x.min())
    far = np.flatnonzero(crossed & (left > points.x.max()))
    near = np.flatnonzero(crossed & (left <= points.x.max()))
    keys = [_beyond_strip(segments.feature[far], first[far], last[far], len(points.y))]
    low, high, feature = low[near], high[near], segments.feature[near]
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
