"""Influence factors: chapter 5 of Zechmeister 2020 measured anew, figures 5.5 to 5.17 and table 5.4.

One factor grows, everything else stays: what do memory, preparing and drawing do? Each is measured for the structures
that the thesis describes (index="bvh", method="lists") and for ours (grid, tiles).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import decalgl as dg

from ..bench.measure import LAYER_PASSES, draw, drawing, interleaved, timed
from ..errors import DecalError
from . import factor_shares, plots
from .factor_list import COLUMNS, FACTORS, REASONS, Maps
from .part import Figure, Table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..bench.measure import Measure
    from .factor_list import Case, Factor
    from .part import Context, Row

TITLE = "Influence factors"
ABOUT = (
    "What grows with what, as in chapter 5 of Zechmeister 2020: + grows, – shrinks, ~ stays within the noise, empty:"
    " nothing changes. Published are the thesis's structures, built anew here; ours are the grid and the tiles. The"
    " sign of a time counts from a change of a quarter, four times the spread, and 5 ms of preparing or 1 ms of"
    " drawing on, that of memory from 5 % on."
)
NOISE, SPREADS = 0.25, 4.0
LEAST_MS = {"update_ms": 5.0, "render_ms": 1.0}
MEMORY_NOTHING, MEMORY_LITTLE = 0.002, 0.05


def rows(context: Context) -> list[Row]:
    """A row for each factor, way and value."""
    maps = Maps(context)
    found: list[Row] = []
    for factor in FACTORS:
        if context.size == "tiny" and not factor.tiny:
            continue
        for way, make in factor.ways.items():
            context.say(f"{factor.name}, {factor.decals}: {way}")
            values = factor.few if context.size != "full" else factor.values
            found += _measured(context, factor, way, {str(value): make(maps, value) for value in values})
    context.say("shares")
    return [*found, *factor_shares.rows(context, maps)]


def _measured(context: Context, factor: Factor, way: str, cases: dict[str, Case]) -> list[Row]:
    """Prepares and draws the cases in turns; a row of one that is refused says so."""
    words = {"factor": factor.name, "decals": factor.decals, "technique": way}
    found: list[Row] = []
    renderers = {}
    ranks = {value: rank for rank, value in enumerate(cases)}
    for value, case in list(cases.items()):
        prepared = _prepared(case)
        if isinstance(prepared, str):
            found.append({**words, "value": value, "refused": prepared})
            del cases[value]
        else:
            renderers[value] = prepared
    measures: list[Measure] = []
    for value, case in cases.items():
        measures.append(drawing(renderers[value], case.camera, case.antialias, value))
        measures.append(_preparing(case, value))
        measures.append(_floor(renderers[value], value))
    times = interleaved(context.runs, *measures)
    for value, case in cases.items():
        held = draw(renderers[value], case.camera, case.antialias).stats.bytes
        row: Row = {
            **words,
            "value": value,
            "rank": ranks[value],
            "memory_bytes": sum(count for name, count in held.items() if name in LAYER_PASSES),
            "render_ms": times[f"{value}_frame_ms"] - times[f"{value}_ground_ms"],
            "update_ms": times[f"{value}_prepare_ms"],
            "floor_ms": times[f"{value}_floor_ms"],
        }
        for name, source in (("render_ms", f"{value}_frame_ms"), ("update_ms", f"{value}_prepare_ms")):
            if f"{source}_spread" in times:
                row[f"{name}_spread"] = times[f"{source}_spread"]
        found.append(row)
    return found


def _prepared(case: Case) -> dg.Renderer | str:
    """A renderer that has drawn the case, or what it says where it does not."""
    try:
        renderer = dg.Renderer(case.size, **case.renderer)
        renderer.preprocess(case.scene)
        draw(renderer, case.camera, case.antialias)
    except DecalError as error:
        return str(error)
    return renderer


def _preparing(case: Case, value: str) -> Measure:
    return lambda: {
        f"{value}_prepare_ms": timed(lambda: dg.Renderer(case.size, **case.renderer).preprocess(case.scene))
    }


def _floor(renderer: dg.Renderer, value: str) -> Measure:
    return lambda: {f"{value}_floor_ms": renderer.time_floor()}


def figures(rows: Sequence[Row]) -> list[Figure]:
    """Table 5.4, the disagreements with their reasons, a plot for each factor, and shares."""
    every, rows = rows, [row for row in rows if "factor" in row and "refused" not in row]
    caption = "M, U, R: memory, preparing (the thesis's update), drawing, as the factor grows."
    found = [Figure("Table 5.4: factors and their signs", caption, table=signs(rows)), _reasons_figure(rows)]
    for factor in FACTORS:
        own = [row for row in rows if (row["factor"], row["decals"]) == (factor.name, factor.decals)]
        if own:
            found.append(_factor_figure(factor, own))
    refused = [row for row in every if "refused" in row]
    if refused:
        cells = [
            (row["factor"], row["decals"], row["technique"], row["value"], row["refused"]) for row in refused
        ]
        table = Table(("factor", "decals", "way", "value", "error"), cells)
        found.append(Figure("Refused", "Values that a way does not draw.", table=table))
    return [*found, *factor_shares.figures(every)]


def sign(rows: Sequence[Row], column: str) -> str:
    """What a column does from the first value to the last: +, –, ~ or nothing."""
    ranked = sorted(rows, key=lambda row: row["rank"])
    first, last = ranked[0][column], ranked[-1][column]
    if first <= 0.0 or last <= 0.0:
        return "" if first == last else "+"
    change = abs(math.log(last / first))
    if column in LEAST_MS:
        if abs(last - first) < LEAST_MS[column]:
            return "~"
        least = math.log1p(max(NOISE, SPREADS * max(row.get(f"{column}_spread", 0.0) for row in ranked)))
        return "~" if change <= least else "+" if last > first else "–"
    if change <= MEMORY_NOTHING:
        return ""
    return "~" if change <= MEMORY_LITTLE else "+" if last > first else "–"


def disagreements(rows: Sequence[Row]) -> list[tuple[str, str, str, str, str, str]]:
    """(factor, decals, way, column, the two signs, the reason) where our sign is not the thesis's."""
    found = []
    for factor in FACTORS:
        for way in factor.ways:
            own = _of(rows, factor, way)
            for theirs, column in zip(factor.signs, COLUMNS, strict=True):
                if own and (got := sign(own, column)).strip("~") != theirs.strip("~"):
                    reason = REASONS.get((factor.name, factor.decals, way, column), "")
                    signs = f"{theirs or 'nothing'} there, {got or 'nothing'} here"
                    found.append((factor.name, factor.decals, way, COLUMNS[column], signs, reason))
    return found


