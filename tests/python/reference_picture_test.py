"""The reference's pictures, areas and comparisons against closed forms."""

from __future__ import annotations

import ast
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from decalgl import reference as ref
from reference_scenes import (
    Camera,
    Scene,
    Terrain,
    flat_scene,
    make_layer,
    plan_camera,
    square,
    star_features,
)

# Pictures


def translucent_scene() -> Scene:
    scene = flat_scene()
    red, green, blue, hidden = (255, 0, 0, 255), (0, 255, 0, 128), (0, 0, 255, 51), (255, 255, 255, 0)
    squares = [[square(-5, -5, 10)], [square(-2, -2, 10)], [square(-9, -9, 18)]]
    scene.layers = [
        make_layer("polygons", squares, colors=[red, green, hidden]),
        make_layer("lines", [[[(-8, 0.5), (8, 0.5)]]], width=1.0, colors=[blue]),
    ]
    return scene


def test_ids_and_over_in_order() -> None:
    scene = translucent_scene()
    ids = ref.render_ids(scene, plan_camera(20.0), (20, 20))
    assert (ids.ids[9, 10], ids.layers[9, 10]) == (0, 1)
    assert (ids.ids[6, 11], ids.layers[6, 11]) == (10, 0)
    assert (ids.ids[13, 6], ids.layers[13, 6]) == (0, 0)
    assert (ids.ids[1, 1], ids.layers[1, 1]) == (-1, -1)
    np.testing.assert_allclose(ids.edge_distance[9, 10], 0.5)
    crop = ref.render_ids(scene, plan_camera(20.0), (20, 20), (4, 6, 14, 15))
    np.testing.assert_array_equal(ids.ids[6:15, 4:14], crop.ids)
    np.testing.assert_array_equal(ids.layers[6:15, 4:14], crop.layers)
    np.testing.assert_array_equal(ids.edge_distance[6:15, 4:14], crop.edge_distance)
    green, blue = 128 / 255, 0.2
    color = ref.composite(scene, np.array([(0.5, 0.5), (50.0, 50.0)]))
    under = np.array([1 - green, green, 0, 1])
    np.testing.assert_allclose(color[0], np.array([0, 0, blue, blue]) + under * (1 - blue))
    np.testing.assert_allclose(color[1], 0)


def test_overlay_is_the_mean_over_the_pixel_and_does_not_depend_on_crops() -> None:
    scene, camera, size = translucent_scene(), Camera((0.0, -30.0, 20.0), (0.0, 0.0, 0.0), fov=30.0), (40, 30)
    whole = ref.render_overlay(scene, camera, size, samples=4, seed=7)
    crop = (5, 9, 25, 20)
    surface = ref.sample_surface(scene, camera, size, crop, samples=4, seed=7)
    part = ref.render_overlay(scene, camera, size, crop, samples=4, seed=7)
    again = ref.render_overlay(scene, camera, size, crop, samples=4, seed=7, surface=surface)
    np.testing.assert_allclose(whole.rgba[9:20, 5:25], part.rgba, atol=1e-12)
    np.testing.assert_array_equal(again.rgba, part.rgba)
    points = ref.sample_points(crop, 4, 7)[3, 6].reshape(-1, 2)
    world = ref.raycast(scene, camera, size, points).world
    np.testing.assert_allclose(part.rgba[3, 6], ref.composite(scene, world[:, :2]).mean(axis=0))
    assert (part.rgba[..., :3] <= part.rgba[..., 3:] + 1e-12).all()


def test_neighbours_let_nothing_through() -> None:
    scene = flat_scene()
    colors = [(200, 30, 30, 255), (30, 200, 30, 255)]
    halves = [[[(-50, -50), (3, -50), (-2, 50), (-50, 50)]], [[(3, -50), (50, -50), (50, 50), (-2, 50)]]]
    scene.layers = [make_layer("polygons", halves, colors=colors)]
    overlay = ref.render_overlay(scene, plan_camera(20.0), (20, 20), samples=8)
    np.testing.assert_array_equal(overlay.rgba[..., 3], 1.0)
    assert overlay.varied.any(axis=1).all()
    assert not overlay.mixed.any()


