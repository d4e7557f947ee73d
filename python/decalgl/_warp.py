"""Rasters on other planes, brought onto a north-up grid of a metric plane.

A raster arrives as samples, an affine transform (sample (row, col) at transform * (col + 1/2, row + 1/2))
and a CRS. Where its plane is metric and its rows run east-west it is only flipped to start in the north
west; otherwise every target sample is moved back to the source and interpolated bilinearly:

    target (row, col) -> target x, y -> source x, y -> source (row, col) -> four samples

The move is exact (no approximated transformer), so the picture does not depend on the version of GDAL; a
target sample is a hole when any sample that carries weight is one, so holes never shrink.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._crs import EARTH_RADIUS, geographic_turn, is_metric, local_metric_crs, name_of, same_crs, transformer
from .errors import CrsError, InputError, MemoryLimitError

if TYPE_CHECKING:
    import pyproj
    from numpy.typing import NDArray

BLOCK_SAMPLES = 1 << 20
EDGE_POINTS = 65
FARTHEST = 0.7 * EARTH_RADIUS  # transverse Mercator stretches by a quarter this far from its meridian


@dataclass(frozen=True)
class Grid:
    """A north-up grid of samples: sample (row, col) sits at (x0 + col * dx, y0 - row * dy)."""

    x0: float
    y0: float
    dx: float
    dy: float
    rows: int
    columns: int


@dataclass(frozen=True)
class AffineMap:
    """x = a * col + b * row + c, y = d * col + e * row + f, at sample centres (halves already added)."""

    a: float
    b: float
    c: float
    d: float
    e: float
    f: float

    @classmethod
    def of_transform(cls, transform: Any, what: str) -> AffineMap:
        """From an affine.Affine or six numbers (a, b, c, d, e, f) in rasterio's order."""
        try:
            a, b, c, d, e, f = (float(value) for value in tuple(transform)[:6])
        except (TypeError, ValueError) as error:
            raise InputError(
                f"The transform of {what} must be an affine.Affine or six numbers (a, b, c, d, e, f) as"
                f" rasterio gives them, but it is {transform!r}."
            ) from error
        determinant = a * e - b * d
        if not math.isfinite(determinant + c + f) or determinant == 0.0:
            raise InputError(
                f"The transform of {what} does not span a plane: {(a, b, c, d, e, f)}. Its two steps a, e "
                "(or b, d) must be finite and not zero; rasterio.transform.from_bounds makes one."
            )
        return cls(a, b, c + (a + b) / 2.0, d, e, f + (d + e) / 2.0)

    def forward(self, column: Any, row: Any) -> tuple[Any, Any]:
        return self.a * column + self.b * row + self.c, self.d * column + self.e * row + self.f

    def inverse(self, x: Any, y: Any) -> tuple[Any, Any]:
        determinant = self.a * self.e - self.b * self.d
        u, v = x - self.c, y - self.f
        return (self.e * u - self.b * v) / determinant, (self.a * v - self.d * u) / determinant

    def is_rotated(self, rows: int, columns: int) -> bool:
        """Whether following a row or column to its end drifts by more than 1/1000 of a sample."""
        return abs(self.b) * rows > 1e-3 * abs(self.a) or abs(self.d) * columns > 1e-3 * abs(self.e)


def to_metric_grid(
    z: NDArray[np.float32],
    sample_map: AffineMap,
    crs: pyproj.CRS | None,
    target: pyproj.CRS | None,
    max_samples: int,
    what: str,
) -> tuple[NDArray[np.float32], Grid, pyproj.CRS | None]:
    """The heights (rows, columns), their grid, and the metric CRS it lies in.

    `target` None keeps a metric `crs` and warps any other to a local transverse Mercator plane.
    """
    rows, columns = z.shape
    if crs is not None and target is None:
        target = crs if is_metric(crs) else local_metric_crs(crs, *_centre(sample_map, rows, columns))
    moves = crs is not None and target is not None and not same_crs(crs, target)
    if not moves and not sample_map.is_rotated(rows, columns):
        return *_flipped(z, sample_map), target
    warp = _Warp(sample_map, crs if moves else None, target if moves else None, rows, columns, what)
    if rows == 1 or columns == 1:
        return z, warp.thin_grid(), target
    grid = warp.target_grid()
    _check_count(grid, max_samples, what)
    if warp.wraps:
        z = np.concatenate([z, z[:, :1]], axis=1)
    return warp.resample(z, grid), grid, target


