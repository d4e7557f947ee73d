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


class LayerLike(Protocol):
    """Features with colours (features, 4) uint8 straight alpha, widths in metres, draw order."""

    @property
    def features(self) -> FeaturesLike: ...
    @property
    def colors(self) -> NDArray[np.uint8]: ...
    @property
    def widths(self) -> FloatArray: ...
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


def visible_features(layer: LayerLike) -> BoolArray:
    """Mask (features,): features with alpha 0 are not drawn and have no id."""
    return np.asarray(layer.colors, dtype=np.uint8).reshape(-1, 4)[:, 3] > 0


def draw_ranks(layer: LayerLike) -> IntArray:
    """Rank (features,) of each feature in its layer's draw order, 0 at the bottom."""
    order = np.asarray(layer.draw_order, dtype=np.int64)
    ranks = np.empty(len(order), dtype=np.int64)
    ranks[order] = np.arange(len(order))
    return ranks
