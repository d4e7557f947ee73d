"""Nothing needless, map by map: what a frame of each case study ran, beside what that map needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..errors import DecalError
from . import needless, views
from .case_studies import Map, rows_of_maps

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    import decalgl as dg

    from .needless import Way
    from .part import Context, Row

# Of what is prepared, for what a view makes of it: LOOPS draws what is active there from cells of its own.
VIEW_SHARE = {"loops": 1.0}


def rows(context: Context) -> list[Row]:
    """A row for each map and technique."""
    found = rows_of_maps(context, "needless", lambda drawn: list(of_map(drawn)))
    return [{**row, "map": row["scene"]} for row in found]


def of_map(drawn: Map) -> Iterator[Row]:
    """The rows of one map, each technique drawing what it can and static the rest."""
    camera = views.views(drawn)["oblique"]
    bare = Map(drawn.name, drawn.ground, ()).scene().render(camera, needless.SIZE, antialias="none")
    for name, way in needless.WAYS.items():
        if not (way.fills or drawn.has_lines):
            continue
        words = {"scene": drawn.name, "technique": name}
        others = "auto" if way.pixels else "static"  # outlines are as wide as on the screen, too
        try:
            scene = drawn.scene(way.technique if way.fills else others, way.technique, way.pixels)
            frame = scene.render(camera, needless.SIZE, antialias="none", **way.options)
        except DecalError as error:
            yield {**words, "refused": str(error)}
            continue
        needs = _needs(name, way, scene, frame, needless.uploaded(bare))
        yield {**needless.row(name, drawn.name, frame, needs), **words, "shows": sorted(needs.shows)}


def _needs(name: str, way: Way, scene: dg.Scene, frame: dg.Frame, ground: int) -> needless.Needs:
    shows = shown(scene)
    others = frozenset({"static"}) if not way.fills and "polygons" in shows else frozenset()
    features = sum(len(layer.features) * (1 + (layer.kind == "polygons")) for layer in scene.layers)
    uploads = ground + needless.first(name, frame, features)
    uploads += round(VIEW_SHARE.get(name, 0.0) * frame.stats.counts["prepared_bytes"])
    return needless.Needs(needless.FIRST, uploads, needless.passes_of(name) | others, shows=shows)


def shown(scene: dg.Scene) -> frozenset[str]:
    """What a map shows of what programs and arrays are made for; all of plain styles."""
    found = {"holes"} if np.isnan(scene.terrain.z).any() else set()
    for layer in scene.layers:
        found.add(layer.kind)
        for strokes in (layer.stroke, layer.casing):
            if strokes is not None:
                found.add("lines")
                found |= _translucency(strokes.colors)
        if layer.fill is not None:
            found |= _translucency(layer.fill.colors)
    return frozenset(found)


def _translucency(colors: NDArray[np.uint8]) -> set[str]:
    alpha = colors[:, 3]
    return {"translucent"} if ((alpha > 0) & (alpha < 255)).any() else set()
