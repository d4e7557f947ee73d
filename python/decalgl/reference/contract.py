"""What the reference reads of a scene and a camera, as structural types.

The reference shares no code with the renderer. It only names the attributes that it reads, so
that `decalgl.Scene` and `decalgl.Camera` fit as they are, and so do plain stand-ins in tests.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Sequence

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
Size: TypeAlias = tuple[int, int]
Crop: TypeAlias = tuple[int, int, int, int]


class TerrainLike(Protocol):
    """Where the samples sit: sample (row, column) at (x0 + column*dx, y0 - row*dy), metres."""

    @property
    def x0(self) -> float: ...
    @property
    def y0(self) -> float: ...
    @property
    def dx(self) -> float: ...
    @property
    def dy(self) -> float: ...


class FeaturesLike(Protocol):
    """Ragged geometry: coords (n, 2) split into parts, parts into features; rows (features,)."""

    @property
    def kind(self) -> str: ...
    @property
    def coords(self) -> FloatArray: ...
    @property
    def part_offsets(self) -> NDArray[np.integer[Any]]: ...
    @property
    def feature_offsets(self) -> NDArray[np.integer[Any]]: ...
    @property
    def rows(self) -> NDArray[np.integer[Any]]: ...


class MarkLike(Protocol):
    """A mark of a pattern: where it lies in the period, metres, and shares of the width at its ends."""

    @property
    def begin(self) -> float: ...
    @property
    def end(self) -> float: ...
    @property
    def begin_width(self) -> float: ...
    @property
    def end_width(self) -> float: ...


class PatternLike(Protocol):
    """Marks that repeat along a line, lengths in metres on the map ("m") or in pixels ("px")."""

    @property
    def period(self) -> float: ...
    @property
    def offset(self) -> float: ...
    @property
    def units(self) -> str: ...
    @property
    def marks(self) -> Sequence[MarkLike]: ...


class BandLike(Protocol):
    """A colour (R, G, B, A bytes) across a line, up to a share of its half width."""

    @property
    def reach(self) -> float: ...
    @property
    def color(self) -> Sequence[int]: ...


class StyleLike(Protocol):
    """What strokes share: words as in `decalgl.strokes`, the miter limit in degrees."""

    @property
    def corner(self) -> str: ...
    @property
    def cap(self) -> str: ...
    @property
    def miter_limit(self) -> float: ...
    @property
    def slope_correction(self) -> str: ...
    @property
    def pattern(self) -> PatternLike | None: ...
    @property
    def bands(self) -> Sequence[BandLike]: ...


class LimitsLike(Protocol):
    """What a width is kept between: pixels, and metres seen head-on."""

    @property
    def least_px(self) -> float: ...
    @property
    def most_px(self) -> float: ...
    @property
    def least_metres(self) -> float: ...
    @property
    def most_metres(self) -> float: ...


class StrokeLike(Protocol):
    """Colours (features, 4) uint8 straight alpha, widths (features,) and their units, each feature's style.

    Limits hold for what is left of widths without margins (features,).
    """

    @property
    def colors(self) -> NDArray[np.uint8]: ...
    @property
    def widths(self) -> FloatArray: ...
    @property
    def styles(self) -> Sequence[StyleLike]: ...
    @property
    def style_of(self) -> NDArray[np.integer[Any]] | None: ...
    @property
    def units(self) -> str: ...
    @property
    def limits(self) -> LimitsLike: ...
    @property
    def margins(self) -> FloatArray | None: ...
    @property
    def follows_view(self) -> bool: ...


class HatchLike(Protocol):
    """Parallel lines in place of an even fill: metres, and degrees from east to the left."""

    @property
    def spacing(self) -> float: ...
    @property
    def width(self) -> float: ...
    @property
    def angle(self) -> float: ...
    @property
    def crossed(self) -> bool: ...


class FillLike(Protocol):
    """Colours (features, 4) uint8 straight alpha, each feature's hatch; None is an even fill."""

    @property
    def colors(self) -> NDArray[np.uint8]: ...
    @property
    def hatches(self) -> Sequence[HatchLike | None]: ...
    @property
    def hatch_of(self) -> NDArray[np.integer[Any]] | None: ...


class LayerLike(Protocol):
    """Features, how they look, and their order from bottom to top."""

    @property
    def features(self) -> FeaturesLike: ...
    @property
    def fill(self) -> FillLike | None: ...
    @property
    def stroke(self) -> StrokeLike | None: ...
    @property
    def casing(self) -> StrokeLike | None: ...
    @property
    def outline_mode(self) -> str: ...
    @property
    def outline_order(self) -> str: ...
    @property
    def draw_order(self) -> NDArray[np.integer[Any]]: ...


class SceneLike(Protocol):
    """A heightfield, heights (rows, columns) in metres with NaN as holes, and layers bottom to top."""

    @property
    def heights(self) -> NDArray[np.floating[Any]]: ...
    @property
    def terrain(self) -> TerrainLike: ...
    @property
    def layers(self) -> Sequence[LayerLike]: ...


class CameraLike(Protocol):
    """Eye, target and up in scene coordinates; fov in degrees, or None when orthographic."""

    @property
    def eye(self) -> Sequence[float] | FloatArray: ...
    @property
    def target(self) -> Sequence[float] | FloatArray: ...
    @property
    def up(self) -> Sequence[float] | FloatArray: ...
    @property
    def fov(self) -> float | None: ...
    @property
    def view_height(self) -> float | None: ...
