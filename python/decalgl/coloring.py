"""Styling keywords to colours, one a row, with the names and the meaning of `GeoDataFrame.plot`.

color       one colour, or one a row            column + cmap     numbers through a colormap
(nothing)   matplotlib's first blue             column of texts   one colour a category
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._colors import Rgba, alpha_values, colormap, parse_color, parse_colors
from .errors import StyleError, close_matches, warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._sources import Attributes

DEFAULT_COLOR = "#1f77b4"
DEFAULT_MISSING = "lightgrey"
MISSING_KEYS = ("color", "alpha", "label")
LegendKind = Literal["single", "listed", "categorical", "continuous"]


@dataclass(frozen=True, eq=False)
class Coloring:
    """Colours and what a legend needs to explain them.

    colors: uint8 (rows, 4), sRGB with straight alpha; alpha 0 is not drawn.
    kind: "single" (one colour), "listed" (one a row, given), "categorical" or "continuous".
    legend: whether a legend was asked for.
    title: the column's name, or an empty string.
    labels, label_colors: the categories and their colours, uint8 (labels, 4); the missing values come last.
    cmap, norm: the matplotlib colormap and normalisation of a continuous or categorical colouring, or None.
    vmin, vmax: the values at the ends of a continuous colormap.
    missing: how many rows have no value.
    """

    colors: NDArray[np.uint8] = field(repr=False)
    kind: LegendKind
    legend: bool = False
    title: str = ""
    labels: tuple[str, ...] = ()
    label_colors: NDArray[np.uint8] = field(default_factory=lambda: np.zeros((0, 4), np.uint8), repr=False)
    cmap: Any = None
    norm: Any = None
    vmin: float | None = None
    vmax: float | None = None
    missing: int = 0


@dataclass(frozen=True)
class _Painted:
    """Colours before missing values and alpha are applied: float64 (rows, 4), and which rows are missing."""

    rgba: NDArray[np.float64]
    missing: NDArray[np.bool_]
    kind: LegendKind
    labels: tuple[str, ...] = ()
    label_rgba: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 4)))
    cmap: Any = None
    norm: Any = None


def resolve_colors(
    count: int,
    attributes: Attributes | None = None,
    *,
    color: Any = None,
    column: Any = None,
    cmap: Any = None,
    vmin: float | None = None,
    vmax: float | None = None,
    alpha: Any = None,
    categorical: bool | None = None,
    legend: bool = False,
    missing_kwds: Mapping[str, Any] | None = None,
    norm: Any = None,
    rows: NDArray[np.int64] | None = None,
) -> Coloring:
    """The colours of a layer of `count` rows of user data.

    attributes: the layer's columns, as `read_features` returns them.
    color: one colour (a name, "#rrggbb", an RGB or RGBA tuple from 0 to 1) or `count` of them.
    column: the name of a column, or `count` values. Texts, booleans and pandas categories are categorical.
    cmap: a colormap or its name; for categories also a dict {category: colour}, or a list of colours.
    vmin, vmax: numbers at the colormap's ends, by default the least and the greatest (of all rows).
    alpha: opacity from 0 to 1, one or `count`; it replaces the colours' own.
    categorical: colour numbers by category too; by default only what is no number.
    missing_kwds: {"color": ..., "alpha": ..., "label": ...} for rows without a value, which are otherwise
        not drawn.
    norm: a matplotlib normalisation, instead of a linear one.
    rows: give the colours of these rows only (FeatureTable.rows), in this order; the legend still covers all.

    Raises ColumnError (no such column) and StyleError (unknown colour or colormap, wrong lengths or ranges).
    """
    title = column if isinstance(column, str) else str(getattr(column, "name", None) or "")
    if column is not None and color is not None:
        warn("Both color= and column= are given; color= is used, as GeoPandas does.")
        column = None
    if column is None:
        painted, title = _painted_plain(count, DEFAULT_COLOR if color is None else color), ""
    else:
        painted = _painted_by_column(
            count, attributes, column, cmap, vmin, vmax, categorical, norm, missing_kwds
        )
    missing_look = _missing_look(missing_kwds)
    rgba, label_rgba, labels = painted.rgba, painted.label_rgba, painted.labels
    opacity = alpha_values(alpha, count)
    if opacity is not None:
        # A fully transparent colour was asked for by name ("none"), and stays so.
        drawn = rgba[:, 3] > 0.0
        rgba[drawn, 3] = np.broadcast_to(opacity, count)[drawn]
        if opacity.ndim == 0:
            label_rgba[:, 3] = opacity
    if painted.missing.any():
        one = None if opacity is None or opacity.ndim else float(opacity)
        look = _missing_rgba(missing_look, one)
        rgba[painted.missing] = look if look is not None else 0.0
        if look is not None:
            labels, label_rgba = (*labels, str(missing_look["label"])), np.vstack([label_rgba, look])
    return Coloring(
        _bytes(rgba if rows is None else rgba[rows]),
        painted.kind,
        bool(legend),
        title,
        labels,
        _bytes(label_rgba),
        painted.cmap,
        painted.norm,
        None if painted.norm is None else painted.norm.vmin,
        None if painted.norm is None else painted.norm.vmax,
        int(painted.missing.sum()),
    )


def _bytes(rgba: NDArray[np.float64]) -> NDArray[np.uint8]:
    return np.rint(np.clip(rgba, 0.0, 1.0) * 255.0).astype(np.uint8)


def _painted_plain(count: int, color: Any) -> _Painted:
    none_missing = np.zeros(count, dtype=np.bool_)
    single = parse_color(color, strict=False)
    if single is None:
        return _Painted(parse_colors(color, count), none_missing, "listed")
    return _Painted(np.tile(np.array(single), (count, 1)), none_missing, "single", (), np.array([single]))


def _painted_by_column(
    count: int,
    attributes: Attributes | None,
    column: Any,
    cmap: Any,
    vmin: float | None,
    vmax: float | None,
    categorical: bool | None,
    norm: Any,
    missing_kwds: Mapping[str, Any] | None,
) -> _Painted:
    values, what = _column_values(count, attributes, column)
    numbers = None if categorical or isinstance(cmap, Mapping) else _as_numbers(values)
    if numbers is None:
        if categorical is False:
            raise StyleError(
                f"{what} holds texts or categories, so it cannot be coloured with categorical=False."
            )
        codes, categories = _codes(values)
        return _painted_by_category(codes, categories, cmap, what, missing_kwds is not None)
    return _painted_by_number(numbers, cmap, vmin, vmax, norm, what)


def _column_values(count: int, attributes: Attributes | None, column: Any) -> tuple[Any, str]:
    named = isinstance(column, str) or np.isscalar(column)
    if named:
        if attributes is None:
            raise StyleError(
                f"The layer has no columns, so column={column!r} names nothing. Give the values themselves."
            )
        return attributes.raw(column), f"Column {column!r} of layer {attributes.layer_name!r}"
    values = column
    if not hasattr(values, "dtype"):
        given = list(column)
        values = np.empty(len(given), dtype=object)
        values[:] = given
        numeric = [v for v in given if v is not None]
        if numeric and all(
            isinstance(v, (int, float, np.number)) and not isinstance(v, bool) for v in numeric
        ):
            values = np.array([np.nan if v is None else v for v in given], dtype=np.float64)
    if getattr(values, "ndim", 1) != 1 or len(values) != count:
        raise StyleError(
            f"column= has shape {getattr(values, 'shape', len(values))}, but the layer has {count} rows. "
            "Give the name of a column, or one value for each row."
        )
    return values, "column="


def _as_numbers(values: Any) -> NDArray[np.float64] | None:
    """The values as float64 with NaN where missing; None when they are texts, booleans or categories."""
    kind = getattr(values.dtype, "kind", "O")
    if kind in "iuf":
        if hasattr(values, "to_numpy"):  # a pandas column, whose nullable integers may hold <NA>
            return np.array(values.to_numpy(dtype=np.float64, na_value=np.nan))
        return np.array(values, dtype=np.float64)
    if kind in "mM":
        moments = np.asarray(values, dtype=f"{kind}8[ns]")  # time zones become UTC
        return np.where(np.isnat(moments), np.nan, moments.astype(np.int64).astype(np.float64))
    return None


def _codes(values: Any) -> tuple[NDArray[np.int64], list[Any]]:
    """Category numbers, -1 where missing, and the categories: in pandas' order, sorted, or as they come."""
    own = getattr(values, "cat", None)
    plain: list[Any] = np.asarray(values, dtype=object).tolist()
    present = list(dict.fromkeys(value for value in plain if not _is_missing(value)))
    if own is not None:
        categories = list(own.categories)
    else:
        try:
            categories = sorted(present)
        except TypeError:
            categories = present
    number = {category: code for code, category in enumerate(categories)}
    return (
        np.array([-1 if _is_missing(value) else number[value] for value in plain], dtype=np.int64),
        categories,
    )


