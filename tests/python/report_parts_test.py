"""The report's parts on scaling, stability and needless work: what they measure, judge and draw."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import decalgl as dg
from decalgl.bench import comparison
from decalgl.report import (
    case_studies,
    docs,
    extremes,
    needless,
    needless_maps,
    odd_inputs,
    scaling,
    stability,
)
from decalgl.report.part import Context

ROOT = Path(__file__).resolve().parents[2]
SOME = [one for one in extremes.EXTREMES if one.name in ("angle", "coordinates")]


@pytest.fixture
def context(tmp_path: Path) -> Context:
    return Context("tiny", tmp_path, tmp_path, (32, 18), (16, 9), 1, say=lambda _: None)


def extreme(name: str) -> extremes.Extreme:
    return next(one for one in extremes.EXTREMES if one.name == name)


def judged(name: str, value: float, technique: str) -> dict[str, Any]:
    return stability.judged(stability.WAYS[technique], extreme(name).make(value))


def stored(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """As they come out of a file."""
    read: list[dict[str, Any]] = json.loads(json.dumps(rows))
    return read


def test_a_report_goes_on_where_one_of_the_same_commit_broke_off(context: Context) -> None:
    measured: list[dict[str, Any]] = []

    def measure() -> list[dict[str, Any]]:
        measured.append({"scene": "a", "round": len(measured)})
        return measured[-1:]

    first, other = (replace(context, commit=commit) for commit in ("1234", "1234+"))
    assert first.kept("some part", measure) == measured
    again = replace(first, resume=True)
    assert again.kept("some part", measure) == measured[:1]
    assert again.seconds == first.seconds
    assert replace(other, resume=True).kept("some part", measure) == [{"scene": "a", "round": 1}]
    assert replace(other, resume=False).kept("some part", measure) == [{"scene": "a", "round": 2}]


def test_no_technique_runs_what_a_scene_does_not_need() -> None:
    names = tuple(needless.WAYS)
    rows = [row for name in names for row in needless.states(name)]
    assert [(row["technique"], row["scene"], row["needless"]) for row in rows if row["needless"]] == []
    assert len(rows) == 91, "docs/extremes.md names them"
    assert {row["scene"] for row in rows} >= {"hidden", "nothing in view", "unchanged", "another colour"}
    figures = needless.figures(stored(rows))
    assert figures[0].table is None
    assert len(figures) == 2 + len(names)
    weighed = {row["technique"]: row["times"] for row in rows if "times" in row}
    assert weighed["static"] < 10.0
    assert weighed["dynamic lists"] < 3.0


@pytest.mark.parametrize("name", ["floods", "rural", "isolines"])
def test_no_technique_runs_what_a_map_does_not_need(name: str) -> None:
    rows = list(needless_maps.of_map(case_studies.build(name, "tiny")))
    assert [(row["technique"], row["needless"]) for row in rows if row["needless"]] == []
    drawn = {row["technique"] for row in rows}
    polygons_alone = {name for name, way in needless.WAYS.items() if way.fills}
    assert drawn == (polygons_alone if name == "isolines" else set(needless.WAYS))
    assert len(needless.figures(stored([{**row, "map": name} for row in rows]))) == 3


def test_what_is_needless_is_found() -> None:
    needs = needless.Needs(needless.GROUND, 10, frozenset({"static"}), view=False)
    programs = ["static_decals[LENS,LINES]", "static_decals[RINGS]", "volume[NEW_FLAG]"]
    held = {"static_bvh: polygons": 1}
    assert needless.surplus(["terrain", "upload", "static", "volume"], programs, 11, held, needs) == [
        "pass upload",
        "pass volume",
        "static_decals[LENS,LINES]: LENS",
        "static_decals[RINGS]: RINGS",
        "volume[NEW_FLAG]: NEW_FLAG",
        "1 of 11 bytes uploaded",
        "the object static_bvh: polygons",
    ]
    hidden = needless.Needs(needless.FIRST, 0)
    ran = needless.surplus(["upload", "static"], [], 0, {"frame: overlay": 1}, hidden)
    assert ran == ["pass static", "an overlay"]
    recoloured = needless.Needs(needless.GROUND, 0, frozenset({"dynamic"}), view=False)
    assert needless.surplus(["dynamic: project", "dynamic"], [], 0, {}, recoloured) == [
        "pass dynamic: project"
    ]


@pytest.mark.parametrize(
    ("name", "value", "technique", "verdict"),
    [
        ("coordinates", 1e8, "static", "exact"),
        ("coordinates", 1e9, "static", "refuses with an error"),
        ("feature size", 1e9, "static", "warns"),
        ("feature size", 1e9, "volume", "warns"),  # of which nothing is left
        ("exaggeration", 1000.0, "static bvh", "exact"),
        ("tilt", 0.2, "dynamic bins", "exact"),
        ("slope", 89.9, "distance_field", "exact"),
        ("nesting", 100.0, "loops", "within tolerance"),
        ("coincident", 1e-6, "volume", "warns"),
        ("coincident", 1e-5, "loops", "warns"),
    ],
)
def test_verdicts_at_the_extremes(name: str, value: float, technique: str, verdict: str) -> None:
    row = judged(name, value, technique)
    assert row["verdict"] == verdict, row
    if verdict == "warns":
        assert "pixels off" in row["warning"]
    if verdict.startswith("refuses"):
        assert row["error"]


@pytest.mark.parametrize("technique", ["static", "static coverage", "dynamic coverage"])
def test_wrong_pictures_are_found(technique: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A reference that sees the map half a pixel, or ten, aside is told from one that agrees."""
    case, way = extreme("coordinates").make(1.0), stability.WAYS[technique]
    seen = stability.reference_colors
    for aside, verdict in ((0.0, "exact"), (0.5, "within tolerance"), (10.0, "fails")):
        monkeypatch.setattr(
            stability,
            "reference_colors",
            lambda scene, case, points, aside=aside: seen(scene, case, points + np.array([aside, 0.0])),
        )
        assert stability.judged(way, case)["verdict"] == verdict


