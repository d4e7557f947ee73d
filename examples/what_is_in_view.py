"""Reads a picture back: which land cover fills it, and everything under its middle.

    python examples/what_is_in_view.py [--size 640x360]

A frame knows the topmost feature at every pixel (`ids`, `layers`), where each pixel lies (`world`) and every
feature under one of them (`pick`).
"""

from __future__ import annotations

import argparse

import numpy as np

import decalgl as dg
import demo
import honolulu


def main() -> None:
    parser = argparse.ArgumentParser(description="Say what is in view.")
    parser.add_argument("--size", type=demo.parse_size, default=(640, 360))
    size = parser.parse_args().size

    cover = honolulu.land_cover()
    scene = dg.Scene(dg.Terrain.open(honolulu.DEM), exaggeration=honolulu.EXAGGERATION)
    scene.add_polygons(cover, name="land cover", column="material", cmap=honolulu.PALETTE)
    camera = dg.Camera.look_at(honolulu.EYE, honolulu.TARGET, fov=honolulu.FIELD_OF_VIEW)
    frame = scene.render(camera, size=size)

    seen = frame.ids[frame.layers >= 0]
    materials, counts = np.unique(cover["material"].to_numpy().astype(str)[seen], return_counts=True)
    for i in np.argsort(-counts):
        print(f"{materials[i]:<12} {100 * counts[i] / frame.ids.size:5.1f} % of the picture")

    x, y = size[0] // 2, size[1] // 2
    east, north, height = frame.world[y, x]
    height /= honolulu.EXAGGERATION
    print(f"The middle is at {east:.1f} m east, {north:.1f} m north, {height:.1f} m high.")
    for hit in frame.pick(x, y):
        print("there:", hit)


if __name__ == "__main__":
    main()
