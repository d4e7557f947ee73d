"""How a layer's lines and fills look once all styling arguments are resolved: what the core is given.

Each feature has a colour and a width of its own; whatever else there is to a style is shared by many features,
kept once, and named by its place.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from ._values import finite_number, flag
from .errors import StyleError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

CornerStyle = Literal["round", "miter", "bevel"]
CapStyle = Literal["round", "butt", "square"]
SlopeCorrection = Literal["none", "thoeny", "tangent"]
OutlineMode = Literal["normal", "inset", "offset"]
OutlineOrder = Literal["layer", "feature"]
WidthUnits = Literal["m", "px"]
MITER_LIMIT = 40.0


@dataclass(frozen=True)
class PatternMark:
    """A trapezoid along a line: lengths from the period's beginning, widths as shares of the line's."""

    begin: float
    end: float
    begin_width: float = 1.0
    end_width: float = 1.0


@dataclass(frozen=True)
class LinePattern:
    """Marks that repeat along a line every `period`, `offset` in where it begins.

    units: "m", metres on the map, of strokes with slope correction "tangent" on the ground; "px", pixels: as many
        metres of the map as 2**-k a pixel, where 2**k is the power of two next to how many pixels a metre takes there,
        seen head-on.
    """

    period: float
    marks: tuple[PatternMark, ...]
    offset: float = 0.0
    units: WidthUnits = "m"


@dataclass(frozen=True)
class ColorBand:
    """A colour (R, G, B, A bytes, straight alpha) across a line, to a share `reach` of its half width."""

    reach: float
    color: tuple[int, int, int, int]


@dataclass(frozen=True)
class StrokeStyle:
    """What features of one layer may share of how their lines look.

    miter_limit: degrees between two segments; sharper corners are round.
    bands: colours from the centre line outwards, in place of the feature's own, whose alpha multiplies theirs.
    """

    corner: CornerStyle = "round"
    cap: CapStyle = "round"
    miter_limit: float = MITER_LIMIT
    slope_correction: SlopeCorrection = "none"
    pattern: LinePattern | None = None
    bands: tuple[ColorBand, ...] = ()


@dataclass(frozen=True)
class WidthLimits:
    """What a width is kept between at every depth: pixels, and metres as they are seen head-on."""

    least_px: float = 0.0
    most_px: float = float("inf")
    least_metres: float = 0.0
    most_metres: float = float("inf")


@dataclass(frozen=True, eq=False)
class Stroke:
    """The strokes of a layer's features.

    colors: uint8 (features, 4), sRGB with straight alpha; alpha 0 is not drawn.
    widths: float64 (features), metres on the map plane, or pixels on the screen as `units` says; 0 is not drawn.
    limits: of the widths, whatever their units.
    margins: float64 (features), what of each width the limits do not count: they hold for the rest. None for none.
    styles, style_of: uint32 (features), each feature's place among the styles.
    widest: what strokes may be widened to later without preprocessing; 0 for as wide as they are.
    """

    colors: NDArray[np.uint8] = field(repr=False)
    widths: NDArray[np.float64] = field(repr=False)
    styles: tuple[StrokeStyle, ...] = (StrokeStyle(),)
    style_of: NDArray[np.uint32] | None = field(default=None, repr=False)
    widest: float = 0.0
    units: WidthUnits = "m"
    limits: WidthLimits = WidthLimits()
    margins: NDArray[np.float64] | None = field(default=None, repr=False)

    @property
    def follows_view(self) -> bool:
        """Whether widths on the ground change with the view."""
        return self.units == "px" or self.limits != WidthLimits()

    def __post_init__(self) -> None:
        _lock(self.colors, self.widths, self.style_of, self.margins)


@dataclass(frozen=True)
class Hatch:
    """Parallel lines on the map, in a fill's colour, in place of an even fill.

    spacing: metres from line to line, between their middles. width: metres.
    angle: degrees from east, to the left. crossed: with a second set at right angles.

    Raises StyleError.
    """

    spacing: float
    width: float
    angle: float = 45.0
    crossed: bool = False

    def __post_init__(self) -> None:
        for name in ("spacing", "width"):
            length = finite_number(getattr(self, name), f"Hatch {name}")
            if length <= 0.0:
                raise StyleError(f"Hatch {name} must be a length above 0 in metres, but it is {length:g}.")
            object.__setattr__(self, name, length)
        object.__setattr__(self, "angle", finite_number(self.angle, "Hatch angle"))
        object.__setattr__(self, "crossed", flag(self.crossed, "Hatch crossed"))


@dataclass(frozen=True, eq=False)
class Fill:
    """The fills of a layer's polygons.

    colors: uint8 (features, 4), sRGB with straight alpha; alpha 0 is not drawn.
    hatches, hatch_of: uint32 (features), each feature's place among the hatches; None is an even fill.
    """

    colors: NDArray[np.uint8] = field(repr=False)
    hatches: tuple[Hatch | None, ...] = (None,)
    hatch_of: NDArray[np.uint32] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        _lock(self.colors, self.hatch_of)


def _lock(*arrays: NDArray[np.generic] | None) -> None:
    for array in arrays:
        if array is not None:
            array.flags.writeable = False
