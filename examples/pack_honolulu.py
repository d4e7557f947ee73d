"""Packs the Honolulu scene: land cover as quantised TopoJSON, terrain as a small GeoTIFF.

    python examples/pack_honolulu.py LANDCOVER DEM --out examples/data/honolulu

LANDCOVER is any file of polygons with a column `material` (GeoParquet or what pyogrio reads) and DEM a
raster, both in EPSG:4326. The land cover is stored once per border, not once per polygon:

    polygons ──snap-round──▶ noded lines ──polygonize──▶ faces ──owner──▶ polygons on a lattice
                              (10^-7 deg)                                       │
                        arcs, delta-coded integers ◀──cut at the nodes──────────┘

Every border between two polygons becomes one arc that both refer to, so that the neighbours share it
exactly and nothing can open between them. Snap rounding (Hobby 1999, as in GEOS) puts all vertices,
also the ones where borders cross or touch, on one integer lattice and leaves no crossing behind.
"""

from __future__ import annotations

import argparse
import gzip
import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import geopandas as gpd
import numpy as np
import rasterio
import shapely
from numpy.typing import NDArray
from rasterio.windows import from_bounds

if TYPE_CHECKING:
    from collections.abc import Iterator

LATTICE_DEGREES = 1e-7  # about 1 cm: finer than the thinnest sliver of the land cover, which is 2 cm wide
FILL_BELOW_SQUARE_METRES = 10.0  # gaps smaller than this are digitising noise and go to a neighbour
METRIC_CRS = "EPSG:32604"  # UTM zone 4 north, for areas only

Vertex = tuple[int, int]
Geometries = NDArray[Any]


@dataclass
class ArcTable:
    """Arcs that are stored once, whatever their direction; a reversed one is referred to as ~index."""

    arcs: list[list[Vertex]] = field(default_factory=list)
    index: dict[tuple[Vertex, ...], int] = field(default_factory=dict)

    def refer(self, vertices: list[Vertex]) -> int:
        """Index of the arc through the vertices, or ~index when it is stored the other way round."""
        key = tuple(vertices)
        if key in self.index:
            return self.index[key]
        if key[::-1] in self.index:
            return ~self.index[key[::-1]]
        self.index[key] = len(self.arcs)
        self.arcs.append(vertices)
        return self.index[key]


def partition(polygons: Geometries) -> Geometries:
    """The polygons as a coverage on the lattice: valid, noded, without overlaps and tiny gaps.

    Where two overlap the smaller one keeps the ground, so that no sliver disappears under its neighbour.
    """
    lines = shapely.union_all(shapely.boundary(polygons), grid_size=LATTICE_DEGREES)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))
    owner = _owners(faces, polygons)
    _fill_small_gaps(faces, owner)
    packed = np.empty(len(polygons), dtype=object)
    for feature in range(len(polygons)):
        members = faces[owner == feature]
        if len(members) == 0:
            raise SystemExit(
                f"polygon {feature} vanished on a lattice of {LATTICE_DEGREES} degrees; refine it"
            )
        packed[feature] = members[0] if len(members) == 1 else shapely.coverage_union_all(members)
    return packed


def _owners(faces: Geometries, polygons: Geometries) -> NDArray[np.int64]:
    """For each face the smallest polygon that holds it, or -1 in a gap."""
    face, polygon = shapely.STRtree(polygons).query(shapely.point_on_surface(faces), predicate="intersects")
    largest_first = np.argsort(-shapely.area(polygons[polygon]), kind="stable")
    owner = np.full(len(faces), -1, dtype=np.int64)
    owner[face[largest_first]] = polygon[largest_first]  # the last one written, the smallest, stays
    return owner


