"""The ground of a scene: heights on a regular grid of a metric plane.

    sample (0,0) at (x0, y0)      north
        +----+----+----+            ^
        |    |    |    |  dy        |
        +----+----+----+            +--> east
          dx               sample (row, col) at (x0 + col * dx, y0 - row * dy)

Heights are metres; NaN marks a hole. The surface is triangles over the samples and ends at the outer ones,
so a terrain of a single row, column or sample is legal and draws nothing.
"""

from __future__ import annotations

import logging
import math
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _raster, _warp
from ._crs import is_metric, name_of, parse_crs
from .errors import CrsError, InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyproj
    from numpy.typing import ArrayLike, NDArray

log = logging.getLogger("decalgl")


@dataclass(frozen=True, eq=False)
class Terrain:
    """Heights in metres over a north-up grid of a metric plane; make one with `open`, `from_array` or `flat`.

    z: float32 (rows, columns), row 0 in the north, NaN where there is no ground; read-only.
    x0, y0: position of sample (0, 0), in metres of the scene's plane.
    dx, dy: metres from one column to the next eastwards and from one row to the next southwards, both > 0.
    crs: the plane's coordinate reference system (a pyproj.CRS in metres), or None.
    """

    z: NDArray[np.float32] = field(repr=False)
    x0: float
    y0: float
    dx: float
    dy: float
    crs: pyproj.CRS | None = None

    def __post_init__(self) -> None:
        given = np.asarray(self.z)
        if given.ndim != 2 or given.size == 0 or given.dtype.kind not in "iufb":
            raise InputError(
                "A terrain needs at least one sample in rows and columns of real heights, but z has shape"
                f" {given.shape} and type {given.dtype}."
            )
        with np.errstate(over="ignore"):
            z = np.ascontiguousarray(given, dtype=np.float32)
        if np.isinf(z).any():
            raise InputError("A terrain's heights must be finite, or NaN for holes, but some are infinite.")
        if z.flags.writeable:
            z = z.view()
            z.flags.writeable = False
        object.__setattr__(self, "z", z)
        for name in ("x0", "y0", "dx", "dy"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if not (math.isfinite(self.x0 + self.y0 + self.dx + self.dy) and self.dx > 0.0 and self.dy > 0.0):
            raise InputError(
                f"A terrain's origin must be finite and its steps positive, but (x0, y0) is ({self.x0},"
                f" {self.y0}) and (dx, dy) is ({self.dx}, {self.dy})."
            )

    def __repr__(self) -> str:
        rows, columns = self.shape
        return (
            f"<Terrain {rows} x {columns} samples, {self.dx:.6g} x {self.dy:.6g} m apart, in"
            f" {name_of(self.crs)}>"
        )

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns) of samples."""
        return self.z.shape[0], self.z.shape[1]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, ymin, xmax, ymax) over the samples' positions, in metres."""
        rows, columns = self.shape
        return (self.x0, self.y0 - (rows - 1) * self.dy, self.x0 + (columns - 1) * self.dx, self.y0)

    @classmethod
    def open(
        cls,
        path: str | os.PathLike[str],
        crs: Any = None,
        band: int = 1,
        *,
        window: Any = None,
        max_samples: int | None = None,
        nodata: float | None = None,
    ) -> Terrain:
        """The terrain of a raster file of any format that GDAL reads (through rasterio).

        Samples that the file marks as nodata are holes; scale, offset and units of length that the band
        states (feet, say) are applied. A raster in degrees, in feet or turned against north is warped
        bilinearly to a metric plane, by default transverse Mercator around its centre at the samples' own
        spacing there.

        crs: the metric CRS to warp to; for a raster without one, the CRS that it is in.
        band: the band to read, from 1.
        window: (column, row, columns, rows) of the part to read, or a rasterio Window.
        max_samples: the most samples to read; by default 16384 x 16384, and files that declare much more than
            they can hold are refused. Giving it means that the size is meant.
        nodata: the value that marks holes, instead of the file's own mark.

        Raises FileError (missing, unreadable), MemoryLimitError (too large), CrsError, and InputError (no
        such band, no finite height, infinite heights).
        """
        what = repr(os.fspath(path))
        read = _raster.read_band(path, band, window, max_samples, nodata)
        source = parse_crs(read.crs, f"the CRS stored in {what}")
        target = parse_crs(crs, "the argument crs=")
        if source is None:
            source, target = target, None
        if target is not None and not is_metric(target):
            raise CrsError(
                f"crs={name_of(target)} is not in metres, so it cannot be the plane of a scene. Name a"
                " projected CRS in metres, or leave crs= out to get one around the terrain's centre."
            )
        limit = _raster.MAX_SAMPLES if max_samples is None else int(max_samples)
        return cls._on_plane(read.heights, read.sample_map, source, target, limit, what)

    @classmethod
    def from_array(
        cls, z: ArrayLike, transform: Any, crs: Any = None, nodata: float | None = None
    ) -> Terrain:
        """The terrain of an array, as rasterio gives it.

        z: heights in metres, shape (rows, columns), of any real type, masked arrays included; NaN is a hole.
        transform: affine.Affine or (a, b, c, d, e, f): sample (row, col) lies at transform * (col + 1/2,
            row + 1/2).
        crs: the CRS of the transform; one in degrees or feet is warped as `open` does.
        nodata: the height that marks holes; None keeps all.

        Raises InputError (shape, type, infinite or no finite heights, transform) and CrsError.
        """
        mask = np.ma.getmaskarray(z) if isinstance(z, np.ma.MaskedArray) else None
        values = np.asarray(z)
        if values.ndim != 2 or values.size == 0 or values.dtype.kind not in "iufb":
            raise InputError(
                f"z must be a table of real heights, shape (rows, columns), but it has shape {values.shape}"
                f" and type {values.dtype}. Give one band, such as dataset.read(1)."
            )
        if nodata is not None:
            marked = values == nodata
            mask = marked if mask is None else mask | marked
        heights = _raster.as_heights(values, mask, "the array z")
        _raster.check_finite(heights, "The array z")
        source = parse_crs(crs, "the argument crs=")
        sample_map = _warp.AffineMap.of_transform(transform, "the array z")
        return cls._on_plane(
            heights, sample_map, source, None, max(_raster.MAX_SAMPLES, 2 * heights.size), "the array z"
        )

    @classmethod
    def flat(cls, bounds: Sequence[float], crs: Any = None, height: float = 0.0) -> Terrain:
        """Level ground: 2 x 2 samples at the corners of `bounds`.

        bounds: (xmin, ymin, xmax, ymax) in `crs`; bounds in degrees or feet become the rectangle around
            them on a metric plane.
        height: metres.
        """
        try:
            west, south, east, north = (float(value) for value in bounds)
        except (TypeError, ValueError) as error:
            raise InputError(f"bounds must be (xmin, ymin, xmax, ymax), but it is {bounds!r}.") from error
        if not (math.isfinite(west + south + east + north) and west < east and south < north):
            raise InputError(
                "bounds must be finite with xmin < xmax and ymin < ymax, but it is"
                f" {(west, south, east, north)}."
            )
        if not math.isfinite(height):
            raise InputError(f"The height of flat ground must be finite, but it is {height}.")
        level = np.full((2, 2), height, dtype=np.float32)
        source = parse_crs(crs, "the argument crs=")
        width, depth = east - west, north - south
        if source is None or is_metric(source):
            return cls(level, west, north, width, depth, source)
        # A fine grid finds the rectangle around the bounds' curved image; its heights are all the same.
        steps = _warp.EDGE_POINTS - 1
        fine = np.zeros((steps + 1, steps + 1), dtype=np.float32)
        half_x, half_y = width / steps / 2.0, depth / steps / 2.0
        transform = (width / steps, 0.0, west - half_x, 0.0, -depth / steps, north + half_y)
        around = cls.from_array(fine, transform, source)
        xmin, ymin, xmax, ymax = around.bounds
        return cls(level, xmin, ymax, xmax - xmin, ymax - ymin, around.crs)

    @classmethod
    def _on_plane(
        cls,
        heights: NDArray[np.float32],
        sample_map: _warp.AffineMap,
        source: pyproj.CRS | None,
        target: pyproj.CRS | None,
        max_samples: int,
        what: str,
    ) -> Terrain:
        z, grid, crs = _warp.to_metric_grid(heights, sample_map, source, target, max_samples, what)
        if source is not None and crs is not None and crs is not source:
            log.info("terrain %s: warped from %s to %s", what, name_of(source), name_of(crs))
        return cls(z, grid.x0, grid.y0, grid.dx, grid.dy, crs)
