"""Nothing needless: the passes, programs, GL objects and bytes of small scenes, beside those that each needs.

needless_maps.py asks the same of the case studies.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from ..bench.suites.dynamic import STEPS
from .part import Figure, Table, byte_count

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from .part import Context, Row

TITLE = "Nothing needless"
ABOUT = (
    "Each case study drawn by each technique; and two lines over a hill in one style after another, then hidden, out of"
    " view, seen again unchanged, from elsewhere and in another colour. What ran is listed beside what that takes;"
    " needless is what ran beyond it, and the tests fail where that is not empty. Bytes are those of the technique,"
    " prepared data and GL objects together; uploads are those of the frame, which needs what was prepared once."
)
SIZE = (96, 64)
NEAR = dg.Camera.look_at((50.0, -80.0, 60.0), (50.0, 50.0, 0.0))
ELSEWHERE = dg.Camera.look_at((60.0, -60.0, 70.0), (50.0, 50.0, 0.0))
SKY = dg.Camera.look_at((50.0, 50.0, 60.0), (50.0, 90.0, 140.0))


@dataclass(frozen=True)
class Way:
    """A technique and what the renderer is asked for.

    name: that its passes, programs and memory go by. passes: further ones. fills: whether it draws polygons.
    pixels: whether its widths are those on the screen.
    """

    technique: dg.Technique
    name: str
    options: Mapping[str, Any] = field(default_factory=dict)
    passes: tuple[str, ...] = ()
    fills: bool = True
    pixels: bool = False


WAYS = {
    "static": Way(dg.Static(), "static"),
    "static bvh": Way(dg.Static(), "static_bvh", {"index": dg.BvhIndex(cells=64)}),
    "dynamic bins": Way(dg.Dynamic(method="bins"), "dynamic", fills=False, pixels=True),
    "dynamic lists": Way(dg.Dynamic(method="lists"), "dynamic", fills=False, pixels=True),
    "loops": Way(dg.Loops(), "loops"),
    "volume": Way(dg.Volume(), "volume"),
    "clipmap": Way(dg.Clipmap(), "clipmap"),
    "distance_field": Way(dg.DistanceField(), "distance_field", passes=("fields", "stylize"), fills=False),
}
STYLES: dict[str, dict[str, Any]] = {
    "one colour": {},
    "two colours": {"color": ["crimson", "navy"]},
    "translucent": {"alpha": 0.5},
    "bevels": {"corner": "bevel", "cap": "butt"},
    "dashes": {"dash": (10.0, 5.0)},
}
# What of these a picture shows, beside lines.
SHOWN = {"translucent": "translucent", "bevels": "corners", "dashes": "patterns"}
# Flags of programs, and what a picture shows of which one thing is reason enough. A flag that is neither here nor among
# the free ones is taken for needless.
FLAGS = {
    "LINES": {"lines"},
    "STROKES": {"lines"},
    "RINGS": {"polygons"},
    "FILLS": {"polygons"},
    "TRANSLUCENT": {"translucent"},
    "CORNERS": {"corners", "patterns"},
    "JOINED": {"corners", "patterns"},
    "STYLES": {"corners", "patterns"},
    "STYLED": {"patterns"},
    "PATTERNS": {"patterns"},
    "LENGTHS": {"patterns"},
    "PHASES": {"patterns"},
    "HOLES": {"holes"},
}
FREE = ("ONE_COLOR", "ONE_WIDTH", "UNION", "UNDER", "OVERLAY")
# Arrays on the GPU, and what they are for.
OBJECTS = {
    "static: half planes": {"coverage"},
    "static: levels": {"coverage"},
    "static_bvh: samples": {"coverage"},
    "static_bvh: polygons": {"polygons"},
    "static_bvh: quad-trees": {"polygons"},
    "static_bvh: segments": {"lines"},
}
# What follows from the view and the lines' places and widths, whatever their colours.
VIEW_PASSES = ("fields", *(f"dynamic: {step}" for step in STEPS))


@dataclass(frozen=True)
class Needs:
    """What a frame takes.

    passes: beside those of the layers. uploads: bytes that buffers and textures need to take. layers: the passes of
    layers that are drawn, by their first words. view: whether what follows from the view is due anew. shows: what
    flags may be for.
    """

    passes: frozenset[str]
    uploads: int
    layers: frozenset[str] = frozenset()
    view: bool = True
    shows: frozenset[str] = frozenset({"lines"})


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


def rows(context: Context) -> list[Row]:
    """A row for each technique and state, and each map: what ran, and what of it was `needless`."""
    from . import needless_maps

    return [*(row for name in WAYS for row in states(name)), *needless_maps.rows(context)]


def states(name: str) -> Iterator[Row]:
    """The rows of one technique."""
    bare = _draw(name, _ground())
    ground = uploaded(bare)
    layers = passes_of(name)
    yield row(name, "no layers", bare, Needs(FIRST, ground))
    for style, looks in STYLES.items():
        try:
            frame = _draw(name, _scene(name, **looks))
        except (dg.StyleError, dg.UnsupportedError):
            continue
        shows = frozenset({"lines", SHOWN.get(style, "lines")})
        yield row(name, style, frame, Needs(FIRST, ground + first(name, frame), layers, shows=shows))
    yield row(name, "hidden", _draw(name, _scene(name, alpha=0.0)), Needs(FIRST, ground))
    sky = _draw(name, _scene(name), SKY)
    outside = frozenset({"upload", "compose", "readback"})
    yield row(name, "nothing in view", sky, Needs(outside, ground + first(name, sky)))
    yield from _changes(name)
    yield _weighed(name)


def passes_of(name: str) -> frozenset[str]:
    """The first words of a way's passes."""
    return frozenset({WAYS[name].name, *WAYS[name].passes})


