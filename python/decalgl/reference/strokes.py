"""Strokes: which points they cover, and how far points are from their borders, in float64.

A stroke is the union of its pieces. Each piece is a shape around a gauge: the half width at which it would
reach a point.

    bar     along a segment: |across|; beyond an end that is round, the distance to it
    joint   at a vertex: a disc, a mitred or bevelled corner, a square dot

The clearance of a point in a piece is a lower bound of the distance to the piece's border: 0 or more inside, less
than 0 outside. Points are paired with the pieces near them and tested pair by pair.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .chains import Chains
from .ground_lengths import GroundLengths
from .points import Strip, candidate_pairs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .contract import BoolArray, FeaturesLike, FloatArray, IntArray, PatternLike, StrokeLike, StyleLike
    from .ground import Ground
    from .screen import ScreenPlanes

# How a bar ends.
FLAT, ROUNDED, LENGTHENED = 0, 1, 2
# What a joint is.
DISC, MITER, BEVEL, SQUARE = 0, 1, 2, 3


@dataclass(frozen=True)
class Slopes:
    """What slope correction and widths on the screen need.

    gradient: (n, 2) of the ground at points. forward: the camera's unit view direction (3,). planes: of the points, on
    the screen; None where no stroke's width follows the view. ground: what patterns of strokes with the correction
    "tangent" lie on; None for level ground.
    """

    gradient: FloatArray
    forward: FloatArray
    planes: ScreenPlanes | None = None
    ground: Ground | None = None

    def __getitem__(self, which: IntArray) -> Slopes:
        planes = None if self.planes is None else self.planes[which]
        return Slopes(self.gradient[which], self.forward, planes, self.ground)


class Touch(NamedTuple):
    """Pairs of a point and a piece: feature, rank of the point in its strip, clearance, gauge, half width there."""

    feature: IntArray
    point: IntArray
    clearance: FloatArray
    gauge: FloatArray
    half_width: FloatArray


@dataclass(frozen=True)
class Bars:
    """Segments: start and vector (n, 2), arc (n,) of the start, how they begin and end (n,).

    place: (n,) of the segments in `lengths`, which tells lengths along the ground; None for those on the map.
    """

    start: FloatArray
    vector: FloatArray
    arc: FloatArray
    begins: IntArray
    ends: IntArray
    half_width: FloatArray
    feature: IntArray
    place: IntArray | None = None
    lengths: GroundLengths | None = None

    def __getitem__(self, which: IntArray) -> Bars:
        start, vector, arc = self.start[which], self.vector[which], self.arc[which]
        begins, ends, half_width = self.begins[which], self.ends[which], self.half_width[which]
        place = None if self.place is None else self.place[which]
        return Bars(start, vector, arc, begins, ends, half_width, self.feature[which], place, self.lengths)

    def reach(self, style: StyleLike) -> FloatArray:
        """How far (n,) from its segment a bar covers anything."""
        return self.half_width * (np.sqrt(2.0) if style.cap == "square" else 1.0)

    def measure(self, xy: FloatArray, style: StyleLike, slopes: Slopes | None) -> tuple[FloatArray, ...]:
        """Clearance, gauge and half width (n,) of points (n, 2), one a bar."""
        to_ground, half_width = _correction(style, slopes, self.half_width)
        offset, vector = to_ground(xy - self.start), to_ground(self.vector)
        length = np.hypot(*vector.T)
        direction = vector / length[:, None]
        t, s = _dot(offset, direction), np.abs(_cross(direction, offset))
        before, after = -t, t - length
        before -= half_width * (self.begins == LENGTHENED)
        after -= half_width * (self.ends == LENGTHENED)
        over = np.where(self.begins == ROUNDED, np.maximum(before, 0.0), 0.0)
        over += np.where(self.ends == ROUNDED, np.maximum(after, 0.0), 0.0)
        gauge = np.hypot(over, s)
        inside = np.full(len(xy), np.inf)
        np.minimum(inside, -before, out=inside, where=self.begins != ROUNDED)
        np.minimum(inside, -after, out=inside, where=self.ends != ROUNDED)
        if style.pattern is None:
            return np.minimum(inside, half_width - gauge), gauge, half_width
        covered = pattern_clearance(style.pattern, self.arc_at(t / length), gauge, half_width, along=True)
        return np.minimum(inside, covered), gauge, half_width

    def arc_at(self, share: FloatArray) -> FloatArray:
        """Metres (n,) along the line at shares of the segments' ways."""
        if self.lengths is None or self.place is None:
            on_map: FloatArray = self.arc + share * np.hypot(*self.vector.T)
            return on_map
        return self.arc + self.lengths.at(self.place, share)


