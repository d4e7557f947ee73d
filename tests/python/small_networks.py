"""Small networks by distance fields, for tests."""

from __future__ import annotations

from typing import Any

from shapely import LineString

import decalgl as dg
from small_scenes import flat_scene

WHITE, BLACK, RED, GOLD = (255, 255, 255, 255), (0, 0, 0, 255), (255, 0, 0, 255), (255, 215, 0, 255)
EXACT: dict[str, Any] = {"bits": 32, "drop_off": "exact"}
CROSS = [LineString([(0, 50), (50, 50), (100, 50)]), LineString([(50, 0), (50, 50), (50, 100)])]
LOW_AND_HIGH = {
    "low": dg.NetworkStyle(20, "red", "black", main=0.6),
    "high": dg.NetworkStyle(20, "gold", "black", main=0.6),
}
NEAR_AND_FAR = [(0.0, dg.NetworkStyle(10, "white")), (1.0, dg.NetworkStyle(30, "black"))]


def network(
    lines: Any = CROSS, category: Any = ("low", "high"), styles: Any = None, **options: Any
) -> dg.Scene:
    """Flat ground with a network."""
    scene = flat_scene()
    technique = dg.DistanceField(category=category, styles=styles or LOW_AND_HIGH, **options)
    scene.add_lines(lines, name="roads", technique=technique)
    return scene


def one_line(style: Any, **options: Any) -> dg.Scene:
    """A line from west to east through the middle."""
    return network([CROSS[0]], ["one"], {"one": style}, **options)


def width_at(frame: dg.Frame, x: int) -> int:
    """Pixels of a feature in a column, which are metres."""
    return int((frame.ids[:, x] >= 0).sum())
