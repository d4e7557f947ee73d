"""Measuring: what is compared takes turns and medians are reported, so that a drifting machine hits all alike."""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import decalgl as dg
from decalgl import _core

if TYPE_CHECKING:
    from collections.abc import Callable


def interleaved(runs: int, *measures: Callable[[], float]) -> list[float]:
    """The median of each measure over `runs` rounds in which each runs once; a first round is thrown away."""
    for measure in measures:
        measure()
    rounds = [[measure() for measure in measures] for _ in range(runs)]
    return [statistics.median(column) for column in zip(*rounds, strict=True)]


def pass_times(frame: dg.Frame) -> dict[str, float]:
    """Milliseconds of each pass of a frame."""
    return {one["name"]: one["ms"] for one in frame.stats.passes}


def preprocessing(scene: dg.Scene, size: tuple[int, int], camera: dg.Camera, runs: int) -> dict[str, float]:
    """Times of preprocessing the layers, of sorting as many keys, and their ratio P."""
    stats: dict[str, Any] = {}

    def preprocess() -> float:
        renderer = dg.Renderer(size=size, antialias="none")
        renderer.preprocess(scene)
        renderer.update(camera)
        stats.update(renderer.render().stats.to_dict())
        return float(stats["preprocess"]["static"])

    segments = sum(len(layer.features.coords) for layer in scene.layers)
    built, sorted_ = interleaved(runs, preprocess, lambda: _core.time_radix_sort(segments, 0))
    counts = stats["counts"]
    return {
        "segments": counts["segments"],
        "pieces": counts["pieces"],
        "quantum_m": counts["quantum_m"],
        "preprocess_ms": built,
        "radix_sort_ms": sorted_,
        "P": built / sorted_,
        "bytes_per_segment": counts["prepared_bytes"] / counts["segments"],
        "terrain_preprocess_ms": stats["preprocess"]["terrain"],
    }


def drawing(
    full: dg.Renderer, empty: dg.Renderer, size: tuple[int, int], camera: dg.Camera, runs: int
) -> dict[str, float]:
    """Pass times at one view and the ratios S, AA and empty."""

    def draw(renderer: dg.Renderer, antialias: str) -> dict[str, float]:
        renderer.set_picture(size, antialias)
        renderer.update(camera)
        return pass_times(renderer.render())

    passes: dict[str, float] = {}

    def static(antialias: str) -> Callable[[], float]:
        def run() -> float:
            passes.update(draw(full, antialias))
            return passes["static"]

        return run

    def bare() -> float:
        found = draw(empty, "none")
        return found["terrain"] + found["compose"]

    def ground() -> float:
        found = draw(full, "none")
        return found["terrain"] + found["compose"]

    floor, none, coverage, empty_ms, ground_ms = interleaved(
        runs, full.time_floor, static("none"), static("coverage"), bare, ground
    )
    return {
        "floor_ms": floor,
        "static_none_ms": none,
        "static_coverage_ms": coverage,
        "terrain_and_compose_ms": ground_ms,
        "empty_ms": empty_ms,
        "S": none / floor,
        "AA": coverage / none,
        "empty": empty_ms / ground_ms,
    }


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    working = [record for record in dg.doctor() if record.ok]
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=False)
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)),
        "system": platform.platform(),
        "driver": working[0].detail if working else "none",
        "commit": commit.stdout.strip() or None,
        "decalgl": dg.__version__,
    }


def _processor() -> str:
    with Path("/proc/cpuinfo").open() as lines:
        return next(
            (line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown"
        )
