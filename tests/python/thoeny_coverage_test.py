"""Coverage after Thöny et al. 2018 (section 3.5) in every index, against his formula in double precision."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import decalgl as dg
import judge
from decalgl import reference as ref
from scenes import View
from shapes import tints
from small_scenes import flat_scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

LINES = 30
# No more lines of a pixel are laid over each other.
MOST_LINES = 8
# Steps of 1/255: the bytes of three pictures.
STEPS = 3.0


def lines_aslant(translucent: bool) -> tuple[View, FloatArray, FloatArray, FloatArray]:
    """Segments in all directions, seen from the side: the view, their ends (n, 2, 2), half widths and colours (n, 4).

    A pixel is of another width in each direction, lines are from a sixth to twice as wide as it, and the grid's cells
    larger than it, as those that are smaller are drawn by samples.
    """
    generator = np.random.default_rng(12)
    middles = generator.uniform(48.0, 52.0, (LINES, 2))
    angles = np.linspace(0.0, np.pi, LINES, endpoint=False) + 0.01
    along = generator.uniform(0.5, 2.4, (LINES, 1)) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    ends = np.stack([middles - along, middles + along], axis=1)
    widths = generator.uniform(0.01, 0.12, LINES)
    colors = tints(LINES, 13, (0.3, 0.8) if translucent else 1.0)
    scene = flat_scene()
    scene.add_lines(
        (ends.reshape(-1, 2), 2 * np.arange(LINES + 1)), width=widths, width_units="m", color=colors
    )
    camera = dg.Camera((110.0, -60.0, 130.0), (50.0, 50.0, 0.0), fov=None, view_height=4.0)
    return View(scene, camera, (90, 70)), ends, widths / 2, np.asarray(scene.layers[0].colors) / 255.0


def estimates(view: View, ends: FloatArray, half_widths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distances from pixel centres to lines, and the shares of the pixels that lines cover, both (pixels, lines)."""
    surface = ref.raycast(view.scene, view.camera, view.size).reshape(-1)
    right, down = judge.sides(view, judge.centres_of(view), surface)
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    from_start = surface.world[:, None, :2] - start
    t = np.clip((from_start * along).sum(axis=-1) / length**2, 0.0, 1.0)
    distance = np.linalg.norm(from_start - t[..., None] * along, axis=-1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / length[:, None]
    width = np.hypot(right[:, :2] @ across.T, down[:, :2] @ across.T)
    sides = (np.minimum(width / 2 + sign * distance, half_widths) for sign in (-1.0, 1.0))
    coverage: FloatArray = np.clip(sum(sides) / width, 0.0, 1.0)
    return distance, coverage


def over_each_other(coverage: FloatArray, colors: FloatArray) -> FloatArray:
    """Premultiplied (pixels, 4), the last line on top."""
    assert ((coverage > 0.0).sum(axis=1) <= MOST_LINES).all()
    result = np.zeros((len(coverage), 4))
    for share, color in zip(coverage.T, colors, strict=True):
        source = share[:, None] * np.append(color[:3] * color[3], color[3])
        result = source + result * (1.0 - source[:, 3:])
    return result


@pytest.mark.parametrize("translucent", [False, True], ids=["opaque", "translucent"])
@pytest.mark.parametrize("index", ["grid", "bvh"])
def test_lines_cover_by_the_formula_and_lie_over_each_other(index: str, translucent: bool) -> None:
    view, ends, half_widths, colors = lines_aslant(translucent)
    renderer = dg.Renderer(terrain_error=0.0, index=index, coverage="thoeny")
    got = judge.overlay_of(renderer, view, "coverage").reshape(-1, 4)
    _, coverage = estimates(view, ends, half_widths)
    assert ((coverage > 0.0).sum(axis=1) > 1).sum() > 200
    assert np.abs(got - over_each_other(coverage, colors)).max() <= STEPS / 255


def test_the_nearest_line_covers_by_the_formula() -> None:
    view, ends, half_widths, colors = lines_aslant(translucent=False)
    renderer = dg.Renderer(terrain_error=0.0, index="thoeny", coverage="thoeny")
    got = judge.overlay_of(renderer, view, "coverage").reshape(-1, 4)
    distance, coverage = estimates(view, ends, half_widths)
    nearest = np.where(coverage > 0.0, distance, np.inf)
    only = np.zeros_like(coverage)
    row = np.arange(len(coverage)), nearest.argmin(axis=1)
    only[row] = coverage[row]
    assert (only > 0.0).any(axis=1).sum() > 1000
    assert np.abs(got - over_each_other(only, colors)).max() <= STEPS / 255


def pixel_of_lines(count: int) -> tuple[dg.Scene, dict[str, Any]]:
    """Short lines in 3,600 cells of one pixel, of which the last cells hold the topmost; and how to draw them."""
    middles = np.random.default_rng(0).uniform(0.0, 99.0, (count, 1, 2))
    ends = np.concatenate([middles, middles + 0.4], axis=1)
    ends[-1] = [[1.0, 99.0], [99.9, 99.0]]
    offsets = np.arange(count + 1)
    lines = dg.FeatureTable("lines", ends.reshape(-1, 2), 2 * offsets, offsets, offsets[:-1])
    widths = np.full(count, 0.05)
    widths[-1] = 2.0
    scene = flat_scene()
    scene.add_lines(lines, width=widths, width_units="m", color=["blue"] * (count - 1) + ["red"])
    camera = dg.Camera.top_down((0.0, 0.0, 100.0, 100.0))
    return scene, {"camera": camera, "size": (1, 1), "index": dg.BvhIndex(cells=60), "coverage": "thoeny"}


def test_a_pixel_of_many_lines_shows_the_topmost() -> None:
    scene, options = pixel_of_lines(20_000)
    seen = scene.render(**options).image[0, 0].astype(int)
    ground = flat_scene().render(options["camera"], options["size"]).image[0, 0].astype(int)
    # Two in a hundred of the pixel are red.
    assert np.abs(seen[1:3] - 0.98 * ground[1:3]).max() <= STEPS
    assert seen[1] <= ground[1] - 3


def test_more_lines_than_the_driver_looks_at_are_refused() -> None:
    scene, options = pixel_of_lines(60_000)
    try:
        seen = scene.render(**options).image[0, 0].astype(int)
    except dg.UnsupportedError as error:
        message = str(error)
        assert "coverage='exact'" in message
        assert "65535 turns" in message
    else:  # a driver whose loops have no end
        assert "llvmpipe" not in next(record.detail for record in dg.doctor() if record.ok)
        assert seen[0] > seen[1]
    # The scene can be drawn in the other way.
    assert scene.render(**options | {"coverage": "exact"}).image.shape == (1, 1, 4)
