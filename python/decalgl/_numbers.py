"""Numbers as they come from users: finite ones, or an error that says which is none."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .errors import StyleError


def is_number(value: Any) -> bool:
    """Whether it is one number; truth values and texts are none."""
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def finite_number(value: Any, what: str) -> float:
    """The number. Raises StyleError."""
    if not is_number(value) or not math.isfinite(value):
        raise StyleError(f"{what} must be a finite number, but it is {value!r}.")
    return float(value)
