"""Draws the pictures of the documentation: `python docs/images/draw.py`.

honolulu.jpg    the demo, reduced to 1400 pixels
detail.png      a part of it, four times enlarged: decalgl on the left, the reference on the right
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import decalgl as dg
from decalgl import reference

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parents[1] / "examples"))

import demo  # noqa: E402
import honolulu  # noqa: E402

SIZE = (1920, 1080)
CROP = (325, 775, 455, 865)  # left, top, right, bottom: hairpin bends, isolines, borders of land cover
ENLARGED = 4
GAP = 12
SAMPLES = 16  # each way, so 256 a pixel


def draw_demo() -> None:
    """The demo's picture, small enough for a page."""
    frame = demo.build_scene().render(camera(), size=SIZE)
    width = 1400
    picture = Image.fromarray(frame.image).convert("RGB")
    picture = picture.resize((width, width * SIZE[1] // SIZE[0]), Image.Resampling.LANCZOS)
    picture.save(FOLDER / "honolulu.jpg", quality=84, optimize=True, progressive=True)


def draw_detail() -> None:
    """The layers alone, since the reference knows nothing of light: both over ground of one colour."""
    scene = demo.build_scene()
    scene.relief = dg.Relief(color="#e9e5dc", strength=0.0)
    left, top, right, bottom = CROP
    drawn = scene.render(camera(), size=SIZE, terrain_error=0.0).image[top:bottom, left:right, :3]
    overlay = reference.render_overlay(scene, camera(), SIZE, CROP, samples=SAMPLES).rgba
    ground = np.array([0xE9, 0xE5, 0xDC]) / 255
    true = np.rint(255 * (overlay[..., :3] + (1 - overlay[..., 3:]) * ground)).astype(np.uint8)
    gap = np.full((bottom - top, GAP // ENLARGED, 3), 255, dtype=np.uint8)
    pair = np.concatenate([drawn, gap, true], axis=1)
    picture = Image.fromarray(np.kron(pair, np.ones((ENLARGED, ENLARGED, 1), dtype=np.uint8)))
    picture.save(FOLDER / "detail.png", optimize=True)
    difference = np.abs(drawn.astype(int) - true.astype(int))
    print(f"detail: rms {np.sqrt((difference**2).mean()):.2f} and at most {difference.max()} of 255")


def camera() -> dg.Camera:
    """The demo's."""
    return dg.Camera.look_at(honolulu.EYE, honolulu.TARGET, fov=honolulu.FIELD_OF_VIEW)


if __name__ == "__main__":
    draw_demo()
    draw_detail()
