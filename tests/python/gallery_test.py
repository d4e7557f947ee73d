"""The gallery shows every picture that there is, and pictures are drawn as the page has them."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import decalgl as dg

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "images" / "gallery"
CHEAP = "miter_limits.png"


@pytest.fixture(scope="module")
def gallery() -> Any:
    """The program that draws the pictures, which is not installed."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT))
        yield importlib.import_module("tools.gallery.__main__")


def test_the_page_shows_every_picture(gallery: Any) -> None:
    text = (ROOT / "docs" / "gallery.md").read_text()
    shown = re.findall(r"\]\(images/gallery/([^)]+)\)", text)
    assert sorted(shown) == sorted(gallery.PICTURES)
    assert sorted(path.name for path in FOLDER.iterdir()) == sorted(gallery.PICTURES)


def test_pictures_are_small() -> None:
    sizes = {path.name: path.stat().st_size for path in FOLDER.iterdir()}
    assert not {name: size for name, size in sizes.items() if size > 60_000}
    assert sum(sizes.values()) < 1_200_000


def test_a_picture_is_drawn_as_the_page_has_it(gallery: Any, tmp_path: Path) -> None:
    again = gallery.draw(CHEAP, tmp_path)
    driver = next(record.detail for record in dg.doctor() if record.ok)
    if "llvmpipe" in driver:  # the driver of the pictures; others round in their own ways
        assert again.read_bytes() == (FOLDER / CHEAP).read_bytes(), "run make gallery"
    with Image.open(again) as picture, Image.open(FOLDER / CHEAP) as kept:
        assert picture.size == kept.size
    first = again.read_bytes()
    assert gallery.draw(CHEAP, tmp_path).read_bytes() == first
