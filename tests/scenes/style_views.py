"""Views by name: they are built once and kept."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from scenes import View

STYLES: dict[str, Callable[[], View]] = {}


def build(name: str) -> View:
    """The view of that name; `STYLES` lists them."""
    return STYLES[name]()


def named(make: Callable[[], View]) -> Callable[[], View]:
    """Adds a view under the function's name."""
    kept = functools.cache(make)
    STYLES[make.__name__] = kept
    return kept