@pytest.mark.parametrize("orthographic", [False, True])
def test_mixed_marks_silhouettes_and_the_skyline_only(orthographic: bool) -> None:
    heights = np.zeros((101, 101), dtype=np.float32)
    heights[50] = 4.0
    scene = Scene(heights, Terrain(-50.0, 60.0, 1.0, 1.0))
    lens: dict[str, Any] = {"fov": None, "view_height": 60.0} if orthographic else {"fov": 60.0}
    camera = Camera((0.0, -30.0, 16.0), (0.0, 0.0, 0.0), **lens)
    overlay = ref.render_overlay(scene, camera, (48, 48), samples=8)
    centre = overlay.mixed[:, 24]
    sky = overlay.terrain_fraction[:, 24]
    assert centre[(sky > 0) & (sky < 1)].all()
    ridge_hides = centre & (sky == 1)
    assert 1 <= ridge_hides.sum() <= 2
    assert centre.sum() <= 4


# Areas


def test_half_plane_coverage_has_a_closed_form() -> None:
    scene = flat_scene()
    upright = [(-50, -50), (0.3, -50), (0.3, 50), (-50, 50)]
    diagonal = [(-60, -60), (60.5, -60), (-60, 60.5)]
    scene.layers = [make_layer("polygons", [[upright], [diagonal]])]
    camera, crop = plan_camera(10.0), (5, 4, 6, 5)
    np.testing.assert_allclose(ref.exact_coverage(scene, camera, (10, 10), 0, 0, crop), 0.3, atol=1e-12)
    np.testing.assert_allclose(ref.exact_coverage(scene, camera, (10, 10), 0, 1, crop), 0.125, atol=1e-12)


@pytest.mark.parametrize("offset", [0.0, 1e7])
def test_coverage_is_area_on_the_screen_not_on_the_map(offset: float) -> None:
    """A straight edge across a grazing view: the screen row where it lies is known."""
    scene = Scene(np.zeros((2, 2), dtype=np.float32), Terrain(offset - 5000.0, 5000.0, 10000.0, 10000.0))
    edge = [(offset - 4e3, 18.0), (offset + 4e3, 18.0), (offset + 4e3, 4e3), (offset - 4e3, 4e3)]
    scene.layers = [make_layer("polygons", [[edge]])]
    camera = Camera((offset, 0.0, 10.0), (offset, 100.0, 10.0), fov=90.0)
    row = 4 + 4 * 10 / 18
    covered = ref.exact_coverage(scene, camera, (8, 8), 0, 0, (3, 0, 5, 8))
    assert np.isnan(covered[:5]).all()
    np.testing.assert_allclose(covered[5], 1, atol=1e-7)
    np.testing.assert_allclose(covered[6], row - 6, atol=1e-7)
    np.testing.assert_allclose(covered[7], 0, atol=1e-12)


def test_areas_of_strokes_and_of_odd_rings() -> None:
    scene = flat_scene()
    rings = [square(0.1, 0.1, 0.6), square(0.4, 0.4, 0.5), square(0.1, 0.1, 0.2), square(0.1, 0.1, 0.2)]
    scene.layers = [
        make_layer("lines", [[[(0.5, 0.5)]], [[(-3, 0.5), (3, 0.5)], [(-2, 0.5), (2, 0.5)]]], width=0.5),
        make_layer("polygons", [rings]),
    ]
    camera, crop = plan_camera(10.0), (5, 4, 6, 5)
    disc = ref.exact_coverage(scene, camera, (10, 10), 0, 0, crop)
    np.testing.assert_allclose(disc, np.pi / 16, rtol=1e-4)
    np.testing.assert_allclose(ref.exact_coverage(scene, camera, (10, 10), 0, 1, crop), 0.5, atol=1e-9)
    expected = 0.36 + 0.25 - 2 * 0.09
    np.testing.assert_allclose(ref.exact_coverage(scene, camera, (10, 10), 1, 0, crop), expected, atol=1e-9)


