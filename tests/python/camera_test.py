"""Cameras: their frames, rays and projections, and what they refuse."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from decalgl.camera import Camera
from decalgl.errors import InputError

SIZE = (640, 360)
CENTRE = [[320.0, 180.0]]


def test_look_at_makes_a_right_handed_frame() -> None:
    right, up, forward = Camera.look_at((0, -10, 0), (0, 0, 0)).basis()
    np.testing.assert_allclose(forward, (0, 1, 0))
    np.testing.assert_allclose(right, (1, 0, 0))
    np.testing.assert_allclose(up, (0, 0, 1), atol=1e-15)


@pytest.mark.parametrize(("height", "expected"), [(100.0, (1, 0, 0)), (-100.0, (-1, 0, 0))])
def test_straight_views_take_north_as_up(height: Any, expected: Any) -> None:
    right, up, _ = Camera.look_at((5, 5, height), (5, 5, 0)).basis()
    np.testing.assert_allclose(up, (0, 1, 0), atol=1e-15)
    np.testing.assert_allclose(right, expected, atol=1e-15)


def test_the_centre_ray_runs_forward_and_corners_span_the_field_of_view() -> None:
    camera = Camera.look_at((1e7, 1e7, 500), (1e7 + 300, 1e7 + 400, 100), fov=60)
    right, up, forward = camera.basis()
    origins, directions = camera.rays(np.array([*CENTRE, [0, 0]]), SIZE)
    np.testing.assert_array_equal(origins, [camera.eye, camera.eye])
    np.testing.assert_allclose(directions[0], forward)
    half = math.tan(math.radians(30))
    np.testing.assert_allclose(directions[1], forward - right * half * 640 / 360 + up * half)


def test_orthographic_rays_are_parallel() -> None:
    camera = Camera((0, 0, 50), (0, 0, 0), fov=None, view_height=36.0)
    origins, directions = camera.rays(np.array([*CENTRE, [640, 0]]), SIZE)
    np.testing.assert_allclose(directions, [[0, 0, -1]] * 2)
    np.testing.assert_allclose(origins, [[0, 0, 50], [32, 18, 50]])


@settings(max_examples=60, deadline=None)
@given(
    azimuth=st.floats(0, 360),
    elevation=st.floats(-90, 90),
    fov=st.floats(1, 170),
    x=st.floats(0, 640),
    y=st.floats(0, 360),
    depth=st.floats(0.1, 1e5),
)
def test_projection_undoes_rays(azimuth: Any, elevation: Any, fov: Any, x: Any, y: Any, depth: Any) -> None:
    camera = Camera.orbit((4000, -3000, 200), 1500, azimuth, elevation, fov)
    origins, directions = camera.rays([[x, y]], SIZE)
    xy, depths = camera.project(origins + depth * directions, SIZE)
    np.testing.assert_allclose(xy, [[x, y]], atol=1e-4)
    np.testing.assert_allclose(depths, depth, rtol=1e-6, atol=1e-8)


def test_points_behind_a_perspective_camera_have_no_place_in_the_picture() -> None:
    camera = Camera.look_at((0, 0, 0), (0, 100, 0))
    xy, depth = camera.project([[0, -5, 0], [0, 0, 0], [0, 5, 0]], SIZE)
    assert np.isnan(xy[:2]).all()
    np.testing.assert_allclose(depth, [-5, 0, 5])


@pytest.mark.parametrize(
    ("azimuth", "elevation", "offset"),
    [(0, 0, (0, 1, 0)), (90, 0, (1, 0, 0)), (180, 0, (0, -1, 0)), (270, 30, (-math.sqrt(0.75), 0, 0.5))],
)
def test_orbit_stands_at_the_compass_bearing(azimuth: Any, elevation: Any, offset: Any) -> None:
    camera = Camera.orbit((10, 20, 30), 100, azimuth, elevation)
    np.testing.assert_allclose(np.subtract(camera.eye, (10, 20, 30)), np.multiply(offset, 100), atol=1e-9)


@pytest.mark.parametrize(("azimuth", "sign"), [(200.0, 1), (20.0, -1)])
def test_orbit_keeps_its_bearing_straight_above_and_below(azimuth: Any, sign: Any) -> None:
    near = Camera.orbit((0, 0, 0), 100, azimuth, sign * 89.99).basis()
    top = Camera.orbit((0, 0, 0), 100, azimuth, sign * 90.0).basis()
    np.testing.assert_allclose(near, top, atol=1e-3)


@pytest.mark.parametrize(("size", "height"), [((400, 200), 100.0), ((100, 200), 400.0)])
def test_top_down_shows_all_of_its_bounds(size: Any, height: Any) -> None:
    camera = Camera.top_down((0, 0, 200, 100))
    fitted = camera.for_size(size)
    assert fitted.view_height == height
    xy, _ = camera.project([[0, 0, 0], [200, 100, 30]], size)
    assert (xy >= -1e-9).all()
    assert (xy <= np.array(size) + 1e-9).all()
    assert xy[0, 1] > xy[1, 1], "north is up"


def test_top_down_margins_widen_the_view() -> None:
    assert Camera.top_down((0, 0, 100, 100), margin=0.1).for_size((10, 10)).view_height == pytest.approx(120)


def test_for_size_leaves_other_cameras_alone() -> None:
    camera = Camera.look_at((0, 0, 5), (1, 1, 1))
    assert camera.for_size(SIZE) is camera


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Camera.look_at((0, 0, 0), (0, 0, 0)), "same point"),
        (lambda: Camera.look_at((0, 0, math.nan), (0, 0, 0)), "finite"),
        (lambda: Camera.look_at((0, 0), (0, 0, 0)), r"eye must be \(x, y, z\)"),
        (lambda: Camera.look_at("abc", (0, 0, 0)), "eye must be"),  # type: ignore[arg-type]
        (lambda: Camera.look_at((0, 0, 1), (0, 0, 0), fov=180), "between 0 and 180"),
        (lambda: Camera.look_at((0, 0, 1), (0, 0, 0), fov=0), "between 0 and 180"),
        (lambda: Camera.look_at((0, 0, 1), (0, 0, 0), fov=math.inf), "finite"),
        (lambda: Camera.look_at((0, 0, 1), (0, 0, 0), up=(0, 0, 1)), "along the view"),
        (lambda: Camera.look_at((0, 9, 1), (0, 0, 0), up=(0, 0, 0)), "nowhere"),
        (lambda: Camera.orbit((0, 0, 0), 0, 0, 0), "distance"),
        (lambda: Camera.orbit((0, 0, 0), 1, 0, 91), "elevation"),
        (lambda: Camera.top_down((0, 0, 0, 5)), "xmin < xmax"),
        (lambda: Camera.top_down((0, 0, 5)), "bounds must be"),
        (lambda: Camera.top_down((0, 0, 1, 1), margin=-0.5), "margin"),
        (lambda: Camera((0, 0, 1), (0, 0, 0), fov=None), "view_height"),
        (lambda: Camera((0, 0, 1), (0, 0, 0), fov=None, view_height=0), "larger than 0"),
        (lambda: Camera((0, 0, 1), (0, 0, 0), view_height=5), "not both"),
        (lambda: Camera.top_down((0, 0, 1, 1)).for_size((0, 5)), "size must be"),
        (lambda: Camera.top_down((0, 0, 1, 1)).for_size((1.5, 5)), "size must be"),  # type: ignore[arg-type]
        (lambda: Camera.look_at((0, 0, 1), (0, 0, 0)).rays([[1, 2, 3]], SIZE), r"shape \(n, 2\)"),
    ],
)
def test_impossible_cameras_are_refused(make: Any, message: Any) -> None:
    with pytest.raises(InputError, match=message):
        make()
