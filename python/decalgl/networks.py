"""Styles of networks drawn by distance fields, and the levels of detail at which they hold (Trapp et al. 2015).

NetworkStyle(width=12, color="gold", border_color="black", main=0.8)      one style
NetworkCategory([(0.0, near), (1.0, far)])                                styles by level of detail
Lod.by_distance(200, 5000)                                                where which level holds
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

from . import _core
from ._colors import parse_color
from ._values import finite_number, is_listed, is_number, is_word
from .errors import StyleError
from .patterns import parse_dash

if TYPE_CHECKING:
    from numpy.typing import NDArray

CAPS = ("round", "square", "butt")
DROP_OFF_SIDE = 512
FIRST_CUSTOM_CAP = len(CAPS) + 1
MOST_LOD_STYLES = 16
SPACES = ("map", "screen", "camera")


@dataclass(frozen=True)
class NetworkStyle:
    """How the lines of a category look at one level of detail.

    width: metres, from border to border; 0 is not drawn.
    color: of the main part, with alpha. border_color: of the rest; None without a border.
    main: the share of the width in the main colour; 0.75 by default where there is a border, else 1.
    texture_share: how much of the category's texture the main colour takes, 0 to 1.

    Raises StyleError.
    """

    width: float
    color: Any = "white"
    border_color: Any = None
    main: float | None = None
    texture_share: float = 0.0

    def __post_init__(self) -> None:
        if finite_number(self.width, "NetworkStyle width") < 0.0:
            raise StyleError(f"NetworkStyle width must be metres, 0 or more, but it is {self.width:g}.")
        main = self.main if self.main is not None else (1.0 if self.border_color is None else 0.75)
        object.__setattr__(self, "main", _share(main, "NetworkStyle main"))
        _share(self.texture_share, "NetworkStyle texture_share")
        parse_color(self.color)
        if self.border_color is not None:
            parse_color(self.border_color)

    def core(self, lod: float) -> _core.NetworkStyle:
        """As the core takes it."""
        style = _core.NetworkStyle()
        style.lod, style.width = lod, float(self.width)
        style.main, style.texture_share = float(cast("float", self.main)), float(self.texture_share)
        style.main_color = parse_color(self.color)
        # A border that is not there fades in without a colour of its own.
        style.border_color = (
            (*style.main_color[:3], 0.0) if self.border_color is None else parse_color(self.border_color)
        )
        return style


@dataclass(frozen=True, eq=False)
class NetworkCategory:
    """The style set of a category.

    styles: a `NetworkStyle`; or [(lod, style), ...] by rising level of detail from 0 to 1, between which pixels
        take a mean.
    cap: how lines end: "round", "square", "butt" or a drop-off of your own, an array (512, 512) from 0 at the line
        to 1 where its field ends: row 0 lies on the line, column 0 at its end. Or a dict by the node's grade: how
        many segments meet there, {1: "butt", 3: "round"}; 4 stands for four and more.
    slope_correction: None, "tangent" or "thoeny", as `Scene.add_lines` has it; lengths of dashes stay those on the map.
    dash: as `Scene.add_lines` has it, or a `Pattern` of arrows and the like.
    texture: an array (rows, columns, 4) of bytes, R, G, B, A; columns go along the line, rows from its middle to the
        border of the main colour. texture_length: metres that its columns take up.
    sketch: (amplitude, length): borders waver by a share of the half width, every so many metres.

    Raises StyleError.
    """

    styles: NetworkStyle | Sequence[tuple[float, NetworkStyle]]
    cap: Any = "round"
    slope_correction: Literal["thoeny", "tangent"] | None = None
    dash: Any = None
    texture: Any = None
    texture_length: float = 100.0
    sketch: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "styles", _tuples(self.styles))
        object.__setattr__(self, "dash", parse_dash(self.dash))
        if self.slope_correction not in (None, "thoeny", "tangent"):
            raise StyleError(
                f"slope_correction must be None, 'thoeny' or 'tangent', not {self.slope_correction!r}."
            )
        if self.texture is not None:
            object.__setattr__(self, "texture", _texture(self.texture))
        if finite_number(self.texture_length, "texture_length") <= 0.0:
            raise StyleError("texture_length must be metres above 0.")
        object.__setattr__(self, "sketch", _sketch(self.sketch))
        for grade, cap in self.caps.items():
            if not is_word(cap, CAPS):
                _drop_off(cap, grade)

    @property
    def caps(self) -> dict[int, Any]:
        """The cap of each grade from 1 to 4."""
        if not isinstance(self.cap, Mapping):
            return dict.fromkeys(range(1, 5), self.cap)
        unknown = [grade for grade in self.cap if grade not in range(1, 5)]
        if unknown:
            raise StyleError(f"cap= names grade {unknown[0]!r}; grades go from 1 to 4.")
        return {grade: self.cap.get(grade, "round") for grade in range(1, 5)}

    def core(
        self, name: str, options: _core.DistanceFieldOptions, added: dict[int, int]
    ) -> _core.NetworkCategory:
        """As the core takes it; textures and drop-offs go into the options, `added` knows those there are."""
        category = _core.NetworkCategory()
        category.name = name
        tuples = cast("Sequence[tuple[float, NetworkStyle]]", self.styles)
        category.styles = [style.core(lod) for lod, style in tuples]
        category.caps = [self._core_cap(cap, grade, options, added) for grade, cap in self.caps.items()]
        category.slope_correction = _core.SlopeCorrection.__members__[self.slope_correction or "none"]
        if self.dash is not None:
            pattern = self.dash.for_width(max(style.width for _, style in tuples))
            if pattern.units == "px":
                raise StyleError(
                    f"NetworkCategory {name!r}: dash must be in metres or widths, not in pixels."
                )
            marks = [
                _core.PatternMark(mark.begin, mark.end, mark.begin_width, mark.end_width)
                for mark in pattern.marks
            ]
            category.pattern = _core.LinePattern(pattern.period, pattern.offset, marks)
        if self.texture is not None:
            category.raster = _added(self.texture, 0, added, options.add_raster)
            category.raster_length = float(self.texture_length)
        category.sketch = self.sketch
        return category

    def _core_cap(
        self, cap: Any, grade: int, options: _core.DistanceFieldOptions, added: dict[int, int]
    ) -> int:
        if isinstance(cap, str):
            return 1 + CAPS.index(cap)
        texels = _drop_off(cap, grade)
        options.add_drop_off(texels)
        added[-1] = added.get(-1, FIRST_CUSTOM_CAP - 1) + 1
        return added[-1]


@dataclass(frozen=True, eq=False)
class Lod:
    """Which level of detail, 0 to 1, holds where.

    source: "value", the same everywhere; "distance", 0 up to `near` metres of eye depth and 1 from `far` on;
        "texture", read from an array.
    texture: (rows, columns), 0 to 1 or bytes; row 0 lies on top.
    space: what the texture lies on: "map", "screen", or "camera", the ground before the camera.
    extent: (x0, y0, x1, y1) of the texture. map: the scene's coordinates. screen: shares of the picture from its lower
        left corner. camera: metres to the right of the view's axis, and metres of eye depth.

    Raises StyleError.
    """

    source: Literal["value", "distance", "texture"] = "value"
    value: float = 0.0
    near: float = 0.0
    far: float = 1.0
    texture: Any = None
    space: Literal["map", "screen", "camera"] = "map"
    extent: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)

    def __post_init__(self) -> None:
        if not is_word(self.source, ("value", "distance", "texture")):
            raise StyleError(f"Lod source must be 'value', 'distance' or 'texture', not {self.source!r}.")
        if not is_word(self.space, SPACES):
            raise StyleError(f"Lod space must be 'map', 'screen' or 'camera', not {self.space!r}.")
        _share(self.value, "Lod value")
        if self.source == "distance" and not 0.0 <= self.near < self.far:
            raise StyleError(f"Lod near must lie below far, but they are {self.near!r} and {self.far!r}.")
        if self.source == "texture":
            object.__setattr__(self, "texture", _lod_texels(self.texture))
        extent = tuple(finite_number(value, "Lod extent") for value in self.extent)
        if len(extent) != 4 or extent[0] >= extent[2] or extent[1] >= extent[3]:
            raise StyleError(f"Lod extent must be (x0, y0, x1, y1), rising, but it is {self.extent!r}.")
        object.__setattr__(self, "extent", extent)

    @classmethod
    def at(cls, value: float) -> Lod:
        """One level everywhere."""
        return cls(value=value)

    @classmethod
    def by_distance(cls, near: float, far: float) -> Lod:
        """By how far away the eye is."""
        return cls("distance", near=near, far=far)

    @classmethod
    def by_texture(
        cls,
        texture: Any,
        extent: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0),
        space: Literal["map", "screen", "camera"] = "map",
    ) -> Lod:
        """By a texture, whose edges go on beyond its extent."""
        return cls("texture", texture=texture, space=space, extent=extent)

    @classmethod
    def lens(
        cls,
        center: tuple[float, float],
        radius: float,
        falloff: float = 0.0,
        space: Literal["map", "screen", "camera"] = "map",
        texels: int = 256,
    ) -> Lod:
        """1 in a circle and 0 outside, with a ring of `falloff` between them; all in the units of the space."""
        reach = radius + falloff
        x, y = center
        steps = (np.arange(texels) + 0.5) / texels * 2.0 - 1.0
        # A ring of zeros goes on beyond the extent.
        distance = np.hypot(*np.meshgrid(steps, steps)) * reach * texels / (texels - 4.0)
        inside = np.clip((reach - distance) / max(falloff, 1e-9 * reach), 0.0, 1.0)
        side = reach * texels / (texels - 4.0)
        return cls.by_texture(inside, (x - side, y - side, x + side, y + side), space)

    @classmethod
    def along(cls, route: Any, reach: float, falloff: float, texels: int = 512) -> Lod:
        """1 within `reach` metres of a route and 0 from `falloff` metres further on: a region of interest.

        route: (n, 2) coordinates on the scene's plane, or a shapely line.
        """
        points = _route_points(route)
        margin = reach + falloff
        low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
        side = float(max(high - low)) / (texels - 4)
        columns, rows = (int(np.ceil(length / side)) + 4 for length in high - low)
        x = low[0] + (np.arange(columns) - 1.5) * side
        y = low[1] + (np.arange(rows) - 1.5) * side
        distance = _distances(x, y, points)
        inside = np.clip(1.0 - (distance - reach) / max(falloff, 1e-9), 0.0, 1.0)[::-1]
        x0, y0 = x[0] - 0.5 * side, y[0] - 0.5 * side
        return cls.by_texture(inside, (x0, y0, x0 + columns * side, y0 + rows * side))

    def core(self) -> _core.LevelOfDetail:
        """As the core takes it."""
        lod = _core.LevelOfDetail()
        lod.source = _core.LodSource.__members__[self.source]
        lod.space = _core.LodSpace.__members__[self.space]
        lod.value, lod.near, lod.far = float(self.value), float(self.near), float(self.far)
        lod.extent = self.extent
        if self.source == "texture":
            lod.set_texels(np.ascontiguousarray(self.texture[::-1]))
        return lod


def _share(value: Any, what: str) -> float:
    number = finite_number(value, what)
    if not 0.0 <= number <= 1.0:
        raise StyleError(f"{what} must lie between 0 and 1, but it is {number:g}.")
    return number


def _tuples(styles: Any) -> tuple[tuple[float, NetworkStyle], ...]:
    if isinstance(styles, NetworkStyle):
        return ((0.0, styles),)
    if not is_listed(styles) or not 1 <= len(styles) <= MOST_LOD_STYLES:
        raise StyleError(
            f"styles of a NetworkCategory must be a NetworkStyle or 1 to {MOST_LOD_STYLES} pairs (lod, style)."
        )
    tuples = []
    for pair in styles:
        if not is_listed(pair) or len(pair) != 2 or not isinstance(pair[1], NetworkStyle):
            raise StyleError(f"{pair!r} is no pair of a level of detail and a NetworkStyle.")
        tuples.append((_share(pair[0], "lod"), pair[1]))
    if any(a[0] >= b[0] for a, b in itertools.pairwise(tuples)):
        raise StyleError("The levels of detail of a NetworkCategory must rise from style to style.")
    return tuple(tuples)


def _texture(texture: Any) -> NDArray[np.uint8]:
    array = np.asarray(texture)
    if array.ndim != 3 or array.shape[2] != 4 or array.dtype != np.uint8 or not array.size:
        raise StyleError(
            "texture must be an array (rows, columns, 4) of bytes, but it has the shape"
            f" {array.shape} and {array.dtype}."
        )
    return np.ascontiguousarray(array)


def _sketch(sketch: Any) -> tuple[float, float]:
    if not is_listed(sketch) or len(sketch) != 2 or not all(map(is_number, sketch)) or sketch[1] <= 0.0:
        raise StyleError(f"sketch must be (amplitude, length), such as (0.2, 30), but it is {sketch!r}.")
    return _share(sketch[0], "sketch amplitude"), float(sketch[1])


def _drop_off(cap: Any, grade: int) -> NDArray[np.uint8]:
    array = np.asarray(cap)
    if array.dtype.kind not in "fiu" or array.shape != (DROP_OFF_SIDE, DROP_OFF_SIDE):
        raise StyleError(
            f"cap {cap!r} of grade {grade} is none. Give 'round', 'square', 'butt' or an array"
            f" ({DROP_OFF_SIDE}, {DROP_OFF_SIDE}) from 0 to 1."
        )
    if array.dtype.kind == "f":
        array = np.rint(255.0 * np.clip(array, 0.0, 1.0))
    return np.ascontiguousarray(array.astype(np.uint8))


def _added(texture: NDArray[np.uint8], first: int, added: dict[int, int], add: Any) -> int:
    """The place of an array among those added; the same array is added once."""
    key = id(texture)
    if key not in added:
        added[key] = first + sum(1 for other in added if other >= 0)
        add(texture)
    return added[key]


def _lod_texels(texture: Any) -> NDArray[np.uint8]:
    array = np.asarray(texture)
    if array.ndim != 2 or not array.size or array.dtype.kind not in "fiub":
        raise StyleError(f"Lod texture must be an array (rows, columns), but its shape is {array.shape}.")
    if array.dtype != np.uint8:
        if not np.isfinite(array).all() or array.min() < 0.0 or array.max() > 1.0:
            raise StyleError("Lod texture must hold bytes, or numbers from 0 to 1.")
        array = np.rint(255.0 * array).astype(np.uint8)
    return array


def _route_points(route: Any) -> NDArray[np.float64]:
    points = np.asarray(getattr(route, "coords", route), dtype=np.float64)
    if points.ndim != 2 or points.shape[1] < 2 or len(points) < 2 or not np.isfinite(points).all():
        raise StyleError("A route must be a line of at least two finite points x, y.")
    return points[:, :2]


def _distances(
    x: NDArray[np.float64], y: NDArray[np.float64], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Of each place of a grid to the nearest segment."""
    nearest = np.full((len(y), len(x)), np.inf)
    for (ax, ay), (bx, by) in itertools.pairwise(points):
        dx, dy = bx - ax, by - ay
        length2 = max(dx * dx + dy * dy, 1e-300)
        share = np.clip(((x[None, :] - ax) * dx + (y[:, None] - ay) * dy) / length2, 0.0, 1.0)
        distance = np.hypot(x[None, :] - ax - share * dx, y[:, None] - ay - share * dy)
        np.minimum(nearest, distance, out=nearest)
    return nearest
