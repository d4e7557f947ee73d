"""Features as flat arrays: from shapely and __geo_interface__, cleaned, without a loop over vertices.

coords          x y x y x y x y x y ...      every point of the layer
part_offsets    |0      |3        |7 ...     a part is a ring or a polyline
feature_offsets |0                |2 ...     a feature is one or more parts
rows            |0                |4 ...     the feature's row in the user's data (skipped ones leave gaps)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from ._nesting import DEEPEST_COORDINATES, coordinates_depth, unsupported_type
from .errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

TYPE_NAMES = (
    "Point", "LineString", "LinearRing", "Polygon", "MultiPoint", "MultiLineString", "MultiPolygon",
    "GeometryCollection",
)  # fmt: skip
ALLOWED = {"polygons": (3, 6), "lines": (1, 2, 5)}
COORDINATE_DEPTH = {1: 2, 2: 2, 3: 3, 5: 3, 6: 4}


@dataclass(frozen=True)
class Ragged:
    """Flat arrays of features; `exterior` tells outer rings from holes where that is known."""

    coords: NDArray[np.float64]
    part_offsets: NDArray[np.int64]
    feature_offsets: NDArray[np.int64]
    rows: NDArray[np.int64]
    exterior: NDArray[np.bool_] | None = None

    def row_of_point(self, point: int) -> int:
        """The user's row of the feature that coordinate number `point` belongs to."""
        part = int(np.searchsorted(self.part_offsets, point, side="right")) - 1
        feature = int(np.searchsorted(self.feature_offsets, part, side="right")) - 1
        return int(self.rows[feature])


def offsets_of(counts: NDArray[np.integer[Any]]) -> NDArray[np.int64]:
    """Offsets (n + 1) of runs with the given lengths (n)."""
    offsets = np.zeros(len(counts) + 1, dtype=np.int64)
    np.cumsum(counts, out=offsets[1:])
    return offsets


def check_types(types: NDArray[np.integer[Any]], kind: str, layer_name: str) -> None:
    """Raise InputError at the first type (shapely's numbers, -1 for none) that `kind` does not draw."""
    wrong = ~np.isin(types, (-1, *ALLOWED[kind]))
    if not wrong.any():
        return
    row = int(np.flatnonzero(wrong)[0])
    name = TYPE_NAMES[int(types[row])]
    if name == "GeometryCollection":
        raise InputError(unsupported_type(layer_name, row, name))
    wanted = "['Polygon', 'MultiPolygon']" if kind == "polygons" else "['LineString', 'MultiLineString']"
    if kind == "polygons" and name in ("LineString", "LinearRing", "MultiLineString"):
        other = "Draw lines with add_lines, or keep"
    elif kind == "lines" and name in ("Polygon", "MultiPolygon"):
        other = "Draw polygons with add_polygons, draw their borders as lines with gdf.boundary, or keep"
    else:
        other = "Give points an extent with gdf.buffer(metres) and draw them as polygons, or keep"
    raise InputError(
        f"Layer {layer_name!r} holds {int(wrong.sum())} geometries that are no {kind}, the first a {name} at"
        f" row {row}. {other} the {kind} only: gdf[gdf.geom_type.isin({wanted})]."
    )


def from_shapely(shapes: NDArray[Any], kind: str, layer_name: str) -> tuple[Ragged, int, int]:
    """The arrays of shapely geometries (n,), and how many were null and how many empty."""
    import shapely

    types = shapely.get_type_id(shapes)
    # Asking a deep collection whether it is empty recurses; having no members does not.
    bare_collection = (types == 7) & (shapely.get_num_geometries(shapes) == 0)
    plain = types != 7
    empty = bare_collection.copy()
    empty[plain] = shapely.is_empty(shapes[plain])
    check_types(np.where(empty, -1, types), kind, layer_name)
    null = types == -1
    rows = np.flatnonzero(~null & ~empty).astype(np.int64)
    parts, feature_of_part = shapely.get_parts(shapes[rows], return_index=True)
    exterior = None
    if kind == "polygons":
        parts, polygon_of_ring = shapely.get_rings(parts, return_index=True)
        feature_of_part = feature_of_part[polygon_of_ring]
        exterior = np.ones(len(parts), dtype=np.bool_)
        exterior[1:] = polygon_of_ring[1:] != polygon_of_ring[:-1]
    ragged = Ragged(
        shapely.get_coordinates(parts),
        offsets_of(shapely.get_num_coordinates(parts)),
        offsets_of(np.bincount(feature_of_part, minlength=len(rows))),
        rows,
        exterior,
    )
    return ragged, int(null.sum()), int(empty.sum())


