"""The ways of anti-aliasing, by name, and how many samples those made of samples may have."""

from __future__ import annotations

from operator import index
from typing import Any

from .errors import InputError

ANTIALIAS = ("none", "coverage", "ssaa", "msaa", "fxaa")
SAMPLES = (1, 2, 4, 8, 16, 32)


def checked_antialias(antialias: Any) -> str:
    """One of `ANTIALIAS`. Raises InputError, which lists them, for another."""
    if not isinstance(antialias, str) or antialias not in ANTIALIAS:
        known = ", ".join(repr(one) for one in ANTIALIAS)
        raise InputError(f"There is no antialias={antialias!r}; choose one of {known}.")
    return antialias


def checked_samples(samples: Any) -> int:
    """One of `SAMPLES`. Raises InputError, which lists them, for another."""
    try:
        count = index(samples)
    except TypeError:
        count = 0
    if count not in SAMPLES:
        known = ", ".join(str(one) for one in SAMPLES)
        raise InputError(f"samples must be one of {known}, but it is {samples!r}.")
    return count
