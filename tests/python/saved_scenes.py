"""A small scene that tests save, open and keep in caches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from shapely import LineString, box

import decalgl as dg
from small_scenes import OBLIQUE, SIZE, hilly_scene

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

ARRAYS = ("image", "ids", "layers", "depth", "world")


def sample_scene(**changes: Any) -> dg.Scene:
    """A hill with two polygons and two lines; `changes` exchange one thing of it."""
    given_parts: dict[str, Any] = {
        "exaggeration": 1.0,
        "relief": dg.Relief(cmap="terrain"),
        "name": "fields",
        "color": ["red", "green"],
        "alpha": 0.5,
        "order": "feature",
        "box": (20, 20, 80, 80),
        "width": [4.0, 8.0],
        "vertex": 100.0,
        "height": 0.0,
        **changes,
    }
    hills = hilly_scene().terrain
    z = hills.z.copy()
    z[3, 4] += given_parts["height"]
    terrain = dg.Terrain(z, hills.x0, hills.y0, hills.dx, hills.dy)
    scene = dg.Scene(terrain, given_parts["exaggeration"], given_parts["relief"])
    scene.add_polygons(
        [box(*given_parts["box"]), box(40, 40, 90, 95)],
        name=given_parts["name"],
        color=given_parts["color"],
        alpha=given_parts["alpha"],
        order=given_parts["order"],
    )
    lines = [LineString([(0, 0), (given_parts["vertex"], 100)]), LineString([(0, 60), (100, 50)])]
    scene.add_lines(lines, name="ways", width=given_parts["width"], width_units="m", color="blue")
    return scene


def drawn(renderer: dg.Renderer, camera: dg.Camera = OBLIQUE) -> dg.Frame:
    renderer.update(camera)
    return renderer.render()


def prepared(scene: dg.Scene, **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(SIZE, **options)
    renderer.preprocess(scene)
    return renderer


def opened(path: Path, **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(SIZE, **options)
    renderer.open(path)
    return renderer


def assert_same(one: dg.Frame, other: dg.Frame) -> None:
    for name in ARRAYS:
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name
    assert one.stats.counts == other.stats.counts
    for x, y in ((50, 50), (70, 60), (5, 5)):
        assert [str(found) for found in one.pick(x, y)] == [str(found) for found in other.pick(x, y)]


def save_sample(folders: pytest.TempPathFactory) -> Path:
    """A file of the sample scene."""
    path = folders.mktemp("saved") / "map.decal"
    prepared(sample_scene()).save(path)
    return path
