"""Styling keywords to colours, one a row, with the names and the meaning of `GeoDataFrame.plot`.

color       one colour, or one a row            column + cmap     numbers through a colormap
(nothing)   matplotlib's first blue             column of texts   one colour a category
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._colors import Rgba, alpha_values, colormap, parse_color, parse_colors
from ._values import flag, is_listed
from .errors import StyleError, close_matches, warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._sources import Attributes

DEFAULT_COLOR = "#1f77b4"
DEFAULT_MISSING = "lightgrey"
MISSING_KEYS = ("color", "alpha", "label")
LegendKind = Literal["single", "listed", "categorical", "continuous"]
Extend = Literal["neither", "min", "max", "both"]


@dataclass(frozen=True, eq=False)
class Coloring:
    """Colours and what a legend needs to explain them.

    colors: uint8 (rows, 4), sRGB with straight alpha; alpha 0 is not drawn.
    kind: "single" (one colour), "listed" (one a row, given), "categorical" or "continuous".
    legend: whether a legend was asked for. legend_kwds: how it is to look, in matplotlib's words.
    title: the column's name, or an empty string.
    labels, label_colors: the categories and their colours, uint8 (labels, 4); the missing values come last.
    label_of: int64 (rows), each row's place among the labels, -1 for none.
    cmap, norm: the matplotlib colormap and normalisation of a continuous or categorical colouring, or None.
    vmin, vmax: the values at the ends of a continuous colormap.
    extend: which ends of a continuous colormap values lie beyond: "neither", "min", "max" or "both".
    alpha: the one opacity that was given for all rows, or None.
    missing: how many rows have no value.
    left_out: bool (rows), those that are not drawn for lack of a colour: neither are their outlines and casings.
    """

    colors: NDArray[np.uint8] = field(repr=False)
    kind: LegendKind
    legend: bool = False
    legend_kwds: Mapping[str, Any] = field(default_factory=dict, repr=False)
    title: str = ""
    labels: tuple[str, ...] = ()
    label_colors: NDArray[np.uint8] = field(default_factory=lambda: np.zeros((0, 4), np.uint8), repr=False)
    label_of: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), repr=False)
    cmap: Any = None
    norm: Any = None
    vmin: float | None = None
    vmax: float | None = None
    extend: Extend = "neither"
    alpha: float | None = None
    missing: int = 0
    left_out: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_), repr=False)

    def with_alpha(self, alpha: float) -> Coloring:
        """The same with another opacity of all that is drawn."""
        label_colors = self.label_colors.copy()
        label_colors[label_colors[:, 3] > 0, 3] = round(255.0 * alpha)
        return replace(self, label_colors=label_colors, alpha=alpha)

    def seen(self, shares: NDArray[np.float64]) -> Coloring:
        """The same where of each row that share of its colour is seen: without what is not seen at all."""
        if shares.size == 0 or (shares == 1.0).all():
            return self
        most = float(shares.max())
        if most == 0.0:
            return replace(self, legend=False)
        label_colors = self.label_colors.astype(np.float64)
        if self.kind != "categorical":
            label_colors[:, 3] *= most
            alpha = (1.0 if self.alpha is None else self.alpha) * most
            return replace(self, label_colors=np.rint(label_colors).astype(np.uint8), alpha=alpha)
        # One more for rows without a label, whose place is -1.
        by_label = np.zeros(len(self.labels) + 1)
        np.maximum.at(by_label, self.label_of[: len(shares)], shares)
        used = np.bincount(self.label_of[: len(shares)] + 1, minlength=len(by_label))[1:] > 0
        by_label = by_label[:-1]
        label_colors[used, 3] *= by_label[used]
        kept = ~used | (by_label > 0.0)
        places = np.append(np.where(kept, np.cumsum(kept) - 1, -1), -1)
        return replace(
            self,
            labels=tuple(label for label, is_kept in zip(self.labels, kept, strict=True) if is_kept),
            label_colors=np.rint(label_colors[kept]).astype(np.uint8),
            label_of=places[self.label_of],
        )


@dataclass(frozen=True)
class _Painted:
    """Colours before missing values and alpha are applied: float64 (rows, 4), and which rows are missing.

    hidden: rows whose value the normalisation gives no colour.
    """

    rgba: NDArray[np.float64]
    missing: NDArray[np.bool_]
    kind: LegendKind
    labels: tuple[str, ...] = ()
    label_rgba: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 4)))
    label_of: NDArray[np.int64] | None = None
    cmap: Any = None
    norm: Any = None
    extend: Extend = "neither"
    hidden: NDArray[np.bool_] | None = None


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
    legend_kwds: Mapping[str, Any] | None = None,
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
    norm: a matplotlib normalisation, instead of a linear one, such as LogNorm(), TwoSlopeNorm(0) or
        BoundaryNorm([0, 10, 100], 256). Limits that it lacks are vmin and vmax, or else the least and the
        greatest value it can show; it is copied. Values that it cannot show are not drawn.
    legend, legend_kwds: kept for `Layer.legend`.
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
    label_of = np.full(count, -1) if painted.label_of is None else painted.label_of
    opacity = alpha_values(alpha, count)
    if opacity is not None:
        # A fully transparent colour was asked for by name ("none"), and stays so.
        drawn = rgba[:, 3] > 0.0
        rgba[drawn, 3] = np.broadcast_to(opacity, count)[drawn]
        if opacity.ndim == 0:
            label_rgba[:, 3] = opacity
    one = None if opacity is None or opacity.ndim else float(opacity)
    left_out = np.zeros(count, dtype=np.bool_) if painted.hidden is None else painted.hidden
    if painted.missing.any():
        look = _missing_rgba(missing_look, one)
        rgba[painted.missing] = look if look is not None else 0.0
        if look is None:
            left_out = left_out | painted.missing
        else:
            labels, label_rgba = (*labels, str(missing_look["label"])), np.vstack([label_rgba, look])
            label_of[painted.missing] = len(labels) - 1
    return Coloring(
        colors=_bytes(rgba if rows is None else rgba[rows]),
        kind=painted.kind,
        legend=flag(legend, "legend"),
        legend_kwds=_checked_legend_kwds(legend_kwds),
        title=title,
        labels=labels,
        label_colors=_bytes(label_rgba),
        label_of=label_of if rows is None else label_of[rows],
        cmap=painted.cmap,
        norm=painted.norm,
        vmin=None if painted.norm is None else painted.norm.vmin,
        vmax=None if painted.norm is None else painted.norm.vmax,
        extend=painted.extend,
        alpha=one,
        missing=int(painted.missing.sum()),
        left_out=left_out if rows is None else left_out[rows],
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
    values, what = column_values(count, attributes, column)
    if categorical is not None:
        categorical = flag(categorical, "categorical")
    numbers = None if categorical or isinstance(cmap, Mapping) else _as_numbers(values)
    if numbers is None:
        if categorical is False:
            raise StyleError(
                f"{what} holds texts or categories, so it cannot be coloured with categorical=False."
            )
        codes, categories = category_codes(values)
        return _painted_by_category(codes, categories, cmap, what, missing_kwds is not None)
    return _painted_by_number(numbers, cmap, vmin, vmax, norm, what)


def column_values(count: int, attributes: Attributes | None, column: Any) -> tuple[Any, str]:
    """The values of column=, its name's or itself, one a row; and what to call it. Raises as `resolve_colors`."""
    named = isinstance(column, str) or np.isscalar(column)
    if named:
        if attributes is None:
            raise StyleError(
                f"The layer has no columns, so column={column!r} names nothing. Give the values themselves."
            )
        return attributes.raw(column), f"Column {column!r} of layer {attributes.layer_name!r}"
    values = column
    if not is_listed(column):
        raise StyleError(f"column= must be a column's name or one value for each row, but it is {column!r}.")
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


