"""Nothing needless: the passes, programs, GL objects and bytes of small scenes, beside those that each needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

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
WAYS = {
    "static": dg.Static(),
    "dynamic": dg.Dynamic(),
    "loops": dg.Loops(),
    "volume": dg.Volume(),
    "clipmap": dg.Clipmap(),
    "distance_field": dg.DistanceField(),
}
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
    "CORNERS": {"bevels"},
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
        "FROM_LEVELS",
        "MULTISAMPLED",
        "GATHERED",
        "SAMPLE",
    ),
)
LAYER_PASSES = ("static", "dynamic", "loops", "volume", "clipmap", "distance_field", "fields", "stylize")


@dataclass(frozen=True)
class Needs:
    """What a frame takes.

    passes: beside those of the layers. layers: whether the layers are drawn at all. style: what flags are for.
    uploads: the most bytes that buffers and textures take; None: what the scene is made of.
    """

    passes: frozenset[str]
    layers: bool = True
    style: str = "one colour"
    uploads: int | None = None


GROUND = frozenset({"terrain", "compose", "readback"})
FIRST = GROUND | {"upload"}
VIEW_BYTES = 4096  # a view's own: its uniform block, and the level of detail of each tile


def rows(_context: Context) -> list[Row]:
    """A row for each technique and state: what ran, and what of it was `needless`."""
    return [row for name in WAYS for row in states(name)]


def states(name: str) -> Iterator[Row]:
    """The rows of one technique."""
    yield _row(name, "no layers", _draw(_ground()), Needs(FIRST, layers=False))
    for style, looks in STYLES.items():
        try:
            frame = _draw(_scene(name, **looks))
        except (dg.StyleError, dg.UnsupportedError):
            continue
        yield _row(name, style, frame, Needs(FIRST, style=style))
    yield _row(name, "hidden", _draw(_scene(name, alpha=0.0)), Needs(FIRST, layers=False))
    outside = Needs(frozenset({"upload", "compose", "readback"}), layers=False)
    yield _row(name, "nothing in view", _draw(_scene(name), SKY), outside)
    yield from _changes(name)


def _changes(name: str) -> Iterator[Row]:
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(_scene(name))

    def frame(camera: dg.Camera = ELSEWHERE) -> dg.Frame:
        renderer.update(camera)
        return renderer.render()

    frame(NEAR)
    yield _row(name, "another camera", frame(), Needs(GROUND, uploads=VIEW_BYTES))
    yield _row(name, "unchanged", frame(), Needs(frozenset(), layers=False, uploads=0))
    try:
        renderer.restyle("ways", color="navy")
    except (dg.StyleError, dg.UnsupportedError):
        return
    looks = frozenset({"upload", "compose", "readback"})
    yield _row(name, "another colour", frame(), Needs(looks, uploads=VIEW_BYTES))


def _row(name: str, state: str, frame: dg.Frame, needs: Needs) -> Row:
    stats = frame.stats
    passes = [one["name"] for one in stats.passes]
    uploads = int(stats.counts["uploaded_bytes"])
    held = {owner: count for owner, count in stats.bytes.items() if owner == name}
    return {
        "scene": state,
        "technique": name,
        "passes": passes,
        "programs": stats.variants,
        "objects": sorted(each for each in stats.objects if each.startswith(f"{name}:")),
        "held_bytes": sum(held.values()),
        "uploaded_bytes": uploads,
        "needless": surplus(passes, stats.variants, uploads, stats.objects, needs),
    }


def surplus(
    passes: Sequence[str], programs: Sequence[str], uploads: int, objects: Mapping[str, int], needs: Needs
) -> list[str]:
    """What ran beyond the needs, in words."""
    found = []
    for each in passes:
        of_layers = each.split(":")[0].split(" ")[0] in LAYER_PASSES
        if not (needs.layers if of_layers else each in needs.passes):
            found.append(f"pass {each}")
    for program in programs:
        flags = program.rstrip("]").split("[")[1].split(",") if "[" in program else []
        found += [f"{program}: {flag}" for flag in flags if not _is_for(flag, needs.style)]
    if needs.uploads is not None and uploads > needs.uploads:
        found.append(f"{uploads} bytes uploaded")
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


def _scene(name: str, **looks: Any) -> dg.Scene:
    scene = _ground()
    lines = np.array([(5.0, 50.0), (50.0, 20.0), (95.0, 60.0), (20.0, 5.0), (30.0, 95.0)])
    table = dg.FeatureTable("lines", lines, np.array([0, 3, 5]), np.arange(3), np.arange(2))
    units = "px" if name == "dynamic" else "m"
    keywords: dict[str, Any] = {"color": "crimson", "width": 4.0, "width_units": units, **looks}
    scene.add_lines(table, name="ways", technique=WAYS[name], **keywords)
    return scene


def _draw(scene: dg.Scene, camera: dg.Camera = NEAR) -> dg.Frame:
    return scene.render(camera, SIZE, antialias="none")


def figures(rows: Sequence[Row]) -> list[Figure]:
    """What ran, in a table for each technique, and what of it was needless."""
    needless = [[row["technique"], row["scene"], each] for row in rows for each in row["needless"]]
    summary = f"Of {len(rows)} states, {len({(a, b) for a, b, _ in needless})} ran what they do not need."
    table = Table(["technique", "state", "needless"], needless) if needless else None
    names = list(dict.fromkeys(row["technique"] for row in rows))
    return [
        Figure("What was needless", summary, table=table),
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
        ]
        for row in rows
        if row["technique"] == name
    ]
    columns = ["state", "passes", "programs of the layers", "objects", "held", "uploaded"]
    return Figure(f"What {name} ran", "Programs are those compiled so far.", table=Table(columns, lines))
