"""Maps over terrain: colours and legends, slopes, anti-aliasing, silhouettes, indexes. Real data is Honolulu's."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import PowerNorm
from PIL import Image
from shapely import LineString

import decalgl as dg
import honolulu

from .ground import EYE, KINDS, cover, ground_scene, isolines, terrain
from .sheet import BLUE, RED, draw, enlarged, panel_size, sheet

if TYPE_CHECKING:
    from collections.abc import Callable

MAP_SIZE = (760, 380)


def _saved(scene: dg.Scene, camera: dg.Camera = EYE, size: tuple[int, int] = MAP_SIZE) -> Image.Image:
    """As `Frame.save` writes it, with its legends."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.png"
        scene.render(camera, size).save(path)
        with Image.open(path) as picture:
            return picture.convert("RGB")


def categories() -> Image.Image:
    """Land cover by category; what has no colour of its own shares one."""
    scene = ground_scene()
    shown = cover()[cover()["material"].isin(KINDS)]
    scene.add_polygons(cover(), color="#d3d8bd")
    scene.add_polygons(
        shown,
        column="material",
        cmap=KINDS,
        outline=dg.Outline(width=3, width_units="m", color="#6b6250", alpha=0.6),
        legend=True,
        legend_kwds={"title": "Land cover", "loc": "upper right", "fontsize": 8},
    )
    return _saved(scene)


def numbers() -> Image.Image:
    """Isolines by height, wider every 200 m."""
    scene = ground_scene(dg.Relief(color="#cfccc4", strength=0.4))
    lines = isolines(50.0)
    scene.add_lines(
        lines,
        column="elevation",
        cmap="viridis",
        norm=PowerNorm(0.7),
        width=np.where(lines["elevation"] % 200 == 0, 20.0, 8.0),
        width_units="m",
        slope_correction="tangent",
        legend=True,
        legend_kwds={"label": "height in metres", "shrink": 0.8},
    )
    return _saved(scene)


def styled_map() -> Image.Image:
    """Many styles on one map: hatched crops, inset outlines, cased roads, banded isolines."""
    scene = ground_scene()
    everything = cover()
    areas = everything[~everything["material"].isin(honolulu.NETWORK)]
    hatch: dict[str, dg.Hatch | None] = dict.fromkeys(areas["material"].unique())
    hatch["GolfCourse"] = dg.Hatch(spacing=60, width=30, angle=30)
    hatch["Grassland"] = dg.Hatch(spacing=50, width=25, angle=100)
    scene.add_polygons(
        areas,
        column="material",
        cmap=honolulu.PALETTE,
        hatch=hatch,
        outline=dg.Outline(
            width=10, width_units="m", mode="inset", color="#5d6b46", alpha=0.5, corner="miter"
        ),
    )
    common, heavy = honolulu.split_isolines(isolines(50.0), every=200.0)
    scene.add_lines(common, color=honolulu.ISOLINE_COLOR, alpha=0.6, width=4, width_units="m")
    scene.add_lines(
        heavy,
        width=26,
        width_units="m",
        bands=[(0.35, "#5b3d1d"), (1.0, "#f6ecd9")],
        slope_correction="tangent",
    )
    network = everything[everything["material"].isin(("Road", "Freeway"))]
    scene.add_polygons(
        network,
        column="material",
        cmap=honolulu.PALETTE,
        outline=dg.Outline(width=6, width_units="m", mode="offset", color="#6d5c4a"),
    )
    # Up a ridge: an arrow of its own width, and a wider white one below.
    trail = [(-3707, -4557), (-3360, -3946), (-3282, -3626), (-2731, -3327), (-1186, -2547), (-615, -1810)]
    arrows = dg.Pattern.arrows(every=330, length=190, shaft=0.35)
    scene.add_lines(
        [LineString(trail)],
        crs=terrain().crs,
        color=RED,
        width=80,
        width_units="m",
        cap="butt",
        corner="miter",
        dash=arrows,
        casing=dg.Casing(width=22, color="white", dash=arrows),
    )
    return draw(scene, MAP_SIZE, EYE)


def _steep_scene(correction: str | None) -> dg.Scene:
    """A ridge as steep as 65 degrees, with lines along it and dashed ones across."""
    x = np.linspace(-200.0, 200.0, 161)
    ridge = 150.0 * np.exp(-((x / 62.0) ** 2))
    ground = dg.Terrain(np.tile(ridge, (161, 1)).astype(np.float32), -200.0, 200.0, 2.5, 2.5)
    scene = dg.Scene(ground, relief=dg.Relief(color="#cfc9bb", strength=0.35))
    along = [LineString([(a, -190), (a, 190)]) for a in (-150, -90, -45, 0, 45, 90, 150)]
    across = [LineString([(-190, b), (190, b)]) for b in (-120, -40, 40, 120)]
    looks: dict[str, Any] = {"width": 10, "width_units": "m", "slope_correction": correction}
    scene.add_lines(along, color=BLUE, **looks)
    scene.add_lines(across, color=RED, dash=(20, 12), cap="butt", **looks)
    return scene


