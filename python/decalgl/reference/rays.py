"""From picture positions to the terrain: camera rays and what they hit.

Pixel (x, y) has its centre at (x + 1/2, y + 1/2), row 0 at the top. The ray parameter is planar eye
depth: the distance along the viewing direction, in metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .heightfield import Heightfield

if TYPE_CHECKING:
    from .contract import CameraLike, Crop, FloatArray, SceneLike, Size


@dataclass(frozen=True)
class Surface:
    """What rays hit, for picture positions of any shape (…).

    world: (…, 3) scene coordinates in metres, NaN where there is sky.
    depth: (…) planar eye depth in metres, inf where there is sky.
    gradient: (…, 2) dz/dx and dz/dy of the hit triangle, NaN where there is sky.
    """

    world: FloatArray
    depth: FloatArray
    gradient: FloatArray

    def __getitem__(self, index: Any) -> Surface:
        """The same surface over some of the positions; `index` addresses `depth`."""
        return Surface(self.world[index], self.depth[index], self.gradient[index])

    def reshape(self, *shape: int) -> Surface:
        """The same surface with positions in another shape."""
        return Surface(
            self.world.reshape(*shape, 3), self.depth.reshape(*shape), self.gradient.reshape(*shape, 2)
        )


@dataclass(frozen=True)
class Viewpoint:
    """A camera for one picture size: ray(x, y) = origin + x*origin_x + y*origin_y, direction likewise.

    Every member is a vector (3,): `origin_x` is the change of the ray's origin in metres for one pixel
    to the right, and so on. Perspective cameras move the direction only, orthographic ones the origin. `forward` is
    the unit view direction.
    """

    origin: FloatArray
    origin_x: FloatArray
    origin_y: FloatArray
    direction: FloatArray
    direction_x: FloatArray
    direction_y: FloatArray
    orthographic: bool
    forward: FloatArray

    def rays(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Origins and directions (n, 3) through picture positions (n, 2) in pixels."""
        x, y = points[:, :1], points[:, 1:]
        origins = self.origin + x * self.origin_x + y * self.origin_y
        directions = self.direction + x * self.direction_x + y * self.direction_y
        return origins, directions


def viewpoint(camera: CameraLike, size: Size) -> Viewpoint:
    """The rays of a camera in a picture of `size` (width, height) pixels."""
    width, height = size
    for_size = getattr(camera, "for_size", None)
    if for_size is not None:
        camera = for_size(size)
    eye = np.asarray(camera.eye, dtype=np.float64)
    forward = _normalise(np.asarray(camera.target, dtype=np.float64) - eye)
    right = _normalise(np.cross(forward, np.asarray(camera.up, dtype=np.float64)))
    up = np.cross(right, forward)
    if camera.fov is not None:
        half_height = float(np.tan(np.radians(camera.fov) / 2))
    elif camera.view_height is not None:
        half_height = camera.view_height / 2
    else:
        raise ValueError("The camera has neither a field of view nor a view height.")
    half_width = half_height * width / height
    corner = up * half_height - right * half_width
    step_x, step_y = right * (2 * half_width / width), up * (-2 * half_height / height)
    zero = np.zeros(3)
    if camera.fov is None:
        return Viewpoint(eye + corner, step_x, step_y, forward, zero, zero, True, forward)
    return Viewpoint(eye, zero, zero, forward + corner, step_x, step_y, False, forward)


def pixel_centres(crop: Crop) -> FloatArray:
    """Picture positions (pixels, 2) of the pixel centres of a crop (x0, y0, x1, y1), row by row."""
    x0, y0, x1, y1 = crop
    y, x = np.mgrid[y0:y1, x0:x1]
    return np.stack([x.ravel() + 0.5, y.ravel() + 0.5], axis=1)


def raycast(scene: SceneLike, camera: CameraLike, size: Size, points: FloatArray | None = None) -> Surface:
    """Nearest hits of the terrain's triangles.

    size: picture width and height in pixels. points: picture positions (n, 2) in pixels, continuous;
    without them all pixel centres are cast and the surface has shape (height, width).
    """
    caster = RayCaster(scene, camera, size)
    if points is not None:
        return caster.cast(points)
    return caster.cast(pixel_centres((0, 0, *size))).reshape(size[1], size[0])


class RayCaster:
    """A terrain made ready for many calls of one camera."""

    def __init__(self, scene: SceneLike, camera: CameraLike, size: Size) -> None:
        self.view = viewpoint(camera, size)
        self._field = Heightfield(scene.heights)
        terrain = scene.terrain
        self._zero = np.array([terrain.x0, terrain.y0, 0.0])
        self._scale = np.array([1.0 / terrain.dx, -1.0 / terrain.dy, 1.0])

    def cast(self, points: FloatArray) -> Surface:
        """The surface at picture positions (n, 2) in pixels."""
        origins, directions = self.view.rays(np.asarray(points, dtype=np.float64).reshape(-1, 2))
        hits = self._field.cast((origins - self._zero) * self._scale, directions * self._scale)
        depth = hits.distance
        with np.errstate(invalid="ignore"):
            world = origins + depth[:, None] * directions
        world[~np.isfinite(depth)] = np.nan
        return Surface(world, depth, hits.slope * self._scale[:2])


def _normalise(vector: FloatArray) -> FloatArray:
    length = float(np.linalg.norm(vector))
    if not length > 0:
        raise ValueError("The camera's eye, target and up do not span a view.")
    return vector / length
