"""The published indexes: against the reference on every scene, against the grid pixel by pixel, and their options."""

from __future__ import annotations

import dataclasses
import functools
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, Polygon, box

import decalgl as dg
import judge
import scenes
import shapes
from decalgl import reference as ref
from decalgl.strokes import Stroke, StrokeStyle
from scenes import View
from small_scenes import MAP, SIZE, draw, flat_scene

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    BoolArray = NDArray[np.bool_]

WITH_GROUND = [name for name in scenes.SCENES if name not in ("one_sample", "one_row")]
# Thousands of features over one metre fill a grid that is laid over just them.
FEW_CELLS = {"crowd": dg.BvhIndex(cells=16)}
QUANTA = 1.5
# Half the widths of `crossing_lines`, metres.
REACH = np.linspace(1.0, 4.5, 60)


@functools.cache
def renderer(index: str | dg.BvhIndex) -> dg.Renderer:
    """One renderer for each index; it draws every sample of the terrain."""
    return dg.Renderer(terrain_error=0.0, index=index)


def tolerance(*frames: dg.Frame) -> float:
    """How far from an edge frames may be wrong, metres."""
    return QUANTA * max(float(frame.stats.counts["quantum_m"]) for frame in frames)


def far_from_edges(view: View, frame: dg.Frame, pixels: BoolArray, metres: float) -> int:
    distance = ref.edge_distance(view.scene, frame.world[pixels][:, :2])
    return int((distance > metres).sum())


def apart(a: dg.Frame, b: dg.Frame) -> NDArray[np.int64]:
    """The largest difference (h, w) of a channel, in 1/255."""
    difference: NDArray[np.int64] = np.abs(a.image.astype(np.int64) - b.image.astype(np.int64)).max(axis=-1)
    return difference


# Against the reference and the grid


@pytest.mark.parametrize("name", WITH_GROUND)
def test_every_scene_is_as_right_as_in_the_grid(name: str) -> None:
    view = scenes.build(name)
    grid = judge.draw(renderer("grid"), view)
    bvh = judge.draw(renderer(FEW_CELLS.get(name, "bvh")), view)
    assert (bvh.ids >= 0).any()
    own = judge.judge_ids(view, bvh, judge.own_surface(view, bvh), tolerance(bvh))
    assert own.far == 0, own
    differs = (grid.ids != bvh.ids) | (grid.layers != bvh.layers) | (apart(grid, bvh) > 2)
    assert far_from_edges(view, bvh, differs, tolerance(grid, bvh)) == 0


@pytest.mark.parametrize("name", ["hills", "honolulu_above", "far_coordinates", "nested_holes"])
@pytest.mark.parametrize(
    "index",
    [dg.BvhIndex(passes="kind"), dg.BvhIndex(cells=40, leaf_capacity=2, depth_limit=3)],
    ids=["kind", "small"],
)
def test_other_parameters_draw_the_same(name: str, index: dg.BvhIndex) -> None:
    view = scenes.build(name)
    plain, other = judge.draw(renderer("bvh"), view), judge.draw(renderer(index), view)
    np.testing.assert_array_equal(plain.ids, other.ids)
    np.testing.assert_array_equal(plain.layers, other.layers)
    assert apart(plain, other).max() <= 2


def test_translucent_layers_in_few_passes_and_in_many() -> None:
    view = scenes.build("translucent")
    plain = judge.draw(renderer("bvh"), view)
    joined = judge.draw(renderer(dg.BvhIndex(passes="kind")), view)
    assert apart(plain, joined).max() <= 2