def slopes() -> Image.Image:
    """The same lines of 10 m, from the side and from above."""
    size = panel_size(3, 200)
    side = dg.Camera.orbit((0, -20, 40), distance=560, azimuth=250, elevation=28, fov=35)
    above = dg.Camera.top_down((-180, -130, 180, 130))
    panels = {}
    for camera, place in ((side, "from the side"), (above, "from above")):
        for correction in (None, "thoeny", "tangent"):
            label = f'"{correction}"' if correction else "None"
            panels[f"slope_correction={label}, {place}"] = draw(_steep_scene(correction), size, camera)
    return sheet(panels, 3)


def _lines_scene() -> dg.Scene:
    """Isolines of two widths over roads, on ground without shadows."""
    scene = ground_scene(dg.Relief(color="#e9e5dc", strength=0.0))
    network = cover()[cover()["material"].isin(honolulu.NETWORK)]
    scene.add_polygons(network, column="material", cmap={**honolulu.PALETTE, "Road": "#8d8478"})
    common, heavy = honolulu.split_isolines(isolines(50.0), every=200.0)
    scene.add_lines(common, color=honolulu.ISOLINE_COLOR, width=5, width_units="m")
    scene.add_lines(heavy, color=honolulu.ISOLINE_COLOR, width=14, width_units="m")
    return scene


def zooms() -> Image.Image:
    """Isolines and roads of 12 m, and of 1.6 pixels, from three distances (after Zechmeister 2020, figure 3.2)."""
    size = panel_size(3, 104)
    roads = cover()[cover()["material"].isin(("Road", "Freeway"))]
    panels = {}
    for label, looks in (("12 m", {"width": 12, "width_units": "m"}), ("1.6 pixels", {"width": 1.6})):
        scene = ground_scene(dg.Relief(color="#e9e5dc", strength=0.45))
        outline: dict[str, Any] = {**looks, "color": BLUE}
        scene.add_polygons(roads, color="none", outline=dg.Outline(**outline))
        scene.add_lines(isolines(100.0), color=RED, **looks)
        for distance in (12_000.0, 4000.0, 1200.0):
            camera = dg.Camera.orbit((-1600.0, -3000.0, 300.0), distance=distance, azimuth=200, elevation=32)
            panels[f"{label}, from {distance / 1000:g} km"] = draw(scene, size, camera)
    return sheet(panels, 3)


def antialiasing() -> Image.Image:
    """A part of the valleys, three times enlarged, with each mode."""
    modes: dict[str, dict[str, Any]] = {
        '"none"': {"antialias": "none"},
        '"coverage"': {"antialias": "coverage"},
        '"coverage", coverage="thoeny"': {"antialias": "coverage", "coverage": "thoeny"},
        '"msaa", samples=8': {"antialias": "msaa", "samples": 8},
        '"ssaa", samples=8': {"antialias": "ssaa", "samples": 8},
        '"fxaa"': {"antialias": "fxaa"},
    }
    scene = _lines_scene()
    box = (330, 226, 420, 292)
    drawn = {
        f"antialias={label}": enlarged(draw(scene, (640, 360), EYE, **mode), box, 3)
        for label, mode in modes.items()
    }
    return sheet(drawn, 3)


def silhouettes() -> Image.Image:
    """A ridge before the sky and before another one, four times enlarged."""
    scene = _lines_scene()
    scene.relief = dg.Relief(color="#cfc9bb", strength=0.4)
    modes: dict[str, dict[str, Any]] = {
        "none": {},
        "coverage": {},
        "ssaa": {"samples": 32},
    }
    box = (246, 72, 313, 122)
    drawn = {
        f'antialias="{mode}"': enlarged(draw(scene, (640, 360), EYE, antialias=mode, **options), box, 4)
        for mode, options in modes.items()
    }
    return sheet(drawn, 3)


def indexes() -> Image.Image:
    """One scene from three indexes, twice enlarged."""
    scene = ground_scene(dg.Relief(color="#e9e5dc", strength=0.0))
    scene.add_polygons(
        cover(),
        column="material",
        cmap=honolulu.PALETTE,
        outline=dg.Outline(width=12, width_units="m", mode="inset", color="#5d6b46", alpha=0.6),
    )
    scene.add_lines(isolines(50.0), color=honolulu.ISOLINE_COLOR, width=9, width_units="m", dash=(60, 30))
    box = (300, 190, 436, 286)
    options: dict[str, dict[str, Any]] = {
        'index="grid"': {"index": "grid"},
        'index="bvh"': {"index": "bvh"},
        'index="thoeny", coverage="thoeny"': {"index": "thoeny", "coverage": "thoeny"},
    }
    drawn = {label: enlarged(draw(scene, (640, 360), EYE, **one), box, 2) for label, one in options.items()}
    return sheet(drawn, 3)


PICTURES: dict[str, Callable[[], Image.Image]] = {
    "styled_map.jpg": styled_map,
    "categories.jpg": categories,
    "numbers.jpg": numbers,
    "slopes.png": slopes,
    "zooms.jpg": zooms,
    "antialiasing.png": antialiasing,
    "silhouettes.png": silhouettes,
    "indexes.png": indexes,
}
