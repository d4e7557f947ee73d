"""Measuring: what is compared takes turns, so a drifting machine hits all alike; medians are reported."""

from __future__ import annotations

import math
import os
import platform
import shutil
import statistics
import subprocess
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import decalgl as dg
from decalgl import _core

from . import folders

if TYPE_CHECKING:
    from collections.abc import Callable

    Times = dict[str, float]
    Measure = Callable[[], Times]

# Of the techniques; what they time inside these is not counted twice.
LAYER_PASSES = ("static", "static_bvh", "dynamic", "loops", "volume", "clipmap", "distance_field")
# A picture that costs next to nothing, for what a frame tells about its scene.
SMALL_PICTURE = (16, 16)


def interleaved(runs: int, *measures: Measure, patience: float = math.inf) -> Times:
    """The medians of all that the measures give, over `runs` rounds in which each runs once, and their spreads.

    A round before them is thrown away, but of measures that take longer in it than `patience` seconds: for those it is
    the first of the rounds. `name`_spread, of times with names in _ms, is half of what lies between the quartiles, as a
    share of the median; one round has none.
    """
    rounds: list[list[Times]] = []
    for measure in measures:
        started = time.monotonic()
        times = measure()
        rounds.append([times] if time.monotonic() - started > patience else [])
    for _ in range(runs):
        for measure, found in zip(measures, rounds, strict=True):
            if len(found) < runs:
                found.append(measure())
    values = {name: [times[name] for times in found] for found in rounds for name in found[0]}
    medians = {name: statistics.median(some) for name, some in values.items()}
    timed = [name for name, value in medians.items() if name.endswith("_ms") and value > 0.0]
    spreads = {f"{name}_spread": spread(values[name]) for name in timed if runs > 1}
    return {**medians, **spreads}


def spread(values: list[float]) -> float:
    """Half of what lies between the quartiles of two or more values, as a share of their median."""
    first, middle, third = statistics.quantiles(values, n=4, method="inclusive")
    return (third - first) / (2.0 * middle)


def drawing(
    renderer: dg.Renderer,
    camera: dg.Camera,
    antialias: str,
    name: str,
    look: Callable[[dg.Frame], None] = lambda _: None,
) -> Measure:
    """Measures a frame: `name`_ms of the layers' passes, `name`_ground_ms of terrain and composing, and of the
    whole frame `name`_frame_ms. What silhouettes take is in the last alone.

    look: is given each frame that was drawn.
    """

    def measure() -> Times:
        frame = draw(renderer, camera, antialias)
        look(frame)
        passes = frame.stats.passes
        centres = _before_silhouettes(passes)
        layers = sum(one["ms"] for one in centres if one["name"] in LAYER_PASSES)
        whole = sum(one["ms"] for one in passes)
        return {f"{name}_ms": layers, f"{name}_ground_ms": ground_ms(centres), f"{name}_frame_ms": whole}

    return measure


def ground_ms(passes: list[dict[str, Any]]) -> float:
    """Milliseconds of terrain and composing among passes of a frame."""
    return float(sum(one["ms"] for one in passes if one["name"] in ("terrain", "compose")))


def _before_silhouettes(passes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The passes over the whole picture; it is one piece, so those of silhouettes come after them."""
    names = [one["name"] for one in passes]
    return passes[: names.index("silhouettes")] if "silhouettes" in names else passes


def timed(action: Callable[[], object]) -> float:
    """Milliseconds that an action takes."""
    started = time.perf_counter()
    action()
    return 1000.0 * (time.perf_counter() - started)


def floor(renderer: dg.Renderer) -> Measure:
    """Measures the pass that all others are compared with; the renderer must have drawn a frame."""
    return lambda: {"floor_ms": renderer.time_floor()}


def draw(renderer: dg.Renderer, camera: dg.Camera, antialias: str) -> dg.Frame:
    """A frame of a renderer's scene, in the size that it has, drawn anew."""
    renderer.set_picture(renderer.size, antialias)
    renderer.forget()
    renderer.update(camera)
    return renderer.render()


def preparing(scene: dg.Scene, name: str, stats: dict[str, Any], **options: Any) -> Measure:
    """Measures preparing a scene: `name`_ms of the layers, `name`_terrain_ms of the terrain.

    stats: filled with those of a frame.
    """

    def measure() -> Times:
        renderer = dg.Renderer(size=SMALL_PICTURE, **options)
        renderer.preprocess(scene)
        renderer.update(dg.Camera.top_down(scene.terrain.bounds))
        stats.update(renderer.render().stats.to_dict())
        parts = stats["preprocess"]
        layers = sum(ms for part, ms in parts.items() if part != "terrain")
        return {f"{name}_ms": layers, f"{name}_terrain_ms": parts["terrain"]}

    return measure


def preprocessing(scene: dg.Scene, runs: int, *others: Measure, **options: Any) -> Times:
    """Counts, the times of preparing the layers and of sorting as many keys, and their ratio P.

    others: further measures that take turns with these.
    """
    vertices = vertices_of(scene)
    stats: dict[str, Any] = {}
    times = interleaved(
        runs,
        preparing(scene, "preprocess", stats, **options),
        lambda: {"radix_sort_ms": _core.time_radix_sort(vertices, 0)},
        *others,
    )
    counts = stats["counts"]
    return {
        "vertices": vertices,
        "segments": counts["segments"],
        "pieces": counts["pieces"],
        "quantum_mm": 1000.0 * counts["quantum_m"],
        **times,
        "P": times["preprocess_ms"] / times["radix_sort_ms"],
        "bytes_per_segment": counts["prepared_bytes"] / counts["segments"],
    }


def vertices_of(scene: dg.Scene) -> int:
    """Of all layers."""
    return sum(len(layer.features.coords) for layer in scene.layers)


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    working = [record for record in dg.doctor() if record.ok]
    commit = _commit()
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)),
        "system": platform.platform(),
        "driver": working[0].detail if working else "none",
        "commit": commit,
        "decalgl": dg.__version__,
    }


def _commit() -> str | None:
    """That of the checkout; a dirty one ends in +. None for an installed package."""
    root = folders.checkout()
    git = shutil.which("git")
    if root is None or git is None:
        return None

    def said(*arguments: str) -> str:
        command = [git, "-C", str(root), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()

    commit = said("rev-parse", "HEAD")
    return commit + "+" * bool(said("status", "--porcelain", "--untracked-files=no")) if commit else None


def _processor() -> str:
    with Path("/proc/cpuinfo").open() as lines:
        return next(
            (line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown"
        )