def test_figures_stand_on_rows_alone() -> None:
    rows = [
        {"extreme": one.name, "technique": name, "value": value, "verdict": verdict, **shares}
        for one in SOME
        for name in stability.WAYS
        for value, verdict, shares in (
            (one.quick[0], "exact", {"rough": 0.0, "far": 0.0}),
            (one.quick[-1], "refuses with an error", {"error": "No."}),
        )
    ]
    figures = stability.figures(stored(rows))
    assert len(figures) == 2 + len(SOME)
    table = figures[0].table
    assert table is not None
    assert {len(row) for row in table.rows} == {1 + len(stability.WAYS)}
    assert {cell for row in table.rows for cell in row[1:]} == {
        f"exact; at {one.quick[-1]:g} refuses" for one in SOME
    }


def test_every_verdict_that_is_not_exact_has_a_reason() -> None:
    kept = comparison.read(ROOT / docs.KEPT)["records"]
    rows = [row for row in kept if row["part"] == "stability"]
    assert {row["extreme"] for row in rows} == {one.name for one in extremes.EXTREMES}
    assert not [row for row in rows if row["verdict"] == "fails"]
    table = stability.figures(rows)[1].table
    assert table is not None
    assert [row for row in table.rows if not row[3]] == []


@pytest.mark.parametrize("name", odd_inputs.ODD_INPUTS)
def test_odd_inputs_are_drawn_right_or_refused(name: str) -> None:
    """Refused are points that are no numbers and lines without a width, and nothing else.

    Textures are filtered; coverage follows rays beside a hole near what the pixels around see.
    """
    is_refused = name in ("points that are no numbers", "points at infinity", "lines of width 0")
    case = odd_inputs.ODD_INPUTS[name]()
    for technique, way in stability.WAYS.items():
        row = stability.judged(way, case)
        filtered = technique == "clipmap" or (name == "holes in the terrain" and "coverage" in technique)
        right = {"exact", "within tolerance"} if filtered else {"exact"}
        assert row["verdict"] in ({"refuses with an error"} if is_refused else right), (technique, row)


def test_all_extremes_make_scenes() -> None:
    for one in extremes.EXTREMES:
        assert set(one.quick) <= set(one.values), one.name
        for value in one.quick:
            case = one.make(value)
            assert case.lines or case.polygons
            coords = np.concatenate([part for feature in case.lines + case.polygons for part in feature])
            assert np.isfinite(coords).all()


@pytest.mark.parametrize(("power", "noise"), [(0.0, 0.0), (1.0, 0.0), (0.5, 0.1)])
def test_exponents(power: float, noise: float) -> None:
    counts = np.array([1e4, 1e5, 1e6, 1e7])
    wobble = np.array([1.0, 1.0 + noise, 1.0 - noise, 1.0])
    found = scaling.exponent(
        [(n, v, 0.01) for n, v in zip(counts, 3.0 * counts**power * wobble, strict=True)]
    )
    assert found is not None
    assert abs(found.slope - power) < 0.05
    assert found.error < 0.05
    assert noise == 0.0 or found.error > 0.005
    assert scaling.exponent([(10.0, 1.0, 0.1)]) is None


def test_scaling_measures_and_says_what_is_refused(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    refusing = scaling.Way(dg.Static(), (1e5, 0, 0), {"memory_limit": 1000})
    bvh = scaling.Way(dg.Static(), (1e5, 0, 0), {"index": "bvh"})
    ways = {"static": scaling.WAYS["static"], "static bvh": bvh, "volume": refusing}
    monkeypatch.setattr(scaling, "WAYS", ways)
    rows = stored(scaling.rows(context))
    sweeps = {row["sweep"] for row in rows}
    assert sweeps == set(scaling.SWEEPS)
    assert not any(" " in name for row in rows for name in row), "a row has its own times alone"
    drawn = [row for row in rows if row["technique"] == "static" and row["sweep"] != "threads"]
    assert all(row["draw_ms"] > 0.0 and row["prepare_ms"] > 0.0 and row["held_bytes"] > 0 for row in drawn)
    assert all("memory limit" in row["error"] for row in rows if row["technique"] == "volume")
    figures = scaling.figures(rows)
    assert figures[0].table is not None
    assert any("Refused: volume" in figure.caption for figure in figures)


@pytest.mark.parametrize(
    ("technique", "name", "value", "says"),
    [
        ("clipmap", "tilt", 1.0, "looks along the ground"),
        ("clipmap", "overlap", 300.0, "blends them into bytes"),
        ("volume", "overlap", 300.0, "blends them into bytes"),
    ],
)
def test_techniques_say_what_they_draw_badly(technique: str, name: str, value: float, says: str) -> None:
    way, make = stability.WAYS[technique], extreme(name).make
    with pytest.warns(dg.DecalWarning, match=says):
        picture(way, make(value))
    picture(way, make(10.0))


def picture(way: stability.Way, case: extremes.Case) -> None:
    way.scene(case).render(case.camera, (32, 18), antialias="none", **way.options)
