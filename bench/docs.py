"""The figures in the documentation, written from bench/results/latest.json: `python -m bench --docs`.

What stands between the lines <!-- bench:NAME --> and <!-- /bench --> of a page is replaced by what
`tables.BLOCKS` makes for NAME.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

from .tables import BLOCKS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .tables import Results

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results" / "latest.json"
PAGES = (
    ROOT / "README.md",
    ROOT / "docs" / "interaction.md",
    ROOT / "docs" / "techniques" / "static.md",
    ROOT / "docs" / "techniques" / "distance_field.md",
    ROOT / "docs" / "techniques" / "clipmap.md",
    ROOT / "docs" / "techniques" / "volume.md",
    ROOT / "docs" / "techniques" / "loops.md",
)
MARKED = re.compile(r"(<!-- bench:(\w+) -->\n).*?(<!-- /bench -->)", re.DOTALL)


def write_pages(results: Results, pages: Iterable[Path] = PAGES) -> list[Path]:
    """Replaces every marked block; returns the pages that changed."""
    changed = []
    for page in pages:
        text = page.read_text()
        filled = fill(text, results)
        if filled != text:
            page.write_text(filled)
            changed.append(page)
    return changed


def read_results(path: Path = RESULTS) -> Results:
    """What the last full run wrote."""
    results: Results = json.loads(path.read_text())
    return results


def fill(text: str, results: Results) -> str:
    """The text with its marked blocks made anew."""
    return MARKED.sub(lambda found: f"{found[1]}{BLOCKS[found[2]](results)}\n{found[3]}", text)
