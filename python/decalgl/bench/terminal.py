"""The ratios of a run beside their goals, in the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from .goals import RATIOS

if TYPE_CHECKING:
    from .goals import Ratio
    from .records import Record

COLORS = {True: "green", False: "red", None: ""}


def table(records: list[Record], picture: tuple[int, int]) -> Table:
    """Every ratio of the records, green where it reaches its goal."""
    width, height = picture
    result = Table("scene", "view", "ratio", "is", "goal", "of", title=f"Static decals, {width} x {height}")
    for name, ratio in RATIOS.items():
        found = [record for record in records if name in record]
        for record in found:
            result.add_row(*_row(record, name, ratio), end_section=record is found[-1])
    return result


def _row(record: Record, name: str, ratio: Ratio) -> list[str]:
    value = f"{record[name]:.2f}"
    color = COLORS[ratio.reached(record, record[name])]
    shown = f"[{color}]{value}[/]" if color else value
    source = ratio.source.format(**record)
    return [record["scene"], record["view"] or "", name, shown, ratio.goal(record), source]
