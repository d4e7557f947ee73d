"""Distance on the map to the nearest boundary of any feature: how sure an id at a point is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from .contract import FloatArray, IntArray, LayerLike, SceneLike, visible_features
from .membership import Segments, segment_distance

if TYPE_CHECKING:
    from collections.abc import Iterator

# Points whose neighbourhood is searched at once.
CHUNK = 100_000


def edge_distance(scene: SceneLike, xy: FloatArray, limit: float = np.inf) -> FloatArray:
    """Distance (n,) in metres from map points (n, 2) to the nearest boundary of a drawn feature.

    A boundary is a ring's edge, or the border of a line's stroke: |distance to the line - width/2|.
    Points farther than `limit` from all, NaN points, and points of a scene without features get inf.
    """
    xy = np.asarray(xy, dtype=np.float64).reshape(-1, 2)
    nearest = np.full(len(xy), np.inf)
    places = np.flatnonzero(np.isfinite(xy).all(axis=1))
    for layer in scene.layers:
        for group in _width_groups(layer):
            boundaries = _Boundaries(layer, group)
            for start in range(0, len(places), CHUNK):
                chunk = places[start : start + CHUNK]
                nearest[chunk] = np.minimum(nearest[chunk], boundaries.distance(xy[chunk]))
    nearest[nearest > limit] = np.inf
    return nearest


def _width_groups(layer: LayerLike) -> Iterator[IntArray]:
    """Segments of drawn features, lines of about one width at a time.

    The search reaches as far as the widest stroke of its group: one wide line must not slow the rest.
    """
    owner = Segments.of(layer.features).feature
    drawn = visible_features(layer)[owner]
    group = np.zeros(len(owner))
    if layer.features.kind == "lines":
        widths = np.asarray(layer.widths, dtype=np.float64)[owner]
        drawn &= widths >= 0
        group = np.frexp(widths)[1].astype(np.float64)
    for value in np.unique(group[drawn]):
        yield np.flatnonzero(drawn & (group == value))


class _Boundaries:
    """The boundaries of some of a layer's segments in a tree."""

    def __init__(self, layer: LayerLike, which: IntArray) -> None:
        self.segments = Segments.of(layer.features)[which]
        self.half_widths: FloatArray = np.asarray(layer.widths, dtype=np.float64) / 2
        self.strokes = layer.features.kind == "lines"
        ends = np.stack([self.segments.start, self.segments.end], axis=1)
        self.tree = shapely.STRtree(np.asarray(shapely.linestrings(ends)))

    def distance(self, xy: FloatArray) -> FloatArray:
        """Distance (n,) to the nearest boundary of finite points (n, 2)."""
        points = shapely.points(xy)
        (_, segment), nearest = self.tree.query_nearest(points, return_distance=True, all_matches=False)
        if not self.strokes:
            return np.asarray(nearest, dtype=np.float64)
        half_widths = self.half_widths[self.segments.feature]
        # The nearest line bounds the answer; no line farther than that beyond its stroke can beat it.
        bound = np.abs(nearest - half_widths[segment])
        reach = (bound + half_widths.max(initial=0.0)) * (1 + 1e-9)
        pairs = self.tree.query(points, predicate="dwithin", distance=reach)
        return self._stroke_distance(xy, pairs[0], pairs[1])

    def _stroke_distance(self, xy: FloatArray, point: IntArray, segment: IntArray) -> FloatArray:
        """Distance (n,) to the nearest stroke's border, over pairs of points and segments."""
        starts, ends = self.segments.start[segment], self.segments.end[segment]
        distance = segment_distance(xy[point, 0], xy[point, 1], starts, ends)
        # The border is that of the whole line: its nearest segment counts, not each of them.
        feature = self.segments.feature[segment]
        order = np.lexsort((distance, feature, point))
        point, feature, distance = point[order], feature[order], distance[order]
        first = np.flatnonzero(np.diff(point, prepend=-1) | np.diff(feature, prepend=-1))
        border = np.abs(distance[first] - self.half_widths[feature[first]])
        nearest = np.full(len(xy), np.inf)
        np.minimum.at(nearest, point[first], border)
        return nearest
