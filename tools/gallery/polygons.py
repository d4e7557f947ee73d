"""Polygons: outline modes, outlines wider than the polygon, hatches, draw orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import geopandas as gpd
import numpy as np
from shapely import Point, Polygon, box

import decalgl as dg

from .sheet import BLUE, DARK, GREEN, RED, YELLOW, draw, panel_size, paper, sheet

if TYPE_CHECKING:
    from collections.abc import Callable

    from PIL.Image import Image

MODES: tuple[Literal["normal", "inset", "offset"], ...] = ("normal", "inset", "offset")


def _house(width: int, height: int) -> Polygon:
    """A polygon with a corner that goes in, and a hole."""
    shell = [(0.2, 0.2), (0.8, 0.2), (0.8, 0.55), (0.55, 0.8), (0.45, 0.55), (0.2, 0.75)]
    hole = [(0.42, 0.32), (0.62, 0.32), (0.62, 0.48), (0.46, 0.48)]
    return Polygon(_scaled(shell, width, height), [_scaled(hole, width, height)])


def _scaled(shares: list[tuple[float, float]], width: int, height: int) -> list[tuple[float, float]]:
    return [(x * width, y * height) for x, y in shares]


def outline_modes() -> Image:
    """A narrow outline, and one that is wider than what it runs around."""
    size = panel_size(3, 160)
    panels = {}
    for width in (8, 34):
        for mode in MODES:
            scene = paper(size)
            outline = dg.Outline(
                width=width, width_units="m", color=DARK, alpha=0.55, mode=mode, corner="miter"
            )
            scene.add_polygons([_house(*size)], color=YELLOW, outline=outline)
            panels[f'mode="{mode}", width={width}'] = draw(scene, size)
    return sheet(panels, 3)


def hatches() -> Image:
    """Hatches of neighbours meet, as they lie on the map."""
    size = panel_size(3, 128)
    width, height = size
    parts = [box(10, 10, 0.4 * width, height - 10), box(0.4 * width, 10, width - 10, height - 10)]
    looks: dict[str, Any] = {
        "Hatch(spacing=12, width=4)": dg.Hatch(spacing=12, width=4),
        "crossed=True, and angle=0": [
            dg.Hatch(spacing=14, width=2, crossed=True),
            dg.Hatch(spacing=9, width=3, angle=0),
        ],
        "a hatch over its even fill": dg.Hatch(spacing=10, width=3, angle=120),
    }
    panels = {}
    for number, (label, hatch) in enumerate(looks.items()):
        scene = paper(size)
        if number == 2:
            scene.add_polygons(parts, color=[BLUE, GREEN], alpha=0.35)
        outline = dg.Outline(width=2, width_units="m", color=DARK)
        scene.add_polygons(parts, color=[BLUE, GREEN], hatch=hatch, outline=outline)
        panels[label] = draw(scene, size)
    return sheet(panels, 3)


def outline_orders() -> Image:
    """Outlines over all fills, or each under the next feature; translucent too."""
    size = panel_size(3, 128)
    discs = [Point(size[0] * (0.3 + 0.2 * i), 64 + 14 * (-1) ** i).buffer(44, quad_segs=32) for i in range(3)]
    colors = [BLUE, YELLOW, RED]
    looks: dict[str, Any] = {
        'order="layer"': ("layer", 1.0),
        'order="feature"': ("feature", 1.0),
        'order="feature", alpha=0.5': ("feature", 0.5),
    }
    panels = {}
    for label, (order, alpha) in looks.items():
        scene = paper(size)
        outline = dg.Outline(width=7, width_units="m", color=DARK, alpha=alpha, order=order)
        scene.add_polygons(discs, color=colors, alpha=alpha, outline=outline)
        panels[label] = draw(scene, size)
    return sheet(panels, 3)


def draw_orders() -> Image:
    """Which feature lies over which: by row, by size, by a column."""
    size = panel_size(3, 128)
    middles, radii = [(0.34, 0.5), (0.46, 0.58), (0.58, 0.5), (0.7, 0.58)], (30, 52, 24, 44)
    discs = [
        Point(x * size[0], y * size[1]).buffer(radius, quad_segs=32)
        for (x, y), radius in zip(middles, radii, strict=True)
    ]
    importance = {"geometry": discs, "importance": [4, 1, 2, 3], "color": [BLUE, YELLOW, RED, GREEN]}
    panels = {}
    for order in ("feature", "size", "importance"):
        scene = paper(size)
        outline = dg.Outline(width=3, width_units="m", color=DARK, order="feature")
        data = gpd.GeoDataFrame(importance)
        scene.add_polygons(data, crs=None, color=importance["color"], order=order, outline=outline)
        panels[f'order="{order}"'] = draw(scene, size)
    return sheet(panels, 3)


def styled_outlines() -> Image:
    """Outlines are strokes: corners, dashes and bands, with round holes."""
    size = panel_size(3, 128)
    angles = np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    radii = np.where(np.arange(8) % 2 == 0, 46.0, 30.0)
    middle = np.array(size) / 2.0
    star = middle + radii[:, None] * np.stack([1.6 * np.cos(angles), np.sin(angles)], axis=1)
    shape = Polygon(star).difference(Point(*middle).buffer(14))
    looks: dict[str, dict[str, Any]] = {
        'corner="bevel"': {"corner": "bevel", "color": DARK},
        'mode="inset", dash=(10, 5)': {"mode": "inset", "dash": (10, 5), "color": RED, "corner": "miter"},
        'mode="offset", bands=[...]': {
            "mode": "offset",
            "corner": "miter",
            "bands": [(0.34, "#23415a"), (0.67, "#6d93b3"), (1.0, "#cfdeea")],
        },
    }
    panels = {}
    for label, look in looks.items():
        scene = paper(size)
        scene.add_polygons([shape], color="#dfe6d5", outline=dg.Outline(width=9, width_units="m", **look))
        panels[label] = draw(scene, size)
    return sheet(panels, 3)


PICTURES: dict[str, Callable[[], Image]] = {
    "outline_modes.png": outline_modes,
    "draw_orders.png": draw_orders,
    "outline_orders.png": outline_orders,
    "styled_outlines.png": styled_outlines,
    "hatches.png": hatches,
}
