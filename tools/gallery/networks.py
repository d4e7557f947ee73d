"""Networks by distance fields: countries, levels of detail, borders, styles, and the artefacts with their mends."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np
from shapely import LineString

import decalgl as dg

from .sheet import draw, enlarged, panel_size, paper, sheet

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from PIL import Image

Town = tuple[list[LineString], list[str]]

SIDE = 1600.0
ROADS: Mapping[str, Any] = dg.road_styles("germany")
PLAIN = {"low": dg.NetworkStyle(26, "#f4a259", "#33373d"), "high": dg.NetworkStyle(34, "#5b8e7d", "#33373d")}


@functools.cache
def _town() -> Town:
    """A town of its own: a grid that was bent, main roads through it, lanes on the hill."""
    bent = np.random.default_rng(4)
    lines: list[LineString] = []
    classes: list[str] = []

    def add(points: Any, name: str) -> None:
        x, y = np.asarray(points, dtype=np.float64).T
        swing = 40.0 * np.sin(y / 300.0), 50.0 * np.sin(x / 400.0 + 1.0)
        lines.append(LineString(np.column_stack([x + swing[0], y + swing[1]])))
        classes.append(name)

    places = np.arange(200.0, 1401.0, 100.0)
    for number, place in enumerate(places):
        name = "primary" if number == 6 else "secondary" if number in (2, 10) else "residential"
        for across in (False, True):
            if name == "residential":
                cuts = bent.random(len(places) - 1) < 0.8
                for begin, end, kept in zip(places, places[1:], cuts, strict=False):
                    along = np.linspace(begin, end, 6)
                    if kept:
                        add(np.column_stack([(along, np.full(6, place))[:: -1 if across else 1]][0]), name)
                continue
            along = np.arange(0.0, SIDE + 1.0, 20.0)
            add(np.column_stack([(along, np.full(len(along), place))[:: -1 if across else 1]][0]), name)
    around = np.linspace(0.0, 2.0 * np.pi, 90)
    add(np.column_stack([800 + 560 * np.cos(around), 800 + 520 * np.sin(around)]), "motorway")
    for start in bent.uniform(150.0, 1450.0, (30, 2)):
        add(start + np.cumsum(bent.normal(0.0, 22.0, (12, 2)), axis=0), "path")
    return lines, classes


def _town_scene(**options: Any) -> dg.Scene:
    x = np.linspace(0.0, 1.0, 161)
    hills = 70.0 * np.sin(7.0 * x[None, :]) * np.cos(6.0 * x[:, None] + 0.7)
    ground = dg.Terrain(hills.astype(np.float32), 0.0, SIDE, 10.0, 10.0)
    scene = dg.Scene(ground, relief=dg.Relief(color="#e8e2d4"))
    lines, classes = _town()
    scene.add_lines(lines, technique=dg.DistanceField(category=classes, **{"styles": ROADS, **options}))
    return scene


OBLIQUE = dg.Camera.orbit((800.0, 760.0, 0.0), 1150.0, 190.0, 32.0)


def _town_panel(size: tuple[int, int], **options: Any) -> Image.Image:
    return draw(_town_scene(**options), size, OBLIQUE)


def countries() -> Image.Image:
    size = panel_size(1, 220)
    lod = dg.Lod.by_distance(500.0, 2200.0)
    names = ("germany", "france", "britain")
    return sheet({name: _town_panel(size, styles=dg.road_styles(name), lod=lod) for name in names}, 1)


def levels() -> Image.Image:
    size = panel_size(2, 240)
    context = {
        name: [
            (0.0, dg.NetworkStyle(8.0 if name in ("motorway", "primary") else 0.0, "#8b8b8b")),
            (1.0, style.styles[0][1]),
        ]
        for name, style in ROADS.items()
    }
    route = [(800.0, 200.0), (800.0, 800.0), (1300.0, 800.0)]
    panels = {
        "Lod.by_distance(500, 2200)": {"lod": dg.Lod.by_distance(500.0, 2200.0)},
        'Lod.lens(..., space="map")': {"styles": context, "lod": dg.Lod.lens((760.0, 720.0), 260.0, 80.0)},
        'Lod.lens(..., space="screen")': {
            "styles": context,
            "lod": dg.Lod.lens((0.5, 0.5), 0.25, 0.05, space="screen"),
        },
        "Lod.along(route, ...)": {"styles": context, "lod": dg.Lod.along(route, 60.0, 60.0)},
    }
    return sheet({label: _town_panel(size, **options) for label, options in panels.items()}, 2)


def borders() -> Image.Image:
    size = panel_size(3, 190)
    width, height = size
    lines = [
        LineString([(0, 60), (width / 2, 60), (width, 75)]),
        LineString([(width / 2, 60), (width / 2 - 30, height)]),
        LineString([(40, 0), (70, height)]),
    ]

    def panel(name: str) -> Image.Image:
        scene = paper(size)
        options: Any = {"borders": name}
        scene.add_lines(
            lines, technique=dg.DistanceField(category=["high", "low", "low"], styles=PLAIN, **options)
        )
        return draw(scene, size)

    return sheet({f'borders="{name}"': panel(name) for name in ("over", "under", "smooth")}, 3)


def along() -> Image.Image:
    size = panel_size(2, 130)
    width, height = size
    x = np.linspace(25.0, width - 25.0, 80)
    wave = LineString(np.column_stack([x, height / 2 + 34 * np.sin(x / 45.0)]))
    stones = np.zeros((32, 64, 4), dtype=np.uint8)
    column, row = np.meshgrid(np.arange(64), np.arange(32))
    stones[...] = (196, 160, 120, 255)
    stones[(column % 32 < 2) | (row % 16 < 2)] = (90, 70, 50, 255)
    sure = dg.NetworkStyle(30, "#f4a259", "#33373d")
    stony = dg.NetworkStyle(30, "#f4a259", "#33373d", texture_share=1.0)
    categories = {
        "dash=(30, 15)": dg.NetworkCategory(sure, dash=(30, 15), cap="butt"),
        "dash=Pattern.arrows(...)": dg.NetworkCategory(sure, dash=dg.Pattern.arrows(40, 24), cap="butt"),
        "texture=, texture_length=40": dg.NetworkCategory(stony, texture=stones, texture_length=40.0),
        "sketch=(0.4, 9)": dg.NetworkCategory(sure, sketch=(0.4, 9.0)),
    }

    def panel(category: dg.NetworkCategory) -> Image.Image:
        scene = paper(size)
        technique = dg.DistanceField(category=["a"], styles={"a": category}, bits=32, blending="nearest")
        scene.add_lines([wave], technique=technique)
        return draw(scene, size)

    return sheet({label: panel(category) for label, category in categories.items()}, 2)


def artefacts() -> Image.Image:
    size = panel_size(4, 150)
    width = size[0]
    close = [
        LineString([(10, 110), (60, 84), (150, 82), (190, 110)]),
        LineString([(10, 40), (60, 66), (150, 68), (190, 40)]),
    ]
    tee = [
        LineString([(0, 50), (width / 2, 50), (width, 50)]),
        LineString([(width / 2, 50), (width / 2, 140)]),
    ]
    white = {"a": dg.NetworkStyle(30, "white", "#33373d")}
    wide = {"low": dg.NetworkStyle(70, "#f4a259", "#33373d"), "high": dg.NetworkStyle(22, "white", "#33373d")}

    def panel(lines: Any, category: Any, styles: Any, **options: Any) -> Image.Image:
        scene = paper(size)
        scene.add_lines(lines, technique=dg.DistanceField(category=category, styles=styles, **options))
        return draw(scene, size)

    both = ["a", "a"]
    ranks = ["high", "low"]
    return sheet(
        {
            "intrusion": panel(close, both, white),
            "mend_intrusion": panel(close, both, white, mend_intrusion=True, widths_at="vertex"),
            "protrusion": panel(tee, ranks, wide),
            "mend_protrusion": panel(tee, ranks, wide, mend_protrusion=True),
        },
        4,
    )


def fields() -> Image.Image:
    """A wide line seen from near, by what its field is made of; pixels four times as large."""
    size = panel_size(4, 150)
    crossing = [LineString([(-900, -90), (900, 120)]), LineString([(-300, -400), (260, 500)])]
    wide = {"a": dg.NetworkCategory(dg.NetworkStyle(900, "#f4a259", "#33373d", main=0.9))}
    lengths = {"a": dg.NetworkCategory(dg.NetworkStyle(60, "#f4a259"), dash=(30, 30), cap="butt")}

    def panel(lines: Any, styles: Any, scale: float, place: Any, **options: Any) -> Image.Image:
        scene = dg.Scene(dg.Terrain.flat((-1000, -1000, 1000, 1000)), relief=dg.Relief(color="#f6f3ea"))
        technique = dg.DistanceField(category=["a"] * len(lines), styles=styles, **options)
        scene.add_lines(lines, technique=technique)
        half = (scale * size[0] / 2, scale * size[1] / 2)
        bounds = (place[0] - half[0], place[1] - half[1], place[0] + half[0], place[1] + half[1])
        return draw(scene, size, dg.Camera.top_down(bounds))

    def crossed(**options: Any) -> Image.Image:
        return panel(crossing, lengths, 1.2, (20.0, 30.0), **options)

    exact: dict[str, Any] = {"bits": 32, "drop_off": "exact"}

    def near(**options: Any) -> Image.Image:
        whole = panel(crossing[:1], wide, 0.4, (300.0, 456.0), **options)
        left, top = 3 * size[0] // 8, 3 * size[1] // 8
        part = enlarged(whole, (left, top, left + size[0] // 4 + 1, top + size[1] // 4 + 1), 4)
        return part.crop((0, 0, *size))

    return sheet(
        {
            "bits=8, textures": near(),
            "bits=32, exact": near(**exact),
            'lengths, "minimum"': crossed(**exact),
            'lengths, "nearest"': crossed(blending="nearest", **exact),
        },
        4,
    )


PICTURES: dict[str, Callable[[], Image.Image]] = {
    "network_countries.jpg": countries,
    "network_levels.jpg": levels,
    "network_borders.png": borders,
    "network_along.png": along,
    "network_artefacts.png": artefacts,
    "network_fields.png": fields,
}
