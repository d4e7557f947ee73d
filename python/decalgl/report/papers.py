"""The tables and figures of the other papers in their own form, out of the suites of the benchmark.

Thöny 2018, table 2; LOOPS, table 2 and figure 16; Taibo 2014, figures 10 to 12; Trapp 2015, table 2.
"""

from __future__ import annotations

import dataclasses
import statistics
from typing import TYPE_CHECKING

import decalgl as dg

from ..bench import workload
from ..bench.records import Records
from ..bench.suites import SUITES
from . import plots
from .case_studies import relief_of
from .part import Figure, Table, byte_count, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .part import Context, Row

TITLE = "Tables of the other papers"
ABOUT = (
    "The same questions put to our own implementations of what the papers describe, on isolines, iso-bands and streets,"
    " in software. Their numbers come from graphics cards of their time: shapes compare, milliseconds do not."
)
LARGE = ("1M", "5M")  # segments in a full report; Thöny's table alone has the second
ASKED = ("indexes", "loops", "clipmap", "distance_field")
# Vector map, lines, seconds of line assignment, milliseconds of rendering 3840 x 2160 (GTX 1080).
THOENY = (
    ("Vorarlberg ski slopes", 64_724, 3.37, 8),
    ("Vorarlberg streets", 728_661, 9.8, 8),
    ("New York PlutoMap", 5_578_677, 38.06, 15),
    ("Switzerland streets", 16_556_412, 101.7, 10),
    ("Carinthia isolines", 31_297_095, 120.7, 20),
)
# Primitives, those in the index, its megabytes, milliseconds of four views.
LOOPS = {
    "seg replica": ("21 M", "93 M", "1,100 MB", "84, 38, 33, 33 ms"),
    "tri replica": ("10 M", "56 M", "773 MB", "58, 27, 28, 29 ms"),
    "tri constant": ("10 M", "119.5 M", "1,810 MB", "57, 24, 18, 19 ms"),
}
# Milliseconds of 1, 2, 4 and 8 parameter sets, Berlin 1.
TRAPP = {
    "390 x 260": (3.0, 3.2, 4.1, 5.5),
    "670 x 450": (3.0, 3.2, 4.1, 5.7),
    "1280 x 800": (25.5, 29.0, 36.1, 50.1),
}
SETS = (1, 2, 4, 8)


def rows(context: Context) -> list[Row]:
    """What the suites record on real data; quick on a smaller terrain, stretched to where their cameras stand."""
    real = context.size == "full"
    work = workload.Workload(
        ground=workload.real_ground() if real else _stretched(relief_of(context.step)),
        folder=context.data if real else context.out / "contours",
        sizes={size: workload.SIZES[size] for size in LARGE} if real else {"few": workload.Size(60.0, 120.0)},
        middle=LARGE[0] if real else "few",
        say=context.say,
        picture=context.chosen((32, 18), (192, 108), context.picture),
        runs=min(context.runs, 2),
        towns=("helsinki",) if real else (),
    )
    records = Records()
    for suite in ASKED if context.size != "tiny" else ("distance_field",):
        before = len(records.list())
        SUITES[suite](work, records)
        for size in list(work.sizes)[1:] if suite == "indexes" else ():
            SUITES[suite](dataclasses.replace(work, middle=size), records)
        for record in records.list()[before:]:
            record["suite"] = suite
    return records.list()


def _stretched(ground: dg.Terrain) -> dg.Terrain:
    """Over San Francisco bay, whose size the benchmark's cameras are made for."""
    rows, columns = ground.shape
    dx, dy = 89_000.0 / (columns - 1), 111_000.0 / (rows - 1)
    return dg.Terrain(ground.z, -44_500.0, 55_600.0, dx, dy)


def figures(rows: Sequence[Row]) -> list[Figure]:
    """One for each table or figure of a paper that the rows have numbers for."""
    made = (_thoeny(rows), _loops_table(rows), *_loops_flight(rows), *_taibo(rows), _trapp(rows))
    return [figure for figure in made if figure is not None]


def _thoeny(rows: Sequence[Row]) -> Figure | None:
    measured = ("preprocess_ms", "bvh_ms")
    own = [row for row in rows if row["technique"] == "thoeny" and any(name in row for name in measured)]
    if not own:
        return None
    cells = [(name, f"{lines:,}", f"{assign} s", f"{render} ms") for name, lines, assign, render in THOENY]
    for scene in dict.fromkeys(row["scene"] for row in own):
        (whole,) = (row for row in own if row["scene"] == scene and "preprocess_ms" in row)
        render = statistics.median(row["bvh_ms"] for row in own if row["scene"] == scene and "bvh_ms" in row)
        times = (f"{number(whole['preprocess_ms'] / 1000.0)} s", f"{number(render)} ms")
        cells.append((f"ours: {scene}", f"{whole['segments']:,.0f}", *times))
    return Figure(
        "Thöny 2018, table 2",
        '256 x 256 clusters (index="thoeny"); render times are the layers\' passes, medians of the views.',
        table=Table(("data set", "lines", "line assignment", "render time"), cells),
    )


