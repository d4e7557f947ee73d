"""Error against run time: every scene, view, technique and setting, and what to choose when."""

from __future__ import annotations

import functools
import statistics
from typing import TYPE_CHECKING

import decalgl as dg

from ..bench.measure import LAYER_PASSES, drawing, floor, interleaved, timed
from ..errors import DecalError
from . import choices, plots, views
from .accuracy import MOVED, Judge
from .case_studies import rows_of_maps
from .part import Figure, Table, byte_count, number
from .settings import settings

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .case_studies import Map
    from .part import Context, Row
    from .settings import Setting

TITLE = "Error against run time"
TOGETHER = 6  # renderers that are held at once
ERROR = "error at borders (rms, of 1)"  # of the axes
PATIENCE = 0.3  # seconds: frames that take longer need no round before those that count
ABOUT = (
    "Each point is a technique with a setting. Time is that of a whole frame, and of what it adds to"
    " terrain and composing, both divided by the floor, a pass that reads depth and writes a colour for every"
    " pixel; the first frame of a clipmap paints tiles, which its spread tells. The error is the root mean square of"
    " the difference to the reference, of 1, over the pixels of a crop that"
    " a border passes (an edge's), over all pixels of the crop (the image's), and of the coverage alone. Dynamic lines"
    " are as wide as on the screen and are compared with a reference that draws them so; techniques that draw only"
    " lines leave polygons to static, and are left out where there are no lines."
)


def rows(context: Context) -> list[Row]:
    """Draws every scene by every setting; one that does not draw it is a row with what it says."""
    return rows_of_maps(context, "error_over_time", functools.partial(_of_scene, context))


def _of_scene(context: Context, drawn: Map) -> list[Row]:
    cameras = views.chosen(context, drawn)
    judge = Judge(drawn, cameras, context.picture, context.crop)
    by_key: dict[tuple[str, str, str], Row] = {}
    drawable: list[Setting] = []
    for setting in settings(context):
        if setting.polygons != setting.lines and not drawn.has_lines:
            continue
        words = {"scene": drawn.name, "technique": setting.group, "setting": setting.name}
        try:
            judged = judge.judge(setting)
        except DecalError as error:
            by_key[setting.group, setting.name, ""] = {**words, "refused": str(error).split(". ")[0]}
            continue
        drawable.append(setting)
        for view, errors in judged.items():
            by_key[setting.group, setting.name, view] = {**words, "view": view, **errors}
    for view in cameras:
        true = context.save_picture(f"{drawn.name} {view} reference", judge.true_picture(view))
        by_key["reference", "", view] = {
            "scene": drawn.name,
            "technique": "reference",
            "view": view,
            "picture": true,
        }
    for view, errors in judge.judge_ground().items():
        by_key["terrain", "", view] = {"scene": drawn.name, "technique": "terrain", "view": view, **errors}
    context.say(f"{drawn.name}: times")
    for batch in _batches(drawable):
        _time(context, drawn, cameras, batch, by_key)
    return list(by_key.values())


def _batches(drawable: Sequence[Setting]) -> Iterable[list[Setting]]:
    """Settings whose renderers are held together: those of one preparing side by side."""
    keys = list(dict.fromkeys(one.prepared for one in drawable))
    for first in range(0, len(keys), TOGETHER):
        some = keys[first : first + TOGETHER]
        yield [one for one in drawable if one.prepared in some]


