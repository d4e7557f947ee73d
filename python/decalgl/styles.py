"""Looks as users give them to a layer: its colouring, its strokes, casings and outlines.

 casing.width
    |--|
====------====          a line of width 4 with a casing of 2 on each side
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Literal

from .strokes import MITER_LIMIT, WidthUnits

if TYPE_CHECKING:
    from collections.abc import Mapping

WIDTH_LIMITS = ("width_min_px", "width_max_px", "width_min_m", "width_max_m")


@dataclass(frozen=True)
class ColorKeywords:
    """The keywords that colour a layer, as `resolve_colors` takes them."""

    column: Any = None
    cmap: Any = None
    color: Any = None
    vmin: float | None = None
    vmax: float | None = None
    norm: Any = None
    alpha: Any = None
    categorical: bool | None = None
    legend: bool = False
    legend_kwds: Mapping[str, Any] | None = None
    missing_kwds: Mapping[str, Any] | None = None


@dataclass(frozen=True)
class StrokeKeywords:
    """The keywords that shape lines and outlines, as `Scene.add_lines` describes them."""

    width: Any = 1.0
    width_units: WidthUnits = "px"
    corner: Any = "round"
    cap: Any = "round"
    miter_limit: float = MITER_LIMIT
    dash: Any = None
    bands: Any = None
    slope_correction: Literal["thoeny", "tangent"] | None = None
    widest: float | None = None
    width_min_px: float | None = None
    width_max_px: float | None = None
    width_min_m: float | None = None
    width_max_m: float | None = None

    @property
    def follows_view(self) -> bool:
        """Whether widths on the ground change with the view: those in pixels, and limited ones."""
        return self.width_units == "px" or any(getattr(self, name) is not None for name in WIDTH_LIMITS)


@dataclass(frozen=True, eq=False, kw_only=True)
class Casing:
    """A wider stroke under each line of a layer; casings lie under all lines of their layer.

    width: what it shows on each side of the line, in the line's units: one number, one for each row, a column's
        name, or a dict {category: width}. A line of width 6 with a casing of 2 covers 10.
    color ... missing_kwds: as in `Scene.add_lines`; black by default.
    dash: as in `Scene.add_lines`; solid by default, whatever the line is.

    Corners, caps, the miter limit and the slope correction are those of the line.
    """

    width: Any
    color: Any = None
    column: Any = None
    cmap: Any = None
    vmin: float | None = None
    vmax: float | None = None
    norm: Any = None
    alpha: Any = None
    categorical: bool | None = None
    missing_kwds: Mapping[str, Any] | None = None
    dash: Any = None


@dataclass(frozen=True, eq=False, kw_only=True)
class Outline:
    """Strokes along the borders of polygons, holes included.

    width, width_units, width_min_px ... width_max_m, corner, miter_limit, dash, bands, slope_correction, widest: as in
        `Scene.add_lines`.
    color ... missing_kwds: as in `Scene.add_polygons`; black by default.
    mode: "normal", half of the width on each side of the border; "inset" or "offset", the whole width inside or
        outside the polygon.
    order: "layer", all outlines over all fills of the layer; "feature", each over its own fill and under the
        next feature.
    """

    width: Any = 1.0
    width_units: WidthUnits = "px"
    color: Any = None
    column: Any = None
    cmap: Any = None
    vmin: float | None = None
    vmax: float | None = None
    norm: Any = None
    alpha: Any = None
    categorical: bool | None = None
    missing_kwds: Mapping[str, Any] | None = None
    mode: Literal["normal", "inset", "offset"] = "normal"
    order: Literal["layer", "feature"] = "layer"
    corner: Any = "round"
    miter_limit: float = MITER_LIMIT
    dash: Any = None
    bands: Any = None
    slope_correction: Literal["thoeny", "tangent"] | None = None
    widest: float | None = None
    width_min_px: float | None = None
    width_max_px: float | None = None
    width_min_m: float | None = None
    width_max_m: float | None = None


def color_keywords(look: Casing | Outline) -> ColorKeywords:
    """The colouring of a casing or an outline."""
    given = {
        field.name: getattr(look, field.name) for field in fields(ColorKeywords) if hasattr(look, field.name)
    }
    if given["color"] is None and given["column"] is None:
        given["color"] = "black"
    return ColorKeywords(**given)


def stroke_keywords(look: Outline) -> StrokeKeywords:
    """The shape of an outline."""
    given = {
        field.name: getattr(look, field.name) for field in fields(StrokeKeywords) if hasattr(look, field.name)
    }
    return StrokeKeywords(**given)
