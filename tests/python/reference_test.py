"""The reference's rays and membership against closed forms and brute force."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from decalgl import reference as ref
from reference_scenes import (
    Camera,
    Scene,
    Terrain,
    flat_scene,
    make_layer,
    plan_camera,
    rough_scene,
    square,
    star_features,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

# Rays


def all_triangles(scene: Scene) -> FloatArray:
    """Triangles (n, 3, 3) of the surface, holes left out."""
    rows, columns = scene.heights.shape
    terrain = scene.terrain
    corners = np.empty((rows, columns, 3))
    corners[..., 0] = terrain.x0 + np.arange(columns) * terrain.dx
    corners[..., 1] = (terrain.y0 - np.arange(rows) * terrain.dy)[:, None]
    corners[..., 2] = scene.heights
    northwest, northeast = corners[:-1, :-1], corners[:-1, 1:]
    southwest, southeast = corners[1:, :-1], corners[1:, 1:]
    lower = np.stack([northwest, southwest, southeast], axis=2).reshape(-1, 3, 3)
    upper = np.stack([northwest, southeast, northeast], axis=2).reshape(-1, 3, 3)
    triangles = np.concatenate([lower, upper])
    whole: FloatArray = triangles[np.isfinite(triangles).all(axis=(1, 2))]
    return whole


def brute_depth(scene: Scene, camera: Camera, size: tuple[int, int], points: FloatArray) -> FloatArray:
    """Nearest hit (n,) by Möller and Trumbore over all triangles, with rays made independently."""
    eye = np.array(camera.eye)
    forward = np.array(camera.target) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    across = (2 * points[:, :1] / size[0] - 1) * size[0] / size[1]
    down = 1 - 2 * points[:, 1:] / size[1]
    if camera.fov is None:
        assert camera.view_height is not None
        origins = eye + (right * across + up * down) * camera.view_height / 2
        directions = np.broadcast_to(forward, origins.shape)
    else:
        directions = forward + (right * across + up * down) * np.tan(np.radians(camera.fov) / 2)
        origins = np.broadcast_to(eye, directions.shape)
    depth = np.full(len(points), np.inf)
    for a, b, c in all_triangles(scene):
        normal = np.cross(directions, c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1 / (normal @ (b - a))
            first = ((origins - a) * normal).sum(axis=1) * scale
            turned = np.cross(origins - a, b - a)
            second = (directions * turned).sum(axis=1) * scale
            distance = turned @ (c - a) * scale
            hit = (first >= 0) & (second >= 0) & (first + second <= 1) & (distance >= 0)
        depth[hit] = np.minimum(depth[hit], distance[hit])
    return depth


CAMERAS = {
    "oblique": Camera((-120.0, -90.0, 150.0), (0.0, 30.0, 10.0)),
    "grazing": Camera((-200.0, 31.0, 21.0), (0.0, 33.0, 20.0), fov=20.0),
    "inside": Camera((2.0, 33.0, 45.0), (40.0, 20.0, 0.0), fov=100.0),
    "below": Camera((3.0, 30.0, -30.0), (5.0, 32.0, 20.0), fov=110.0),
    "between": Camera((3.0, 30.0, 20.0), (50.0, 12.0, 21.0), fov=120.0),
    "down": Camera((1.0, 30.0, 300.0), (1.0, 30.0, 0.0), up=(0.0, 1.0, 0.0)),
    "plan": Camera((0.0, 30.0, 300.0), (0.0, 30.0, 0.0), up=(0.0, 1.0, 0.0), fov=None, view_height=120.0),
    "parallel": Camera((-90.0, 0.0, 60.0), (0.0, 30.0, 10.0), fov=None, view_height=90.0),
    "level": Camera((-90.0, 30.0, 20.0), (0.0, 30.0, 20.0), fov=None, view_height=60.0),
}


@pytest.mark.parametrize("name", CAMERAS)
@pytest.mark.parametrize("holes", [0.0, 0.15])
def test_raycast_matches_all_triangles(name: str, holes: float) -> None:
    scene = rough_scene(len(name), 10, 13, holes)
    size = (64, 40)
    points = np.random.default_rng(2).uniform((0, 0), size, (2000, 2))
    surface = ref.raycast(scene, CAMERAS[name], size, points)
    expected = brute_depth(scene, CAMERAS[name], size, points)
    assert np.isfinite(expected).any()
    np.testing.assert_array_equal(np.isfinite(surface.depth), np.isfinite(expected))
    np.testing.assert_allclose(surface.depth, expected, rtol=1e-9)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**6), eye=st.tuples(*[st.floats(-150, 150)] * 3), rows=st.integers(2, 9))
def test_raycast_matches_all_triangles_from_anywhere(
    seed: int, eye: tuple[float, float, float], rows: int
) -> None:
    scene = rough_scene(seed, rows, 6, 0.1)
    camera = Camera(eye, (eye[0] * 0.3 - 20.0, 41.0, 9.5), fov=80.0)
    points = np.random.default_rng(seed).uniform(0, 50, (300, 2))
    surface = ref.raycast(scene, camera, (50, 50), points)
    np.testing.assert_allclose(surface.depth, brute_depth(scene, camera, (50, 50), points), rtol=1e-8)


def test_raycast_far_from_the_origin_and_far_from_the_terrain() -> None:
    scene = rough_scene(3, 20, 20, 0.0, offset=1e7)
    target = (1e7 + 40.0, 1e7 / 3 + 20.0, 10.0)
    camera = Camera((1e7 - 3e5, 1e7 / 3, 4e5), target, fov=0.02)
    surface = ref.raycast(scene, camera, (40, 30))
    hit = np.isfinite(surface.depth)
    assert hit.mean() > 0.3
    column = (surface.world[hit][:, 0] - scene.terrain.x0) / scene.terrain.dx
    row = (scene.terrain.y0 - surface.world[hit][:, 1]) / scene.terrain.dy
    corner = np.floor(np.stack([row, column])).astype(int)
    v, u = np.stack([row, column]) - corner
    heights = scene.heights.astype(np.float64)
    nw, ne = heights[corner[0], corner[1]], heights[corner[0], corner[1] + 1]
    sw, se = heights[corner[0] + 1, corner[1]], heights[corner[0] + 1, corner[1] + 1]
    expected = np.where(v >= u, nw + v * (sw - nw) + u * (se - sw), nw + u * (ne - nw) + v * (se - ne))
    np.testing.assert_allclose(surface.world[hit][:, 2], expected, atol=1e-6)


def test_picture_positions_follow_the_convention() -> None:
    camera = plan_camera(20.0)
    surface = ref.raycast(flat_scene(height=5.0), camera, (40, 20))
    np.testing.assert_allclose(surface.world[0, 0], (-19.5, 9.5, 5.0))
    np.testing.assert_allclose(surface.world[19, 39], (19.5, -9.5, 5.0))
    np.testing.assert_allclose(surface.depth, 995.0)
    camera = Camera((0.0, -10.0, 10.0), (0.0, 0.0, 0.0), fov=90.0)
    centre = ref.raycast(flat_scene(), camera, (10, 10), np.array([[5.0, 5.0], [5.0, 0.0], [5.0, 10.0]]))
    np.testing.assert_allclose(centre.depth[0], np.sqrt(200))
    assert not np.isfinite(centre.depth[1])
    np.testing.assert_allclose(centre.world[2], (0.0, -10.0, 0.0), atol=1e-12)


def test_plane_gives_its_gradient_and_ridge_hides_what_lies_behind() -> None:
    x, y = np.meshgrid(np.arange(5) * 10.0, 40.0 - np.arange(5) * 10.0)
    plane = Scene((0.25 * x - 0.5 * y).astype(np.float32), Terrain(0.0, 40.0, 10.0, 10.0))
    surface = ref.raycast(plane, plan_camera(20.0, 20.0, 20.0), (8, 8))
    np.testing.assert_allclose(surface.gradient, np.broadcast_to((0.25, -0.5), (8, 8, 2)))
    ridge = np.zeros((5, 5), dtype=np.float32)
    ridge[2] = 20.0
    camera = Camera((20.0, -30.0, 10.0), (20.0, 20.0, 10.0), fov=40.0)
    seen = ref.raycast(Scene(ridge, Terrain(0.0, 40.0, 10.0, 10.0)), camera, (32, 32))
    hit = np.isfinite(seen.depth)
    assert hit.any()
    assert seen.world[hit][:, 1].max() <= 20.0 + 1e-9


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (7, 1), (4, 4)])
def test_terrain_without_triangles_is_sky(shape: tuple[int, int]) -> None:
    heights = np.full(shape, np.nan if shape == (4, 4) else 1.0, dtype=np.float32)
    surface = ref.raycast(Scene(heights, Terrain(0, 0, 1, 1)), plan_camera(20.0), (4, 3))
    assert np.isinf(surface.depth).all()
    assert np.isnan(surface.world).all()
    assert np.isnan(surface.gradient).all()


# Membership


def naive_inside(rings: list[FloatArray], x: float, y: float) -> bool:
    inside = False
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            if ay > by:
                ax, ay, bx, by = bx, by, ax, ay
            if ay <= y < by and (bx - ax) * (y - ay) - (x - ax) * (by - ay) > 0:
                inside = not inside
    return inside


def test_even_odd_of_known_polygons() -> None:
    donut = [square(0, 0, 10), square(3, 3, 4)]
    nested = [square(20 + i, i, 10 - 2 * i) for i in range(5)]
    overlapping = [square(40, 0, 6), square(43, 3, 6)]
    repeated = [square(60, 0, 6), square(60, 0, 6)]
    bow_tie = [[(80, 0), (86, 6), (86, 0), (80, 6)]]
    layer = make_layer("polygons", [donut, nested, overlapping, repeated, bow_tie])
    cases = {
        (1, 5): [0], (5, 5): [], (20.5, 5): [1], (21.5, 5): [], (24.5, 5): [1], (22.5, 5): [1],
        (41, 1): [2], (44.5, 4.5): [], (48, 8): [2], (63, 3): [], (80.5, 3): [4], (83, 1): [], (83, 5): [],
    }  # fmt: skip
    held = ref.membership(layer, np.array(list(cases), dtype=np.float64))
    assert [held.at(i).tolist() for i in range(len(cases))] == list(cases.values())


ring_strategy = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=3, max_size=8)


@settings(max_examples=60, deadline=None)
@given(features=st.lists(st.lists(ring_strategy, min_size=1, max_size=3), min_size=1, max_size=4))
def test_even_odd_matches_counting_on_a_lattice(features: list[list[Any]]) -> None:
    """Vertices, edges and points coincide all the time here."""
    layer = make_layer("polygons", features)
    x, y = np.meshgrid(np.arange(-1, 8) / 1.0, np.arange(-2, 14) / 2)
    xy = np.stack([x.ravel(), y.ravel()], axis=1)
    held = ref.membership(layer, xy)
    for index, rings in enumerate(features):
        arrays = [np.array(ring, dtype=np.float64) for ring in rings]
        np.testing.assert_array_equal(held.inside(index), [naive_inside(arrays, *point) for point in xy])


@pytest.mark.parametrize("area", [(0.0, 100.0), (49.0, 50.0)])
def test_many_points_in_strips_match_shapely(area: tuple[float, float]) -> None:
    """Random points of valid rings: enough for many strips, wide and closely zoomed."""
    features = star_features(40, 5)
    xy = np.random.default_rng(1).uniform(*area, (60_000, 2))
    held = ref.membership(make_layer("polygons", features), xy)
    lines = ref.membership(make_layer("lines", features, width=1.5), xy)
    points = shapely.points(xy)
    for index, (ring,) in enumerate(features):
        polygon = shapely.Polygon(ring)
        shapely.prepare(polygon)
        np.testing.assert_array_equal(held.inside(index), shapely.contains(polygon, points))
        line = shapely.LineString(ring)
        shapely.prepare(line)
        np.testing.assert_array_equal(lines.inside(index), shapely.dwithin(line, points, 0.75))


def test_shared_borders_belong_to_one_feature() -> None:
    cells = [[square(x, y, 1)] for y in range(4) for x in range(4)]
    reversed_cells = [[ring[::-1]] if i % 2 else [ring] for i, (ring,) in enumerate(cells)]
    x, y = np.meshgrid(np.arange(0, 4, 0.25), np.arange(0, 4, 0.25))
    held = ref.membership(make_layer("polygons", reversed_cells), np.stack([x.ravel(), y.ravel()], axis=1))
    np.testing.assert_array_equal(np.diff(held.offsets), 1)
    slanted = [[[(0, 0), (7, 0), (3, 9)]], [[(3, 9), (7, 0), (11, 10)]]]
    along = np.linspace(0, 1, 101)[1:-1, None] * np.array([[-4.0, 9.0]]) + np.array([[7.0, 0.0]])
    held = ref.membership(make_layer("polygons", slanted), along)
    np.testing.assert_array_equal(np.diff(held.offsets), 1)


def test_lines_are_closed_sets_with_round_ends() -> None:
    layer = make_layer("lines", [[[(0, 0), (10, 0)]], [[(20, 0), (20, 0)]], [[(30, 0)]]], width=2.0)
    inside = np.array([(5, 1), (-1, 0), (11, 0), (20, 1), (19, 0), (30, -1), (31, 0)], dtype=np.float64)
    outside = np.array([(5, 1.0000001), (-0.8, 0.8), (10.8, -0.8), (20.8, 0.8), (29.2, 0.8), (15, 0)])
    assert ref.membership(layer, inside).topmost().tolist() == [0, 0, 0, 1, 1, 2, 2]
    assert ref.membership(layer, outside).topmost().tolist() == [-1] * 6


def test_membership_is_in_draw_order_and_skips_what_is_not_a_place() -> None:
    layer = make_layer("polygons", [[square(0, 0, 4)], [square(1, 1, 4)], [square(2, 2, 4)]])
    layer.draw_order = np.array([2, 0, 1])
    held = ref.membership(layer, np.array([(3.0, 3.0), (np.nan, np.nan), (1.5, 1.5)]))
    assert [held.at(i).tolist() for i in range(3)] == [[2, 0, 1], [], [0, 1]]
    assert held.topmost().tolist() == [1, -1, 1]
    nothing = ref.membership(make_layer("polygons", []), np.zeros((2, 2)))
    assert nothing.topmost().tolist() == [-1, -1]
    assert ref.membership(layer, np.empty((0, 2))).offsets.tolist() == [0]


@pytest.mark.parametrize("limit", [np.inf, 2.0])
def test_edge_distance_matches_shapely(limit: float) -> None:
    rings, lines = star_features(12, 8), [*star_features(5, 9), [np.array([(40.0, 40.0)])]]
    scene = flat_scene()
    widths = np.array([6.0, 0.01, 30.0, 1.0, 6.0, 12.0])
    scene.layers = [make_layer("polygons", rings), make_layer("lines", lines, width=widths)]
    xy = np.random.default_rng(4).uniform(-200, 300, (400, 2))
    xy[200:] = xy[200:] / 5 + 40
    points = shapely.points(xy)
    expected = np.full(len(xy), np.inf)
    for (ring,) in rings:
        expected = np.minimum(expected, shapely.distance(shapely.LinearRing(ring), points))
    for (line,), width in zip(lines, widths, strict=True):
        shape = shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0])
        expected = np.minimum(expected, np.abs(shapely.distance(shape, points) - width / 2))
    expected[expected > limit] = np.inf
    np.testing.assert_allclose(ref.edge_distance(scene, xy, limit), expected, rtol=1e-9, atol=1e-9)
    assert np.isinf(ref.edge_distance(flat_scene(), xy)).all()
