"""Measures the ratios that the project promises and writes them as a table and as bench/results/latest.json."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import decalgl as dg

from . import docs, measure, scenes

SIZE = (1920, 1080)
GOALS = {"S": 10.0, "P": 5.0, "bytes_per_segment": 48.0, "empty": 1.05}


def measure_size(name: str, ground: dg.Terrain, runs: int, console: Console) -> list[dict[str, Any]]:
    """One record for preprocessing and one for each view."""
    console.print(f"isolines, {name} segments …")
    scene = scenes.scene(ground, name)
    views = scenes.views(ground)
    label = {"scene": f"isolines {name}", "technique": "static"}
    prepared = measure.preprocessing(scene, SIZE, views["overview"], runs)
    full, empty = (dg.Renderer(size=SIZE) for _ in range(2))
    full.preprocess(scene)
    empty.preprocess(scenes.scene(ground, None))
    records: list[dict[str, Any]] = [{**label, "view": None, **prepared}]
    for view, camera in views.items():
        full.update(camera)
        empty.update(camera)
        records.append({**label, "view": view, **measure.drawing(full, empty, SIZE, camera, runs)})
    return records


def print_table(records: list[dict[str, Any]], console: Console) -> None:
    """The ratios, and the times that they are made of."""
    table = Table("scene", "view", "ratio", "is", "goal", "of", title="Static decals, 1920 x 1080")
    sources = {
        "S": "{static_none_ms:.1f} ms ÷ floor {floor_ms:.1f} ms",
        "AA": "{static_coverage_ms:.0f} ms ÷ {static_none_ms:.0f} ms",
        "empty": "{empty_ms:.0f} ms ÷ terrain and compose {terrain_and_compose_ms:.0f} ms",
        "P": "{preprocess_ms:.0f} ms ÷ radix sort {radix_sort_ms:.0f} ms",
        "bytes_per_segment": "{segments:,.0f} segments in {pieces:,.0f} pieces",
    }
    for record in records:
        for ratio, source in sources.items():
            if ratio in record:
                goal = GOALS.get(ratio)
                shown = "" if goal is None else f"≤ {goal:g}"
                colour = "" if goal is None else "green" if record[ratio] <= goal else "red"
                value = f"[{colour}]{record[ratio]:.2f}[/]" if colour else f"{record[ratio]:.2f}"
                table.add_row(
                    record["scene"], record["view"] or "", ratio, value, shown, source.format(**record)
                )
    console.print(table)


def write_docs(console: Console) -> None:
    """Brings the tables of the documentation up to the last results."""
    for page in docs.write_pages(docs.read_results()):
        console.print(f"Figures brought up to date in {page.relative_to(docs.ROOT)}")


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure speed and memory on real data.")
    parser.add_argument("--runs", type=int, default=7, help="rounds of which the medians are taken")
    parser.add_argument("--sizes", nargs="*", choices=list(scenes.STEPS), default=list(scenes.STEPS))
    parser.add_argument("--out", type=Path, default=docs.RESULTS)
    parser.add_argument("--docs", action="store_true", help="only write the last figures into the docs")
    arguments = parser.parse_args()
    console = Console(width=110)
    if arguments.docs:
        write_docs(console)
        return
    scenes.DATA.mkdir(parents=True, exist_ok=True)
    ground = scenes.terrain()
    records = [
        record for name in arguments.sizes for record in measure_size(name, ground, arguments.runs, console)
    ]
    machine = measure.machine()
    print_table(records, console)
    console.print(", ".join(f"{name}: {value}" for name, value in machine.items()))
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text(json.dumps({"machine": machine, "records": records}, indent=2) + "\n")
    console.print(f"Written to {arguments.out}")
    # A part of a run, or one that is kept elsewhere, is not what the docs report.
    if arguments.out == docs.RESULTS and set(arguments.sizes) == set(scenes.STEPS):
        write_docs(console)


if __name__ == "__main__":
    main()
