"""Other shared styles for the features of a prepared layer: dashes, corners, bands and hatches.

Each keyword changes its part of the styles that features have; the rest of them, and those of other features, stay.
The core says which of them its index was not made for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ._choices import Choices, LayerRows, choose
from ._values import is_word
from .patterns import parse_dash
from .styling import (
    CORNERS,
    checked_miter_limit,
    color_bands,
    hatches_of,
    is_one_dash,
    widths_of_dashes,
    word_of,
)  # fmt: skip

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from .patterns import Pattern
    from .strokes import StrokeStyle

STROKE_STYLES = ("corner", "miter_limit", "dash", "bands")
FILL_STYLES = ("hatch",)

Where: TypeAlias = "NDArray[np.bool_] | None"


@dataclass(frozen=True, eq=False)
class Styles:
    """Styles of strokes or hatches of fills, and uint32 (features) each feature's place among them; None: the first."""

    values: tuple[Any, ...]
    place_of: NDArray[np.uint32] | None = None

    def extended(self, count: int) -> Styles:
        """With features at the end that look as the first one."""
        if self.place_of is None:
            return self
        return replace(self, place_of=np.concatenate([self.place_of, np.repeat(self.place_of[:1], count)]))


def changed_strokes(
    styles: Styles, wanted: Mapping[str, Any], rows: LayerRows, widths: NDArray[np.float64], where: Where
) -> Styles:
    """Raises StyleError."""
    corners: Choices[Any] | None = None
    dashes: Choices[Pattern | None] | None = None
    sizes = None
    if "corner" in wanted:
        corners = choose(
            rows, "corner", wanted["corner"], word_of(CORNERS), lambda value: is_word(value, CORNERS)
        )
    if "dash" in wanted:
        dashes = choose(rows, "dash", wanted["dash"], parse_dash, is_one_dash)
        sizes = widths_of_dashes(dashes, widths)
    shared: dict[str, Any] = {}
    if "bands" in wanted:
        shared["bands"] = color_bands(wanted["bands"], "")
    if "miter_limit" in wanted:
        shared["miter_limit"] = checked_miter_limit(wanted["miter_limit"], "")

    def change(feature: int, before: StrokeStyle) -> StrokeStyle:
        after = replace(before, **shared)
        if corners is not None:
            after = replace(after, corner=corners.at(feature))
        if dashes is not None:
            dash = dashes.at(feature)
            after = replace(after, pattern=None if dash is None else dash.for_width(float(widths[feature])))
        return after

    codes = [each.codes for each in (corners, dashes) if each is not None]
    return _changed(styles, len(rows.rows), [*codes, sizes], where, change)


def changed_hatches(hatches: Styles, hatch: Any, rows: LayerRows, where: Where) -> Styles:
    """`hatch`: as in `Scene.add_polygons`; False for even fills. Raises StyleError."""
    chosen = hatches_of(None if hatch is False else hatch, rows)
    return _changed(hatches, len(rows.rows), [chosen.codes], where, lambda feature, _: chosen.at(feature))


def _changed(
    before: Styles,
    count: int,
    codes: list[NDArray[np.int64] | None],
    where: Where,
    change: Callable[[int, Any], Any],
) -> Styles:
    """Once for all features with the same style and codes."""
    keys = np.zeros(count, dtype=np.int64)
    for code in (before.place_of, *codes, where):
        if code is not None and count:
            keys = np.unique(keys * (int(code.max()) + 1) + code, return_inverse=True)[1].astype(np.int64)
    _, first, place_of = np.unique(keys, return_index=True, return_inverse=True)
    values = []
    for feature in first.tolist():
        own = before.values[0 if before.place_of is None else before.place_of[feature]]
        values.append(change(feature, own) if where is None or where[feature] else own)
    if not values:
        return before
    return Styles(tuple(values), None if len(values) == 1 else place_of.astype(np.uint32))
