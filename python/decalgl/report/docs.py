"""The documentation's figures that come from the report: `decalgl report --out DIR --docs`.

The report's numbers are kept in bench/results/report.json; parts that a report leaves out stay as they were kept, each
with the size and the machine that it was measured with. What stands between <!-- report:NAME --> and
<!-- /report --> of a page is replaced by what `BLOCKS` makes for NAME, and `PLOTS` are drawn anew.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..bench import comparison, folders
from ..bench.docs import filled
from ..errors import InputError
from . import choices, error_over_time, factors, needless, odd_inputs, scaling, scenes, sizes, stability
from .command import as_text
from .extremes import EXTREMES
from .part import number
from .parts import PARTS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path
    from typing import Any

    from .part import Figure, Row, Table

    Results = Mapping[str, Any]

PAGES = ("README.md", "docs/report.md", "docs/extremes.md")
IMAGES = "docs/images"
KEPT = "bench/results/report.json"
DIGITS = 5  # of the numbers that are kept


def update(out: Path) -> list[Path]:
    """Takes over the report of a folder; the files that were written. Raises InputError outside of a checkout."""
    root = folders.checkout()
    if root is None:
        raise InputError("There is no documentation beside an installed package. Run --docs in a checkout.")
    kept = root / KEPT
    results = merged(comparison.read(kept), comparison.read(out / "report.json"))
    kept.write_text(as_text(results))
    for name in PLOTS:
        (root / name).write_text(plot(name, results), encoding="utf-8")
    for page in PAGES:
        path = root / page
        path.write_text(fill(path.read_text(), results))
    return [root / name for name in (KEPT, *PLOTS, *PAGES)]


def merged(kept: Results, new: Results) -> dict[str, Any]:
    """What is kept, its parts replaced by those that are new, with as many digits as matter."""
    parts = {name: {**one, "machine": new["machine"]} for name, one in new["parts"].items()}
    stay = [row for row in kept["records"] if row["part"] not in parts]
    records = [*stay, *(_rounded(row) for row in new["records"])]
    records.sort(key=lambda row: list(PARTS).index(row["part"]))
    return {"machine": new["machine"], "parts": {**kept["parts"], **parts}, "records": records}


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _rounded(one) for name, one in value.items()}
    if isinstance(value, list):
        return [_rounded(one) for one in value]
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def plot(name: str, results: Results) -> str:
    """The text of an SVG file of that path; its points lead nowhere, as pictures lie with the report."""
    part, figure = PLOTS[name]
    drawn = figure([{**row, "picture": ""} for row in _rows(results, part)]).plot
    assert isinstance(drawn, str)
    return drawn


def fill(text: str, results: Results) -> str:
    """The text with its marked tables made anew."""
    return filled("report", BLOCKS, text, results)


def _choices(results: Results) -> str:
    drawn = _drawn(results)
    table = choices.figure(drawn).table
    assert table is not None
    scenes = dict.fromkeys(row["scene"] for row in drawn)
    among = f"Of what draws all of the scenes {', '.join(scenes)}; dynamic lines, those with lines."
    among += f" {choices.PAINTED}"
    return f"{_lines(table)}\n\n{among} {_origin(results, 'error_over_time')}"


def _table(part: str, make: Callable[[Sequence[Row]], Table]) -> Callable[[Results], str]:
    """A block: a table of a part's rows, and what they were measured with."""
    return lambda results: f"{_lines(make(_rows(results, part)))}\n\n{_origin(results, part)}"


def _times(results: Results) -> str:
    """How long each part took."""
    cells = [
        f"{name} {number(one['seconds'] / 60.0, 2)} ({one['size']})" for name, one in results["parts"].items()
    ]
    return f"Minutes that the parts took when the figures here were measured: {', '.join(cells)}."


FEATURE_SIZE = next(one for one in EXTREMES if one.name == "feature size")
# Files, the parts whose rows they are drawn of, and how.
PLOTS: dict[str, tuple[str, Callable[[list[Row]], Figure]]] = {
    f"{IMAGES}/error_over_time.svg": ("error_over_time", lambda rows: _over_all(rows)[0]),
    f"{IMAGES}/error_over_memory.svg": ("error_over_time", lambda rows: _over_all(rows)[1]),
    f"{IMAGES}/zoom.svg": ("scenes", lambda rows: scenes.path_figure(rows, "catchments", "zoom")),
    f"{IMAGES}/drawing_over_segments.svg": (
        "scaling",
        lambda rows: scaling.over(rows, "segments", "draw_ms"),
    ),
    f"{IMAGES}/error_over_feature_size.svg": ("stability", lambda rows: stability.curves(rows, FEATURE_SIZE)),
}
BLOCKS: dict[str, Callable[[Results], str]] = {
    "choices": _choices,
    "exponents": _table("scaling", scaling.exponents),
    "held": _table("needless", needless.weighed),
    "odd": _table("odd_inputs", odd_inputs.verdicts),
    "signs": _table("factors", factors.signs),
    "sizes": _table("sizes", sizes.table),
    "times": _times,
    "verdicts": _table("stability", stability.verdicts),
}


def _over_all(rows: Sequence[Row]) -> list[Figure]:
    return error_over_time.over_all([row for row in rows if "frame" in row])


def _lines(table: Table) -> str:
    lines = [table.columns, ["---"] * len(table.columns), *table.rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _origin(results: Results, part: str) -> str:
    """What a part was measured with."""
    one = results["parts"][part]
    machine = one["machine"]
    commit = str(machine["commit"])
    changed = ", with changes" if commit.endswith("+") else ""
    return (
        f"Of the {one['size']} report, on {machine['cores']} cores of an {machine['processor']} with"
        f" {machine['driver']}; commit {commit[:8]}{changed}."
    )


def _rows(results: Results, part: str) -> list[Row]:
    return [row for row in results["records"] if row["part"] == part]


def _drawn(results: Results) -> list[Row]:
    return [row for row in _rows(results, "error_over_time") if "frame" in row]
