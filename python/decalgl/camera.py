"""Where a picture is taken from, and the geometry of its rays.

    up          picture, width x height                 f = normalise(target - eye)      forward
     |  right   +-------------------+ y = 0             r = normalise(f x up)            right
     | /        | (x, y) continuous |                   u = r x f                        up
     |/         | pixel (i, j) has  |
    eye ----> f | its centre at     |                   perspective: rays leave the eye, along
                | (i + .5, j + .5)  |                       f + r * X + u * Y, where f has length 1
                +-------------------+                   orthographic: rays leave the eye's plane, along f

So the ray's parameter is planar depth: metres in front of the plane through the eye.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

Point = tuple[float, float, float]
UP: Point = (0.0, 0.0, 1.0)
NORTH: Point = (0.0, 1.0, 0.0)
# Closer than this (radians) to straight up or down, "up" has no direction in the picture.
VERTICAL = 1e-6
NARROWEST = 1e-9  # degrees; a narrower field of view, or one as close to 180, is taken for a mistake
TOP_DOWN_HEIGHT = 100_000.0
# Metres: a camera's numbers stay between these, so that no product of them over- or underflows.
CLOSEST, FARTHEST = 1e-9, 1e12


@dataclass(frozen=True)
class Camera:
    """A camera in the scene's plane; make one with `look_at`, `orbit` or `top_down`.

    eye, target: (x, y, z), metres; z is up and counts after exaggeration.
    up: the direction that points up in the picture; None becomes z, or north when looking straight down or
        up.
    fov: vertical field of view in degrees, None for an orthographic camera.
    view_height: metres that the picture's height shows; orthographic only.
    bounds: (xmin, ymin, xmax, ymax) that an orthographic camera fits into a picture; `for_size` turns it
        into a view_height.
    """

    eye: Point
    target: Point
    up: Point = None  # type: ignore[assignment]
    fov: float | None = 45.0
    view_height: float | None = None
    bounds: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        for name in ("eye", "target"):
            object.__setattr__(self, name, _point(getattr(self, name), name))
        if math.dist(self.eye, self.target) < CLOSEST:
            raise InputError(
                f"eye and target are the same point {self.eye}, so there is no direction. Move one of them."
            )
        object.__setattr__(self, "up", self._upright())
        if self.fov is not None:
            object.__setattr__(self, "fov", _number(self.fov, "fov"))
            if not NARROWEST < self.fov < 180.0 - NARROWEST:
                raise InputError(f"fov must lie between 0 and 180 degrees, but it is {self.fov}.")
        if self.view_height is not None:
            object.__setattr__(self, "view_height", _number(self.view_height, "view_height"))
            if not CLOSEST <= self.view_height <= FARTHEST:
                raise InputError(
                    f"view_height must be larger than 0 metres (up to {FARTHEST:g}), but it is"
                    f" {self.view_height}."
                )
        if self.fov is None and self.view_height is None and self.bounds is None:
            raise InputError(
                "An orthographic camera (fov=None) needs a view_height in metres, or bounds to fit."
            )
        if self.fov is not None and (self.view_height is not None or self.bounds is not None):
            raise InputError(
                "A camera has a fov or a view_height (or bounds), not both. Set fov=None for an orthographic"
                " one."
            )
        if self.bounds is not None:
            object.__setattr__(self, "bounds", _bounds(self.bounds))

    @classmethod
    def look_at(
        cls,
        eye: Sequence[float],
        target: Sequence[float],
        fov: float = 45.0,
        up: Sequence[float] | None = None,
    ) -> Camera:
        """A perspective camera at `eye` that looks at `target`, both (x, y, z) in metres.

        fov: vertical field of view, degrees.
        up: the direction upwards in the picture; by default z, or north when looking straight down.
        Raises InputError (not finite, eye and target equal, fov, up along the view).
        """
        # None is settled once eye and target are known.
        settled: Any = None if up is None else _point(up, "up")
        return cls(_point(eye, "eye"), _point(target, "target"), settled, fov)

    @classmethod
    def orbit(
        cls, target: Sequence[float], distance: float, azimuth: float, elevation: float, fov: float = 45.0
    ) -> Camera:
        """A perspective camera on a sphere around `target`.

        distance: metres from the target.
        azimuth: where the camera stands, degrees clockwise from north: at 180 it looks north.
        elevation: degrees above the horizon, -90 to 90.
        """
        centre = _point(target, "target")
        reach = _number(distance, "distance")
        bearing = math.radians(_number(azimuth, "azimuth"))
        rise = math.radians(_number(elevation, "elevation"))
        if reach <= 0.0:
            raise InputError(f"distance must be larger than 0 metres, but it is {distance}.")
        if abs(rise) > math.pi / 2.0:
            raise InputError(f"elevation must lie between -90 and 90 degrees, but it is {elevation}.")
        east, north, height = math.sin(bearing), math.cos(bearing), math.sin(rise)
        level = math.cos(rise)
        eye = (
            centre[0] + reach * level * east,
            centre[1] + reach * level * north,
            centre[2] + reach * height,
        )
        # Straight above, "up" keeps the bearing, so that the picture does not jump at 90 degrees.
        up = (-east * math.copysign(1.0, height), -north * math.copysign(1.0, height), 0.0)
        return cls(eye, centre, up if level < VERTICAL else UP, fov)

    @classmethod
    def top_down(cls, bounds: Sequence[float], margin: float = 0.0) -> Camera:
        """An orthographic camera straight above that shows all of `bounds`, north up, like a map.

        bounds: (xmin, ymin, xmax, ymax), metres. margin: what to add on every side, as a share of the extent.
        The eye stands at a height of 100 km, and depth counts from there.
        """
        west, south, east, north = _bounds(bounds)
        share = _number(margin, "margin")
        if share <= -0.5:
            raise InputError(f"margin must be larger than -0.5, but it is {margin}.")
        wide, high = share * (east - west), share * (north - south)
        fitted = (west - wide, south - high, east + wide, north + high)
        x, y = (west + east) / 2.0, (south + north) / 2.0
        return cls((x, y, TOP_DOWN_HEIGHT), (x, y, 0.0), NORTH, None, None, fitted)

    @property
    def is_orthographic(self) -> bool:
        """Whether all rays are parallel."""
        return self.fov is None

    def for_size(self, size: tuple[int, int]) -> Camera:
        """This camera with its view_height settled for a picture of `size` (width, height) in pixels."""
        width, height = checked_size(size)
        if self.bounds is None or self.view_height is not None:
            return self
        west, south, east, north = self.bounds
        return replace(self, view_height=max(north - south, (east - west) * height / width))

    def basis(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """(right, up, forward), float64 unit vectors (3,) at right angles."""
        forward = self._forward()
        right = np.cross(forward, self.up)
        right /= np.linalg.norm(right)
        return right, np.cross(right, forward), forward

    def _forward(self) -> NDArray[np.float64]:
        forward = np.subtract(self.target, self.eye)
        return np.asarray(forward / np.linalg.norm(forward))

    def _upright(self) -> Point:
        given: Point | None = self.up
        up = UP if given is None else _point(given, "up")
        length = float(np.linalg.norm(up))
        if length > 0.0 and float(np.linalg.norm(np.cross(self._forward(), up))) >= VERTICAL * length:
            return up
        if given is None:
            return NORTH
        raise InputError(
            f"up={up} points along the view from {self.eye} to {self.target}, or nowhere, so the picture has"
            " no upright. Give another direction, such as (0, 1, 0) when looking down, or leave up= out."
        )

    def rays(self, xy: ArrayLike, size: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(origins, directions), float64 (n, 3), through the picture positions `xy` (n, 2).

        Positions are continuous: pixel (i, j) has its centre at (i + 0.5, j + 0.5). The surface at planar
        depth t is at origin + t * direction.
        """
        camera = self.for_size(size)
        width, height = checked_size(size)
        positions = _table(xy, 2, "xy")
        right, up, forward = camera.basis()
        half_height = camera._half_height()
        across = (2.0 * positions[:, 0] / width - 1.0) * half_height * width / height
        upwards = (1.0 - 2.0 * positions[:, 1] / height) * half_height
        offsets = across[:, None] * right + upwards[:, None] * up
        eye = np.array(camera.eye)
        if camera.is_orthographic:
            return eye + offsets, np.broadcast_to(forward, offsets.shape).copy()
        return np.broadcast_to(eye, offsets.shape).copy(), forward + offsets

    def project(
        self, points: ArrayLike, size: tuple[int, int]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(xy (n, 2), depth (n)) of scene points (n, 3): positions in pixels, planar depth in metres.

        Points at or behind the plane through the eye have xy NaN with a perspective camera; their depth is
        not positive.
        """
        camera = self.for_size(size)
        width, height = checked_size(size)
        right, up, forward = camera.basis()
        local = _table(points, 3, "points") - np.array(camera.eye)
        depth = local @ forward
        scale = np.full(len(depth), camera._half_height())
        if not camera.is_orthographic:
            scale *= np.where(depth > 0.0, depth, np.nan)
        x = (local @ right / scale * height / width + 1.0) * width / 2.0
        y = (1.0 - local @ up / scale) * height / 2.0
        return np.column_stack([x, y]), depth

    def _half_height(self) -> float:
        if self.fov is not None:
            return math.tan(math.radians(self.fov) / 2.0)
        assert self.view_height is not None
        return self.view_height / 2.0


def _number(value: Any, name: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be a number, but it is {value!r}.") from error
    if not math.isfinite(number):
        raise InputError(f"{name} must be finite, but it is {number}.")
    return number


def _numbers(values: Any, count: int, name: str, shape: str) -> tuple[float, ...]:
    try:
        numbers = tuple(float(value) for value in values)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be {shape}, but it is {values!r}.") from error
    if len(numbers) != count or not all(math.isfinite(number) for number in numbers):
        raise InputError(f"{name} must be {shape} of finite numbers, but it is {numbers}.")
    return numbers


def _point(values: Any, name: str) -> Point:
    x, y, z = _numbers(values, 3, name, "(x, y, z)")
    if max(abs(x), abs(y), abs(z)) > FARTHEST:
        raise InputError(f"{name} {(x, y, z)} lies more than {FARTHEST:g} m from the origin. Move it closer.")
    return (x, y, z)


def _bounds(values: Any) -> tuple[float, float, float, float]:
    west, south, east, north = _numbers(values, 4, "bounds", "(xmin, ymin, xmax, ymax)")
    if not (west < east and south < north):
        raise InputError(
            f"bounds must have xmin < xmax and ymin < ymax, but it is {(west, south, east, north)}."
        )
    _point((max(abs(west), abs(east)), max(abs(south), abs(north)), 0.0), "bounds")
    return (west, south, east, north)


def checked_size(size: Any) -> tuple[int, int]:
    """(width, height) of a picture in pixels, at least 1 each. Raises InputError."""
    try:
        width, height = (int(value) for value in size)
        whole = width == size[0] and height == size[1]
    except (TypeError, ValueError, OverflowError):
        width, height, whole = 0, 0, False
    if not whole or width < 1 or height < 1:
        raise InputError(
            f"size must be (width, height) in whole pixels, at least (1, 1), but it is {size!r}."
        )
    return width, height


def _table(values: ArrayLike, columns: int, name: str) -> NDArray[np.float64]:
    table = np.asarray(values, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] != columns:
        raise InputError(f"{name} must have shape (n, {columns}), but it is {table.shape}.")
    return table