@pytest.mark.parametrize("name", ["map_from_above", "slivers"])
@pytest.mark.parametrize("kind", ["polygons", "lines"])
def test_coverage_is_the_mean_over_the_pixel(name: str, kind: str) -> None:
    view = scenes.build(name)
    scene = dg.Scene(view.scene.terrain, view.scene.exaggeration)
    bounds = np.array(scene.terrain.bounds)
    if kind == "polygons":
        cover = shapes.partition(scene.terrain.bounds, 30, 25, seed=3)
        scene.add_polygons(cover, crs=scene.terrain.crs, color=shapes.tints(30 * 25, 3))
    else:
        ends = np.random.default_rng(4).uniform(bounds[:2], bounds[2:], (400, 2))
        width = float(np.hypot(*(bounds[2:] - bounds[:2]))) / 2000.0
        scene.add_lines((ends, 2 * np.arange(201)), width=width, width_units="m", color=shapes.tints(200, 4))
    one = View(scene, view.camera, (640, 360))
    index = renderer(dg.BvhIndex(cells=64))
    crop = judge.busiest_crop(judge.draw(index, one), (40, 24))
    surface = ref.sample_surface(one.scene, one.camera, one.size, crop, 32)
    expected = ref.render_overlay(one.scene, one.camera, one.size, crop, 32, surface=surface)
    ignored = expected.mixed | (expected.terrain_fraction < 1.0) | judge.folded(one, crop, surface, 32)
    got = judge.overlay_of(index, one, "coverage")[crop[1] : crop[3], crop[0] : crop[2]]
    found = ref.compare_overlay(got, expected, ignore=ignored)
    assert found.partial >= 50
    assert found.rms <= 0.015, found
    assert found.p99 <= 0.05, found
    assert found.leak <= 0.02, found


@pytest.mark.parametrize(
    ("index", "turns"),
    [("bvh", range(12)), (dg.BvhIndex(cells=1), range(12)), (dg.BvhIndex(cells=1000), (1, 5))],
    ids=["cells", "cell", "far"],
)
def test_a_straight_edge_errs_by_little_in_any_direction(
    index: str | dg.BvhIndex, turns: Sequence[int]
) -> None:
    """64 samples tell a share of the pixel to 1 / 128; the rest is for the bytes of three pictures.

    Where the map is so small, a pixel has hundreds of cells by default, and of more than 2048 not all are searched.
    """
    for i in turns:
        turn = np.radians(7.5 * i)
        normal, along = np.array((np.cos(turn), np.sin(turn))), np.array((-np.sin(turn), np.cos(turn)))
        middle = np.array((10.31, 8.31)) + 0.037 * i
        corners = middle + np.array(
            [-40 * along, 40 * along, 40 * along + 40 * normal, -40 * along + 40 * normal]
        )
        scene = dg.Scene(dg.Terrain.flat((0.0, 0.0, 20.0, 16.0)))
        scene.add_polygons([Polygon(corners)], color="white")
        one = View(scene, dg.Camera.top_down((0.0, 0.0, 20.0, 16.0)), (20, 16))
        exact = ref.exact_coverage(scene, one.camera.for_size(one.size), one.size, 0, 0, (0, 0, 20, 16))
        error = judge.overlay_of(renderer(index), one, "coverage")[..., 3] - exact
        assert np.abs(error).max() <= 0.02
        assert ((exact > 0.0) & (exact < 1.0)).sum() >= 15


def test_a_search_for_borders_that_is_cut_short_has_found_one() -> None:
    """Every pixel has some 1800 cells of ten fills below a strip over its upper part, where the search comes last."""
    scene = dg.Scene(dg.Terrain.flat((0.0, 0.0, 12.0, 12.0)))
    strips = [box(0.0, y + 0.64, 12.0, y + 1.0) for y in range(12)]
    scene.add_polygons([box(0.0, 0.0, 12.0, 12.0)] * 10 + strips, color=["black"] * 10 + ["white"] * 12)
    camera = dg.Camera.top_down((0.0, 0.0, 12.0, 12.0))
    image = draw(scene, camera, (12, 12), index="bvh", antialias="coverage").image
    assert np.abs(image[..., :3] / 255.0 - 0.36).max() <= 0.02


def test_neighbours_let_nothing_through() -> None:
    view = scenes.build("map_from_above")
    scene = dg.Scene(view.scene.terrain)
    x0, y0, x1, y1 = scene.terrain.bounds
    beyond = (2 * x0 - x1, 2 * y0 - y1, 2 * x1 - x0, 2 * y1 - y0)
    scene.add_polygons(shapes.partition(beyond, 60, 50, seed=7), crs=scene.terrain.crs, color="olive")
    for antialias in ("none", "coverage"):
        one = View(scene, view.camera, (192, 108))
        frame = judge.draw(renderer("bvh"), one)
        inner = np.isfinite(frame.depth) & (judge.rim_distance(one, frame) > 2.0)
        assert judge.overlay_of(renderer("bvh"), one, antialias)[inner][:, 3].min() == 1.0


