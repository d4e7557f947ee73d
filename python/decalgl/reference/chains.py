"""Parts of features as chains of vertices that a stroke follows: without repeats, open or closed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .contract import BoolArray, FeaturesLike, FloatArray, IntArray


@dataclass(frozen=True)
class Chains:
    """Vertices (n, 2) of chains one after another; a closed chain does not repeat its first vertex.

    feature, first, last, closed: (chains,), of each its feature, the places of its end vertices, and whether it
    is closed. chain: (n,), the chain of each vertex.
    """

    vertices: FloatArray
    chain: IntArray
    first: IntArray
    last: IntArray
    feature: IntArray
    closed: BoolArray

    @staticmethod
    def of(features: FeaturesLike, wanted: BoolArray) -> Chains:
        """The chains of the wanted features, mask (features,).

        Rings are closed, and none if fewer than three vertices differ from the one before. Lines are closed if
        they end where they begin and have at least three segments.
        """
        owner = np.repeat(np.arange(len(features.rows)), np.diff(features.feature_offsets))
        vertices, part = _distinct(features, wanted[owner])
        rings = features.kind == "polygons"
        first, last, length = _runs(part, len(owner))
        ends = np.flatnonzero(length > 1)
        returns = np.zeros(len(owner), dtype=np.bool_)
        returns[ends] = (vertices[first[ends]] == vertices[last[ends]]).all(axis=1)
        closed = np.ones(len(owner), dtype=np.bool_) if rings else returns & (length >= 4)
        kept = np.ones(len(part), dtype=np.bool_)
        kept[last[returns & closed]] = False
        if rings:
            kept &= ((length - returns) >= 3)[part]
        vertices, part = vertices[kept], part[kept]
        first, last, length = _runs(part, len(owner))
        filled = length > 0
        chain = np.repeat(np.arange(filled.sum()), length[filled])
        return Chains(vertices, chain, first[filled], last[filled], owner[filled], closed[filled])

    def following(self) -> IntArray:
        """The next vertex (n,) of each; that of an open chain's last is itself."""
        following = np.arange(1, len(self.vertices) + 1)
        following[self.last] = np.where(self.closed, self.first, self.last)
        return following

    def is_end(self) -> tuple[BoolArray, BoolArray]:
        """Masks (n,) of the vertices that open chains begin and end with."""
        begins = np.zeros(len(self.vertices), dtype=np.bool_)
        ends = begins.copy()
        begins[self.first[~self.closed]] = True
        ends[self.last[~self.closed]] = True
        return begins, ends


def _distinct(features: FeaturesLike, wanted: BoolArray) -> tuple[FloatArray, IntArray]:
    """Vertices of the wanted parts that differ from the one before, and their parts."""
    coords = np.asarray(features.coords, dtype=np.float64).reshape(-1, 2)
    part = np.repeat(np.arange(len(wanted)), np.diff(features.part_offsets))
    index = np.flatnonzero(wanted[part])
    coords, part = coords[index], part[index]
    differs = np.ones(len(coords), dtype=np.bool_)
    differs[1:] = (coords[1:] != coords[:-1]).any(axis=1) | (part[1:] != part[:-1])
    return coords[differs], part[differs]


def _runs(part: IntArray, count: int) -> tuple[IntArray, IntArray, IntArray]:
    """First and last place, and length, (count,) of each part in an ascending array."""
    length = np.bincount(part, minlength=count).astype(np.int64)
    first = np.cumsum(length) - length
    return first, first + length - 1, length