def _time(
    context: Context,
    drawn: Map,
    cameras: dict[str, dg.Camera],
    batch: list[Setting],
    by_key: dict[tuple[str, str, str], Row],
) -> None:
    renderers: dict[str, dg.Renderer] = {}
    prepare: dict[str, float] = {}
    for setting in batch:
        if setting.prepared not in renderers:
            renderer = dg.Renderer(context.picture, **setting.renderer)
            scene = drawn.scene(setting.polygons, setting.lines, setting.pixels)
            prepare[setting.prepared] = timed(lambda made=renderer, of=scene: made.preprocess(of))  # type: ignore[misc]
            renderers[setting.prepared] = renderer
    for view, camera in cameras.items():
        measures = [
            drawing(
                renderers[setting.prepared],
                camera,
                setting.antialias,
                f"{setting.group}/{setting.name}",
                functools.partial(_keep, context, by_key[setting.group, setting.name, view]),
            )
            for setting in batch
        ]
        floor_of_all = floor(renderers[batch[0].prepared])
        times = interleaved(context.runs, *measures, floor_of_all, patience=PATIENCE)
        for setting in batch:
            name = f"{setting.group}/{setting.name}"
            row = by_key[setting.group, setting.name, view]
            for short, long in (("frame_ms", f"{name}_frame_ms"), ("floor_ms", "floor_ms")):
                row[short] = times[long]
                if f"{long}_spread" in times:
                    row[f"{short}_spread"] = times[f"{long}_spread"]
            row["frame"] = row["frame_ms"] / row["floor_ms"]
            row["layers"] = (row["frame_ms"] - times[f"{name}_ground_ms"]) / row["floor_ms"]
            row["prepare_ms"] = prepare[setting.prepared]


def _keep(context: Context, row: Row, frame: dg.Frame) -> None:
    """Saves the picture of the first frame, and tells how many bytes its layers held, prepared data and GL objects."""
    if "picture" not in row:
        name = " ".join(row[word] for word in ("scene", "view", "technique", "setting"))
        row["picture"] = context.save_picture(name, frame.image)
        held = frame.stats.bytes.items()
        row["layers_bytes"] = sum(count for name, count in held if name in LAYER_PASSES)


def figures(rows: Sequence[Row]) -> list[Figure]:
    """Plots over all scenes and for each, and tables."""
    drawn = [row for row in rows if "frame" in row]
    found = [*over_all(drawn), choices.figure(drawn), *_approaches(drawn), *_ground(rows)]
    for scene in dict.fromkeys(row["scene"] for row in drawn):
        own = [row for row in drawn if row["scene"] == scene]
        found.append(_time_plot(scene, own))
        found.append(_memory_plot(scene, own))
        found.append(_table(scene, own, [row for row in rows if row["scene"] == scene]))
    refused = [row for row in rows if "refused" in row]
    if refused:
        cells = [
            (row["scene"], row.get("technique", ""), row.get("setting", ""), row["refused"])
            for row in refused
        ]
        table = Table(("scene", "technique", "setting", "error"), cells)
        found.append(Figure("What was refused", "What a technique does not draw it refuses.", table=table))
    return found


