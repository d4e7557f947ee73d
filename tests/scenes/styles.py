"""Scenes of styles, by name: `build("corner_angles")` is a view whose layers were made without styling keywords.

    ordinary    every corner, cap, pattern, band, casing, outline and hatch
    hostile     reversals, short segments under wide strokes, outlines wider than their polygons, dashes below a
                pixel, crossing translucent lines, steep ground

They are built once and kept: do not add layers to them.
"""

from __future__ import annotations

import area_styles
import line_styles
from style_views import STYLES, build

__all__ = ["STYLES", "area_styles", "build", "line_styles"]