def _centre(sample_map: AffineMap, rows: int, columns: int) -> tuple[float, float]:
    x, y = sample_map.forward((columns - 1) / 2.0, (rows - 1) / 2.0)
    return float(x), float(y)


def _flipped(z: NDArray[np.float32], sample_map: AffineMap) -> tuple[NDArray[np.float32], Grid]:
    rows, columns = z.shape
    first_column, first_row = 0, 0
    if sample_map.a < 0.0:
        z, first_column = z[:, ::-1], columns - 1
    if sample_map.e > 0.0:
        z, first_row = z[::-1], rows - 1
    x0, y0 = sample_map.forward(first_column, first_row)
    return z, Grid(x0, y0, abs(sample_map.a), abs(sample_map.e), rows, columns)


def _check_count(grid: Grid, max_samples: int, what: str) -> None:
    if grid.rows * grid.columns > max_samples:
        raise MemoryLimitError(
            f"Warped to a metric plane, {what} would take {grid.rows} x {grid.columns} samples, more than "
            f"max_samples={max_samples}. Cut it to the area of interest (window=), give a CRS that suits it "
            "(crs=), or raise max_samples=."
        )


class _Warp:
    """Positions of one raster's samples on the target plane, and back."""

    def __init__(
        self,
        sample_map: AffineMap,
        source: pyproj.CRS | None,
        target: pyproj.CRS | None,
        rows: int,
        columns: int,
        what: str,
    ) -> None:
        self.sample_map, self.rows, self.columns, self.what = sample_map, rows, columns, what
        self.source, self.target = source, target
        self.turn = geographic_turn(source) if source is not None and source.is_geographic else None
        full_turn = self.turn is not None and math.isclose(
            columns * abs(sample_map.a), self.turn, rel_tol=1e-6
        )
        # A raster once around the globe closes: its first column follows its last.
        self.wraps = full_turn and not sample_map.is_rotated(rows, columns)
        if self.wraps:
            self.columns += 1

    def forward(self, column: Any, row: Any) -> tuple[Any, Any]:
        x, y = self.sample_map.forward(column, row)
        if self.source is not None:
            x, y = transformer(self.source, self.target).transform(x, y)
        return x, y

    def inverse(self, x: Any, y: Any) -> tuple[Any, Any]:
        if self.source is not None:
            x, y = transformer(self.target, self.source).transform(x, y)
        if self.turn is not None:
            # PROJ answers within half a turn of Greenwich; the raster may lie across the antimeridian.
            middle, _ = _centre(self.sample_map, self.rows, self.columns)
            x = middle + (x - middle + self.turn / 2.0) % self.turn - self.turn / 2.0
        return self.sample_map.inverse(x, y)

    def steps(self) -> tuple[float, float]:
        """Lengths of one column and one row step at the raster's centre, in metres on the target."""
        column, row = (self.columns - 1) / 2.0, (self.rows - 1) / 2.0
        x, y = self.forward(
            np.array([column - 0.5, column + 0.5, column, column]), np.array([row, row, row - 0.5, row + 0.5])
        )
        step_x, step_y = math.hypot(x[1] - x[0], y[1] - y[0]), math.hypot(x[3] - x[2], y[3] - y[2])
        if not (0.0 < step_x < math.inf and 0.0 < step_y < math.inf):
            self.refuse()
        turned = abs(x[1] - x[0]) < abs(y[1] - y[0])  # by about a quarter turn: rows run north-south
        return (step_y, step_x) if turned else (step_x, step_y)

    def refuse(self) -> None:
        raise CrsError(
            f"The extent of {self.what} in {name_of(self.source)} does not fit on the plane"
            f" {name_of(self.target)}. Cut it to the area of interest, or name a metric CRS that suits it"
            " with crs=."
        )

    def target_grid(self) -> Grid:
        """A grid over the samples' positions, as fine as the source is at its centre."""
        columns, rows = np.meshgrid(
            np.linspace(0, self.columns - 1, EDGE_POINTS), np.linspace(0, self.rows - 1, EDGE_POINTS)
        )
        x, y = self.forward(columns.ravel(), rows.ravel())
        if not (np.isfinite(x).all() and np.isfinite(y).all()):
            self.refuse()
        if self.target is not None and "+proj=tmerc" in str(self.target.srs) and np.abs(x).max() > FARTHEST:
            self.refuse()
        dx, dy = self.steps()
        west, east, south, north = float(x.min()), float(x.max()), float(y.min()), float(y.max())
        column_steps, row_steps = max(1, round((east - west) / dx)), max(1, round((north - south) / dy))
        return Grid(
            west,
            north,
            (east - west) / column_steps,
            (north - south) / row_steps,
            row_steps + 1,
            column_steps + 1,
        )

    def thin_grid(self) -> Grid:
        """The grid of a single row or column, which draws nothing: placed, not interpolated."""
        columns = self.columns - (1 if self.wraps else 0)
        dx, dy = self.steps()
        x, y = self.forward((columns - 1) / 2.0, (self.rows - 1) / 2.0)
        return Grid(x - dx * (columns - 1) / 2.0, y + dy * (self.rows - 1) / 2.0, dx, dy, self.rows, columns)

    def resample(self, z: NDArray[np.float32], grid: Grid) -> NDArray[np.float32]:
        """Heights at the grid's samples, NaN outside the source and beside its holes."""
        heights = np.empty((grid.rows, grid.columns), dtype=np.float32)
        block = max(1, BLOCK_SAMPLES // grid.columns)
        x = grid.x0 + np.arange(grid.columns) * grid.dx
        for start in range(0, grid.rows, block):
            y = grid.y0 - np.arange(start, min(start + block, grid.rows)) * grid.dy
            grid_x, grid_y = np.meshgrid(x, y)
            column, row = self.inverse(grid_x.ravel(), grid_y.ravel())
            heights[start : start + len(y)] = bilinear(z, column, row).reshape(grid_x.shape)
        return heights


def bilinear(
    z: NDArray[np.float32], column: NDArray[np.float64], row: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Heights at fractional (column, row) of `z`, at least 2 x 2 samples; NaN outside and beside holes.

    A position up to 1/1000 of a sample outside counts as on the border, and one as near to a sample as
    the sample itself, so that rounding neither trims the outer samples nor spreads holes.
    """
    rows, columns = z.shape
    slack = 1e-3
    with np.errstate(invalid="ignore"):
        inside = (
            (column >= -slack) & (column <= columns - 1 + slack) & (row >= -slack) & (row <= rows - 1 + slack)
        )
    column, row = column[inside], row[inside]
    west = np.clip(np.floor(column), 0, columns - 2).astype(np.int64)
    north = np.clip(np.floor(row), 0, rows - 2).astype(np.int64)
    u, v = _fraction(column - west), _fraction(row - north)
    total = np.zeros(len(column), dtype=np.float64)
    for step_row, weight_row in ((0, 1.0 - v), (1, v)):
        for step_column, weight_column in ((0, 1.0 - u), (1, u)):
            weight = weight_row * weight_column
            sample = z[north + step_row, west + step_column]
            total += np.where(weight > 0.0, sample * weight, 0.0)
    heights = np.full(inside.shape, np.nan)
    heights[inside] = total
    return heights


def _fraction(value: NDArray[np.float64]) -> NDArray[np.float64]:
    near = np.rint(value)
    return np.clip(np.where(np.abs(value - near) < 1e-3, near, value), 0.0, 1.0)