def over_all(rows: Sequence[Row]) -> list[Figure]:
    """Error over time and over memory: one point a setting, medians over scenes and views."""
    settings: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        settings.setdefault((row["technique"], row["setting"]), []).append(row)
    times, bytes_held = [], []
    for (group, setting), own in settings.items():
        middle = sorted(own, key=lambda row: row["edge_rms"])[len(own) // 2]
        error = statistics.median(row["edge_rms"] for row in own)
        label = f"{group}, {setting}"
        time = statistics.median(row["frame"] for row in own)
        times.append(plots.Point(time, error, group, label, middle["picture"]))
        held = statistics.median(row["layers_bytes"] for row in own)
        if held:
            bytes_held.append(plots.Point(held / 1e6, error, group, label, middle["picture"]))
    caption = (
        "Medians over all scenes and views that a setting draws; each point leads to the picture whose error is the"
        " middle one. The dashed line joins those that no other beats in both."
    )
    return [
        Figure("All scenes", caption, plots.scatter(times, "frame ÷ floor", ERROR)),
        Figure("All scenes: error over memory", caption, plots.scatter(bytes_held, "MB", ERROR)),
    ]


def _approaches(rows: Sequence[Row]) -> list[Figure]:
    """Zechmeister 2020, figure 5.5: volumes, static decals and dynamic lines, scene by scene, without anti-aliasing."""
    plain = [row for row in rows if row["setting"] in ("none", "tiles, none", "lists, none")]
    columns = {
        "memory": ("layers_bytes", 1e6, "MB"),
        "update": ("prepare_ms", 1.0, "ms"),
        "render": ("layers", 1.0, "÷ floor"),
    }
    found = []
    for name, (column, unit, label) in columns.items():
        groups = {}
        for scene in dict.fromkeys(row["scene"] for row in plain):
            ways: dict[str, list[float]] = {}
            for row in plain:
                if row["scene"] == scene:
                    way = (
                        row["technique"]
                        if row["setting"] == "none"
                        else f"dynamic {row['setting'].split(',')[0]}"
                    )
                    ways.setdefault(way, []).append(row[column] / unit)
            groups[scene] = {way: statistics.median(values) for way, values in ways.items()}
        caption = "Shadow volumes, static decals by our index and by the thesis's, dynamic lines by tiles and by lists."
        found.append(Figure(f"Figure 5.5: approaches, {name}", caption, plots.bars(groups, label, log="y")))
    return found


def _ground(rows: Sequence[Row]) -> list[Figure]:
    """What the terrain's own level of detail adds to the error, which is measured on all its samples."""
    own = [row for row in rows if "ground_rms" in row]
    if not own:
        return []
    cells = [
        (row["scene"], row["view"], f"{row['ground_rms']:.4f}", f"{row['ground_moved']:.2%}") for row in own
    ]
    caption = (
        "Layers with coverage over the terrain's level of detail, with which times are taken, beside those over all of"
        f" its samples, on which errors are measured. Moved are pixels that differ by more than {MOVED:g}."
    )
    columns = ("scene", "view", "whole picture (rms)", "pixels moved")
    return [Figure("What the terrain's level of detail adds", caption, table=Table(columns, cells))]


def _time_plot(scene: str, rows: Sequence[Row]) -> Figure:
    points = [
        plots.Point(
            row["frame"],
            row["edge_rms"],
            row["technique"],
            f"{row['setting']}, {row['view']}",
            row["picture"],
        )
        for row in rows
    ]
    return Figure(
        f"{scene}: error over time",
        "Each point leads to its picture.",
        plots.scatter(points, "frame ÷ floor", ERROR),
    )


def _memory_plot(scene: str, rows: Sequence[Row]) -> Figure:
    points = [
        plots.Point(
            row["layers_bytes"] / 1e6, row["edge_rms"], row["technique"], row["setting"], row["picture"]
        )
        for row in rows
        if row["layers_bytes"]
    ]
    return Figure(
        f"{scene}: error over memory",
        "Prepared data and GL objects of the layers, in megabytes.",
        plots.scatter(points, "MB", ERROR),
    )


def _table(scene: str, rows: Sequence[Row], every: Sequence[Row]) -> Figure:
    columns = (
        "view",
        "technique",
        "setting",
        "frame ÷ floor",
        "layers ÷ floor",
        "frame",
        "prepare",
        "memory",
        "borders",
        "p99",
        "image",
        "coverage",
        "leak",
    )
    cells = [
        (
            row["view"],
            row["technique"],
            f"[{row['setting']}]({row['picture']})",
            number(row["frame"]),
            number(row["layers"]),
            f"{number(row['frame_ms'])} ms ± {100 * row.get('frame_ms_spread', 0.0):.0f} %",
            f"{number(row['prepare_ms'])} ms",
            byte_count(row["layers_bytes"]),
            f"{row['edge_rms']:.4f}",
            f"{row['edge_p99']:.3f}",
            f"{row['image_rms']:.4f}",
            f"{row['coverage_rms']:.4f}",
            f"{row['leak']:.3f}",
        )
        for row in sorted(rows, key=lambda one: (one["view"], one["edge_rms"]))
    ]
    true = [row for row in every if row.get("technique") == "reference"]
    pictures = {f"{row['view']}, the crop by the reference": row["picture"] for row in true}
    return Figure(
        f"{scene}: all settings", "Sorted by the error at borders.", None, Table(columns, cells), pictures
    )
