"""Frames: what their arrays hold, pick, what they say after the scene and the renderer went on, and saving."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image
from shapely import LineString, box

import decalgl as dg
from small_scenes import (
    BOUNDS,
    DIAGONAL,
    MAP,
    OBLIQUE,
    RED,
    SIZE,
    count_color,
    draw,
    flat_scene,
    hilly_scene,
    pixel,
)

if TYPE_CHECKING:
    from pathlib import Path


def layered_scene() -> dg.Scene:
    """Two polygons and a line, which all lie over (50, 50)."""
    scene = hilly_scene()
    scene.add_polygons(
        [box(0, 0, 5, 5), box(20, 20, 80, 80), box(40, 40, 60, 60)], color="red", name="fields"
    )
    scene.add_lines([DIAGONAL], width=8, width_units="m", color="blue", alpha=0.5, name="road")
    return scene


def test_arrays() -> None:
    frame = draw(layered_scene(), OBLIQUE, (64, 48))
    assert frame.size == (64, 48)
    expected = {
        "image": ((48, 64, 4), np.uint8),
        "ids": ((48, 64), np.int64),
        "layers": ((48, 64), np.int32),
        "depth": ((48, 64), np.float32),
        "world": ((48, 64, 3), np.float64),
    }
    for name, (shape, dtype) in expected.items():
        array = getattr(frame, name)
        assert (array.shape, array.dtype) == (shape, dtype), name
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
        np.testing.assert_array_equal(array, getattr(frame, name))


def test_arrays_outlive_their_frame_and_renderer() -> None:
    scene = layered_scene()
    frame = draw(scene)
    ids, again = frame.ids, frame.ids.copy()
    del frame, scene
    draw(flat_scene())
    np.testing.assert_array_equal(ids, again)


def test_sky_is_marked() -> None:
    frame = draw(layered_scene(), dg.Camera.look_at((50, -80, 10), (50, 0, 15)))
    sky = np.isinf(frame.depth)
    assert 0.1 < sky.mean() < 0.9
    assert np.isnan(frame.world[sky]).all()
    assert np.isfinite(frame.world[~sky]).all()
    assert (frame.ids[sky] == -1).all()
    assert (frame.layers[sky] == -1).all()
    x, y = np.argwhere(sky)[0][::-1].tolist()
    assert frame.pick(x, y) == []


def test_world_and_depth_lie_on_the_pixels_ray() -> None:
    size = (64, 48)
    for camera in (OBLIQUE, MAP):
        frame = draw(hilly_scene(), camera, size)
        rows, columns = np.nonzero(np.isfinite(frame.depth))
        centres = np.column_stack([columns + 0.5, rows + 0.5])
        seen, depth = camera.project(frame.world[rows, columns], size)
        np.testing.assert_allclose(seen, centres, atol=0.01)
        np.testing.assert_allclose(depth, frame.depth[rows, columns], rtol=1e-6)


def test_ids_and_layers_name_the_topmost_feature() -> None:
    frame = draw(layered_scene())
    at = {
        (2, 2): (0, 1),
        (2, 4): (0, 1),
        (30, 70): (1, 0),
        (58, 42): (2, 0),
        (50, 50): (0, 1),
        (90, 10): (-1, -1),
    }
    for (x, y), (row, layer) in at.items():
        place = (SIZE[1] - 1 - y, x)
        assert (frame.ids[place], frame.layers[place]) == (row, layer), (x, y)


def test_ids_do_not_depend_on_the_antialiasing() -> None:
    scene = layered_scene()
    hard, soft = draw(scene, OBLIQUE), draw(scene, OBLIQUE, antialias="coverage")
    assert (hard.image != soft.image).any()
    np.testing.assert_array_equal(hard.ids, soft.ids)
    np.testing.assert_array_equal(hard.layers, soft.layers)


def test_polygons_of_one_colour_are_coloured_where_their_ids_are() -> None:
    # Along a border, the first crossings of a list alone do not say whether a pixel is inside.
    scene = flat_scene()
    scene.add_polygons([box(20, 20, 80, 80)] * 254, color="red")
    frame = scene.render(MAP, SIZE, antialias="none", background=None)
    assert "static_decals[ONE_COLOR,RINGS]" in frame.stats.variants
    is_red = (frame.image[..., :3] == (255, 0, 0)).all(axis=2)
    assert (is_red == (frame.ids >= 0)).all()
    assert is_red.any()


def test_pick_lists_all_features_topmost_first() -> None:
    scene = layered_scene()
    frame = draw(scene)
    fields, road = scene.layers
    assert frame.pick(50, 50) == [dg.Picked(road, 0), dg.Picked(fields, 2), dg.Picked(fields, 1)]
    assert str(frame.pick(50, 50)[1]) == "fields, row 2"
    assert frame.pick(np.int64(50), 50.0) == frame.pick(50, 50)  # type: ignore[arg-type]
    assert frame.pick(0, 50) == []


@pytest.mark.parametrize(
    "place",
    [
        (-1, 0),
        (0, 100),
        (100, 0),
        (0.5, 0),
        (float("nan"), 0),
        (float("inf"), 0),
        ("x", 0),
        (None, 0),
        (1 << 70, 0),
    ],
)
def test_pick_outside_the_picture(place: Any) -> None:
    frame = draw(flat_scene())
    with pytest.raises(dg.InputError, match=r"no pixel of this picture.*\(99, 99\)"):
        frame.pick(*place)


def test_frames_stay_right_when_the_scene_goes_on() -> None:
    scene = layered_scene()
    early = draw(scene)
    scene.add_polygons([box(0, 0, 100, 100)], color="green", name="cover")
    late = draw(scene, OBLIQUE, (40, 30), antialias="coverage")
    assert (late.layers.max(), late.ids.shape) == (2, (30, 40))
    fresh = draw(layered_scene())
    for name in ("image", "ids", "layers", "depth", "world"):
        np.testing.assert_array_equal(getattr(early, name), getattr(fresh, name), err_msg=name)
    assert [str(found) for found in early.pick(50, 50)] == ["road, row 0", "fields, row 2", "fields, row 1"]
    assert late.layers.max() == 2


def test_a_renderer_that_went_on_to_another_scene_answers_for_the_old_one() -> None:
    first, second = flat_scene(), flat_scene()
    first.add_polygons([box(0, 0, 50, 100)], name="old", color="red")
    second.add_polygons([box(50, 0, 100, 100)], name="new", color="red")
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(first)
    renderer.update(MAP)
    renderer.preprocess(second)  # not yet what is drawn
    frame = renderer.render()
    assert [found.layer.name for found in frame.pick(10, 50)] == ["old"]
    renderer.update(MAP)
    after = renderer.render()
    assert [found.layer.name for found in after.pick(90, 50)] == ["new"]
    assert (frame.ids[:, :50] == 0).all()
    assert (frame.ids[:, 50:] == -1).all()
    assert (after.ids[:, 50:] == 0).all()


def test_backgrounds() -> None:
    scene = flat_scene()
    camera = dg.Camera.look_at((50, -80, 10), (50, 0, 15))
    sky = np.isinf(draw(scene, camera).depth)
    assert (draw(scene, camera, background=None).image[sky, 3] == 0).all()
    assert (draw(scene, camera, background=None).image[~sky, 3] == 255).all()
    assert (draw(scene, camera, background="#0000ff").image[sky] == (0, 0, 255, 255)).all()
    assert (draw(scene, camera, background=(0, 0, 1, 0.5)).image[sky] == (0, 0, 255, 128)).all()
    graded = draw(scene, camera).image[sky]
    assert (graded[:, 3] == 255).all()
    assert len(np.unique(graded, axis=0)) > 5, "the sky is darker above"


def test_map_views_have_square_ground_pixels() -> None:
    scene = flat_scene()
    scene.add_polygons([box(20, 20, 60, 60)], color="red")
    wide = draw(scene, dg.Camera.top_down(BOUNDS), (200, 100), background=None)
    assert count_color(wide, RED) == 1600
    assert wide.image[50, 0, 3] == 0, "left of the terrain"
    zoomed = draw(scene, dg.Camera.top_down((20, 20, 60, 60)), (80, 80))
    assert count_color(zoomed, RED) == 6400


def test_cameras_straight_above_and_below_the_horizon() -> None:
    scene = flat_scene()
    scene.add_polygons([box(40, 60, 60, 100)], color="red")
    above = draw(scene, dg.Camera.orbit((50, 50, 0), 150, azimuth=180, elevation=90))
    assert pixel(above, 50, 80) == RED, "north is up"
    below = draw(scene, dg.Camera.orbit((50, 50, 0), 150, azimuth=180, elevation=-60))
    assert below.image.shape == (100, 100, 4)
    away = draw(scene, dg.Camera.look_at((50, 50, 10), (50, 50, 20)))
    assert np.isinf(away.depth).all()


def test_stats() -> None:
    scene = layered_scene()
    stats = draw(scene).stats
    assert [one["name"] for one in stats.passes] == ["upload", "terrain", "static", "compose", "readback"]
    assert set(stats.stages) == {"preprocess", "update", "render", "readback"}
    assert all(one["ms"] >= 0.0 for one in stats.passes)
    assert all(milliseconds >= 0.0 for milliseconds in stats.stages.values())
    assert set(stats.bytes) == {"frame", "static", "terrain"}
    assert stats.bytes["static"] == sum(n for name, n in stats.objects.items() if name.startswith("static:"))
    assert stats.counts["features"] == 4
    assert stats.counts["segments"] > 0
    assert 0.0 < stats.counts["quantum_m"] < 1e-3
    assert json.loads(json.dumps(stats.to_dict())) == stats.to_dict()
    moved = draw(scene, OBLIQUE).stats
    assert [one["name"] for one in moved.passes] == ["terrain", "static", "compose", "readback"], "no upload"
    assert 0.0 < moved.counts["uploaded_bytes"] < stats.counts["uploaded_bytes"] / 10
    assert 0.0 < moved.counts["quantum_px"] < 0.01


def variants(scene: dg.Scene, **options: Any) -> set[str]:
    """The flags of all programs that a first picture of this scene needed."""
    names = draw(scene, **options).stats.variants
    flags = {flag for name in names if "[" in name for flag in name.rstrip("]").split("[")[1].split(",")}
    return flags | {name.split("[")[0] for name in names}


# Flags of the passes that filter a picture over the pixels' areas.
AREA_PASSES = {"CLASSES", "CELLS", "POINTS", "LEVELS"}


def test_nothing_runs_that_the_scene_does_not_need() -> None:
    square, line = box(20, 20, 60, 60), LineString([(0, 0), (100, 100)])
    bare = flat_scene()
    assert variants(bare) == {"terrain", "compose"}
    assert not any(one["name"] == "static" for one in draw(bare).stats.passes)
    assert "static" not in draw(bare).stats.bytes
    unseen = flat_scene()
    unseen.add_polygons([square], alpha=0.0)
    assert variants(unseen) == {"terrain", "compose"}
    opaque = flat_scene()
    opaque.add_polygons([square])
    needed = {"terrain", "compose", "static_decals", "OVERLAY", "RINGS"}
    assert variants(opaque) == needed | {"ONE_COLOR"}
    assert variants(opaque, antialias="coverage", tile=512) == needed | AREA_PASSES | {"silhouettes"}
    colourful = flat_scene()
    colourful.add_polygons([square, line.buffer(1)], color=["red", "green"])
    assert variants(colourful) == needed
    clear = flat_scene()
    clear.add_lines([line], width=2, width_units="m", alpha=0.5)
    assert variants(clear) >= {"static_decals", "OVERLAY", "LINES", "TRANSLUCENT"}
    assert not variants(clear) & ({"RINGS", "IDS", "HOLES", "RAMP"} | AREA_PASSES)
    holes = np.zeros((4, 4), np.float32)
    holes[1, 1] = np.nan
    assert "HOLES" in variants(dg.Scene(dg.Terrain(holes, 0, 100, 30, 30)))
    assert "RAMP" in variants(hilly_scene(relief=dg.Relief(cmap="Greens")))


def test_levels_of_detail_are_for_far_pictures_alone() -> None:
    near, far = dg.Camera.top_down((30, 30, 50, 50)), dg.Camera.top_down((-20_000, -20_000, 20_000, 20_000))
    for camera, antialias, drawn in (
        (near, "coverage", False),
        (far, "coverage", True),
        (far, "none", False),
    ):
        scene = flat_scene()
        scene.add_polygons([box(20, 20, 60, 60)])
        assert ("LEVELS" in variants(scene, antialias=antialias, camera=camera)) == drawn


def test_ids_cost_nothing_until_they_are_read() -> None:
    scene = flat_scene()
    scene.add_polygons([box(20, 20, 60, 60)])
    frame = draw(scene)
    assert not any("IDS" in name for name in draw(scene).stats.variants)
    assert frame.pick(30, 60)
    assert not any("IDS" in name for name in draw(scene).stats.variants), "pick looks at the one pixel"
    assert frame.ids.max() == 0
    assert any("IDS" in name for name in draw(scene).stats.variants)


@pytest.mark.parametrize("ending", ["png", "PNG", "jpg", "jpeg", "tif", "webp", "bmp"])
def test_saving(tmp_path: Path, ending: str) -> None:
    scene = flat_scene()
    frame = draw(scene, dg.Camera.look_at((50, -80, 10), (50, 0, 15)), background=None)
    path = tmp_path / f"map.{ending}"
    frame.save(path)
    with Image.open(path) as image:
        assert image.size == SIZE
        top = np.asarray(image.convert("RGBA"))[0, 0]
    keeps = ending.lower() in ("png", "tif", "webp")
    assert (top[3] == 0) if keeps else (top >= 250).all()
    if ending == "png":
        with Image.open(path) as image:
            np.testing.assert_array_equal(np.asarray(image), frame.image)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("map", "no picture format.*''.*png"),
        ("map.xyz", "no picture format.*'.xyz'"),
        ("map.txt", "no picture format"),
        ("absent/map.png", "Check the folder"),
        (".", "no picture format"),
    ],
)
def test_saving_to_what_cannot_be(tmp_path: Path, name: str, message: str) -> None:
    frame = draw(flat_scene())
    with pytest.raises(dg.FileError, match=message):
        frame.save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []
    frame.save(str(tmp_path / "map.png"))
