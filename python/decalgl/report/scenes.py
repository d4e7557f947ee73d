"""The scenes: what they are made of, beside the thesis's own, and the time along camera paths, step by step."""

from __future__ import annotations

import functools
import statistics
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..bench import cameras
from ..bench.measure import draw, ground_ms, timed
from ..errors import DecalError
from . import plots, views
from .case_studies import CASE_STUDIES, SCENES, build, vertices
from .part import Figure, Table, byte_count, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .case_studies import Map
    from .part import Context, Row

TITLE = "Scenes and camera paths"
ABOUT = (
    "Maps in the character of the eight case studies of Zechmeister 2020 (tables 5.1 to 5.3), out of real data; what is"
    " derived from terrain models says so. Paths are driven as the papers did: thirty steps of zoom (figure 5.8),"
    " LOOPS's four phases (figure 16), and a flight low over the ground (Thöny 2018), without anti-aliasing. Each step"
    " is the median of several drawings one after the other, over ground that is drawn once."
)
PATHS = {
    "zoom": "thirty steps of zoom",
    "flight": "in, along, around, through a valley",
    "flyover": "low over the ground",
}
# Exterior and interior rings, lines and all vertices of the thesis's tables 5.1 and 5.2.
THESIS = {
    "HORA IL": (19, 1605, 1624, 246_022),
    "Cologne OSM": (7749, 856, 43_985, 431_625),
    "Wachau": (21_710, 2327, 6307, 463_981),
    "Graz SC": (92_268, 31_380, 29_111, 4_263_029),
    "HORA RLL": (22_330, 659, 2747, 5_768_312),
    "Cologne SA": (446_321, 276, 652_334, 10_922_352),
    "HORA FA": (22_998, 116_296, 116_317, 20_497_780),
    "HORA RC": (63_397, 659, 41_079, 29_342_626),
}


def rows(context: Context) -> list[Row]:
    """Counts and a picture of each scene, and the times along its paths."""
    found: list[Row] = []
    step = context.step
    for name in SCENES[context.size]:
        context.say(name)
        study = CASE_STUDIES[name]
        words = {"scene": name, "like": study.like, "source": study.source, "step": step}
        try:
            drawn = build(name, step)
        except DecalError as error:
            found.append({**words, "refused": str(error)})
            continue
        measured = functools.partial(_measured, context, drawn, words)
        found += context.kept(f"scenes_{name}", measured)
    return found


def _measured(context: Context, drawn: Map, words: Row) -> list[Row]:
    return [{**words, **_counts(context, drawn)}, *_paths(context, drawn)]


def _counts(context: Context, drawn: Map) -> Row:
    """Rings, lines and vertices as the thesis counts them: outlines are lines too."""
    scene = drawn.scene()
    exterior = interior = lines = groups = draws = colors = 0
    for layer in scene.layers:
        rings = len(layer.features.part_offsets) - 1
        outlined = layer.kind == "polygons" and layer.stroke is not None
        groups += 1
        draws += 1 + outlined
        colors += len(np.unique(layer.colors, axis=0))
        if layer.kind == "polygons":
            exterior += len(layer.features)
            interior += rings - len(layer.features)
            lines += rings if outlined else 0
        else:
            lines += rings
    renderer = dg.Renderer(context.picture)
    prepare = timed(lambda: renderer.preprocess(scene))
    renderer.update(views.views(drawn)["oblique"])
    frame = renderer.render()
    return {
        "exterior": exterior,
        "interior": interior,
        "lines": lines,
        "vertices": vertices(scene),
        "groups": groups,
        "draw_calls": draws,
        "colors": colors,
        "samples": int(np.prod(drawn.ground.shape)),
        "prepare_ms": prepare,
        "layers_bytes": frame.stats.bytes.get("static", 0),
        "picture": context.save_picture(f"scene {drawn.name}", frame.image),
    }


