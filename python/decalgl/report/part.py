"""What a part of the report is: a module with two functions, `rows(context)` and `figures(rows)`.

    rows(context)      measures; plain dicts that JSON can hold, the words in them telling one row from another
    figures(rows)      draws what the rows say, and nothing else, so that a page can be made of a stored report

Rows follow the names of the benchmark's records (decalgl/bench): `scene`, `technique`, `view` and other words say what
was measured; numbers that end in _ms are times, medians of interleaved rounds with their `_spread`; numbers with
`bytes` in their name are exact, as errors are. So `decalgl bench --compare` reads reports too.
"""

from __future__ import annotations

import json
import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

Row: TypeAlias = dict[str, Any]
Size: TypeAlias = Literal["tiny", "quick", "full"]
SIZES: tuple[Size, ...] = ("tiny", "quick", "full")
Step: TypeAlias = Literal["tiny", "offline", "small", "medium", "large"]
STEPS: dict[Size, Step] = {"tiny": "tiny", "quick": "offline", "full": "small"}
PICTURES = "pictures"
ROWS = "rows"


@dataclass(frozen=True)
class Context:
    """What a part is measured with.

    size: how much to measure: "tiny" for tests, "quick" for CI (some minutes in all, no network), "full".
    step: how large the case studies are.
    out: the folder of the page; pictures go into a folder there.
    data: where data is kept that was fetched or derived.
    picture: (width, height) of the pictures whose times are taken. crop: that of what is compared with the
        reference.
    runs: rounds of which medians are taken.
    say: tells the user what is going on.
    resume: whether what an earlier run of the same commit into the same folder measured is taken as it is.
    commit: that of the checkout; None for an installed package.
    seconds: how long what is kept took, by name. spared: those of what was resumed.
    """

    size: Size
    out: Path
    data: Path
    picture: tuple[int, int]
    crop: tuple[int, int]
    runs: int
    step: Step = "offline"
    say: Callable[[str], None] = print
    resume: bool = False
    commit: str | None = None
    seconds: dict[str, float] = field(default_factory=dict)
    spared: list[float] = field(default_factory=list)

    def chosen(self, tiny: Any, quick: Any, full: Any) -> Any:
        """What fits the size of the report."""
        return {"tiny": tiny, "quick": quick, "full": full}[self.size]

    def kept(self, name: str, measure: Callable[[], list[Row]]) -> list[Row]:
        """The rows that measuring gives, stored at once, so that a run that breaks off can be resumed.

        name: of what is measured; `seconds` then says how long it took, runs that broke off included.
        """
        path = self.out / ROWS / f"{self.size}_{self.step}_{_file_name(name)}.json"
        stored = json.loads(path.read_text()) if self.resume and path.is_file() else None
        if stored and stored.get("commit") == self.commit:
            self.say(f"{name}: as measured before")
            self.seconds[name] = stored["seconds"]
            self.spared.append(stored["seconds"])
            return list(stored["rows"])
        started, spared = time.monotonic(), len(self.spared)
        rows = measure()
        self.seconds[name] = time.monotonic() - started + sum(self.spared[spared:])
        path.parent.mkdir(parents=True, exist_ok=True)
        kept = {"commit": self.commit, "seconds": self.seconds[name], "rows": rows}
        path.write_text(json.dumps(kept))
        return rows

    def save_picture(self, name: str, image: NDArray[Any]) -> str:
        """Writes pixels (h, w, 3 or 4) of bytes as a PNG; its address relative to the page. name: a few words."""
        from PIL import Image

        path = self.out / PICTURES / f"{_file_name(name)}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(image).convert("RGB").save(path)
        return f"{PICTURES}/{path.name}"


def _file_name(name: str) -> str:
    words = "".join(letter if letter.isascii() and letter.isalnum() else " " for letter in name.lower())
    return "_".join(words.split())


@dataclass(frozen=True)
class Table:
    """Columns by their headings, and rows of texts. A cell [text](address) is a link."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Figure:
    """A plot, a table, pictures, or several of them, under one title.

    plot: SVG as text (plots.py makes it), or the bytes of a PNG.
    pictures: addresses by what is written below them.
    """

    title: str
    caption: str
    plot: str | bytes | None = None
    table: Table | None = None
    pictures: Mapping[str, str] = field(default_factory=dict)


class Part(Protocol):
    """A module of this folder that the page is made of."""

    TITLE: str
    """Its heading."""
    ABOUT: str
    """What it asks and how it was measured, as a paragraph of plain text."""

    def rows(self, context: Context) -> list[Row]:
        """Measures. Raises DecalError."""

    def figures(self, rows: Sequence[Row]) -> list[Figure]:
        """Draws the rows."""


def number(value: float | None, digits: int = 3) -> str:
    """A number with so many digits that matter, and thousands apart; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:,.{decimals}f}" if abs(value) >= 1e-4 else f"{value:.{digits - 1}e}"


def byte_count(value: float | None) -> str:
    """Bytes in units that are easy to read."""
    if value is None:
        return "–"
    for unit in ("bytes", "kB", "MB"):
        if value < 1000.0:
            return f"{number(value)} {unit}"
        value /= 1000.0
    return f"{number(value)} GB"