def _is_missing(value: Any) -> bool:
    # NaN and NaT differ from themselves; pandas' NA has no truth value.
    return value is None or type(value).__name__ == "NAType" or bool(value != value)


def _painted_by_category(
    codes: NDArray[np.int64],
    categories: list[Any],
    cmap: Any,
    what: str,
    has_missing_look: bool,
) -> _Painted:
    missing = codes < 0
    if isinstance(cmap, Mapping):
        looks = _looks_from_dict(codes, categories, cmap, what, has_missing_look)
        unnamed = np.isnan(looks[:, 0]) if len(looks) else np.zeros(0, dtype=np.bool_)
        missing |= np.append(unnamed, True)[codes]
        kept = ~unnamed
        labels = tuple(str(category) for category, keep in zip(categories, kept, strict=True) if keep)
        rgba = np.append(looks, [[0.0] * 4], axis=0)[codes]
        return _Painted(rgba, missing, "categorical", labels, looks[kept])
    looks, chosen = _category_looks(len(categories), cmap)
    rgba = np.append(looks, [[0.0] * 4], axis=0)[codes]
    return _Painted(rgba, missing, "categorical", tuple(map(str, categories)), looks, chosen)


def _category_looks(count: int, cmap: Any) -> tuple[NDArray[np.float64], Any]:
    """A colour for each category, and the colormap: GeoPandas' choice (its version 1.2)."""
    if cmap is None:
        cmap = "tab10" if count <= 10 else "tab20" if count <= 20 else "viridis"
    chosen = colormap(cmap)
    # Short colormaps are lists of contrasting colours; long ones are spread over the categories.
    numbers = np.arange(count) % chosen.N if chosen.N < 32 else np.arange(count) / max(1, count - 1)
    return np.array(chosen(numbers), dtype=np.float64).reshape(-1, 4), chosen


