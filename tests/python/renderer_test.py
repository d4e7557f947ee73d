"""The renderer's three stages: options, limits, cancelling, threads, backends, and no OpenGL at all."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import box

import decalgl as dg
from small_scenes import (
    DIAGONAL,
    MAP,
    OBLIQUE,
    RED,
    SIZE,
    assert_usable,
    count_color,
    draw,
    flat_scene,
    hilly_scene,
)

if TYPE_CHECKING:
    from pathlib import Path

NAN, INF = float("nan"), float("inf")


def mixed_scene() -> dg.Scene:
    """A hill with a polygon and a line."""
    scene = hilly_scene()
    scene.add_polygons([box(20, 20, 80, 80)], color="red")
    scene.add_lines([DIAGONAL], width=8, width_units="m", color="blue", alpha=0.5)
    return scene


def test_three_stages_by_hand() -> None:
    renderer = dg.Renderer(size=SIZE, antialias="none")
    scene = mixed_scene()
    renderer.preprocess(scene)
    report = renderer.update(OBLIQUE)
    assert set(report) == {"pieces", "bytes", "longest_walk", "shader_steps"}
    assert report["pieces"] > 0
    frame = renderer.render()
    np.testing.assert_array_equal(frame.image, draw(scene, OBLIQUE).image)
    np.testing.assert_array_equal(renderer.render().image, frame.image)
    assert renderer.time_floor() >= 0.0


def test_stages_out_of_order() -> None:
    renderer = dg.Renderer(size=SIZE)
    with pytest.raises(dg.InputError, match=r"preprocess\(scene\) first"):
        renderer.update(MAP)
    with pytest.raises(dg.InputError, match=r"update\(camera\) first"):
        renderer.render()
    with pytest.raises(dg.InputError, match=r"update\(camera\) first"):
        renderer.time_floor()
    renderer.preprocess(flat_scene())
    with pytest.raises(dg.InputError, match=r"update\(camera\) first"):
        renderer.render()
    renderer.update(MAP)
    assert renderer.render().size == SIZE


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"size": (0, 10)}, dg.InputError, "at least"),
        ({"size": (10, -1)}, dg.InputError, "at least"),
        ({"size": (10.5, 10)}, dg.InputError, "whole pixels"),
        ({"size": (NAN, 10)}, dg.InputError, "whole pixels"),
        ({"size": (INF, 10)}, dg.InputError, "whole pixels"),
        ({"size": 10}, dg.InputError, "width, height"),
        ({"size": (10, 10, 10)}, dg.InputError, "width, height"),
        ({"size": "big"}, dg.InputError, "width, height"),
        ({"size": (10**12, 10)}, dg.InputError, "at most"),
        ({"antialias": "smooth"}, dg.InputError, "'none', 'coverage', 'ssaa', 'msaa', 'fxaa'"),
        ({"antialias": None}, dg.InputError, "'none', 'coverage', 'ssaa', 'msaa', 'fxaa'"),
        ({"samples": 0}, dg.InputError, "1, 2, 4, 8, 16, 32"),
        ({"samples": 3}, dg.InputError, "1, 2, 4, 8, 16, 32"),
        ({"samples": 64}, dg.InputError, "1, 2, 4, 8, 16, 32"),
        ({"samples": "many"}, dg.InputError, "1, 2, 4, 8, 16, 32"),
        ({"samples": 2.0}, dg.InputError, "1, 2, 4, 8, 16, 32"),
        ({"terrain_error": -1}, dg.InputError, "terrain_error"),
        ({"terrain_error": NAN}, dg.InputError, "terrain_error"),
        ({"terrain_error": "fine"}, dg.InputError, "terrain_error"),
        ({"memory_limit": 0}, dg.InputError, "memory_limit"),
        ({"memory_limit": -5}, dg.InputError, "memory_limit"),
        ({"memory_limit": 1e30}, dg.InputError, "memory_limit"),
        ({"memory_limit": "2GB"}, dg.InputError, "memory_limit"),
        ({"backend": "vulkan"}, dg.InputError, "'egl' or 'osmesa'"),
        ({"threads": 0}, dg.InputError, "threads"),
        ({"threads": 1.5}, dg.InputError, "threads"),
        ({"threads": 10**6}, dg.InputError, "threads"),
        ({"tile": -1}, dg.InputError, "tile"),
    ],
)
def test_options_out_of_range(options: Any, error: type[Exception], message: str) -> None:
    scene = flat_scene()
    with pytest.raises(error, match=message):
        dg.Renderer(**options)
    with pytest.raises(error, match=message):
        scene.render(MAP, **options)
    assert_usable(scene)


def test_unknown_backgrounds() -> None:
    scene = flat_scene()
    with pytest.raises(dg.StyleError, match="Did you mean 'skyblue'"):
        scene.render(MAP, SIZE, background="skyblu")
    assert_usable(scene)


def test_one_renderer_serves_many_pictures() -> None:
    scene = flat_scene()
    draw(scene)
    first = scene._renderer
    draw(scene, OBLIQUE, (30, 20), antialias="coverage", terrain_error=0.5, memory_limit=None)
    assert scene._renderer is first
    draw(scene, tile=64)
    assert scene._renderer is not first


@pytest.mark.parametrize(
    "options", [{"tile": 17}, {"threads": 1}, {"threads": 3}, {"memory_limit": 1 << 30}], ids=str
)
@pytest.mark.parametrize("antialias", ["none", "coverage", "ssaa", "msaa", "fxaa"])
def test_options_that_do_not_change_the_picture(options: dict[str, Any], antialias: str) -> None:
    scene = mixed_scene()
    plain = draw(scene, OBLIQUE, antialias=antialias)
    other = draw(scene, OBLIQUE, antialias=antialias, **options)
    for name in ("image", "ids", "layers", "depth", "world"):
        np.testing.assert_array_equal(getattr(plain, name), getattr(other, name), err_msg=name)


def test_backends_draw_the_same() -> None:
    names = {record.name.split()[0] for record in dg.doctor() if record.ok and "llvmpipe" in record.detail}
    if names != {"EGL", "OSMesa"}:
        pytest.skip("needs the same software renderer behind EGL and OSMesa")
    scene = mixed_scene()
    for antialias in ("none", "coverage"):
        first = draw(scene, OBLIQUE, antialias=antialias, backend="egl")
        second = draw(scene, OBLIQUE, antialias=antialias, backend="osmesa")
        for name in ("image", "ids", "depth", "world"):
            np.testing.assert_array_equal(getattr(first, name), getattr(second, name), err_msg=name)


def test_pictures_larger_than_the_driver_draws() -> None:
    scene = flat_scene()
    draw(scene)
    with pytest.raises(dg.MemoryLimitError, match=r"100000 x 8 pixels is larger than.*smaller size"):
        scene.render(MAP, (100_000, 8))
    assert_usable(scene)


def test_terrains_larger_than_the_driver_holds() -> None:
    scene = dg.Scene(dg.Terrain(np.zeros((2, 70_000), np.float32), 0, 0, 1, 1))
    with pytest.raises(dg.MemoryLimitError, match=r"The terrain has 2 x 70000 samples.*open a part"):
        draw(scene)


def test_pictures_larger_than_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = flat_scene()
    large = draw(scene, size=(2100, 2100))
    monkeypatch.setattr("decalgl._raster.available_memory", lambda: 1 << 20)
    with pytest.raises(dg.MemoryLimitError, match=r"2100 x 2100 pixels.*smaller size"):
        draw(scene, size=(2100, 2100))
    with pytest.raises(dg.MemoryLimitError, match=r"world of a picture.*smaller picture"):
        large.world  # noqa: B018
    with pytest.raises(dg.MemoryLimitError, match="smaller picture"):
        large.pick(0, 0)
    assert_usable(scene)
    monkeypatch.undo()
    assert large.world.shape == (2100, 2100, 3)


@pytest.mark.parametrize("limit", [1, 10_000, 3_000_000, 5_000_000])
def test_limits_that_are_too_small(limit: int) -> None:
    scene = mixed_scene()
    with pytest.raises(dg.MemoryLimitError, match=r"needs .* of the memory limit of .*Raise memory_limit"):
        draw(scene, size=(400, 300), memory_limit=limit)
    assert_usable(scene)


def test_a_limit_reached_after_a_picture_leaves_renderer_and_frame() -> None:
    scene = mixed_scene()
    renderer = dg.Renderer(SIZE, antialias="none", memory_limit=16_000_000)
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    before = renderer.render()
    renderer.set_picture((3000, 3000), "none")
    with pytest.raises(dg.MemoryLimitError, match="smaller picture"):
        renderer.update(OBLIQUE)
    lines = np.random.default_rng(1).uniform(0, 100, (200_000, 2))
    scene.add_lines((lines, [0, len(lines)]), width=1, width_units="m")
    with pytest.raises(dg.MemoryLimitError, match="fewer features"):
        renderer.preprocess(scene)
    np.testing.assert_array_equal(renderer.render().image, before.image)
    assert before.ids.max() == 0
    renderer.set_picture(SIZE, "none")
    renderer.update(OBLIQUE)
    np.testing.assert_array_equal(renderer.render().image, before.image)


def test_memory_is_given_back() -> None:
    scene = mixed_scene()
    held = draw(scene).stats.bytes
    for size in ((300, 200), (20, 20), SIZE):
        draw(scene, size=size)
    assert draw(scene).stats.bytes == held


def test_progress_is_told_and_false_cancels() -> None:
    scene = mixed_scene()
    told: list[tuple[str, float]] = []
    draw(scene, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert {stage for stage, _ in told} == {"terrain", "layers"}
    assert [fraction for stage, fraction in told if stage == "layers"][-1] == 1.0
    for stage in ("terrain", "layers"):
        fractions = [fraction for name, fraction in told if name == stage]
        assert fractions == sorted(fractions)
    draw(scene, progress=lambda *_: pytest.fail("nothing is left to preprocess"))

    renderer = dg.Renderer(SIZE, antialias="none")
    for answer in (False, np.False_):
        with pytest.raises(dg.CancelledError, match="cancelled"):
            renderer.preprocess(scene, progress=lambda *_, answer=answer: answer)
    with pytest.raises(dg.CancelledError, match="layers"):
        renderer.preprocess(scene, progress=lambda stage, _: stage != "layers")
    with pytest.raises(dg.InputError, match="preprocess"):
        renderer.update(MAP)
    assert_usable(mixed_scene_cancelled())


def mixed_scene_cancelled() -> dg.Scene:
    """Flat ground whose first picture was cancelled."""
    scene = flat_scene()
    with pytest.raises(dg.CancelledError):
        draw(scene, progress=lambda *_: False)
    return scene


class Halt(BaseException):
    """What no library should swallow."""


@pytest.mark.parametrize("error", [ValueError("mine"), KeyboardInterrupt(), Halt("stop")])
def test_exceptions_of_the_callback_come_back_as_they_were(error: BaseException) -> None:
    def fail(*_: object) -> bool:
        raise error

    scene = flat_scene()
    with pytest.raises(type(error)) as caught:
        draw(scene, progress=fail)
    assert caught.value is error
    assert error.__cause__ is None
    assert_usable(scene)


def test_a_callback_may_use_the_library() -> None:
    inner = flat_scene()
    inner.add_polygons([box(20, 20, 60, 60)], color="red")
    counts: list[int] = []
    scene = mixed_scene()
    draw(scene, progress=lambda *_: counts.append(count_color(draw(inner), RED)))
    assert set(counts) == {1600}


def test_preprocessing_in_another_thread() -> None:
    scene, other = flat_scene(), mixed_scene()
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    before = renderer.render()
    thread = threading.Thread(target=renderer.preprocess, args=(other,))
    thread.start()
    for _ in range(5):
        renderer.update(MAP)
        renderer.render()
    thread.join()
    renderer.update(MAP)
    assert (renderer.render().image != before.image).any()
    np.testing.assert_array_equal(renderer.render().image, draw(other).image)


def test_drawing_from_one_thread_after_another() -> None:
    scene = mixed_scene()
    pictures = [draw(scene).image]
    thread = threading.Thread(target=lambda: pictures.append(draw(scene).image))
    thread.start()
    thread.join()
    pictures.append(draw(scene).image)
    assert len(pictures) == 3
    assert all((picture == pictures[0]).all() for picture in pictures)


WITHOUT_GL = """
import sys
import decalgl as dg
assert "OpenGL" not in sys.modules
assert [record.ok for record in dg.doctor()] == [False, False], dg.doctor()
scene = dg.Scene(dg.Terrain.flat((0, 0, 100, 100)))
renderer = dg.Renderer((10, 10))
renderer.preprocess(scene)
for attempt in range(2):
    for draw in (lambda: renderer.update(scene.home()), lambda: scene.render(scene.home())):
        try:
            draw()
        except dg.GraphicsError as error:
            message = str(error)
        else:
            raise SystemExit("drew without OpenGL")
print(message)
"""


def test_importing_works_without_opengl_and_drawing_says_what_to_install(tmp_path: Path) -> None:
    for library in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6"):
        (tmp_path / library).write_text("not a library")
    environment = {**os.environ, "LD_LIBRARY_PATH": str(tmp_path)}
    outcome = subprocess.run(
        [sys.executable, "-c", WITHOUT_GL], env=environment, capture_output=True, text=True, check=False
    )
    assert outcome.returncode == 0, outcome.stderr
    for part in ("libEGL.so.1 cannot be loaded", "libOSMesa", "apt-get install libegl1", "libosmesa6"):
        assert part in outcome.stdout
