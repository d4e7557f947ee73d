"""Strokes: corners and caps, miter limits, patterns, bands, casings, crossings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from shapely import LineString

import decalgl as dg

from .sheet import BLUE, DARK, GREEN, RED, YELLOW, draw, panel_size, paper, sheet

if TYPE_CHECKING:
    from collections.abc import Callable

    from PIL.Image import Image

CORNERS = ("round", "miter", "bevel")
CAPS = ("round", "butt", "square")


def _add(scene: dg.Scene, lines: list[LineString], width: Any, **looks: Any) -> dg.Layer:
    return scene.add_lines(lines, width=width, width_units="m", **looks)


def _hook(width: int, height: int) -> LineString:
    """A line with a sharp turn, a blunt one and two ends."""
    shares = [(0.12, 0.25), (0.42, 0.75), (0.5, 0.25), (0.72, 0.25), (0.86, 0.72)]
    return LineString([(x * width, y * height) for x, y in shares])


def corners() -> Image:
    """Every corner with every cap; a thin line shows the vertices' places."""
    size = panel_size(3, 128)
    panels = {}
    for corner in CORNERS:
        for cap in CAPS:
            scene = paper(size)
            _add(scene, [_hook(*size)], 26, color=BLUE, alpha=0.6, corner=corner, cap=cap)
            _add(scene, [_hook(*size)], 1, color="white", cap="butt")
            panels[f'corner="{corner}", cap="{cap}"'] = draw(scene, size)
    return sheet(panels, 3)


def miter_limits() -> Image:
    """Corners of 18, 35, 60 and 110 degrees with three limits."""
    size = panel_size(3, 96)
    openings = (18.0, 35.0, 60.0, 110.0)
    lines = []
    for number, opening in enumerate(openings):
        x, y, half = size[0] * (number + 0.5) / len(openings), 0.55 * size[1], np.radians(opening) / 2
        arm = 30.0 * np.array([np.sin(half), -np.cos(half)])
        lines.append(LineString([(x - arm[0], y + arm[1]), (x, y), (x + arm[0], y + arm[1])]))
    panels = {}
    for limit in (10, 40, 100):
        scene = paper(size)
        _add(scene, lines, 8, color=RED, corner="miter", cap="butt", miter_limit=limit)
        panels[f"miter_limit={limit}"] = draw(scene, size)
    return sheet(panels, 3)


def dashes() -> Image:
    """Named dashes, lengths, arrows, stipples and tapered marks along the same wave."""
    size = panel_size(2, 52)
    x = np.linspace(16.0, size[0] - 16.0, 60)
    wave = LineString(np.stack([x, 26.0 + 9.0 * np.sin(x / 34.0)], axis=1))
    patterns = {
        'dash="dashed"': "dashed",
        'dash="dotted"': "dotted",
        'dash="dashdot"': "dashdot",
        "dash=(24, 8, 4, 8)": (24, 8, 4, 8),
        "Pattern.arrows(every=40, length=16)": dg.Pattern.arrows(every=40, length=16),
        "Pattern.arrows(every=48, length=18, shaft=0.25)": dg.Pattern.arrows(every=48, length=18, shaft=0.25),
        'Pattern.stipple("1110010", step=5)': dg.Pattern.stipple("1110010", step=5),
        "Pattern(30, [(0, 15, 0.1, 1), (15, 30, 1, 0.1)])": dg.Pattern(
            30, [(0, 15, 0.1, 1), (15, 30, 1, 0.1)]
        ),
    }
    panels = {}
    for number, (label, dash) in enumerate(patterns.items()):
        scene = paper(size)
        width = 7 if number < 4 else 13
        _add(
            scene,
            [wave],
            width,
            color=(BLUE, RED, GREEN, DARK)[number % 4],
            corner="miter",
            cap="butt",
            dash=dash,
        )
        panels[label] = draw(scene, size)
    return sheet(panels, 2)


def bands() -> Image:
    """Colours across lines, around corners and along arrows."""
    size = panel_size(3, 128)
    road = [(0.12, "white"), (0.75, DARK), (1.0, YELLOW)]
    glow = [(0.2, "#08306b"), (0.45, "#2171b5"), (0.7, "#6baed6"), (1.0, "#c6dbef")]
    looks: dict[str, dict[str, Any]] = {
        'corner="miter", cap="butt"': {"bands": road, "corner": "miter", "cap": "butt"},
        "round": {"bands": glow},
        "along arrows": {
            "bands": [(0.3, YELLOW), (1.0, RED)],
            "corner": "miter",
            "cap": "butt",
            "dash": dg.Pattern.arrows(every=62, length=34, shaft=0.5),
        },
    }
    panels = {}
    for label, look in looks.items():
        scene = paper(size)
        _add(scene, [_hook(*size)], 28, **look)
        panels[label] = draw(scene, size)
    return sheet(panels, 3)


def casings() -> Image:
    """Roads that join, a railway, and casings that shine through."""
    size = panel_size(3, 128)
    width, height = size
    across = LineString(
        [(0.05 * width, 0.3 * height), (0.5 * width, 0.45 * height), (0.95 * width, 0.3 * height)]
    )
    down = LineString(
        [(0.3 * width, 0.92 * height), (0.5 * width, 0.45 * height), (0.62 * width, 0.06 * height)]
    )
    roads = [across, down]
    looks: dict[str, dict[str, Any]] = {
        "casing=Casing(width=3)": {"color": [YELLOW, "white"], "casing": dg.Casing(width=3)},
        "white dashes on a black casing": {
            "color": "white",
            "cap": "butt",
            "dash": (14, 14),
            "casing": dg.Casing(width=3),
        },
        "translucent, over a dashed casing": {
            "color": RED,
            "alpha": 0.5,
            "corner": "miter",
            "cap": "butt",
            "casing": dg.Casing(width=7, color=DARK, dash=(4, 4)),
        },
    }
    panels = {}
    for label, look in looks.items():
        scene = paper(size)
        _add(scene, roads, 14, **look)
        panels[label] = draw(scene, size)
    return sheet(panels, 3)


def crossings() -> Image:
    """Translucent lines that cross themselves and each other."""
    size = panel_size(3, 160)
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    middle = np.array(size) / 2.0
    rose = middle + np.stack([115.0 * np.sin(2.0 * turn), 62.0 * np.sin(3.0 * turn)], axis=1)
    angles = 2.0 * np.pi * np.arange(8) * 3 / 7 + np.pi / 2
    star = middle + 46.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    star[-1] = star[0]  # to the last bit: a closed line
    pointed = {"corner": "miter", "miter_limit": 10}
    shapes: dict[str, tuple[list[LineString], dict[str, Any]]] = {
        "one line, alpha=0.5": ([LineString(rose)], {"color": BLUE}),
        'a star, corner="miter"': ([LineString(star)], {"color": GREEN, **pointed}),
        "two lines": ([LineString(rose), LineString(star)], {"color": [BLUE, RED], **pointed}),
    }
    panels = {}
    for label, (lines, looks) in shapes.items():
        scene = paper(size)
        _add(scene, lines, 12, alpha=0.5, **looks)
        panels[label] = draw(scene, size)
    return sheet(panels, 3)


PICTURES: dict[str, Callable[[], Image]] = {
    "corners.png": corners,
    "miter_limits.png": miter_limits,
    "dashes.png": dashes,
    "bands.png": bands,
    "casings.png": casings,
    "crossings.png": crossings,
}
