"""The benchmark runs: every suite on a few hills and a tiny picture, through to its tables."""

from __future__ import annotations

import importlib
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import decalgl as dg

ROOT = Path(__file__).resolve().parents[2]
# Of San Francisco bay, as the views are.
WEST, NORTH, SPACING = -44_500.0, 55_600.0, 1112.0
ROWS, COLUMNS = 101, 81


def hills() -> dg.Terrain:
    """Hills that rise from a level sea, and a hole."""
    column, row = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    waves = np.sin(0.4 * column) * np.cos(0.3 * row)
    z = np.where(column + row < 70, 0.0, 500.0 + 400.0 * waves).astype(np.float32)
    z[-3:, -3:] = np.nan
    return dg.Terrain(z, WEST, NORTH, SPACING, SPACING)


@pytest.fixture(scope="module")
def bench() -> Any:
    """The modules of the benchmark, which is not installed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT))
        for name in ("report", "tables", "goals"):
            importlib.import_module(f"bench.{name}")
        yield importlib.import_module("bench.__main__"), importlib.import_module("bench")


@pytest.fixture(scope="module")
def records(bench: Any, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """All suites, once."""
    program, modules = bench
    sizes = {"few": modules.workload.Size(200.0, 400.0), "more": modules.workload.Size(80.0, 160.0)}
    work = modules.workload.Workload(
        ground=hills(),
        folder=tmp_path_factory.mktemp("contours"),
        sizes=sizes,
        middle="more",
        say=lambda _: None,
        picture=(48, 27),
        runs=1,
        depths=(3,),
        ring=(4000, 20),
        towns=(),
    )
    found: list[dict[str, Any]] = program.run(work, modules.suites.SUITES).list()
    return found


def test_every_ratio_is_measured(bench: Any, records: list[dict[str, Any]]) -> None:
    _, modules = bench
    measured = {name for record in records for name in record}
    assert not set(modules.goals.RATIOS) - measured
    for record in records:
        values = [record[name] for name in modules.goals.RATIOS if name in record]
        assert all(np.isfinite(value) and value > 0.0 for value in values), record


def test_the_report_shows_them(bench: Any, records: list[dict[str, Any]]) -> None:
    _, modules = bench
    table = modules.report.table(records, (48, 27))
    assert table.row_count >= len(records)


def test_the_documentation_can_be_made_of_them(bench: Any, records: list[dict[str, Any]]) -> None:
    _, modules = bench
    results = {"machine": {"cores": 2, "processor": "x", "driver": "y"}, "runs": 1, "records": records}
    for block in modules.tables.BLOCKS.values():
        assert block(results).startswith("| ")


def test_shapes_are_valid(bench: Any) -> None:
    _, modules = bench
    bounds = (0.0, 0.0, 90_000.0, 110_000.0)
    ring = modules.shapes.spiked_ring(bounds, 6000, 30)
    starts = ring.part_offsets
    assert len(starts) - 1 == 31
    outline, *holes = [ring.coords[first:last] for first, last in itertools.pairwise(starts)]
    polygon = shapely.Polygon(outline, holes)
    assert shapely.is_valid(polygon), shapely.is_valid_reason(polygon)
    disjoint = modules.shapes.disjoint(bounds, 10)
    blobs = shapely.polygons(disjoint.coords.reshape(10, -1, 2))
    assert shapely.union_all(blobs).area == pytest.approx(shapely.area(blobs).sum())
