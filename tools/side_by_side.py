"""One scene drawn by each technique, with its error and time under each picture: python -m tools.side_by_side.

Land cover and isolines behind Honolulu. A technique that draws no polygons, or no lines, leaves them to "static"; one
that knows no coverage takes eight samples of the whole picture. The error is the root mean square of the difference to
`decalgl.reference` over the pixels of a crop that an edge passes, of 255. The time is that of the layers' passes.
"""

from __future__ import annotations

import argparse
import functools
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

import decalgl as dg
from decalgl import reference

from .gallery.sheet import GAP, enlarged, sheet

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import honolulu

if TYPE_CHECKING:
    import geopandas as gpd
    from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs" / "images" / "techniques.jpg"
SIZE = (408, 240)
DETAIL = (200, 120, 268, 160)  # left, top, right, bottom: compared with the reference, and shown enlarged
ENLARGED = 6
SAMPLES = 16  # of the reference, each way
RUNS = 5
GROUND = (0xE9, 0xE5, 0xDC)
LAYER_PASSES = ("static", "dynamic", "loops", "volume", "clipmap", "distance_field")


@dataclass(frozen=True)
class Entry:
    """Who draws polygons and lines, and how edges are filtered."""

    polygons: str | dg.Technique = "static"
    lines: str | dg.Technique = "static"
    antialias: str = "coverage"
    pixels: bool = False  # whether widths are those on the screen


ENTRIES = {
    "static": Entry(),
    "dynamic (lines)": Entry(lines="dynamic", pixels=True),
    "loops": Entry("loops", "loops"),
    "volume": Entry("volume", "volume", antialias="ssaa"),
    "clipmap": Entry("clipmap", "clipmap"),
    "distance_field (lines)": Entry(lines="distance_field"),
}


@functools.cache
def _terrain() -> dg.Terrain:
    return dg.Terrain.open(honolulu.DEM)


@functools.cache
def _data() -> tuple[gpd.GeoDataFrame, gpd.GeoDataFrame]:
    cover = honolulu.land_cover()
    return cover[~cover["material"].isin(honolulu.NETWORK)], honolulu.isolines(_terrain(), 50.0)


def _scene(entry: Entry) -> dg.Scene:
    color = "#{:02x}{:02x}{:02x}".format(*GROUND)
    relief = dg.Relief(color=color, strength=0.0)
    scene = dg.Scene(_terrain(), exaggeration=honolulu.EXAGGERATION, relief=relief)
    areas, lines = _data()
    scene.add_polygons(areas, column="material", cmap=honolulu.PALETTE, technique=entry.polygons)
    width, units = (2.0, "px") if entry.pixels else (20.0, "m")
    scene.add_lines(
        lines, color=honolulu.ISOLINE_COLOR, width=width, width_units=units, technique=entry.lines
    )
    return scene


@functools.cache
def _true_picture(pixels: bool) -> NDArray[np.float64]:
    """The detail as the reference draws it, 0..255, and which pixels an edge passes, in a fourth channel."""
    scene = _scene(Entry(lines="dynamic" if pixels else "static", pixels=pixels))
    overlay = reference.render_overlay(scene, _camera(), SIZE, DETAIL, samples=SAMPLES)
    seen = overlay.rgba[..., :3] + (1.0 - overlay.rgba[..., 3:]) * np.array(GROUND) / 255
    return np.concatenate([255 * seen, overlay.varied[..., None]], axis=2)


def _camera() -> dg.Camera:
    return dg.Camera.look_at(honolulu.EYE, honolulu.TARGET, fov=honolulu.FIELD_OF_VIEW)


def panel(entry: Entry) -> tuple[Image.Image, float, float]:
    """The picture with its enlarged detail beside it; its error, of 255; milliseconds of the layers."""
    renderer = dg.Renderer(SIZE, antialias=entry.antialias, terrain_error=0.0)
    renderer.preprocess(_scene(entry))
    times = []
    for _ in range(RUNS):
        renderer.forget()
        renderer.update(_camera())
        frame = renderer.render()
        passes = frame.stats.passes
        times.append(sum(each["ms"] for each in passes if each["name"] in LAYER_PASSES))
    picture = Image.fromarray(frame.image).convert("RGB")
    left, top, right, bottom = DETAIL
    true = _true_picture(entry.pixels)
    difference = frame.image[top:bottom, left:right, :3] - true[..., :3]
    error = float(np.sqrt((difference[true[..., 3] > 0] ** 2).mean()))
    both = Image.new("RGB", (SIZE[0], 2 * SIZE[1] + GAP), "white")
    both.paste(picture, (0, 0))
    both.paste(enlarged(picture, DETAIL, ENLARGED), (0, SIZE[1] + GAP))
    return both, error, statistics.median(times)


def main() -> None:
    parser = argparse.ArgumentParser(prog="tools.side_by_side", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=PICTURE)
    arguments = parser.parse_args()
    panels = {}
    for name, entry in ENTRIES.items():
        picture, error, milliseconds = panel(entry)
        label = f"{name}, {entry.antialias}: error {error:.1f}, {milliseconds:.0f} ms"
        print(label)
        panels[label] = picture
    sheet(panels, 3).save(arguments.out, optimize=True, quality=85)


if __name__ == "__main__":
    main()