def from_interfaces(geometries: Sequence[Any], kind: str, layer_name: str) -> tuple[Ragged, int, int]:
    """The arrays of GeoJSON-like geometries (dicts or None), and how many were null and how many empty."""
    types = np.array(
        [_type_of(geometry, row, layer_name) for row, geometry in enumerate(geometries)], dtype=np.int64
    )
    null = types == -1
    coordinates = [None if geometry is None else geometry.get("coordinates", ()) for geometry in geometries]
    empty = np.array([value is not None and len(value) == 0 for value in coordinates], dtype=np.bool_)
    bare = (types == 7) & np.array(
        [not (geometry or {}).get("geometries") for geometry in geometries], dtype=np.bool_
    )
    empty = (empty & (types != 7)) | bare
    check_types(np.where(empty, -1, types), kind, layer_name)
    rows = np.flatnonzero(~null & ~empty).astype(np.int64)
    parts: list[Any] = []
    part_counts: list[int] = []
    exterior: list[bool] = []
    for row in rows.tolist():
        value, type_number = coordinates[row], int(types[row])
        _check_depth(value, type_number, row, layer_name)
        polygons = {1: [[value]], 2: [[value]], 3: [value], 5: [value]}.get(type_number, value)
        rings = list(chain.from_iterable(polygons))
        exterior.extend(
            chain.from_iterable([True] + [False] * (len(rings) - 1) for rings in polygons if len(rings))
        )
        parts.extend(rings)
        part_counts.append(len(rings))
    coords = _points_of(parts, np.repeat(rows, part_counts), layer_name)
    ragged = Ragged(
        coords,
        offsets_of(np.array([len(part) for part in parts], dtype=np.int64)),
        offsets_of(np.array(part_counts, dtype=np.int64)),
        rows,
        np.array(exterior, dtype=np.bool_) if kind == "polygons" else None,
    )
    return ragged, int(null.sum()), int(empty.sum())


def _type_of(geometry: Any, row: int, layer_name: str) -> int:
    if geometry is None:
        return -1
    name = geometry.get("type") if isinstance(geometry, dict) else None
    if name not in TYPE_NAMES:
        raise InputError(
            f"Layer {layer_name!r} has no GeoJSON-like geometry at row {row}: its type is {name!r}. "
            f"The types are {', '.join(TYPE_NAMES)}."
        )
    return TYPE_NAMES.index(name)


def _check_depth(coordinates: Any, type_number: int, row: int, layer_name: str) -> None:
    depth, expected = coordinates_depth(coordinates), COORDINATE_DEPTH[type_number]
    if depth != expected and len(coordinates):
        found = f"more than {DEEPEST_COORDINATES}" if depth > DEEPEST_COORDINATES else str(depth)
        raise InputError(
            f"Layer {layer_name!r} has a {TYPE_NAMES[type_number]} at row {row} whose coordinates nest"
            f" {found} deep instead of {expected}. Write them as GeoJSON does."
        )


def _points_of(parts: list[Any], rows: NDArray[np.int64], layer_name: str) -> NDArray[np.float64]:
    try:
        x = [point[0] for ring in parts for point in ring]
        y = [point[1] for ring in parts for point in ring]
        return np.column_stack([np.array(x, dtype=np.float64), np.array(y, dtype=np.float64)])
    except (TypeError, ValueError, IndexError, KeyError) as error:
        part = next((index for index, ring in enumerate(parts) if not _are_points(ring)), 0)
        raise InputError(
            f"Layer {layer_name!r} has coordinates at row {int(rows[part])} that are no pairs of numbers:"
            f" {error}. Write each point as (x, y)."
        ) from error