def _of(rows: Sequence[Row], factor: Factor, way: str) -> list[Row]:
    key = (factor.name, factor.decals, way)
    return [row for row in rows if (row["factor"], row["decals"], row["technique"]) == key]


def signs(rows: Sequence[Row]) -> Table:
    """Table 5.4 with our signs beside the thesis's."""
    cells = []
    rows = [row for row in rows if "factor" in row and "refused" not in row]
    for factor in FACTORS:
        ours = {way: own for way in factor.ways if (own := _of(rows, factor, way))}
        if not ours:
            continue
        found = [
            sign(own, column)
            for way in ("published", "ours")
            for column in COLUMNS
            for own in [ours.get(way)]
            if own
        ]
        blank = ["no such choice"] + [""] * 2
        published = found[:3] if "published" in ours else blank
        own_signs = found[-3:] if "ours" in ours else blank
        values = [row["value"] for row in sorted(next(iter(ours.values())), key=lambda row: row["rank"])]
        span = f"{values[0]}, {values[-1]}"
        cells.append((factor.decals, factor.name, span, *factor.signs, *published, *own_signs))
    heads = [
        f"{who}: {name[0].upper()}" for who in ("thesis", "published", "ours") for name in COLUMNS.values()
    ]
    return Table(("decals", "factor", "from, to", *heads), cells)


def _reasons_figure(rows: Sequence[Row]) -> Figure:
    cells = disagreements(rows)
    return Figure(
        "Where we disagree with the thesis",
        "Each sign that is another one, and why. On small scenes and busy machines signs of times come and go;"
        " one without a reason is one that no earlier run showed.",
        table=Table(("factor", "decals", "way", "of", "signs", "reason"), cells),
    )


def _factor_figure(factor: Factor, rows: Sequence[Row]) -> Figure:
    """All columns ÷ their first value."""
    series = {}
    for way in factor.ways:
        own = sorted(_of(rows, factor, way), key=lambda row: row["rank"])
        for column, name in COLUMNS.items():
            if own and own[0][column] > 0.0:
                series[f"{name}, {way}"] = [(row["rank"], row[column] / own[0][column]) for row in own]
    labels = list(dict.fromkeys(row["value"] for row in sorted(rows, key=lambda row: row["rank"])))
    return Figure(
        f"{factor.figure}: {factor.name}, {factor.decals}",
        f"Relative to the first value. Values: {', '.join(labels)}.",
        plots.curves(series, factor.name, "÷ first", log="y", ticks=labels),
    )
