"""The ground that one feature covers, as a shapely geometry: fills, hatches, strokes of any style on level ground."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from .decals import FillDecals, StrokeDecals, decals_of
from .fills import Edges, inside_polygons
from .membership import hatches_of
from .points import strips
from .strokes import BEVEL, DISC, LENGTHENED, MITER, ROUNDED, Bars, Joints, StyledStroke, styled_strokes

if TYPE_CHECKING:
    from .contract import BoolArray, FloatArray, HatchLike, LayerLike, PatternLike, StyleLike

# Segments of a quarter circle in joints and caps of lines: area errs by 1e-5 of the disc's.
QUARTER_SEGMENTS = 128


def feature_area(layer: LayerLike, feature: int, origin: FloatArray) -> shapely.Geometry:
    """The ground under all drawn decals of one feature, relative to a map position (2,).

    Raises ValueError for slope correction: there the area differs from triangle to triangle.
    """
    only = np.arange(len(layer.features.rows)) == feature
    areas = []
    for decals in decals_of(layer, only):
        if isinstance(decals, FillDecals):
            area = _even_odd_area(layer, only, origin)
            hatch = decals.fill.hatches[hatches_of(decals)[feature]]
            areas.append(
                area if hatch is None else shapely.intersection(area, _hatch_area(hatch, area, origin))
            )
        else:
            areas.append(_outline_area(layer, decals, only, origin))
    return shapely.union_all(areas)


def _outline_area(
    layer: LayerLike, decals: StrokeDecals, only: BoolArray, origin: FloatArray
) -> shapely.Geometry:
    (stroke,) = styled_strokes(layer.features, decals.stroke, decals.half_widths, only) or (None,)
    area = shapely.Polygon() if stroke is None else stroke_area(stroke, origin)
    if decals.side == "inset":
        return shapely.intersection(area, _even_odd_area(layer, only, origin))
    if decals.side == "offset":
        return shapely.difference(area, _even_odd_area(layer, only, origin))
    return area


def stroke_area(stroke: StyledStroke, origin: FloatArray) -> shapely.Geometry:
    """The union of a stroke's pieces, relative to a map position (2,)."""
    if stroke.style.slope_correction != "none":
        raise ValueError("The area of a stroke with slope correction differs from triangle to triangle.")
    shapes: list[shapely.Geometry] = []
    for i in range(len(stroke.bars.feature)):
        shapes += _bar_shapes(stroke.bars, i, stroke.style, origin)
    for i in range(len(stroke.joints.feature)):
        shapes += _joint_shapes(stroke.joints, i, stroke.style, origin)
    return shapely.union_all(shapes)


def _disc(place: FloatArray, radius: float) -> shapely.Geometry:
    return shapely.buffer(shapely.Point(place), radius, quad_segs=QUARTER_SEGMENTS)


def _bar_shapes(bars: Bars, i: int, style: StyleLike, origin: FloatArray) -> list[shapely.Geometry]:
    start, radius = bars.start[i] - origin, float(bars.half_width[i])
    length = float(np.hypot(*bars.vector[i]))
    along = bars.vector[i] / length
    left = np.array([-along[1], along[0]])
    first = -radius if bars.begins[i] == LENGTHENED else 0.0
    last = length + (radius if bars.ends[i] == LENGTHENED else 0.0)
    shapes: list[shapely.Geometry] = []
    for begin, end, begin_width, end_width in _stretches(style.pattern, float(bars.arc[i]), first, last):
        a, b = start + begin * along, start + end * along
        across = radius * left
        corners = [a - begin_width * across, b - end_width * across, b + end_width * across,
                   a + begin_width * across]  # fmt: skip
        shapes.append(shapely.Polygon(corners))
    if bars.begins[i] == ROUNDED:
        shapes.append(_disc(start, radius))
    if bars.ends[i] == ROUNDED:
        shapes.append(_disc(start + length * along, radius))
    return shapes


