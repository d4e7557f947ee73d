"""Measures the ratios that the project promises; shows them and writes bench/results/latest.json."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from . import docs, measure, report, workload
from .records import Records
from .suites import SUITES

if TYPE_CHECKING:
    from collections.abc import Iterable

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


def write_docs(console: Console) -> None:
    """Brings the tables of the documentation up to the last results."""
    for page in docs.write_pages(docs.read_results()):
        console.print(f"Figures brought up to date in {page.relative_to(workload.ROOT)}")


def main() -> None:
    arguments = _arguments()
    console = Console(width=130)
    if arguments.docs:
        write_docs(console)
        return
    work = workload.Workload(
        ground=workload.real_ground(),
        folder=workload.DATA,
        sizes={name: workload.SIZES[name] for name in arguments.sizes},
        middle=MIDDLE if MIDDLE in arguments.sizes else arguments.sizes[-1],
        say=console.print,
        runs=arguments.runs,
    )
    records = run(work, arguments.suites).list()
    machine = measure.machine()
    console.print(report.table(records, work.picture))
    console.print(", ".join(f"{name}: {value}" for name, value in machine.items()))
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    results = {"machine": machine, "runs": work.runs, "records": records}
    arguments.out.write_text(json.dumps(results, indent=2) + "\n")
    console.print(f"Written to {arguments.out}")
    if arguments.out == docs.RESULTS:
        write_docs(console)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench", description="Measure speed and memory on real data.")
    parser.add_argument("--runs", type=int, default=5, help="rounds of which the medians are taken")
    parser.add_argument("--sizes", nargs="+", choices=list(workload.SIZES), default=list(workload.SIZES))
    parser.add_argument("--suites", nargs="+", choices=list(SUITES), default=list(SUITES))
    parser.add_argument(
        "--out", type=Path, help="by default bench/results/latest.json, for a part build/bench.json"
    )
    parser.add_argument("--docs", action="store_true", help="only write the last figures into the docs")
    arguments = parser.parse_args()
    # In their own order, whatever was typed.
    arguments.sizes = [name for name in workload.SIZES if name in arguments.sizes]
    whole = set(arguments.sizes) == set(workload.SIZES) and set(arguments.suites) == set(SUITES)
    # A part of a run is not what the docs report.
    if arguments.out is None:
        arguments.out = docs.RESULTS if whole else workload.ROOT / "build" / "bench.json"
    return arguments


if __name__ == "__main__":
    main()
