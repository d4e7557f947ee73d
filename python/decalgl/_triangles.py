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
    """(features,) valid polygons or collections of them; what has no area is an empty one."""
    rings, feature = _rings(features)
    regions = np.full(len(features.rows), shapely.Polygon(), dtype=object)
    count = np.bincount(feature, minlength=len(regions))
    single = count[feature] == 1
    regions[feature[single]] = rings[single]
    # Rings on their own may overlap: making the collection valid takes their symmetric difference.
    several = np.flatnonzero(count > 1)
    if several.size:
        place = np.searchsorted(several, feature[~single])
        regions[several] = shapely.multipolygons(rings[~single], indices=place)
    invalid = np.flatnonzero(~shapely.is_valid(regions))
    regions[invalid] = shapely.make_valid(regions[invalid], method="linework")
    return regions


def _rings(features: FeatureTable) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
    """Each ring of three or more vertices as a polygon, and its feature."""
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
    return shapely.polygons(closed), owner[kept].astype(np.int64)
