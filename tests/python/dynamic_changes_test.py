"""Dynamic layers that change after they were prepared: edits, draw orders, the lens; and what caches know of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, box

import decalgl as dg
from small_scenes import MAP, OBLIQUE, SIZE, flat_scene, hilly_scene

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

LINES = [
    LineString([(10, 30), (35, 70), (40, 30), (60, 30), (62, 75), (90, 50)]),
    LineString([(5, 60), (50, 52), (95, 64)]),
    LineString([(20, 15), (80, 85)]),
]
LOOKS: list[dict[str, Any]] = [
    {"width": 6.0, "alpha": 0.6, "casing": dg.Casing(width=2, color="black")},
    {"width": 8.0, "bands": [(0.5, "white"), (1.0, "navy")], "dash": (14, 6)},
]


def renderer_of(scene: dg.Scene, antialias: str = "none", **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(size=SIZE, antialias=antialias, terrain_error=0.0, **options)
    renderer.preprocess(scene)
    return renderer


def image_of(renderer: dg.Renderer) -> NDArray[np.uint8]:
    renderer.update(OBLIQUE)
    return renderer.render().image


def scene_of(lines: list[LineString], **looks: Any) -> dg.Scene:
    scene = hilly_scene()
    scene.add_lines([LineString([(0, 50), (100, 40)])], color="green", width=3.0)
    scene.add_lines(lines, name="roads", **{"color": "crimson", **looks})
    scene.add_lines([LineString([(40, 0), (50, 100)])], color="gold", width=3.0)
    return scene


@pytest.mark.parametrize("looks", LOOKS, ids=["casing", "bands"])
@pytest.mark.parametrize("method", ["bins", "lists"])
def test_edited_lines_are_those_of_a_scene_prepared_anew(looks: dict[str, Any], method: Any) -> None:
    looks = {**looks, "technique": dg.Dynamic(method=method)}
    renderer = renderer_of(scene_of(LINES, **looks))
    first = image_of(renderer)
    added = renderer.edit("roads", add=[LineString([(10, 90), (90, 95)])], remove=[1], move={2: (5.0, -3.0)})
    moved = LineString([(25, 12), (85, 82)])
    anew = renderer_of(scene_of([LINES[0], moved, LineString([(10, 90), (90, 95)])], **looks))
    assert (image_of(renderer) == image_of(anew)).all()
    assert not (image_of(renderer) == first).all()
    assert set(np.unique(renderer.render().ids)) >= {0, 2, int(added[0])}
    renderer.edit("roads", remove=[0, 2, int(added[0])])
    assert (image_of(renderer) == image_of(renderer_of(scene_of([], **looks)))).all()
    renderer.edit("roads", add=[LINES[0]], color="blue", width=4.0)
    again = renderer_of(scene_of([LINES[0]], **{**looks, "color": "blue", "width": 4.0}))
    if "dash" not in looks and "alpha" not in looks:
        assert (image_of(renderer) == image_of(again)).all()


def test_outlines_and_fills_are_edited_together() -> None:
    outline = dg.Outline(width=3.0, color="black")
    shapes = [box(10, 10, 40, 40), box(30, 30, 70, 70)]
    scene, anew = flat_scene(), flat_scene()
    scene.add_polygons(shapes[:1], color="tan", outline=outline)
    anew.add_polygons(shapes, color="tan", outline=outline)
    renderer = renderer_of(scene)
    renderer.edit(0, add=shapes[1:])
    assert (image_of(renderer) == image_of(renderer_of(anew))).all()


@pytest.mark.parametrize("looks", LOOKS, ids=["casing", "bands"])
def test_another_draw_order_is_that_of_a_scene_prepared_with_it(looks: dict[str, Any]) -> None:
    looks = {**looks, "color": ["crimson", "royalblue", "gold"]}
    renderer = renderer_of(scene_of(LINES, **looks))
    before = image_of(renderer)
    renderer.restyle("roads", order=[2, 1, 0])
    after = image_of(renderer)
    assert (after == image_of(renderer_of(scene_of(LINES, order=[2, 1, 0], **looks)))).all()
    assert not (after == before).all()
    # Looks are found again in the new order.
    renderer.restyle("roads", color="black", where=np.array([True, False, False]))
    renderer.restyle("roads", order="feature")
    black = {**looks, "color": ["black", "royalblue", "gold"]}
    assert (image_of(renderer) == image_of(renderer_of(scene_of(LINES, **black)))).all()


@pytest.mark.parametrize("method", ["bins", "lists"])
def test_inside_the_lens_lines_look_otherwise(method: Any) -> None:
    def pictured(color: str, width: float) -> dg.Scene:
        scene = flat_scene()
        scene.add_lines(LINES, name="roads", color=color, width=width, technique=dg.Dynamic(method=method))
        return scene

    renderer = renderer_of(pictured("red", 3.0))
    renderer.lens = dg.Lens(circle=(50, 50, 20), styles={"roads": {"color": "blue", "width": 9.0}})
    renderer.update(MAP)
    seen = renderer.render().image
    y, x = np.mgrid[0:100, 0:100] + 0.5
    away = np.hypot(x - 50, y - 50)
    for color, width, where in (("red", 3.0, away > 21), ("blue", 9.0, away < 19)):
        plain = pictured(color, width).render(MAP, SIZE, "none", terrain_error=0.0).image
        assert (seen[where] == plain[where]).all()


@pytest.mark.parametrize(
    "choices",
    [
        (dg.Dynamic(cell=0.5), dg.Dynamic(cell=0.25)),
        (dg.Dynamic(method="lists"), dg.Dynamic(method="bins")),
        (dg.Dynamic(width_rule="thesis", method="lists"), dg.Dynamic(method="lists")),
    ],
)
def test_a_cache_knows_the_choices_that_it_was_made_with(choices: Any, tmp_path: Path) -> None:
    def stages(technique: dg.Technique) -> set[str]:
        scene = flat_scene()
        scene.add_lines(LINES, technique=technique)
        renderer = dg.Renderer(SIZE, "none")
        renderer.preprocess(scene, cache=tmp_path / "map.decal")
        renderer.update(MAP)
        return set(renderer.render().stats.preprocess)

    assert "save" in stages(choices[0])
    assert "open" in stages(choices[0])
    assert "save" in stages(choices[1])
