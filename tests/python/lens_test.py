"""Lenses: inside, the picture is that of a scene restyled so; outside, nothing changes."""

from __future__ import annotations

from typing import Any

import numpy as np
from shapely import Point, box

import decalgl as dg
from changed_scenes import BOTH, EVERY_WAY, INDEXES, PLAIN, assert_same, picks, prepared, scene_of
from judge import eroded
from small_scenes import SIZE


@EVERY_WAY
def test_a_lens_shows_other_layers_inside(antialias: str, index: str) -> None:
    scene = scene_of({"column": "kind"}, {"color": "navy"}, widest=5.0)
    renderer = prepared(scene, antialias, index=index)
    outside = renderer.render()
    inside_styles: dict[Any, dict[str, Any]] = {"ways": {"width": 5.0, "color": "crimson"}}
    renderer.restyle("ways", **inside_styles["ways"])
    renderer.restyle("areas", visible=False)
    inside = renderer.render()
    renderer.restyle("ways", width=2.0, color="navy")
    renderer.restyle("areas", visible=True)
    renderer.lens = dg.Lens(circle=(40.0, 50.0, 20.0), styles=inside_styles, hidden=("areas",))
    frame = renderer.render()
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    apart = np.hypot(x - 40.0, y - 50.0)
    for part, expected in ((apart < 19.4, inside), (apart > 20.6, outside)):
        np.testing.assert_array_equal(frame.image[part], expected.image[part])
    centre = apart <= 20.0
    np.testing.assert_array_equal(frame.ids, np.where(centre, inside.ids, outside.ids))
    np.testing.assert_array_equal(frame.layers, np.where(centre, inside.layers, outside.layers))
    assert picks(frame) == [
        inside_pick if np.hypot(px + 0.5 - 40.0, py + 0.5 - 50.0) <= 20.0 else outside_pick
        for inside_pick, outside_pick, (px, py) in zip(
            picks(inside),
            picks(outside),
            [(px, py) for px in range(3, SIZE[0], 14) for py in range(3, SIZE[1], 14)],
            strict=True,
        )
    ]


@INDEXES
@BOTH
def test_a_lens_on_the_map_lies_on_the_terrain(antialias: str, index: str) -> None:
    scene = scene_of({"color": "tan"}, {"color": "navy"})
    renderer = prepared(scene, antialias, index=index)
    outside = renderer.render()
    renderer.restyle("areas", color="crimson")
    inside = renderer.render()
    renderer.restyle("areas", color="tan")
    shape = box(20, 20, 80, 80).difference(box(40, 40, 60, 60))
    renderer.lens = dg.Lens(polygon=shape, styles={"areas": {"color": "crimson"}})
    frame = renderer.render()
    world = frame.world[..., :2]
    on_ground = np.isfinite(world[..., 0])
    distance = np.full(world.shape[:2], np.inf)
    within = np.zeros(world.shape[:2], dtype=bool)
    for index in np.argwhere(on_ground):
        point = Point(world[tuple(index)])
        distance[tuple(index)] = shape.boundary.distance(point)
        within[tuple(index)] = shape.contains(point)
    far = distance > 3.0
    assert (far & within).any()
    # Where a pixel sees two surfaces, both may be on other sides of the border: all neighbours must be on one.
    for part, expected in ((far & within, inside), (far & ~within, outside)):
        alike = eroded(part, 1)
        assert alike.any()
        np.testing.assert_array_equal(frame.image[alike], expected.image[alike])
    np.testing.assert_array_equal(frame.ids, outside.ids)


def test_a_lens_that_moves_draws_the_layers_alone() -> None:
    scene = scene_of(PLAIN, {})
    renderer = prepared(scene)
    lens = dg.Lens(circle=(50, 50, 20), styles={"areas": {"color": "red"}})
    renderer.lens = lens
    renderer.render()
    renderer.lens = lens.moved(circle=(30, 50, 20))
    moved = renderer.render()
    assert [one["name"] for one in moved.stats.passes] == ["upload", "lens", "static", "compose", "readback"]
    fresh = prepared(scene)
    fresh.lens = dg.Lens(circle=(30, 50, 20), styles={"areas": {"color": "red"}})
    assert_same(moved, fresh.render())
    renderer.lens = None
    assert_same(renderer.render(), prepared(scene).render())


@INDEXES
def test_a_lens_follows_what_is_restyled_outside(index: str) -> None:
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}), index=index)
    renderer.lens = dg.Lens(circle=(50, 50, 40), styles={"areas": {"opacity": 0.5}})
    renderer.restyle("areas", color="red")
    renderer.restyle("ways", color="green")
    frame = renderer.render()
    fresh = prepared(scene_of({"color": "red"}, {"color": "green"}), index=index)
    fresh.lens = dg.Lens(circle=(50, 50, 40), styles={"areas": {"opacity": 0.5}})
    assert_same(frame, fresh.render())


@INDEXES
@BOTH
def test_a_lens_has_a_draw_order_and_styles_of_its_own(antialias: str, index: str) -> None:
    scene = scene_of({"column": "kind"}, {"color": "navy", "width": 4.0, "dash": (6, 4)})
    inside: dict[Any, dict[str, Any]] = {
        "areas": {"order": -np.arange(40.0), "hatch": dg.Hatch(6, 3)},
        "ways": {"dash": (2, 8), "order": "size"},
    }
    renderer = prepared(scene, antialias, index=index)
    outside = renderer.render()
    renderer.lens = dg.Lens(circle=(50.0, 50.0, 25.0), styles=inside)
    frame = renderer.render()
    renderer.lens = None
    for layer, style in inside.items():
        renderer.restyle(layer, **style)
    expected = renderer.render()
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    apart = np.hypot(x - 50.0, y - 50.0)
    np.testing.assert_array_equal(frame.image[apart < 24.4], expected.image[apart < 24.4])
    np.testing.assert_array_equal(frame.image[apart > 25.6], outside.image[apart > 25.6])
    np.testing.assert_array_equal(frame.ids, np.where(apart <= 25.0, expected.ids, outside.ids))
    assert (frame.image != outside.image).any()
