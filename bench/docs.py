"""The figures in the documentation, written from bench/results/latest.json: `python -m bench --docs`.

What stands between the lines <!-- bench:NAME --> and <!-- /bench --> of a page is replaced by what `BLOCKS` makes
for NAME.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    Results = Mapping[str, Any]

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results" / "latest.json"
PAGES = (ROOT / "README.md", ROOT / "docs" / "techniques" / "static.md")
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


def machine(results: Results) -> str:
    """One sentence: what the figures were measured on."""
    found = results["machine"]
    return (
        f"Measured on {found['cores']} cores of {_article(found['processor'])} with {found['driver']}, at 1920 x 1080,"
        " as medians."
    )


def summary(results: Results) -> str:
    """For the README: each scene and view in milliseconds, then what preparing costs."""
    rows = [
        (
            one["scene"],
            one["view"],
            f"{one['static_none_ms']:.0f} ms",
            f"{one['S']:.1f}",
            f"{one['static_coverage_ms']:.0f} ms",
            f"{one['terrain_and_compose_ms']:.0f} ms",
        )
        for one in _views(results)
    ]
    header = ("scene", "view", "layers, `none`", "÷ floor", "layers, `coverage`", "terrain and compose")
    costs = [
        f"- {one['scene']}: {one['segments']:,.0f} segments are prepared in {one['preprocess_ms']:.0f} ms (the"
        f" terrain in {one['terrain_preprocess_ms']:.0f} ms) and take {one['bytes_per_segment']:.0f} bytes each;\n"
        f"  no vertex moves by more than {1000 * one['quantum_m']:.0f} mm."
        for one in _prepared(results)
    ]
    return "\n".join([_table(header, rows, left=2), "", *costs, "", machine(results)])


def ratios(results: Results) -> str:
    """For the technique's page: the ratios and what they are made of."""
    drawn = [
        (
            one["scene"],
            one["view"],
            f"{one['floor_ms']:.1f} ms",
            f"{one['static_none_ms']:.1f} ms",
            f"{one['S']:.1f}",
            f"{one['static_coverage_ms']:.0f} ms",
            f"{one['AA']:.1f}",
            f"{one['empty']:.2f}",
        )
        for one in _views(results)
    ]
    prepared = [
        (
            one["scene"],
            f"{one['segments']:,.0f}",
            f"{one['pieces']:,.0f}",
            f"{one['preprocess_ms']:.0f} ms",
            f"{one['radix_sort_ms']:.1f} ms",
            f"{one['P']:.1f}",
            f"{one['bytes_per_segment']:.1f}",
            f"{1000 * one['quantum_m']:.1f} mm",
        )
        for one in _prepared(results)
    ]
    drawn_header = ("scene", "view", "floor", "`none`", "S", "`coverage`", "AA", "empty")
    prepared_header = (
        "scene",
        "segments",
        "pieces",
        "preprocess",
        "radix sort",
        "P",
        "bytes a segment",
        "quantum",
    )
    tables = [_table(drawn_header, drawn, left=2), _table(prepared_header, prepared, left=1)]
    return "\n\n".join([*tables, machine(results)])


BLOCKS: dict[str, Callable[[Results], str]] = {"summary": summary, "ratios": ratios}


def _views(results: Results) -> list[Mapping[str, Any]]:
    return [one for one in results["records"] if one["view"] is not None]


def _prepared(results: Results) -> list[Mapping[str, Any]]:
    return [one for one in results["records"] if one["view"] is None]


def _table(header: tuple[str, ...], rows: list[tuple[str, ...]], left: int) -> str:
    """A Markdown table whose first `left` columns are text and the others numbers."""
    rules = ["---"] * left + ["---:"] * (len(header) - left)
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [header, tuple(rules), *rows])


def _article(noun: str) -> str:
    return f"an {noun}" if noun[:1].upper() in "AEIOU" else f"a {noun}"
