"""Distance on the map to the nearest border of any decal: how sure an id and a colour at a point are.

Fills have exact distances. Those of strokes are exact for round corners and caps, else lower bounds: a seam between
two pieces of a stroke may count as a border too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from .decals import FillDecals, StrokeDecals, decals_of
from .fills import Edges, hatch_clearance, inside_polygons
from .membership import hatches_of
from .points import strips
from .screen import touching_on_screen
from .strokes import Slopes, StyledStroke, styled_strokes

if TYPE_CHECKING:
    from .contract import FloatArray, IntArray, LayerLike, SceneLike
    from .points import Strip
    from .strokes import Touch

# Points whose neighbourhood is searched at once.
CHUNK = 100_000
# The first search reaches this share of everything's extent, and each further one some times farther.
FIRST_REACH, GROWTH = 1e-3, 8.0
# Pixels within which borders of widths on the screen are looked for.
SCREEN_LIMIT = 2.0


def edge_distance(
    scene: SceneLike, xy: FloatArray, limit: float = np.inf, slopes: Slopes | None = None
) -> FloatArray:
    """Distance (n,) in metres from map points (n, 2) to the nearest border of a decal that is drawn.

    A border is a ring's edge, that of a stroke, a dash, a band or a hatch's line. Points farther than `limit` from all,
    NaN points, and points of a scene without features get inf. slopes: of the points, as in `membership`.
    """
    xy = np.asarray(xy, dtype=np.float64).reshape(-1, 2)
    nearest = np.full(len(xy), np.inf)
    places = np.flatnonzero(np.isfinite(xy).all(axis=1))
    for layer in scene.layers:
        for decals in decals_of(layer):
            if isinstance(decals, FillDecals) or decals.side != "normal":
                _lower(nearest, places, _ring_distance(layer, decals, xy[places]))
            if isinstance(decals, FillDecals):
                _lower(nearest, places, _hatch_distance(layer, decals, xy[places]))
            else:
                there = None if slopes is None else slopes[places]
                _lower(nearest, places, _stroke_distance(layer, decals, xy[places], there, limit))
    nearest[nearest > limit] = np.inf
    return nearest


def _lower(nearest: FloatArray, places: IntArray, distance: FloatArray) -> None:
    nearest[places] = np.minimum(nearest[places], distance)


def _ring_distance(layer: LayerLike, decals: FillDecals | StrokeDecals, xy: FloatArray) -> FloatArray:
    """Distance (n,) to the nearest edge of a ring of the decals' features."""
    edges = Edges.of(layer.features, decals.drawn)
    nearest = np.full(len(xy), np.inf)
    if not len(edges.feature):
        return nearest
    tree = shapely.STRtree(np.asarray(shapely.linestrings(np.stack([edges.start, edges.end], axis=1))))
    for start in range(0, len(xy), CHUNK):
        points = shapely.points(xy[start : start + CHUNK])
        _, distance = tree.query_nearest(points, return_distance=True, all_matches=False)
        nearest[start : start + CHUNK] = distance
    return nearest


def _hatch_distance(layer: LayerLike, decals: FillDecals, xy: FloatArray) -> FloatArray:
    """Distance (n,) to the nearest border of a hatch's line, of the features that hold each point."""
    nearest = np.full(len(xy), np.inf)
    hatch_of = hatches_of(decals)
    for index, hatch in enumerate(decals.fill.hatches):
        drawn = decals.drawn & (hatch_of == index)
        if hatch is None or not drawn.any():
            continue
        edges = Edges.of(layer.features, drawn).beside(xy)
        for strip in strips(xy):
            inside = strip.index[inside_polygons(edges, strip) % len(strip.index)]
            nearest[inside] = np.minimum(nearest[inside], np.abs(hatch_clearance(hatch, xy[inside])))
    return nearest


