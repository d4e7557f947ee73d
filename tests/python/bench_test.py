"""The benchmark runs: every suite on a few hills and a tiny picture, through to its tables."""

from __future__ import annotations

import itertools
import json
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

import decalgl as dg
from decalgl import cli
from decalgl.bench import artefacts, command, comparison, goals, shapes, tables, terminal, workload
from decalgl.bench.measure import interleaved
from decalgl.bench.suites import SUITES, loops
from decalgl.errors import InputError
from decalgl.report import papers

if TYPE_CHECKING:
    from pathlib import Path

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
def records(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """All suites, once."""
    sizes = {"few": workload.Size(200.0, 400.0), "more": workload.Size(80.0, 160.0)}
    work = workload.Workload(
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
    return command.run(work, SUITES).list()


def test_every_ratio_is_measured(records: list[dict[str, Any]]) -> None:
    measured = {name for record in records for name in record}
    assert not set(goals.RATIOS) - measured
    for record in records:
        values = [record[name] for name in goals.RATIOS if name in record]
        assert all(np.isfinite(value) and value > 0.0 for value in values), record


def test_the_report_shows_them(records: list[dict[str, Any]]) -> None:
    table = terminal.table(records, (48, 27))
    assert table.row_count == sum(name in record for record in records for name in goals.RATIOS) > 300


def test_the_documentation_can_be_made_of_them(records: list[dict[str, Any]]) -> None:
    results = {"machine": {"cores": 2, "processor": "x", "driver": "y"}, "runs": 1, "records": records}
    for block in tables.BLOCKS.values():
        assert block(results).startswith("| ")


def test_the_report_has_the_papers_tables_of_them(records: list[dict[str, Any]]) -> None:
    titles = {figure.title for figure in papers.figures(records)}
    tables_of = {"Thöny 2018, table 2", "LOOPS, table 2", "Trapp 2015, table 2"}
    flight = {
        "LOOPS, figure 16: indexes",
        "LOOPS, figure 16 (a) to (c): time along the trajectory",
        "LOOPS, figure 16 (d): what takes it",
    }
    assert titles >= tables_of | flight
    steps: dict[str, list[float]] = {}
    for record in records:
        if "step_ms" in record:
            steps.setdefault(record["technique"], []).append(record["step_ms"] - record["step_cells_ms"])
    assert {"loops cells", "loops fitted"} <= set(steps)
    assert all(len(each) == loops.FLIGHT and min(each) > 0.0 for each in steps.values())
    assert sum(title.startswith("Taibo 2014, figure") for title in titles) == 3


def test_shapes_are_valid() -> None:
    bounds = (0.0, 0.0, 90_000.0, 110_000.0)
    ring = shapes.spiked_ring(bounds, 6000, 30)
    starts = ring.part_offsets
    assert len(starts) - 1 == 31
    outline, *holes = [ring.coords[first:last] for first, last in itertools.pairwise(starts)]
    polygon = shapely.Polygon(outline, holes)
    assert shapely.is_valid(polygon), shapely.is_valid_reason(polygon)
    disjoint = shapes.disjoint(bounds, 10)
    blobs = shapely.polygons(disjoint.coords.reshape(10, -1, 2))
    assert shapely.union_all(blobs).area == pytest.approx(shapely.area(blobs).sum())


def test_medians_come_with_their_spread() -> None:
    times = iter([9.0, 10.0, 12.0, 8.0, 11.0, 9.0])
    found = interleaved(5, lambda: {"some_ms": next(times)})
    assert found == {"some_ms": 10.0, "some_ms_spread": pytest.approx(0.1)}


def test_what_takes_long_has_no_round_thrown_away() -> None:
    long, quick = iter([20.0, 40.0, 30.0]), iter([5.0, 1.0, 2.0, 3.0])

    def slow() -> dict[str, float]:
        time.sleep(0.02)
        return {"slow_ms": next(long)}

    found = interleaved(3, slow, lambda: {"quick_ms": next(quick)}, patience=0.01)
    assert found == {
        "slow_ms": 30.0,
        "slow_ms_spread": pytest.approx(1 / 6),
        "quick_ms": 2.0,
        "quick_ms_spread": 0.25,
    }


def test_one_round_has_no_spread() -> None:
    assert interleaved(1, lambda: {"some_ms": 10.0}) == {"some_ms": 10.0}


def results(floor: float, time: float, size: int, spread: float = 0.01) -> dict[str, Any]:
    """A run of two records."""
    measured = {"draw_ms": time, "draw_ms_spread": spread, "index_bytes": size}
    records = [
        {"scene": "hills", "technique": "static", "view": "close", "floor_ms": floor},
        {"scene": "hills", "technique": "static", "view": "far", **measured},
    ]
    return {"machine": {"driver": "x"}, "records": records}


@pytest.mark.parametrize(
    ("after", "worse", "better"),
    [
        (results(5.0, 10.4, 1000), [], []),
        (results(5.0, 11.0, 1000), ["draw_ms"], []),
        (results(5.0, 11.0, 1000, spread=0.03), [], []),  # noisy
        (results(10.0, 20.0, 1000), [], []),  # the machine took twice as long for everything
        (results(5.0, 9.0, 1100), ["index_bytes"], ["draw_ms"]),
    ],
)
def test_comparing_tells_changes_from_noise(
    after: dict[str, Any], worse: list[str], better: list[str]
) -> None:
    found = comparison.compare(results(5.0, 10.0, 1000), after)
    assert [one.name for one in found.worse] == worse
    assert [one.name for one in found.better] == better
    assert comparison.table(found).row_count == len(worse) + len(better)


def test_each_part_of_a_report_has_its_own_drift() -> None:
    """A machine that was busy during one part makes no other part look quicker; rows are told apart by all words."""
    before, after = results(5.0, 10.0, 1000), results(10.0, 20.0, 1000)
    for run, ms in ((before, 7.0), (after, 7.1)):
        words = {"part": "quiet", "scene": "town", "setting": "none"}
        run["records"] += [
            {**words, "view": "top", "floor_ms": 5.0},
            {**words, "draw_ms": ms, "draw_ms_spread": 0.0},
        ]
    assert not comparison.compare(before, after).changes[-1].better
    slower = {**after, "records": [*after["records"][:-1], {**after["records"][-1], "draw_ms": 8.0}]}
    (worse,) = comparison.compare(before, slower).worse
    assert worse.where == "quiet, town, none"
    few = comparison.compare({**before, "runs": 2}, {**slower, "runs": 2})
    assert not few.worse, "spreads of two rounds may be small by chance"


def test_what_is_lost_is_told() -> None:
    """Errors, verdicts that are worse, what is refused now, and rows that are no longer there."""
    before, after = results(5.0, 10.0, 1000), results(5.0, 10.0, 1000)
    before["records"] += [
        {"scene": "town", "view": "top", "edge_rms": 0.01, "leak": 0.0, "verdict": "exact"},
        {"scene": "sea", "view": "top", "held_bytes": 1},
        {"scene": "moon", "view": "top", "held_bytes": 1},
    ]
    after["records"] += [
        {
            "scene": "town",
            "view": "top",
            "edge_rms": 0.02,
            "leak": 0.0,
            "verdict": "warns",
            "warning": "Far.",
        },
        {"scene": "sea", "view": "top", "refused": "Too deep."},
    ]
    found = comparison.compare(before, after)
    assert [(one.name, one.share) for one in found.worse] == [("edge_rms", 2.0)]
    assert found.lost == [
        "town, top: exact, then warns.",
        "sea, top: Too deep.",
        "moon, top: is no longer measured.",
    ]
    assert comparison.compare(before, before).lost == []
    assert "Too deep." in comparison.summary(found)


def test_runs_without_anything_in_common_are_refused() -> None:
    with pytest.raises(InputError, match="in common"):
        comparison.compare({"records": []}, results(5.0, 10.0, 1000))


def test_the_command_compares_two_files(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    before, after, other = (tmp_path / f"{name}.json" for name in ("before", "after", "other"))
    before.write_text(json.dumps(results(5.0, 10.0, 1000)))
    after.write_text(json.dumps(results(5.0, 20.0, 1000)))
    other.write_text("[]")
    assert cli.run(["bench", "--compare", str(before), str(before)]) == 0
    assert cli.run(["bench", "--compare", str(before), str(after)]) == 1
    assert "draw_ms" in capfd.readouterr().out
    for wrong in (other, tmp_path / "absent.json"):
        assert cli.run(["bench", "--compare", str(before), str(wrong)]) == 2
        assert capfd.readouterr().err.startswith("error: ")


def test_overdraw_is_what_faces_write() -> None:
    """A hull seen from above: its lid lies before the ground, its bottom behind, and walls stand on edge."""

    def scene_of(technique: dg.Technique) -> dg.Scene:
        scene = dg.Scene(dg.Terrain.flat((0.0, 0.0, 100.0, 100.0)))
        scene.add_polygons([shapely.box(20, 20, 80, 80)], technique=technique)
        return scene

    camera = dg.Camera.top_down((0.0, 0.0, 100.0, 100.0))
    volume = artefacts.overdraw(scene_of, dg.Volume(), camera, (100, 100))
    assert volume == pytest.approx(2.0, abs=0.1)  # the bottom, and the mask
    assert artefacts.overdraw(scene_of, dg.Static(), camera, (100, 100)) == pytest.approx(0.0, abs=0.1)


def test_artefacts_are_there_and_mended() -> None:
    assert artefacts.intrusion() == 1.0
    assert artefacts.intrusion(mend_intrusion=True, widths_at="vertex") == 0.0
    assert artefacts.protrusion() == pytest.approx(15.0, abs=1.0)
    assert artefacts.protrusion(mend_protrusion=True) == 0.0
    assert 0.1 < artefacts.steps() <= 0.5
