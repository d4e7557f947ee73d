"""Points of the map, cut into strips so that the pairs of a point and what lies near it are few.

Points are cut into strips of equal counts along x and sorted by y within each.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .contract import FloatArray, IntArray

# Pairs that are held at once.
PAIR_LIMIT = 2_000_000
POINTS_PER_STRIP = 4096
MOST_STRIPS = 64


@dataclass(frozen=True)
class Strip:
    """Points (n,) between two x, sorted by y; index tells which points of the caller they are."""

    x: FloatArray
    y: FloatArray
    index: IntArray


def strips(xy: FloatArray) -> Iterator[Strip]:
    """Cut finite points (n, 2) into strips of nearly equal counts."""
    index = np.flatnonzero(np.isfinite(xy).all(axis=1))
    if not len(index):
        return
    index = index[np.argsort(xy[index, 0], kind="stable")]
    strip_count = int(np.clip(len(index) // POINTS_PER_STRIP, 1, MOST_STRIPS))
    for part in np.array_split(index, strip_count):
        ordered = part[np.argsort(xy[part, 1], kind="stable")]
        yield Strip(xy[ordered, 0], xy[ordered, 1], ordered)


def candidate_pairs(first: IntArray, last: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """All (i, j) with first[i] <= j < last[i], in batches of about PAIR_LIMIT."""
    counts = np.maximum(last - first, 0)
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    start = done = 0
    while done < total:
        stop = max(int(np.searchsorted(ends, done + PAIR_LIMIT, side="right")), start + 1)
        batch = counts[start:stop]
        owner = np.repeat(np.arange(start, stop), batch)
        shift = np.repeat(first[start:stop] - (np.cumsum(batch) - batch), batch)
        yield owner, np.arange(len(owner)) + shift
        start, done = stop, int(ends[stop - 1])
