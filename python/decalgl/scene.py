"""A scene: a terrain, how it looks, and the layers over it from bottom to top."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _core
from ._choices import LayerRows
from ._colors import colormap, parse_color
from .camera import Camera
from .errors import InputError
from .features import LARGEST_COORDINATE, FeatureTable, Kind, read_features
from .layer import Layer
from .legend import require_drawable
from .strokes import MITER_LIMIT
from .styles import ColorKeywords, StrokeKeywords
from .styling import WIDEST_LINE, LineKeywords, PolygonKeywords
from .techniques import Technique, resolve_technique
from .terrain import Terrain

__all__ = ["Layer", "Relief", "Scene"]

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from ._sources import Attributes
    from .frame import Frame
    from .renderer import Renderer
    from .strokes import WidthUnits
    from .styles import Casing, Outline


@dataclass(frozen=True)
class Relief:
    """How the bare terrain looks.

    color: its colour where there is no `cmap`.
    cmap, vmin, vmax: colours by height in metres (after exaggeration), by default from the lowest height to
        the highest.
    azimuth, altitude: where the light comes from, degrees clockwise from north and above the horizon.
    strength: of the hillshade, 0 for none. Level ground keeps its colour at any strength.
    on_layers: the share of the hillshade, 0 to 1, that the layers take on too. 0 shows their exact colours.

    Raises InputError, and StyleError for unknown colours and colormaps.
    """

    color: Any = "#e9e5dc"
    cmap: Any = None
    vmin: float | None = None
    vmax: float | None = None
    azimuth: float = 315.0
    altitude: float = 45.0
    strength: float = 0.6
    on_layers: float = 0.0

    def __post_init__(self) -> None:
        for name in ("azimuth", "altitude", "strength", "on_layers"):
            object.__setattr__(self, name, _finite(getattr(self, name), f"Relief {name}"))
        for name in ("vmin", "vmax"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _finite(getattr(self, name), f"Relief {name}"))
        if not 0.0 < self.altitude <= 90.0:
            raise InputError(
                f"Relief altitude must lie above 0 and up to 90 degrees, but it is {self.altitude}."
            )
        if self.strength < 0.0 or not 0.0 <= self.on_layers <= 1.0:
            raise InputError("Relief strength must be 0 or more, and on_layers from 0 to 1.")
        if self.vmin is not None and self.vmax is not None and self.vmin >= self.vmax:
            raise InputError(f"Relief vmin must lie below vmax, but they are {self.vmin} and {self.vmax}.")
        # As a plain tuple, so that two reliefs compare by value.
        object.__setattr__(self, "color", parse_color(self.color))
        if self.cmap is not None:
            object.__setattr__(self, "cmap", colormap(self.cmap))


class Scene:
    """A terrain and its layers.

    terrain: what everything lies on; its CRS is the scene's.
    exaggeration: heights are drawn this many times as high.
    relief: how bare terrain looks; it may be exchanged at any time.

    Raises InputError for a terrain that cannot be drawn (no finite height, beyond 1e9 m).
    """

    def __init__(self, terrain: Terrain, exaggeration: float = 1.0, relief: Relief | None = None) -> None:
        if not isinstance(terrain, Terrain):
            raise InputError(
                f"A scene needs a Terrain, not a {type(terrain).__name__}. Make one with Terrain.open,"
                " Terrain.from_array or Terrain.flat."
            )
        self._terrain = terrain
        self._exaggeration = _checked_exaggeration(terrain, exaggeration)
        self.relief = Relief() if relief is None else relief
        self._layers: list[Layer] = []
        self._heights: NDArray[np.float32] | None = None
        self._renderer: Renderer | None = None

    def __repr__(self) -> str:
        names = ", ".join(layer.name for layer in self._layers)
        return f"Scene({self.terrain!r}, layers=[{names}])"

    @property
    def terrain(self) -> Terrain:
        """What everything lies on."""
        return self._terrain

    @property
    def exaggeration(self) -> float:
        """Heights are drawn this many times as high."""
        return self._exaggeration

    @property
    def relief(self) -> Relief:
        """How bare terrain looks."""
        return self._relief

    @relief.setter
    def relief(self, relief: Relief) -> None:
        if not isinstance(relief, Relief):
            raise InputError(f"relief must be a Relief, not a {type(relief).__name__}.")
        self._relief = relief

    @property
    def layers(self) -> tuple[Layer, ...]:
        """The layers, bottom to top."""
        return tuple(self._layers)

    @property
    def heights(self) -> NDArray[np.float32]:
        """What is drawn, float32 (rows, columns) metres: exaggerated, then rounded; NaN is a hole."""
        if self._heights is None:
            scaled = self.terrain.z.astype(np.float64) * self.exaggeration
            self._heights = scaled.astype(np.float32)
            self._heights.setflags(write=False)
        return self._heights

    def add_polygons(
        self,
        data: Any,
        *,
        name: str | None = None,
        layer: str | int | None = None,
        crs: Any = None,
        column: Any = None,
        cmap: Any = None,
        color: Any = None,
        vmin: float | None = None,
        vmax: float | None = None,
        norm: Any = None,
        alpha: Any = None,
        categorical: bool | None = None,
        legend: bool = False,
        legend_kwds: Mapping[str, Any] | None = None,
        missing_kwds: Mapping[str, Any] | None = None,
        hatch: Any = None,
        outline: Outline | None = None,
        order: Any = "feature",
        technique: str | Technique = "auto",
    ) -> Layer:
        """Adds a layer of polygons on top of the others.

        data: whatever `decalgl.features.read_features` reads; inside is even-odd over all rings of a feature.
        name: of the layer, for messages and legends. layer: the one to read of a file with several.
        crs: of data that carries none.
        column ... missing_kwds: colours, as in `GeoDataFrame.plot`; color="none" for outlines alone.
        legend, legend_kwds: whether `Frame.save` draws a legend, and how, as in `GeoDataFrame.plot`.
        hatch: a `Hatch` in place of an even fill; or one (or None) for each row, the name of a column of them, or
            a dict {category: hatch} by the categories of `column`.
        outline: an `Outline`.
        order: "feature" (later on top), "size" (larger on top), or a column or numbers (higher on top,
            missing ones at the bottom). Columns named "feature" or "size" must be given as numbers.
        technique: who draws the layer: "auto", a name or a `Technique` with its choices (`decalgl.techniques`).
            Neighbouring layers of one technique are one pass; between passes only colour and coverage are known.
            Outlines with widths on the screen are a pass over that of the fills.

        Raises CrsError, FileError, ColumnError, StyleError and InputError, which leave the scene as it was.
        """
        colors = ColorKeywords(
            column, cmap, color, vmin, vmax, norm, alpha, categorical, legend, legend_kwds, missing_kwds
        )
        looks = PolygonKeywords(colors, hatch, outline)
        return self._add("polygons", data, name, layer, crs, looks, order, technique)

    def add_lines(
        self,
        data: Any,
        *,
        width: Any = 1.0,
        width_units: WidthUnits = "px",
        name: str | None = None,
        layer: str | int | None = None,
        crs: Any = None,
        column: Any = None,
        cmap: Any = None,
        color: Any = None,
        vmin: float | None = None,
        vmax: float | None = None,
        norm: Any = None,
        alpha: Any = None,
        categorical: bool | None = None,
        legend: bool = False,
        legend_kwds: Mapping[str, Any] | None = None,
        missing_kwds: Mapping[str, Any] | None = None,
        corner: Any = "round",
        cap: Any = "round",
        miter_limit: float = MITER_LIMIT,
        dash: Any = None,
        casing: Casing | None = None,
        bands: Any = None,
        slope_correction: Literal["thoeny", "tangent"] | None = None,
        widest: float | None = None,
        width_min_px: float | None = None,
        width_max_px: float | None = None,
        width_min_m: float | None = None,
        width_max_m: float | None = None,
        order: Any = "feature",
        technique: str | Technique = "auto",
    ) -> Layer:
        """Adds a layer of lines on top of the others.

        width: one number, one for each row, a column's name, or a dict {category: width} by the categories of
            `column`. width_units: "m", metres on the map plane; "px", pixels on the screen at every zoom.
        width_min_px ... width_max_m: what widths are kept between, in pixels, or in metres as they are seen head-on.
        corner: "round", "miter" or "bevel". cap: "round", "butt" or "square". Each is one for all, one for each
            row, a column's name, or a dict by category.
        miter_limit: degrees between two segments; sharper corners than that are round.
        dash: "dashed", "dotted" or "dashdot", matplotlib's, as multiples of each line's width; lengths on, off, on,
            ... in the units of the width, such as (10, 5), or (offset, (10, 5)); or a `Pattern`. As `corner`, by row or
            category. Lengths in pixels are those on the screen to within a factor of the square root of two.
        casing: a `Casing` under the lines.
        bands: colours across the line, [(reach, colour), ...] from its middle outwards, each to a share of the half
            width, the last to 1. They take the place of the line's colour, whose opacity they keep.
        slope_correction: None, widths and lengths of dashes as they are on the map; "tangent", as they are on the
            slope; "thoeny", widths narrower on slopes seen from the side (Thöny 2018).
        widest: metres that lines may be widened to later without preparing anew.
        order: "feature" (later on top), "size" (longer on top), or a column or numbers (higher on top,
            features without one lowest).
        The other arguments, and the errors, are those of `add_polygons`; StyleError too for widths that are
        not positive, UnsupportedError for what this version does not draw.
        """
        if isinstance(technique, Technique) and technique.names_widths:
            width, width_units = 1.0, "m"
        colors = ColorKeywords(
            column, cmap, color, vmin, vmax, norm, alpha, categorical, legend, legend_kwds, missing_kwds
        )
        stroke = StrokeKeywords(
            width,
            width_units,
            corner,
            cap,
            miter_limit,
            dash,
            bands,
            slope_correction,
            widest,
            width_min_px,
            width_max_px,
            width_min_m,
            width_max_m,
        )
        looks = LineKeywords(colors, stroke, casing)
        return self._add("lines", data, name, layer, crs, looks, order, technique)

    def home(self) -> Camera:
        """A camera that shows the whole terrain obliquely from the south."""
        x0, y0, x1, y1 = self.terrain.bounds
        finite = self.heights[np.isfinite(self.heights)]
        middle = float(np.median(finite)) if finite.size else 0.0
        distance = 1.25 * max(x1 - x0, y1 - y0, 1.0)
        return Camera.orbit(((x0 + x1) / 2, (y0 + y1) / 2, middle), distance, azimuth=180.0, elevation=40.0)

    def render(
        self,
        camera: Camera,
        size: tuple[int, int] = (1280, 720),
        antialias: str = "coverage",
        background: Any = "sky",
        progress: Callable[[str, float], bool | None] | None = None,
        cache: str | os.PathLike[str] | None = None,
        **renderer: Any,
    ) -> Frame:
        """A picture of the scene: `Renderer`'s three stages in one call.

        The renderer is kept, so a second picture only draws. `renderer`: other arguments of `Renderer`.
        progress, cache: as in `Renderer.preprocess`.
        Raises what `Renderer` raises; the scene stays as it was, and so does an earlier frame.
        """
        from .renderer import Renderer, drawn_background

        drawn_background(background)  # before minutes of preprocessing
        if self._renderer is None or not self._renderer.has_options(renderer):
            self._renderer = Renderer(size=size, antialias=antialias, **renderer)
        self._renderer.set_picture(size, antialias)
        self._renderer.preprocess(self, progress=progress, cache=cache)
        self._renderer.update(camera)
        return self._renderer.render(background=background)

    def _add(
        self,
        kind: Kind,
        data: Any,
        name: str | None,
        file_layer: str | int | None,
        crs: Any,
        looks: LineKeywords | PolygonKeywords,
        order: Any,
        technique: str | Technique,
    ) -> Layer:
        name = f"{kind} {len(self._layers)}" if name is None else str(name)
        looks.check(name)
        chosen = resolve_technique(technique, name, looks.follows_view)
        table, attributes = read_features(
            data, kind, terrain_crs=self.terrain.crs, layer_name=name, crs=crs, layer=file_layer
        )
        x0, y0, x1, y1 = self.terrain.bounds
        widest = WIDEST_LINE * (max(x1 - x0, y1 - y0) or 1.0)
        resolved = looks.resolve(LayerRows(name, attributes, table.rows, widest))
        draw_order = draw_order_of(order, table, attributes)
        layer = Layer(
            name,
            len(self._layers),
            table,
            draw_order,
            technique=chosen.bound_to(name, table.rows, attributes),
            **vars(resolved),
            attributes=attributes,
        )
        if layer.coloring.legend:
            require_drawable(layer)
        self._layers.append(layer)
        return layer


def _finite(value: Any, what: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what} must be a number, but it is {value!r}.") from error
    if not np.isfinite(number):
        raise InputError(f"{what} must be a finite number, but it is {number}.")
    return number


def _checked_exaggeration(terrain: Terrain, exaggeration: Any) -> float:
    """The factor, after a look at whether the terrain can be drawn with it."""
    factor = _finite(exaggeration, "exaggeration")
    if factor < 0.0:
        raise InputError(f"exaggeration must be zero or more, but it is {factor}.")
    if max(map(abs, terrain.bounds)) > LARGEST_COORDINATE:
        raise InputError(
            f"The terrain's bounds {terrain.bounds} reach farther than {LARGEST_COORDINATE:g} m from the"
            " origin. Check its transform and its CRS."
        )
    lowest, highest = np.fmin.reduce(terrain.z, axis=None), np.fmax.reduce(terrain.z, axis=None)
    if np.isnan(lowest):
        raise InputError(
            "The terrain has no finite height, so there is nothing to draw. Check its nodata value."
        )
    if max(abs(float(lowest)), abs(float(highest))) * factor > LARGEST_COORDINATE:
        raise InputError(
            f"The terrain's heights, from {lowest:g} to {highest:g} m, drawn {factor:g} times as high, reach"
            f" beyond {LARGEST_COORDINATE:g} m. Name the value that marks holes with nodata=, or lower the"
            " exaggeration."
        )
    return factor


def draw_order_of(order: Any, table: FeatureTable, attributes: Attributes) -> NDArray[np.int64]:
    """Features from bottom to top: "feature", "size", a column or numbers. Raises ColumnError, InputError."""
    if isinstance(order, str) and order == "feature":
        return np.arange(len(table), dtype=np.int64)
    if isinstance(order, str) and order == "size":
        return _core.ascending(table.sizes())
    return draw_order_by(order, table.rows, attributes)


def draw_order_by(order: Any, rows: NDArray[np.int64], attributes: Attributes) -> NDArray[np.int64]:
    """Features from bottom to top by a column or numbers, one a row. Raises ColumnError, InputError."""
    return _core.ascending(attributes.numbers(order, "order")[rows])
