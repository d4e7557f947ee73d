"""Filters: which rows of a layer are meant, by a mask, a function of the columns, or an expression such as

    kind == 'primary' and (lanes >= 2 or name in ('A 1', 'A 2'))

Expressions know column names, constants, comparisons, `in`, arithmetic, `and`, `or`, `not`; nothing else, so that
text from a scene file or a web page can do no harm.
"""

from __future__ import annotations

import ast
import operator
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import DecalError, InputError
from .frame import KEEP_THE_DATA

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from ._sources import Attributes

COMPARISONS: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
ARITHMETIC: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Mod: operator.mod,
}


class Columns:
    """A layer's columns by name, as functions that filter get them."""

    def __init__(self, attributes: Attributes | None, layer_name: str) -> None:
        self._attributes, self._layer_name = attributes, layer_name

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The column, one value a row. Raises ColumnError, which names close matches."""
        if self._attributes is None:
            raise InputError(
                f"Layer {self._layer_name!r} comes from a saved scene, which keeps no columns. {KEEP_THE_DATA}"
                " Or give one value for each row."
            )
        return self._attributes.column(name)


def rows_meant(given: Any, count: int, columns: Columns, layer_name: str, keyword: str) -> NDArray[np.bool_]:
    """Which of the layer's rows `given` means: a bool, one a row, an expression, or a function of the columns.

    Raises InputError that names the keyword, ColumnError.
    """
    what = f"{keyword}= of layer {layer_name!r}"
    if isinstance(given, (bool, np.bool_)):
        return np.full(count, bool(given))
    if isinstance(given, str):
        given = _evaluate(given, columns, what)
    mask = np.asarray(given(columns) if callable(given) else given)
    if mask.dtype == object:
        # Comparisons with missing values answer with pandas' NA, which means no.
        mask = np.array([value is True or value is np.True_ for value in mask.ravel().tolist()]).reshape(
            mask.shape
        )
    if mask.dtype != np.bool_:
        raise InputError(f"{what} must be true or false for each row, but it holds {mask.dtype} values.")
    if mask.ndim == 0:
        return np.full(count, bool(mask))
    if mask.shape != (count,):
        raise InputError(f"{what} has shape {mask.shape}, but the layer has {count} rows. Give one a row.")
    return mask


def _evaluate(text: str, columns: Columns, what: str) -> Any:
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(
            f"{what} is no expression: {text!r}. Write such as \"kind == 'primary' and lanes >= 2\"."
        ) from error
    try:
        with np.errstate(all="ignore"):
            return _value(tree.body, columns, what)
    except DecalError:
        raise
    except (TypeError, ValueError, ZeroDivisionError, RecursionError) as error:
        raise InputError(f"{what} cannot be worked out: {text!r}: {error}.") from error


def _value(node: ast.expr, columns: Columns, what: str) -> Any:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name):
        return columns[node.id]
    if isinstance(node, (ast.Tuple, ast.List)):
        return [_value(item, columns, what) for item in node.elts]
    if isinstance(node, ast.BoolOp):
        joined = np.logical_and if isinstance(node.op, ast.And) else np.logical_or
        parts = [np.asarray(_value(part, columns, what), dtype=np.bool_) for part in node.values]
        return joined.reduce(np.broadcast_arrays(*parts))
    if isinstance(node, ast.UnaryOp):
        operand = _value(node.operand, columns, what)
        if isinstance(node.op, ast.Not):
            return np.logical_not(np.asarray(operand, dtype=np.bool_))
        if isinstance(node.op, ast.USub):
            return -operand
    if isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC:
        left, right = _value(node.left, columns, what), _value(node.right, columns, what)
        return ARITHMETIC[type(node.op)](left, right)
    if isinstance(node, ast.Compare):
        return _compare(node, columns, what)
    raise InputError(
        f"{what} may hold column names, constants, comparisons, in, arithmetic, and, or and not; not"
        f" {ast.unparse(node)!r}. Give a mask or a function of the columns for more."
    )


def _compare(node: ast.Compare, columns: Columns, what: str) -> NDArray[np.bool_]:
    left = _value(node.left, columns, what)
    answers = []
    for sign, part in zip(node.ops, node.comparators, strict=True):
        right = _value(part, columns, what)
        if isinstance(sign, (ast.In, ast.NotIn)):
            within = np.array([value in right for value in np.asarray(left).ravel().tolist()], np.bool_)
            answers.append(within if isinstance(sign, ast.In) else ~within)
        elif type(sign) in COMPARISONS:
            answers.append(np.asarray(COMPARISONS[type(sign)](left, right), dtype=np.bool_))
        else:
            raise InputError(f"{what} compares with 'is'; write == or != in its place.")
        left = right
    return np.asarray(np.logical_and.reduce(np.broadcast_arrays(*answers)))