def first(name: str, frame: dg.Frame, features: int = FEATURES) -> int:
    """Bytes to upload of what is prepared, once, beside the ground."""
    prepared = int(frame.stats.counts["prepared_bytes"])
    return prepared + LOOK_BYTES * features + VIEW_BYTES + FIXED_BYTES.get(name, 0)


def _changes(name: str) -> Iterator[Row]:
    renderer = dg.Renderer(SIZE, antialias="none", **WAYS[name].options)
    renderer.preprocess(_scene(name))
    view = VIEW_BYTES + FIXED_VIEW_BYTES.get(name, 0)
    layers = passes_of(name)

    def frame(camera: dg.Camera = ELSEWHERE) -> dg.Frame:
        renderer.update(camera)
        return renderer.render()

    frame(NEAR)
    yield row(name, "another camera", frame(), Needs(GROUND, view, layers))
    yield row(name, "unchanged", frame(), Needs(frozenset(), 0))
    renderer.restyle("ways", color="navy")
    looks = frozenset({"upload", "compose", "readback"})
    needs = Needs(looks, view + LOOK_BYTES * FEATURES, layers, view=False)
    yield row(name, "another colour", frame(), needs)


def _weighed(name: str) -> Row:
    """Bytes that are held for many segments, beside those of their ends and looks."""
    turn = np.linspace(0.0, 20.0, LONG + 1) + np.arange(MANY)[:, None]
    start = np.random.default_rng(3).uniform(10.0, 90.0, (MANY, 1, 2))
    coords = (
        start + np.stack([np.cos(turn), np.sin(turn)], axis=-1) * np.linspace(1.0, 9.0, LONG + 1)[:, None]
    )
    each = np.arange(MANY + 1)
    table = dg.FeatureTable("lines", coords.reshape(-1, 2), (LONG + 1) * each, each, each[:-1])
    frame = _draw(name, _scene(name, table, width=1.0 if WAYS[name].pixels else 0.2))
    needed = MANY * (LONG * SEGMENT_BYTES + FEATURE_BYTES)
    found = row(name, "many segments", frame, Needs(FIRST, uploaded(frame), passes_of(name)))
    return {**found, "needed_bytes": needed, "times": found["held_bytes"] / needed}


def row(name: str, state: str, frame: dg.Frame, needs: Needs) -> Row:
    """What ran for a frame, and what of it was needless."""
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
        "uploaded_bytes": uploaded(frame),
        "needed_upload_bytes": needs.uploads,
        "needless": surplus(passes, stats.variants, uploaded(frame), stats.objects, needs),
    }


def uploaded(frame: dg.Frame) -> int:
    """Bytes that a frame uploaded."""
    return int(frame.stats.counts["uploaded_bytes"])


def surplus(
    passes: Sequence[str], programs: Sequence[str], uploads: int, objects: Mapping[str, int], needs: Needs
) -> list[str]:
    """What ran beyond the needs, in words."""
    found = []
    for each in passes:
        is_of_layers = each.split(":")[0].split(" ")[0] in needs.layers
        if not (each in needs.passes or (is_of_layers and (needs.view or each not in VIEW_PASSES))):
            found.append(f"pass {each}")
    for program in programs:
        flags = program.rstrip("]").split("[")[1].split(",") if "[" in program else []
        found += [
            f"{program}: {flag}"
            for flag in flags
            if flag not in FREE and not FLAGS.get(flag, set()) & needs.shows
        ]
    if uploads > needs.uploads:
        found.append(f"{uploads - needs.uploads} of {uploads} bytes uploaded")
    found += [f"the object {name}" for name in objects if name in OBJECTS and not OBJECTS[name] & needs.shows]
    is_first = "upload" in passes
    if not needs.layers and is_first and "frame: overlay" in objects:
        found.append("an overlay")
    return found