def test_pick_lists_what_lies_there() -> None:
    view = scenes.build("hills")
    grid, bvh = judge.draw(renderer("grid"), view), judge.draw(renderer("bvh"), view)
    y, x = np.nonzero(np.isfinite(bvh.depth))
    for i in np.random.default_rng(2).choice(len(x), 100):
        at = int(x[i]), int(y[i])
        distance = ref.edge_distance(view.scene, bvh.world[at[1], at[0]][None, :2])
        if distance[0] > tolerance(grid, bvh):
            assert [(one.layer.index, one.row) for one in bvh.pick(*at)] == [
                (one.layer.index, one.row) for one in grid.pick(*at)
            ]


@pytest.mark.parametrize("index", ["grid", "bvh"])
@pytest.mark.parametrize("correction", ["tangent", "thoeny"])
def test_pick_knows_the_slope_as_the_shaders_do(index: str, correction: str) -> None:
    random = np.random.default_rng(4)
    rugged = dg.Terrain(random.uniform(0.0, 12.0, (21, 21)).astype(np.float32), 0.0, 100.0, 5.0, 5.0)
    ways = [[LineString(random.uniform(0.0, 100.0, (4, 2))) for _ in range(12)] for _ in range(3)]
    camera = dg.Camera.look_at((50.0, -40.0, 70.0), (50.0, 50.0, 0.0))
    tops = []
    for slope_correction in (None, correction):
        style = {"width": 4.0, "width_units": "m", "slope_correction": slope_correction}
        scene = dg.Scene(rugged)
        scene.add_lines(ways[0], corner="miter", dash=(9, 3), **style)
        scene.add_lines(ways[1], corner="bevel", cap="square", **style)
        scene.add_lines(ways[2], bands=[(0.5, "red"), (1.0, "blue")], casing=dg.Casing(width=1), **style)
        frame = draw(scene, camera, index=index)
        hits = [frame.pick(x, y)[:1] for y in range(SIZE[1]) for x in range(SIZE[0])]
        tops.append([(one[0].layer.index, one[0].row) if one else (-1, -1) for one in hits])
        seen = list(zip(frame.layers.ravel().tolist(), frame.ids.ravel().tolist(), strict=True))
        assert tops[-1] == seen
    assert sum(one != other for one, other in zip(*tops, strict=True)) > 200


# Thöny's composition


def crossing_lines() -> tuple[dg.Scene, FloatArray]:
    """Sixty wide segments over 100 m of level ground: the scene and their ends (60, 2, 2)."""
    ends = np.random.default_rng(8).uniform(0.0, 100.0, (60, 2, 2))
    ends[7] = ends[3, ::-1]  # two lines over each other, one of them backwards
    scene = flat_scene()
    scene.add_lines(
        (ends.reshape(-1, 2), 2 * np.arange(61)), width=2 * REACH, width_units="m", color=shapes.tints(60, 9)
    )
    return scene, ends


def distances(ends: FloatArray, points: FloatArray) -> FloatArray:
    """From points (p, 2) to segments (s, 2, 2), as (p, s)."""
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    apart = points[:, None] - start
    t = np.clip((apart * along).sum(axis=-1) / (along**2).sum(axis=-1), 0.0, 1.0)
    distance: FloatArray = np.linalg.norm(apart - t[..., None] * along, axis=-1)
    return distance


@pytest.mark.parametrize("index", ["thoeny", dg.BvhIndex(composition="nearest")], ids=["thoeny", "sorted"])
def test_the_nearest_line_is_seen(index: str | dg.BvhIndex) -> None:
    scene, ends = crossing_lines()
    frame = draw(scene, index=index)
    distance = distances(ends, frame.world[..., :2].reshape(-1, 2))
    distance[:, 3] = distance[:, 7]  # to the last digit
    reached = np.where(distance <= REACH, distance, np.inf)
    # Of equally near ones the topmost, which comes last.
    nearest = 59 - reached[:, ::-1].argmin(axis=1)
    expected = np.where(np.isfinite(reached.min(axis=1)), nearest, -1)
    # The two lines over each other count as one.
    ordered = np.sort(np.delete(distance, 3, axis=1), axis=1)
    unsure = (np.abs(distance - REACH) < 1e-4).any(axis=1) | (ordered[:, 1] - ordered[:, 0] < 1e-4)
    assert unsure.mean() < 0.05
    assert (frame.ids.ravel() == expected)[~unsure].all()
    assert (expected == 7).any()
    assert not (frame.ids == 3).any()
    colors = scene.layers[0].colors
    shown = frame.image.reshape(-1, 4)[:, :3].astype(int)
    sure = ~unsure & (expected >= 0)
    assert np.abs(shown[sure] - colors[expected[sure], :3]).max() <= 1


