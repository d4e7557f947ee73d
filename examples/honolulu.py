"""The Honolulu scene that the examples share: its data, its colours, its isolines and a good place to stand.

Land cover of the city and of the Koʻolau range behind it, and a terrain model of 1 arc-second; origin and
licence are in data/honolulu/README.md.
"""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import TYPE_CHECKING, Any

import contourpy
import geopandas as gpd
import numpy as np
import shapely

if TYPE_CHECKING:
    import decalgl as dg

DATA = Path(__file__).parent / "data" / "honolulu"
DEM = DATA / "dem.tif"
LAND_COVER = DATA / "landcover.topojson.gz"

# Water in blues, growth in greens that darken from grass to forest, dry ground in sand, built-up land in warm
# greys light enough for the roads. Only what one looks for along a line is saturated: streams and freeways.
PALETTE = {
    "Ocean": "#a3c7dc",
    "Lake": "#86b8d6",
    "Stream": "#2f7fb8",
    "Canal": "#2f7fb8",
    "Marsh": "#b3cfb9",
    "Scrub": "#b4c792",
    "MixedForest": "#93b27a",
    "Grassland": "#d5dca6",
    "Grass": "#c8dc9c",
    "GolfCourse": "#bbdb98",
    "Cemetery": "#c5d3ac",
    "MixedCrop": "#e3d99b",
    "Sand": "#f4e5b8",
    "Dirt": "#d9c39a",
    "Gravel": "#d0c5b2",
    "Lava": "#a08e82",
    "Town": "#eee0cb",
    "Urban": "#e6d6c3",
    "Industrial": "#d8c9c8",
    "Airport": "#d9d3dd",
    "Asphalt": "#c4bfc2",
    "Railroad": "#7d7670",
    "Road": "#fffdf7",
    "Freeway": "#e8924a",
}
NETWORK = ("Stream", "Canal", "Railroad", "Road", "Freeway")  # narrow: drawn once more above the isolines
ISOLINE_COLOR = "#7a5a36"
EXAGGERATION = 1.5

# Above Honolulu at 2500 m, looking north-east: the Pali Highway on the left, the ridges of Tantalus in front,
# Mānoa and Pālolo valleys on the right, the crest of the Koʻolau behind. Metres of the terrain's plane.
EYE = (-7000.0, -6500.0, 2500.0)
TARGET = (-1600.0, 900.0, -330.0)
FIELD_OF_VIEW = 38.0


def land_cover() -> gpd.GeoDataFrame:
    """3,582 polygons with a column `material`, EPSG:4326; TopoJSON has no CRS of its own."""
    with gzip.open(LAND_COVER) as stream:
        return gpd.read_file(stream).set_crs("EPSG:4326")


def isolines(terrain: dg.Terrain, step: float) -> gpd.GeoDataFrame:
    """Lines of equal height every `step` metres above the sea, with a column `elevation` (metres)."""
    rows, columns = terrain.shape
    generator = contourpy.contour_generator(
        x=terrain.x0 + terrain.dx * np.arange(columns),
        y=terrain.y0 - terrain.dy * np.arange(rows),
        z=np.ma.masked_invalid(terrain.z),
    )
    top = float(np.nanmax(terrain.z))
    lines, elevations = [], []
    for elevation in np.arange(step, top, step):
        contours: Any = generator.lines(elevation)  # arrays (points, 2)
        found = [shapely.LineString(line) for line in contours if len(line) > 1]
        lines += found
        elevations += [float(elevation)] * len(found)
    return gpd.GeoDataFrame({"elevation": elevations}, geometry=lines, crs=terrain.crs)


def split_isolines(lines: gpd.GeoDataFrame, every: float) -> tuple[gpd.GeoDataFrame, gpd.GeoDataFrame]:
    """(the common ones, the heavier ones every `every` metres)."""
    heavy = lines["elevation"] % every == 0
    return lines[~heavy], lines[heavy]
