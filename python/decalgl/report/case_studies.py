"""Eight maps in the character of Zechmeister 2020, section 5.1, in steps of size, from data that registries carry.

    isolines      bands of height: few areas, many holes                 derived
    urban         OpenStreetMap of a town                                Helsinki
    rural         land cover, streams and roads of a mountain range      Honolulu
    sewers        dense catchments in many colours                       derived
    rivers        rivers and lakes of a country                          derived
    buildings     a large city with a colour for each building           Helsinki, side by side
    floods        jagged areas with very many holes                      derived
    catchments    river catchments with outlines: the most vertices of   derived
                  what is not copied

What is derived comes from real terrain models (derive.py): without a network from matplotlib's sample of the Jacksboro
fault in Tennessee (SRTM, 3 arc-seconds), else from San Francisco bay (SRTM, 1 arc-second). No registry carries a town
together with a terrain model that fits, so a part of the bay lies under the towns, at their size and with its slopes.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

import decalgl as dg

from ..bench import fetch, folders
from ..errors import DecalError, FileError
from ..road_styles import CLASSES, COLORS, road_classes
from . import derive

if TYPE_CHECKING:
    from collections.abc import Callable

    import geopandas as gpd

    from .part import Context, Row, Size, Step

# Samples along a side of what is cut out of the terrain model, and of the town, how many copies along a side.
WINDOWS: dict[Step, int] = {"tiny": 60, "offline": 300, "small": 800, "medium": 1800, "large": 3500}
COPIES: dict[Step, int] = {"tiny": 1, "offline": 1, "small": 2, "medium": 8, "large": 24}
OFFLINE: tuple[Step, ...] = ("tiny", "offline")
LINES = np.linspace(0.02, 0.98, 17)  # shares of the height range at which isolines run
PUDDLE = 20  # vertices: areas with a shorter border are none that flood maps show
GROUND = "#ece8df"
PIXELS = 2.0  # the width of lines where it is one on the screen


@dataclass(frozen=True)
class Part:
    """A layer to be: its data and the keywords of `Scene.add_polygons` or `add_lines`."""

    kind: Literal["polygons", "lines"]
    data: Any
    looks: dict[str, Any] = field(default_factory=dict)

    def add(self, scene: dg.Scene, technique: str | dg.Technique, pixels: bool) -> dg.Layer:
        """Adds the layer. pixels: lines and outlines as wide as on the screen."""
        looks = dict(self.looks)
        if pixels and self.kind == "lines":
            looks.update(width=PIXELS, width_units="px")
        if pixels and "outline" in looks:
            looks["outline"] = replace(looks["outline"], width=PIXELS, width_units="px")
        adding = scene.add_lines if self.kind == "lines" else scene.add_polygons
        return adding(self.data, technique=technique, **looks)


@dataclass(frozen=True, eq=False)
class Map:
    """A terrain and the layers over it, for any technique."""

    name: str
    ground: dg.Terrain
    parts: tuple[Part, ...]

    @property
    def has_lines(self) -> bool:
        """Whether a layer is of lines, beside outlines."""
        return any(part.kind == "lines" for part in self.parts)

    def scene(
        self,
        polygons: str | dg.Technique = "static",
        lines: str | dg.Technique = "static",
        pixels: bool = False,
        relief: dg.Relief | None = None,
    ) -> dg.Scene:
        """The scene, its polygons and lines drawn by these techniques."""
        scene = dg.Scene(self.ground, relief=relief or dg.Relief(color=GROUND, on_layers=0.4))
        for part in self.parts:
            part.add(scene, lines if part.kind == "lines" else polygons, pixels)
        return scene


@dataclass(frozen=True)
class CaseStudy:
    """A map that can be made in steps of size.

    like: the case study of the thesis in whose character it is. source: where its data comes from.
    """

    like: str
    source: str
    make: Callable[[Step], tuple[dg.Terrain, list[Part]]]


def vertices(scene: dg.Scene) -> int:
    """As the thesis counts them: outlines are lines too, and their vertices count once more."""
    outlined = [layer.kind == "polygons" and layer.stroke is not None for layer in scene.layers]
    return sum(
        len(layer.features.coords) * (1 + twice) for layer, twice in zip(scene.layers, outlined, strict=True)
    )


def build(name: str, step: Step) -> Map:
    """The map of that name. Raises DecalError where its data cannot be had."""
    ground, parts = CASE_STUDIES[name].make(step)
    return Map(name, ground, tuple(parts))


@functools.lru_cache(maxsize=1)
def relief_of(step: Step) -> dg.Terrain:
    """The terrain that vector data is derived from: hills of Tennessee, or the mountains beside San Francisco bay."""
    side = WINDOWS[step]
    whole = _jacksboro() if step in OFFLINE else _bay()
    rows, columns = whole.shape
    # The Santa Cruz Mountains are in the middle of what is cut out, as far as there is room.
    middle = (rows // 2, columns // 2) if step in OFFLINE else (2850, 3060)
    top, left = (
        max(0, min(at - side // 2, count - side)) for at, count in zip(middle, whole.shape, strict=True)
    )
    z = whole.z[top : top + side, left : left + side]
    return dg.Terrain(z, whole.x0 + left * whole.dx, whole.y0 - top * whole.dy, whole.dx, whole.dy, whole.crs)


@functools.cache
def _jacksboro() -> dg.Terrain:
    from affine import Affine
    from matplotlib.cbook import get_sample_data

    opened: Any = get_sample_data("jacksboro_fault_dem.npz")
    with opened as stored:
        z = np.asarray(stored["elevation"], np.float32)
        step, west = float(stored["dx"]), float(stored["xmin"])
        north = max(float(stored["ymin"]), float(stored["ymax"]))
    warped = dg.Terrain.from_array(z, Affine(step, 0, west, 0, -step, north), crs="EPSG:4326")
    return _trimmed(warped, 16)


@functools.cache
def _bay() -> dg.Terrain:
    (path,) = fetch.fetch("sf", folders.data())
    return dg.Terrain.open(path)


def _trimmed(ground: dg.Terrain, rim: int) -> dg.Terrain:
    """Without its outermost samples, where warping leaves holes."""
    z = ground.z[rim:-rim, rim:-rim]
    return dg.Terrain(
        z, ground.x0 + rim * ground.dx, ground.y0 - rim * ground.dy, ground.dx, ground.dy, ground.crs
    )


def _isolines(step: Step) -> tuple[dg.Terrain, list[Part]]:
    """Bands of height of which only pieces with two holes or more are kept."""
    ground = relief_of(step)
    edges = np.linspace(float(np.nanmin(ground.z)), float(np.nanmax(ground.z)) + 1.0, 7) + 0.37
    table, _ = derive.bands(ground, itertools.pairwise(edges.tolist()))
    table = derive.chosen(table, np.diff(table.feature_offsets) > 2)
    outline = dg.Outline(width=0.5 * ground.dx, width_units="m", color="black")
    return ground, [Part("polygons", table, {"color": "#7fb2dd", "outline": outline})]


def _floods(step: Step) -> tuple[dg.Terrain, list[Part]]:
    """What lies lower than the ground around it, in three slices with a colour each: more holes than areas."""
    ground = relief_of(step)
    low = derive.above_surroundings(ground, samples=10)
    edges = np.nanquantile(low.z, (0.0, 0.12, 0.24, 0.36))
    table, heights = derive.bands(low, itertools.pairwise(edges.tolist()))
    is_shown = np.diff(table.part_offsets)[table.feature_offsets[:-1]] >= PUDDLE
    table, heights = derive.chosen(table, is_shown), heights[is_shown]
    colors = np.array(["#d7302c", "#ef8a2c", "#f2d544"])[np.searchsorted(edges[1:], heights)]
    span = float(np.nanmax(ground.z) - np.nanmin(ground.z))
    lines = derive.contour_lines(ground, [float(np.nanmin(ground.z)) + span * share for share in LINES])
    looks = {"color": "#7a5a36", "width": 0.3 * ground.dx, "width_units": "m"}
    return ground, [Part("polygons", table, {"color": list(colors)}), Part("lines", lines, looks)]


def _sewers(step: Step) -> tuple[dg.Terrain, list[Part]]:
    ground = relief_of(step)
    table, _ = derive.catchments(ground, 150)
    tint = (np.arange(len(table)) * 7) % 20
    outline = dg.Outline(width=0.3 * ground.dx, width_units="m", color="#5a1040")
    lines, through = derive.drainage(ground, 60)
    polygons = {"column": tint, "cmap": "RdPu", "alpha": 0.8, "outline": outline}
    return ground, [Part("polygons", table, polygons), Part("lines", lines, _river_looks(ground, through))]


def _rivers(step: Step) -> tuple[dg.Terrain, list[Part]]:
    ground = relief_of(step)
    lakes = derive.lakes(ground)
    lines, through = derive.drainage(ground, 25)
    looks = _river_looks(ground, through)
    return ground, [Part("polygons", lakes, {"color": "#8fbfe0"}), Part("lines", lines, looks)]


def _catchments(step: Step) -> tuple[dg.Terrain, list[Part]]:
    ground = relief_of(step)
    table, areas = derive.catchments(ground, 20)
    outline = dg.Outline(width=0.25 * ground.dx, width_units="m", color="white")
    looks = {"column": np.sqrt(areas), "cmap": "Blues", "outline": outline}
    return ground, [Part("polygons", table, looks)]


def _river_looks(ground: dg.Terrain, through: derive.FloatArray) -> dict[str, Any]:
    """Wider where more water comes through, in four steps."""
    rank = np.clip(np.log10(np.maximum(through, 1.0)) - 1.0, 0.0, 3.0).astype(int)
    return {"color": "#2a6fb0", "width": ground.dx * np.array([0.3, 0.5, 0.9, 1.5])[rank], "width_units": "m"}


def _town_map(step: Step, by_area: bool) -> tuple[dg.Terrain, list[Part]]:
    """Helsinki side by side. by_area: buildings are coloured by it, and there are more copies."""
    count = COPIES[step] * (2 if by_area else 1)
    areas, roads = _town()
    xmin, ymin, xmax, ymax = roads.total_bounds
    steps = np.stack(np.meshgrid(np.arange(count) * (xmax - xmin), np.arange(count) * (ymax - ymin)), -1)
    steps = steps.reshape(-1, 2).astype(np.float64)
    ground = _borrowed((xmin, ymin, xmin + count * (xmax - xmin), ymin + count * (ymax - ymin)))
    parts = []
    land = areas[areas["building"].isna()]
    parts.append(_copies("polygons", land, steps, color=["#b9d6a3"] * len(land)))
    houses = areas[areas["building"].notna()]
    if by_area:
        looks = {"column": np.tile(np.log10(houses.area.to_numpy() + 1.0), len(steps)), "cmap": "turbo"}
        parts.append(Part("polygons", _table("polygons", houses, steps), looks))
    else:
        parts.append(_copies("polygons", houses, steps, color=["#c9b8a8"] * len(houses)))
    kinds = roads["class"].to_list()
    widths = [CLASSES[kind][0] for kind in kinds]
    colors = [COLORS["france"][kind][1] for kind in kinds]
    parts.append(_copies("lines", roads, steps, color=colors, width=widths, width_units="m"))
    return ground, parts


def _copies(kind: Any, frame: gpd.GeoDataFrame, steps: derive.FloatArray, **looks: Any) -> Part:
    each = {name: value * len(steps) if isinstance(value, list) else value for name, value in looks.items()}
    return Part(kind, _table(kind, frame, steps), each)


def _table(kind: Any, frame: gpd.GeoDataFrame, steps: derive.FloatArray) -> dg.FeatureTable:
    import shapely

    if kind == "lines":
        features = [[shapely.get_coordinates(line)] for line in frame.geometry]
    else:
        features = [
            [
                np.asarray(ring.coords)
                for polygon in _polygons(one)
                for ring in (polygon.exterior, *polygon.interiors)
            ]
            for one in frame.geometry
        ]
    return derive.repeated(derive.table(kind, features), steps)


def _polygons(geometry: Any) -> list[Any]:
    return list(getattr(geometry, "geoms", [geometry]))


@functools.cache
def _town() -> tuple[gpd.GeoDataFrame, gpd.GeoDataFrame]:
    """(land use and buildings, roads with their class) of Helsinki, in metres."""
    import warnings

    import pyogrio

    (path,) = fetch.fetch("helsinki", folders.data())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # rings that the extract's border cut open
        areas = pyogrio.read_dataframe(path, layer="multipolygons", on_invalid="ignore")
        roads = pyogrio.read_dataframe(path, layer="lines", columns=["highway"])
    roads["class"] = road_classes(roads["highway"])
    roads = roads[roads["class"].notna()]
    plane = roads.estimate_utm_crs()
    areas = areas[areas.geometry.notna()].to_crs(plane)
    areas = areas[areas.geometry.is_valid & ~areas.geometry.is_empty]
    kept = areas["building"].notna() | areas["leisure"].notna() | areas["natural"].notna()
    return areas[kept], roads.to_crs(plane)


def _borrowed(bounds: tuple[float, float, float, float]) -> dg.Terrain:
    """A part of the bay's hills at the size of the bounds, as high as keeps its slopes."""
    samples = 512
    hills = relief_of("small").z[:samples, :samples]
    xmin, ymin, xmax, ymax = bounds
    dx, dy = (xmax - xmin) / (samples - 1), (ymax - ymin) / (samples - 1)
    flatter = min(1.0, dx / 24.6)
    return dg.Terrain((hills * flatter).astype(np.float32), xmin, ymax, dx, dy)