def test_by_priority_the_topmost_line_is_seen_in_any_order_of_segments() -> None:
    scene, ends = crossing_lines()
    frame = draw(scene, index=dg.BvhIndex(segment_order="hilbert"))
    distance = distances(ends, frame.world[..., :2].reshape(-1, 2))
    covers = distance <= REACH
    expected = np.where(covers.any(axis=1), 59 - covers[:, ::-1].argmax(axis=1), -1)
    unsure = (np.abs(distance - REACH) < 1e-4).any(axis=1)
    assert (frame.ids.ravel() == expected)[~unsure].all()


def test_translucent_lines_along_a_curve() -> None:
    scene = flat_scene()
    line = shapes.walk(np.random.default_rng(5), np.array([50.0, 50.0]), 5.0, 20)
    scene.add_lines((line, [0, len(line)]), width=3, width_units="m", alpha=0.5)
    with pytest.raises(dg.UnsupportedError, match=r"translucent lines.*composition=\"nearest\""):
        draw(scene, index=dg.BvhIndex(segment_order="hilbert"))
    assert (draw(scene, index="thoeny").ids == 0).any()


# Coverage


def test_layers_over_each_other_show_the_upper_one_alone() -> None:
    """Where edges of two layers are the same, the mean is that of the composite."""
    cover = shapes.partition((10.0, 10.0, 90.0, 90.0), 7, 6, seed=3)
    one, both = flat_scene(), flat_scene()
    both.add_polygons(cover, color="lime")
    for scene in (one, both):
        scene.add_polygons(cover, color="red")
    size, camera = (83, 83), dg.Camera.top_down((0.0, 0.0, 100.0, 100.0))
    pictures = [draw(scene, camera, size, index="bvh", antialias="coverage").image for scene in (one, both)]
    np.testing.assert_array_equal(*pictures)


def line_coverage(width: float, **options: Any) -> FloatArray:
    """Coverage (100,) down a column of metres, of a level line through the middle of one; `width` in pixels."""
    scene = flat_scene()
    scene.add_lines(
        (np.array([[-50.0, 60.5], [150.0, 60.5]]), [0, 2]), width=width, width_units="m", color="black"
    )
    bare, drawn = (
        draw(each, antialias="coverage", **options).image[:, 50, 0].astype(float)
        for each in (flat_scene(), scene)
    )
    coverage: FloatArray = 1.0 - drawn / bare
    return coverage


@pytest.mark.parametrize("index", ["bvh", "thoeny"])
@pytest.mark.parametrize("width", [0.05, 0.5, 1.0, 4.0])
def test_lines_thinner_than_a_pixel_fade(index: str, width: float) -> None:
    coverage = line_coverage(width, index=index, coverage="thoeny")
    assert coverage.sum() == pytest.approx(width, abs=0.01)
    assert coverage[39] == pytest.approx(min(width, 1.0), abs=0.005)
    assert (coverage > 0.002).sum() == (1 if width <= 1.0 else 5)


def test_polygons_stay_exact_below_lines_by_coverage() -> None:
    scene = flat_scene()
    scene.add_polygons([box(20.3, 20.3, 60.7, 60.7)], color="teal")
    exact = draw(scene, index="bvh", antialias="coverage")
    scene.add_lines(
        (np.array([[5.0, 90.0], [80.0, 90.5]]), [0, 2]), width=0.7, width_units="m", color="black"
    )
    both = draw(scene, index="bvh", antialias="coverage", coverage="thoeny")
    np.testing.assert_array_equal(both.image[30:], exact.image[30:])
    assert "static_bvh[THOENY]" in both.stats.variants


