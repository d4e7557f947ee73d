"""Which decals hold which points of the map, and in which colours, decided in float64.

Polygons are even-odd over all rings of a feature. Lines are closed sets: without other styles they hold the points
whose distance to any of their segments is at most half the width. A gap in a dash or a hatch holds nothing, nor does
a band of alpha 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .decals import FillDecals, StrokeDecals, decals_of
from .fills import Edges, hatch_clearance, inside_polygons
from .points import strips
from .screen import touching_on_screen
from .strokes import Slopes, StyledStroke, Touch, styled_strokes

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from .contract import BandLike, BoolArray, FloatArray, IntArray, LayerLike
    from .points import Strip


@dataclass(frozen=True)
class Membership:
    """The decals of each of n points, bottom to top: (decals, ...) arrays, those of a point side by side.

    offsets: (n + 1,); the decals of point i are those from offsets[i] to offsets[i + 1].
    features: indices into the layer's feature table. A fill and its outline are two decals of one feature.
    colors: (decals, 4), premultiplied, 0..1: rows `tints` of a `palette`.
    """

    offsets: IntArray
    features: IntArray
    tints: IntArray
    palette: FloatArray

    @property
    def colors(self) -> FloatArray:
        colors: FloatArray = self.palette[self.tints]
        return colors

    def at(self, point: int) -> IntArray:
        """Features of the decals that hold one point, bottom to top."""
        return self.features[self.offsets[point] : self.offsets[point + 1]]

    def inside(self, feature: int) -> BoolArray:
        """Mask (n,) of the points that any decal of one feature holds."""
        points = np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))
        mask = np.zeros(len(self.offsets) - 1, dtype=np.bool_)
        mask[points[self.features == feature]] = True
        return mask

    def topmost(self) -> IntArray:
        """Feature (n,) of the topmost decal of each point, -1 where there is none."""
        top = np.full(len(self.offsets) - 1, -1, dtype=np.int64)
        filled = self.offsets[1:] > self.offsets[:-1]
        top[filled] = self.features[self.offsets[1:][filled] - 1]
        return top


def membership(
    layer: LayerLike,
    xy: FloatArray,
    only: BoolArray | None = None,
    slopes: Slopes | None = None,
    nearest: bool = False,
) -> Membership:
    """Decals of a layer at map points xy (n, 2), metres; NaN points are in none.

    only: mask (features,) of the features to look at, all by default. Decals of alpha 0 or width 0 are not drawn.
    slopes: of the points, for strokes with slope correction; without them the ground is level.
    nearest: of strokes, and apart from them of casings, only the one whose centre line is nearest holds a point
        (Thöny et al. 2018). Outlines that are cut by their rings, or drawn each over its fill, stay in order.
    """
    count = len(layer.features.rows)
    finders = [_Finder(layer, decals, xy, slopes, nearest) for decals in decals_of(layer, only)]
    points, places, features, tints = ([np.empty(0, dtype=np.int64)] for _ in range(4))
    palette, first = [np.empty((0, 4))], 0
    cut = list(strips(xy))
    for finder in finders:
        palette.append(finder.palette)
        for strip in cut:
            feature, rank, tint = finder.find(strip, None if slopes is None else slopes[strip.index])
            points.append(strip.index[rank])
            places.append(finder.decals.place[feature])
            features.append(feature)
            tints.append(tint + first)
        first += len(finder.palette)
    point = np.concatenate(points)
    order = np.argsort(point * (2 * count) + np.concatenate(places))
    offsets = np.searchsorted(point[order], np.arange(len(xy) + 1)).astype(np.int64)
    return Membership(
        offsets, np.concatenate(features)[order], np.concatenate(tints)[order], np.concatenate(palette)
    )


class _Finder:
    """The decals of one run made ready to be looked up.

    palette: (m, 4) premultiplied colours; one a feature, then those of bands.
    """

    def __init__(
        self,
        layer: LayerLike,
        decals: FillDecals | StrokeDecals,
        xy: FloatArray,
        slopes: Slopes | None,
        nearest: bool,
    ) -> None:
        self.decals = decals
        self.nearest = nearest and not (
            layer.features.kind == "polygons"
            and (layer.outline_order == "feature" or layer.outline_mode != "normal")
        )
        self.edges: Edges | None = None
        self.strokes: list[StyledStroke] = []
        if isinstance(decals, FillDecals) or decals.side != "normal":
            self.edges = Edges.of(layer.features, decals.drawn).beside(xy)
        if isinstance(decals, FillDecals):
            colors = _straight(decals.fill.colors)
            self.palette = _premultiplied(colors)
            return
        colors = _straight(decals.stroke.colors)
        self.strokes = styled_strokes(layer.features, decals.stroke, decals.half_widths, decals.drawn, slopes)
        palettes, self.bands_at = [colors], [0]
        for stroke in self.strokes:
            self.bands_at.append(sum(len(palette) for palette in palettes))
            palettes.append(_band_colors(stroke.style.bands, colors))
        self.palette = _premultiplied(np.concatenate(palettes))

    def find(self, points: Strip, slopes: Slopes | None) -> tuple[IntArray, IntArray, IntArray]:
        """Pairs that are drawn: feature, rank of the point in the strip, row of the palette."""
        count = len(points.index)
        if isinstance(self.decals, FillDecals):
            assert self.edges is not None
            feature, rank = np.divmod(inside_polygons(self.edges, points), count)
            kept = _hatched(self.decals, feature, np.stack([points.x[rank], points.y[rank]], axis=1))
            return feature[kept], rank[kept], feature[kept]
        keys, tints = [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]
        gauges = [np.empty(0)]
        for stroke, first in zip(self.strokes, self.bands_at[1:], strict=True):
            touches = _touching(self.decals, stroke, points, slopes)
            key, share, gauge = covered_pairs(touches, count)
            keys.append(key)
            gauges.append(gauge)
            feature, bands = key // count, stroke.style.bands
            if bands:
                band = np.searchsorted([band.reach for band in bands], share, side="left")
                tints.append(first + feature * len(bands) + np.minimum(band, len(bands) - 1))
            else:
                tints.append(feature)
        key, tint = np.concatenate(keys), np.concatenate(tints)
        kept = self.palette[tint, 3] > 0.0
        if self.nearest:
            kept &= self._is_nearest(key, np.concatenate(gauges), count)
        if self.edges is not None:
            kept &= np.isin(key, inside_polygons(self.edges, points)) == (self.decals.side == "inset")
        feature, rank = np.divmod(key[kept], count)
        return feature, rank, tint[kept]

    def _is_nearest(self, key: IntArray, gauge: FloatArray, count: int) -> BoolArray:
        """Which pairs have the least gauge at their point; of equal ones that on top."""
        feature, rank = np.divmod(key, count)
        order = np.lexsort((-self.decals.place[feature], gauge, rank))
        first = np.diff(rank[order], prepend=-1) != 0
        chosen = np.zeros(len(key), dtype=np.bool_)
        chosen[order[first]] = True
        return chosen


def _touching(
    decals: StrokeDecals, styled: StyledStroke, points: Strip, slopes: Slopes | None
) -> Iterator[Touch]:
    if not decals.stroke.follows_view:
        return styled.touching(points, slopes)
    if slopes is None or slopes.planes is None:
        raise ValueError("Widths on the screen need the planes that points are seen on; see `slopes_of`.")
    return touching_on_screen(styled, decals, points, slopes.planes)


def covered_pairs(touches: Iterable[Touch], count: int) -> tuple[IntArray, FloatArray, FloatArray]:
    """Of points that strokes cover, ascending: keys feature * count + point, gauge over half width, and gauge."""
    keys, shares, gauges = [np.empty(0, dtype=np.int64)], [np.empty(0)], [np.empty(0)]
    for touch in touches:
        kept = np.flatnonzero(touch.clearance >= 0.0)
        keys.append(touch.feature[kept] * count + touch.point[kept])
        gauges.append(touch.gauge[kept])
        shares.append(touch.gauge[kept] / touch.half_width[kept])
    key, share, gauge = np.concatenate(keys), np.concatenate(shares), np.concatenate(gauges)
    order = np.lexsort((share, key))
    order = order[np.diff(key[order], prepend=-1) != 0]
    return key[order], share[order], gauge[order]


def _hatched(decals: FillDecals, feature: IntArray, xy: FloatArray) -> BoolArray:
    """Which of the pairs (n,) of a feature and a point inside lie on its fill."""
    on = np.ones(len(feature), dtype=np.bool_)
    hatch_of = hatches_of(decals)
    for index, hatch in enumerate(decals.fill.hatches):
        if hatch is not None:
            some = np.flatnonzero(hatch_of[feature] == index)
            on[some] = hatch_clearance(hatch, xy[some]) >= 0.0
    return on


def hatches_of(decals: FillDecals) -> IntArray:
    """Each feature's place (features,) among the hatches."""
    if decals.fill.hatch_of is None:
        return np.zeros(len(decals.drawn), dtype=np.int64)
    return np.asarray(decals.fill.hatch_of, dtype=np.int64)


def _straight(colors: object) -> FloatArray:
    return np.asarray(colors, dtype=np.float64).reshape(-1, 4) / 255


def _premultiplied(colors: FloatArray) -> FloatArray:
    return np.concatenate([colors[:, :3] * colors[:, 3:], colors[:, 3:]], axis=1)


def _band_colors(bands: Sequence[BandLike], own: FloatArray) -> FloatArray:
    """Straight colours (features * bands, 4): those of the bands under the alpha of each feature."""
    colors = np.tile(_straight([band.color for band in bands]), (len(own), 1))
    colors[:, 3] *= np.repeat(own[:, 3], len(bands))
    return colors
