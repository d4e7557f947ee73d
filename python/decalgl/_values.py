"""Numbers, words and flags as they come from users, or an error that says what is none."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import StyleError

if TYPE_CHECKING:
    from collections.abc import Iterable


def is_number(value: Any) -> bool:
    """Whether it is one number; truth values and texts are none."""
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def is_whole(value: Any) -> bool:
    """Whether it is one whole number; truth values are none."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def finite_number(value: Any, what: str) -> float:
    """The number. Raises StyleError."""
    try:
        number = float(value) if is_number(value) else math.nan
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise StyleError(f"{what} must be a finite number, but it is {value!r}.")
    return number


def flag(value: Any, what: str) -> bool:
    """True or False. Raises StyleError."""
    if not isinstance(value, (bool, np.bool_)):
        raise StyleError(f"{what} must be True or False, but it is {value!r}.")
    return bool(value)


def is_listed(value: Any) -> bool:
    """Whether it is a list, a tuple, an array or a Series of values; texts and mappings are none."""
    if isinstance(value, (str, bytes)):
        return False
    return isinstance(value, Sequence) or getattr(value, "ndim", 0) > 0


def is_word(value: Any, known: Iterable[str]) -> bool:
    """Whether it is one of a few words."""
    return isinstance(value, str) and value in known