def _are_points(ring: Any) -> bool:
    try:
        return all(len(point) >= 2 and isinstance(float(point[0]) + float(point[1]), float) for point in ring)
    except (TypeError, ValueError, IndexError, KeyError):
        return False


def drop_closing_points(ragged: Ragged) -> Ragged:
    """Rings without the repetition of their first point at their end."""
    counts = np.diff(ragged.part_offsets)
    long = np.flatnonzero(counts >= 2)
    first, last = ragged.part_offsets[:-1][long], ragged.part_offsets[1:][long] - 1
    closed = (ragged.coords[first] == ragged.coords[last]).all(axis=1)
    keep = np.ones(len(ragged.coords), dtype=np.bool_)
    keep[last[closed]] = False
    counts[long[closed]] -= 1
    return replace(ragged, coords=ragged.coords[keep], part_offsets=offsets_of(counts))


def has_area(ragged: Ragged) -> NDArray[np.bool_]:
    """For each part whether it has at least three distinct points."""
    enough = np.zeros(len(ragged.part_offsets) - 1, dtype=np.bool_)
    counts = np.diff(ragged.part_offsets)
    filled = np.flatnonzero(counts > 0)
    if filled.size == 0:
        return enough
    starts, counts = ragged.part_offsets[:-1][filled], counts[filled]
    coords = ragged.coords
    # The filled parts cover all points without gaps, so reduceat runs over exactly one part each.
    differs = (coords != np.repeat(coords[starts], counts, axis=0)).any(axis=1)
    places = np.where(differs, np.arange(len(coords)), len(coords))
    second = np.minimum.reduceat(places, starts)
    second = np.where(second < len(coords), second, starts)
    differs &= (coords != np.repeat(coords[second], counts, axis=0)).any(axis=1)
    enough[filled] = np.logical_or.reduceat(differs, starts)
    return enough


def keep_parts(ragged: Ragged, keep: NDArray[np.bool_]) -> tuple[Ragged, int]:
    """The features with only the kept parts, and how many features that left with none."""
    counts = np.diff(ragged.part_offsets)
    kept_before = np.concatenate([[0], np.cumsum(keep)]).astype(np.int64)
    feature_offsets = kept_before[ragged.feature_offsets]
    filled = np.diff(feature_offsets) > 0
    kept = Ragged(
        ragged.coords[np.repeat(keep, counts)],
        offsets_of(counts[keep]),
        np.concatenate([[0], feature_offsets[1:][filled]]).astype(np.int64),
        ragged.rows[filled],
        None if ragged.exterior is None else ragged.exterior[keep],
    )
    return kept, int((~filled).sum())


def signed_areas(coords: NDArray[np.float64], part_offsets: NDArray[np.int64]) -> NDArray[np.float64]:
    """Area of each ring (closed implicitly), positive anticlockwise; parts must not be empty."""
    if len(part_offsets) < 2:
        return np.zeros(0)
    starts, counts = part_offsets[:-1], np.diff(part_offsets)
    # Relative to each ring's first point: products of coordinates of 1e7 m would swallow small rings.
    local = coords - np.repeat(coords[starts], counts, axis=0)
    following = np.arange(1, len(coords) + 1)
    following[part_offsets[1:] - 1] = starts
    cross = local[:, 0] * local[following, 1] - local[following, 0] * local[:, 1]
    return np.asarray(np.add.reduceat(cross, starts) / 2.0)


def orient(ragged: Ragged) -> Ragged:
    """Outer rings anticlockwise and holes clockwise, so that signed areas add up to a feature's area."""
    if ragged.exterior is None or len(ragged.coords) == 0:
        return ragged
    starts, counts = ragged.part_offsets[:-1], np.diff(ragged.part_offsets)
    areas = signed_areas(ragged.coords, ragged.part_offsets)
    turned = np.where(ragged.exterior, areas < 0.0, areas > 0.0)
    if not turned.any():
        return ragged
    source = np.arange(len(ragged.coords))
    mirrored = np.repeat(starts + ragged.part_offsets[1:] - 1, counts) - source
    source = np.where(np.repeat(turned, counts), mirrored, source)
    return replace(ragged, coords=ragged.coords[source])
