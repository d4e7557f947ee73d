"""Panels with labels beside each other, as one picture, and the level paper that most of them are drawn on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from PIL import Image, ImageDraw, ImageFont

import decalgl as dg

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

WIDTH = 832
GAP = 8
LABEL = 18
PAPER = "#f6f3ea"
BLUE, RED, GREEN, YELLOW, DARK = "#2f6690", "#bc4b51", "#5b8e7d", "#f4a259", "#33373d"
FONT = Path(mpl.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"


def panel_size(columns: int, height: int) -> tuple[int, int]:
    """The size of one of so many panels beside each other."""
    return (WIDTH - (columns - 1) * GAP) // columns, height


def paper(size: tuple[int, int]) -> dg.Scene:
    """Level ground, a metre to the pixel, and some more around it."""
    margin = 50.0
    ground = dg.Terrain.flat((-margin, -margin, size[0] + margin, size[1] + margin))
    return dg.Scene(ground, relief=dg.Relief(color=PAPER, strength=0.0))


def draw(
    scene: dg.Scene, size: tuple[int, int], camera: dg.Camera | None = None, **options: Any
) -> Image.Image:
    """A picture, of paper where no camera is given."""
    seen = dg.Camera.top_down((0.0, 0.0, *size)) if camera is None else camera
    return Image.fromarray(scene.render(seen, size, **options).image).convert("RGB")


def enlarged(picture: Image.Image, box: tuple[int, int, int, int], times: int) -> Image.Image:
    """A part of a picture, left, top, right, bottom, with pixels as squares."""
    part: NDArray[np.uint8] = np.asarray(picture.crop(box))
    return Image.fromarray(np.kron(part, np.ones((times, times, 1), dtype=np.uint8)))


def sheet(panels: Mapping[str, Image.Image], columns: int) -> Image.Image:
    """Panels of one size, row by row, each over its label."""
    width, height = next(iter(panels.values())).size
    rows = -(-len(panels) // columns)
    page = Image.new(
        "RGB", (columns * (width + GAP) - GAP, rows * (height + LABEL + GAP) - GAP), color="white"
    )
    pen = ImageDraw.Draw(page)
    font = ImageFont.truetype(FONT, 12)
    for number, (label, picture) in enumerate(panels.items()):
        x = number % columns * (width + GAP)
        y = number // columns * (height + LABEL + GAP)
        page.paste(picture, (x, y))
        pen.text((x + width // 2, y + height + LABEL // 2 + 1), label, fill=DARK, font=font, anchor="mm")
    return page