def test_groups_by_coverage_keep_their_order_between_fills() -> None:
    scene = flat_scene()
    for i, color in enumerate(("#00808099", "#ffd70099", "#80008099")):
        scene.add_polygons([box(10 + 10 * i, 10, 60 + 10 * i, 90 - 10 * i)], color=color)
        for y in (20.0, 30.0):
            line = np.array([[-50.0, y + 10 * i], [150.0, y + 10 * i]])
            scene.add_lines((line, [0, 2]), width=8.0, width_units="m", color="#00000080")
    exact, estimated = (
        draw(scene, index="bvh", antialias="coverage", coverage=rule) for rule in ("exact", "thoeny")
    )
    # All edges lie on those of pixels.
    assert apart(estimated, exact).max() <= 1


def test_a_line_in_low_cells_has_no_gaps() -> None:
    scene = flat_scene()
    line = np.array([[2.0, 50.2], [98.0, 52.7]])
    scene.add_lines((line, [0, 2]), width=0.3, width_units="m", color="black")
    drawn, bare = (
        draw(each, index="bvh", antialias="coverage", coverage="thoeny").image[:, 5:95, 0].astype(float)
        for each in (scene, flat_scene())
    )
    # Cells are 5 mm high; each column of pixels has all of the line's width.
    np.testing.assert_allclose((1.0 - drawn / bare).sum(axis=0), 0.3, atol=0.02)


def test_coverage_by_estimate_takes_no_longer_than_by_samples() -> None:
    scene = flat_scene()
    along = np.linspace(-5.0, 105.0, 200)
    for y in range(10, 90, 10):
        waves = np.stack([along, y + 4.0 * np.sin(along)], axis=-1)
        scene.add_lines((waves, [0, len(waves)]), width=1.0, width_units="m", color="black")
    scene.add_polygons([box(20.3, 20.3, 60.7, 60.7)], color="#00808080")
    seconds = {}
    for rule in ("exact", "thoeny"):
        drawer = dg.Renderer(size=(200, 200), index="bvh", antialias="coverage", coverage=rule)
        drawer.preprocess(scene)
        drawer.update(MAP)
        drawer.render()  # compiles
        times = []
        for _ in range(3):
            begin = time.perf_counter()
            drawer.render()
            times.append(time.perf_counter() - begin)
        seconds[rule] = min(times)
    # It takes a third in software, and 20 times as long where lines are drawn for each sample of the fill.
    assert seconds["thoeny"] < 3.0 * seconds["exact"]


def test_coverage_is_one_that_there_is() -> None:
    with pytest.raises(dg.InputError, match="There is no coverage='msaa'; choose 'exact' or 'thoeny'"):
        dg.Renderer(coverage="msaa", index="bvh")


def test_coverage_by_estimate_is_the_same_in_both_indexes() -> None:
    scene = flat_scene()
    scene.add_polygons([box(60, 55, 90, 85)], color="seagreen", alpha=0.6)
    for i, width in enumerate((0.3, 1.0, 2.5, 6.0)):
        line = LineString([(5, 10 + 11 * i), (55, 14 + 14 * i), (95, 8 + 9 * i)])
        scene.add_lines([line], width=width, width_units="m", color="navy")
    images = []
    for index in ("grid", "bvh"):
        renderer = dg.Renderer(size=(200, 200), coverage="thoeny", index=index)
        renderer.preprocess(scene)
        renderer.update(dg.Camera.top_down((0, 0, 100, 100)))
        images.append(renderer.render(background="white").image.astype(int))
    # The grid sees pixels within a stroke, or beside it, as such; the estimate errs there by up to a twentieth.
    assert np.abs(images[0] - images[1]).max() <= 0.06 * 255


# Styles


def styled(mode: str, style: StrokeStyle) -> dg.Scene:
    """A square of teal from 30 to 70 m with a red outline of 10 m."""
    scene = flat_scene()
    layer = scene.add_polygons([box(30, 30, 70, 70)], color="teal")
    stroke = Stroke(np.array([[255, 0, 0, 255]], dtype=np.uint8), np.array([10.0]), (style,))
    scene._layers[0] = dataclasses.replace(layer, stroke=stroke, outline_mode=mode)
    return scene


