"""The indexes in which static layers are looked up, pixel by pixel.

"grid"       short lists in small cells: the default, and the faster one
"bvh"        Zechmeister 2020: trees of boxes in a coarser grid, quad-trees of polygons
"thoeny"     Thöny et al. 2018, of the same parts: segments along a Hilbert curve, the nearest line is seen
BvhIndex()   the last two with other parameters
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from .errors import InputError

INDEXES = ("grid", "bvh", "thoeny")
RANGES = {"cells": (1, 4096), "leaf_capacity": (1, 1024), "depth_limit": (0, 16)}
CHOICES = {
    "segment_order": ("importance", "hilbert"),
    "composition": ("order", "nearest"),
    "passes": ("layer", "kind"),
}


@dataclass(frozen=True)
class BvhIndex:
    """Parameters of the published structures.

    cells: along each side of the grid over a layer, 1 to 4096.
    leaf_capacity: edges in a leaf of a polygon's quad-tree above its depth limit, 1 to 1024.
    depth_limit: levels below the root of a quad-tree, 0 to 16.
    segment_order: of a cell's segments, "importance" (draw order, topmost first) or along a "hilbert" curve.
    composition: "order" lays the lines that cover a point over each other; "nearest" shows only the one whose
        centre line is nearest, of equally near ones the topmost. Polygons are always laid over each other.
    passes: "layer" draws each layer in a pass of its own; "kind" draws neighbouring layers of one kind at once.

    Ids are those of what is seen; `frame.pick` lists every feature in draw order. Translucent lines with
    segment_order="hilbert" need composition="nearest": else preprocessing raises UnsupportedError.
    Raises InputError for values out of range.
    """

    cells: int = 500
    leaf_capacity: int = 8
    depth_limit: int = 8
    segment_order: str = "importance"
    composition: str = "order"
    passes: str = "layer"

    def __post_init__(self) -> None:
        for name, (least, most) in RANGES.items():
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
                raise InputError(
                    f"BvhIndex: {name} must be a whole number from {least} to {most}, but it is {value!r}."
                )
        for name, known in CHOICES.items():
            value = getattr(self, name)
            if value not in known:
                raise InputError(
                    f"BvhIndex: {name} must be {known[0]!r} or {known[1]!r}, but it is {value!r}."
                )

    @classmethod
    def thoeny(cls) -> BvhIndex:
        """256 x 256 clusters, sorted along a Hilbert curve, of which a pixel shows the nearest line."""
        return cls(cells=256, segment_order="hilbert", composition="nearest")

    def to_dict(self) -> dict[str, Any]:
        """The parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def resolve_index(index: str | BvhIndex) -> tuple[str, BvhIndex]:
    """The core's name of an index, and its parameters. Raises InputError."""
    if isinstance(index, BvhIndex):
        return "bvh", index
    if index not in INDEXES:
        raise InputError(
            f"There is no index={index!r}; choose 'grid', 'bvh', 'thoeny' or a decalgl.BvhIndex(...)."
        )
    return ("grid" if index == "grid" else "bvh"), (BvhIndex.thoeny() if index == "thoeny" else BvhIndex())
