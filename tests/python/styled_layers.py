"""Layers of a few lines or squares, for tests of what styling keywords make of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import geopandas
from shapely import LineString, box

from small_scenes import DIAGONAL, flat_scene

if TYPE_CHECKING:
    import decalgl as dg


def frame(count: int = 4, **columns: Any) -> geopandas.GeoDataFrame:
    """Lines one above the other."""
    return geopandas.GeoDataFrame(columns, geometry=[LineString([(0, y), (90, y)]) for y in range(count)])


def lines(data: Any = None, **options: Any) -> dg.Layer:
    """A layer of lines in metres, called "roads"."""
    data = [DIAGONAL] if data is None else data
    return flat_scene().add_lines(data, name="roads", **{"width": 4.0, "width_units": "m", **options})


def polygons(count: int = 1, **options: Any) -> dg.Layer:
    """A layer of squares, called "parks"."""
    squares = [box(10 * i, 0, 10 * i + 5, 5) for i in range(count)]
    return flat_scene().add_polygons(squares, name="parks", **options)
