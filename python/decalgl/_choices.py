"""Keywords of which each row may have its own: one value for all, one a row, a column's, or one a category.

corner="miter"      corner=["round", "miter", ...]      corner="joint"      corner={"canal": "miter", ...}
one for all         one a row                           a column            by the categories of column=
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from ._values import is_listed
from .coloring import category_codes, column_values
from .errors import StyleError, close_matches

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .features import Attributes

Value = TypeVar("Value")


@dataclass(frozen=True)
class LayerRows:
    """The rows of a layer that are drawn, and the columns beside them.

    name: the layer's. rows: int64 (features), each feature's row in the user's data.
    widest: metres that a line may be wide. column: the argument column=, whose categories may choose styles.
    """

    name: str
    attributes: Attributes
    rows: NDArray[np.int64]
    widest: float
    column: Any = None


@dataclass(frozen=True)
class Choices(Generic[Value]):
    """A few distinct values, and int64 (features) each feature's place among them; None: the first for all."""

    values: tuple[Value, ...]
    codes: NDArray[np.int64] | None = None

    def at(self, feature: int) -> Value:
        """The feature's value."""
        return self.values[0 if self.codes is None else self.codes[feature]]


def choose(
    rows: LayerRows, keyword: str, given: Any, parse: Callable[[Any], Value], is_one: Callable[[Any], bool]
) -> Choices[Value]:
    """The values of a keyword.

    parse: makes a value of what the user gives, of None too, or raises StyleError that begins with its repr.
    is_one: whether it is one value, and not a column's name or one value a row.
    Raises StyleError that names the keyword and the row.
    """
    if isinstance(given, Mapping):
        return _by_category(rows, keyword, given, parse)
    if isinstance(given, str) and not is_one(given) and given in rows.attributes.names:
        return _by_row(rows, keyword, rows.attributes.raw(given), parse)
    if not is_listed(given) or (not hasattr(given, "to_numpy") and is_one(given)):
        return Choices((_parsed(rows, "", keyword, given, parse),))
    return _by_row(rows, keyword, given, parse)


def _by_row(rows: LayerRows, keyword: str, given: Any, parse: Callable[[Any], Value]) -> Choices[Value]:
    values = given.to_numpy(dtype=object) if hasattr(given, "to_numpy") else given
    if len(values) != rows.attributes.count:
        raise StyleError(
            f"{keyword}= lists {len(values)} values, but the layer has {rows.attributes.count} rows. Give one value,"
            " or one for each row."
        )
    known: dict[Any, int] = {}
    found: list[Value] = []
    codes = np.zeros(len(rows.rows), dtype=np.int64)
    for feature, row in enumerate(rows.rows.tolist()):
        key = _hashable(values[row])
        if key not in known:
            known[key] = len(found)
            found.append(_parsed(rows, f", row {row}", keyword, None if key is None else values[row], parse))
        codes[feature] = known[key]
    return _compact(found or [parse(None)], codes)


def _by_category(
    rows: LayerRows, keyword: str, given: Mapping[Any, Any], parse: Callable[[Any], Value]
) -> Choices[Value]:
    codes, categories = _categories(rows, keyword, given)
    # Rows without a value have the code -1, the last place.
    values = [
        _parsed(rows, f", category {name!r}", keyword, given.get(name), parse) for name in [*categories, None]
    ]
    return _compact(values, np.where(codes < 0, len(values) - 1, codes))


def _categories(
    rows: LayerRows, keyword: str, given: Mapping[Any, Any]
) -> tuple[NDArray[np.int64], list[Any]]:
    """Each feature's category, -1 for none, and the categories."""
    if rows.column is None:
        raise StyleError(
            f"{keyword}= is given by category, but there is no column= that says each row's. Name the column, or"
            " give one value for each row."
        )
    values, what = column_values(rows.attributes.count, rows.attributes, rows.column)
    codes, categories = category_codes(values)
    codes = codes[rows.rows]
    used = np.unique(codes[codes >= 0])
    for code in used.tolist():
        if categories[code] not in given:
            raise StyleError(
                f"{what} holds {categories[code]!r}, which {keyword}= does not name."
                f"{close_matches(categories[code], given)} Add it."
            )
    return codes, categories


def numbers_of(given: Any, rows: LayerRows, keyword: str) -> NDArray[np.float64]:
    """float64 (features) of a keyword that is a number, one a row, a column's name, or {category: number}.

    NaN where a row has none. Raises ColumnError, InputError and StyleError.
    """
    if not isinstance(given, Mapping):
        return rows.attributes.numbers(given, keyword)[rows.rows]
    codes, categories = _categories(rows, keyword, given)
    try:
        numbers = [float(given.get(category, np.nan)) for category in categories]
        numbers.append(float(given.get(None, np.nan)))
    except (TypeError, ValueError, OverflowError) as error:
        raise StyleError(f"{keyword}= must give each category a number: {error}.") from error
    return np.array(numbers)[codes]


def _parsed(rows: LayerRows, where: str, keyword: str, value: Any, parse: Callable[[Any], Value]) -> Value:
    try:
        return parse(value)
    except StyleError as error:
        raise StyleError(f"Layer {rows.name!r}{where}: {keyword}={error}") from error


def _hashable(value: Any) -> Any:
    """A key that is equal for equal values; None for what is missing."""
    if value is None or type(value).__name__ == "NAType" or (isinstance(value, float) and value != value):
        return None
    try:
        hash(value)
    except TypeError:
        return repr(value)
    return value


def _compact(values: list[Value], codes: NDArray[np.int64]) -> Choices[Value]:
    """The values that some feature has, each once."""
    used, compact = np.unique(codes, return_inverse=True)
    place: dict[Value, int] = {}
    places = [place.setdefault(values[code], len(place)) for code in used.tolist()]
    if len(place) <= 1:
        return Choices(tuple(place) or (values[0],))
    return Choices(tuple(place), np.array(places, dtype=np.int64)[compact])