def _rural(step: Step) -> tuple[dg.Terrain, list[Part]]:
    """One size only: the land cover that lies in a checkout beside the examples."""
    import gzip

    import geopandas as gpd

    root = folders.checkout()
    folder = root / "examples" / "data" / "honolulu" if root is not None else None
    if folder is None or not folder.is_dir():
        raise FileError("The land cover of Honolulu lies in a checkout, not in an installed package.")
    ground = dg.Terrain.open(folder / "dem.tif")
    with gzip.open(folder / "landcover.topojson.gz") as stream:
        cover = gpd.read_file(stream).set_crs("EPSG:4326")
    cover = cover[cover["material"] != "Ocean"]
    narrow = cover["material"].isin(["Stream", "Canal", "Railroad", "Road", "Freeway"])
    ground = _window(ground, 160) if step == "tiny" else ground
    areas = {"column": "material", "cmap": "YlGn", "categorical": True}
    borders = cover[narrow].copy()
    borders["geometry"] = borders.geometry.boundary
    kinds = {
        "Stream": "#2f7fb8",
        "Canal": "#2f7fb8",
        "Railroad": "#4d4742",
        "Road": "#8a5a44",
        "Freeway": "#d0501e",
    }
    lines = {"color": [kinds[kind] for kind in borders["material"]], "width": 8.0, "width_units": "m"}
    return ground, [Part("polygons", cover[~narrow], areas), Part("lines", borders, lines)]


