"""Draws the land cover of Honolulu over its mountains, with isolines, and says what the picture cost.

python examples/demo.py [--out build/demo/honolulu.png] [--size 1920x1080]

land cover, by material      polygons that share their borders
isolines every 20 m          derived from the terrain, 3 m wide on the ground
isolines every 100 m         7 m wide
streams, roads, freeways     the narrow polygons once more, above the isolines
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import decalgl as dg
import honolulu


def build_scene() -> dg.Scene:
    """Terrain and layers, bottom to top."""
    terrain = dg.Terrain.open(honolulu.DEM)
    relief = dg.Relief(strength=0.6, on_layers=0.55)
    scene = dg.Scene(terrain, exaggeration=honolulu.EXAGGERATION, relief=relief)

    cover = honolulu.land_cover()
    scene.add_polygons(cover, name="land cover", column="material", cmap=honolulu.PALETTE)

    common, heavy = honolulu.split_isolines(honolulu.isolines(terrain, step=20.0), every=100.0)
    brown = honolulu.ISOLINE_COLOR
    scene.add_lines(common, name="isolines 20 m", color=brown, alpha=0.5, width=3.0, width_units="m")
    scene.add_lines(heavy, name="isolines 100 m", color=brown, alpha=0.75, width=7.0, width_units="m")

    network = cover[cover["material"].isin(honolulu.NETWORK)]
    scene.add_polygons(network, name="streams and roads", column="material", cmap=honolulu.PALETTE)
    return scene


def print_layers(scene: dg.Scene, console: Console) -> None:
    """What is in the scene."""
    table = Table("layer", "kind", "features", "vertices", title="The scene")
    for column in table.columns[2:]:
        column.justify = "right"
    for layer in scene.layers:
        features = layer.features
        table.add_row(layer.name, features.kind, f"{len(features.rows):,}", f"{len(features.coords):,}")
    console.print(table)


def print_cost(stats: dict[str, Any], console: Console) -> None:
    """Milliseconds of each stage and each pass, bytes of each technique."""
    table = Table("", "", title="What it cost")
    table.columns[1].justify = "right"
    for stage, milliseconds in stats.get("stages", {}).items():
        table.add_row(f"[bold]{stage}[/bold]", f"{milliseconds:,.1f} ms")
    table.add_section()
    for one in stats.get("passes", []):
        table.add_row(f"pass {one['name']}", f"{one['ms']:,.1f} ms")
    table.add_section()
    for technique, count in stats.get("bytes", {}).items():
        table.add_row(f"memory {technique}", f"{count / 1e6:,.1f} MB")
    console.print(table)


def parse_size(text: str) -> tuple[int, int]:
    """(width, height) of a text such as 1920x1080."""
    width, height = text.lower().split("x")
    return int(width), int(height)


def main() -> None:
    default = Path(__file__).resolve().parents[1] / "build" / "demo" / "honolulu.png"
    parser = argparse.ArgumentParser(description="Draw Honolulu.")
    parser.add_argument("--out", type=Path, default=default)
    parser.add_argument("--size", type=parse_size, default=(1920, 1080))
    arguments = parser.parse_args()

    console = Console()
    started = time.perf_counter()
    scene = build_scene()
    console.print(f"Read and styled the data in {time.perf_counter() - started:.1f} s.")
    print_layers(scene, console)

    camera = dg.Camera.look_at(honolulu.EYE, honolulu.TARGET, fov=honolulu.FIELD_OF_VIEW)
    frame = scene.render(camera, size=arguments.size, antialias="coverage")
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    frame.save(arguments.out)

    print_cost(frame.stats.to_dict(), console)
    console.print("The picture is at", style="bold", end=" ")
    console.print(str(arguments.out), soft_wrap=True, highlight=False)


if __name__ == "__main__":
    main()
