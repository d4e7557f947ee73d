"""What `decalgl bench` does: measures, shows the ratios, writes the results, and compares those of two runs."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING

from rich.console import Console

from ..errors import InputError
from . import comparison, docs, folders, measure, terminal, workload
from .records import Records
from .suites import SUITES

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from .workload import Workload

MIDDLE = "5M"


def run(work: Workload, suites: Iterable[str]) -> Records:
    """Asks the questions of these suites."""
    records = Records()
    for name in suites:
        started = time.monotonic()
        work.say(f"[bold]{name}[/]")
        SUITES[name](work, records)
        work.say(f"{time.monotonic() - started:.0f} s")
    return records


def measure_all(sizes: list[str], suites: list[str], runs: int, out: Path | None) -> None:
    """Measures and writes the results. sizes, suites: names; empty for all. Raises InputError, FetchError."""
    sizes = _chosen("size", sizes, list(workload.SIZES))
    suites = _chosen("suite", suites, list(SUITES))
    if runs < 1:
        raise InputError(f"--runs must be 1 or more, but it is {runs}.")
    whole = sizes == list(workload.SIZES) and suites == list(SUITES)
    out = folders.results(whole) if out is None else out
    console = Console(width=130)
    work = workload.Workload(
        ground=workload.real_ground(),
        folder=folders.data(),
        sizes={name: workload.SIZES[name] for name in sizes},
        middle=MIDDLE if MIDDLE in sizes else sizes[-1],
        say=console.print,
        runs=runs,
    )
    records = run(work, suites).list()
    machine = measure.machine()
    console.print(terminal.table(records, work.picture))
    console.print(", ".join(f"{name}: {value}" for name, value in machine.items()))
    out.parent.mkdir(parents=True, exist_ok=True)
    results = {"machine": machine, "runs": work.runs, "records": records}
    out.write_text(json.dumps(results, indent=2) + "\n")
    console.print(f"Written to {out}")
    if out == folders.results(whole=True) and folders.checkout() is not None:
        write_docs()


def write_docs() -> None:
    """Brings the tables of the documentation up to the last results. Raises InputError outside of a checkout."""
    root = folders.checkout()
    if root is None:
        raise InputError("There is no documentation beside an installed package. Run --docs in a checkout.")
    console = Console()
    for page in docs.write_pages(root):
        console.print(f"Figures brought up to date in {page.relative_to(root)}")


def compare(before: Path, after: Path) -> bool:
    """Shows what changed from one file of results to another; whether nothing got slower or larger."""
    found = comparison.compare(comparison.read(before), comparison.read(after))
    Console(width=130).print(comparison.table(found), comparison.summary(found))
    return not found.worse and not found.lost


def _chosen(option: str, names: list[str], known: list[str]) -> list[str]:
    """The known names that were asked for, in their own order; all where none was."""
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(f"There is no --{option} {unknown[0]!r}. Choose from {', '.join(known)}.")
    return [name for name in known if name in names] if names else known