def _stretches(
    pattern: PatternLike | None, arc: float, first: float, last: float
) -> list[tuple[float, float, float, float]]:
    """The marks between two places of a bar that begins at `arc`: places of both ends, shares of width there."""
    if pattern is None:
        return [(first, last, 1.0, 1.0)]
    found = []
    shift = arc + pattern.offset
    for mark in pattern.marks:
        rise = (mark.end_width - mark.begin_width) / (mark.end - mark.begin)
        repeats = np.arange(
            np.floor((first + shift) / pattern.period) - 1, np.ceil((last + shift) / pattern.period) + 1
        )
        for at in repeats * pattern.period - shift:
            begin, end = max(first, at + mark.begin), min(last, at + mark.end)
            if begin < end:
                begin_width, end_width = (
                    mark.begin_width + rise * (place - at - mark.begin) for place in (begin, end)
                )
                found.append((begin, end, begin_width, end_width))
    return found


def _share_at(pattern: PatternLike | None, arc: float) -> float:
    """The share of the width that a pattern has at an arc length, 0 in a gap."""
    if pattern is None:
        return 1.0
    u = (arc + pattern.offset) % pattern.period
    shares = [
        mark.begin_width + (u - mark.begin) / (mark.end - mark.begin) * (mark.end_width - mark.begin_width)
        for mark in pattern.marks
        if mark.begin <= u <= mark.end
    ]
    return max(shares, default=0.0)


def _joint_shapes(joints: Joints, i: int, style: StyleLike, origin: FloatArray) -> list[shapely.Geometry]:
    place = joints.place[i] - origin
    radius = float(joints.half_width[i]) * _share_at(style.pattern, float(joints.arc[i]))
    if radius == 0.0:
        return []
    coming, going = joints.coming[i], joints.going[i]
    half_opening = np.hypot(*(coming + going)) / 2
    sharp = half_opening < np.sin(np.radians(style.miter_limit) / 2) or half_opening == 0.0
    if joints.shape[i] == DISC or (joints.shape[i] == MITER and sharp):
        return [_disc(place, radius)]
    if joints.shape[i] not in (MITER, BEVEL):
        return [shapely.box(*(place - radius), *(place + radius))]
    # To the outer side of the turn.
    side = -np.sign(coming[0] * going[1] - coming[1] * going[0])
    if side == 0.0:
        return []
    ends = [place + side * radius * np.array([-way[1], way[0]]) for way in (coming, going)]
    if joints.shape[i] == BEVEL:
        return [shapely.Polygon([place, *ends])]
    turn = coming - going
    tip = place + radius / half_opening * turn / np.hypot(*turn)
    return [shapely.Polygon([place, ends[0], tip, ends[1]])]


def _hatch_area(hatch: HatchLike, area: shapely.Geometry, origin: FloatArray) -> shapely.Geometry:
    """The lines of a hatch over the bounds of an area, both relative to `origin`."""
    if shapely.is_empty(area):
        return area
    x0, y0, x1, y1 = shapely.bounds(area)
    middle, reach = np.array([x0 + x1, y0 + y1]) / 2, np.hypot(x1 - x0, y1 - y0)
    lines = []
    for turn in (0.0, 90.0)[: 2 if hatch.crossed else 1]:
        angle = np.radians(hatch.angle + turn)
        along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        at = float((middle + origin) @ across)
        first, last = np.ceil((at - reach) / hatch.spacing) - 1, np.floor((at + reach) / hatch.spacing) + 1
        for place in np.arange(first, last + 1) * hatch.spacing - at:
            low, high = (middle + (place + side * hatch.width / 2) * across for side in (-1, 1))
            ends = [low - reach * along, low + reach * along, high + reach * along, high - reach * along]
            lines.append(shapely.Polygon(ends))
    return shapely.union_all(lines)


def _even_odd_area(layer: LayerLike, only: BoolArray, origin: FloatArray) -> shapely.Geometry:
    """Even-odd area of rings that may cross, touch, overlap and repeat.

    The rings' lines are cut at their crossings; each face between them lies inside or outside as a
    whole, which one point of it tells.
    """
    edges = Edges.of(layer.features, only)
    ends = np.stack([edges.start - origin, edges.end - origin], axis=1)
    ends = ends[(ends[:, 0] != ends[:, 1]).any(axis=1)]
    faces = shapely.get_parts(
        shapely.polygonize(shapely.get_parts(shapely.union_all(shapely.linestrings(ends))))
    )
    if not len(faces):
        return shapely.Polygon()
    inside = np.zeros(len(faces), dtype=np.bool_)
    for strip in strips(shapely.get_coordinates(shapely.point_on_surface(faces)) + origin):
        inside[strip.index[inside_polygons(edges, strip) % len(strip.index)]] = True
    return shapely.union_all(faces[inside])
