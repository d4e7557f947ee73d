"""An interactive session without a window: flies, fades, looks through a lens, picks and edits one prepared map.

    python examples/interactive.py [--out DIRECTORY] [--size 960x540]

The scene is prepared once. A program with a window would do the same in its event loop: a mouse that moves sets
`renderer.lens`, a click asks `frame.pick`, a slider calls `renderer.restyle`.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import shapely

import decalgl as dg
import demo
import honolulu

FADED = ("Scrub", "MixedForest", "Grassland", "Grass")


def main() -> None:
    parser = argparse.ArgumentParser(description="Fly, fade, look through a lens, pick and edit.")
    parser.add_argument("--out", type=Path, default=Path("build/interactive"))
    parser.add_argument("--size", type=demo.parse_size, default=(960, 540))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    width, height = arguments.size

    renderer = dg.Renderer(size=arguments.size)
    renderer.preprocess(demo.build_scene())
    renderer.update(dg.Camera.look_at(honolulu.EYE, honolulu.TARGET, fov=honolulu.FIELD_OF_VIEW))

    def show(name: str) -> dg.Frame:
        started = time.perf_counter()
        frame = renderer.render()
        frame.save(arguments.out / f"{name}.png")
        print(f"{name}.png  drawn and written in {time.perf_counter() - started:.2f} s")
        return frame

    show("1_map")

    cover = renderer.layers[0]
    renderer.restyle(cover, opacity=dict.fromkeys(FADED, 0.3))
    renderer.restyle("isolines 20 m", visible=False)
    show("2_faded")

    lens = dg.Lens(
        circle=(width / 2, height / 2, height / 4),
        styles={"land cover": {"opacity": 1.0}, "isolines 20 m": {"visible": True}},
        hidden=("streams and roads",),
    )
    for step in range(3):  # as a mouse would move it
        renderer.lens = lens.moved(circle=(width * (0.3 + 0.2 * step), height / 2, height / 4))
        show(f"3_lens_{step}")

    renderer.lens = None
    frame = show("4_without_lens")
    column, row = width // 2, 2 * height // 3
    for hit in frame.pick(column, row):
        print("picked:", hit)

    east, north, _ = frame.world[row, column]
    circle = shapely.Point(east, north).buffer(400.0)
    rows = renderer.edit("streams and roads", add=[circle], color="crimson", alpha=0.7)
    frame = show("5_added")
    print("added:", frame.pick(column, row)[0])
    for _ in range(3):
        renderer.edit("streams and roads", move={int(rows[0]): (300.0, 0.0)})
    show("6_moved")
    renderer.edit("streams and roads", remove=rows)
    show("7_removed")


if __name__ == "__main__":
    main()
