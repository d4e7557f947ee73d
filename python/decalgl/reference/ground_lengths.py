"""Lengths along lines that lie on the ground: what patterns follow where widths are those on the slope, in float64."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .contract import FloatArray, IntArray
    from .ground import Ground


class GroundLengths:
    """How far along segments their points are, in metres along the ground, which is level over holes.

    start, vector: (n, 2), the segments on the map.
    """

    def __init__(self, ground: Ground, start: FloatArray, vector: FloatArray) -> None:
        knots, lengths = [], []
        for a, way in zip(start, vector, strict=True):
            shares = _crossings(ground, a, way)
            height = ground(a + shares[:, None] * way)
            steps = np.hypot(np.diff(shares) * np.hypot(*way), np.nan_to_num(np.diff(height)))
            knots.append(shares)
            lengths.append(np.concatenate([[0.0], np.cumsum(steps)]))
        # Segment i is between 2 i and 2 i + 1, so that one table holds all.
        self._knots = np.concatenate([2 * i + shares for i, shares in enumerate(knots)] or [np.zeros(1)])
        self._lengths = np.concatenate(lengths or [np.zeros(1)])
        self.total = np.array([each[-1] for each in lengths])
        self._first = np.array([each[1] / part[1] for each, part in zip(lengths, knots, strict=True)])
        self._last = np.array(
            [(each[-1] - each[-2]) / (1.0 - part[-2]) for each, part in zip(lengths, knots, strict=True)]
        )

    def at(self, segment: IntArray, share: FloatArray) -> FloatArray:
        """Metres (m,) from the starts of segments (m,) at shares of their ways; beyond their ends straight on."""
        inside = np.clip(share, 0.0, 1.0)
        along: FloatArray = np.interp(2 * segment + inside, self._knots, self._lengths)
        beyond = share - inside
        return along + beyond * np.where(beyond < 0.0, self._first[segment], self._last[segment])


def _crossings(ground: Ground, start: FloatArray, way: FloatArray) -> FloatArray:
    """Shares of a way, from 0 to 1, at which it may pass from one triangle to the next."""
    terrain = ground.terrain
    rows, columns = ground.heights.shape
    column, row = (start[0] - terrain.x0) / terrain.dx, (terrain.y0 - start[1]) / terrain.dy
    east, south = way[0] / terrain.dx, -way[1] / terrain.dy
    shares = [np.array([0.0, 1.0])]
    for begin, step, low, high in (
        (column, east, 0, columns - 1),
        (row, south, 0, rows - 1),
        (column - row, east - south, 1 - rows, columns - 1),
    ):
        if step == 0.0:
            continue
        first, last = sorted((begin, begin + step))
        lines = np.arange(max(low, np.ceil(first)), min(high, np.floor(last)) + 1)
        shares.append((lines - begin) / step)
    found = np.unique(np.concatenate(shares))
    return found[(found >= 0.0) & (found <= 1.0)]
