"""Widths on the screen: strokes dropped onto the plane of the ground that a point is seen on, and projected.

The screen is a picture of that plane. An offset a on the map from the point, with gradient g and d = (a, g.a), lies

    J a / (1 + k.a)        pixels from the point on the screen

so straight lines stay straight, and distances on the screen are those between points and segments as ever. A point is
inside a stroke whose half width is h pixels when the stroke's centre line comes as near as h, and when the ground under
the nearest point of that line is seen no farther than max(h, 1) / 2 + 1 / 4 pixels from where the plane has it. That
point is looked for among the places where the line runs beside the point, at corners in the gap between two segments,
and at the line's ends: so it does not matter where straight lines are cut.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely

from .points import candidate_pairs
from .strokes import Bars, Joints, Touch, pattern_clearance

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .contract import BoolArray, FloatArray, IntArray, LimitsLike, PatternLike, StyleLike
    from .decals import StrokeDecals
    from .ground import Ground
    from .points import Strip
    from .rays import Viewpoint
    from .strokes import StyledStroke

# Points that are looked up together, and the share of its depth below which an offset is too near to the eye.
GROUP = 128
NEAREST = 1e-3
# Pixels, beyond half of a half width of at least 1, that the ground under a line may be seen off its plane.
GROUND_SLACK = 0.25


@dataclass(frozen=True)
class ScreenPlanes:
    """Of points that are seen, metres and pixels.

    to_screen: J (n, 2, 2). lean: k (n, 2). pixels_per_metre: (n,) seen head-on. height, gradient: (n,) and (n, 2) of
    the planes. up, lean_up: (n, 2) and (n,), what J and k are for a metre upwards. ground: of the scene.
    """

    to_screen: FloatArray
    lean: FloatArray
    pixels_per_metre: FloatArray
    height: FloatArray
    gradient: FloatArray
    up: FloatArray
    lean_up: FloatArray
    ground: Ground

    def __getitem__(self, which: IntArray) -> ScreenPlanes:
        arrays = {name: value if name == "ground" else value[which] for name, value in vars(self).items()}
        return ScreenPlanes(**arrays)

    def reach(self, pixels: FloatArray) -> FloatArray:
        """Metres (n, 2) along x and y on the map that lie no farther than so many pixels (n,) away."""
        with np.errstate(all="ignore"):
            determinant = np.linalg.det(self.to_screen)
            across = np.stack([self.to_screen[:, 1, 1], self.to_screen[:, 0, 1]], axis=-1)
            along = np.stack([self.to_screen[:, 1, 0], self.to_screen[:, 0, 0]], axis=-1)
            ellipse = (
                np.stack([np.hypot(*across.T), np.hypot(*along.T)], axis=1) / np.abs(determinant)[:, None]
            )
            reach = pixels[:, None] * ellipse
            # With the depth, 1 + k.a, an ellipse grows away from the eye: |a| <= reach * (1 + |k| |a|).
            left = 1.0 - (np.abs(self.lean) * reach).sum(axis=1)
            reach = np.where(left[:, None] > 0.0, reach / left[:, None], np.inf)
        reach[np.isnan(reach)] = np.inf
        return reach

    def project(self, offset: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Pixels (n, 2) before the division by the depth, and the depth (n,), of offsets on the map."""
        return np.einsum("nij,nj->ni", self.to_screen, offset), 1.0 + (self.lean * offset).sum(axis=1)

    def is_on_ground(
        self, xy: FloatArray, foot: FloatArray, on_screen: FloatArray, widths: FloatArray
    ) -> BoolArray:
        """Whether the ground at places of the map is seen near where the planes have them.

        foot, on_screen: (n, 2) there. xy: (n, 2) the points. widths: (n,) pixels, half of strokes. Holes are on it.
        """
        offset = foot - xy
        rise = self.ground(foot) - self.height - (self.gradient * offset).sum(axis=1)
        flat, depth = self.project(offset)
        depth = np.maximum(depth + rise * self.lean_up, NEAREST)
        seen = (flat + rise[:, None] * self.up) / depth[:, None]
        is_near: BoolArray = ~(np.hypot(*(seen - on_screen).T) > np.maximum(widths, 1.0) / 2 + GROUND_SLACK)
        return is_near

    def pattern_scale(self, pattern: PatternLike) -> FloatArray:
        """What a metre on the map counts (n,) in the lengths of a pattern."""
        if pattern.units == "m":
            return np.ones(len(self.pixels_per_metre))
        octave: FloatArray = np.exp2(np.floor(np.log2(self.pixels_per_metre) + 0.5))
        return octave


