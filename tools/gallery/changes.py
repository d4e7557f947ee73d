"""What changes without preparing anew: lenses, fading and filters, edits; panels of one renderer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image
from shapely import LineString, Point, box

import decalgl as dg
import honolulu

from .ground import EYE, KINDS, cover, ground_scene, isolines
from .sheet import BLUE, DARK, GREEN, RED, YELLOW, panel_size, paper, sheet

if TYPE_CHECKING:
    from collections.abc import Callable

MAP_PANEL = 152
GREENS = ("Scrub", "MixedForest", "Grassland", "Grass")


def _shot(renderer: dg.Renderer) -> Image.Image:
    return Image.fromarray(renderer.render().image).convert("RGB")


def _map_renderer(size: tuple[int, int]) -> dg.Renderer:
    """Land cover, and isolines over it."""
    scene = ground_scene()
    palette = {**honolulu.PALETTE, **KINDS}
    scene.add_polygons(cover(), name="land", column="material", cmap=palette)
    scene.add_lines(isolines(50.0), name="isolines", color=honolulu.ISOLINE_COLOR, width=12, width_units="m")
    renderer = dg.Renderer(size)
    renderer.preprocess(scene)
    renderer.update(EYE)
    return renderer


def lenses() -> Image.Image:
    """Other layers, other colours and other opacities inside a circle on the screen or a polygon on the map."""
    size = panel_size(3, MAP_PANEL)
    renderer = _map_renderer(size)
    renderer.restyle("isolines", visible=False)
    panels = {}
    circle = (0.5 * size[0], 0.62 * size[1], 0.33 * size[1])
    renderer.lens = dg.Lens(circle=circle, styles={"isolines": {"visible": True}})
    panels["a layer, in a circle on the screen"] = _shot(renderer)
    seen = renderer.render().world[int(0.75 * size[1]), size[0] // 2, :2]
    renderer.lens = dg.Lens(
        polygon=Point(seen).buffer(1100.0), styles={"land": {"column": "material", "cmap": "tab20"}}
    )
    panels["colours, in a polygon on the map"] = _shot(renderer)
    renderer.restyle("isolines", visible=True)
    renderer.lens = dg.Lens(circle=circle, styles={"land": {"opacity": 0.2}}, hidden=("isolines",))
    panels["opacity=0.2, and a hidden layer"] = _shot(renderer)
    return sheet(panels, 3)


def fading() -> Image.Image:
    """Categories that fade, and a filter by a column."""
    size = panel_size(3, MAP_PANEL)
    renderer = _map_renderer(size)
    panels = {}
    for opacity in (0.6, 0.2):
        renderer.restyle("land", opacity=dict.fromkeys(GREENS, opacity))
        panels[f"opacity={{forest: {opacity}, ...}}"] = _shot(renderer)
    renderer.restyle("land", opacity=1.0, visible="material in ('Road', 'Freeway', 'Stream', 'Ocean')")
    renderer.restyle("isolines", visible="elevation % 200 == 0", color=RED)
    panels['visible="elevation % 200 == 0"'] = _shot(renderer)
    return sheet(panels, 3)


def edits() -> Image.Image:
    """Features that come, move, go and get another geometry and look."""
    size = panel_size(3, 128)
    scene = paper(size)
    lots = [box(20 + 60 * i, 14 + 52 * j, 72 + 60 * i, 58 + 52 * j) for j in range(2) for i in range(4)]
    scene.add_polygons(
        lots,
        name="lots",
        color=GREEN,
        outline=dg.Outline(width=3, width_units="m", color=DARK, corner="miter"),
    )
    scene.add_lines(
        [LineString([(4, 62), (268, 62)])],
        name="ways",
        color="white",
        width=6,
        width_units="m",
        casing=dg.Casing(width=2),
    )
    renderer = dg.Renderer(size)
    renderer.preprocess(scene)
    renderer.update(dg.Camera.top_down((0.0, 0.0, *size)))
    panels = {"prepared": _shot(renderer)}
    renderer.edit("ways", add=[LineString([(196, 4), (196, 124)])], color=YELLOW, width=9)
    renderer.edit(
        "lots", remove=[6], move={7: (0.0, 8.0), 2: (-6.0, 0.0)}, replace={4: Point(46, 88).buffer(24)}
    )
    panels["edit(add=, remove=, move=, replace=)"] = _shot(renderer)
    renderer.restyle("lots", color=np.array([GREEN, BLUE] * 4), outline={"color": RED})
    panels["restyle(color=, outline=)"] = _shot(renderer)
    return sheet(panels, 3)


PICTURES: dict[str, Callable[[], Image.Image]] = {
    "lenses.jpg": lenses,
    "fading.jpg": fading,
    "edits.png": edits,
}