def _window(ground: dg.Terrain, side: int) -> dg.Terrain:
    top, left = (max(0, (count - side) // 2) for count in ground.shape)
    z = ground.z[top : top + side, left : left + side]
    return dg.Terrain(
        z, ground.x0 + left * ground.dx, ground.y0 - top * ground.dy, ground.dx, ground.dy, ground.crs
    )


CASE_STUDIES = {
    "isolines": CaseStudy("HORA IL", "derived: bands of height, pieces with holes", _isolines),
    "urban": CaseStudy("Cologne OSM", "OpenStreetMap: Helsinki", lambda step: _town_map(step, by_area=False)),
    "rural": CaseStudy("Wachau", "FlightGear's land cover: Honolulu", _rural),
    "sewers": CaseStudy("Graz SC", "derived: catchments of 150 samples, drainage lines", _sewers),
    "rivers": CaseStudy("HORA RLL", "derived: drainage lines of 25 samples, level ground as water", _rivers),
    "buildings": CaseStudy(
        "Cologne SA", "OpenStreetMap: Helsinki side by side", lambda step: _town_map(step, by_area=True)
    ),
    "floods": CaseStudy("HORA FA", "derived: what lies lower than the ground around it", _floods),
    "catchments": CaseStudy("HORA RC", "derived: catchments of 20 samples", _catchments),
}
# What a report of each size is made of.
SCENES: dict[Size, tuple[str, ...]] = {
    "tiny": ("floods",),
    "quick": ("floods", "rural"),
    "full": tuple(CASE_STUDIES),
}


def rows_of_maps(context: Context, part: str, measure: Callable[[Map], list[Row]]) -> list[Row]:
    """What a part measures of each map of the report, kept map by map; one whose data cannot be had is a row too."""
    found: list[Row] = []
    for name in SCENES[context.size]:
        try:
            drawn = build(name, context.step)
        except DecalError as error:
            found.append({"scene": name, "refused": str(error)})
            continue
        context.say(f"{part}: {name}")
        found += context.kept(f"{part}_{name}", functools.partial(measure, drawn))
    return found
