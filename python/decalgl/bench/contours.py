"""Isolines and iso-bands of a terrain, traced by contourpy level by level and kept on disk.

    isolines     polylines along one elevation
    iso-bands    polygons with holes between two elevations; neighbours share their borders point by point

Both are ordered by elevation.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import contourpy
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    import decalgl as dg

    Arrays = dict[str, NDArray[Any]]
    Say = Callable[[str], None]

# A third of a metre off, so that no isoline falls on the whole metres of the samples.
OFF_WHOLE_METRES = 0.37
LEVELS_A_LINE = 100  # of progress


def isolines(ground: dg.Terrain, step: float, path: Path, say: Say) -> Arrays:
    """`coordinates` (n, 2) and `offsets` of the lines, every `step` metres over the whole height range."""
    return _kept(path, lambda: _trace_lines(ground, step, say), say)


def isobands(ground: dg.Terrain, step: float, path: Path, say: Say) -> Arrays:
    """`coordinates`, `part_offsets`, `feature_offsets` of polygons, and the `heights` they reach up to."""
    return _kept(path, lambda: _trace_bands(ground, step, say), say)


def _kept(path: Path, trace: Callable[[], Arrays], say: Say) -> Arrays:
    if not path.exists():
        say(f"making {path.name}")
        path.parent.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(".part.npz")
        arrays: dict[str, Any] = trace()
        np.savez(unfinished, **arrays)
        unfinished.rename(path)
    with np.load(path) as stored:
        return dict(stored)


def _trace_lines(ground: dg.Terrain, step: float, say: Say) -> Arrays:
    generator = _generator(ground)
    coordinates, offsets = _Parts(), _Offsets()
    levels = np.arange(np.nanmin(ground.z) + OFF_WHOLE_METRES, np.nanmax(ground.z), step)
    for i, elevation in enumerate(levels):
        _tell(say, i, len(levels))
        (points,), (ends,) = generator.lines(elevation)
        if points is not None:
            coordinates.append(points)
            offsets.append(ends)
    return {"coordinates": coordinates.joined(), "offsets": offsets.joined()}


def _trace_bands(ground: dg.Terrain, step: float, say: Say) -> Arrays:
    generator = _generator(ground)
    coordinates, rings, polygons, heights = _Parts(), _Offsets(), _Offsets(), _Parts()
    lowest, highest = float(np.nanmin(ground.z)), float(np.nanmax(ground.z))
    # The outermost levels lie beyond the terrain, so that the bands cover it all.
    levels = np.arange(lowest + OFF_WHOLE_METRES - step, highest + step, step)
    for i, (low, high) in enumerate(itertools.pairwise(levels)):
        _tell(say, i, len(levels))
        (points,), (ends,), (members,) = generator.filled(low, high)
        if points is not None:
            coordinates.append(points)
            rings.append(ends)
            polygons.append(members)
            heights.append(np.full(len(members) - 1, high))
    return {
        "coordinates": coordinates.joined(),
        "part_offsets": rings.joined(),
        "feature_offsets": polygons.joined(),
        "heights": heights.joined(),
    }


def _generator(ground: dg.Terrain) -> Any:
    rows, columns = ground.shape
    return contourpy.contour_generator(
        x=ground.x0 + ground.dx * np.arange(columns),
        y=ground.y0 - ground.dy * np.arange(rows),
        z=np.ma.masked_invalid(ground.z),
        line_type=contourpy.LineType.ChunkCombinedOffset,
        fill_type=contourpy.FillType.ChunkCombinedOffsetOffset,
    )


def _tell(say: Say, level: int, levels: int) -> None:
    if level and level % LEVELS_A_LINE == 0:
        say(f"level {level} of {levels}")


class _Parts:
    """Arrays that come level by level, to be one."""

    def __init__(self) -> None:
        self._parts: list[NDArray[Any]] = []

    def append(self, part: NDArray[Any]) -> None:
        self._parts.append(part)

    def joined(self) -> NDArray[Any]:
        return np.concatenate(self._parts)


class _Offsets(_Parts):
    """Offsets that each start from 0, to go on from where the last ones ended."""

    def __init__(self) -> None:
        super().__init__()
        self._end = 0
        super().append(np.zeros(1, np.int64))

    def append(self, part: NDArray[Any]) -> None:
        super().append(part[1:].astype(np.int64) + self._end)
        self._end += int(part[-1])
