"""LOOPS: against the reference at full detail and within its bounds, other looks, levels of detail by place."""

from __future__ import annotations

import dataclasses
import functools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, box

import decalgl as dg
import judge
import rounding
import saved_scenes
import scenes
import shapes
from decalgl.loops import NAMED_BVHS
from scenes import View
from small_scenes import MAP, SIZE, draw, flat_scene

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

FULL = dg.Loops(detail=dg.Detail(screen=None, uniform=0.0))
EVERYTHING = [
    "hills",
    "hills_orthographic",
    "line_widths",
    "translucent",
    "far_coordinates",
    "nodata_holes",
    "larger_than_the_map",
    "zero_lengths",
    "nested_holes",
    "slivers",
    "crowd",
]
QUANTA = 2.5  # noding moves edges by up to two


@functools.cache
def renderer() -> dg.Renderer:
    """It draws every sample of the terrain."""
    return dg.Renderer(terrain_error=0.0)


def by_loops(view: View, technique: dg.Loops) -> View:
    """The same view, drawn by LOOPS."""
    return view._replace(scene=shapes.drawn_by(view.scene, technique))


# Against the reference


@pytest.mark.parametrize("name", EVERYTHING)
def test_full_detail_is_right_wherever_the_reference_is_asked(name: str) -> None:
    view = by_loops(scenes.build(name), FULL)
    frame = judge.draw(renderer(), view)
    assert (frame.ids >= 0).any()
    own = judge.judge_ids(
        view, frame, judge.own_surface(view, frame), QUANTA * frame.stats.counts["quantum_m"]
    )
    assert own.far == 0, own


def allowed(view: View, frame: dg.Frame, pixels: float) -> FloatArray:
    """Metres (h, w) on the ground that show as at most so many pixels, in any direction."""
    basis = view.camera.basis()
    away = frame.world.reshape(-1, 3) - np.array(view.camera.eye)
    if view.camera.fov is None:
        return np.full(frame.depth.shape, pixels * view.camera.view_height / view.size[1])
    focal = 0.5 * view.size[1] / np.tan(np.radians(0.5 * view.camera.fov))
    metres: FloatArray = pixels * (away @ basis[2]) ** 2 / (focal * np.linalg.norm(away, axis=1))
    return metres.reshape(frame.depth.shape)


@pytest.mark.parametrize("name", ["hills", "hills_orthographic", "eye_at_one_metre"])
@pytest.mark.parametrize("pixels", [0.5, 4.0])
def test_ids_differ_only_within_the_bound_of_an_edge(name: str, pixels: float) -> None:
    view = by_loops(scenes.build(name), dg.Loops(detail=dg.Detail(screen=pixels)))
    frame = judge.draw(renderer(), view)
    surface = judge.own_surface(view, frame)
    bound = allowed(view, frame, pixels) + QUANTA * frame.stats.counts["quantum_m"]
    found = judge.judge_ids(view, frame, surface, bound)
    assert found.far == 0, found
    assert found.wrong > 0


@pytest.mark.parametrize("name", ["hills", "line_widths"])
def test_coverage_is_the_mean_of_its_samples(name: str) -> None:
    # On level ground, as silhouettes and creases are filtered by the frame.
    hilly = scenes.build(name)
    level = dg.Scene(dg.Terrain.flat(hilly.scene.terrain.bounds), relief=hilly.scene.relief)
    level._layers.extend(hilly.scene.layers)
    view = by_loops(hilly._replace(scene=level), FULL)
    frame = judge.draw(renderer(), view)
    x0, y0, x1, y1 = crop = judge.busiest_crop(frame, (120, 68))
    expected = rounding.coverage_of_samples(view, frame, crop)
    own = judge.overlay_of(renderer(), view, "coverage")[y0:y1, x0:x1]
    difference = np.abs(own - expected).max(axis=-1)
    assert (difference > 2.1 / 32).mean() <= 0.01
    assert (difference > 2.1 / 255).mean() <= 0.02