def _looks_from_dict(
    codes: NDArray[np.int64],
    categories: list[Any],
    cmap: Mapping[Any, Any],
    what: str,
    has_missing_look: bool,
) -> NDArray[np.float64]:
    looks = np.full((len(categories), 4), np.nan)
    unnamed = []
    for code, category in enumerate(categories):
        if category in cmap:
            looks[code] = parse_color(cmap[category])
        elif (codes == code).any():
            unnamed.append(category)
    if unnamed and not has_missing_look:
        listed = ", ".join(repr(category) for category in unnamed[:10])
        raise StyleError(
            f"{what} holds {len(unnamed)} values that cmap= gives no colour:"
            f" {listed}.{close_matches(unnamed[0], cmap)} Add them, or colour the rest with"
            " missing_kwds={'color': 'lightgrey'}."
        )
    return looks


def _painted_by_number(
    numbers: NDArray[np.float64], cmap: Any, vmin: float | None, vmax: float | None, norm: Any, what: str
) -> _Painted:
    from matplotlib.colors import Normalize

    chosen = colormap("viridis" if cmap is None else cmap)
    missing = np.isnan(numbers)
    finite = numbers[np.isfinite(numbers)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    low, high = _limit(vmin, low, "vmin"), _limit(vmax, high, "vmax")
    if low > high:
        raise StyleError(
            f"vmin={low:g} lies above vmax={high:g} for {what[:1].lower()}{what[1:]}. Swap them."
        )
    if norm is None:
        norm = Normalize(low, high)
    elif not callable(norm):
        raise StyleError(
            f"norm={norm!r} must be a matplotlib normalisation such as matplotlib.colors.LogNorm()."
        )
    elif not norm.scaled():
        norm.autoscale_None(np.array([low, high]))
    rgba = np.array(chosen(norm(np.where(missing, low, numbers))), dtype=np.float64).reshape(-1, 4)
    return _Painted(rgba, missing, "continuous", cmap=chosen, norm=norm)


def _limit(value: Any, default: float, name: str) -> float:
    if value is None:
        return default
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise StyleError(f"{name} must be a number, but it is {value!r}.") from error
    if not math.isfinite(number):
        raise StyleError(f"{name} must be finite, but it is {number}.")
    return number


def _missing_look(missing_kwds: Mapping[str, Any] | None) -> dict[str, Any]:
    if missing_kwds is None:
        return {}
    unknown: Sequence[str] = [key for key in missing_kwds if key not in MISSING_KEYS]
    if unknown:
        raise StyleError(
            f"missing_kwds has the unknown key {unknown[0]!r}.{close_matches(unknown[0], MISSING_KEYS)} "
            f"It takes {', '.join(MISSING_KEYS)}."
        )
    return {"color": DEFAULT_MISSING, "label": "NaN", **missing_kwds}


def _missing_rgba(look: Mapping[str, Any], alpha: float | None) -> Rgba | None:
    if not look:
        return None
    red, green, blue, opacity = parse_color(look["color"])
    own = alpha_values(look.get("alpha"), 0)
    if own is not None:
        return red, green, blue, float(own)
    return red, green, blue, opacity if alpha is None or opacity == 0.0 else alpha
