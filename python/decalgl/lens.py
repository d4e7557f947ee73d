"""The lens: a part of the picture in which layers look otherwise.

circle on the screen: it stays round.    polygon on the map: it lies on the terrain.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from .errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .frame import PreparedLayer
    from .scene import Layer

    AnyLayer: TypeAlias = Layer | PreparedLayer | str | int


@dataclass(frozen=True, eq=False)
class Lens:
    """A circle on the screen or a polygon on the map, and what is seen in it.

    circle: (x, y, radius) in pixels from the picture's upper left corner; the centre of pixel (0, 0) is (0.5, 0.5).
    polygon: a shapely polygon or multipolygon, or (n, 2) coordinates, in the scene's CRS.
    styles: {layer: keywords of `Renderer.restyle`}; what they leave open is as outside. {"visible": True} shows
        what is hidden outside.
    hidden: layers that are not seen inside.
    """

    circle: tuple[float, float, float] | None = None
    polygon: Any = None
    styles: Mapping[Any, Mapping[str, Any]] = field(default_factory=dict, repr=False)
    hidden: tuple[Any, ...] = ()
    rings: tuple[NDArray[np.float64], ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if (self.circle is None) == (self.polygon is None):
            raise InputError("A lens is a circle or a polygon. Give one of the two.")
        if self.circle is not None:
            object.__setattr__(self, "circle", _checked_circle(self.circle))
        object.__setattr__(self, "rings", () if self.polygon is None else _rings_of(self.polygon))
        if not isinstance(self.styles, Mapping):
            raise InputError(
                f"styles= of a lens must be a dict {{layer: keywords}}, not a {type(self.styles).__name__}."
            )
        hidden = self.hidden if isinstance(self.hidden, (list, tuple, set)) else (self.hidden,)
        object.__setattr__(self, "hidden", tuple(hidden))

    def moved(self, circle: tuple[float, float, float] | None = None, polygon: Any = None) -> Lens:
        """The same lens elsewhere: setting it costs next to nothing."""
        return replace(self, circle=circle, polygon=polygon)

    def shows_as(self, other: Lens | None) -> bool:
        """Whether the same is seen in both."""
        return other is not None and self.styles is other.styles and self.hidden == other.hidden


def _checked_circle(circle: Any) -> tuple[float, float, float]:
    try:
        x, y, radius = (float(value) for value in circle)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"circle= must be (x, y, radius) in pixels, such as (640, 360, 100), not {circle!r}."
        ) from error
    if not np.isfinite([x, y, radius]).all() or radius < 0.0:
        raise InputError(f"circle= must be finite, with a radius of 0 or more, but it is {circle!r}.")
    return x, y, radius


def _rings_of(polygon: Any) -> tuple[NDArray[np.float64], ...]:
    if hasattr(polygon, "geom_type"):
        parts = getattr(polygon, "geoms", [polygon])
        if any(part.geom_type != "Polygon" for part in parts) or polygon.is_empty:
            raise InputError(f"polygon= of a lens must be a polygon with an area, not {polygon.geom_type}.")
        rings = [ring.coords for part in parts for ring in (part.exterior, *part.interiors)]
    else:
        rings = [polygon]
    return tuple(_checked_ring(ring) for ring in rings)


def _checked_ring(ring: Any) -> NDArray[np.float64]:
    try:
        points = np.array(ring, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("polygon= of a lens must be a shapely polygon or (n, 2) coordinates.") from error
    if points.ndim != 2 or points.shape[1] < 2 or len(points) < 3 or not np.isfinite(points).all():
        raise InputError(
            f"polygon= of a lens must have at least three finite points x, y, but its shape is {points.shape}."
        )
    return points[:, :2]
