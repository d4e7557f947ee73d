"""Nothing needless: the passes, programs, GL objects and bytes of small scenes, beside those that each needs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..bench.suites.dynamic import STEPS
from .part import Figure, Table, byte_count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from .part import Context, Row

TITLE = "Nothing needless"
ABOUT = (
    "Two lines over a hill, drawn by each technique in one style after another, then hidden, out of view, seen again"
    " unchanged, from elsewhere and in another colour. What ran is listed beside what that takes; needless is what ran"
    " beyond it, and the tests fail where that is not empty. Bytes are those of the technique, prepared data and GL"
    " objects together; uploads are those of the frame."
)
SIZE = (96, 64)
NEAR = dg.Camera.look_at((50.0, -80.0, 60.0), (50.0, 50.0, 0.0))
ELSEWHERE = dg.Camera.look_at((60.0, -60.0, 70.0), (50.0, 50.0, 0.0))
SKY = dg.Camera.look_at((50.0, 50.0, 60.0), (50.0, 90.0, 140.0))


@dataclass(frozen=True)
class Way:
    """A technique and what the renderer is asked for. name: that its passes, programs and memory go by."""

    technique: dg.Technique
    name: str
    options: Mapping[str, Any] = field(default_factory=dict)


WAYS = {
    "static": Way(dg.Static(), "static"),
    "static bvh": Way(dg.Static(), "static_bvh", {"index": dg.BvhIndex(cells=64)}),
    "dynamic bins": Way(dg.Dynamic(method="bins"), "dynamic"),
    "dynamic lists": Way(dg.Dynamic(method="lists"), "dynamic"),
    "loops": Way(dg.Loops(), "loops"),
    "volume": Way(dg.Volume(), "volume"),
    "clipmap": Way(dg.Clipmap(), "clipmap"),
    "distance_field": Way(dg.DistanceField(), "distance_field"),
}
PIXELS = ("dynamic bins", "dynamic lists")  # draw widths on the screen
STYLES: dict[str, dict[str, Any]] = {
    "one colour": {},
    "two colours": {"color": ["crimson", "navy"]},
    "translucent": {"alpha": 0.5},
    "bevels": {"corner": "bevel", "cap": "butt"},
    "dashes": {"dash": (10.0, 5.0)},
}
# Flags of programs, and the styles that they are for.
FLAGS = {
    "TRANSLUCENT": {"translucent"},
    "PATTERNS": {"dashes"},
    "STYLED": {"dashes"},
    "JOINED": {"bevels", "dashes"},
    "CORNERS": {"bevels", "dashes"},
    "STYLES": {"bevels", "dashes"},
}
# Flags for what none of these pictures shows.
OTHER_FLAGS = (
    *("RINGS", "FILLS", "BANDS", "HATCHES", "SLOPES", "HIDDEN", "LENS", "IDS", "HOLES", "RAMP", "THOENY"),
    *(
        "COVERAGE",
        "CLASSES",
        "CELLS",
        "POINTS",
        "LEVELS",
        "MULTISAMPLED",
        "GATHERED",
        "SAMPLE",
    ),
)
LAYER_PASSES = (
    "static",
    "static_bvh",
    "dynamic",
    "loops",
    "volume",
    "clipmap",
    "distance_field",
    "fields",
    "stylize",
)
# What follows from the view and the lines' places and widths, whatever their colours.
VIEW_PASSES = ("fields", *(f"dynamic: {step}" for step in STEPS))


@dataclass(frozen=True)
class Needs:
    """What a frame takes.

    passes: beside those of the layers. uploads: bytes that buffers and textures need to take. layers: whether the
    layers are drawn at all. view: whether that follows from the view anew. style: what flags are for.
    """

    passes: frozenset[str]
    uploads: int
    layers: bool = True
    view: bool = True
    style: str = "one colour"


GROUND = frozenset({"terrain", "compose", "readback"})
FIRST = GROUND | {"upload"}
# Bytes: what shaders know of a view and of its tiles; a feature's looks and place, wherever they are held; tables and
# grids that do not depend on the scene.
VIEW_BYTES, LOOK_BYTES = 1024, 64
FIXED_BYTES = {"distance_field": 1 << 20, "loops": 40_000}
# Of what each view makes anew.
FIXED_VIEW_BYTES = {"loops": FIXED_BYTES["loops"]}
# A segment's ends and a feature's looks, in main memory and on the GPU.
SEGMENT_BYTES, FEATURE_BYTES = 2 * 16, 2 * 16
FEATURES = 2  # of the small scenes
MANY, LONG = 1000, 100  # lines, and segments of each, of the scene that bytes are counted on
WEIGHED = (
    f"{MANY * LONG:,} segments of {MANY} lines: what a technique holds, beside {SEGMENT_BYTES} bytes for each segment"
    f" and {FEATURE_BYTES} for each line, in main memory and on the GPU together. Clipmaps hold tiles, lists and"
    " distance fields pixels, whatever the scene."
)


def rows(_context: Context) -> list[Row]:
    """A row for each technique and state: what ran, and what of it was `needless`."""
    return [row for name in WAYS for row in states(name)]


def states(name: str) -> Iterator[Row]:
    """The rows of one technique."""
    bare = _draw(name, _ground())
    ground = _uploaded(bare)

    def first(frame: dg.Frame) -> int:
        """What is prepared, once, beside the ground."""
        prepared = int(frame.stats.counts["prepared_bytes"])
        return ground + prepared + LOOK_BYTES * FEATURES + VIEW_BYTES + FIXED_BYTES.get(name, 0)

    yield _row(name, "no layers", bare, Needs(FIRST, ground, layers=False))
    for style, looks in STYLES.items():
        try:
            frame = _draw(name, _scene(name, **looks))
        except (dg.StyleError, dg.UnsupportedError):
            continue
        yield _row(name, style, frame, Needs(FIRST, first(frame), style=style))
    yield _row(name, "hidden", _draw(name, _scene(name, alpha=0.0)), Needs(FIRST, ground, layers=False))
    sky = _draw(name, _scene(name), SKY)
    outside = frozenset({"upload", "compose", "readback"})
    yield _row(name, "nothing in view", sky, Needs(outside, first(sky), layers=False))
    yield from _changes(name)
    yield _weighed(name)


def _changes(name: str) -> Iterator[Row]:
    renderer = dg.Renderer(SIZE, antialias="none", **WAYS[name].options)
    renderer.preprocess(_scene(name))
    view = VIEW_BYTES + FIXED_VIEW_BYTES.get(name, 0)

    def frame(camera: dg.Camera = ELSEWHERE) -> dg.Frame:
        renderer.update(camera)
        return renderer.render()

    frame(NEAR)
    yield _row(name, "another camera", frame(), Needs(GROUND, view))
    yield _row(name, "unchanged", frame(), Needs(frozenset(), 0, layers=False))
    renderer.restyle("ways", color="navy")
    looks = frozenset({"upload", "compose", "readback"})
    needs = Needs(looks, view + LOOK_BYTES * FEATURES, view=False)
    yield _row(name, "another colour", frame(), needs)


def _weighed(name: str) -> Row:
    """Bytes that are held for many segments, beside those of their ends and looks."""
    turn = np.linspace(0.0, 20.0, LONG + 1) + np.arange(MANY)[:, None]
    start = np.random.default_rng(3).uniform(10.0, 90.0, (MANY, 1, 2))
    coords = (
        start + np.stack([np.cos(turn), np.sin(turn)], axis=-1) * np.linspace(1.0, 9.0, LONG + 1)[:, None]
    )
    each = np.arange(MANY + 1)
    table = dg.FeatureTable("lines", coords.reshape(-1, 2), (LONG + 1) * each, each, each[:-1])
    frame = _draw(name, _scene(name, table, width=0.2 if name not in PIXELS else 1.0))
    needed = MANY * (LONG * SEGMENT_BYTES + FEATURE_BYTES)
    row = _row(name, "many segments", frame, Needs(FIRST, _uploaded(frame)))
    return {**row, "needed_bytes": needed, "times": row["held_bytes"] / needed}


def _row(name: str, state: str, frame: dg.Frame, needs: Needs) -> Row:
    stats = frame.stats
    passes = [one["name"] for one in stats.passes]
    memory = WAYS[name].name
    return {
        "scene": state,
        "technique": name,
        "passes": passes,
        "programs": stats.variants,
        "objects": sorted(each for each in stats.objects if each.startswith(f"{memory}:")),
        "held_bytes": stats.bytes.get(memory, 0),
        "uploaded_bytes": _uploaded(frame),
        "needed_upload_bytes": needs.uploads,
        "needless": surplus(passes, stats.variants, _uploaded(frame), stats.objects, needs),
    }


def _uploaded(frame: dg.Frame) -> int:
    return int(frame.stats.counts["uploaded_bytes"])


def surplus(
    passes: Sequence[str], programs: Sequence[str], uploads: int, objects: Mapping[str, int], needs: Needs
) -> list[str]:
    """What ran beyond the needs, in words."""
    found = []
    for each in passes:
        of_layers = each.split(":")[0].split(" ")[0] in LAYER_PASSES
        needed = needs.layers and (needs.view or each not in VIEW_PASSES)
        if not (needed if of_layers else each in needs.passes):
            found.append(f"pass {each}")
    for program in programs:
        flags = program.rstrip("]").split("[")[1].split(",") if "[" in program else []
        found += [f"{program}: {flag}" for flag in flags if not _is_for(flag, needs.style)]
    if uploads > needs.uploads:
        found.append(f"{uploads - needs.uploads} of {uploads} bytes uploaded")
    is_first = "upload" in passes
    if not needs.layers and is_first and "frame: overlay" in objects:
        found.append("an overlay")
    return found


def _is_for(flag: str, style: str) -> bool:
    return flag not in OTHER_FLAGS and style in FLAGS.get(flag, {style})


def _ground() -> dg.Scene:
    x = np.linspace(-1.0, 1.0, 21)
    hill = 20.0 * np.exp(-4.0 * (x[None, :] ** 2 + x[:, None] ** 2))
    return dg.Scene(dg.Terrain(hill.astype(np.float32), 0.0, 100.0, 5.0, 5.0))


def _two_lines() -> dg.FeatureTable:
    lines = np.array([(5.0, 50.0), (50.0, 20.0), (95.0, 60.0), (20.0, 5.0), (30.0, 95.0)])
    return dg.FeatureTable("lines", lines, np.array([0, 3, 5]), np.arange(3), np.arange(2))


def _scene(name: str, table: dg.FeatureTable | None = None, **looks: Any) -> dg.Scene:
    scene = _ground()
    units = "px" if name in PIXELS else "m"
    keywords: dict[str, Any] = {"color": "crimson", "width": 4.0, "width_units": units, **looks}
    scene.add_lines(table or _two_lines(), name="ways", technique=WAYS[name].technique, **keywords)
    return scene


def _draw(name: str, scene: dg.Scene, camera: dg.Camera = NEAR) -> dg.Frame:
    return scene.render(camera, SIZE, antialias="none", **WAYS[name].options)


def figures(rows: Sequence[Row]) -> list[Figure]:
    """What ran, in a table for each technique, and what of it was needless."""
    needless = [[row["technique"], row["scene"], each] for row in rows for each in row["needless"]]
    summary = f"Of {len(rows)} states, {len({(a, b) for a, b, _ in needless})} ran what they do not need."
    table = Table(["technique", "state", "needless"], needless) if needless else None
    names = list(dict.fromkeys(row["technique"] for row in rows))
    weighed = [
        [
            row["technique"],
            byte_count(row["held_bytes"]),
            byte_count(row["needed_bytes"]),
            f"{row['times']:.1f}",
        ]
        for row in rows
        if "times" in row
    ]
    columns = ["technique", "held", "needed", "times"]
    return [
        Figure("What was needless", summary, table=table),
        Figure("Bytes of many segments", WEIGHED, table=Table(columns, weighed)),
        *(_technique_table(rows, name) for name in names),
    ]


def _technique_table(rows: Sequence[Row], name: str) -> Figure:
    shown: Callable[[Sequence[str]], str] = ", ".join
    lines = [
        [
            row["scene"],
            shown(row["passes"]) or "none",
            shown([each for each in row["programs"] if each.split("[")[0] not in ("terrain", "compose")])
            or "none",
            shown([each.split(": ")[1] for each in row["objects"]]) or "none",
            byte_count(row["held_bytes"]),
            byte_count(row["uploaded_bytes"]),
            byte_count(row["needed_upload_bytes"]),
        ]
        for row in rows
        if row["technique"] == name
    ]
    columns = ["state", "passes", "programs of the layers", "objects", "held", "uploaded", "needed at most"]
    return Figure(f"What {name} ran", "Programs are those compiled so far.", table=Table(columns, lines))