def category_codes(values: Any) -> tuple[NDArray[np.int64], list[Any]]:
    """Category numbers, -1 where missing, and the categories: in pandas' order, sorted, or as they come."""
    own = getattr(values, "cat", None)
    plain: list[Any] = np.asarray(values, dtype=object).tolist()
    try:
        present = list(dict.fromkeys(value for value in plain if not _is_missing(value)))
    except (TypeError, ValueError) as error:
        raise StyleError(
            f"column= holds values that are no categories: {error}. Give texts or numbers."
        ) from error
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
        places = np.append(np.where(kept, np.cumsum(kept) - 1, -1), -1)[codes]
        return _Painted(rgba, missing, "categorical", labels, looks[kept], places)
    looks, chosen = _category_looks(len(categories), cmap)
    rgba = np.append(looks, [[0.0] * 4], axis=0)[codes]
    return _Painted(rgba, missing, "categorical", tuple(map(str, categories)), looks, codes, chosen)


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
    scale: Any = Normalize()
    if norm is None:
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
        scale.vmin = low if vmin is None else _limit(vmin, "vmin")
        scale.vmax = high if vmax is None else _limit(vmax, "vmax")
        if scale.vmin > scale.vmax:
            raise StyleError(
                f"vmin={scale.vmin:g} lies above vmax={scale.vmax:g} for {what[:1].lower()}{what[1:]}. Swap them."
            )
    try:
        if norm is not None:
            scale = _scaled(norm, finite, vmin, vmax)
        shares = scale(np.where(missing, finite[0] if finite.size else 0.0, numbers))
    except StyleError:
        raise
    except ValueError as error:
        raise StyleError(f"norm= cannot show {what[:1].lower()}{what[1:]}: {error}.") from error
    hidden = np.ma.getmaskarray(shares) & ~missing
    if hidden.any():
        warn(
            f"{what}: {int(hidden.sum())} values are not drawn, as {type(scale).__name__} gives them no colour."
            " Give a norm for all values, or leave these rows out."
        )
    rgba = np.array(chosen(shares), dtype=np.float64).reshape(-1, 4)
    extend = _extend(scale, numbers[~missing & ~hidden])
    return _Painted(rgba, missing, "continuous", cmap=chosen, norm=scale, extend=extend, hidden=hidden)


