"""Patterns along lines as users give them: dashes by name or by length, arrows, stipples, marks of their own.

    Pattern.dashes(6, 3)              ======   ======   ======
    Pattern.arrows(20, 5)             >        >        >
    Pattern.stipple("1101", 2)        ==== == ==== == ==== ==

Dashes by name are matplotlib's, whose lengths are multiples of the line's width.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ._values import finite_number, is_listed, is_number, is_word
from .errors import StyleError, close_matches
from .strokes import LinePattern, PatternMark, WidthUnits

if TYPE_CHECKING:
    from collections.abc import Sequence

PatternUnits = Literal["m", "px", "width"]
MOST_MARKS = 16
# Lengths on and off in line widths: rcParams lines.dashed_pattern and its siblings as matplotlib ships them.
NAMED_DASHES = {
    "solid": (),
    "dashed": (3.7, 1.6),
    "dotted": (1.0, 1.65),
    "dashdot": (6.4, 1.6, 1.0, 1.6),
}
SYMBOLS = {"-": "solid", "--": "dashed", ":": "dotted", "-.": "dashdot"}
DASH_KINDS = (
    "'dashed', 'dotted', 'dashdot', 'solid', lengths on and off such as (10, 5), or a decalgl.Pattern"
)


@dataclass(frozen=True)
class Pattern:
    """Marks that repeat along a line, by its length on the map from its first vertex.

    period: the length after which the marks come again.
    marks: up to 16 tuples (begin, end) or (begin, end, begin_width, end_width): from where to where in the
        period, and what share of the line's width, 0 to 1, is covered there; a mark is a trapezoid.
    offset: how far into the period a line begins.
    units: of all lengths: "m", metres on the map; "px", pixels on the screen, seen head-on, for widths on the screen
        alone; "width", multiples of each line's own width; None, those of the line's width.

    Raises StyleError.
    """

    period: float
    marks: Sequence[Sequence[float]]
    offset: float = 0.0
    units: PatternUnits | None = None

    def __post_init__(self) -> None:
        period = finite_number(self.period, "Pattern period")
        if period <= 0.0:
            raise StyleError(f"Pattern period must be a length above 0, but it is {period:g}.")
        if self.units is not None and not is_word(self.units, ("m", "px", "width")):
            raise StyleError(f"Pattern units must be 'm', 'px' or 'width', but they are {self.units!r}.")
        object.__setattr__(self, "period", period)
        object.__setattr__(self, "offset", finite_number(self.offset, "Pattern offset"))
        object.__setattr__(self, "marks", _checked_marks(self.marks, period))

    @classmethod
    def dashes(cls, *lengths: float, offset: float = 0.0, units: PatternUnits | None = None) -> Pattern:
        """Lengths on, off, on, off, ...; an odd number of them is taken twice over, as SVG does."""
        if len(lengths) % 2:
            lengths += lengths
        marks, place = [], 0.0
        for number, length in enumerate(lengths):
            length = finite_number(length, f"Dash length number {number + 1}")
            if length < 0.0 or (length == 0.0 and number % 2 == 0):
                raise StyleError(
                    f"Dash length number {number + 1} is {length:g}; what is on must be longer than 0, and what is"
                    " off 0 or longer."
                )
            if number % 2 == 0:
                marks.append((place, place + length))
            place += length
        return cls(place, marks, offset, units)

    @classmethod
    def arrows(
        cls,
        every: float,
        length: float,
        shaft: float = 0.0,
        offset: float = 0.0,
        units: PatternUnits | None = None,
    ) -> Pattern:
        """Arrowheads of the line's whole width that point along it, one in each stretch of `every`.

        length: of an arrowhead. shaft: the share of the width that is drawn between the heads.
        """
        every = finite_number(every, "Pattern.arrows every")
        length = finite_number(length, "Pattern.arrows length")
        if not 0.0 < length <= every:
            raise StyleError(
                f"Pattern.arrows length must lie above 0 and up to every={every:g}, but it is {length:g}."
            )
        rest = every - length
        line = [(0.0, rest, shaft, shaft)] if shaft != 0.0 and rest > 0.0 else []
        return cls(every, [*line, (rest, every, 1.0, 0.0)], offset, units)

    @classmethod
    def stipple(
        cls, bits: str, step: float, offset: float = 0.0, units: PatternUnits | None = None
    ) -> Pattern:
        """On and off in equal steps: bits such as "11110010", each as long as `step`."""
        step = finite_number(step, "Pattern.stipple step")
        if not isinstance(bits, str) or set(bits) - {"0", "1"} or "1" not in bits:
            raise StyleError(
                f"Pattern.stipple bits must be a text of 0 and 1 with a 1, such as '11110010', but it is {bits!r}."
            )
        edges = np.flatnonzero(np.diff([0, *map(int, bits), 0]))
        marks = [(begin * step, end * step) for begin, end in zip(edges[::2], edges[1::2], strict=True)]
        return cls(len(bits) * step, marks, offset, units)

    def for_width(self, width: float, width_units: WidthUnits = "m") -> LinePattern:
        """The pattern of a line of this width."""
        units: WidthUnits = self.units if self.units in ("m", "px") else width_units
        scale = width if self.units == "width" else 1.0
        marks = tuple(
            # The product may lie a rounding beyond the period's.
            PatternMark(begin * scale, min(end * scale, self.period * scale), begin_width, end_width)
            for begin, end, begin_width, end_width in self.marks
        )
        period = self.period * scale
        return LinePattern(period, marks, (self.offset * scale) % period, units)


def _checked_marks(marks: Any, period: float) -> tuple[tuple[float, float, float, float], ...]:
    if not is_listed(marks):
        raise StyleError(f"Pattern marks must be a list of tuples (begin, end), but they are {marks!r}.")
    if not 1 <= len(marks) <= MOST_MARKS:
        raise StyleError(f"A Pattern has from 1 to {MOST_MARKS} marks, but {len(marks)} are given.")
    return tuple(_checked_mark(mark, number, period) for number, mark in enumerate(marks, start=1))


def _checked_mark(mark: Any, number: int, period: float) -> tuple[float, float, float, float]:
    what = f"Pattern mark {number}"
    if not is_listed(mark) or len(mark) not in (2, 4):
        raise StyleError(
            f"{what} must be (begin, end) or (begin, end, begin_width, end_width), but it is {mark!r}."
        )
    values = [finite_number(value, what) for value in mark]
    begin, end, begin_width, end_width = values if len(values) == 4 else (*values, 1.0, 1.0)
    if not 0.0 <= begin < end <= period:
        raise StyleError(
            f"{what} must begin before it ends, within the period of {period:g}, but it goes from {begin:g} to"
            f" {end:g}."
        )
    if not (0.0 <= begin_width <= 1.0 and 0.0 <= end_width <= 1.0):
        raise StyleError(
            f"{what} has widths {begin_width:g} and {end_width:g}; give shares of the line's width from 0 to 1."
        )
    return begin, end, begin_width, end_width


def parse_dash(value: Any) -> Pattern | None:
    """One dash= of any form; None is a solid line. Raises StyleError that begins with the value."""
    if value is None or isinstance(value, Pattern):
        return value
    if isinstance(value, str):
        return _named(value)
    if not is_dash_lengths(value):
        raise StyleError(f"{value!r} is no dash. Give {DASH_KINDS}.")
    offset, lengths = (0.0, value) if _is_lengths(value) else value
    try:
        return Pattern.dashes(*lengths, offset=offset)
    except StyleError as error:
        raise StyleError(f"{value!r}: {error}") from error


def is_dash_lengths(value: Any) -> bool:
    """Whether it is one dash as lengths: (on, off, ...) or matplotlib's (offset, (on, off, ...))."""
    if _is_lengths(value):
        return True
    return isinstance(value, tuple) and len(value) == 2 and is_number(value[0]) and _is_lengths(value[1])


def _is_lengths(value: Any) -> bool:
    listed = isinstance(value, (tuple, list, np.ndarray)) and is_listed(value)
    return listed and len(value) > 0 and all(map(is_number, value))


def _named(name: str) -> Pattern | None:
    if name not in NAMED_DASHES:
        meant = f" Did you mean {SYMBOLS[name]!r}?" if name in SYMBOLS else close_matches(name, NAMED_DASHES)
        raise StyleError(f"{name!r} is no dash.{meant} Give {DASH_KINDS}, or a column's name.")
    lengths = NAMED_DASHES[name]
    return Pattern.dashes(*lengths, units="width") if lengths else None
