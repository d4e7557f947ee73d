"""The true picture: ids at pixel centres and the filtered overlay by stratified samples.

A picture's true colour is the mean, over the pixel's area on the screen, of the features composited
"over" one another at each point, bottom to top, on sRGB values. It is sampled here at one random place
in each of samples x samples strata of the pixel. Sub-positions that see sky count as transparent.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .decals import follows_slopes, follows_view
from .edges import edge_distance
from .ground import Ground
from .membership import Membership, membership
from .rays import RayCaster, Surface, Viewpoint, pixel_centres, raycast, viewpoint
from .screen import screen_planes
from .strokes import Slopes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .contract import (
        BoolArray,
        CameraLike,
        Crop,
        FloatArray,
        IntArray,
        SceneLike,
        Size,
    )

# Sub-positions that are worked on at once.
BATCH = 1_000_000
# A step between neighbouring sub-positions is a silhouette where it exceeds their planes' by this factor.
JUMP_FACTOR = 4.0


class Ids(NamedTuple):
    """ids (h, w): row of the topmost feature, -1 none; layers (h, w): its layer, -1 none;
    edge_distance (h, w): metres on the map to the nearest boundary, inf if none, NaN if not asked for.
    """

    ids: IntArray
    layers: NDArray[np.int32]
    edge_distance: FloatArray


@dataclass(frozen=True)
class Overlay:
    """The filtered overlay of a crop.

    rgba: (h, w, 4) premultiplied, 0..1.
    mixed: (h, w) pixels that see both sky and terrain, or surfaces on two sides of a silhouette.
    terrain_fraction: (h, w) share of the sub-positions that see terrain.
    varied: (h, w) pixels whose sub-positions differ in colour.
    """

    rgba: FloatArray
    mixed: BoolArray
    terrain_fraction: FloatArray
    varied: BoolArray


def render_ids(
    scene: SceneLike,
    camera: CameraLike,
    size: Size,
    crop: Crop | None = None,
    *,
    surface: Surface | None = None,
    distances: bool = True,
    limit: float = np.inf,
    nearest: bool = False,
) -> Ids:
    """Topmost feature at pixel centres.

    size: picture width and height in pixels. crop: (x0, y0, x1, y1) in pixels, the whole picture by
    default; the result has shape (y1 - y0, x1 - x0). surface: what the centres of the crop see, to
    save the rays. distances: False leaves the edge distance out (NaN); limit: see `edge_distance`.
    nearest: see `membership`.
    """
    x0, y0, x1, y1 = crop or (0, 0, *size)
    shape = (y1 - y0, x1 - x0)
    if surface is None:
        surface = raycast(scene, camera, size, pixel_centres((x0, y0, x1, y1)))
    xy = surface.world[..., :2].reshape(-1, 2)
    slopes = slopes_of(scene, camera, size, surface)
    ids, layers = np.full(len(xy), -1, dtype=np.int64), np.full(len(xy), -1, dtype=np.int32)
    for index, layer in enumerate(scene.layers):
        top = membership(layer, xy, slopes=slopes, nearest=nearest).topmost()
        drawn = top >= 0
        ids[drawn] = np.asarray(layer.features.rows, dtype=np.int64)[top[drawn]]
        layers[drawn] = index
    edges = edge_distance(scene, xy, limit, slopes) if distances else np.full(len(xy), np.nan)
    return Ids(ids.reshape(shape), layers.reshape(shape), edges.reshape(shape))


def slopes_of(scene: SceneLike, camera: CameraLike, size: Size, surface: Surface) -> Slopes | None:
    """What slope correction and widths on the screen need at a surface's positions, flattened.

    None where no style asks for it.
    """
    if not follows_slopes(scene):
        return None
    gradient, world = surface.gradient.reshape(-1, 2), surface.world.reshape(-1, 3)
    if np.isnan(gradient[np.isfinite(world[:, 0])]).any():
        raise ValueError("The surface has no gradients, and the scene has strokes that depend on slopes.")
    return _slopes(scene, viewpoint(camera, size), world, gradient)


def _slopes(scene: SceneLike, view: Viewpoint, world: FloatArray, gradient: FloatArray) -> Slopes:
    ground = Ground(scene)
    planes = screen_planes(view, world, gradient, ground) if follows_view(scene) else None
    return Slopes(gradient, view.forward, planes, ground)


def composite(
    scene: SceneLike, xy: FloatArray, slopes: Slopes | None = None, nearest: bool = False
) -> FloatArray:
    """Premultiplied colour (n, 4), 0..1, of all features "over" one another at map points (n, 2).

    nearest: see `membership`.
    """
    result = np.zeros((len(xy), 4))
    for layer in scene.layers:
        _composite_layer(result, membership(layer, xy, slopes=slopes, nearest=nearest))
    return result


def _composite_layer(result: FloatArray, held: Membership) -> None:
    depths = np.diff(held.offsets)
    active = np.flatnonzero(depths > 0)
    level = 0
    while len(active):
        source = held.palette[held.tints[held.offsets[active] + level]]
        result[active] = source + result[active] * (1 - source[:, 3:])
        level += 1
        active = active[depths[active] > level]


def sample_points(crop: Crop, samples: int, seed: int = 0) -> FloatArray:
    """Picture positions (h, w, samples, samples, 2): one random place in each stratum of each pixel.

    The third axis goes down, the fourth to the right. A pixel's places depend on the seed and on the
    pixel alone, not on the crop.
    """
    x0, y0, x1, y1 = crop
    points = np.empty((y1 - y0, x1 - x0, samples, samples, 2))
    strata = np.arange(samples)
    for y in range(y0, y1):
        generator = np.random.default_rng([seed, y + 2**31])
        jitter = generator.random((x1, samples, samples, 2))[x0:]
        points[y - y0, ..., 0] = (strata + jitter[..., 0]) / samples
        points[y - y0, ..., 1] = y + (strata[:, None] + jitter[..., 1]) / samples
    points[..., 0] += np.arange(x0, x1)[:, None, None]
    return points


def sample_surface(
    scene: SceneLike, camera: CameraLike, size: Size, crop: Crop, samples: int = 16, seed: int = 0
) -> Surface:
    """What the sub-positions of a crop see, shape (h, w, samples, samples); 48 bytes each."""
    x0, y0, x1, y1 = crop
    points = sample_points(crop, samples, seed).reshape(-1, 2)
    surface = RayCaster(scene, camera, size).cast(points)
    return surface.reshape(y1 - y0, x1 - x0, samples, samples)


def render_overlay(
    scene: SceneLike,
    camera: CameraLike,
    size: Size,
    crop: Crop | None = None,
    samples: int = 16,
    seed: int = 0,
    surface: Surface | None = None,
    nearest: bool = False,
) -> Overlay:
    """The filtered overlay of a crop (x0, y0, x1, y1) of a picture of `size`, all in pixels.

    surface: of `sample_surface` with the same arguments, to save the rays when layers change.
    nearest: see `membership`.
    """
    x0, y0, x1, y1 = crop or (0, 0, *size)
    if x1 <= x0 or y1 <= y0:
        raise ValueError(f"The crop {(x0, y0, x1, y1)} holds no pixels.")
    caster = RayCaster(scene, camera, size) if surface is None else None
    view = viewpoint(camera, size)
    rows = max(1, BATCH // ((x1 - x0) * samples * samples))
    bands = []
    for top in range(y0, y1, rows):
        band = (x0, top, x1, min(top + rows, y1))
        points = sample_points(band, samples, seed)
        if surface is not None:
            seen = surface[top - y0 : band[3] - y0]
        else:
            assert caster is not None
            seen = caster.cast(points.reshape(-1, 2)).reshape(*points.shape[:4])
        bands.append(_filter_band(scene, view, points, seen, nearest))
    return Overlay(*(np.concatenate(parts) for parts in zip(*bands, strict=True)))


def _filter_band(
    scene: SceneLike, view: Viewpoint, points: FloatArray, seen: Surface, nearest: bool
) -> tuple[FloatArray, BoolArray, FloatArray, BoolArray]:
    """The members of an Overlay for sub-positions (h, w, s, s, 2) and what they see, each with its own slope."""
    height, width, samples = points.shape[:3]
    hit = np.isfinite(seen.depth)
    slopes = None
    if follows_slopes(scene):
        slopes = _slopes(scene, view, seen.world.reshape(-1, 3), seen.gradient.reshape(-1, 2))
    colors = composite(scene, seen.world[..., :2].reshape(-1, 2), slopes, nearest)
    colors = colors.reshape(height, width, samples * samples, 4)
    varied = (colors != colors[:, :, :1]).any(axis=(2, 3))
    terrain = hit.mean(axis=(2, 3))
    mixed = ((terrain > 0) & (terrain < 1)) | _has_jump(view, points, seen)
    return colors.mean(axis=2), mixed, terrain, varied


def _has_jump(view: Viewpoint, points: FloatArray, seen: Surface) -> BoolArray:
    """Pixels (h, w) with neighbouring sub-positions on two sides of a silhouette.

    On a plane inverse depth (depth itself when orthographic) is linear on the screen. Two neighbours
    whose step is far more than both their planes' steepest explain lie on separate surfaces.
    """
    value, slope = _screen_depth(view, seen)
    jump = np.zeros(points.shape[:2], dtype=np.bool_)
    for axis in (2, 3):
        first = [slice(None)] * 4
        second = [slice(None)] * 4
        first[axis], second[axis] = slice(None, -1), slice(1, None)
        a, b = tuple(first), tuple(second)
        gap = np.hypot(*np.moveaxis(points[b] - points[a], -1, 0))
        explained = np.maximum(slope[a], slope[b]) * gap
        scale = np.maximum(np.abs(value[a]), np.abs(value[b]))
        # Sky against sky is inf - inf: no number, no jump.
        with np.errstate(invalid="ignore"):
            step = np.abs(value[b] - value[a])
            jump |= (step > JUMP_FACTOR * explained + 1e-7 * scale).any(axis=(2, 3))
    return jump


def _screen_depth(view: Viewpoint, seen: Surface) -> tuple[FloatArray, FloatArray]:
    """Inverse depth (…) per sub-position, or depth when orthographic, and its steepest slope a pixel."""
    normal = np.concatenate([-seen.gradient, np.ones((*seen.depth.shape, 1))], axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        if view.orthographic:
            across = normal @ view.direction
            slope = np.hypot(normal @ view.origin_x, normal @ view.origin_y) / np.abs(across)
            return seen.depth, slope
        height = ((seen.world - view.origin) * normal).sum(axis=-1)
        slope = np.hypot(normal @ view.direction_x, normal @ view.direction_y) / np.abs(height)
        return 1.0 / seen.depth, slope
