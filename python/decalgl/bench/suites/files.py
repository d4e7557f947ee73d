"""Prepared scenes on disk, and levels of detail, which are made when first drawn from.

open          opening a saved scene ÷ preparing it
levels_made   making the levels of detail, by the first view that draws from them, ÷ preparing
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import decalgl as dg

from ..measure import interleaved, timed
from ..workload import KINDS

if TYPE_CHECKING:
    from ..measure import Times
    from ..records import Records
    from ..workload import Workload


def measure(work: Workload, records: Records) -> None:
    for kind in KINDS:
        for size in work.sizes:
            work.say(f"{kind} {size}")
            scene = work.scene(kind, size)
            with tempfile.TemporaryDirectory() as folder:
                times = _times(work, scene, Path(folder) / "map.decal", work.runs_of(size))
            records.at(f"{kind} {size}", None).update(
                **times,
                open=times["open_ms"] / times["prepare_ms"],
                levels_made=times["levels_ms"] / times["prepare_ms"],
            )


def _times(work: Workload, scene: dg.Scene, path: Path, runs: int) -> Times:
    saved = work.renderer(scene)
    saved.save(path)
    far = work.views["far"]

    def prepare() -> Times:
        renderer = dg.Renderer(size=work.picture, antialias="coverage")
        prepared = timed(lambda: renderer.preprocess(scene))
        renderer.update(work.views["close"])
        first = timed(lambda: renderer.update(far))
        again = timed(lambda: renderer.update(far))
        return {"prepare_ms": prepared, "levels_ms": max(first - again, 0.0)}

    return interleaved(
        runs,
        prepare,
        lambda: {"open_ms": timed(lambda: dg.Renderer(size=work.picture).open(path))},
        lambda: {"save_ms": timed(lambda: saved.save(path))},
    )