def _ground() -> dg.Scene:
    x = np.linspace(-1.0, 1.0, 21)
    hill = 20.0 * np.exp(-4.0 * (x[None, :] ** 2 + x[:, None] ** 2))
    return dg.Scene(dg.Terrain(hill.astype(np.float32), 0.0, 100.0, 5.0, 5.0))


def _two_lines() -> dg.FeatureTable:
    lines = np.array([(5.0, 50.0), (50.0, 20.0), (95.0, 60.0), (20.0, 5.0), (30.0, 95.0)])
    return dg.FeatureTable("lines", lines, np.array([0, 3, 5]), np.arange(3), np.arange(2))


def _scene(name: str, table: dg.FeatureTable | None = None, **looks: Any) -> dg.Scene:
    scene = _ground()
    units = "px" if WAYS[name].pixels else "m"
    keywords: dict[str, Any] = {"color": "crimson", "width": 4.0, "width_units": units, **looks}
    scene.add_lines(table or _two_lines(), name="ways", technique=WAYS[name].technique, **keywords)
    return scene


def _draw(name: str, scene: dg.Scene, camera: dg.Camera = NEAR) -> dg.Frame:
    return scene.render(camera, SIZE, antialias="none", **WAYS[name].options)


def figures(rows: Sequence[Row]) -> list[Figure]:
    """What was needless; bytes; then what ran, map by map and for each technique state by state."""
    ran = [row for row in rows if "refused" not in row]
    needless = [[row["technique"], row["scene"], each] for row in ran for each in row["needless"]]
    summary = f"Of {len(ran)} frames, {len({(a, b) for a, b, _ in needless})} ran what they do not need."
    table = Table(["technique", "state", "needless"], needless) if needless else None
    states = [row for row in ran if "map" not in row]
    names = list(dict.fromkeys(row["technique"] for row in states))
    maps = dict.fromkeys(row["map"] for row in rows if "map" in row)
    return [
        Figure("What was needless", summary, table=table),
        Figure("Bytes of many segments", WEIGHED, table=weighed(rows)),
        *(_map_table([row for row in rows if row.get("map") == name]) for name in maps),
        *(_technique_table(states, name) for name in names),
    ]


def weighed(rows: Sequence[Row]) -> Table:
    """Bytes that techniques hold for many segments."""
    lines = [
        [
            row["technique"],
            byte_count(row["held_bytes"]),
            byte_count(row["needed_bytes"]),
            f"{row['times']:.1f}",
        ]
        for row in rows
        if "times" in row
    ]
    return Table(["technique", "held", "needed", "times"], lines)


def _map_table(rows: Sequence[Row]) -> Figure:
    """What ran for one map."""
    refused = [f"{row.get('technique', 'the map')}: {row['refused']}" for row in rows if "refused" in row]
    ran = [row for row in rows if "refused" not in row]
    shows = f"Shows {', '.join(ran[0]['shows'])}." if ran else ""
    caption = " ".join([shows, *(f"Refused: {each}" for each in refused)])
    return Figure(
        rows[0]["map"],
        caption,
        table=Table(["technique", *RAN], [[row["technique"], *_ran(row)] for row in ran]),
    )


def _technique_table(rows: Sequence[Row], name: str) -> Figure:
    lines = [[row["scene"], *_ran(row)] for row in rows if row["technique"] == name]
    return Figure(
        f"What {name} ran", "Programs are those compiled so far.", table=Table(["state", *RAN], lines)
    )


RAN = ("passes", "programs of the layers", "objects", "held", "uploaded", "needed at most")


def _ran(row: Row) -> list[str]:
    programs = [each for each in row["programs"] if each.split("[")[0] not in ("terrain", "compose")]
    objects = [each.split(": ")[1] for each in row["objects"]]
    words = [", ".join(some) or "none" for some in (row["passes"], programs, objects)]
    return [
        *words,
        *(byte_count(row[name]) for name in ("held_bytes", "uploaded_bytes", "needed_upload_bytes")),
    ]
