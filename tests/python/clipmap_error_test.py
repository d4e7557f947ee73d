"""How far clipmap textures are from the truth, in texels and pixels: near the eye, far away and on steep slopes.

A border's blur is given as the width of the ramp that is as far from a sharp step: four times the mean distance that
filtering moves colour by. A pixel's own area is 1 pixel wide. Where texels are larger than pixels, a texel's area and
linear interpolation make three boxes of one texel: 4 * 13 / 32 = 1.625 texels.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import Polygon

import decalgl as dg
import judge
import scenes
from decalgl import reference as ref
from scenes import View
from shapes import drawn_by, flat_terrain

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

THREE_BOXES = 4.0 * 13.0 / 32.0
TEXELS = 2**20
# Of borders that lie askew to the texels, so that every offset from them occurs.
HEADING = np.radians(63.0)


def texel_of(terrain: dg.Terrain) -> float:
    """Metres of a finest texel: the next power of two metres that is larger than the map is cut into 2^20."""
    left, bottom, right, top = terrain.bounds
    return float(2.0 ** (np.floor(np.log2(max(right - left, top - bottom))) + 1.0)) / TEXELS


def half_plane(terrain: dg.Terrain, x: float, y: float, technique: dg.Technique, heading: float) -> dg.Scene:
    """The map to the right of a border through (x, y); `heading` from east."""
    reach = 0.2 * (terrain.bounds[2] - terrain.bounds[0])
    along = np.array([np.cos(heading), np.sin(heading)])
    right = np.array([along[1], -along[0]])
    corners = np.array([x, y]) + reach * np.array([-along, along, along + right, right - along])
    scene = dg.Scene(terrain)
    scene.add_polygons([Polygon(corners)], color="white", technique=technique)
    return scene


def blur(view: View, x: float, y: float, heading: float, reach: float, **options: Any) -> float:
    """Metres on the map that the border's ramp is wide, from the pixels within `reach` of it."""
    renderer = dg.Renderer(**{"antialias": "none", "terrain_error": 0.0, **options})
    covered = judge.overlay_of(renderer, view, renderer.antialias)[..., 3]
    world = judge.draw(renderer, view).world
    right = np.array([np.sin(heading), -np.cos(heading)])
    distance = (world[..., :2] - (x, y)) @ right
    near = np.abs(distance) < reach
    bins = np.linspace(-reach, reach, 65)
    counts = np.histogram(distance[near], bins)[0]
    assert counts.min() > 3
    off = np.abs(covered - (distance > 0.0))
    means = np.histogram(distance[near], bins, weights=off[near])[0] / counts
    return 4.0 * float(means.sum() * (bins[1] - bins[0]))


# Nearer than the lattice, which warns: blur by whole texels is what is looked at.
NEARER_THAN_VERTICES = pytest.mark.filterwarnings("ignore:In the middle of this picture:decalgl.DecalWarning")


@NEARER_THAN_VERTICES
def test_near_the_eye_borders_are_as_wide_as_filtered_texels() -> None:
    terrain = flat_terrain(20_000.0)
    texel = texel_of(terrain)
    camera = dg.Camera.look_at((0.0, -1.0, 1.0), (0.0, 0.0, 0.0), fov=25.0)
    view = View(half_plane(terrain, 0.0, 0.0, dg.Clipmap(), HEADING), camera, (320, 240))
    assert blur(view, 0.0, 0.0, HEADING, 2.5 * texel) / texel == pytest.approx(THREE_BOXES, rel=0.1)


@pytest.mark.parametrize("height", [400.0, 500.0, 700.0])
def test_far_borders_are_less_than_two_pixels_wide(height: float) -> None:
    terrain = flat_terrain(20_000.0)
    scene = half_plane(terrain, 3.0, 5.0, dg.Clipmap(), HEADING)
    half = 0.5 * height
    view = View(scene, dg.Camera.top_down((-half, -half, half, half)), (240, 240))
    pixel = height / 240.0
    wide = blur(view, 3.0, 5.0, HEADING, 4.0 * pixel) / pixel
    assert 1.2 < wide < 2.0
    sharp = blur(
        view._replace(scene=drawn_by(scene, dg.Static())),
        3.0,
        5.0,
        HEADING,
        4.0 * pixel,
        antialias="coverage",
    )
    assert sharp / pixel == pytest.approx(1.0, abs=0.15)


