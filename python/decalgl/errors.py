"""The errors and warnings of decalgl.

Everything that decalgl raises on purpose is a `DecalError` and also the builtin that fits, so that
`except ValueError` and `except MemoryError` work as usual. Messages are whole sentences that say what
was wrong, where, and what to do about it.
"""

from __future__ import annotations

import difflib
import sys
import warnings
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


class DecalError(Exception):
    """The root of all errors of decalgl."""


class InputError(DecalError, ValueError):
    """An argument or a data set is not usable: its values, shape or kind."""


class CrsError(InputError):
    """A coordinate reference system is missing, unknown, or does not fit the scene."""


class StyleError(InputError):
    """A colour, colormap, width or another styling argument is not usable."""


class ColumnError(InputError, KeyError):
    """A named column is not in the layer."""

    # KeyError shows the repr of its argument; a sentence should read as one.
    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class FileError(DecalError, OSError):
    """A file is missing or cannot be read or written."""


class MemoryLimitError(DecalError, MemoryError):
    """Something would need more memory than there is or than a limit allows."""


class GraphicsError(DecalError, RuntimeError):
    """OpenGL is not available or failed."""


class CancelledError(DecalError, RuntimeError):
    """Work was stopped by a progress callback that returned False."""


class UnsupportedError(DecalError, NotImplementedError):
    """A feature that the API names but this version does not draw."""


class DecalWarning(UserWarning):
    """Something was left out or assumed; the message carries the counts."""


def warn(message: str) -> None:
    """A DecalWarning that points at the line outside this package that called into it."""
    package, depth = __name__.rpartition(".")[0], 2
    frame = sys._getframe(1)
    while frame.f_back is not None and f"{frame.f_globals.get('__name__')}.".startswith(f"{package}."):
        frame, depth = frame.f_back, depth + 1
    warnings.warn(message, DecalWarning, stacklevel=depth)


def close_matches(name: object, known: Iterable[object]) -> str:
    """A hint such as " Did you mean 'kind'?" for a misspelt `name`, or an empty string."""
    names = [str(other) for other in known]
    found = difflib.get_close_matches(str(name), names, n=3, cutoff=0.6)
    if not found:
        folded = {other.casefold(): other for other in names}
        found = [folded[key] for key in difflib.get_close_matches(str(name).casefold(), list(folded), n=3)]
    return f" Did you mean {' or '.join(repr(match) for match in found)}?" if found else ""
