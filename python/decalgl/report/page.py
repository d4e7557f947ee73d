"""One page out of the figures of all parts: HTML with its style, plots and tables inside, that opens without a network.

Pictures lie beside it, in a folder that goes with it.
"""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .part import Figure, Table

LINK = re.compile(r"\[([^\]]+)\]\(([^)\s]+)\)")
NUMBER = re.compile(r"[-–+×≤≥<>]?\s?[\d.,]+(e-?\d+)?( ?(ms|s|bytes|kB|MB|GB|%|px|m))?")
LONG = 60  # letters of a cell that would be a tower on a narrow window
STYLE = """
:root { --ink: #2b2f33; --soft: #68727a; --line: #dfe3e6; --paper: #fff; --tint: #f4f6f7; --link: #1b6ca8; }
* { box-sizing: border-box; }
body { margin: 0; color: var(--ink); background: var(--paper); font: 16px/1.5 system-ui, sans-serif; }
header, main, nav { max-width: 72rem; margin: 0 auto; padding: 0 1.25rem; }
header { padding-top: 2rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .5rem; }
section { scroll-margin-top: 2.5rem; }
h2 { font-size: 1.45rem; margin: 3rem 0 .5rem; padding-top: .75rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.08rem; margin: 2rem 0 .25rem; }
p { max-width: 46rem; margin: .4rem 0 .8rem; }
a { color: var(--link); }
.soft { color: var(--soft); font-size: .9rem; overflow-wrap: anywhere; }
nav { position: sticky; top: 0; background: var(--paper); border-bottom: 1px solid var(--line); z-index: 2;
      white-space: nowrap; overflow-x: auto; padding-top: .5rem; padding-bottom: .5rem; }
nav a { margin-right: .55rem; font-size: .83rem; text-decoration: none; }
.wide { overflow-x: auto; }
.plot svg { display: block; width: 100%; min-width: 30rem; max-width: 56rem; height: auto; }
.plot img { max-width: 100%; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .7rem; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { background: var(--tint); font-weight: 600; }
td.number { text-align: right; white-space: nowrap; }
td.long { min-width: 20rem; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 1rem; margin: .75rem 0; }
.pictures figure { margin: 0; }
.pictures img { width: 100%; height: auto; display: block; border: 1px solid var(--line); }
figcaption { font-size: .85rem; color: var(--soft); }
"""
HEAD = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
"""


@dataclass(frozen=True)
class Section:
    """A part as the page shows it. name: its anchor, and the name of its CSV."""

    name: str
    title: str
    about: str
    figures: Sequence[Figure]


def page(title: str, machine: Mapping[str, Any], note: str, sections: Sequence[Section]) -> str:
    """The whole page."""
    facts = " · ".join(f"{name}: {value}" for name, value in machine.items())
    links = "".join(f'<a href="#{one.name}">{escape(one.title)}</a>' for one in sections)
    return "".join(
        [
            HEAD.format(title=escape(title), style=STYLE),
            f"<header><h1>{escape(title)}</h1><p>{escape(note)}</p>",
            f'<p class="soft">{escape(facts)}</p>',
            '<p class="soft">All rows: <a href="report.json">report.json</a>'
            + "".join(f', <a href="{one.name}.csv">{one.name}.csv</a>' for one in sections)
            + "</p></header>\n",
            f"<nav>{links}</nav>\n<main>\n",
            *(_section(one) for one in sections),
            "</main>\n</body>\n</html>\n",
        ]
    )


def _section(section: Section) -> str:
    figures = "\n".join(_figure(one) for one in section.figures)
    return (
        f'<section id="{section.name}"><h2>{escape(section.title)}</h2>\n'
        f"<p>{_text(section.about)}</p>\n{figures}</section>\n"
    )


def _figure(figure: Figure) -> str:
    parts = [f"<h3>{escape(figure.title)}</h3>\n<p>{_text(figure.caption)}</p>\n"]
    if isinstance(figure.plot, str):
        parts.append(f'<div class="plot wide">{figure.plot}</div>\n')
    elif figure.plot is not None:
        data = base64.b64encode(figure.plot).decode()
        parts.append(
            f'<div class="plot"><img alt="{escape(figure.title)}" src="data:image/png;base64,{data}"></div>\n'
        )
    if figure.table is not None:
        parts.append(_table(figure.table))
    if figure.pictures:
        parts.append(_pictures(figure.pictures))
    return "".join(parts)


def _table(table: Table) -> str:
    head = "".join(f"<th>{_text(name)}</th>" for name in table.columns)
    rows = "\n".join("<tr>" + "".join(map(_cell, row)) + "</tr>" for row in table.rows)
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>\n{rows}\n</tbody></table></div>\n'


def _cell(text: str) -> str:
    kind = "number" if NUMBER.fullmatch(text.strip()) else "long" if len(text) > LONG else ""
    return f'<td class="{kind}">{_text(text)}</td>' if kind else f"<td>{_text(text)}</td>"


def _pictures(pictures: Mapping[str, str]) -> str:
    shown = "\n".join(
        f'<figure><a href="{escape(address)}"><img loading="lazy" alt="{escape(name)}" src="{escape(address)}"></a>'
        f"<figcaption>{escape(name)}</figcaption></figure>"
        for name, address in pictures.items()
    )
    return f'<div class="pictures">{shown}</div>\n'


def _text(text: str) -> str:
    """Plain text with its [links](address)."""
    return LINK.sub(lambda found: f'<a href="{found[2]}">{found[1]}</a>', escape(text, quote=False))