def _fill_small_gaps(faces: Geometries, owner: NDArray[np.int64]) -> None:
    """Gives each small gap to the neighbour with the longest common border, in place."""
    areas = gpd.GeoSeries(faces, crs="EPSG:4326").to_crs(METRIC_CRS).area.to_numpy()
    tree = shapely.STRtree(faces)
    for gap in np.flatnonzero((owner < 0) & (areas < FILL_BELOW_SQUARE_METRES)):
        near = tree.query(faces[gap], predicate="touches")
        near = near[owner[near] >= 0]
        if len(near):
            common = shapely.length(shapely.intersection(shapely.boundary(faces[near]), faces[gap]))
            owner[gap] = owner[near[np.argmax(common)]]


def to_lattice(ring: shapely.LinearRing, origin: tuple[float, float]) -> list[Vertex]:
    """The ring's vertices as integers, the first one not repeated at the end."""
    steps = np.rint((shapely.get_coordinates(ring)[:-1] - origin) / LATTICE_DEGREES).astype(np.int64)
    return [(x, y) for x, y in steps.tolist()]


def find_nodes(rings: list[list[Vertex]]) -> set[Vertex]:
    """Vertices where other than two borders meet: arcs begin and end there."""
    neighbours: dict[Vertex, set[Vertex]] = {}
    for ring in rings:
        for start, end in zip(ring, ring[1:] + ring[:1], strict=True):
            neighbours.setdefault(start, set()).add(end)
            neighbours.setdefault(end, set()).add(start)
    return {vertex for vertex, around in neighbours.items() if len(around) != 2}


def cut_ring(ring: list[Vertex], nodes: set[Vertex]) -> Iterator[list[Vertex]]:
    """The ring cut at the nodes; one without any is a single closed arc from its least vertex."""
    cuts = [i for i, vertex in enumerate(ring) if vertex in nodes]
    first = cuts[0] if cuts else ring.index(min(ring))
    closed = ring[first:] + ring[: first + 1]
    start = 0
    for position in range(1, len(closed)):
        if closed[position] in nodes or position == len(closed) - 1:
            yield closed[start : position + 1]
            start = position


def encode(polygons: Geometries, materials: list[str], origin: tuple[float, float]) -> dict[str, Any]:
    """A TopoJSON topology with one object `landcover`; feature i is polygon i."""
    outlines = [
        [
            [to_lattice(ring, origin) for ring in (part.exterior, *part.interiors)]
            for part in shapely.get_parts(shape)
        ]
        for shape in polygons
    ]
    nodes = find_nodes([ring for parts in outlines for part in parts for ring in part])
    table = ArcTable()
    geometries = []
    for parts, material in zip(outlines, materials, strict=True):
        arcs = [[[table.refer(arc) for arc in cut_ring(ring, nodes)] for ring in part] for part in parts]
        single = len(arcs) == 1
        geometries.append(
            {
                "type": "Polygon" if single else "MultiPolygon",
                "properties": {"material": material},
                "arcs": arcs[0] if single else arcs,
            }
        )
    deltas = [np.diff(np.array(arc), axis=0, prepend=[[0, 0]]).tolist() for arc in table.arcs]
    return {
        "type": "Topology",
        "transform": {"scale": [LATTICE_DEGREES, LATTICE_DEGREES], "translate": list(origin)},
        "objects": {"landcover": {"type": "GeometryCollection", "geometries": geometries}},
        "arcs": deltas,
    }


def decode(topology: dict[str, Any]) -> Geometries:
    """The polygons of a topology, for the check at the end; what any TopoJSON reader does."""
    scale, shift = (np.array(topology["transform"][key]) for key in ("scale", "translate"))
    arcs = [np.cumsum(np.array(arc), axis=0) for arc in topology["arcs"]]

    def ring(references: list[int]) -> NDArray[np.float64]:
        pieces = [arcs[i] if i >= 0 else arcs[~i][::-1] for i in references]
        steps = np.concatenate([pieces[0][:1], *[piece[1:] for piece in pieces]])
        return np.asarray(steps * scale + shift, dtype=np.float64)

    def polygon(rings: list[list[int]]) -> shapely.Polygon:
        return shapely.Polygon(ring(rings[0]), [ring(hole) for hole in rings[1:]])

    shapes = []
    for geometry in topology["objects"]["landcover"]["geometries"]:
        parts = [geometry["arcs"]] if geometry["type"] == "Polygon" else geometry["arcs"]
        made = [polygon(part) for part in parts]
        shapes.append(made[0] if len(made) == 1 else shapely.MultiPolygon(made))
    return np.array(shapes, dtype=object)


