"""Counts what simplifying by LOOPS does to a map: python -m decalgl.bench.topology FILE ... [--levels 50]

crossings   pairs of edges that meet elsewhere than at a common end, beyond those of the input
openings    edges of an odd number of rings that are not on the map's rim: there, neighbours came apart or overlap

FILE: polygons in any format, or a word: iso-bands for those of San Francisco bay, gshhg for the coasts of the world. The
counts know nothing of how LOOPS works: crossings are found by shapely, and edges are compared by their coordinates.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

import decalgl as dg

from ..features import read_features
from ..loops import ORDERS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    IntArray = NDArray[np.int64]

EVERYTHING = -1.0  # a tolerance
MOST_EDGES_AT_ONCE = 200_000  # queries of shapely hold all their pairs
WIDEST_ZONE = 12.0  # degrees; wider maps are counted in degrees


@dataclass(frozen=True)
class Count:
    """What a level has: edges, crossings beyond the input's, and openings."""

    tolerance: float
    edges: int
    crossings: int
    openings: int


def edges_of(coords: FloatArray, parts: IntArray) -> FloatArray:
    """The edges (n, 4) of rings, each from its lower end, as often as rings have them."""
    sizes = np.diff(parts)
    following = np.arange(1, len(coords) + 1)
    following[parts[1:][sizes > 0] - 1] = parts[:-1][sizes > 0]
    a, b = coords, coords[following]
    swap = (a[:, 0] > b[:, 0]) | ((a[:, 0] == b[:, 0]) & (a[:, 1] > b[:, 1]))
    edges = np.where(swap[:, None], np.column_stack([b, a]), np.column_stack([a, b]))
    drawn: FloatArray = edges[(edges[:, :2] != edges[:, 2:]).any(axis=1)]
    return drawn


def count_crossings(edges: FloatArray) -> int:
    """Pairs of distinct edges that meet anywhere but at a common end."""
    distinct = np.unique(edges, axis=0)
    lines: Any = shapely.linestrings(distinct.reshape(-1, 2, 2))
    tree = shapely.STRtree(lines)
    found = 0
    for begin in range(0, len(lines), MOST_EDGES_AT_ONCE):
        first, second = tree.query(lines[begin : begin + MOST_EDGES_AT_ONCE], predicate="intersects")
        first = first + begin
        first, second = first[first < second], second[first < second]
        common = np.zeros(len(first), dtype=np.bool_)
        for p in (distinct[first, :2], distinct[first, 2:]):
            for q in (distinct[second, :2], distinct[second, 2:]):
                common |= (p == q).all(axis=1)
        along = shapely.length(shapely.intersection(lines[first[common]], lines[second[common]])) > 1e-6
        found += int((~common).sum() + along.sum())
    return found


def odd_edges(edges: FloatArray) -> FloatArray:
    """Those that are there an odd number of times."""
    distinct, counts = np.unique(edges, axis=0, return_counts=True)
    odd: FloatArray = distinct[counts % 2 == 1]
    return odd


def count_openings(edges: FloatArray, rim: FloatArray) -> int:
    """Odd edges with an end that is not on the rim: (n, 2) vertices."""
    ends = odd_edges(edges).reshape(-1, 2)
    everything, places = np.unique(np.concatenate([rim, ends]), axis=0, return_inverse=True)
    on_rim = np.zeros(len(everything), dtype=np.bool_)
    places = places.reshape(-1)
    on_rim[places[: len(rim)]] = True
    return int((~on_rim[places[len(rim) :]].reshape(-1, 2).all(axis=1)).sum())


def counts_of(features: dg.FeatureTable, order: Any, tolerances: list[float]) -> Iterator[Count]:
    """The input as it is on the lattice, then a level for each tolerance."""
    crossings = 0
    rim = np.empty((0, 2))
    all_tolerances = [EVERYTHING, *tolerances]
    simplified = dg.Loops(order=order).simplified(features, all_tolerances)
    for tolerance, (coords, parts, _) in zip(all_tolerances, simplified, strict=True):
        edges = edges_of(coords, parts)
        found = count_crossings(edges)
        if tolerance == EVERYTHING:
            crossings, rim = found, odd_edges(edges).reshape(-1, 2)
        yield Count(tolerance, len(edges), found - crossings, count_openings(edges, rim))


def levels(features: dg.FeatureTable, count: int) -> list[float]:
    """Tolerances from half a thousandth of a percent of the map to all of it."""
    assert features.bounds is not None
    west, south, east, north = features.bounds
    size = max(east - west, north - south)
    return list(np.geomspace(5e-6 * size, size, count))


def _features(name: str, most: int, box: list[float] | None) -> dg.FeatureTable:
    from . import folders, workload

    if name == "iso-bands":
        work = workload.Workload(workload.real_ground(), folders.data(), dict(workload.SIZES), "5M", print)
        arrays = work.contours("iso-bands", "1M")
        rows = np.arange(len(arrays["heights"]))
        table = dg.FeatureTable(
            "polygons", arrays["coordinates"], arrays["part_offsets"], arrays["feature_offsets"], rows
        )
    else:
        import geopandas

        path = workload.coast_file() if name == "gshhg" else Path(name)
        read = geopandas.read_parquet if path.suffix == ".parquet" else geopandas.read_file
        frame = read(path)
        if box is not None:
            frame = frame.cx[box[0] : box[2], box[1] : box[3]]
        west, _, east, _ = frame.total_bounds
        if frame.crs and frame.crs.is_geographic and east - west < WIDEST_ZONE:
            frame = frame.to_crs(frame.estimate_utm_crs())
        bare = frame.geometry.set_crs(None, allow_override=True)
        table = read_features(bare, "polygons", terrain_crs=None, layer_name=path.stem)[0]
    return _last_features(table, most)


def _last_features(table: dg.FeatureTable, most: int) -> dg.FeatureTable:
    """As many whole features as have so many vertices; bands end with peaks, and begin with all of the sea."""
    begins = table.part_offsets[table.feature_offsets]
    first = min(int(np.searchsorted(begins, begins[-1] - most)), len(table.rows) - 1)
    part, vertex = int(table.feature_offsets[first]), int(begins[first])
    return dg.FeatureTable(
        "polygons",
        table.coords[vertex:],
        table.part_offsets[part:] - vertex,
        table.feature_offsets[first:] - part,
        table.rows[first:],
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="decalgl.bench.topology", description=(__doc__ or "").split("\n")[0]
    )
    parser.add_argument("files", nargs="+")
    parser.add_argument("--levels", type=int, default=50)
    parser.add_argument("--orders", nargs="+", default=["douglas_peucker"], choices=ORDERS)
    parser.add_argument("--most", type=int, default=1_000_000, help="vertices, of whole features")
    parser.add_argument("--box", type=float, nargs=4, help="west south east north, in the file's coordinates")
    arguments = parser.parse_args()
    for name in arguments.files:
        features = _features(name, arguments.most, arguments.box)
        for order in arguments.orders:
            started = time.monotonic()
            counts = list(counts_of(features, order, levels(features, arguments.levels)))
            fewest = min(one.edges for one in counts)
            print(
                f"{Path(name).parent.name}/{Path(name).name} {order}: {len(features.coords):,} vertices,"
                f" {counts[0].edges:,} edges, {fewest:,} at last; of {len(counts) - 1} levels"
                f" {sum(one.crossings > 0 for one in counts)} have more crossings"
                f" (at most {max(one.crossings for one in counts)} more), openings at most"
                f" {max(one.openings for one in counts)}; {time.monotonic() - started:.0f} s",
                flush=True,
            )


if __name__ == "__main__":
    main()