def _scaled(norm: Any, finite: NDArray[np.float64], vmin: float | None, vmax: float | None) -> Any:
    """A copy of the normalisation with both limits set. Raises StyleError, and ValueError where none fit."""
    from matplotlib.colors import LogNorm, Normalize

    if not isinstance(norm, Normalize):
        raise StyleError(
            f"norm={norm!r} must be a matplotlib normalisation such as matplotlib.colors.LogNorm()."
        )
    scale = copy.deepcopy(norm)
    for name, given in (("vmin", vmin), ("vmax", vmax)):
        if given is None:
            continue
        limit, own = _limit(given, name), getattr(scale, name)
        if own is None:
            setattr(scale, name, limit)
        elif own != limit:
            raise StyleError(f"{name}={limit:g} is given, but norm= has {name}={own:g}. Leave one out.")
    if not scale.scaled():
        scale.autoscale_None(finite if finite.size else np.array([1.0, 10.0]))
    if isinstance(scale, LogNorm) and not (scale.vmin or 0.0) > 0.0:
        raise ValueError("a logarithm needs values above 0")
    for name, given in (("vmin", vmin), ("vmax", vmax)):
        if given is not None and getattr(scale, name) != given:
            raise ValueError(f"with {name}={given:g} its limits are out of order")
    return scale


def _extend(norm: Any, values: NDArray[np.float64]) -> Extend:
    """Which limits of the normalisation values lie beyond."""
    own: Extend | None = getattr(norm, "extend", None)
    if own is not None and own != "neither":
        return own
    below, above = bool((values < norm.vmin).any()), bool((values > norm.vmax).any())
    return "both" if below and above else "min" if below else "max" if above else "neither"


def _limit(value: Any, name: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise StyleError(f"{name} must be a number, but it is {value!r}.") from error
    if not math.isfinite(number):
        raise StyleError(f"{name} must be finite, but it is {number}.")
    return number


def _missing_look(missing_kwds: Mapping[str, Any] | None) -> dict[str, Any]:
    if missing_kwds is None:
        return {}
    if not isinstance(missing_kwds, Mapping):
        raise StyleError(
            f"missing_kwds must be a dict such as {{'color': 'grey'}}, but it is {missing_kwds!r}."
        )
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


def _checked_legend_kwds(legend_kwds: Any) -> dict[str, Any]:
    if legend_kwds is None:
        return {}
    if not isinstance(legend_kwds, Mapping) or not all(isinstance(key, str) for key in legend_kwds):
        raise StyleError(
            f"legend_kwds must be a dict such as {{'loc': 'upper left'}}, but it is {legend_kwds!r}."
        )
    return dict(legend_kwds)
