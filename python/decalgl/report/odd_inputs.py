"""Odd inputs: what no number drives, each a scene that a technique draws right or refuses."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from decalgl.terrain import Terrain

from . import stability
from .extremes import Case, circle, hills, seen_from
from .part import Figure, Table
from .stability import EXACT, SHORT, WAYS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .extremes import FloatArray, Rings
    from .part import Context, Row

TITLE = "Odd inputs"
ABOUT = (
    "Small scenes with something odd in them, drawn by every technique and judged as the extremes are. What comes as"
    " points that are no numbers is refused before any technique sees it."
)
SQUARE = np.array([(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)])
BOW_TIE = np.array([(-30.0, -20.0), (30.0, 20.0), (30.0, -20.0), (-30.0, 20.0)])
TOUCHING = np.array([(0.0, 0.0), (30.0, 10.0), (30.0, -12.0), (0.0, 0.0), (-30.0, -10.0), (-30.0, 12.0)])
WAY = np.array([(-40.0, -20.0), (-10.0, 18.0), (20.0, -14.0), (42.0, 25.0)])


def _case(polygons: Rings, lines: Rings, width: float = 3.0, terrain: Terrain | None = None) -> Case:
    camera, pixel = seen_from(100.0, 150.0, 65.0)
    return Case(terrain or hills(100.0, 8.0), camera, pixel, polygons, lines, width)


def _polygons(*rings: FloatArray) -> Case:
    """One feature of these rings, and a way across it."""
    return _case([list(rings)], [[WAY]])


def _lines(*parts: FloatArray) -> Case:
    return _case([[SQUARE]], [[part] for part in parts])


def _flat(rows: int, columns: int) -> Case:
    return _case(
        [[SQUARE]], [[WAY]], terrain=Terrain(np.zeros((rows, columns), np.float32), -40.0, 40.0, 80.0, 80.0)
    )


def _with_holes() -> Case:
    ground = hills(100.0, 8.0)
    z = ground.z.copy()
    z[12:15, 14:21] = np.nan
    z[20, 20] = np.nan
    return _case([[SQUARE]], [[WAY]], terrain=Terrain(z, ground.x0, ground.y0, ground.dx, ground.dy))


def _cliff() -> Case:
    heights = np.where(np.arange(33) < 16, 0.0, 60.0) + np.zeros((33, 1))
    ground = Terrain(heights.astype(np.float32), -100.0, 100.0, 6.25, 6.25)
    return _case([[1.5 * SQUARE]], [[WAY]], terrain=ground)


def _spikes() -> Case:
    """A line that goes back on itself, and a ring with a spike of no width."""
    back = np.array([(-40.0, 30.0), (40.0, 30.0), (-20.0, 30.0)])
    spiked = np.array(
        [(-20.0, -20.0), (20.0, -20.0), (20.0, 0.0), (45.0, 0.0), (20.0, 0.0), (20.0, 20.0), (-20.0, 20.0)]
    )
    return _case([[spiked]], [[back]])


def _with(value: float) -> Case:
    way = WAY.copy()
    way[1, 0] = value
    return _case([[np.where(SQUARE[0, 0] == SQUARE, value, SQUARE)]], [[way]])


ODD_INPUTS: dict[str, Callable[[], Case]] = {
    "terrain of one sample": lambda: _flat(1, 1),
    "terrain of one row": lambda: _flat(1, 5),
    "terrain of one quad": lambda: _flat(2, 2),
    "holes in the terrain": _with_holes,
    "a cliff": _cliff,
    "lines of no length": lambda: _lines(
        np.array([(5.0, 5.0), (5.0, 5.0)]), np.repeat([[-20.0, 10.0]], 5, axis=0), WAY
    ),
    "repeated points": lambda: _case([[np.repeat(SQUARE, 3, axis=0)]], [[np.repeat(WAY, 4, axis=0)]]),
    "segments laid twice": lambda: _lines(WAY, WAY, WAY[::-1]),
    "spikes": _spikes,
    "lines of width 0": lambda: _case([[SQUARE]], [[WAY]], width=0.0),
    "a line wider than the map": lambda: _case([[SQUARE]], [[WAY]], width=1000.0),
    "features larger than the map": lambda: _case([[1e5 * SQUARE + 7.0]], [[1e5 * WAY]], width=10.0),
    "a ring that crosses itself": lambda: _polygons(BOW_TIE),
    "a star drawn in one stroke": lambda: _polygons(circle(35.0, 5)[[0, 2, 4, 1, 3]]),
    "a ring that touches itself": lambda: _polygons(TOUCHING),
    "rings that overlap and repeat": lambda: _polygons(SQUARE, SQUARE + 12.0, SQUARE + 12.0, SQUARE + 6.0),
    "rings turning either way": lambda: _polygons(SQUARE[::-1], 0.5 * SQUARE[::-1], 0.2 * SQUARE),
    "features without parts": lambda: _case([[SQUARE], [], [BOW_TIE]], [[], [WAY]]),
    "rings of two points": lambda: _case([[SQUARE[:2]], [SQUARE]], [[WAY]]),
    "points that are no numbers": lambda: _with(math.nan),
    "points at infinity": lambda: _with(math.inf),
}


def rows(context: Context) -> list[Row]:
    """A row for each input and technique: how far its picture is from the reference, or an `error`; the `verdict`."""
    names = list(ODD_INPUTS)[: context.chosen(2, None, None)]
    row_of = functools.partial(_row, every=stability.judged_pixels(context))
    with stability.judges() as pool:
        return list(pool.map(row_of, [(name, technique) for name in names for technique in WAYS]))


def _row(asked: tuple[str, str], every: int) -> Row:
    name, technique = asked
    return {
        "scene": name,
        "technique": technique,
        **stability.judged(WAYS[technique], ODD_INPUTS[name](), every),
    }


def figures(rows: Sequence[Row]) -> list[Figure]:
    """The table of verdicts, and what is said where they are not exact."""
    said = [
        [row["scene"], row["technique"], row["verdict"], row.get("error") or row.get("warning") or ""]
        for row in rows
        if row["verdict"] != EXACT
    ]
    columns = ["input", "technique", "verdict", "what it says"]
    return [
        Figure("Verdicts on odd inputs", "By the limits of the extremes.", table=verdicts(rows)),
        Figure("Where they are not exact", "And what is said.", table=Table(columns, said)),
    ]


def verdicts(rows: Sequence[Row]) -> Table:
    """What each technique makes of each input."""
    cells = {(row["scene"], row["technique"]): SHORT[row["verdict"]] for row in rows}
    names = dict.fromkeys(row["scene"] for row in rows)
    return Table(["input", *WAYS], [[name, *(cells.get((name, way), "–") for way in WAYS)] for name in names])
