"""Sizes: how long each scene takes to be made and prepared in each step of size, and with how much memory."""

from __future__ import annotations

import functools
import json
import subprocess
import sys
from typing import TYPE_CHECKING

from .case_studies import CASE_STUDIES, SCENES
from .part import Figure, Table, byte_count, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .part import Context, Row, Step

TITLE = "Sizes of the scenes"
ABOUT = (
    "Each scene in each step of size, in a process of its own. Making is reading and deriving, data that was fetched"
    " before; preparing is that of the static index. The peak is that of the whole process, Python, libraries and"
    " the making of the data included. Vertices are counted as in the thesis: those of outlines once more."
)
MOST_SECONDS = 1800.0
STEPS: dict[str, tuple[Step, ...]] = {
    "tiny": ("tiny",),
    "quick": ("offline",),
    "full": ("small", "medium", "large"),
}


def rows(context: Context) -> list[Row]:
    """A row for each scene and step."""
    found: list[Row] = []
    for step in STEPS[context.size]:
        for name in SCENES[context.size]:
            context.say(f"{name}, {step}")
            found += context.kept(f"sizes_{step}_{name}", functools.partial(_measured, name, step))
    return found


def _measured(name: str, step: Step) -> list[Row]:
    return [{"scene": name, "like": CASE_STUDIES[name].like, "step": step, **_taken(name, step)}]


def _taken(name: str, step: Step) -> Row:
    command = [sys.executable, "-m", "decalgl.report.one_size", name, step]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=MOST_SECONDS)
    except subprocess.TimeoutExpired:
        return {"refused": f"took more than {MOST_SECONDS:.0f} s"}
    except subprocess.CalledProcessError as error:
        return {"refused": f"ended with {error.returncode}: {error.stderr.strip().splitlines()[-1:]}"}
    taken: Row = json.loads(done.stdout)
    return taken


def figures(rows: Sequence[Row]) -> list[Figure]:
    """One table."""
    return [Figure("Scenes in steps of size", "Times depend on the machine.", table=table(rows))]


def table(rows: Sequence[Row]) -> Table:
    """A line for each scene and step."""
    columns = (
        "scene",
        "step",
        "vertices",
        "made in",
        "prepared in",
        "layers, with coverage",
        "peak of memory",
    )
    return Table(columns, [_cells(row) for row in rows])


def _cells(row: Row) -> tuple[str, ...]:
    words = (row["scene"], row["step"])
    if "refused" in row:
        return (*words, row["refused"], *[""] * 4)
    return (
        *words,
        f"{row['vertices']:,}",
        f"{number(row['make_ms'] / 1000.0)} s",
        f"{number(row['prepare_ms'] / 1000.0)} s",
        byte_count(row["layers_bytes"]),
        byte_count(row["peak_bytes"]),
    )