def pack_terrain(source: Path, bounds: tuple[float, float, float, float], target: Path) -> None:
    """Cuts the raster to the bounds and writes strips that any TIFF reader takes (deflate, predictor 2).

    The cut also drops the source's lowest row, which is filled with zeros.
    """
    with rasterio.open(source) as raster:
        window = from_bounds(*bounds, transform=raster.transform).round_offsets().round_lengths()
        heights = raster.read(1, window=window)
        profile = {"crs": raster.crs, "transform": raster.window_transform(window)}
    rows, columns = heights.shape
    layout = {"driver": "GTiff", "dtype": "int16", "count": 1, "height": rows, "width": columns}
    packing = {"compress": "deflate", "predictor": 2, "zlevel": 9, "blockysize": rows}
    with rasterio.open(target, "w", **layout, **packing, **profile) as raster:
        raster.write(heights.astype(np.int16), 1)


def report(before: Geometries, after: Geometries, target: Path) -> None:
    """Prints what packing changed: counts, areas, validity, and gaps between neighbours."""
    metric_before, metric_after = (
        gpd.GeoSeries(shapes, crs="EPSG:4326").to_crs(METRIC_CRS).to_numpy() for shapes in (before, after)
    )
    holes_before, holes_after = (
        sum(shapely.get_num_interior_rings(shapely.get_parts(shapes))) for shapes in (before, after)
    )
    changed = shapely.area(shapely.symmetric_difference(metric_before, metric_after))
    print(f"features   {len(before)} -> {len(after)}   holes {holes_before} -> {holes_after}")
    vertices_before, vertices_after = (
        shapely.get_num_coordinates(shapes).sum() for shapes in (before, after)
    )
    print(f"vertices   {vertices_before} -> {vertices_after}")
    print(f"types      {dict(Counter(shapely.get_type_id(after).tolist()))}  (3 polygon, 6 multipolygon)")
    print(f"area       {shapely.area(metric_before).sum():.1f} -> {shapely.area(metric_after).sum():.1f} m2")
    print(f"changed    {changed.sum():.1f} m2 in all, {changed.max():.2f} m2 at most in one feature")
    print(f"valid      {int(shapely.is_valid(after).sum())} of {len(after)}")
    print(
        f"coverage   {'valid' if shapely.coverage_is_valid(after) else 'INVALID'} (no overlap, borders match)"
    )
    print(f"size       {target.stat().st_size} bytes")


def main() -> None:
    parser = argparse.ArgumentParser(description="Pack the Honolulu scene.")
    parser.add_argument("landcover", type=Path, help="polygons with a column `material`, EPSG:4326")
    parser.add_argument("dem", type=Path, help="terrain raster, EPSG:4326")
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "data" / "honolulu")
    arguments = parser.parse_args()
    parquet = arguments.landcover.suffix == ".parquet"
    frame = gpd.read_parquet(arguments.landcover) if parquet else gpd.read_file(arguments.landcover)
    before = frame.geometry.to_numpy()
    xmin, ymin, xmax, ymax = (round(float(edge), 7) for edge in frame.total_bounds)
    topology = encode(partition(before), frame["material"].astype(str).tolist(), (xmin, ymin))
    arguments.out.mkdir(parents=True, exist_ok=True)
    target = arguments.out / "landcover.topojson.gz"
    text = json.dumps(topology, separators=(",", ":")).encode()
    # Without a time stamp the bytes are the same each run.
    target.write_bytes(gzip.compress(text, compresslevel=9, mtime=0))
    report(before, decode(topology), target)
    pack_terrain(arguments.dem, (xmin, ymin, xmax, ymax), arguments.out / "dem.tif")
    print(f"terrain    {(arguments.out / 'dem.tif').stat().st_size} bytes")


if __name__ == "__main__":
    main()
