"""The height of the ground under places of the map: the triangles of the heightfield, in float64."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .contract import FloatArray, SceneLike


class Ground:
    """Heights of a scene's surface; beyond the outer samples it goes on level."""

    def __init__(self, scene: SceneLike) -> None:
        self.heights = np.asarray(scene.heights, dtype=np.float64)
        self.terrain = scene.terrain

    def __call__(self, xy: FloatArray) -> FloatArray:
        """Metres (n,) at map points (n, 2); NaN in holes."""
        rows, columns = self.heights.shape
        column = np.clip((xy[:, 0] - self.terrain.x0) / self.terrain.dx, 0, columns - 1)
        row = np.clip((self.terrain.y0 - xy[:, 1]) / self.terrain.dy, 0, rows - 1)
        left = np.minimum(column.astype(np.int64), columns - 2)
        top = np.minimum(row.astype(np.int64), rows - 2)
        east, south = column - left, row - top
        north_west, south_east = self.heights[top, left], self.heights[top + 1, left + 1]
        below = south > east
        third = np.where(below, self.heights[top + 1, left], self.heights[top, left + 1])
        to_east = np.where(below, south_east - third, third - north_west)
        to_south = np.where(below, third - north_west, south_east - third)
        height: FloatArray = north_west + east * to_east + south * to_south
        return height