def screen_planes(view: Viewpoint, world: FloatArray, gradient: FloatArray, ground: Ground) -> ScreenPlanes:
    """The planes with gradients (n, 2) through scene points (n, 3)."""
    if view.orthographic:
        steps = np.stack([view.origin_x, view.origin_y, view.direction], axis=1)
    else:
        steps = np.stack([view.direction_x, view.direction_y, view.direction], axis=1)
    across, down, ahead = np.linalg.inv(steps)
    count = len(world)
    if view.orthographic:
        rows = np.broadcast_to(np.stack([across, down]), (count, 2, 3))
        depths = np.zeros((count, 3))
        per_metre = np.full(count, 1.0 / float(np.linalg.norm(view.origin_x)))
    else:
        offset = world - view.origin
        depth = offset @ ahead
        place = np.stack([offset @ across, offset @ down], axis=1) / depth[:, None]
        depths = ahead / depth[:, None]
        rows = np.stack([across, down])[None] / depth[:, None, None] - place[:, :, None] * depths[:, None, :]
        per_metre = 1.0 / (float(np.linalg.norm(view.direction_x)) * depth)
    to_screen = rows[:, :, :2] + rows[:, :, 2:] * gradient[:, None, :]
    return ScreenPlanes(
        to_screen,
        depths[:, :2] + depths[:, 2:] * gradient,
        per_metre,
        world[:, 2],
        gradient,
        rows[:, :, 2],
        depths[:, 2],
        ground,
    )


class _Widths:
    """Half widths of a run's strokes in pixels, where a metre takes so many of them."""

    def __init__(self, decals: StrokeDecals) -> None:
        self.limits: LimitsLike = decals.stroke.limits
        self.in_pixels = decals.stroke.units == "px"
        # Of a stroke that is cut, half is the whole width.
        self.share = 0.5 if decals.side == "normal" else 1.0
        widths, margins = decals.stroke.widths, decals.stroke.margins
        self.margins = np.zeros(len(widths)) if margins is None else np.asarray(margins, dtype=np.float64)
        self.own = np.asarray(widths, dtype=np.float64) - self.margins

    def of(self, feature: IntArray, pixels_per_metre: FloatArray) -> FloatArray:
        """Of features (n,) at points (n,)."""
        return self._limited(self.own[feature], self.margins[feature], pixels_per_metre)

    def widest(self, feature: IntArray, pixels_per_metre: FloatArray) -> FloatArray:
        """Of no feature of some (m,) more than this (n,)."""
        return self._limited(self.own[feature].max(), self.margins[feature].max(), pixels_per_metre)

    def _limited(self, own: Any, margin: Any, pixels_per_metre: FloatArray) -> FloatArray:
        unit = 1.0 if self.in_pixels else pixels_per_metre
        limits = self.limits
        least = np.maximum(limits.least_px, limits.least_metres * pixels_per_metre)
        most = np.minimum(limits.most_px, limits.most_metres * pixels_per_metre)
        limited: FloatArray = self.share * (np.minimum(np.maximum(own * unit, least), most) + margin * unit)
        return limited