def _stroke_distance(
    layer: LayerLike, decals: StrokeDecals, xy: FloatArray, slopes: Slopes | None, limit: float
) -> FloatArray:
    """Distance (n,) to the nearest border of a stroke, looked for farther and farther away."""
    strokes = styled_strokes(layer.features, decals.stroke, decals.half_widths, decals.drawn, slopes)
    nearest = np.full(len(xy), np.inf)
    if decals.stroke.follows_view:
        for strip in strips(xy):
            for stroke in strokes:
                there = None if slopes is None else slopes[strip.index]
                distance = _screen_borders(decals, stroke, strip, there)
                nearest[strip.index] = np.minimum(nearest[strip.index], distance)
        return nearest
    everything = np.concatenate([np.asarray(layer.features.coords, dtype=np.float64).reshape(-1, 2), xy])
    extent = float(np.hypot(*np.ptp(everything, axis=0))) + float(decals.half_widths.max())
    reach, left = FIRST_REACH * extent, np.arange(len(xy))
    while len(left):
        reach = min(reach, limit)
        for strip in strips(xy[left]):
            index = left[strip.index]
            for stroke in strokes:
                there = None if slopes is None else slopes[index]
                distance = _borders(stroke, strip, there, reach)
                nearest[index] = np.minimum(nearest[index], distance)
        # What is found within reach is the nearest; what is found beyond it may not be.
        left = left[nearest[left] > reach]
        if reach >= min(limit, 2.0 * extent):
            break
        nearest[left] = np.inf
        reach *= GROWTH
    return nearest


def _borders(stroke: StyledStroke, points: Strip, slopes: Slopes | None, reach: float) -> FloatArray:
    """Distance (n,) of a strip's points to the nearest border of a stroke, right where it is at most `reach`."""
    count = len(points.index)
    nearest = np.full(count, np.inf)
    keys, depths = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for touch in stroke.touching(points, slopes, reach):
        keys.append(touch.feature * count + touch.point)
        depths.append(touch.clearance)
        if stroke.style.bands:
            # A piece that ends inside another may end a band there.
            np.minimum.at(nearest, touch.point, np.abs(touch.clearance))
            np.minimum.at(nearest, touch.point, _band_distance(stroke, touch))
    key, depth = np.concatenate(keys), np.concatenate(depths)
    if len(key):
        # The border is that of the union: the deepest piece counts.
        order = np.lexsort((-depth, key))
        first = order[np.flatnonzero(np.diff(key[order], prepend=-1))]
        np.minimum.at(nearest, key[first] % count, np.abs(depth[first]))
    if slopes is not None and stroke.style.slope_correction == "tangent":
        # A metre of the slope is less on the map.
        nearest /= np.sqrt(1.0 + (slopes.gradient**2).sum(axis=1))
    return nearest


def _screen_borders(
    decals: StrokeDecals, styled: StyledStroke, points: Strip, slopes: Slopes | None
) -> FloatArray:
    """Distance (n,) to the nearest border of a stroke with a width on the screen, as metres seen head-on.

    Infinite where none comes nearer than SCREEN_LIMIT pixels.
    """
    if slopes is None or slopes.planes is None:
        raise ValueError("Widths on the screen need the planes that points are seen on; see `slopes_of`.")
    deepest = np.full(len(points.index), -np.inf)
    for touch in touching_on_screen(styled, decals, points, slopes.planes, SCREEN_LIMIT):
        np.maximum.at(deepest, touch.point, touch.clearance)
    distance: FloatArray = np.abs(deepest) / slopes.planes.pixels_per_metre
    return distance


def _band_distance(stroke: StyledStroke, touch: Touch) -> FloatArray:
    """Distance (pairs,) of points in pieces to the nearest border of two bands, inf outside the pieces."""
    distance = np.full(len(touch.point), np.inf)
    for band in stroke.style.bands[:-1]:
        np.minimum(distance, np.abs(touch.gauge - band.reach * touch.half_width), out=distance)
    distance[touch.clearance < 0.0] = np.inf
    return distance