@pytest.mark.parametrize("kind", ["polygons", "lines"])
@pytest.mark.parametrize("orthographic", [False, True])
def test_samples_agree_with_areas(kind: str, orthographic: bool) -> None:
    x, y = np.meshgrid(np.linspace(-100, 100, 3), np.linspace(100, -100, 3))
    scene = Scene((0.2 * x + 0.1 * y).astype(np.float32), Terrain(-100.0, 100.0, 100.0, 100.0))
    scene.layers = [
        make_layer(
            kind,
            [[(ring - ring.mean(axis=0)) * 0.6] for (ring,) in star_features(3, 6)],
            width=1.3 if kind == "lines" else 0.0,
        )
    ]
    lens: dict[str, Any] = {"fov": None, "view_height": 40.0} if orthographic else {"fov": 35.0}
    camera, size, crop = Camera((10.0, -50.0, 40.0), (0.0, 0.0, 0.0), **lens), (96, 64), (20, 10, 70, 50)
    surface = ref.sample_surface(scene, camera, size, crop)
    assert np.isfinite(surface.depth).all()
    for feature in range(3):
        exact = ref.exact_coverage(scene, camera, size, 0, feature, crop)
        sampled = ref.sampled_coverage(scene, camera, size, 0, feature, crop, surface=surface)
        partial = (exact > 0) & (exact < 1)
        assert partial.sum() > 20
        # An edge crosses about 24 of 256 strata; each errs by at most 1/2 of 1/256.
        assert np.sqrt(np.mean((exact - sampled)[partial] ** 2)) < 0.012
        assert np.abs(exact - sampled).max() < 0.06


# Comparison


def test_compare_counts_wrong_ids() -> None:
    expected_ids, layers = np.array([[1, 2, -1, 4]]), np.array([[0, 0, -1, 0]])
    got_ids, got_layers = np.array([[1, -1, 5, 4]]), np.array([[0, -1, 0, 1]])
    distance = np.array([[0.0, 2.0, 3.0, 9.0]])
    result = ref.compare_ids(got_ids, got_layers, expected_ids, layers, distance)
    assert (result.pixels, result.wrong, result.missing, result.extra) == (4, 3, 1, 1)
    assert result.farthest == 9.0
    ignored = ref.compare_ids(got_ids, got_layers, expected_ids, layers, distance, ignore=distance > 5)
    assert (ignored.pixels, ignored.wrong, ignored.farthest) == (3, 2, 3.0)
    with pytest.raises(ValueError, match="differ in shape"):
        ref.compare_ids(got_ids[:, :2], got_layers, expected_ids, layers)


def test_compare_measures_overlays() -> None:
    rgba = np.zeros((1, 4, 4))
    rgba[0, :, 3] = [0.0, 0.5, 1.0, 1.0]
    flags = np.zeros((1, 4), dtype=np.bool_)
    varied = np.array([[False, True, True, False]])
    expected = ref.Overlay(rgba, flags, np.ones((1, 4)), varied)
    got = rgba.copy()
    got[0, :, 3] = [0.0, 0.6, 0.9, 1.0]
    result = ref.compare_overlay(got, expected)
    assert (result.pixels, result.partial) == (4, 2)
    np.testing.assert_allclose([result.rms, result.maximum, result.alpha_rms, result.leak], 0.1)
    np.testing.assert_allclose(result.image_rms, np.sqrt(0.005))
    ignored = ref.compare_overlay(got, expected, ignore=varied)
    assert (ignored.partial, ignored.rms, ignored.leak, ignored.image_maximum) == (0, 0.0, 0.0, 0.0)
    assert ref.compare_overlay(np.round(rgba * 255).astype(np.uint8), expected).maximum < 0.002


def test_reference_shares_no_code_with_the_renderer() -> None:
    assert ref.__file__ is not None
    allowed = {"numpy", "shapely", *sys.stdlib_module_names}
    for path in Path(ref.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                assert {name.name.split(".")[0] for name in node.names} <= allowed
            elif isinstance(node, ast.ImportFrom):
                inside = node.level == 1 and (node.module or "").count(".") == 0
                assert inside or (node.level == 0 and (node.module or "").split(".")[0] in allowed)
