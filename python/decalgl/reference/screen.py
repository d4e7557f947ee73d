"""Widths on the screen: strokes dropped onto the plane of the ground that a point is seen on, and projected.

The screen is a picture of that plane. An offset a on the map from the point, with gradient g and d = (a, g.a), lies

    J a / (1 + k.a)        pixels from the point on the screen

so straight lines stay straight, and distances on the screen are those between points and segments as ever. A point is
inside a stroke whose half width is h pixels when the stroke's centre line comes as near as h.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from .points import candidate_pairs
from .strokes import Bars, Joints, Touch

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .contract import BoolArray, FloatArray, IntArray, LimitsLike, StrokeLike, StyleLike
    from .points import Strip
    from .rays import Viewpoint
    from .strokes import StyledStroke

# Points that are looked up together, and the share of its depth below which an offset is too near to the eye.
GROUP = 128
NEAREST = 1e-3


@dataclass(frozen=True)
class ScreenPlanes:
    """Of points that are seen: J (n, 2, 2), k (n, 2), and pixels (n,) that a metre takes, seen head-on."""

    to_screen: FloatArray
    lean: FloatArray
    pixels_per_metre: FloatArray

    def __getitem__(self, which: IntArray) -> ScreenPlanes:
        return ScreenPlanes(self.to_screen[which], self.lean[which], self.pixels_per_metre[which])

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


def screen_planes(view: Viewpoint, world: FloatArray, gradient: FloatArray) -> ScreenPlanes:
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
    return ScreenPlanes(to_screen, depths[:, :2] + depths[:, 2:] * gradient, per_metre)


def half_widths(stroke: StrokeLike, own: FloatArray, pixels_per_metre: FloatArray) -> FloatArray:
    """Half widths (n,) in pixels of strokes whose own are in their units, where a metre takes so many pixels."""
    pixels = own if stroke.units == "px" else own * pixels_per_metre
    limits: LimitsLike = stroke.limits
    least = np.maximum(limits.least_px, limits.least_metres * pixels_per_metre) / 2
    most = np.minimum(limits.most_px, limits.most_metres * pixels_per_metre) / 2
    limited: FloatArray = np.minimum(np.maximum(pixels, least), most)
    return limited


def touching_on_screen(
    styled: StyledStroke, stroke: StrokeLike, points: Strip, planes: ScreenPlanes, beyond: float = 0.0
) -> Iterator[Touch]:
    """Pairs of pieces and points of a strip no farther than `beyond` pixels from them; lengths in pixels.

    planes: of the strip's points. Pairs that are farther may be among them.
    """
    for pieces, start, end in (
        (styled.bars, styled.bars.start, styled.bars.start + styled.bars.vector),
        (styled.joints, styled.joints.place, styled.joints.place),
    ):
        if not len(start):
            continue
        widest = half_widths(stroke, np.array([pieces.half_width.max()]), planes.pixels_per_metre)
        factor = _reach_factor(pieces, styled.style)
        reach = planes.reach(widest * factor + beyond)
        for piece, point in _pairs(start, end, points, reach):
            some, plane = pieces[piece], planes[point]
            xy = np.stack([points.x[point], points.y[point]], axis=1)
            widths = half_widths(stroke, some.half_width, plane.pixels_per_metre)
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
    nowhere = np.zeros(len(xy), dtype=np.bool_)
    origin = np.zeros_like(xy)
    if isinstance(pieces, Bars):
        start, end, nowhere = _segment(pieces.start - xy, pieces.start + pieces.vector - xy, planes)
        vector = end - start
        short = np.hypot(*vector.T) < 1e-12
        vector[short] = (1e-12, 0.0)
        on_screen: Bars | Joints = Bars(
            start, vector, pieces.arc, pieces.begins, pieces.ends, widths, pieces.feature
        )
    else:
        place, depth = planes.project(pieces.place - xy)
        nowhere = depth < NEAREST
        depth = np.maximum(depth, NEAREST)
        coming, going = (_direction(way, place, depth, planes) for way in (pieces.coming, pieces.going))
        on_screen = Joints(
            place / depth[:, None], coming, going, pieces.arc, pieces.shape, widths, pieces.feature
        )
    with np.errstate(invalid="ignore", divide="ignore"):
        clearance, gauge, _ = on_screen.measure(origin, style, None)
    clearance[nowhere], gauge[nowhere] = -np.inf, np.inf
    return clearance, gauge


def _segment(a: FloatArray, b: FloatArray, planes: ScreenPlanes) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Both ends on the screen, (n, 2), cut off where they come too near to the eye; which are so all along."""
    start, depth_a = planes.project(a)
    end, depth_b = planes.project(b)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip((NEAREST - depth_a) / (depth_b - depth_a), 0.0, 1.0)
    middle = start + np.nan_to_num(share)[:, None] * (end - start)
    near_a, near_b = depth_a < NEAREST, depth_b < NEAREST
    start = np.where(near_a[:, None], middle, start) / np.maximum(depth_a, NEAREST)[:, None]
    end = np.where(near_b[:, None], middle, end) / np.maximum(depth_b, NEAREST)[:, None]
    return start, end, near_a & near_b


def _direction(way: FloatArray, place: FloatArray, depth: FloatArray, planes: ScreenPlanes) -> FloatArray:
    """Unit directions (n, 2) on the screen of ways on the map, at places before the division; zeros stay."""
    on_screen, rise = planes.project(way)
    on_screen = on_screen * depth[:, None] - place * (rise - 1.0)[:, None]
    length = np.hypot(*on_screen.T)
    return on_screen / np.where(length > 0.0, length, 1.0)[:, None]