def touching_on_screen(
    styled: StyledStroke, decals: StrokeDecals, points: Strip, planes: ScreenPlanes, beyond: float = 0.0
) -> Iterator[Touch]:
    """Pairs of pieces and points of a strip no farther than `beyond` pixels from them; lengths in pixels.

    planes: of the strip's points. Pairs that are farther may be among them.
    """
    every_width = _Widths(decals)
    for pieces, start, end in (
        (styled.bars, styled.bars.start, styled.bars.start + styled.bars.vector),
        (styled.joints, styled.joints.place, styled.joints.place),
    ):
        if not len(start):
            continue
        widest = every_width.widest(pieces.feature, planes.pixels_per_metre)
        factor = _reach_factor(pieces, styled.style)
        reach = planes.reach(widest * factor + beyond)
        for piece, point in _pairs(start, end, points, reach):
            some, plane = pieces[piece], planes[point]
            xy = np.stack([points.x[point], points.y[point]], axis=1)
            widths = every_width.of(some.feature, plane.pixels_per_metre)
            clearance, gauge = _measure(some, xy, plane, widths, styled.style)
            yield Touch(some.feature, point, clearance, gauge, widths)


def _reach_factor(pieces: Bars | Joints, style: StyleLike) -> float:
    if isinstance(pieces, Bars) or style.corner != "miter":
        return float(np.sqrt(2.0))
    return float(max(1.0 / np.sin(np.radians(max(style.miter_limit, 1e-3)) / 2), np.sqrt(2.0)))


def _pairs(
    start: FloatArray, end: FloatArray, points: Strip, reach: FloatArray
) -> Iterator[tuple[IntArray, IntArray]]:
    """Pieces and points whose boxes touch."""
    count = len(points.x)
    first = np.arange(0, count, GROUP)
    far = 1e12  # infinite boxes have no place in a tree

    def side(reduce: np.ufunc, values: FloatArray) -> FloatArray:
        return np.clip(reduce.reduceat(values, first), -far, far)

    groups = shapely.box(
        side(np.minimum, points.x - reach[:, 0]),
        side(np.minimum, points.y - reach[:, 1]),
        side(np.maximum, points.x + reach[:, 0]),
        side(np.maximum, points.y + reach[:, 1]),
    )
    low, high = np.minimum(start, end), np.maximum(start, end)
    tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    group, piece = tree.query(groups)
    order = np.lexsort((piece, group))
    group, piece = group[order], piece[order]
    ends = np.minimum(first + GROUP, count)
    for owner, point in candidate_pairs(first[group], ends[group]):
        one = piece[owner]
        near = (low[one, 0] <= points.x[point] + reach[point, 0]) & (
            high[one, 0] >= points.x[point] - reach[point, 0]
        )
        near &= (low[one, 1] <= points.y[point] + reach[point, 1]) & (
            high[one, 1] >= points.y[point] - reach[point, 1]
        )
        yield one[near], point[near]


def _measure(
    pieces: Bars | Joints, xy: FloatArray, planes: ScreenPlanes, widths: FloatArray, style: StyleLike
) -> tuple[FloatArray, FloatArray]:
    """Clearance and gauge (n,) in pixels of points (n, 2), one a piece."""
    if isinstance(pieces, Bars):
        clearance, gauge, arc, foot, on_screen, nowhere = _measure_bars(pieces, xy, planes, widths, style)
    else:
        clearance, gauge, arc, foot, on_screen, nowhere = _measure_joints(pieces, xy, planes, widths, style)
    if style.pattern is not None:
        along = arc * planes.pattern_scale(style.pattern)
        covered = pattern_clearance(style.pattern, along, gauge, widths, along=isinstance(pieces, Bars))
        clearance = np.minimum(clearance, covered)
    nowhere |= ~planes.is_on_ground(xy, foot, on_screen, widths)
    clearance[nowhere], gauge[nowhere] = -np.inf, np.inf
    return clearance, gauge


class _Solid:
    """A style without its pattern."""

    pattern = None

    def __init__(self, style: StyleLike) -> None:
        self.corner, self.cap, self.bands = style.corner, style.cap, style.bands
        self.miter_limit, self.slope_correction = style.miter_limit, style.slope_correction


class _Measured(NamedTuple):
    """Of pairs, without patterns. arc: (n,) metres along the line. nowhere: (n,) those that are not seen.

    foot, on_screen: (n, 2) the nearest point of the centre line on the map and on the screen.
    """

    clearance: FloatArray
    gauge: FloatArray
    arc: FloatArray
    foot: FloatArray
    on_screen: FloatArray
    nowhere: BoolArray


