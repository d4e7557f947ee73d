"""The part of a pixel's area that one feature covers: exactly, by clipping, and by samples.

The exact area takes the terrain as its tangent plane at the pixel's centre. The pixel's corner rays
meet that plane in a quadrilateral of the map, the feature is cut by it, and the cut is carried back to
the screen, where its area is the coverage: straight edges stay straight under that projection.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from .areas import feature_area
from .membership import membership
from .picture import sample_surface, slopes_of
from .rays import RayCaster, Surface, Viewpoint, pixel_centres

if TYPE_CHECKING:
    from .contract import CameraLike, Crop, FloatArray, SceneLike, Size

CORNERS = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])


def exact_coverage(
    scene: SceneLike, camera: CameraLike, size: Size, layer: int, feature: int, crop: Crop
) -> FloatArray:
    """Covered fraction (y1 - y0, x1 - x0), 0..1, of the pixels of a crop (x0, y0, x1, y1).

    feature: index in the layer's feature table. NaN where the centre sees sky or a corner's ray
    does not meet the tangent plane. The feature is all that is drawn of it; other features are not looked at.

    Raises ValueError for strokes with slope correction.
    """
    x0, y0, x1, y1 = crop
    caster = RayCaster(scene, camera, size)
    centres = pixel_centres(crop)
    centre = caster.cast(centres)
    corners = (centres + offset for offset in CORNERS)
    footprint = np.stack([_on_plane(caster.view, corner, centre) for corner in corners], axis=1)
    seen = np.isfinite(footprint).all(axis=(1, 2))
    covered = np.full(len(centres), np.nan)
    # Shapely works near the origin: map coordinates of 1e7 m would cost digits of the area.
    if seen.any():
        origin = footprint[seen].mean(axis=(0, 1))
        area = feature_area(scene.layers[layer], feature, origin)
        pixels = shapely.polygons(footprint[seen] - origin)
        area = shapely.intersection(area, shapely.box(*shapely.total_bounds(pixels)))
        cut = shapely.intersection(pixels, area)
        covered[seen] = [
            _screen_area(caster.view, geometry, centre[index], origin)
            for geometry, index in zip(cut, np.flatnonzero(seen), strict=True)
        ]
    return covered.reshape(y1 - y0, x1 - x0)


def sampled_coverage(
    scene: SceneLike,
    camera: CameraLike,
    size: Size,
    layer: int,
    feature: int,
    crop: Crop,
    samples: int = 16,
    seed: int = 0,
    surface: Surface | None = None,
) -> FloatArray:
    """The same fraction by stratified samples on the true terrain; sky counts as not covered.

    surface: of `sample_surface` with the same arguments, to save the rays.
    """
    if surface is None:
        surface = sample_surface(scene, camera, size, crop, samples, seed)
    chosen = scene.layers[layer]
    only = np.arange(len(chosen.features.rows)) == feature
    slopes = slopes_of(scene, camera, size, surface)
    held = membership(chosen, surface.world[..., :2].reshape(-1, 2), only, slopes)
    inside = np.diff(held.offsets).reshape(surface.depth.shape)
    fraction: FloatArray = inside.mean(axis=(2, 3))
    return fraction


def _on_plane(view: Viewpoint, points: FloatArray, centre: Surface) -> FloatArray:
    """Map positions (n, 2) where rays through picture positions (n, 2) meet the centres' planes."""
    origins, directions = view.rays(points)
    normal = np.concatenate([-centre.gradient, np.ones((len(points), 1))], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = ((centre.world - origins) * normal).sum(axis=1) / (directions * normal).sum(axis=1)
        hit: FloatArray = (origins + at[:, None] * directions)[:, :2]
    hit[~(at > 0)] = np.nan
    return hit


def _screen_area(view: Viewpoint, cut: shapely.Geometry, centre: Surface, origin: FloatArray) -> float:
    """Area in pixels of a map geometry on the tangent plane at one centre."""

    def to_screen(xy: FloatArray) -> FloatArray:
        world = np.empty((len(xy), 3))
        world[:, :2] = xy + origin
        world[:, 2] = centre.world[2] + (world[:, :2] - centre.world[:2]) @ centre.gradient
        return _project(view, world)

    return 0.0 if shapely.is_empty(cut) else float(shapely.area(shapely.transform(cut, to_screen)))


def _project(view: Viewpoint, world: FloatArray) -> FloatArray:
    """Picture positions (n, 2) of scene points (n, 3)."""
    offset = world - view.origin
    if view.orthographic:
        frame = np.stack([view.origin_x, view.origin_y, view.direction], axis=1)
        flat: FloatArray = np.linalg.solve(frame, offset.T).T[:, :2]
        return flat
    frame = np.stack([view.direction_x, view.direction_y, view.direction], axis=1)
    x, y, depth = np.linalg.solve(frame, offset.T)
    return np.stack([x / depth, y / depth], axis=1)
