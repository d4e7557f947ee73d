"""Colours and colormaps by name, tuple or table; matplotlib is asked only for names and colormaps."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from ._values import is_listed
from .errors import StyleError, close_matches

if TYPE_CHECKING:
    from numpy.typing import NDArray

Rgba = tuple[float, float, float, float]
HEX = re.compile(r"#(?:[0-9a-fA-F]{3,4}|[0-9a-fA-F]{6}|[0-9a-fA-F]{8})")
COLOR_KINDS = "a name such as 'crimson', '#rrggbb', or an RGB or RGBA tuple of numbers from 0 to 1"


@overload
def parse_color(value: Any, strict: Literal[True] = True) -> Rgba: ...
@overload
def parse_color(value: Any, strict: bool) -> Rgba | None: ...
def parse_color(value: Any, strict: bool = True) -> Rgba | None:
    """One colour as (red, green, blue, alpha), each from 0 to 1.

    strict: raise StyleError when `value` is no colour; otherwise None is returned for what may be a list of
    colours, and text that is no colour still raises.
    """
    if isinstance(value, str):
        return _from_text(value)
    numbers = _as_channels(value)
    if numbers is not None:
        return numbers
    pair = isinstance(value, (Sequence, np.ndarray)) and is_listed(value) and len(value) == 2
    if pair and isinstance(value[0], str) and _is_real(value[1]):
        red, green, blue, _ = _from_text(value[0])
        alpha = alpha_values(value[1], 0)
        return red, green, blue, float(alpha if alpha is not None else 1.0)
    if strict:
        raise StyleError(f"{value!r} is no colour. Give {COLOR_KINDS}.")
    return None


def _is_real(value: Any) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, (bool, np.bool_))


def _as_channels(value: Any) -> Rgba | None:
    if not isinstance(value, (tuple, list, np.ndarray)) or not is_listed(value) or len(value) not in (3, 4):
        return None
    if not all(_is_real(channel) for channel in value):
        return None
    channels = [float(channel) for channel in value]
    if not all(0.0 <= channel <= 1.0 for channel in channels):
        hint = " Divide values from 0 to 255 by 255." if max(channels) > 1.0 else ""
        raise StyleError(f"{value!r} is no colour: its channels must lie between 0 and 1.{hint}")
    red, green, blue = channels[:3]
    return red, green, blue, channels[3] if len(channels) == 4 else 1.0


def _from_text(text: str) -> Rgba:
    if HEX.fullmatch(text):
        digits = text[1:] if len(text) > 5 else "".join(2 * digit for digit in text[1:])
        red, green, blue, alpha = (
            int((digits + "ff")[place : place + 2], 16) / 255.0 for place in (0, 2, 4, 6)
        )
        return red, green, blue, alpha
    if text.lower() == "none":
        return 0.0, 0.0, 0.0, 0.0
    from matplotlib import colors

    try:
        red, green, blue, alpha = (float(channel) for channel in colors.to_rgba(text))
    except ValueError as error:
        hint = close_matches(text, [*colors.CSS4_COLORS, *colors.TABLEAU_COLORS])
        raise StyleError(f"{text!r} is no known colour.{hint} Give {COLOR_KINDS}.") from error
    return red, green, blue, alpha


def parse_colors(values: Any, count: int) -> NDArray[np.float64]:
    """One colour a row, float64 (count, 4). Raises StyleError that names the first row that has none."""
    if isinstance(values, np.ndarray) and values.ndim == 2 and values.dtype.kind in "iuf":
        table = _channel_table(values)
    else:
        try:
            listed = list(values)
        except TypeError as error:
            raise StyleError(
                f"color={values!r} is no colour. Give {COLOR_KINDS}, or a list of them."
            ) from error
        _check_count(len(listed), count)
        known: dict[Any, Rgba] = {}
        rows = [_remembered(known, value, row) for row, value in enumerate(listed)]
        table = np.array(rows, dtype=np.float64).reshape(-1, 4)
    _check_count(len(table), count)
    return table


def _check_count(found: int, count: int) -> None:
    if found != count:
        raise StyleError(
            f"color= lists {found} colours, but the layer has {count} rows. Give one colour, or one a row."
        )


def _remembered(known: dict[Any, Rgba], value: Any, row: int) -> Rgba:
    key = value if isinstance(value, (str, tuple)) else None
    if key is not None and key in known:
        return known[key]
    try:
        color = parse_color(value)
    except StyleError as error:
        raise StyleError(f"color= has no usable colour for row {row}: {error}") from error
    if key is not None:
        known[key] = color
    return color


def _channel_table(values: NDArray[Any]) -> NDArray[np.float64]:
    if values.shape[1] not in (3, 4):
        raise StyleError(
            f"A table of colours must have shape (rows, 3) or (rows, 4), but it is {values.shape}."
        )
    table = values.astype(np.float64) / (255.0 if values.dtype == np.uint8 else 1.0)
    wrong = ~((table >= 0.0) & (table <= 1.0)).all(axis=1)
    if wrong.any():
        row = int(np.flatnonzero(wrong)[0])
        raise StyleError(
            f"color= has channels outside 0 to 1 in row {row}: {values[row].tolist()}. Give values from 0 to"
            " 1, or an array of type uint8 from 0 to 255."
        )
    return table if table.shape[1] == 4 else np.column_stack([table, np.ones(len(table))])


def alpha_values(alpha: Any, count: int) -> NDArray[np.float64] | None:
    """Opacity as float64, () or (count,); None when none is given. Raises StyleError."""
    if alpha is None:
        return None
    try:
        values = np.asarray(alpha, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise StyleError(f"alpha={alpha!r} must be a number from 0 to 1, or one a row.") from error
    if values.ndim and values.shape != (count,):
        raise StyleError(
            f"alpha has shape {values.shape}, but the layer has {count} rows. Give one number, or one a row."
        )
    if not ((values >= 0.0) & (values <= 1.0)).all():
        wrong = values[~((values >= 0.0) & (values <= 1.0))].ravel()[0]
        raise StyleError(f"alpha must lie between 0 and 1, but it is {wrong:g}.")
    return values


def colormap(cmap: Any) -> Any:
    """A matplotlib colormap from its name, from itself, or from a list of colours. Raises StyleError."""
    import matplotlib as mpl
    from matplotlib.colors import Colormap, ListedColormap

    if isinstance(cmap, Colormap):
        return cmap
    if isinstance(cmap, str):
        try:
            return mpl.colormaps[cmap]
        except KeyError as error:
            hint = close_matches(cmap, list(mpl.colormaps))
            raise StyleError(
                f"{cmap!r} is no known colormap.{hint} Names are in matplotlib.colormaps."
            ) from error
    if isinstance(cmap, Sequence) and len(cmap):
        return ListedColormap([parse_color(color) for color in cmap])
    raise StyleError(
        f"cmap={cmap!r} must be a colormap, its name, a dict {{category: colour}} or a list of colours."
    )
