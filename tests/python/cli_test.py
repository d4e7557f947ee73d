"""The command line: pictures, descriptions, errors in one line, exit codes, Ctrl-C."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from rich.console import Console

import decalgl
from decalgl import _drawing, cli
from decalgl.errors import CancelledError, InputError

HONOLULU = Path(__file__).resolve().parents[2] / "examples" / "data" / "honolulu"
SCENE = """
[terrain]
flat = [-50, -50, 50, 50]
crs = "EPSG:32604"
[[layers]]
type = "polygons"
path = "square.geojson"
color = "#ff0000"
[views.map]
top_down = {}
[views.near]
look_at = { eye = [0, -40, 30], target = [0, 0, 0] }
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    ring = [[-20, -20], [20, -20], [20, 20], [-20, 20], [-20, -20]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32604"}}
    feature = {"type": "Feature", "properties": {"kind": 1}, "geometry": geometry}
    collection = {"type": "FeatureCollection", "crs": crs, "features": [feature]}
    (tmp_path / "square.geojson").write_text(json.dumps(collection))
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def run(capfd: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    """(exit code, standard output, standard error) of one command line."""
    code = cli.run([str(argument) for argument in arguments])
    captured = capfd.readouterr()
    return code, captured.out, captured.err


def pixels(path: Path) -> Any:
    """The picture as an array (height, width, 4)."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGBA"))


def test_sizes_and_amounts() -> None:
    assert cli.parse_size("1920x1080") == (1920, 1080)
    assert cli.parse_size("12 × 7") == (12, 7)
    assert cli.parse_bytes("800MB") == 800_000_000
    assert cli.parse_bytes("1.5 GiB") == 3 << 29
    assert cli.parse_bytes("4096") == 4096
    for wrong in ("", "12", "0x5", "-1x5", "axb", "1x2x3"):
        with pytest.raises(InputError, match="--size"):
            cli.parse_size(wrong)
    for wrong in ("", "MB", "12 apples", "0", "-5MB", "nan", "inf", "1e30GB"):
        with pytest.raises(InputError, match="--memory-limit"):
            cli.parse_bytes(wrong)


def test_help_names_every_command(capfd: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capfd, "--help")
    assert code == 0
    assert all(command in out for command in ("render", "info", "doctor"))


def test_render_draws_a_scene_file(scene: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = scene.parent / "map.png"
    code, out, err = run(capfd, "render", scene, "-o", output, "--size", "64x64", "--stats")
    assert code == 0, err
    assert "map.png" in err
    assert "What it cost" in out
    image = pixels(output).astype(int)
    assert image.shape[:2] == (64, 64)
    red = (image[..., 0] > 150) & (image[..., 1] < 80)
    assert 0.12 < red.mean() < 0.2  # (40 / 100)^2 of the ground


def test_render_keeps_a_cache(scene: Path, capfd: pytest.CaptureFixture[str]) -> None:
    first, second, cache = (scene.parent / name for name in ("first.png", "second.png", "map.decal"))
    common = ("render", scene, "--size", "32x32", "--cache", cache, "-o")
    assert run(capfd, *common, first)[0] == 0
    saved = cache.read_bytes()
    assert run(capfd, *common, second)[0] == 0
    assert (cache.read_bytes(), second.read_bytes()) == (saved, first.read_bytes())
    code, out, _ = run(capfd, "info", cache)
    assert code == 0
    for part in ("saved scene", "2 columns × 2 rows", "-50, -50, 50, 50", "polygons", "1 features"):
        assert part in out
    code, _, err = run(capfd, *common[:-2], scene, "-o", first)
    assert code == 2
    assert "name another file" in " ".join(err.split())
    cache.write_bytes(saved[:100])
    code, _, err = run(capfd, "info", cache)
    assert code == 2
    assert "is cut short" in " ".join(err.split())


def test_render_takes_a_view(scene: Path, capfd: pytest.CaptureFixture[str]) -> None:
    near, plan = scene.parent / "near.png", scene.parent / "plan.png"
    assert run(capfd, "render", scene, "-o", near, "--view", "near", "--size", "32x32")[0] == 0
    assert run(capfd, "render", scene, "-o", plan, "--view", "map", "--size", "32x32")[0] == 0
    assert near.read_bytes() != plan.read_bytes()


def test_render_takes_flags(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "map.png"
    flags = [
        "--dem",
        HONOLULU / "dem.tif",
        "--polygons",
        HONOLULU / "landcover.topojson.gz",
        "--crs",
        "EPSG:4326",
    ]
    code, _, err = run(
        capfd, "render", *flags, "--column", "material", "--top-down", "--size", "90x60", "-o", output
    )
    assert code == 0, err
    assert len(np.unique(pixels(output).reshape(-1, 4), axis=0)) > 20


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["{scene}"], "-o map.png"),
        (["-o", "{folder}/a.png"], "--dem"),
        (["{scene}", "-o", "{folder}"], "is a folder"),
        (["{scene}", "-o", "{folder}/absent/a.png"], "no folder"),
        (["{scene}", "-o", "{folder}/a.pgn"], "Use .png"),
        (["{folder}/absent.toml", "-o", "{folder}/a.png"], "no scene file"),
        (["{scene}", "-o", "{folder}/a.png", "--view", "nera"], "Did you mean 'near'"),
        (["{scene}", "-o", "{folder}/a.png", "--dem", "x.tif"], "--dem"),
        (["{scene}", "-o", "{folder}/a.png", "--eye", "1,2,3"], "--target"),
        (["{scene}", "-o", "{folder}/a.png", "--eye", "1,2", "--target", "1,2,3"], "x,y,z"),
        (["{scene}", "-o", "{folder}/a.png", "--view", "map", "--top-down"], "one of"),
        (["{scene}", "-o", "{folder}/a.png", "--fov", "30"], "--eye"),
        (["{scene}", "-o", "{folder}/a.png", "--size", "big"], "1920x1080"),
        (["--dem", "{folder}/absent.tif", "-o", "{folder}/a.png"], "absent.tif"),
        (["--dem", "{dem}", "-o", "{folder}/a.png", "--width", "3"], "--lines"),
        (["--dem", "{dem}", "-o", "{folder}/a.png", "--cmap", "Greens"], "--column"),
        (["--dem", "{dem}", "-o", "{folder}/a.png", "--color", "red"], "no layer"),
    ],
)
def test_mistakes_end_in_one_line(
    scene: Path, capfd: pytest.CaptureFixture[str], arguments: list[str], expected: str
) -> None:
    places = {"scene": scene, "folder": scene.parent, "dem": HONOLULU / "dem.tif"}
    code, out, err = run(capfd, "render", *(argument.format(**places) for argument in arguments))
    assert (code, out) == (2, "")
    assert err.startswith("error: ")
    assert expected in err
    assert "Traceback" not in err
    assert len(err.strip().splitlines()) == 1
    assert not list(scene.parent.glob("*.png"))


def test_debug_shows_the_traceback(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, _, err = run(capfd, "--debug", "info", tmp_path / "absent.tif")
    assert code == 2
    assert "Traceback" in err


def test_unknown_options_and_commands(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(capfd, "render", "--widht", "3")[0] == 2
    code, _, err = run(capfd, "rendr")
    assert code == 2
    assert "rendr" in err


def test_info_on_a_raster(capfd: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capfd, "info", HONOLULU / "dem.tif")
    assert code == 0
    assert "900 columns × 612 rows" in out
    assert "EPSG:4326" in out


def test_info_on_vectors(capfd: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capfd, "info", HONOLULU / "landcover.topojson.gz")
    assert code == 0
    assert "3,582" in out
    assert "material" in out
    assert not list(HONOLULU.glob("*.properties"))  # nothing is left beside the data


def test_info_on_parquet(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    geopandas = pytest.importorskip("geopandas")
    pytest.importorskip("pyarrow")
    points = geopandas.GeoSeries.from_xy([1.0, 2.0], [3.0, 4.0], crs="EPSG:2193").buffer(1.0)
    geopandas.GeoDataFrame({"kind": ["a", "b"]}, geometry=points).to_parquet(tmp_path / "a.parquet")
    code, out, _ = run(capfd, "info", tmp_path / "a.parquet")
    assert code == 0
    assert "Polygon" in out
    assert "kind" in out


def test_info_on_a_scene(scene: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capfd, "info", scene)
    assert code == 0
    assert "square" in out
    assert "near: look_at" in out


def test_info_on_other_files(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    other = tmp_path / "notes.txt"
    other.write_text("nothing to see")
    for path in (other, tmp_path / "absent.tif", tmp_path):
        code, _, err = run(capfd, "info", path)
        assert code == 2
        assert err.startswith("error: ")


class Record:
    """What `decalgl.doctor` gives for each way to draw."""

    def __init__(self, ok: bool) -> None:
        self.name, self.ok, self.detail, self.cure = "EGL [surfaceless]", ok, "Mesa", "apt install libegl1"


@pytest.mark.parametrize(("oks", "code"), [([True, False], 0), ([False], 1), ([], 1)])
def test_doctor(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], oks: list[bool], code: int
) -> None:
    monkeypatch.setattr(decalgl, "doctor", lambda: [Record(ok) for ok in oks], raising=False)
    got, out, err = run(capfd, "doctor")
    assert got == code
    assert out.count("[surfaceless]") == len(oks)
    assert ("can draw" in err) == (code == 1)


def test_doctor_looks_at_this_machine(capfd: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capfd, "doctor")
    assert code == 0
    assert "ok" in out


def test_an_interrupt_cancels_politely() -> None:
    before = signal.getsignal(signal.SIGINT)
    with _drawing.ProgressBars(Console(stderr=True), hidden=True) as bars:
        assert bars("preprocess", 0.5)
        bars.check()
        os.kill(os.getpid(), signal.SIGINT)
        assert not bars("preprocess", 0.6)
        with pytest.raises(CancelledError):
            bars.check()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def test_a_cancelled_picture(
    scene: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = _drawing.open_scene

    def interrupted(*arguments: Any) -> Any:
        signal.raise_signal(signal.SIGINT)
        return opened(*arguments)

    monkeypatch.setattr(_drawing, "open_scene", interrupted)
    output = scene.parent / "map.png"
    code, _, err = run(capfd, "render", scene, "-o", output)
    assert (code, err) == (130, "Cancelled.\n")
    assert not output.exists()


def test_the_module_runs_as_a_program(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "decalgl.cli", "info", str(tmp_path / "absent.tif")]
    outcome = subprocess.run(command, capture_output=True, text=True, check=False)
    assert outcome.returncode == 2
    assert outcome.stderr.startswith("error: There is no file")


def test_another_index_draws_the_same(scene: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    # Without anti-aliasing: filtered, far pixels of the grid come from levels of detail.
    options = ("--size", "64x36", "--antialias", "none")
    for index in ("grid", "bvh", "thoeny"):
        code, _, errors = run(
            capfd, "render", scene, "-o", tmp_path / f"{index}.png", "--index", index, *options
        )
        assert code == 0, errors
        assert (
            np.abs(pixels(tmp_path / f"{index}.png").astype(int) - pixels(tmp_path / "grid.png")).max() <= 2
        )
    code, _, errors = run(capfd, "render", scene, "-o", tmp_path / "x.png", "--index", "tree")
    assert code == 2
    assert "There is no index='tree'" in errors