def test_coverage_of_translucent_features_is_that_of_static_ones() -> None:
    hilly = scenes.build("translucent")
    level = dg.Scene(dg.Terrain.flat(hilly.scene.terrain.bounds), relief=hilly.scene.relief)
    level._layers.extend(hilly.scene.layers)
    view = hilly._replace(scene=level)
    static = judge.overlay_of(renderer(), view, "coverage")
    own = judge.overlay_of(renderer(), by_loops(view, FULL), "coverage")
    difference = np.abs(own - static).max(axis=-1)
    assert (difference > 2.1 / 32).mean() <= 0.001
    assert np.sqrt((difference**2).mean()) <= 0.005
    assert (static[..., 3] % 1.0 > 0.1).any()


# Parts of the technique


def varied_scene(technique: str | dg.Technique) -> dg.Scene:
    """Polygons with outlines, translucent, and lines over them."""
    scene = flat_scene()
    rings = [shapes.rough_ring(i, 15.0 + 17.0 * (i % 5), 15.0 + 17.0 * (i // 5), 11.0) for i in range(25)]
    outline = dg.Outline(width=1.0, width_units="m", color="black")
    scene.add_polygons(rings, color=shapes.tints(25, 4, 0.6), outline=outline, technique=technique)
    walk = np.cumsum(np.random.default_rng(1).normal(size=(300, 2)), axis=0) + 50.0
    scene.add_lines([LineString(walk)], width=0.8, width_units="m", color="red", technique=technique)
    return scene


@pytest.mark.parametrize(
    "bvh", [None, *NAMED_BVHS, dg.LoopsBvh((9, 4), 10, (3, 2), (4, 9, 4), 1, 0.5)], ids=str
)
def test_every_index_draws_the_same(bvh: Any) -> None:
    static = draw(varied_scene("static"))
    frame = draw(varied_scene(dg.Loops(bvh=bvh, detail=FULL.detail)))
    np.testing.assert_array_equal(frame.ids, static.ids)
    np.testing.assert_array_equal(frame.layers, static.layers)
    assert np.abs(frame.image.astype(int) - static.image).max() <= 2


def test_segments_draw_what_triangles_do_with_twice_as_many() -> None:
    walks = np.cumsum(np.random.default_rng(2).normal(size=(20, 500, 2)), axis=1) * 0.8 + 50.0
    frames = {}
    for primitives in ("tri", "seg"):
        for screen in (0.0, 3.0):
            scene = flat_scene()
            detail = dg.Detail(screen=screen)
            scene.add_lines(
                [LineString(walk) for walk in walks],
                width=0.5,
                width_units="m",
                technique=dg.Loops(primitives=primitives, bvh="fitted", detail=detail),
            )
            frames[primitives, screen] = draw(scene)
    for screen in (0.0, 3.0):
        np.testing.assert_array_equal(frames["tri", screen].ids, frames["seg", screen].ids)
    assert (frames["tri", 0.0].ids != frames["tri", 3.0].ids).any()
    tri, seg = (frames[each, 0.0].stats.counts["loops_primitives"] for each in ("tri", "seg"))
    assert tri == 20 * 498
    assert 0.49 < tri / seg < 0.51


def test_pick_lists_what_lies_there_at_full_detail() -> None:
    static = draw(varied_scene("static"))
    frame = draw(varied_scene("loops"))
    for x in range(0, 100, 7):
        for y in range(0, 100, 7):
            expected = [(picked.layer.index, picked.row) for picked in static.pick(x, y)]
            assert [(picked.layer.index, picked.row) for picked in frame.pick(x, y)] == expected


@pytest.mark.parametrize(
    "look",
    [
        {"color": "red", "opacity": 0.5},
        {"visible": [i % 3 > 0 for i in range(25)]},
        {"order": [float(i * 7 % 25) for i in range(25)]},
        {"outline": {"color": "blue"}},
    ],
    ids=lambda look: next(iter(look)),
)
def test_looks_change_without_preparing(look: dict[str, Any]) -> None:
    frames = {}
    for technique in ("static", FULL):
        drawn = dg.Renderer(size=SIZE, antialias="none")
        scene = varied_scene(technique)
        drawn.preprocess(scene)
        drawn.update(MAP)
        before = drawn.render().image.copy()
        drawn.restyle(0, **look)
        frames[technique] = drawn.render()
        assert (frames[technique].image != before).any()
    static, loops = frames.values()
    np.testing.assert_array_equal(loops.ids, static.ids)
    assert np.abs(loops.image.astype(int) - static.image).max() <= 2


def passes(frame: dg.Frame) -> list[str]:
    return [one["name"] for one in frame.stats.passes]


def test_cells_are_made_anew_only_for_what_they_do_not_hold() -> None:
    frames = {}
    for technique in ("static", FULL):
        scene = flat_scene()
        rings = [shapes.rough_ring(i, 50.0, 50.0, 45.0 - 8.0 * i) for i in range(5)]
        layer = scene.add_polygons(
            rings, color=shapes.tints(5, 4), order=[4, 3, 2, 1, 0], technique=technique
        )
        drawn = dg.Renderer(size=SIZE, antialias="none")
        drawn.preprocess(scene)
        drawn.update(MAP)
        drawn.render()
        looks: list[tuple[dict[str, Any], bool]] = [
            ({"color": "red"}, False),
            ({"visible": [True, True, False, True, True]}, False),
            ({"visible": True}, False),
            ({"visible": [False, True, True, True, True]}, True),  # the largest one hid the others
            ({"color": shapes.tints(5, 5)}, False),
            ({"visible": True}, True),  # it was not there
        ]
        frames[technique] = []
        for look, is_made_anew in looks:
            drawn.restyle(layer, **look)
            frame = drawn.render()
            frames[technique].append((frame.image.copy(), frame.ids.copy()))
            if technique is FULL:
                assert ("loops: cells" in passes(frame)) == is_made_anew, look
    for (static, static_ids), (loops, loops_ids) in zip(*frames.values(), strict=True):
        np.testing.assert_array_equal(loops_ids, static_ids)
        assert np.abs(loops.astype(int) - static).max() <= 2


@pytest.mark.parametrize("bvh", [None, "fitted"])
def test_other_looks_inside_a_lens(bvh: str | None) -> None:
    frames = {}
    order: dict[str, Any] = {} if bvh else {"order": [float(i * 7 % 25) for i in range(25)]}
    for technique in ("static", dg.Loops(bvh=bvh, detail=FULL.detail)):
        drawn = dg.Renderer(size=SIZE, antialias="none")
        scene = varied_scene(technique)
        drawn.preprocess(scene)
        drawn.update(MAP)
        before = drawn.render().image.copy()
        drawn.lens = dg.Lens(circle=(50.0, 50.0, 30.0), styles={0: {"color": "red", **order}}, hidden=(1,))
        frames[technique] = drawn.render()
        assert (frames[technique].image != before).any()
    static, loops = frames.values()
    np.testing.assert_array_equal(loops.ids, static.ids)
    np.testing.assert_array_equal(loops.layers, static.layers)
    assert np.abs(loops.image.astype(int) - static.image).max() <= 2
    for at in ((50, 50), (45, 60), (5, 5)):
        assert [str(each) for each in loops.pick(*at)] == [str(each) for each in static.pick(*at)]


def test_a_lens_has_details_of_its_own() -> None:
    drawn, layer = prepared(FULL)
    drawn.set_picture((400, 400), "coverage")
    drawn.update(MAP)
    full = drawn.render().image.copy()
    coarse = dataclasses.replace(FULL, detail=dg.Detail(screen=None, uniform=20.0))
    drawn.restyle(layer, technique=coarse)
    nothing = drawn.render().image.copy()
    drawn.lens = dg.Lens(circle=(200.0, 200.0, 120.0), styles={layer: {"technique": FULL}})
    seen = drawn.render().image
    y, x = np.mgrid[0:400, 0:400] + 0.5
    apart = np.hypot(x - 200.0, y - 200.0)
    np.testing.assert_array_equal(seen[apart < 118.0], full[apart < 118.0])
    np.testing.assert_array_equal(seen[apart > 122.0], nothing[apart > 122.0])
    assert (full != nothing)[apart > 122.0].any()


@pytest.mark.parametrize("bvh", [None, "efficient"])
def test_what_is_opened_draws_what_was_saved(bvh: str | None, tmp_path: Path) -> None:
    detail = dg.Detail(screen=2.0, by_distance=((10.0, 0.5), (80.0, 3.0)), lens=(50.0, 50.0, 20.0))
    saved = dg.Renderer(size=SIZE, antialias="none")
    saved.preprocess(varied_scene(dg.Loops(bvh=bvh, detail=detail)))
    saved.restyle(0, color=shapes.tints(25, 7, 0.4))
    saved.save(tmp_path / "map")
    opened = dg.Renderer(size=SIZE, antialias="none")
    opened.open(tmp_path / "map")
    opened.save(tmp_path / "again")
    assert (tmp_path / "again").read_bytes() == (tmp_path / "map").read_bytes()
    changes: list[dict[str, Any]] = [{"visible": [i % 3 > 0 for i in range(25)]}, {"color": "red"}]
    for change in changes:
        frames = []
        for drawn in (saved, opened):
            drawn.restyle(0, **change)
            drawn.update(MAP)
            frames.append(drawn.render())
        saved_scenes.assert_same(*frames)


def test_cells_hold_what_is_in_the_picture() -> None:
    drawn, _ = prepared(dg.Loops())
    counts = drawn.render().stats.counts
    near = dg.Camera.top_down((40.0, 40.0, 60.0, 60.0))
    drawn.update(near)
    seen = drawn.render().stats.counts
    # What is out of the picture is not among them.
    assert seen["loops_references"] < 0.5 * counts["loops_references"]
    drawn.update(MAP)
    assert drawn.render().stats.counts["loops_references"] == counts["loops_references"]


# Levels of detail by place


def prepared(technique: dg.Loops) -> tuple[dg.Renderer, dg.Layer]:
    """Rings that do not overlap, so that none needs another."""
    scene = flat_scene()
    rings = [shapes.rough_ring(i, 10.0 + 20.0 * (i % 5), 10.0 + 20.0 * (i // 5), 5.0) for i in range(25)]
    layer = scene.add_polygons(rings, color=shapes.tints(25, 4), technique=technique)
    drawn = dg.Renderer(size=(400, 400), antialias="none")
    drawn.preprocess(scene)
    drawn.update(MAP)
    return drawn, layer


def set_detail(drawn: dg.Renderer, layer: dg.Layer, detail: dg.Detail) -> None:
    drawn.restyle(layer, technique=dataclasses.replace(layer.technique, detail=detail))


@pytest.mark.parametrize("bvh", [None, "fitted"])
def test_detail_changes_without_preparing(bvh: str | None) -> None:
    drawn, layer = prepared(dataclasses.replace(FULL, bvh=bvh))
    full = drawn.render()
    before, ids = full.image.copy(), full.ids.copy()
    set_detail(drawn, layer, dg.Detail(screen=None, uniform=2.0))
    coarse = drawn.render()
    assert (coarse.ids != ids).any()
    if bvh is not None:
        assert coarse.stats.bytes == full.stats.bytes  # nothing new was uploaded
    else:
        assert coarse.stats.counts["loops_primitives"] < 0.5 * full.stats.counts["loops_primitives"]
    set_detail(drawn, layer, FULL.detail)
    again = drawn.render()
    np.testing.assert_array_equal(again.image, before)
    # Frames of before stay right.
    assert (coarse.ids != ids).any()


def test_a_lens_shows_everything_inside_it() -> None:
    drawn, layer = prepared(FULL)
    full = drawn.render().ids.copy()
    set_detail(drawn, layer, dg.Detail(screen=None, uniform=50.0))
    nothing = drawn.render().ids.copy()
    set_detail(drawn, layer, dg.Detail(screen=None, uniform=50.0, lens=(50.0, 50.0, 20.0)))
    seen = drawn.render().ids
    y, x = (np.mgrid[0:400, 0:400] + 0.5) / 4.0
    inside = np.hypot(x - 50.0, 100.0 - y - 50.0) < 20.0
    far = np.hypot(x - 50.0, 100.0 - y - 50.0) > 45.0
    np.testing.assert_array_equal(seen[inside], full[inside])
    np.testing.assert_array_equal(seen[far], nothing[far])
    assert (full[far] != nothing[far]).any()


def test_details_by_distance_and_a_second_camera() -> None:
    drawn, layer = prepared(FULL)
    full = drawn.render().ids.copy()
    corner = dg.Camera.look_at((0.0, 0.0, 2.0), (50.0, 50.0, 0.0))
    steps = ((30.0, 0.0), (60.0, 20.0))
    set_detail(drawn, layer, dg.Detail(screen=None, by_distance=steps, camera=corner))
    seen = drawn.render().ids
    y, x = (np.mgrid[0:400, 0:400] + 0.5) / 4.0
    distance = np.hypot(x, 100.0 - y)
    np.testing.assert_array_equal(seen[distance < 30.0], full[distance < 30.0])
    assert (seen != full)[distance > 60.0].mean() > 0.02
    # What lies behind the camera is drawn in full, as nothing there can be off on its screen.
    set_detail(drawn, layer, dg.Detail(screen=20.0, camera=corner, camera_size=(100, 100)))
    watched = drawn.render().ids
    assert (watched != full)[distance > 60.0].any()
    # The least of two bounds counts.
    set_detail(drawn, layer, dg.Detail(screen=20.0, uniform=0.0, camera=corner, camera_size=(100, 100)))
    np.testing.assert_array_equal(drawn.render().ids, full)


def test_heat_maps_count_primitives() -> None:
    drawn, layer = prepared(dataclasses.replace(FULL, bvh="fitted"))
    heat = {}
    for shows in ("tested", "active"):
        for uniform in (0.0, 3.0):
            set_detail(drawn, layer, dg.Detail(screen=None, uniform=uniform, shows=shows, heat_top=40.0))
            image = drawn.render().image[..., :3].astype(int)
            heat[shows, uniform] = int((image[..., 0] + image[..., 1]).sum())  # rise with the count
    assert heat["tested", 3.0] > heat["active", 3.0] > 0
    assert heat["active", 0.0] > heat["active", 3.0]
    drawn.set_picture((100, 100), "coverage")
    with pytest.raises(dg.UnsupportedError, match="antialias"):
        drawn.update(MAP)


# What is refused


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"order": "dougles_peucker"}, "Did you mean 'douglas_peucker'"),
        ({"primitives": "quad"}, "'tri', 'seg'"),
        ({"bvh": "constan"}, "'constant'"),
        ({"bvh": dg.LoopsBvh((10,))}, "square"),
        ({"bvh": dg.LoopsBvh((4,), 45, (2,), (4,))}, "secondary"),
        ({"detail": None}, "Detail"),
    ],
)
def test_bad_options_are_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(dg.InputError, match=words):
        dg.Loops(**options)


def test_bad_levels_of_detail_are_refused() -> None:
    with pytest.raises(dg.InputError, match="screen"):
        dg.Detail(screen=-1.0)
    with pytest.raises(dg.InputError, match="everywhere"):
        dg.Loops(detail=dg.Detail(screen=None))
    with pytest.raises(dg.InputError, match="must not fall"):
        dg.Loops(detail=dg.Detail(by_distance=((1.0, 2.0), (2.0, 1.0))))
    with pytest.raises(dg.InputError, match="shows"):
        dg.Detail(shows="all")


def test_what_it_does_not_draw_is_refused() -> None:
    scene = flat_scene()
    scene.add_lines([LineString([(0, 0), (9, 9)])], width_units="m", dash="dashed", technique="loops")
    with pytest.raises(dg.UnsupportedError, match="dashes"):
        draw(scene)
    scene = flat_scene()
    layer = scene.add_polygons([box(10, 10, 50, 50)], technique=dg.Loops(bvh="fitted"))
    other = scene.add_polygons([box(20, 20, 30, 30)], name="other", technique="static")
    drawn = dg.Renderer(size=SIZE, antialias="none")
    drawn.preprocess(scene)
    with pytest.raises(dg.UnsupportedError, match="bvh=None"):
        drawn.restyle(layer, order=[0.0])
    with pytest.raises(dg.StyleError, match="the layer's own"):
        drawn.restyle(other, technique=dg.Loops())
    with pytest.raises(dg.StyleError, match="detail alone"):
        drawn.restyle(layer, technique=dg.Loops(order="wang_mueller"))
