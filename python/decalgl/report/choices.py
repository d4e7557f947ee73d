"""What to choose when: for each wish, the setting that comes out of the rows."""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING

from .part import Figure, Table, byte_count, number

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .part import Row

FAINT, FINE = 0.03, 0.015
# What a median over frames of one view does not tell.
PAINTED = "Clipmaps are timed in views whose tiles are painted already."
TIE = 0.05  # as a share: no difference to choose by
TIE_PREPARING = 0.25  # it is timed once


def figure(rows: Sequence[Row]) -> Figure:
    """A table of wishes; those of lines in pixels are for dynamic lines."""
    metres = _everywhere([row for row in rows if row["technique"] != "dynamic"])
    pixels = _everywhere([row for row in rows if row["technique"] == "dynamic"])
    wishes: list[tuple[str, list[list[Row]], str, Callable[[list[Row]], bool]]] = [
        ("the quickest picture", metres, "frame", lambda _: True),
        (f"borders within {FAINT:g}, quickly", metres, "frame", lambda one: _of(one, "edge_rms") <= FAINT),
        (f"borders within {FINE:g}, quickly", metres, "frame", lambda one: _of(one, "edge_rms") <= FINE),
        ("the most exact picture", metres, "edge_rms", lambda _: True),
        ("the least memory", metres, "layers_bytes", lambda _: True),
        ("ready the soonest", metres, "prepare_ms", lambda _: True),
        ("lines as wide as on the screen, quickly", pixels, "frame", lambda _: True),
        ("lines as wide as on the screen, exactly", pixels, "edge_rms", lambda _: True),
    ]
    cells = []
    for wish, among, by, fits in wishes:
        fitting = [one for one in among if fits(one)]
        if not fitting:
            cells.append((wish, "none of them", "", "", "", "", ""))
            continue
        best = _best(fitting, by)
        cells.append(
            (
                wish,
                best[0]["technique"],
                best[0]["setting"],
                number(_of(best, "frame")),
                f"{_of(best, 'edge_rms'):.4f}",
                f"{number(_of(best, 'prepare_ms'))} ms",
                byte_count(_of(best, "layers_bytes")),
            )
        )
    return Figure(
        "What to choose when",
        "Of the settings that draw every scene, the one whose median over scenes and views fits the wish best; of those"
        f" that are within {TIE:.0%} of it, or within {TIE_PREPARING:.0%} of the time of preparing, the quickest."
        f" {PAINTED}",
        table=Table(
            ("wish", "technique", "setting", "frame ÷ floor", "error at borders", "prepare", "memory"), cells
        ),
    )


def _everywhere(rows: Sequence[Row]) -> list[list[Row]]:
    """The rows of each setting that drew all scenes and views that any of these rows is of."""
    whole = len({(row["scene"], row["view"]) for row in rows})
    keys = dict.fromkeys((row["technique"], row["setting"]) for row in rows)
    grouped = [[row for row in rows if (row["technique"], row["setting"]) == key] for key in keys]
    return [own for own in grouped if len(own) == whole]


def _best(settings: Sequence[list[Row]], by: str) -> list[Row]:
    tie = TIE_PREPARING if by == "prepare_ms" else TIE
    most = (1.0 + tie) * min(_of(one, by) for one in settings)
    return min((one for one in settings if _of(one, by) <= most), key=lambda one: _of(one, "frame"))


def _of(rows: Sequence[Row], name: str) -> float:
    return float(statistics.median(row[name] for row in rows))
