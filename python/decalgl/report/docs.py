"""The documentation's figures that come from the report: `decalgl report --out DIR --docs`.

The report's numbers are kept in bench/results/report.json. What stands between <!-- report:choices --> and
<!-- /report --> of a page is replaced by the table of what to choose when, and the plot over all scenes is redrawn.
"""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING

from ..bench import comparison, folders
from ..errors import InputError
from . import choices, error_over_time

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path
    from typing import Any

PAGES = ("README.md", "docs/report.md")
PLOT = "docs/images/error_over_time.svg"
KEPT = "bench/results/report.json"
MARKED = re.compile(r"(<!-- report:choices -->\n).*?(<!-- /report -->)", re.DOTALL)


def update(out: Path) -> list[Path]:
    """Takes over the report of a folder; the files that were written. Raises InputError outside of a checkout."""
    root = folders.checkout()
    if root is None:
        raise InputError("There is no documentation beside an installed package. Run --docs in a checkout.")
    shutil.copyfile(out / "report.json", root / KEPT)
    results = comparison.read(root / KEPT)
    (root / PLOT).write_text(plot(results), encoding="utf-8")
    for page in PAGES:
        path = root / page
        path.write_text(fill(path.read_text(), results))
    return [root / name for name in (KEPT, PLOT, *PAGES)]


def plot(results: Mapping[str, Any]) -> str:
    """The plot over all scenes, as the text of an SVG file."""
    figure = error_over_time.over_all(_drawn(results))
    assert isinstance(figure.plot, str)
    return figure.plot


def fill(text: str, results: Mapping[str, Any]) -> str:
    """The text with its marked tables made anew."""
    table = choices.figure(_drawn(results)).table
    assert table is not None
    lines = [table.columns, ["---"] * len(table.columns), *table.rows]
    machine = results["machine"]
    scenes = dict.fromkeys(row["scene"] for row in _drawn(results))
    note = (
        f"Of the scenes {', '.join(scenes)}, on {machine['cores']} cores of an {machine['processor']} with"
        f" {machine['driver']}; commit {str(machine['commit'])[:8]}."
    )
    shown = "\n".join(f"| {' | '.join(line)} |" for line in lines) + f"\n\n{note}"
    return MARKED.sub(lambda found: f"{found[1]}{shown}\n{found[2]}", text)


def _drawn(results: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [row for row in results["records"] if row["part"] == "error_over_time" and "frame" in row]