def ramp_terrain(slope: float, half: float) -> dg.Terrain:
    """A plane that rises to the north."""
    y = np.linspace(half, -half, 3)[:, None]
    return dg.Terrain((slope * (y + np.zeros((3, 3)))).astype(np.float32), -half, half, half, half)


@NEARER_THAN_VERTICES
@pytest.mark.parametrize("slope", [0.0, 1.0, 5.0])
def test_on_slopes_texels_are_stretched(slope: float) -> None:
    """Seen head-on, a border along the slope's contour is blurred over as many metres of the map at any slope, so over
    sqrt(1 + slope^2) times as many of the ground and the screen.
    """
    terrain = ramp_terrain(slope, 20_000.0)
    texel = texel_of(terrain)
    heading = np.radians(7.0)
    distance = 4.0
    normal = np.array([0.0, -slope, 1.0]) / np.hypot(1.0, slope)
    camera = dg.Camera.look_at(distance * normal, (0.0, 0.0, 0.0), fov=25.0, up=(0.0, 1.0, 0.0))
    view = View(half_plane(terrain, 0.0, 0.0, dg.Clipmap(), heading), camera, (320, 320))
    assert blur(view, 0.0, 0.0, heading, 2.5 * texel) / texel == pytest.approx(THREE_BOXES, rel=0.12)


# Pixels across, of a border that runs away from the eye, 5 degrees above the ground, where pixels are 11 times as long
# as wide: without samples along them, they take texels as wide as they are long. A window that does not reach along all
# of the border leaves blur, whatever the samples.
GRAZING = {
    "one sample": (dg.Clipmap(anisotropy=1, window=2048), 8.0, 25.0),
    "enough samples": (dg.Clipmap(anisotropy=16, window=2048), 0.8, 2.0),
    "a small window": (dg.Clipmap(anisotropy=16, window=512), 4.0, np.inf),
}


@pytest.mark.parametrize("name", list(GRAZING))
def test_grazing_borders_are_as_sharp_as_samples_and_window_allow(name: str) -> None:
    technique, least, most = GRAZING[name]
    heading = np.radians(89.5)
    scene = half_plane(flat_terrain(20_000.0), 0.0, 0.0, technique, heading)
    elevation, distance = np.radians(5.0), 2000.0
    eye = (0.0, -distance * np.cos(elevation), distance * np.sin(elevation))
    view = View(scene, dg.Camera.look_at(eye, (0.0, 0.0, 0.0), fov=2.0), (240, 120))
    pixel = 2.0 * distance * np.tan(np.radians(1.0)) / 120.0
    wide = blur(view, 0.0, 0.0, heading, 16.0 * pixel) / pixel
    assert least < wide < most


# Against the reference: rms and 99th percentile of the overlay's error, of pixels that show one piece of ground.
ERRORS = {
    "hills": (0.018, 0.075),
    "grazing_plain": (0.025, 0.09),
    "map_from_above": (0.006, 0.03),
    "eye_at_one_metre": (0.01, 0.045),
}
SAMPLES = 8


@pytest.mark.parametrize("name", list(ERRORS))
def test_error_against_the_reference(name: str) -> None:
    view = scenes.build(name)
    renderer = dg.Renderer(antialias="none", terrain_error=0.0)
    crop = judge.busiest_crop(judge.draw(renderer, view), (80, 48))
    shown = judge.overlay_of(renderer, view._replace(scene=drawn_by(view.scene, dg.Clipmap())), "none")
    surface = ref.sample_surface(view.scene, view.camera, view.size, crop, SAMPLES)
    true = ref.render_overlay(view.scene, view.camera, view.size, crop, SAMPLES, surface=surface)
    left, top, right, bottom = crop
    error = np.abs(shown[top:bottom, left:right] - true.rgba)
    judged = (true.terrain_fraction == 1.0) & ~judge.folded(view, crop, surface, SAMPLES)
    assert judged.mean() > 0.1
    rms, p99 = float(np.sqrt((error[judged] ** 2).mean())), float(np.percentile(error[judged], 99))
    assert rms <= ERRORS[name][0]
    assert p99 <= ERRORS[name][1]
