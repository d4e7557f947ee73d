"""Polygons cut into triangles by GEOS, for techniques that draw meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .features import FeatureTable


def triangles_of(features: FeatureTable) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """float64 (triangles, 3, 2), and int64 (features + 1): where those of each feature begin.

    They cover what the even-odd rule over all rings of a feature says, and nothing twice.
    """
    regions = _regions(features)
    triangles, owner = shapely.get_parts(shapely.constrained_delaunay_triangles(regions), return_index=True)
    corners = shapely.get_coordinates(triangles).reshape(-1, 4, 2)[:, :3]
    count = np.bincount(owner, minlength=len(regions))
    return np.ascontiguousarray(corners), np.concatenate([[0], np.cumsum(count)]).astype(np.int64)


def _regions(features: FeatureTable) -> NDArray[np.object_]:
    """(features,) polygons or collections of them; what has no area is an empty one."""
    rings, feature = _rings(features)
    regions = np.full(len(features.rows), shapely.Polygon(), dtype=object)
    used, first, count = np.unique(feature, return_index=True, return_counts=True)
    lines = np.full(len(regions), shapely.MultiLineString(), dtype=object)
    if used.size:
        lines[used] = shapely.multilinestrings(rings, indices=np.searchsorted(used, feature))
    # Rings that meet nowhere lie in each other or beside each other.
    simple = shapely.is_simple(lines)
    single = used[count == 1]
    regions[single] = shapely.polygons(rings[first[count == 1]])
    nested = used[(count > 1) & simple[used]]
    regions[nested] = shapely.build_area(lines[nested])
    for index in used[~simple[used]].tolist():
        regions[index] = _odd_faces(lines[index])
    return regions


def _odd_faces(rings: shapely.MultiLineString) -> shapely.GeometryCollection:
    """The faces between rings that lie in an odd number of them."""
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all(shapely.get_parts(rings))]))
    points = shapely.get_coordinates(shapely.point_on_surface(faces))
    inside = np.zeros(len(points), dtype=np.bool_)
    for ring in shapely.get_parts(rings):
        begin = shapely.get_coordinates(ring)
        for (x0, y0), (x1, y1) in zip(begin[:-1], begin[1:], strict=True):
            crosses = (points[:, 1] >= y0) != (points[:, 1] >= y1)
            if crosses.any():
                x = x0 + (points[crosses, 1] - y0) / (y1 - y0) * (x1 - x0)
                inside[crosses] ^= x > points[crosses, 0]
    return shapely.GeometryCollection(list(faces[inside]))


def _rings(features: FeatureTable) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
    """Each ring of three or more vertices, closed, and its feature."""
    coords = np.asarray(features.coords, dtype=np.float64)
    length = np.diff(features.part_offsets)
    owner = np.repeat(np.arange(len(features.rows)), np.diff(features.feature_offsets))
    kept = length >= 3
    ring = np.repeat(np.arange(len(length)), length)
    vertices = np.flatnonzero(kept[ring])
    first = np.asarray(features.part_offsets[:-1])[kept]
    # Rings are closed by repeating their first vertex.
    place = np.concatenate([vertices, first])
    renumbered = np.cumsum(kept) - 1
    index = np.concatenate([renumbered[ring[vertices]], np.arange(len(first))])
    order = np.argsort(index, kind="stable")
    closed = shapely.linearrings(coords[place[order]], indices=index[order])
    return closed, owner[kept].astype(np.int64)
