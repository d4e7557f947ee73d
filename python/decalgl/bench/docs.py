"""The figures in the documentation, written from bench/results/latest.json: `decalgl bench --docs`.

What stands between the lines <!-- bench:NAME --> and <!-- /bench --> of a page is replaced by what
`tables.BLOCKS` makes for NAME.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

from .tables import BLOCKS

if TYPE_CHECKING:
    from pathlib import Path

    from .tables import Results

PAGES = (
    "README.md",
    "docs/interaction.md",
    "docs/techniques/static.md",
    "docs/techniques/distance_field.md",
    "docs/techniques/clipmap.md",
    "docs/techniques/volume.md",
    "docs/techniques/loops.md",
    "docs/techniques/dynamic.md",
)
MARKED = re.compile(r"(<!-- bench:(\w+) -->\n).*?(<!-- /bench -->)", re.DOTALL)


def write_pages(root: Path) -> list[Path]:
    """Replaces every marked block in the pages of a checkout; returns the pages that changed."""
    results = read_results(root)
    changed = []
    for page in (root / name for name in PAGES):
        text = page.read_text()
        filled = fill(text, results)
        if filled != text:
            page.write_text(filled)
            changed.append(page)
    return changed


def read_results(root: Path) -> Results:
    """What the last full run wrote into a checkout."""
    results: Results = json.loads((root / "bench" / "results" / "latest.json").read_text())
    return results


def fill(text: str, results: Results) -> str:
    """The text with its marked blocks made anew."""
    return MARKED.sub(lambda found: f"{found[1]}{BLOCKS[found[2]](results)}\n{found[3]}", text)