def _paths(context: Context, drawn: Map) -> list[Row]:
    target = views.fullest_place(drawn)
    wide = drawn.ground.bounds[2] - drawn.ground.bounds[0]
    steps = context.chosen(3, 30, 30)
    paths = {
        "zoom": cameras.zoom(target, 1.5 * wide, 0.03 * wide, steps),
        "flight": cameras.flight(drawn.ground.bounds, context.chosen(4, 12, 60)),
        "flyover": cameras.flyover(drawn.ground, context.chosen(2, 12, 60)),
    }
    width, height = context.picture
    size = context.chosen(context.picture, (width // 2, height // 2), context.picture)
    ways: dict[str, dict[str, Any]] = {"static": {}, "static bvh": {"renderer": {"index": "bvh"}}}
    if drawn.has_lines:
        ways["dynamic"] = {"lines": "dynamic", "pixels": True}
    found = []
    for way, options in ways.items():
        renderer = dg.Renderer(size, **options.get("renderer", {}))
        renderer.preprocess(drawn.scene("auto", options.get("lines", "auto"), options.get("pixels", False)))
        for path, along in paths.items():
            times, floors = [], []
            for camera in along:
                draw(renderer, camera, "none")
                rounds = [_again(renderer, camera) for _ in range(context.chosen(1, 1, 3))]
                times.append(statistics.median(rounds))
                floors.append(renderer.time_floor())
            found.append(
                {
                    "scene": drawn.name,
                    "technique": way,
                    "path": path,
                    "steps": times,
                    "middle_ms": statistics.median(times),
                    "longest_ms": max(times),
                    "floor_ms": statistics.median(floors),
                }
            )
    return found


def _again(renderer: dg.Renderer, camera: dg.Camera) -> float:
    """Milliseconds of the layers over ground that is drawn already, updates included."""
    renderer.forget(ground=False)
    renderer.update(camera)
    passes = renderer.render().stats.passes
    return float(sum(one["ms"] for one in passes)) - ground_ms(passes)


def figures(rows: Sequence[Row]) -> list[Figure]:
    """The table of scenes, and a plot for each path."""
    scenes = [row["scene"] for row in rows if "vertices" in row]
    flown = {(row["scene"], row["path"]) for row in rows if "path" in row}
    paths = [path_figure(rows, scene, path) for path in PATHS for scene in scenes if (scene, path) in flown]
    return [_scene_table(rows), *paths]


def _scene_table(rows: Sequence[Row]) -> Figure:
    scenes = [row for row in rows if "vertices" in row]
    columns = (
        "scene",
        "as",
        "data",
        "exterior",
        "interior",
        "lines",
        "vertices",
        "draw calls",
        "colours",
        "memory",
    )
    cells = []
    for row in scenes:
        counts = [
            f"{row[name]:,}" for name in ("exterior", "interior", "lines", "vertices", "draw_calls", "colors")
        ]
        cells.append((row["scene"], row["like"], row["source"], *counts, byte_count(row["layers_bytes"])))
        theirs = [f"{count:,}" for count in THESIS[row["like"]]]
        cells.append(("", "", "the thesis's", *theirs, "", "", ""))
    cells += [(row["scene"], row["like"], row["refused"], *[""] * 7) for row in rows if "refused" in row]
    return Figure(
        "Scenes",
        "Counts as in the thesis: outlines are lines too, and their vertices count once more. Sizes come in steps"
        " (case_studies.py); the largest reach tens of millions of vertices.",
        table=Table(columns, cells),
        pictures={f"{row['scene']}: {row['source']}": row["picture"] for row in scenes},
    )


def path_figure(rows: Sequence[Row], scene: str, path: str) -> Figure:
    """The times along a path through a scene, for each technique."""
    ways = {
        row["technique"]: row["steps"] for row in rows if (row["scene"], row.get("path")) == (scene, path)
    }
    lines = {way: list(enumerate(times, start=1)) for way, times in ways.items()}
    middles = ", ".join(f"{way} {number(statistics.median(times))} ms" for way, times in ways.items())
    return Figure(
        f"{scene}: {PATHS[path]}",
        f"Milliseconds of a frame without terrain and composing, step by step. Medians: {middles}.",
        plots.curves(lines, f"step of the {path}", "ms", log="y", marks=False),
    )
