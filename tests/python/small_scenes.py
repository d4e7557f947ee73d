"""Small scenes and pictures for the tests of the public interface: 100 m of flat ground, a pixel to the metre."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, box

import decalgl as dg

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from numpy.typing import NDArray

BOUNDS = (0.0, 0.0, 100.0, 100.0)
SIZE = (100, 100)
MAP = dg.Camera.top_down(BOUNDS)
OBLIQUE = dg.Camera.look_at((50.0, -80.0, 60.0), (50.0, 50.0, 0.0))
RED, GREEN, BLUE = (255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255)
CYAN = (0, 255, 255, 255)
DIAGONAL = LineString([(0, 0), (100, 100)])


def flat_scene(crs: Any = None, **options: Any) -> dg.Scene:
    """100 m x 100 m of level ground without layers."""
    return dg.Scene(dg.Terrain.flat(BOUNDS, crs=crs), **options)


def hilly_scene(south: float = 0.0, **options: Any) -> dg.Scene:
    """A hill of 20 m on 100 m x 100 m, 5 m between samples; south: metres of level ground before it.

    With a kilometre of it, buckets are so large that pixels of a metre are drawn cell by cell, and not from levels of
    detail.
    """
    x = np.arange(-10.0, 11.0) / 10.0
    y = np.arange(10.0, -11.0 - south / 5.0, -1.0) / 10.0
    hill = 20.0 * np.exp(-4.0 * (x[None, :] ** 2 + y[:, None] ** 2))
    return dg.Scene(dg.Terrain(hill.astype(np.float32), 0.0, 100.0, 5.0, 5.0), **options)


def warned(says: str | None) -> AbstractContextManager[object]:
    """In which a warning that says so comes; without it none may."""
    return nullcontext() if says is None else pytest.warns(dg.DecalWarning, match=says)


def draw(scene: dg.Scene, camera: dg.Camera = MAP, size: tuple[int, int] = SIZE, **options: Any) -> dg.Frame:
    """A picture without anti-aliasing, where every pixel is of one feature."""
    return scene.render(camera, size, **{"antialias": "none", **options})


def pixel(frame: dg.Frame, x: float, y: float) -> tuple[int, ...]:
    """The colour at a map position of a picture from MAP."""
    return tuple(frame.image[SIZE[1] - 1 - int(y), int(x)].tolist())


def count_color(frame: dg.Frame, color: tuple[int, int, int, int]) -> int:
    """How many pixels have exactly this colour."""
    matches: NDArray[np.bool_] = (frame.image == np.array(color, dtype=np.uint8)).all(axis=2)
    return int(matches.sum())


def assert_usable(scene: dg.Scene) -> None:
    """After a failed call: a good layer can be added, and the picture shows it."""
    before = len(scene.layers)
    crs = scene.terrain.crs
    scene.add_polygons([box(20, 20, 60, 60)], color="cyan", crs=crs)
    assert len(scene.layers) == before + 1
    assert scene.layers[-1].index == before
    assert count_color(draw(scene), CYAN) == 40 * 40
