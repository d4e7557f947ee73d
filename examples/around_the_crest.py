"""Several pictures of one scene: what was prepared once serves every view.

    python examples/around_the_crest.py [--out DIRECTORY] [--views 4] [--size 960x540]

The three stages by hand: `preprocess` once, then `update` and `render` for each camera.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import decalgl as dg
import demo

CREST = (-1000.0, 1800.0, 500.0)  # above Mānoa, metres of the terrain's plane


def main() -> None:
    parser = argparse.ArgumentParser(description="Fly around the crest of the Koʻolau.")
    parser.add_argument("--out", type=Path, default=Path("build/crest"))
    parser.add_argument("--views", type=int, default=4)
    parser.add_argument("--size", type=demo.parse_size, default=(960, 540))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)

    scene = demo.build_scene()
    renderer = dg.Renderer(size=arguments.size, antialias="coverage")
    renderer.preprocess(scene)
    for view in range(arguments.views):
        azimuth = 360.0 * view / arguments.views
        camera = dg.Camera.orbit(CREST, distance=9000, azimuth=azimuth, elevation=30)
        started = time.perf_counter()
        renderer.update(camera)
        frame = renderer.render(background="sky")
        path = arguments.out / f"crest_{view:02d}.png"
        frame.save(path)
        print(f"{path}  azimuth {azimuth:3.0f} degrees, {time.perf_counter() - started:.2f} s")


if __name__ == "__main__":
    main()
