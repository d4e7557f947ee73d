"""Vector data for the tests of reading it: a few parks, and their tables taken apart and compared."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import geopandas
import numpy as np
import pyproj
from shapely import MultiPolygon, Polygon, box

from decalgl.features import read_features

if TYPE_CHECKING:
    from decalgl.features import FeatureTable

DONUT = Polygon(box(0, 0, 10, 10).exterior, [box(2, 2, 4, 4).exterior, box(5, 5, 9, 9).exterior])
SHAPES = [DONUT, MultiPolygon([box(20, 0, 21, 1), DONUT]), box(30, 0, 40, 5)]
UTM = pyproj.CRS("EPSG:32604")


def parks() -> geopandas.GeoDataFrame:
    """The shapes as a frame with a column of texts and one of numbers."""
    return geopandas.GeoDataFrame({"kind": ["a", "b", "c"], "size": [1, 2, 3]}, geometry=SHAPES, crs=UTM)


def read(data: Any, kind: Any = "polygons", crs: Any = None, own: Any = None, **options: Any) -> FeatureTable:
    """The table of `data`; crs: the terrain's, own: the argument crs=."""
    return read_features(data, kind, terrain_crs=crs, layer_name="parks", crs=own, **options)[0]


def parts_of(table: FeatureTable) -> list[Any]:
    """For each feature the list of its parts, each a list of points."""
    points = np.split(table.coords, table.part_offsets[1:-1]) if len(table.part_offsets) > 1 else []
    ends = zip(table.feature_offsets[:-1], table.feature_offsets[1:], strict=True)
    return [[part.tolist() for part in points[start:end]] for start, end in ends]


def assert_same(first: FeatureTable, second: FeatureTable) -> None:
    """Both hold the same arrays."""
    assert first.kind == second.kind
    for name in ("coords", "part_offsets", "feature_offsets", "rows"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))