@dataclass(frozen=True)
class Joints:
    """Corners, caps and dots: place, and unit directions coming and going, (n, 2); arc and shape (n,)."""

    place: FloatArray
    coming: FloatArray
    going: FloatArray
    arc: FloatArray
    shape: IntArray
    half_width: FloatArray
    feature: IntArray

    def __getitem__(self, which: IntArray) -> Joints:
        return Joints(*(getattr(self, name)[which] for name in self.__dataclass_fields__))

    def reach(self, style: StyleLike) -> FloatArray:
        """How far (n,) from its place a joint covers anything."""
        # A mitre ends at 1 / sin(angle / 2); on a slope the angle is another, but not below the limit.
        sharpest = np.hypot(*(self.coming + self.going).T) / 2 if style.slope_correction != "tangent" else 0.0
        limit = np.maximum(np.sin(np.radians(style.miter_limit) / 2), sharpest)
        with np.errstate(divide="ignore"):
            factor = np.where(self.shape == MITER, 1.0 / limit, np.sqrt(2.0))
        reach: FloatArray = self.half_width * np.maximum(factor, np.sqrt(2.0))
        return reach

    def measure(self, xy: FloatArray, style: StyleLike, slopes: Slopes | None) -> tuple[FloatArray, ...]:
        """Clearance, gauge and half width (n,) of points (n, 2), one a joint."""
        to_ground, half_width = _correction(style, slopes, self.half_width)
        offset = to_ground(xy - self.place)
        gauge = np.hypot(*offset.T)
        square = self.shape == SQUARE
        gauge[square] = np.abs(offset[square]).max(axis=1)
        inside = np.full(len(xy), np.inf)
        at = np.flatnonzero((self.shape == MITER) | (self.shape == BEVEL))
        coming, going = _unit(to_ground(self.coming)[at]), _unit(to_ground(self.going)[at])
        wedge, across, steepness = _corner(offset[at], coming, going, self.shape[at] == BEVEL)
        # |d1 + d2| / 2 is the sine of half the angle between the segments.
        opening = np.hypot(*(coming + going).T) / 2
        sharp = (self.shape[at] == MITER) & (
            (opening < np.sin(np.radians(style.miter_limit) / 2)) | (opening == 0.0)
        )
        inside[at[~sharp]], gauge[at[~sharp]] = wedge[~sharp], across[~sharp]
        if style.pattern is None:
            covered = half_width - gauge
        else:
            covered = pattern_clearance(style.pattern, self.arc, gauge, half_width, along=False)
        covered[at[~sharp]] /= steepness[~sharp]
        return np.minimum(inside, covered), gauge, half_width


