"""One ring of millions of vertices with thousands of holes.

ring    preparing it ÷ preparing the small rings of iso-bands, by vertices
S       as at the other views
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import decalgl as dg

from .. import cameras, shapes
from ..measure import preparing, preprocessing, vertices_of
from .views import at_view

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload


def measure(work: Workload, records: Records) -> None:
    vertices, holes = work.ring
    name = f"ring of {vertices:,} vertices"
    work.say(f"{name} with {holes:,} holes")
    table = shapes.spiked_ring(work.ground.bounds, vertices, holes)
    scene = dg.Scene(work.ground)
    scene.add_polygons(table, color=["seagreen"])
    bands = work.scene("iso-bands", work.middle)
    prepared = preprocessing(scene, work.runs, preparing(bands, "bands", {}))
    per_vertex = prepared["preprocess_ms"] / prepared["vertices"]
    records.at(name, None).update(
        holes=holes,
        **prepared,
        ring=per_vertex / (prepared["bands_ms"] / vertices_of(bands)),
    )
    renderer = work.renderer(scene)
    views = {"overview": work.views["overview"], "worst": cameras.worst(work.ground, table.coords)}
    for view, camera in views.items():
        records.at(name, view).update(at_view(renderer, camera, work.runs))
