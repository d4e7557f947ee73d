"""What a layer is composed of: decals, one over the other. A feature is one or two of them.

lines      casings of all features, then strokes of all features
polygons   fills of all features, then outlines of all; or each fill with its outline
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .contract import BoolArray, FillLike, FloatArray, IntArray, LayerLike, SceneLike, StrokeLike


@dataclass(frozen=True)
class FillDecals:
    """Fills of a layer. drawn: mask (features,); place: (features,) among the layer's decals, 0 at the bottom."""

    fill: FillLike
    drawn: BoolArray
    place: IntArray


@dataclass(frozen=True)
class StrokeDecals:
    """Strokes, casings or outlines of a layer.

    drawn, place: as of fills. half_widths: (features,) in the stroke's units. side: "normal", or which side of the
    rings is left of outlines, "inset" or "offset", whose half widths are whole widths.
    """

    stroke: StrokeLike
    drawn: BoolArray
    place: IntArray
    half_widths: FloatArray
    side: str


def decals_of(layer: LayerLike, only: BoolArray | None = None) -> Iterator[FillDecals | StrokeDecals]:
    """The decals of a layer that show anything. only: mask (features,) of the features to look at, else all."""
    rank = _ranks(layer)
    count = len(rank)
    wanted = np.ones(count, dtype=np.bool_) if only is None else only
    lines = layer.features.kind == "lines"
    below, above = rank, rank + count
    if not lines and layer.outline_order == "feature":
        below, above = 2 * rank, 2 * rank + 1
    if not lines and layer.fill is not None:
        drawn = wanted & (_alpha(layer.fill.colors) > 0)
        if drawn.any():
            yield FillDecals(layer.fill, drawn, below)
    side = "normal" if lines else layer.outline_mode
    for stroke, place in ((layer.casing if lines else None, below), (layer.stroke, above)):
        if stroke is None:
            continue
        widths = np.asarray(stroke.widths, dtype=np.float64)
        drawn = wanted & (_alpha(stroke.colors) > 0) & (widths > 0)
        if drawn.any():
            yield StrokeDecals(stroke, drawn, place, widths / 2 if side == "normal" else widths, side)


def follows_slopes(scene: SceneLike) -> bool:
    """Whether anything in a scene looks different on slopes."""
    return follows_view(scene) or any(
        style.slope_correction != "none" for stroke in _strokes(scene) for style in stroke.styles
    )


def follows_view(scene: SceneLike) -> bool:
    """Whether any stroke in a scene has a width on the screen."""
    return any(stroke.follows_view for stroke in _strokes(scene))


def _strokes(scene: SceneLike) -> list[StrokeLike]:
    return [stroke for layer in scene.layers for stroke in (layer.casing, layer.stroke) if stroke is not None]


def _alpha(colors: object) -> IntArray:
    return np.asarray(colors, dtype=np.int64).reshape(-1, 4)[:, 3]


def _ranks(layer: LayerLike) -> IntArray:
    """Rank (features,) of each feature in its layer's draw order, 0 at the bottom."""
    order = np.asarray(layer.draw_order, dtype=np.int64)
    ranks = np.empty(len(order), dtype=np.int64)
    ranks[order] = np.arange(len(order))
    return ranks
