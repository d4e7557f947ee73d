r"""Nearest hit of many rays with a triangulated heightfield, in double precision.

Based on maximum mipmaps (Tevs, Ihrke and Seidel, "Maximum mipmaps for fast, accurate, and scalable
dynamic height field rendering", 2008): a pyramid holds the lowest and highest point of every block
of 2^k by 2^k cells. A ray skips a block that it passes above or below, and opens it otherwise. All
rays of a chunk take their step together.

Each cell of four samples is two triangles, split along north-west to south-east:

    NW ---- NE     u (columns) grows to the right, v (rows) downwards.
    | \   up |     upper triangle NW SE NE where u >= v,
    | lo  \  |     lower triangle NW SW SE where v >= u.
    SW ---- SE     A triangle with a NaN sample is a hole.

The hit is solved from the ray and the triangle's plane, not marched. A triangle is grown by about
1e-9 of a cell, so that no ray slips between neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .contract import BoolArray, FloatArray, IntArray

# Rays that step together: few enough for the cache, enough to hide the cost of each NumPy call.
CHUNK = 16384
TOLERANCE = 1e-9


@dataclass(frozen=True)
class Hits:
    """distance (n,): ray parameter, inf for a miss; slope (n, 2): dz/du, dz/dv, NaN for a miss."""

    distance: FloatArray
    slope: FloatArray


class Heightfield:
    """Heights (rows, columns) in grid coordinates: u = column, v = row, z in metres, NaN = hole."""

    def __init__(self, heights: NDArray[np.floating[Any]]) -> None:
        self.heights: FloatArray = np.ascontiguousarray(heights, dtype=np.float64)
        rows, columns = self.heights.shape
        self.cell_rows = max(rows - 1, 0)
        self.cell_columns = max(columns - 1, 0)
        self.empty = self.cell_rows == 0 or self.cell_columns == 0
        if not self.empty:
            self._build_pyramid()

    def _build_pyramid(self) -> None:
        low, high = _cell_ranges(self.heights)
        self.lowest, self.highest = float(low.min()), float(high.max())
        self.empty = self.highest < self.lowest
        lows, highs, offsets, widths = [low.ravel()], [high.ravel()], [0], [low.shape[1]]
        while low.size > 1:
            offsets.append(offsets[-1] + low.size)
            low, high = _halve(low, np.inf, np.minimum), _halve(high, -np.inf, np.maximum)
            lows.append(low.ravel())
            highs.append(high.ravel())
            widths.append(low.shape[1])
        margin = 0.0 if self.empty else TOLERANCE * (1.0 + max(abs(self.lowest), abs(self.highest)))
        self.low: FloatArray = np.concatenate(lows) - margin
        self.high: FloatArray = np.concatenate(highs) + margin
        self.level_offsets: IntArray = np.array(offsets, dtype=np.int64)
        self.level_widths: IntArray = np.array(widths, dtype=np.int64)
        self.lowest -= margin
        self.highest += margin

    def cast(self, origins: FloatArray, directions: FloatArray) -> Hits:
        r"""Nearest hits of rays (n, 3) in grid coordinates at parameters >= 0."""
        count = len(origins)
        hits = Hits(np.full(count, np.inf), np.full((count, 2), np.nan))
        if self.empty:
            return hits
        for start in range(0, count, CHUNK):
            chunk = slice(start, start + CHUNK)
            _Traversal(self, origins[chunk], directions[chunk]).run(hits.distance[chunk], hits.slope[chunk])
        return hits


class _Traversal:
    """One chunk of rays on its way through the pyramid."""

    def __init__(self, field: Heightfield, origins: FloatArray, directions: FloatArray) -> None:
        self.field = field
        enter, leave = _clip(field, origins, directions)
        alive = np.flatnonzero(enter <= leave)
        self.ray: IntArray = alive
        self.enter = enter[alive]
        self.leave = leave[alive] - self.enter
        # Restarted where it enters the terrain's box: far eyes lose no digits.
        start = origins[alive] + self.enter[:, None] * directions[alive]
        self.u, self.v, self.z = (np.ascontiguousarray(start[:, axis]) for axis in range(3))
        self.du, self.dv, self.dz = (np.ascontiguousarray(directions[alive, axis]) for axis in range(3))
        with np.errstate(divide="ignore"):
            self.inverse_du, self.inverse_dv = 1.0 / self.du, 1.0 / self.dv
        self.at = np.zeros(len(alive))
        self.column = np.clip(np.floor(self.u).astype(np.int64), 0, field.cell_columns - 1)
        self.row = np.clip(np.floor(self.v).astype(np.int64), 0, field.cell_rows - 1)
        self.level = np.full(len(alive), len(field.level_widths) - 1, dtype=np.int64)

    def run(self, distance: FloatArray, slope: FloatArray) -> None:
        """Step all rays until each has hit or left; fill distance (n,) and slope (n, 2)."""
        while len(self.ray):
            finished = self._step(distance, slope)
            if finished.any():
                self._keep(~finished)

    def _keep(self, keep: BoolArray) -> None:
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, value[keep])

    def _step(self, distance: FloatArray, slope: FloatArray) -> BoolArray:
        field, level = self.field, self.level
        block_column, block_row = self.column >> level, self.row >> level
        exit_u = self._exit(block_column, self.du, self.inverse_du, self.u)
        exit_v = self._exit(block_row, self.dv, self.inverse_dv, self.v)
        leave = np.maximum(np.minimum(np.minimum(exit_u, exit_v), self.leave), self.at)

        z_at, z_leave = self.z + self.at * self.dz, self.z + leave * self.dz
        block = field.level_offsets[level] + block_row * field.level_widths[level] + block_column
        touches = (np.minimum(z_at, z_leave) <= field.high[block]) & (
            np.maximum(z_at, z_leave) >= field.low[block]
        )
        finished = np.zeros(len(self.ray), dtype=np.bool_)
        leaf = np.flatnonzero(touches & (level == 0))
        if len(leaf):
            finished[leaf] = self._test_cell(leaf, distance, slope)
        opens = touches & (level > 0)
        advance = np.flatnonzero(~(opens | finished))
        self.level[opens] -= 1
        finished[advance] = self._advance(advance, exit_u[advance] <= exit_v[advance], leave[advance])
        return finished

    def _exit(
        self, block: IntArray, direction: FloatArray, inverse: FloatArray, origin: FloatArray
    ) -> FloatArray:
        """Parameter (n,) where rays cross the far side of their block along one axis."""
        side = (block + (direction > 0)) << self.level
        with np.errstate(invalid="ignore"):
            crossing: FloatArray = (side - origin) * inverse
        crossing[direction == 0] = np.inf
        return crossing

    def _advance(self, which: IntArray, through_u: BoolArray, leave: FloatArray) -> BoolArray:
        """Move rays to the next block; True (n,) for those that left the terrain."""
        level = self.level[which]
        column, row = self.column[which], self.row[which]
        next_column = _next_cell(column, level, self.du[which], self.u[which], leave, through_u)
        next_row = _next_cell(row, level, self.dv[which], self.v[which], leave, ~through_u)
        left = (leave >= self.leave[which]) | (next_column < 0) | (next_row < 0)
        left |= (next_column >= self.field.cell_columns) | (next_row >= self.field.cell_rows)
        # A ray that leaves its parent block too goes on with larger blocks.
        top = len(self.field.level_widths) - 1
        parent = level + 1
        rises = ((next_column >> parent) != (column >> parent)) | ((next_row >> parent) != (row >> parent))
        self.level[which] = np.minimum(level + rises, top)
        self.column[which], self.row[which], self.at[which] = next_column, next_row, leave
        return left

    def _test_cell(self, which: IntArray, distance: FloatArray, slope: FloatArray) -> BoolArray:
        """Hit rays with the two triangles of their cell; True (n,) where one was hit."""
        column, row = self.column[which], self.row[which]
        u, v, z = self.u[which] - column, self.v[which] - row, self.z[which]
        du, dv, dz = self.du[which], self.dv[which], self.dz[which]
        heights = self.field.heights
        northwest, northeast = heights[row, column], heights[row, column + 1]
        southwest, southeast = heights[row + 1, column], heights[row + 1, column + 1]
        best = np.full(len(which), np.inf)
        best_u, best_v = np.full(len(which), np.nan), np.full(len(which), np.nan)
        for lower in (True, False):
            slope_u = southeast - southwest if lower else northeast - northwest
            slope_v = southwest - northwest if lower else southeast - northeast
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                at = (northwest + slope_u * u + slope_v * v - z) / (dz - slope_u * du - slope_v * dv)
                hit_u, hit_v = u + at * du, v + at * dv
            smaller, larger = (hit_u, hit_v) if lower else (hit_v, hit_u)
            hit = (smaller >= -TOLERANCE) & (larger <= 1 + TOLERANCE) & (larger - smaller >= -TOLERANCE)
            hit &= (at < best) & (at + self.enter[which] >= 0)
            best[hit], best_u[hit], best_v[hit] = at[hit], slope_u[hit], slope_v[hit]
        found: BoolArray = np.isfinite(best)
        ray = self.ray[which[found]]
        distance[ray] = np.maximum(best[found] + self.enter[which[found]], 0.0)
        slope[ray, 0], slope[ray, 1] = best_u[found], best_v[found]
        return found


def _next_cell(
    cell: IntArray,
    level: IntArray,
    direction: FloatArray,
    origin: FloatArray,
    leave: FloatArray,
    crosses: BoolArray,
) -> IntArray:
    """Cell (n,) along one axis after a block: the neighbour where crossed, else where the ray is."""
    first = (cell >> level) << level
    last = first + (1 << level) - 1
    forward = direction > 0
    inside = np.clip(np.floor(origin + leave * direction).astype(np.int64), first, last)
    # Rounding must never send a ray back.
    inside = np.where(forward, np.maximum(inside, cell), np.minimum(inside, cell))
    return np.where(crosses, np.where(forward, last + 1, first - 1), inside)


def _clip(field: Heightfield, origins: FloatArray, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Parameters (n,) where rays enter and leave the terrain's box; enter > leave if they miss."""
    lower = np.array([0.0, 0.0, field.lowest])
    upper = np.array([field.cell_columns, field.cell_rows, field.highest], dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (lower - origins) / directions, (upper - origins) / directions
    near, far = np.minimum(first, second), np.maximum(first, second)
    parallel = directions == 0
    outside = (origins < lower) | (origins > upper)
    near[parallel], far[parallel] = -np.inf, np.inf
    far[parallel & outside] = -np.inf
    return np.maximum(near.max(axis=1), 0.0), far.min(axis=1)


def _cell_ranges(heights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest point (rows-1, columns-1) of each cell's triangles, (inf, -inf) for a hole."""
    northwest, northeast = heights[:-1, :-1], heights[:-1, 1:]
    southwest, southeast = heights[1:, :-1], heights[1:, 1:]
    low = np.full(northwest.shape, np.inf)
    high = np.full(northwest.shape, -np.inf)
    for third in (southwest, northeast):
        # minimum and maximum pass NaN on, fmin and fmax drop it: a holed triangle counts for nothing.
        low = np.fmin(low, np.minimum(np.minimum(northwest, southeast), third))
        high = np.fmax(high, np.maximum(np.maximum(northwest, southeast), third))
    return low, high


def _halve(values: FloatArray, filler: float, reduce: np.ufunc) -> FloatArray:
    """The next coarser level of the pyramid: 2 by 2 blocks reduced to one."""
    rows, columns = values.shape
    padded = np.pad(values, ((0, rows % 2), (0, columns % 2)), constant_values=filler)
    pairs = reduce(padded[0::2], padded[1::2])
    result: FloatArray = reduce(pairs[:, 0::2], pairs[:, 1::2])
    return result