def _measure_bars(
    bars: Bars, xy: FloatArray, planes: ScreenPlanes, widths: FloatArray, style: StyleLike
) -> _Measured:
    seen = _segment(bars.start - xy, bars.start + bars.vector - xy, planes)
    vector = seen.end - seen.start
    short = np.hypot(*vector.T) < 1e-12
    vector[short] = (1e-12, 0.0)
    on_screen = Bars(seen.start, vector, bars.arc, bars.begins, bars.ends, widths, bars.feature)
    with np.errstate(invalid="ignore", divide="ignore"):
        clearance, gauge, _ = on_screen.measure(np.zeros_like(xy), _Solid(style), None)
        share = -(seen.start * vector).sum(axis=1) / (vector * vector).sum(axis=1)
        arc = bars.arc + seen.on_map(share) * np.hypot(*bars.vector.T)
    nearest = np.clip(share, 0.0, 1.0)
    foot = bars.start + seen.on_map(nearest)[:, None] * bars.vector
    return _Measured(clearance, gauge, arc, foot, seen.start + nearest[:, None] * vector, seen.nowhere.copy())


def _measure_joints(
    joints: Joints, xy: FloatArray, planes: ScreenPlanes, widths: FloatArray, style: StyleLike
) -> _Measured:
    place, depth = planes.project(joints.place - xy)
    nowhere = depth < NEAREST
    depth = np.maximum(depth, NEAREST)
    coming, going = (_direction(way, place, depth, planes) for way in (joints.coming, joints.going))
    place = place / depth[:, None]
    on_screen = Joints(place, coming, going, joints.arc, joints.shape, widths, joints.feature)
    with np.errstate(invalid="ignore", divide="ignore"):
        clearance, gauge, _ = on_screen.measure(np.zeros_like(xy), _Solid(style), None)
    # Joints fill the gap between bars alone: marks end flat, and beside a bar its own ground counts.
    gap = np.minimum(-(place * coming).sum(axis=1), (place * going).sum(axis=1))
    clearance = np.minimum(clearance, gap)
    return _Measured(clearance, gauge, joints.arc, joints.place, place, nowhere)


class _Seen(NamedTuple):
    """Segments on the screen: start and end (n, 2), cut off where they come too near to the eye.

    depths, shares: (n, 2) there, the latter of the way on the map. nowhere: (n,) those that are cut off all along.
    """

    start: FloatArray
    end: FloatArray
    depths: FloatArray
    shares: FloatArray
    nowhere: BoolArray

    def on_map(self, share: FloatArray) -> FloatArray:
        """The share (n,) of the way on the map where it is so much of that on the screen."""
        near, far = self.depths.T
        depth = np.maximum(far + share * (near - far), 1e-6 * far)
        first, last = self.shares.T
        shares: FloatArray = first + (last - first) * share * near / depth
        return shares


def _segment(a: FloatArray, b: FloatArray, planes: ScreenPlanes) -> _Seen:
    """Segments between offsets (n, 2) from the planes' points."""
    start, depth_a = planes.project(a)
    end, depth_b = planes.project(b)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.nan_to_num(np.clip((NEAREST - depth_a) / (depth_b - depth_a), 0.0, 1.0))
    middle = start + share[:, None] * (end - start)
    near_a, near_b = depth_a < NEAREST, depth_b < NEAREST
    depths = np.maximum(np.stack([depth_a, depth_b], axis=1), NEAREST)
    shares = np.stack([np.where(near_a, share, 0.0), np.where(near_b, share, 1.0)], axis=1)
    start = np.where(near_a[:, None], middle, start) / depths[:, :1]
    end = np.where(near_b[:, None], middle, end) / depths[:, 1:]
    return _Seen(start, end, depths, shares, near_a & near_b)


def _direction(way: FloatArray, place: FloatArray, depth: FloatArray, planes: ScreenPlanes) -> FloatArray:
    """Unit directions (n, 2) on the screen of ways on the map, at places before the division; zeros stay."""
    on_screen, rise = planes.project(way)
    on_screen = on_screen * depth[:, None] - place * (rise - 1.0)[:, None]
    length = np.hypot(*on_screen.T)
    return on_screen / np.where(length > 0.0, length, 1.0)[:, None]
