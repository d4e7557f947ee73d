"""Vector data out of terrain models, where the registries carry none that fits: iso-bands, catchments, drainage lines.

    bands         contourpy: areas between two heights, with their holes
    catchments    pyflwdir: what drains to the same outlet, traced along the samples' borders by rasterio
    lakes         level ground
    drainage      pyflwdir: where more than so many samples drain through

All are in the terrain's plane. Catchments share their borders point by point.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..errors import DecalError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]


LEVEL = 0.05  # metres between neighbours, of water


class MissingLibraryError(DecalError, ImportError):
    """A library that only the full report needs is not installed."""


def bands(ground: dg.Terrain, levels: Iterable[tuple[float, float]]) -> tuple[dg.FeatureTable, FloatArray]:
    """Areas between pairs of heights, each connected piece a polygon with its holes; the upper height of each."""
    generator = _contours(ground)
    polygons: list[list[FloatArray]] = []
    heights: list[float] = []
    for low, high in levels:
        pieces, offsets = generator.filled(low, high)
        found = [np.split(points, ends[1:-1]) for points, ends in zip(pieces, offsets, strict=True)]
        found = [[ring for ring in rings if _is_area(ring)] for rings in found if _is_area(rings[0])]
        polygons += found
        heights += [high] * len(found)
    return table("polygons", polygons), np.asarray(heights)


def contour_lines(ground: dg.Terrain, heights: Iterable[float]) -> dg.FeatureTable:
    """Lines along which the ground is as high as one of the heights."""
    generator = _contours(ground)
    return table("lines", [[line] for height in heights for line in generator.lines(height)])


def catchments(ground: dg.Terrain, samples: int) -> tuple[dg.FeatureTable, FloatArray]:
    """What drains to the same outlet, about `samples` samples each; areas in square metres. Raises DecalError."""
    least = samples * ground.dx * ground.dy / 1e6
    found = table("polygons", _traced(ground, np.asarray(_flow(ground).subbasins_area(least)[0], np.int32)))
    return found, found.sizes()


def drainage(ground: dg.Terrain, samples: int) -> tuple[dg.FeatureTable, FloatArray]:
    """Lines through which `samples` samples or more drain, and how many at the lower end. Raises DecalError."""
    flow = _flow(ground)
    through = np.asarray(flow.upstream_area(unit="cell"))
    dry = np.nan_to_num(ground.z, nan=-1.0) > 0.0
    lines, counts = [], []
    for stream in flow.streams(mask=(through >= samples) & dry):
        points = np.asarray(stream["geometry"]["coordinates"], np.float64)
        if len(points) > 1:
            lines.append([points])
            counts.append(float(through.flat[stream["properties"]["idx"]]))
    return table("lines", lines), np.asarray(counts)


def lakes(ground: dg.Terrain, least: int = 40) -> dg.FeatureTable:
    """Level ground of `least` samples or more, as terrain models show water."""
    import rasterio.features

    around = np.lib.stride_tricks.sliding_window_view(np.pad(ground.z, 1, mode="edge"), (3, 3))
    with np.errstate(invalid="ignore"):
        level = (around.max(axis=(2, 3)) - around.min(axis=(2, 3))) < LEVEL
    kept = rasterio.features.sieve(level.astype(np.uint8), least)
    return table("polygons", _traced(ground, kept))


def above_surroundings(ground: dg.Terrain, samples: int) -> dg.Terrain:
    """Heights above the mean of a square of so many samples to each side; NaN at sea, which is level."""
    side = 2 * samples + 1
    padded = np.pad(ground.z.astype(np.float64), samples, mode="edge")
    sums = np.pad(padded.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    means = (sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]) / side**2
    above = np.where(ground.z > 0.0, ground.z - means, np.nan).astype(np.float32)
    return dg.Terrain(above, ground.x0, ground.y0, ground.dx, ground.dy, ground.crs)


def table(kind: Any, features: Sequence[Sequence[FloatArray]]) -> dg.FeatureTable:
    """Features out of the points of their parts."""
    parts = [part for feature in features for part in feature]
    coords = np.concatenate(parts) if parts else np.zeros((0, 2))
    part_offsets = np.cumsum([0, *map(len, parts)])
    feature_offsets = np.cumsum([0, *map(len, features)])
    return dg.FeatureTable(kind, coords, part_offsets, feature_offsets, np.arange(len(features)))


def chosen(features: dg.FeatureTable, keep: NDArray[np.bool_]) -> dg.FeatureTable:
    """The features of a table that a mask keeps, with rows of their own from 0 on."""
    parts = np.repeat(keep, np.diff(features.feature_offsets))
    points = np.repeat(parts, np.diff(features.part_offsets))
    part_offsets = np.append(0, np.cumsum(np.diff(features.part_offsets)[parts]))
    feature_offsets = np.append(0, np.cumsum(np.diff(features.feature_offsets)[keep]))
    return dg.FeatureTable(
        features.kind, features.coords[points], part_offsets, feature_offsets, np.arange(int(keep.sum()))
    )


def without_holes(features: dg.FeatureTable) -> dg.FeatureTable:
    """Polygons of their first rings alone."""
    first = features.feature_offsets[:-1]
    rings = [[features.coords[features.part_offsets[at] : features.part_offsets[at + 1]]] for at in first]
    return table("polygons", rings)


def holes(features: dg.FeatureTable) -> dg.FeatureTable:
    """A polygon of each ring but the first of its feature."""
    first = set(features.feature_offsets[:-1].tolist())
    ends = zip(features.part_offsets[:-1].tolist(), features.part_offsets[1:].tolist(), strict=True)
    rings = [[features.coords[begin:end]] for ring, (begin, end) in enumerate(ends) if ring not in first]
    return table("polygons", rings)


def repeated(features: dg.FeatureTable, steps: FloatArray) -> dg.FeatureTable:
    """The features once for each of the steps (n, 2) in metres."""
    count = len(steps)
    coords = (features.coords[None] + steps[:, None]).reshape(-1, 2)
    return dg.FeatureTable(
        features.kind,
        coords,
        _tiled(features.part_offsets, count),
        _tiled(features.feature_offsets, count),
        np.arange(count * len(features)),
    )


def _tiled(offsets: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    each = offsets[1:][None] + offsets[-1] * np.arange(count)[:, None]
    return np.append(0, each.reshape(-1))


def _contours(ground: dg.Terrain) -> Any:
    import contourpy

    rows, columns = ground.shape
    return contourpy.contour_generator(
        x=ground.x0 + ground.dx * np.arange(columns),
        y=ground.y0 - ground.dy * np.arange(rows),
        z=np.ma.masked_invalid(ground.z),
        line_type=contourpy.LineType.Separate,
        fill_type=contourpy.FillType.OuterOffset,
    )


def _is_area(ring: FloatArray) -> bool:
    """Whether a ring has three distinct points; contours touch single samples."""
    return len(ring) > 6 or len(np.unique(ring, axis=0)) > 2


def _traced(ground: dg.Terrain, labels: NDArray[Any]) -> list[list[FloatArray]]:
    """The rings of each connected piece of equal labels, along the samples' borders; 0 is left out."""
    import rasterio.features

    traced = rasterio.features.shapes(labels, mask=labels > 0, transform=_place(ground))
    return [[np.asarray(ring, np.float64) for ring in shape["coordinates"]] for shape, _ in traced]


def _place(ground: dg.Terrain) -> Any:
    """From columns and rows to metres: samples are the middles of cells."""
    from affine import Affine

    return Affine(ground.dx, 0, ground.x0 - ground.dx / 2, 0, -ground.dy, ground.y0 + ground.dy / 2)


@functools.lru_cache(maxsize=1)
def _flow(ground: dg.Terrain) -> Any:
    try:
        import pyflwdir
    except ImportError as error:
        raise MissingLibraryError(
            "Catchments and drainage lines are derived by pyflwdir, which is not installed. Run"
            " pip install pyflwdir, or leave these scenes out."
        ) from error
    # The sea is where water leaves the map.
    heights = np.where(ground.z > 0.0, ground.z, -9999.0).astype(np.float32)
    return pyflwdir.from_dem(heights, nodata=-9999.0, transform=_place(ground), latlon=False)
