"""What `decalgl report` does: measures all parts, and writes the page, report.json and a CSV for each part."""

from __future__ import annotations

import csv
import functools
import json
from typing import TYPE_CHECKING, Any, cast

from rich.console import Console

from .. import errors
from ..bench import comparison, folders, measure
from .page import Section, page
from .part import SIZES, STEPS, Context, Row, Size, Step
from .parts import PARTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

TITLE = "decalgl: error against run time"
NOTE = (
    "Every figure comes from the rows in report.json. Times of drawing are medians of rounds in which what is compared"
    " takes turns, but along camera paths; preparing is timed once unless a spread stands beside it. Errors are those"
    " against decalgl.reference, and the same on every run."
)
STEPS_KNOWN = ("tiny", "offline", "small", "medium", "large")
# Of the full report there are 1500 pictures and 56 references: larger ones would make hours days.
PICTURE: dict[Size, tuple[int, int]] = {"tiny": (64, 36), "quick": (240, 136), "full": (384, 216)}
# Smaller than the picture by even counts of pixels, so that it is its middle.
CROP: dict[Size, tuple[int, int]] = {"tiny": (16, 8), "quick": (32, 18), "full": (64, 36)}
RUNS: dict[Size, int] = {"tiny": 1, "quick": 1, "full": 3}


def make(
    out: Path,
    size: str,
    names: Sequence[str] = (),
    step: str | None = None,
    resume: bool = False,
    say: Any = None,
) -> Path:
    """Measures the parts of these names, all where none is given, and writes the page. Raises DecalError.

    step: of the case studies, by default as fits the size. resume: takes what an earlier run of this commit into the
    same folder has measured as it is.
    """
    if size not in SIZES:
        raise errors.InputError(f"There is no --size {size!r}. Choose from {', '.join(SIZES)}.")
    if step is not None and step not in STEPS_KNOWN:
        raise errors.InputError(f"There is no --step {step!r}. Choose from {', '.join(STEPS_KNOWN)}.")
    unknown = [name for name in names if name not in PARTS]
    if unknown:
        raise errors.InputError(f"There is no --part {unknown[0]!r}. Choose from {', '.join(PARTS)}.")
    chosen: Size = size
    machine = measure.machine()
    context = Context(
        size=chosen,
        step=cast("Step", step) if step else STEPS[chosen],
        out=out,
        data=folders.data(),
        picture=PICTURE[chosen],
        crop=CROP[chosen],
        runs=RUNS[chosen],
        say=say or Console(stderr=True, highlight=False).print,
        resume=resume,
        commit=machine["commit"],
    )
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise errors.FileError(f"{out} cannot be written: {error.strerror}. Choose another --out.") from error
    parts: dict[str, Any] = {}
    records: list[Row] = []
    for name in names or PARTS:
        context.say(f"[bold]{name}[/]")
        rows = context.kept(name, functools.partial(PARTS[name].rows, context))
        records += [{"part": name, **row} for row in rows]
        seconds = round(context.seconds[name])
        parts[name] = {"size": size, "step": context.step, "runs": context.runs, "seconds": seconds}
        context.say(f"{seconds} s")
        # After each part, so that a report that breaks off keeps what it has.
        results = {"machine": machine, "parts": parts, "records": records}
        (out / "report.json").write_text(as_text(results))
    return write(out)


def as_text(results: Mapping[str, Any]) -> str:
    """JSON with a line for each record."""
    head = json.dumps({name: value for name, value in results.items() if name != "records"}, indent=1)
    lines = ",\n".join(json.dumps(record, ensure_ascii=False) for record in results["records"])
    return f'{head.removesuffix("}").rstrip()},\n "records": [\n{lines}\n]}}\n'


def write(out: Path) -> Path:
    """Makes the page and the CSVs anew from a folder's report.json; the page's path."""
    results = comparison.read(out / "report.json")
    sections = []
    for name, part in PARTS.items():
        rows = [row for row in results["records"] if row["part"] == name]
        if rows:
            _write_csv(out / f"{name}.csv", rows)
            sections.append(Section(name, part.TITLE, part.ABOUT, part.figures(rows)))
    target = out / "index.html"
    note = f"{NOTE} {_extent(results['parts'])}"
    target.write_text(page(TITLE, results["machine"], note, sections), encoding="utf-8")
    return target


def _extent(parts: Mapping[str, Any]) -> str:
    """How much was measured, in how long."""
    sizes = ", ".join(dict.fromkeys(one["size"] for one in parts.values()))
    minutes = sum(one["seconds"] for one in parts.values()) / 60.0
    return f"Size: {sizes}. Measured in {minutes:.0f} minutes."


def _write_csv(path: Path, rows: Sequence[Row]) -> None:
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, columns)
        writer.writeheader()
        writer.writerows(_flat(rows))


def _flat(rows: Iterable[Row]) -> Iterable[Row]:
    """Rows whose lists are texts."""
    for row in rows:
        yield {
            name: json.dumps(value) if isinstance(value, (list, dict)) else value
            for name, value in row.items()
        }
