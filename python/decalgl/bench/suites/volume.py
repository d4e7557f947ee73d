"""Shadow volumes beside the static index and the thesis's: its figure 5.5, with one colour and with hundreds.

memory     bytes of prepared data and of GL objects
prepare    milliseconds; cutting polygons into triangles is in them
draw       milliseconds of the layers' passes at each view, without anti-aliasing
"""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING, Any

import decalgl as dg

from ..measure import drawing, interleaved, timed
from ..workload import add_contours

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload

# The index of static layers; None: volumes.
WAYS: dict[str, str | None] = {"static": "grid", "bvh": "bvh", "volume": None}
CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "one colour": ("isolines", {}),
    "hundreds of colours": ("isolines", {"cmap": "viridis"}),
    "iso-bands": ("iso-bands", {}),
}


def measure(work: Workload, records: Records) -> None:
    size = next(iter(work.sizes))
    for case, (kind, looks) in CASES.items():
        name = f"{kind} {size}" if case == kind else f"{kind} {size}, {case}"
        work.say(name)
        renderers = {way: _prepared(work, records, name, kind, looks, way) for way in WAYS}
        for view, camera in work.views.items():
            drawn = [drawing(renderer, camera, "none", way) for way, renderer in renderers.items()]
            times = interleaved(work.runs, *drawn)
            for way in WAYS:
                records.at(name, view, way).update(draw_ms=times[f"{way}_ms"])
        for way in WAYS:
            each = [records.at(name, view, way)["draw_ms"] for view in work.views]
            records.at(name, None, way).update(draw_ms=statistics.median(each))


def _prepared(
    work: Workload, records: Records, name: str, kind: str, looks: dict[str, Any], way: str
) -> dg.Renderer:
    """A renderer of the scene, after what it takes to prepare went into the records."""
    arrays = work.contours(kind, next(iter(work.sizes)))
    if "cmap" in looks:
        looks = {**looks, "color": None, "column": arrays["coordinates"][arrays["offsets"][:-1], 0]}
    scene = dg.Scene(work.ground)
    index = WAYS[way]
    technique = dg.Static() if index else dg.Volume(groups="colors")
    add_contours(scene, kind, arrays, technique=technique, **looks)
    renderer = dg.Renderer(size=work.picture, index=index or "grid", antialias="none")
    prepare = timed(lambda: renderer.preprocess(scene))
    renderer.update(next(iter(work.views.values())))
    stats = renderer.render().stats
    pass_name = "static_bvh" if index == "bvh" else technique.name
    records.at(name, None, way).update(
        prepare_ms=prepare, bytes=stats.bytes[pass_name], groups=stats.counts.get("volume_groups", 0.0)
    )
    return renderer
