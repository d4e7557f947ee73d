"""A scene: a terrain, how it looks, and the layers over it from bottom to top."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .camera import Camera
from .coloring import Coloring, resolve_colors
from .errors import InputError, StyleError, UnsupportedError, close_matches
from .features import FeatureTable, read_features

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from ._sources import Attributes
    from .frame import Frame
    from .renderer import Renderer
    from .terrain import Terrain

Technique = Literal["auto", "static"]


@dataclass(frozen=True)
class Relief:
    """How the bare terrain looks.

    color: its colour where there is no `cmap`.
    cmap, vmin, vmax: colours by height in metres (after exaggeration); by default from the lowest to the highest.
    azimuth, altitude: where the light comes from, degrees clockwise from north and above the horizon.
    strength: of the hillshade, 0 for none. Level ground keeps its colour at any strength.
    on_layers: the share of the hillshade, 0 to 1, that the layers take on too. 0 shows their exact colours.
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
            if not np.isfinite(getattr(self, name)):
                raise InputError(f"Relief {name} must be a finite number, but it is {getattr(self, name)!r}.")
        if not 0.0 < self.altitude <= 90.0:
            raise InputError(f"Relief altitude must lie above 0 and up to 90 degrees, but it is {self.altitude}.")
        if self.strength < 0.0 or not 0.0 <= self.on_layers <= 1.0:
            raise InputError("Relief strength must be 0 or more, and on_layers from 0 to 1.")


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer of a scene, ready to draw.

    features: the geometry on the scene's plane.
    colors: uint8 (features, 4), sRGB with straight alpha; alpha 0 is not drawn and has no id.
    widths: float64 (features), metres on the map plane; zeros for polygons.
    draw_order: int64 (features), features from bottom to top.
    coloring: how the colours came about, for legends.
    """

    name: str
    index: int
    features: FeatureTable
    colors: NDArray[np.uint8] = field(repr=False)
    widths: NDArray[np.float64] = field(repr=False)
    draw_order: NDArray[np.int64] = field(repr=False)
    coloring: Coloring = field(repr=False)

    @property
    def kind(self) -> str:
        """"polygons" or "lines"."""
        return self.features.kind


class Scene:
    """A terrain and its layers.

    terrain: what everything lies on; its CRS is the scene's.
    exaggeration: heights are drawn this many times as high.
    relief: how bare terrain looks.
    """

    def __init__(self, terrain: Terrain, exaggeration: float = 1.0, relief: Relief | None = None) -> None:
        if not np.isfinite(exaggeration) or exaggeration < 0.0:
            raise InputError(f"exaggeration must be a finite factor, zero or more, but it is {exaggeration!r}.")
        self.terrain = terrain
        self.exaggeration = float(exaggeration)
        self.relief = Relief() if relief is None else relief
        self._layers: list[Layer] = []
        self._heights: NDArray[np.float32] | None = None
        self._renderer: Renderer | None = None

    def __repr__(self) -> str:
        names = ", ".join(layer.name for layer in self._layers)
        return f"Scene({self.terrain!r}, layers=[{names}])"

    @property
    def layers(self) -> tuple[Layer, ...]:
        """The layers, bottom to top."""
        return tuple(self._layers)

    @property
    def heights(self) -> NDArray[np.float32]:
        """The heights that are drawn, float32 (rows, columns) metres: exaggerated, then rounded; NaN: none."""
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
        missing_kwds: Mapping[str, Any] | None = None,
        order: Any = "feature",
        technique: Technique = "auto",
    ) -> Layer:
        """Adds a layer of polygons on top of the others.

        data: whatever `decalgl.features.read_features` reads; inside is even-odd over all rings of a feature.
        column ... missing_kwds: colours, as in `GeoDataFrame.plot`.
        order: "feature" (later on top), "size" (larger on top), or a column or numbers (higher on top).

        Raises CrsError, FileError, ColumnError, StyleError and InputError, which leave the scene as it was.
        """
        name = self._layer_name(name, "polygons")
        _require_technique(technique)
        table, attributes = read_features(
            data, "polygons", terrain_crs=self.terrain.crs, layer_name=name, crs=crs, layer=layer
        )
        coloring = resolve_colors(
            attributes.count, attributes, color=color, column=column, cmap=cmap, vmin=vmin, vmax=vmax, norm=norm,
            alpha=alpha, categorical=categorical, legend=legend, missing_kwds=missing_kwds, rows=table.rows,
        )  # fmt: skip
        return self._add(name, table, attributes, coloring, np.zeros(len(table)), order)

    def add_lines(
        self,
        data: Any,
        *,
        width: Any = 1.0,
        width_units: Literal["m", "px"] = "px",
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
        missing_kwds: Mapping[str, Any] | None = None,
        corner: str = "round",
        cap: str = "round",
        order: Any = "feature",
        technique: Technique = "auto",
    ) -> Layer:
        """Adds a layer of lines on top of the others.

        width: one number, one for each row, or a column's name.
        width_units: "m", metres on the map plane. "px", pixels on the screen, is not drawn by this version.
        corner, cap: "round".
        order: "feature" (later on top), "size" (longer on top), or a column or numbers (higher on top).
        The other arguments, and the errors, are those of `add_polygons`; StyleError too for widths that are not
        positive, UnsupportedError for what this version does not draw.
        """
        name = self._layer_name(name, "lines")
        _require_technique(technique)
        _require_line_style(width_units, corner, cap)
        table, attributes = read_features(
            data, "lines", terrain_crs=self.terrain.crs, layer_name=name, crs=crs, layer=layer
        )
        coloring = resolve_colors(
            attributes.count, attributes, color=color, column=column, cmap=cmap, vmin=vmin, vmax=vmax, norm=norm,
            alpha=alpha, categorical=categorical, legend=legend, missing_kwds=missing_kwds, rows=table.rows,
        )  # fmt: skip
        return self._add(name, table, attributes, coloring, _widths(width, table, attributes, name), order)

    def home(self) -> Camera:
        """A camera that shows the whole terrain obliquely from the south."""
        x0, y0, x1, y1 = self.terrain.bounds
        finite = self.heights[np.isfinite(self.heights)]
        middle = float(np.median(finite)) if finite.size else 0.0
        reach = max(x1 - x0, y1 - y0, 1.0)
        return Camera.orbit(((x0 + x1) / 2, (y0 + y1) / 2, middle), 1.25 * reach, azimuth=180.0, elevation=40.0)

    def render(
        self,
        camera: Camera,
        size: tuple[int, int] = (1280, 720),
        antialias: str = "coverage",
        background: Any = "sky",
        progress: Callable[[str, float], bool | None] | None = None,
        **renderer: Any,
    ) -> Frame:
        """A picture of the scene: `Renderer`'s three stages in one call.

        The renderer is kept, so a second picture only draws. `renderer`: other arguments of `Renderer`.
        """
        from .renderer import Renderer

        if self._renderer is None or self._renderer.keywords != renderer:
            self._renderer = Renderer(size=size, antialias=antialias, **renderer)
        self._renderer.set_picture(size, antialias)
        self._renderer.preprocess(self, progress=progress)
        self._renderer.update(camera)
        return self._renderer.render(background=background)

    def _layer_name(self, name: str | None, kind: str) -> str:
        return f"{kind} {len(self._layers)}" if name is None else str(name)

    def _add(
        self,
        name: str,
        table: FeatureTable,
        attributes: Attributes,
        coloring: Coloring,
        widths: NDArray[np.float64],
        order: Any,
    ) -> Layer:
        draw_order = _draw_order(order, table, attributes)
        layer = Layer(name, len(self._layers), table, coloring.colors, widths, draw_order, coloring)
        self._layers.append(layer)
        return layer


def _require_technique(technique: str) -> None:
    if technique not in ("auto", "static"):
        raise UnsupportedError(f"technique={technique!r} is not drawn by this version; use 'auto' or 'static'.")


def _require_line_style(width_units: str, corner: str, cap: str) -> None:
    if width_units == "px":
        raise UnsupportedError(
            "Widths in pixels are not drawn by this version. Give the width on the ground: width=..., width_units='m'."
        )
    if width_units != "m":
        raise StyleError(f"width_units must be 'm' or 'px', but it is {width_units!r}.")
    for name, value, known in (("corner", corner, ("round", "miter", "bevel")), ("cap", cap, ("round", "butt", "square"))):
        if value not in known:
            raise StyleError(f"There is no {name}={value!r}.{close_matches(value, known)} Known: {', '.join(known)}.")
        if value != "round":
            raise UnsupportedError(f"{name}={value!r} is not drawn by this version; use 'round'.")


def _widths(width: Any, table: FeatureTable, attributes: Attributes, layer_name: str) -> NDArray[np.float64]:
    widths = attributes.numbers(width, "width")[table.rows]
    wrong = np.flatnonzero(~(np.isfinite(widths) & (widths > 0.0)))
    if wrong.size:
        raise StyleError(
            f"Layer {layer_name!r}, row {table.rows[wrong[0]]}: width {widths[wrong[0]]:g} is not a positive length. "
            "Give every line a width above 0 metres."
        )
    return widths


def _draw_order(order: Any, table: FeatureTable, attributes: Attributes) -> NDArray[np.int64]:
    if isinstance(order, str) and order == "feature":
        return np.arange(len(table), dtype=np.int64)
    by_size = isinstance(order, str) and order == "size" and "size" not in attributes.names
    keys = table.sizes() if by_size else attributes.numbers(order, "order")[table.rows]
    return np.argsort(keys, kind="stable").astype(np.int64)
