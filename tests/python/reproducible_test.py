"""The same scene, camera and driver give the same bytes, whatever happened before and however the work was cut."""

from __future__ import annotations

import functools
import gc
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import decalgl as dg
import judge
import scenes
from decalgl import reference
from scenes import View

if TYPE_CHECKING:
    from collections.abc import Iterator

NAMES = ["honolulu", "hills", "coast", "hills_orthographic", "nodata_holes", "translucent"]
SIZE = (322, 181)  # no multiple of any tile, group of lanes or workgroup


def view_of(name: str) -> View:
    view = scenes.build(name)
    return View(view.scene, view.camera, SIZE)


def other_views(view: View) -> Iterator[View]:
    """Cameras and sizes that leave other tiles, levels of detail and targets behind."""
    x0, y0, x1, y1 = view.scene.terrain.bounds
    yield View(view.scene, dg.Camera.top_down((x0, y0, (x0 + x1) / 2, y1)), (200, 300))
    yield View(view.scene, view.scene.home(), (64, 64))
    yield View(view.scene, view.camera, (SIZE[0] + 100, SIZE[1]))


def arrays(frame: dg.Frame) -> dict[str, bytes]:
    """Everything that a frame holds, as bytes."""
    return {name: getattr(frame, name).tobytes() for name in ("image", "ids", "layers", "depth", "world")}


@functools.cache
def expected(name: str, antialias: str = "coverage") -> dict[str, bytes]:
    """The picture of a renderer that does nothing else."""
    return arrays(draw(dg.Renderer(), view_of(name), antialias))


def draw(renderer: dg.Renderer, view: View, antialias: str = "coverage") -> dg.Frame:
    return judge.draw(renderer, view, antialias)


@pytest.mark.parametrize("name", NAMES[:4])
@pytest.mark.parametrize(
    "options", [{"threads": 1}, {"threads": 2}, {"threads": 5}, {"tile": 64}, {"tile": 100}]
)
def test_bytes_do_not_depend_on_how_the_work_is_cut(name: str, options: dict[str, Any]) -> None:
    assert arrays(draw(dg.Renderer(**options), view_of(name))) == expected(name)


@pytest.mark.parametrize("tile", [1000, 61])
def test_tiles_of_any_size_make_the_same_large_picture(tile: int) -> None:
    view = View(scenes.build("hills").scene, scenes.build("hills").camera, (1030, 517))
    whole, tiled = draw(dg.Renderer(), view), draw(dg.Renderer(tile=tile), view)
    assert arrays(tiled) == arrays(whole)


@pytest.mark.parametrize("antialias", ["coverage", "none", "ssaa", "msaa", "fxaa"])
def test_bytes_do_not_depend_on_what_was_drawn_before(antialias: str) -> None:
    renderer = dg.Renderer()
    for name in NAMES:
        view = view_of(name)
        for other in other_views(view):
            draw(renderer, other, "none" if antialias == "coverage" else "coverage")
        assert arrays(draw(renderer, view, antialias)) == expected(name, antialias)
    for name in reversed(NAMES):
        assert arrays(draw(renderer, view_of(name), antialias)) == expected(name, antialias)


def test_ids_and_positions_do_not_depend_on_antialiasing() -> None:
    for name in NAMES:
        both = expected(name, "coverage"), expected(name, "none")
        for array in ("ids", "layers", "depth", "world"):
            assert both[0][array] == both[1][array]


def test_a_scene_keeps_its_renderer_and_its_bytes() -> None:
    view = view_of("hills")
    for _ in range(2):
        assert arrays(view.scene.render(view.camera, SIZE)) == expected("hills")
        view.scene.render(view.camera, (100, 50), antialias="none")


@pytest.mark.parametrize(
    "order", [("world", "ids", "image"), ("image", "ids", "world"), ("ids", "depth", "layers")]
)
def test_frames_stay_right_after_the_renderer_went_on(order: tuple[str, ...]) -> None:
    renderer = dg.Renderer()
    frames = {}
    for name in NAMES[:3]:
        frames[name] = draw(renderer, view_of(name))
        for other in other_views(view_of(name)):
            draw(renderer, other).ids.sum()
    for name, frame in frames.items():
        for array in order:
            assert getattr(frame, array).tobytes() == expected(name)[array], (name, array)


def test_frames_outlive_their_renderer() -> None:
    renderer = dg.Renderer()
    frame = draw(renderer, view_of("hills"))
    picked = frame.pick(160, 120)
    del renderer
    gc.collect()
    assert arrays(frame) == expected("hills")
    assert frame.pick(160, 120) == picked


def test_renderers_do_not_disturb_each_other() -> None:
    first, second = dg.Renderer(), dg.Renderer(tile=64)
    pictures = {}
    for renderer, name in ((first, "hills"), (second, "coast")):
        renderer.set_picture(SIZE, "coverage")
        renderer.preprocess(view_of(name).scene)
    first.update(view_of("hills").camera)
    second.update(view_of("coast").camera)
    pictures["hills"], pictures["coast"] = first.render(), second.render()
    for name, frame in pictures.items():
        assert arrays(frame) == expected(name)


def test_the_background_shows_where_there_is_sky_alone() -> None:
    view = view_of("nodata_holes")
    renderer = dg.Renderer(size=SIZE)
    renderer.preprocess(view.scene)
    renderer.update(view.camera)
    frames = [
        renderer.render(background=background) for background in ("sky", None, "red", (0.0, 0.0, 1.0, 0.5))
    ]
    sky = np.isinf(frames[0].depth)
    # A pixel beside the sky may show some of it, and so may one before a hole that is thinner than a pixel.
    away = judge.eroded(~sky, 2)
    assert away.sum() > 1000
    ground = away & (frames[1].image[..., 3] == 255)
    rows, columns = np.nonzero(away & ~ground)
    crop = (int(columns.min()), int(rows.min()), int(columns.max()) + 1, int(rows.max()) + 1)
    seen = reference.render_overlay(view.scene, view.camera, SIZE, crop).terrain_fraction
    assert (seen[rows - crop[1], columns - crop[0]] < 1).all()
    for frame in frames[1:]:
        np.testing.assert_array_equal(frame.image[ground], frames[0].image[ground])
        assert frame.ids.tobytes() == frames[0].ids.tobytes()
    outer = judge.eroded(sky, 1)
    assert outer.sum() > 1000
    assert (frames[1].image[outer] == 0).all()
    assert (frames[2].image[outer] == (255, 0, 0, 255)).all()
    assert (frames[3].image[outer] == (0, 0, 255, 128)).all()
