"""What restyles make of the widths of strokes, and of the casings that show on each side of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import StyleError, UnsupportedError
from .scene import Layer

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from ._looks import DecalState, LayerState


def restyled_widths(
    state: LayerState, every: Mapping[str, Mapping[str, Any]], where: NDArray[np.bool_] | None
) -> dict[str, DecalState]:
    """The decals with the widths that are wanted: a casing's on each side of the line, whatever that one's becomes."""
    decals = dict(state.decals)
    wanted = {role: own["width"] for role, own in every.items() if "width" in own}
    for role in wanted.keys() - {"casing"}:
        decal = decals[role]
        if decal.widths is None:
            raise StyleError("fills have no width. Leave width= out, or give it to outline=.")
        widths = _restyled_width(state, decal.widths, wanted[role], where)
        decals[role] = _as_wide(decal, widths)
    if "casing" in decals and wanted:
        casing, sides = decals["casing"], casing_sides(state)
        if "casing" in wanted:
            if (
                isinstance(state.layer, Layer)
                and state.layer.casing
                and state.layer.casing.margins is not None
            ):
                raise UnsupportedError(
                    "casings of lines whose widths have limits stay as wide as they are. Prepare the scene anew."
                )
            sides = _restyled_width(state, sides, wanted["casing"], where)
        line = decals["stroke"].widths
        assert line is not None
        decals["casing"] = _as_wide(casing, line + 2.0 * sides)
    return decals


def casing_sides(state: LayerState) -> NDArray[np.float64]:
    """How wide the layer's casings are on each side of their lines."""
    line, casing = state.decals["stroke"].widths, state.decals["casing"].widths
    assert line is not None
    assert casing is not None
    return 0.5 * (casing - line)


def _restyled_width(
    state: LayerState, before: NDArray[np.float64], width: Any, where: NDArray[np.bool_] | None
) -> NDArray[np.float64]:
    widths = _widths(state, width)
    if where is not None:
        widths = np.where(where, widths, before)
    wrong = np.flatnonzero(~((widths >= 0.0) & (widths < np.inf)))
    if wrong.size:
        raise StyleError(
            f"row {state.rows[wrong[0]]}: width {widths[wrong[0]]:g} is no length. Give metres, 0 or more."
        )
    return widths


def _as_wide(decal: DecalState, widths: NDArray[np.float64]) -> DecalState:
    if decal.widest > 0.0 and (widths > decal.widest).any():
        raise StyleError(
            f"a width of {widths.max():g} m is more than the {decal.widest:g} m that it was prepared for. Make"
            " the layer with a larger widest=."
        )
    return replace(decal, widths=widths)


def _widths(state: LayerState, width: Any) -> NDArray[np.float64]:
    if state.attributes is not None:
        return state.attributes.numbers(width, "width")[state.rows]
    widths = np.asarray(width, dtype=np.float64)
    if widths.shape not in ((), (state.row_count,)):
        raise StyleError(f"width has shape {widths.shape}, but the layer has {state.row_count} rows.")
    return np.array(np.broadcast_to(widths, state.row_count)[state.rows])