def _loops_table(rows: Sequence[Row]) -> Figure | None:
    cells = []
    for row in rows:
        name = row["technique"].removeprefix("loops ")
        if name in LOOPS or name == "tri fitted":
            theirs = LOOPS.get(name, ("",) * 4)
            cells.append(
                (
                    name,
                    number(row["loops_primitives"]),
                    number(row["loops_references"]),
                    byte_count(row["loops_bytes"]),
                    f"{number(row['loops_ms'])} ms",
                    *theirs,
                )
            )
    if not cells:
        return None
    heads = ("primitives", "in the index", "its size", "time")
    columns = ("primitives, index", *heads, *(f"theirs: {head}" for head in heads))
    return Figure("LOOPS, table 2", "Isolines; time is the mean of four views.", table=Table(columns, cells))


def _loops_flight(rows: Sequence[Row]) -> list[Figure]:
    own = [row for row in rows if row["technique"].startswith("loops ") and "loops_fitted_time" in row]
    if not own:
        return []
    points = [
        plots.Point(row["loops_bytes"] / 1e6, row["loops_ms"], name, name)
        for row in own
        for name in [row["technique"].removeprefix("loops ")]
    ]
    path = "Iso-bands along the flight of four phases"
    return [
        Figure(
            "LOOPS, figure 16: indexes",
            f"{path}: mean time of the layers' passes over the size of the index.",
            plots.scatter(points, "MB of the index", "ms"),
        ),
        *_loops_steps([row for row in rows if "step_ms" in row], path),
    ]


def _loops_steps(rows: Sequence[Row], path: str) -> list[Figure]:
    """Time along the flight, and what takes it."""
    if not rows:
        return []
    along: dict[str, list[tuple[float, float]]] = {}
    shares: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        name = row["technique"].removeprefix("loops ")
        own = along.setdefault(name, [])
        step = len(own) + 1.0
        own.append((step, row["step_ms"]))
        if name == "cells":
            shares.setdefault("terrain", []).append((step, row["step_terrain_ms"]))
            shares.setdefault("walking the index, making cells", []).append((step, row["step_cells_ms"]))
            shares.setdefault("drawing", []).append((step, row["step_ms"] - row["step_cells_ms"]))
    return [
        Figure(
            "LOOPS, figure 16 (a) to (c): time along the trajectory",
            f"{path}: the layers' passes of each frame, for the paper's indexes and ours.",
            plots.curves(along, "step of the flight", "ms", "y"),
        ),
        Figure(
            "LOOPS, figure 16 (d): what takes it",
            f"{path}, by our cells: the terrain's pass, walking the index and making cells, drawing.",
            plots.curves(shares, "step of the flight", "ms", "y"),
        ),
    ]


def _taibo(rows: Sequence[Row]) -> list[Figure]:
    """Relative to the best of each set of lines, as the paper's figures are."""
    own = [row for row in rows if row["technique"].startswith("clipmap ")]
    made = {
        "Taibo 2014, figure 10: memory": ("prepared_bytes", "What tiles are drawn from"),
        "Taibo 2014, figure 11: generation": ("generate_ms", "Preparing"),
        "Taibo 2014, figure 12: rendering": ("tiles_ms", "Drawing all tiles of a view anew"),
    }
    found = []
    for title, (column, words) in made.items():
        groups = {}
        for scene in dict.fromkeys(row["scene"] for row in own):
            values = {
                row["technique"].removeprefix("clipmap "): row[column] for row in own if row["scene"] == scene
            }
            best = min(values.values())
            groups[scene] = {f"solution {name}": 100.0 * value / best for name, value in values.items()}
        if groups:
            found.append(
                Figure(
                    title, f"{words}, in percent of the best solution.", plots.bars(groups, "% of the best")
                )
            )
    return found


def _trapp(rows: Sequence[Row]) -> Figure | None:
    own = [row for row in rows if "style_sets" in row]
    if not own:
        return None
    cells = [(f"theirs: Berlin 1, {size}", *(f"{ms} ms" for ms in times)) for size, times in TRAPP.items()]
    for town, size in dict.fromkeys((row["town"], row["picture"]) for row in own):
        times = {
            row["style_sets"]: row["sets_ms"] for row in own if (row["town"], row["picture"]) == (town, size)
        }
        cells.append((f"ours: {town}, {size}", *(f"{number(times.get(sets))} ms" for sets in SETS)))
    return Figure(
        "Trapp 2015, table 2",
        "Drawing a network by the number of style sets.",
        table=Table(("network, picture", *(f"{sets} sets" for sets in SETS)), cells),
    )
