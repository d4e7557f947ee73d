"""The folders show the way of the data: dependencies between the areas of the C++ core point one way."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
AREAS = {
    "core": set(),
    "gl": {"core"},
    "geo": {"core", "terrain"},  # it resamples terrains
    "vector": {"core"},
    "terrain": {"core"},
    "technique": {"core", "gl", "terrain", "vector"},
    "frame": {"core", "gl", "vector", "terrain", "technique"},
    "app": {"core", "geo", "vector", "terrain", "frame"},
}
INCLUDE = re.compile(r'#include "(?:decalgl/)?(\w+)/')


def sources(area: str) -> list[Path]:
    folders = (ROOT / "cpp" / "include" / "decalgl" / area, ROOT / "cpp" / "src" / area)
    return [path for folder in folders for path in folder.rglob("*") if path.suffix in (".h", ".cpp")]


@pytest.mark.parametrize("area", AREAS)
def test_an_area_includes_only_what_lies_before_it(area: str) -> None:
    found = sources(area)
    assert found
    for path in found:
        used = {name for name in INCLUDE.findall(path.read_text()) if name in AREAS and name != area}
        assert used <= AREAS[area], f"{path.relative_to(ROOT)} includes {used - AREAS[area]}"


def test_only_geo_knows_geographiclib() -> None:
    for area in AREAS:
        for path in sources(area):
            assert area == "geo" or "GeographicLib" not in path.read_text(), path.relative_to(ROOT)


def test_terrain_and_vector_know_no_gl() -> None:
    for area in ("core", "geo", "vector", "terrain"):
        for path in sources(area):
            assert not re.search(r"\bgl[A-Z]\w+\(", path.read_text()), path.relative_to(ROOT)


def test_a_technique_includes_no_other() -> None:
    folders = [path for path in (ROOT / "cpp" / "src" / "technique").iterdir() if path.is_dir()]
    for folder in folders:
        others = {other.name for other in folders if other != folder}
        for path in folder.rglob("*.[hc]*"):
            used = set(re.findall(r'#include "technique/(\w+)/', path.read_text()))
            assert not used & others, path.relative_to(ROOT)
