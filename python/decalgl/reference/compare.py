"""How far a picture is from the reference, in plain numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .contract import BoolArray, FloatArray
    from .picture import Overlay

# Alpha of the reference this close to 0 or 1 is rounding of a mean.
WHOLE = 1e-9


@dataclass(frozen=True)
class IdComparison:
    """Differences of ids at pixel centres.

    pixels: compared. wrong: pixels whose id or layer differs, of which `missing` were expected to have
    a feature and have none, `extra` the other way round. mask: (h, w) the wrong pixels.
    farthest: largest distance in metres of a wrong pixel from an edge, 0 if none is wrong, NaN if the
    distances were not given.
    """

    pixels: int
    wrong: int
    missing: int
    extra: int
    mask: BoolArray
    farthest: float


@dataclass(frozen=True)
class OverlayComparison:
    """Differences of a filtered overlay, premultiplied, 0..1.

    pixels: compared; partial: of which partly covered (alpha between 0 and 1, or samples that differ).
    rms, p99, maximum: over partial pixels, of the channel that differs most. alpha_rms, alpha_p99,
    alpha_maximum: the same of alpha alone. leak: largest lack of alpha where features cover all of the
    pixel opaquely. image_rms, image_maximum: over all compared pixels, of the channel that differs most.
    worst: (row, column) of the largest difference, (-1, -1) if nothing was compared.
    """

    pixels: int
    partial: int
    rms: float
    p99: float
    maximum: float
    alpha_rms: float
    alpha_p99: float
    alpha_maximum: float
    leak: float
    image_rms: float
    image_maximum: float
    worst: tuple[int, int]


def compare_ids(
    got_ids: NDArray[np.integer[Any]],
    got_layers: NDArray[np.integer[Any]],
    expected_ids: NDArray[np.integer[Any]],
    expected_layers: NDArray[np.integer[Any]],
    edge_distance: FloatArray | None = None,
    ignore: BoolArray | None = None,
) -> IdComparison:
    """Compare ids and layers, all (h, w). `ignore` (h, w) leaves pixels out."""
    _same_shape(got_ids, got_layers, expected_ids, expected_layers)
    compared = np.ones(expected_ids.shape, dtype=np.bool_) if ignore is None else ~ignore
    mask: BoolArray = compared & ((got_ids != expected_ids) | (got_layers != expected_layers))
    missing = mask & (got_layers < 0)
    extra = mask & (expected_layers < 0)
    farthest = np.nan
    if edge_distance is not None:
        farthest = float(edge_distance[mask].max(initial=0.0))
    return IdComparison(
        int(compared.sum()), int(mask.sum()), int(missing.sum()), int(extra.sum()), mask, farthest
    )


def compare_overlay(
    got: NDArray[np.floating[Any]] | NDArray[np.uint8], expected: Overlay, ignore: BoolArray | None = None
) -> OverlayComparison:
    """Compare premultiplied colours (h, w, 4), 0..1 or uint8, with a reference overlay.

    ignore: (h, w) pixels to leave out, such as `expected.mixed`.
    """
    _same_shape(got, expected.rgba)
    scale = 255.0 if got.dtype == np.uint8 else 1.0
    colors = np.asarray(got, dtype=np.float64) / scale
    compared = np.ones(expected.mixed.shape, dtype=np.bool_) if ignore is None else ~ignore
    alpha = expected.rgba[..., 3]
    partial = compared & (((alpha > WHOLE) & (alpha < 1 - WHOLE)) | expected.varied)
    error = np.abs(colors - expected.rgba)
    largest = np.where(compared, error.max(axis=-1), -1.0)
    worst = np.unravel_index(int(largest.argmax()), largest.shape) if compared.any() else (-1, -1)
    whole = compared & (alpha >= 1 - WHOLE)
    leak = float((alpha - colors[..., 3])[whole].max(initial=0.0))
    image_rms, _, image_maximum = _summary(largest[compared])
    return OverlayComparison(
        int(compared.sum()),
        int(partial.sum()),
        *_summary(largest[partial]),
        *_summary(error[..., 3][partial]),
        leak,
        image_rms,
        image_maximum,
        (int(worst[0]), int(worst[1])),
    )


def _summary(values: FloatArray) -> tuple[float, float, float]:
    """Root mean square, 99th percentile and maximum, zeros if there are no values."""
    if not values.size:
        return 0.0, 0.0, 0.0
    return (
        float(np.sqrt(np.mean(values**2))),
        float(np.percentile(values, 99)),
        float(values.max()),
    )


def _same_shape(*arrays: NDArray[Any]) -> None:
    shapes = {array.shape for array in arrays}
    if len(shapes) > 1:
        raise ValueError(f"The pictures to compare differ in shape: {sorted(shapes)}.")