@pytest.mark.parametrize(("mode", "low", "high"), [("inset", 30, 40), ("normal", 25, 35), ("offset", 20, 30)])
@pytest.mark.parametrize("corner", ["miter", "round", "bevel"])
def test_outlines_lie_where_their_mode_and_corner_say(mode: str, low: int, high: int, corner: Any) -> None:
    frame = draw(styled(mode, StrokeStyle(corner=corner)), index="bvh")
    red = (frame.image[::-1] == (255, 0, 0, 255)).all(axis=-1)  # row 0 at the bottom
    assert red[50, low:high].all()
    assert not red[50, high]
    assert not red[50, low - 1]
    # The outer corner's own square metre.
    assert red[low, low] == (corner == "miter" or mode == "inset")
    assert frame.pick(50, 50)[0].row == 0


def test_shaders_have_what_styles_ask_for() -> None:
    plain = draw(styled("normal", StrokeStyle()), index="bvh")
    assert {name for name in plain.stats.variants if "bvh" in name} == {"static_bvh", "static_bvh[RINGS]"}
    mitred = draw(styled("inset", StrokeStyle(corner="miter")), index="bvh")
    assert {name for name in mitred.stats.variants if "bvh" in name} == {"static_bvh[BOTH,CORNERS,INSET]"}


# Options


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"cells": 0}, "cells must be a whole number from 1 to 4096"),
        ({"cells": 4097}, "cells must be"),
        ({"cells": 2.5}, "cells must be"),
        ({"leaf_capacity": 0}, "leaf_capacity must be a whole number from 1 to 1024"),
        ({"depth_limit": 17}, "depth_limit must be a whole number from 0 to 16"),
        ({"segment_order": "random"}, "segment_order must be 'importance' or 'hilbert'"),
        ({"composition": "last"}, "composition must be 'order' or 'nearest'"),
        ({"passes": 3}, "passes must be 'layer' or 'kind'"),
    ],
)
def test_wrong_parameters_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(dg.InputError, match=message):
        dg.BvhIndex(**options)


@pytest.mark.parametrize("index", ["tree", None, 3])
def test_an_unknown_index_is_refused(index: Any) -> None:
    with pytest.raises(dg.InputError, match=r"There is no index=.*choose 'grid', 'bvh', 'thoeny'"):
        dg.Renderer(index=index)


def test_an_index_that_cannot_be_held_is_refused() -> None:
    scene = scenes.build("crowd").scene
    with pytest.raises(dg.MemoryLimitError, match="use fewer cells"):
        dg.Renderer(index=dg.BvhIndex(cells=4096)).preprocess(scene)
    with pytest.raises(dg.MemoryLimitError, match="memory_limit"):
        dg.Renderer(index=FEW_CELLS["crowd"], memory_limit=1 << 20).preprocess(scene)


def test_only_what_is_needed_is_drawn() -> None:
    scene = flat_scene()
    frame = draw(scene, index="bvh")
    assert not any(one["name"] == "static_bvh" for one in frame.stats.passes)
    scene.add_polygons([box(20, 20, 60, 60)], color="teal")
    frame = draw(scene, index="bvh")
    assert [one["name"] for one in frame.stats.passes].count("static_bvh") == 1
    assert [name for name in frame.stats.variants if "static" in name] == ["static_bvh[RINGS]"]
    assert "static_bvh: segments" not in frame.stats.objects


def test_a_scene_keeps_its_renderer_while_the_index_stays() -> None:
    scene, _ = crossing_lines()
    first = draw(scene, index=dg.BvhIndex(cells=30))
    again = draw(scene, index=dg.BvhIndex(cells=30))
    assert first.stats.stages["preprocess"] == again.stats.stages["preprocess"]
    assert draw(scene, index="grid").stats.stages["preprocess"] != first.stats.stages["preprocess"]
    np.testing.assert_array_equal(first.ids, again.ids)


def test_a_picture_in_tiles_is_the_same() -> None:
    scene, _ = crossing_lines()
    for antialias in ("none", "coverage"):
        whole = draw(scene, index="bvh", antialias=antialias)
        tiled = draw(scene, index="bvh", antialias=antialias, tile=37)
        np.testing.assert_array_equal(whole.image, tiled.image)
        np.testing.assert_array_equal(whole.ids, tiled.ids)


def test_long_walks_are_reported() -> None:
    scene, _ = crossing_lines()
    one = dg.Renderer(size=SIZE, antialias="none", index=dg.BvhIndex(cells=1))
    one.preprocess(scene)
    assert 60 < one.update(MAP)["longest_walk"] <= 2 * 64
