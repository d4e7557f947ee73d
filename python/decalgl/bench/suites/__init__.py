"""The questions that the benchmark asks, each a module with a function `measure(work, records)`.

prepare      P, bytes a segment: what does an index cost?
views        S, S_levels, AA, levels: what does a picture cost, from everywhere?
files        open, levels_made: what do opening a saved scene and levels of detail cost?
memory       peak_memory: how much does preparing take beside the input?
scale        scale: does a larger map cost more at the same view?
indexes      bvh_grid: how much faster is the grid than the papers' trees?
layers       layer, empty: what does one more layer cost, and none?
interior     interior: what does the inside of a large polygon cost?
stacks       opaque_stack: what do thousands of overlapping polygons cost?
ring         ring: what does one enormous ring cost?
interaction  restyle, filter, edit, lens, reorder: what do changes of a prepared map cost?
dynamic      D, update_share: what do lines of constant width on the screen cost, by tiles and by lists?
distance_field   sets, drawn, field_memory: what do networks by distance fields cost?
loops        loops_detail, loops_static, loops_seg_time, loops_fitted_time ...: what do levels of detail save?
styles       style, mode: what do styles and modes of anti-aliasing cost beside plain strokes and fills?
clipmap      memory, generate, width, tiles, picture: what do the solutions for lines in textures cost?
volume       memory, prepare, draw: what do shadow volumes cost, with one colour and with hundreds?
artefacts    figure: how far do the artefacts go that papers name?
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import (
    artefacts,
    clipmap,
    distance_field,
    dynamic,
    files,
    indexes,
    interaction,
    interior,
    layers,
    loops,
    memory,
    prepare,
    ring,
    scale,
    stacks,
    styles,
    views,
    volume,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..records import Records
    from ..workload import Workload

SUITES: dict[str, Callable[[Workload, Records], None]] = {
    "prepare": prepare.measure,
    "views": views.measure,
    "files": files.measure,
    "memory": memory.measure,
    "scale": scale.measure,
    "indexes": indexes.measure,
    "layers": layers.measure,
    "interior": interior.measure,
    "stacks": stacks.measure,
    "ring": ring.measure,
    "interaction": interaction.measure,
    "dynamic": dynamic.measure,
    "styles": styles.measure,
    "clipmap": clipmap.measure,
    "volume": volume.measure,
    "distance_field": distance_field.measure,
    "loops": loops.measure,
    "artefacts": artefacts.measure,
}
