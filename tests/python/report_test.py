"""The report: all parts at the smallest size through to a page whose links lead somewhere, and what it is made of."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import decalgl as dg
from decalgl import cli, reference
from decalgl.bench import comparison
from decalgl.bench.docs import marked
from decalgl.errors import InputError
from decalgl.report import (
    accuracy,
    case_studies,
    choices,
    command,
    derive,
    docs,
    error_over_time,
    factors,
    page,
    parts,
    plots,
    views,
)
from decalgl.report.part import Figure, Table, byte_count, number
from decalgl.report.settings import Setting

ROOT = Path(__file__).resolve().parents[2]


class Links(HTMLParser):
    """Collects what a page leads to and shows, and its anchors."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = set()
        self.open: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert tag not in ("script", "link", "iframe")
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)
        for name, value in attrs:
            if name in ("href", "src", "xlink:href") and value:
                self.targets.append(value)
            if name == "id" and value:
                self.anchors.add(value)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a report of the smallest size."""
    folder = tmp_path_factory.mktemp("report")
    command.make(folder, "tiny", say=lambda _: None)
    return folder


def test_the_page_stands_alone_and_its_links_lead_somewhere(report: Path) -> None:
    text = (report / "index.html").read_text()
    found = Links(text)
    assert not found.open
    assert "url(http" not in text
    for target in found.targets:
        assert "://" not in target, target
        if target.startswith("#"):
            assert target[1:] in found.anchors, target
        elif not target.startswith("data:"):
            assert (report / target).is_file(), target
    assert set(parts.PARTS) <= found.anchors


def test_choices_are_those_that_fit_best_and_draw_everything() -> None:
    def row(setting: str, scene: str, frame: float, error: float, prepare: float) -> dict[str, Any]:
        numbers = {"frame": frame, "edge_rms": error, "prepare_ms": prepare, "layers_bytes": 1e6}
        return {"technique": "static", "setting": setting, "scene": scene, "view": "close", **numbers}

    rows = [row("none", scene, 10.0, 0.2, 10.3) for scene in ("a", "b")]
    rows += [row("coverage", scene, 20.0, 0.012, 10.1) for scene in ("a", "b")]
    rows += [row("ssaa 16", scene, 160.0, 0.02, 12.0) for scene in ("a", "b")]
    rows += [row("one scene alone", "a", 1.0, 0.0, 1.0)]
    table = choices.figure(rows).table
    assert table is not None
    chosen = {line[0]: line[2] for line in table.rows}
    assert chosen["the quickest picture"] == "none"
    assert chosen["borders within 0.03, quickly"] == "coverage"
    assert chosen["the most exact picture"] == "coverage"
    assert chosen["ready the soonest"] == "none", "2 % are no difference, so the quickest of them"
    assert chosen["lines as wide as on the screen, quickly"] == ""
    assert choices.figure(rows[:2]).table.rows[1][1] == "none of them"  # type: ignore[union-attr]


def test_every_point_leads_to_its_picture(report: Path) -> None:
    rows = json.loads((report / "report.json").read_text())["records"]
    drawn = [row for row in rows if row["part"] == "error_over_time" and "frame" in row]
    settings = {(row["technique"], row["setting"]) for row in drawn}
    expected = {"All scenes": len(settings), "All scenes: error over memory": len(settings)}
    for scene in {row["scene"] for row in drawn}:
        points = sum(row["scene"] == scene for row in drawn)
        expected |= {f"{scene}: error over time": points, f"{scene}: error over memory": points}
    figures = {figure.title: figure.plot for figure in error_over_time.figures(drawn)}
    for title, points in expected.items():
        links = re.findall(r'xlink:href="(pictures/[^"]+)"', str(figures[title]))
        assert len(links) == points, title
        assert all((report / link).is_file() for link in links)


def test_the_ground_s_level_of_detail_is_told_apart(report: Path) -> None:
    rows = json.loads((report / "report.json").read_text())["records"]
    part = [row for row in rows if row["part"] == "error_over_time"]
    own = [row for row in part if "ground_rms" in row]
    assert {row["view"] for row in own} == {row["view"] for row in part if "frame" in row}
    assert all(0.0 <= row["ground_rms"] < 0.1 and 0.0 <= row["ground_moved"] < 0.2 for row in own)
    tables = {figure.title: figure.table for figure in error_over_time.figures(part)}
    table = tables["What the terrain's level of detail adds"]
    assert table is not None
    assert len(table.rows) == len(own)


def test_ground_that_is_coarser_moves_more(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = case_studies.build("floods", "offline")
    judge = accuracy.Judge(drawn, {"close": views.views(drawn)["close"]}, (160, 90), (32, 18))
    fine = judge.judge_ground()["close"]
    coarser = replace(accuracy.BY_DETAIL, renderer={"terrain_error": 8.0})
    monkeypatch.setattr(accuracy, "BY_DETAIL", coarser)
    coarse = judge.judge_ground()["close"]
    assert 2.0 * fine["ground_moved"] < coarse["ground_moved"]
    assert fine["ground_rms"] < coarse["ground_rms"]


def test_rows_are_in_the_files(report: Path) -> None:
    results = json.loads((report / "report.json").read_text())
    assert {row["part"] for row in results["records"]} == set(parts.PARTS)
    for name in parts.PARTS:
        own = [row for row in results["records"] if row["part"] == name]
        with (report / f"{name}.csv").open() as stream:
            assert len(list(csv.DictReader(stream))) == len(own)
    same = comparison.compare(results, results)
    assert not same.worse
    assert same.compared > 20


def test_the_page_can_be_made_again(report: Path) -> None:
    before = (report / "index.html").read_text()
    assert cli.run(["report", "--out", str(report), "--redraw"]) == 0
    assert (report / "index.html").read_text() == before


def test_coverage_is_nearer_to_the_reference_than_no_filter(report: Path) -> None:
    rows = json.loads((report / "report.json").read_text())["records"]
    static = {row["setting"]: row for row in rows if row.get("technique") == "static" and "edge_rms" in row}
    assert static["coverage"]["edge_rms"] < 0.03 < static["none"]["edge_rms"]
    assert static["coverage"]["image_rms"] < static["ssaa 4"]["image_rms"] < static["none"]["image_rms"]


def test_the_documentation_is_that_of_the_last_report() -> None:
    results = comparison.read(ROOT / docs.KEPT)
    for page_name in docs.PAGES:
        text = (ROOT / page_name).read_text()
        assert marked("report").search(text), page_name
        assert docs.fill(text, results) == text, f"{page_name}: run decalgl report --out DIR --docs"


def test_each_disagreement_with_the_thesis_is_explained() -> None:
    kept = comparison.read(ROOT / docs.KEPT)["records"]
    rows = [row for row in kept if row["part"] == "factors" and "factor" in row and "refused" not in row]
    assert {row["factor"] for row in rows} == {factor.name for factor in factors.FACTORS}
    found = factors.disagreements(rows)
    assert found
    assert [one[:5] for one in found if not one[5]] == []


@pytest.mark.parametrize("name", docs.PLOTS)
def test_the_plots_of_the_documentation_are_those_of_the_last_report(name: str) -> None:
    drawn = docs.plot(name, comparison.read(ROOT / docs.KEPT))
    assert (ROOT / name).read_text(encoding="utf-8") == drawn, "run decalgl report --out DIR --docs"
    assert any(Path(name).name in (ROOT / page_name).read_text() for page_name in docs.PAGES)


@pytest.mark.parametrize("arguments", [{"size": "huge"}, {"names": ["colours"]}, {"step": "vast"}])
def test_unknown_words_are_refused(tmp_path: Path, arguments: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="Choose from"):
        command.make(tmp_path / "x", **{"size": "tiny", **arguments})


def test_the_reference_may_look_at_the_seen_part_alone() -> None:
    drawn = case_studies.build("floods", "tiny")
    scene, camera = drawn.scene(), views.views(drawn)["close"]
    size, crop = (64, 36), (20, 10, 36, 20)
    part = accuracy.seen_part(scene, camera, size, crop)
    assert sum(map(len, (layer.features for layer in part.layers))) < sum(
        len(layer.features) for layer in scene.layers
    )
    whole = reference.render_overlay(scene, camera, size, crop, samples=4)
    assert np.array_equal(reference.render_overlay(part, camera, size, crop, samples=4).rgba, whole.rgba)


@pytest.mark.parametrize("view", ["overview", "oblique", "grazing"])
def test_a_narrowed_camera_sees_the_middle_of_the_picture(view: str) -> None:
    drawn = case_studies.build("floods", "tiny")
    camera, size, crop = views.views(drawn)[view], (64, 36), (21, 8)
    places = np.column_stack([drawn.parts[0].data.coords[:100], np.zeros(100)])
    whole, depth = camera.project(places, size)
    middle, same_depth = accuracy.narrowed(camera, size, crop).project(places, crop)
    assert np.array_equal(depth, same_depth)
    assert np.allclose(whole - middle, np.subtract(size, crop) / 2, rtol=1e-9, atol=1e-9, equal_nan=True)


def test_the_middle_alone_is_judged_as_in_the_whole_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = case_studies.build("floods", "tiny")
    cameras = {name: views.views(drawn)[name] for name in ("close", "oblique")}
    judge = accuracy.Judge(drawn, cameras, (64, 36), (32, 18))
    some = [
        Setting("static", "coverage"),
        Setting("dynamic", "coverage", "coverage", "auto", dg.Dynamic(), pixels=True),
        Setting("static bvh", "none", "none", renderer={"index": dg.BvhIndex()}),
        Setting("volume", "none", "none", dg.Volume(), dg.Volume()),
    ]
    alone = [judge.judge(setting) for setting in some]
    monkeypatch.setattr(Setting, "looks_around", True)
    for one, setting in zip(alone, some, strict=True):
        whole = judge.judge(setting)
        for view in cameras:
            assert whole[view] == pytest.approx(one[view], abs=1.01 / 255), setting.name
            assert 0.0 < one[view]["edge_rms"] < 0.5


def test_floods_have_more_holes_than_areas() -> None:
    areas = case_studies.build("floods", "offline").parts[0].data
    holes = len(areas.part_offsets) - 1 - len(areas)
    assert holes > len(areas) > 100


def test_bands_share_the_ground_among_them() -> None:
    z = np.add.outer(np.arange(20.0), np.sin(np.arange(30.0))).astype(np.float32)
    ground = dg.Terrain(z, 0.0, 19.0, 1.0, 1.0)
    table, heights = derive.bands(ground, [(-5.0, 4.5), (4.5, 12.3), (12.3, 30.0)])
    assert table.sizes().sum() == pytest.approx(19.0 * 29.0)
    assert set(heights) == {4.5, 12.3, 30.0}
    twice = derive.repeated(table, np.array([[0.0, 0.0], [100.0, 0.0]]))
    assert twice.sizes().sum() == pytest.approx(2.0 * 19.0 * 29.0)
    kept = derive.chosen(twice, twice.coords[twice.part_offsets[twice.feature_offsets[:-1]], 0] < 50.0)
    assert np.array_equal(kept.coords, table.coords)


def test_the_front_has_what_nothing_beats() -> None:
    points = [plots.Point(x, y, "a", f"{x} {y}") for x, y in ((1, 5), (2, 6), (2, 3), (4, 3), (5, 1))]
    assert [(point.x, point.y) for point in plots.pareto(points)] == [(1, 5), (2, 3), (5, 1)]


@pytest.mark.parametrize(
    ("first", "last", "spread", "expected"),
    [(100.0, 200.0, 0.0, "+"), (200.0, 100.0, 0.0, "–"), (1.0, 4.0, 0.0, "~"), (100.0, 170.0, 0.2, "~")],
)
def test_signs_leave_noise_out(first: float, last: float, spread: float, expected: str) -> None:
    rows = [{"rank": i, "update_ms": ms, "update_ms_spread": spread} for i, ms in enumerate((first, last))]
    assert factors.sign(rows, "update_ms") == expected


def test_pages_escape_what_is_text() -> None:
    figure = Figure("a < b", "see [c](d.png) & e", table=Table(("<x>",), [("1,234 ms",), ("[f](g.png)",)]))
    text = page.page("t", {"cores": 2}, "n", [page.Section("s", "S", "about", [figure])])
    assert "a &lt; b" in text
    assert '<a href="d.png">c</a> &amp; e' in text
    assert '<td class="number">1,234 ms</td>' in text
    assert not Links(text).open


def test_numbers_in_words() -> None:
    assert [number(value) for value in (1234.5, 0.01234, 0.0, float("nan"))] == ["1,234", "0.0123", "0", "–"]
    assert [byte_count(count) for count in (12, 12_345, 1.2e10)] == ["12.0 bytes", "12.3 kB", "12.0 GB"]