def _corner(
    offset: FloatArray, coming: FloatArray, going: FloatArray, bevel: BoolArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of points in the wedge between two bars' ends, all (n,).

    Clearance from the wedge's sides, the gauge of the corner, and how fast that grows with distance.
    """
    wedge = np.minimum(_dot(offset, coming), -_dot(offset, going))
    gauge = np.maximum(np.abs(_cross(coming, offset)), np.abs(_cross(going, offset)))
    cosine = np.hypot(*(coming + going).T) / 2
    turn = coming - going
    with np.errstate(divide="ignore", invalid="ignore"):
        outwards = _dot(offset, turn) / np.hypot(*turn.T) / cosine
        cut = bevel & (outwards > gauge)
        steepness = np.where(cut, 1.0 / cosine, 1.0)
    gauge[cut] = outwards[cut]
    nothing = bevel & ~np.isfinite(outwards)
    wedge[nothing], gauge[nothing], steepness[nothing] = -np.inf, np.inf, 1.0
    return wedge, gauge, steepness


def pattern_clearance(
    pattern: PatternLike, arc: FloatArray, gauge: FloatArray, half_width: FloatArray, along: bool
) -> FloatArray:
    """Clearance (n,) of points in the marks of a pattern, 0 or more where one of them covers.

    along: whether arc length changes from point to point.
    """
    best = np.full(len(arc), -np.inf)
    for mark in pattern.marks:
        half = (mark.end - mark.begin) / 2
        rise = (mark.end_width - mark.begin_width) / (2 * half)
        place = arc + pattern.offset - (mark.begin + mark.end) / 2
        place -= pattern.period * np.round(place / pattern.period)
        # The nearest mark covers; the one on the other side may have the nearer border.
        for there in (place, place - np.copysign(pattern.period, place)):
            width = half_width * (mark.begin_width + rise * (np.clip(there, -half, half) + half))
            across = (width - gauge) / np.hypot(1.0, half_width * rise * along)
            np.maximum(best, np.minimum(half - np.abs(there), across), out=best)
    return best


class StyledStroke:
    """The pieces of those features' strokes that share a style."""

    def __init__(self, style: StyleLike, bars: Bars, joints: Joints) -> None:
        self.style = style
        self.bars = bars
        self.joints = joints

    def touching(self, points: Strip, slopes: Slopes | None, beyond: float = 0.0) -> Iterator[Touch]:
        """Pairs of pieces and points of a strip that are no farther than `beyond` metres from them.

        slopes: of the strip's points. Pairs that are farther may be among them.
        """
        if self.style.slope_correction == "none":
            slopes = None
        for pieces, start, end in (
            (self.bars, self.bars.start, self.bars.start + self.bars.vector),
            (self.joints, self.joints.place, self.joints.place),
        ):
            reach = (pieces.reach(self.style) + beyond) * (1 + 1e-9)
            near, first, last = _neighbours(start, end, reach, points)
            left = np.minimum(start[near, 0], end[near, 0]) - reach[near]
            right = np.maximum(start[near, 0], end[near, 0]) + reach[near]
            for owner, point in candidate_pairs(first, last):
                x = points.x[point]
                beside = np.flatnonzero((x >= left[owner]) & (x <= right[owner]))
                owner, point = owner[beside], point[beside]
                some = pieces[near[owner]]
                xy = np.stack([points.x[point], points.y[point]], axis=1)
                there = None if slopes is None else slopes[point]
                clearance, gauge, half_width = some.measure(xy, self.style, there)
                yield Touch(some.feature, point, clearance, gauge, half_width)


def _neighbours(
    start: FloatArray, end: FloatArray, reach: FloatArray, points: Strip
) -> tuple[IntArray, IntArray, IntArray]:
    """Segments that come near a strip, and the first and last + 1 of its points in their range of y."""
    left, right = points.x.min() - reach, points.x.max() + reach
    low_x, high_x = np.minimum(start[:, 0], end[:, 0]), np.maximum(start[:, 0], end[:, 0])
    near = np.flatnonzero((low_x <= right) & (high_x >= left))
    start, end, reach, left, right = start[near], end[near], reach[near], left[near], right[near]
    # Of a long slanting segment only the stretch beside the strip matters.
    across = end[:, 0] - start[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.stack([left - start[:, 0], right - start[:, 0]]) / across
    at = np.where(across != 0.0, np.clip(at, 0.0, 1.0), [[0.0], [1.0]])
    y = start[:, 1] + at * (end[:, 1] - start[:, 1])
    first = np.searchsorted(points.y, y.min(axis=0) - reach, side="left")
    last = np.searchsorted(points.y, y.max(axis=0) + reach, side="right")
    return near, first, last


def styled_strokes(
    features: FeaturesLike,
    stroke: StrokeLike,
    half_widths: FloatArray,
    drawn: BoolArray,
    slopes: Slopes | None = None,
) -> list[StyledStroke]:
    """The strokes of the drawn features, mask (features,), by style.

    half_widths: (features,) in metres. slopes: of any points of the scene, for the ground.
    """
    ground = None if slopes is None else slopes.ground
    style_of = np.zeros(len(drawn), dtype=np.int64) if stroke.style_of is None else stroke.style_of
    found = []
    for index, style in enumerate(stroke.styles):
        wanted = drawn & (style_of == index)
        if wanted.any():
            along = ground if style.slope_correction == "tangent" and style.pattern is not None else None
            bars, joints = _pieces(
                Chains.of(features, wanted), style, half_widths, stroke.follows_view, along
            )
            found.append(StyledStroke(style, bars, joints))
    return found


def _pieces(
    chains: Chains, style: StyleLike, half_widths: FloatArray, on_screen: bool, ground: Ground | None
) -> tuple[Bars, Joints]:
    """The pieces of strokes of one style. ground: what lengths are measured along; None for the map."""
    following = chains.following()
    vector = chains.vertices[following] - chains.vertices
    length = np.hypot(*vector.T)
    lengths = None if ground is None else GroundLengths(ground, chains.vertices, vector)
    steps = length if lengths is None else lengths.total
    walked = np.cumsum(steps) - steps
    arc = walked - walked[chains.first[chains.chain]]
    feature = chains.feature[chains.chain]
    half_width = half_widths[feature]
    begins, ends = chains.is_end()
    dot = begins & ends
    # A bar with a round end is a disc's other half too, unless it is flat and near at the other end, or has a pattern:
    # then the disc is a piece of its own, which covers by the vertex's place in the pattern. So are corners on the
    # screen, which ask for the ground under the vertex.
    apart = on_screen or style.pattern is not None
    joined = ROUNDED if style.corner == "round" and not apart else FLAT
    capped = {"round": ROUNDED if style.pattern is None else FLAT, "butt": FLAT, "square": LENGTHENED}[
        style.cap
    ]
    one = np.flatnonzero(~ends)
    bars = Bars(
        chains.vertices[one],
        vector[one],
        arc[one],
        np.where(begins[one], capped, joined),
        np.where(ends[following[one]], capped, joined),
        half_width[one],
        feature[one],
        one,
        lengths,
    )
    with np.errstate(invalid="ignore"):
        going = vector / length[:, None]
    coming = np.zeros_like(going)
    coming[following[one]] = going[one]
    shape = np.full(len(arc), -1)
    inner = ~begins & ~ends
    if style.corner != "round":
        shape[inner] = MITER if style.corner == "miter" else BEVEL
    elif apart or style.cap == "butt":
        shape[inner] = DISC
    if style.cap == "round":
        shape[dot if style.pattern is None and style.corner == "round" else begins | ends] = DISC
    elif style.cap == "square":
        shape[dot] = SQUARE
    some = np.flatnonzero(shape >= 0)
    joints = Joints(
        chains.vertices[some],
        coming[some],
        np.nan_to_num(going[some]),
        arc[some],
        shape[some],
        half_width[some],
        feature[some],
    )
    return bars, joints


class _ToGround:
    """Carries vectors (n, 2) of the map into the tangent planes of the ground, turned level."""

    def __init__(self, gradient: FloatArray | None) -> None:
        self.gradient = gradient
        if gradient is not None:
            square = _dot(gradient, gradient)
            # (sqrt(1 + g.g) - 1) / g.g, without the loss of digits on level ground.
            self.factor = 1.0 / (np.sqrt(1.0 + square) + 1.0)

    def __call__(self, vector: FloatArray) -> FloatArray:
        if self.gradient is None:
            return vector
        return vector + (self.factor * _dot(self.gradient, vector))[:, None] * self.gradient


def _correction(
    style: StyleLike, slopes: Slopes | None, half_width: FloatArray
) -> tuple[_ToGround, FloatArray]:
    """How vectors are measured at points on slopes, and the half widths (n,) there."""
    if slopes is None or style.slope_correction == "none":
        return _ToGround(None), half_width
    if style.slope_correction == "tangent":
        return _ToGround(slopes.gradient), half_width
    upright = 1.0 / np.sqrt(1.0 + _dot(slopes.gradient, slopes.gradient))
    down = float(np.clip(-slopes.forward[2], 0.0, 1.0))
    return _ToGround(None), half_width * (upright + down * (1.0 - upright))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]
    return product


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product


def _unit(a: FloatArray) -> FloatArray:
    unit: FloatArray = a / np.hypot(*a.T)[:, None]
    return unit
