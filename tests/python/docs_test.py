"""The documentation is true where a test can tell: code blocks run, links lead somewhere, figures are the last ones."""

from __future__ import annotations

import dataclasses
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import decalgl as dg
from decalgl.bench import docs
from decalgl.scene_file import read_scene_file
from small_scenes import flat_scene

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md")])
README = ROOT / "README.md"
LINK = re.compile(r"\]\(([^)#\s]+)(#[^)]*)?\)")


def blocks(page: Path, language: str) -> list[str]:
    """The fenced blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder where the README's paths lead somewhere and pictures do no harm."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    return tmp_path


def run(command: list[str], folder: Path) -> str:
    outcome = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stderr
    return outcome.stdout


def test_the_python_example_of_the_readme(folder: Path) -> None:
    (example,) = blocks(README, "python")
    out = run([sys.executable, "-c", example], folder)
    assert re.match(r".+, row \d+\n", out)
    with Image.open(folder / "map.png") as picture:
        assert picture.size == (1280, 720)


def test_the_commands_of_the_readme(folder: Path) -> None:
    (commands,) = blocks(README, "sh")
    for line in commands.replace("\\\n", " ").splitlines():
        program, command, *arguments = shlex.split(line)
        assert program == "decalgl"
        if command == "render":
            arguments += ["--size", "96x54"]
        run([sys.executable, "-m", "decalgl.cli", command, *arguments], folder)
        if command == "render":
            assert (folder / arguments[arguments.index("-o") + 1]).stat().st_size > 0


def test_the_cpp_example_of_the_readme_is_the_installed_one() -> None:
    (example,) = blocks(README, "cpp")
    names = set(re.findall(r"#include <(decalgl/[^>]+)>", example))
    assert names
    assert all((ROOT / "cpp" / "include" / name).is_file() for name in names)


def test_the_stages_by_hand() -> None:
    (example,) = blocks(ROOT / "docs" / "python.md", "python")
    names: dict[str, Any] = {"dg": dg, "scene": flat_scene()}
    exec(example, names)
    assert names["frame"].image.shape == (360, 640, 4)


def test_the_styles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = ROOT / "docs" / "styles.md"
    (example,) = blocks(page, "python")
    monkeypatch.chdir(tmp_path)
    scene = flat_scene()
    exec(example, {"dg": dg, "scene": scene})
    with Image.open("map.png") as picture:
        assert picture.size == (640, 640)
    assert [len(layer.legend_handles()) for layer in scene.layers] == [3, 3]
    (description,) = blocks(page, "toml")
    Path("scene.toml").write_text(description)
    areas, ways = read_scene_file("scene.toml").layers
    assert set(areas.keywords) > {"outline", "hatch"}
    assert set(ways.keywords) > {"dash", "casing", "bands"}


def test_the_styles_name_every_keyword() -> None:
    text = (ROOT / "docs" / "styles.md").read_text()
    for look in (dg.Casing, dg.Outline, dg.Hatch, dg.Pattern):
        names = [field.name for field in dataclasses.fields(look)]
        assert not [
            name for name in names if not re.search(rf"`{name}[`=]|[ (]{name}[=,)]|\b{name} =", text)
        ], look


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])
def test_links_lead_somewhere(page: Path) -> None:
    targets = [target for target, _ in LINK.findall(page.read_text()) if "://" not in target]
    missing = [target for target in targets if not (page.parent / target).exists()]
    assert not missing


def test_the_documentation_names_what_there_is() -> None:
    text = (ROOT / "docs" / "python.md").read_text()
    unnamed = [name for name in dg.__all__ if name.endswith("Error") and f"`{name}`" not in text]
    assert not unnamed


def test_figures_are_those_of_the_last_benchmark() -> None:
    results = docs.read_results(ROOT)
    for page in docs.PAGES:
        text = (ROOT / page).read_text()
        assert docs.marked("bench").search(text), page
        assert docs.fill(text, results) == text, f"{page}: run decalgl bench --docs"
