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
    from collections.abc import Callable, Mapping
    from pathlib import Path
    from typing import Any

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
    return filled("bench", BLOCKS, text, results)


def filled(word: str, blocks: Mapping[str, Callable[[Any], str]], text: str, results: Any) -> str:
    """The text with what stands between <!-- word:NAME --> and <!-- /word --> made anew by the block of that name."""
    return marked(word).sub(lambda found: f"{found[1]}{blocks[found[2]](results)}\n{found[3]}", text)


def marked(word: str) -> re.Pattern[str]:
    """What stands between the marks of a word."""
    return re.compile(rf"(<!-- {word}:(\w+) -->\n).*?(<!-- /{word} -->)", re.DOTALL)
