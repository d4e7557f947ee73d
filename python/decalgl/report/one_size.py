"""What one scene takes at one step of size: python -m decalgl.report.one_size SCENE STEP

Run by the part `sizes`, in a process of its own, so that the peak of memory is this scene's alone.
"""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Any, cast

import decalgl as dg

from ..bench.measure import timed
from ..bench.peak_memory import of_process
from ..errors import DecalError
from . import views
from .case_studies import Map, build, vertices

if TYPE_CHECKING:
    from .part import Step


def main() -> None:
    name, step = sys.argv[1:]
    try:
        print(json.dumps(_taken(name, cast("Step", step))))
    except DecalError as error:
        print(json.dumps({"refused": str(error)}))


def _taken(name: str, step: Step) -> dict[str, Any]:
    made: list[Map] = []
    make = timed(lambda: made.append(build(name, step)))
    (drawn,) = made
    scene = drawn.scene()
    renderer = dg.Renderer()
    prepare = timed(lambda: renderer.preprocess(scene))
    renderer.update(views.views(drawn)["oblique"])
    stats = renderer.render().stats
    return {
        "vertices": vertices(scene),
        "make_ms": make,
        "prepare_ms": prepare,
        "layers_bytes": stats.bytes.get("static", 0),
        "peak_bytes": of_process("VmHWM"),
    }


if __name__ == "__main__":
    main()
