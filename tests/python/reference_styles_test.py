"""The reference's styles against shapely's buffers, closed forms and brute force."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from decalgl import reference as ref
from decalgl.reference.areas import feature_area
from decalgl.strokes import ColorBand, Hatch, LinePattern, PatternMark
from reference_scenes import (
    Fill,
    Layer,
    Scene,
    Stroke,
    Style,
    Terrain,
    flat_scene,
    make_layer,
    plan_camera,
    square,
    star_features,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

CORNERS = {"round": "round", "miter": "mitre", "bevel": "bevel"}
CAPS = {"round": "round", "butt": "flat", "square": "square"}
ORIGIN = np.zeros(2)


def holds(layer: Layer, xy: Any, slopes: ref.Slopes | None = None) -> list[bool]:
    """Whether feature 0 holds each point."""
    held = ref.membership(layer, np.array(xy, dtype=np.float64).reshape(-1, 2), slopes=slopes)
    return held.inside(0).tolist()


def line(points: Any, width: float, **style: Any) -> Layer:
    return make_layer("lines", [[points]], width=width, style=Style(**style))


def shapely_buffer(points: FloatArray, half_width: float, style: Style, single: bool = False) -> Any:
    ratio = 1 / np.sin(np.radians(style.miter_limit) / 2)
    closed = shapely.LineString(points).is_ring
    geometry = shapely.LinearRing(points) if closed else shapely.LineString(points)
    return shapely.buffer(
        geometry, half_width, quad_segs=64, cap_style=CAPS[style.cap], join_style=CORNERS[style.corner],
        mitre_limit=ratio, single_sided=single,
    )  # fmt: skip


def scattered(points: Any, reach: float, count: int = 4000, seed: int = 3) -> FloatArray:
    low, high = np.min(points, axis=0) - reach, np.max(points, axis=0) + reach
    return np.random.default_rng(seed).uniform(low, high, (count, 2))


# Corners and caps against shapely


@pytest.mark.parametrize("corner", CORNERS)
@pytest.mark.parametrize("cap", CAPS)
@pytest.mark.parametrize("turn", [0.0, 25.0, 60.0, 90.0, 120.0, 139.0, 170.0, -45.0, -100.0])
def test_corners_and_caps_match_shapely(corner: str, cap: str, turn: float) -> None:
    bend = np.radians(turn + 20.0)
    start = -10.0 * np.array([np.cos(np.radians(20.0)), np.sin(np.radians(20.0))])
    points = np.array([start, (0.0, 0.0), (10.0 * np.cos(bend), 10.0 * np.sin(bend))])
    if corner == "miter" and 180.0 - abs(turn) < 40.0:
        # Shapely cuts these off; here they are round.
        expected = shapely_buffer(points, 2.0, Style(cap=cap))
    else:
        expected = shapely_buffer(points, 2.0, Style(corner=corner, cap=cap))
    layer = line(points, 4.0, corner=corner, cap=cap)
    xy = scattered(points, 5.0)
    sure = shapely.distance(expected.boundary, shapely.points(xy)) > 1e-3
    assert holds(layer, xy[sure]) == shapely.contains_xy(expected, xy[sure]).tolist()
    area = feature_area(layer, 0, ORIGIN)
    assert shapely.area(shapely.symmetric_difference(area, expected)) < 3e-3


@pytest.mark.parametrize("corner", CORNERS)
@pytest.mark.parametrize("closed", [False, True])
def test_long_lines_match_shapely(corner: str, closed: bool) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 12 + closed)
    points = (
        np.stack([np.cos(angle), np.sin(angle)], axis=1)
        * (10.0 + 3.0 * (np.arange(12 + closed) % 2))[:, None]
    )
    if closed:
        points[-1] = points[0]
    style = Style(corner=corner, cap="square", miter_limit=10.0)
    expected = shapely_buffer(points, 1.0, style)
    layer = line(points, 2.0, corner=corner, cap="square", miter_limit=10.0)
    xy = scattered(points, 4.0, 20_000)
    sure = shapely.distance(expected.boundary, shapely.points(xy)) > 1e-3
    assert holds(layer, xy[sure]) == shapely.contains_xy(expected, xy[sure]).tolist()


@pytest.mark.parametrize("mode", ["normal", "inset", "offset"])
@pytest.mark.parametrize("corner", CORNERS)
def test_outlines_match_shapely(mode: str, corner: str) -> None:
    rings = [square(0, 0, 20), [(4, 4), (10, 5), (9, 15), (3, 12)], square(12, 8, 3)]
    layer = make_layer("polygons", [rings], width=2.0, style=Style(corner=corner))
    layer.fill, layer.outline_mode = None, mode
    polygon = shapely.Polygon(rings[0], rings[1:])
    half_width = 1.0 if mode == "normal" else 2.0
    style = Style(corner=corner)
    expected = shapely.union_all([shapely_buffer([*ring, ring[0]], half_width, style) for ring in rings])
    if mode != "normal":
        expected = (shapely.intersection if mode == "inset" else shapely.difference)(expected, polygon)
    xy = scattered(rings[0], 4.0, 20_000)
    sure = shapely.distance(expected.boundary, shapely.points(xy)) > 1e-3
    assert holds(layer, xy[sure]) == shapely.contains_xy(expected, xy[sure]).tolist()
    area = feature_area(layer, 0, ORIGIN)
    assert shapely.area(shapely.symmetric_difference(area, expected)) < 0.02


def test_an_outline_wider_than_its_polygon_fills_it() -> None:
    (ring,) = star_features(1, 3)[0]
    layer = make_layer("polygons", [[ring]], width=100.0)
    layer.outline_mode = "inset"
    layer.fill = None
    xy = scattered(ring, 3.0)
    assert holds(layer, xy) == shapely.contains_xy(shapely.Polygon(ring), xy).tolist()


def test_corner_angles_at_the_limit_and_beyond() -> None:
    def corner(degrees: float, limit: float) -> Layer:
        opening = np.radians(degrees)
        return line([(-9, 0), (0, 0), (-9 * np.cos(opening), 9 * np.sin(opening))], 2.0,
                    corner="miter", cap="butt", miter_limit=limit)  # fmt: skip

    tip = 1.0 / np.sin(np.radians(30.0)) * np.array([np.cos(np.radians(-30.0)), np.sin(np.radians(-30.0))])
    assert holds(corner(60.0, 59.0), [0.999 * tip, 1.001 * tip, 0.55 * tip]) == [True, False, True]
    assert holds(corner(60.0, 61.0), [0.999 * tip, 0.499 * tip, 0.501 * tip]) == [False, True, False]
    # Exact reversals are sharper than any limit; a bevel adds nothing to them, nor to straight lines.
    back = [(0, 0), (9, 0), (1, 0)]
    assert holds(line(back, 2.0, corner="miter", cap="butt"), [(9.9, 0), (9.0, 1.0), (10.1, 0)]) == [
        True,
        True,
        False,
    ]
    assert holds(line(back, 2.0, corner="bevel", cap="butt"), [(9.1, 0), (8.9, 0.9)]) == [False, True]
    straight = [(0, 0), (5, 0), (9, 0)]
    for kind in CORNERS:
        assert holds(line(straight, 2.0, corner=kind, cap="butt"), [(5, 0.999), (5, 1.001)]) == [True, False]


def test_degenerate_parts() -> None:
    dots = {"round": [True, False, False], "square": [True, True, False], "butt": [False, False, False]}
    for cap, expected in dots.items():
        for points in ([(3, 3)], [(3, 3), (3, 3), (3, 3)]):
            assert holds(line(points, 2.0, cap=cap), [(3.6, 3.6), (3.95, 3.95), (4.05, 3)]) == expected
    # Repeated vertices count once; there and back is not closed, a triangle is.
    assert holds(line([(0, 0), (0, 0), (4, 0), (4, 0)], 2.0, cap="butt"), [(-0.1, 0), (2, 0)]) == [
        False,
        True,
    ]
    assert holds(line([(0, 0), (4, 0), (0, 0)], 2.0, cap="square"), [(-0.9, 0.9), (4.5, 0.5)]) == [True, True]
    triangle = [(0, 0), (4, 0), (0, 4), (0, 0)]
    assert holds(line(triangle, 2.0, corner="miter", cap="square"), [(-0.9, -0.9), (-0.9, 1.0)]) == [
        True,
        True,
    ]
    assert holds(line(triangle, 2.0, corner="bevel", cap="square"), [(-0.9, -0.9), (-0.9, 1.0)]) == [
        False,
        True,
    ]
    rings: list[list[Any]] = [[(0, 0), (4, 0), (0, 0)], [(9, 9)], []]
    layer = make_layer("polygons", [rings], width=2.0)
    assert holds(layer, [(2, 0), (9, 9)]) == [False, False]


# Patterns


def dashes(*marks: tuple[float, ...], period: float, offset: float = 0.0) -> LinePattern:
    return LinePattern(period, tuple(PatternMark(*mark) for mark in marks), offset)


def test_dashes_follow_the_arc_length() -> None:
    pattern = dashes((0, 2), (3, 4), period=6, offset=1)
    layer = line([(0, 0), (4, 0), (4, 20)], 1.0, pattern=pattern, corner="bevel", cap="butt")
    on = {
        0.5: True,
        1.1: False,
        2.5: True,
        3.1: False,
        5.5: True,
        7.5: False,
        8.5: True,
        10.0: False,
        11.5: True,
    }
    points = [(a, 0.3) if a < 4 else (4.3, a - 4) for a in on]
    assert holds(layer, points) == list(on.values())


def test_patterned_corners_and_caps_take_their_vertex_s_place() -> None:
    ends = [(0, 0), (4, 0), (4, 4)]
    layer = line(ends, 2.0, pattern=dashes((0, 1), (3.9, 4.1), (7.5, 8), period=10), cap="round")
    expected = {
        (-0.9, 0.0): True,
        (4.6, -0.6): True,
        (3.5, 0.8): True,
        (2.5, 0.0): False,
        (4.0, 4.9): True,
        (4, 2.5): False,
    }
    assert holds(layer, list(expected)) == list(expected.values())
    # The vertices at 0, 4 and 8 lie in gaps.
    layer = line(ends, 2.0, pattern=dashes((0.2, 1), period=5), cap="round")
    assert holds(layer, [(-0.1, 0), (4.3, -0.3), (4, 8.1), (0.5, 0.9)]) == [False, False, False, True]
    # The line runs on through a square cap.
    layer = line(ends, 2.0, pattern=dashes((9.5, 10), period=10), cap="square")
    assert holds(layer, [(-0.25, 0.9), (-0.75, 0), (0.1, 0)]) == [True, False, False]


def test_tapered_marks_are_trapezoids() -> None:
    layer = line([(0, 0), (100, 0)], 4.0, cap="butt", pattern=dashes((1, 5, 1.0, 0.0), period=10))
    for u in np.linspace(1.05, 4.95, 14):
        reach = 2.0 * (5 - u) / 4
        at = [(30 + u, 0.99 * reach), (30 + u, 1.01 * reach), (30 + u, -0.99 * reach)]
        assert holds(layer, at) == [True, False, True]
    area = feature_area(layer, 0, ORIGIN)
    np.testing.assert_allclose(shapely.area(area), 10 * 4 * 4 / 2)


@settings(max_examples=60, deadline=None)
@given(
    points=st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), min_size=1, max_size=6),
    corner=st.sampled_from(sorted(CORNERS)),
    cap=st.sampled_from(sorted(CAPS)),
    width=st.floats(0.2, 8.0),
    period=st.floats(0.3, 30.0),
    offset=st.floats(-9.0, 9.0),
    share=st.floats(0.05, 0.95),
    patterned=st.booleans(),
)
def test_membership_matches_areas(
    points: list[tuple[int, int]], corner: str, cap: str, width: float, period: float, offset: float,
    share: float, patterned: bool,
) -> None:  # fmt: skip
    """Polygons that shapely unites, and tests of points, are two ways to the same stroke."""
    # A vertex right at a mark's end is in the mark or not by rounding alone.
    steps = np.hypot(*np.diff(np.array(points, dtype=np.float64), axis=0).T)
    phase = (np.concatenate([[0.0], np.cumsum(steps)]) + offset) / period
    for end in (0.0, share):
        assume(not patterned or (np.abs(phase - end - np.round(phase - end)) > 1e-9).all())
    pattern = dashes((0, share * period, 1.0, 0.5), period=period, offset=offset) if patterned else None
    layer = line(points, width, corner=corner, cap=cap, pattern=pattern, miter_limit=20.0)
    area = feature_area(layer, 0, ORIGIN)
    xy = scattered(points, 2.0 * width, 1000)
    sure = shapely.distance(area.boundary, shapely.points(xy)) > 1e-3 * width
    assert holds(layer, xy[sure]) == shapely.contains_xy(area, xy[sure]).tolist()
    scene = flat_scene()
    scene.layers = [layer]
    distance = ref.edge_distance(scene, xy)
    # A lower bound: no farther than the border, and not closer without a reason.
    if not area.is_empty:
        exact = shapely.distance(area.boundary, shapely.points(xy))
        assert (distance <= exact + 1e-3 * width).all()


# Bands, casings, hatches


def test_bands_go_by_the_nearest_piece() -> None:
    bands = (
        ColorBand(0.25, (255, 0, 0, 255)),
        ColorBand(0.5, (0, 255, 0, 0)),
        ColorBand(1.0, (0, 0, 255, 128)),
    )
    layer = line([(0, 0), (10, 0), (10, 10)], 8.0, bands=bands, corner="miter", cap="butt")
    assert layer.stroke is not None
    layer.stroke.colors[0] = (9, 9, 9, 127)
    red, blue = (1.0, 0, 0, 127 / 255), (0, 0, 1.0, 128 / 255 * 127 / 255)
    cases = {(5, 0.9): red, (5, 1.1): None, (5, 2.1): blue, (5, 4.1): None, (10.5, 5): red, (9, 0.5): red,
             (10.9, -0.5): red, (11.9, -0.5): None, (13.9, -3.9): blue, (7.5, 2.4): blue, (9.5, 3.0): red}  # fmt: skip
    held = ref.membership(layer, np.array(list(cases), dtype=np.float64))
    for i, expected in enumerate(cases.values()):
        colors = held.colors[held.offsets[i] : held.offsets[i + 1]]
        if expected is None:
            assert len(colors) == 0
        else:
            alpha = expected[3]
            np.testing.assert_allclose(
                colors, [[expected[0] * alpha, expected[1], expected[2] * alpha, alpha]]
            )


def test_casings_lie_under_all_strokes_and_outlines_where_told() -> None:
    cross = make_layer(
        "lines",
        [[[(-9, 0), (9, 0)]], [[(0, -9), (0, 9)]]],
        width=2.0,
        colors=[(1, 0, 0, 255), (2, 0, 0, 255)],
    )
    cross.casing = Stroke(np.array([(3, 0, 0, 255), (4, 0, 0, 0)], dtype=np.uint8), np.array([6.0, 6.0]))
    held = ref.membership(cross, np.array([(0.0, 0.0), (0.5, 2.5), (5.0, 2.0), (2.5, 5.0)]))
    assert [held.at(i).tolist() for i in range(4)] == [[0, 0, 1], [0, 1], [0], []]
    squares = make_layer("polygons", [[square(0, 0, 8)], [square(4, 4, 8)]], width=2.0)
    at = np.array([(7.5, 7.5)])
    assert ref.membership(squares, at).at(0).tolist() == [0, 1, 0]
    squares.outline_order = "feature"
    assert ref.membership(squares, at).at(0).tolist() == [0, 0, 1]
    squares.draw_order = np.array([1, 0])
    assert ref.membership(squares, at).at(0).tolist() == [1, 0, 0]


@pytest.mark.parametrize("angle", [0.0, 30.0, 45.0, 90.0, -120.0])
@pytest.mark.parametrize("crossed", [False, True])
def test_hatches(angle: float, crossed: bool) -> None:
    layer = make_layer("polygons", [[square(-20, -20, 40)], [square(30, 0, 5)]])
    assert layer.fill is not None
    layer.fill = Fill(layer.fill.colors, (Hatch(4.0, 1.0, angle, crossed), None), np.array([0, 1]))
    xy = np.random.default_rng(2).uniform(-25, 40, (5000, 2))
    along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    across = np.array([-along[1], along[0]])
    # Lines through the origin, rotated back to level ones.
    on = np.abs((xy @ across + 2.0) % 4.0 - 2.0) <= 0.5
    if crossed:
        on |= np.abs((xy @ along + 2.0) % 4.0 - 2.0) <= 0.5
    inside = (np.abs(xy) <= 20).all(axis=1)
    held = ref.membership(layer, xy)
    np.testing.assert_array_equal(held.inside(0), on & inside)
    assert held.inside(1).sum() > 5
    area = feature_area(layer, 0, np.array([3.0, -5.0]))
    far = shapely.distance(shapely.boundary(area), shapely.points(xy - (3.0, -5.0))) > 1e-6
    np.testing.assert_array_equal(shapely.contains_xy(area, xy - (3.0, -5.0))[far], (on & inside)[far])


# Slopes


def test_tangent_strokes_are_as_wide_on_the_slope() -> None:
    gradient = np.array([0.75, 0.0])  # 5/4 as long uphill
    across = line([(0, -50), (0, 50)], 10.0, slope_correction="tangent")
    along = line([(-50, 0), (50, 0)], 10.0, slope_correction="tangent", cap="butt")
    xy = np.array([(3.99, 0.0), (4.01, 0.0), (-3.99, 1.0)])
    slopes = ref.Slopes(np.tile(gradient, (3, 1)), np.array([0.0, 0.0, -1.0]))
    assert holds(across, xy, slopes) == [True, False, True]
    assert holds(across, xy) == [True, True, True]
    xy = np.array([(0.0, 4.99), (0.0, 5.01), (49.9, 0.0)])
    assert holds(along, xy, slopes) == [True, False, True]
    # In space: the distance from the axis on a slanting plane, whatever its direction.
    slant = np.array([0.6, -1.1])
    points = np.random.default_rng(5).uniform(-12, 12, (3000, 2))
    a, b = np.array([-20.0, -13.0]), np.array([25.0, 11.0])
    layer = line([a, b], 6.0, slope_correction="tangent", cap="butt")
    in_space = [np.append(p, p @ slant) for p in (b - a, *(points - a))]
    axis = in_space[0] / np.linalg.norm(in_space[0])
    apart = np.linalg.norm([p - (p @ axis) * axis for p in in_space[1:]], axis=1)
    slopes = ref.Slopes(np.tile(slant, (len(points), 1)), np.array([0.0, 0.0, -1.0]))
    assert holds(layer, points, slopes) == (apart <= 3.0).tolist()


def test_thoeny_strokes_narrow_on_slopes_seen_from_the_side() -> None:
    layer = line([(0, -50), (0, 50)], 10.0, slope_correction="thoeny")
    gradient = np.array([[0.75, 0.0]])
    for down, reach in ((1.0, 5.0), (0.5, 4.5), (0.0, 4.0), (-0.4, 4.0)):
        slopes = ref.Slopes(gradient, np.array([np.sqrt(1 - down**2), 0.0, -down]))
        assert holds(layer, [(0.999 * reach, 0.0)], slopes) == [True]
        assert holds(layer, [(1.001 * reach, 0.0)], slopes) == [False]


def test_pictures_know_the_slope() -> None:
    x = np.linspace(-100, 100, 3)
    scene = Scene(np.tile(0.75 * x, (3, 1)).astype(np.float32), Terrain(-100.0, 100.0, 100.0, 100.0))
    scene.layers = [line([(0, -50), (0, 50)], 10.0, slope_correction="tangent")]
    camera, size = plan_camera(40.0), (40, 40)
    ids = ref.render_ids(scene, camera, size)
    assert (ids.ids[20] >= 0).sum() == 8
    np.testing.assert_allclose(ids.edge_distance[20, 20], 3.5 if not (ids.ids[20, 20] < 0) else 0, atol=1e-9)
    overlay = ref.render_overlay(scene, camera, size, (10, 20, 30, 21), samples=4)
    np.testing.assert_allclose(overlay.rgba[..., 3].sum(), 8.0, atol=1e-9)
    sampled = ref.sampled_coverage(scene, camera, size, 0, 0, (10, 20, 30, 21), samples=4)
    np.testing.assert_allclose(sampled, overlay.rgba[..., 3])
    with pytest.raises(ValueError, match="slope correction"):
        ref.exact_coverage(scene, camera, size, 0, 0, (10, 20, 30, 21))
    blind = ref.Surface(np.zeros((1, 3)), np.ones(1), np.full((1, 2), np.nan))
    with pytest.raises(ValueError, match="no gradients"):
        ref.render_ids(scene, camera, (1, 1), surface=blind.reshape(1, 1))


# Distances and coverage


def test_edge_distance_knows_dashes_bands_and_hatches() -> None:
    bands = (ColorBand(0.5, (255, 0, 0, 255)), ColorBand(1.0, (0, 0, 255, 255)))
    scene = flat_scene()
    plain = {"cap": "butt", "corner": "miter"}
    cases: list[tuple[Layer, dict[tuple[float, float], float]]] = [
        (line([(0, 0), (40, 0)], 8.0, pattern=dashes((0, 5), period=10), **plain),
         {(12, 0): 2, (14.5, 1): 0.5, (16, 0): 1, (13, 3.5): 0.5, (13, 4.25): 0.25}),
        (line([(0, 0), (40, 0)], 8.0, bands=bands, **plain), {(20, 1.75): 0.25, (20, 3): 1, (20, 3.5): 0.5}),
    ]  # fmt: skip
    hatched = make_layer("polygons", [[square(0, 0, 20)]])
    assert hatched.fill is not None
    hatched.fill.hatches = (Hatch(4.0, 1.0, 0.0),)
    cases.append((hatched, {(10, 10): 1.5, (10, 8.25): 0.25, (19.9, 10): 0.1, (21, 8.25): 1}))
    for layer, expected in cases:
        scene.layers = [layer]
        found = ref.edge_distance(scene, np.array(list(expected), dtype=np.float64))
        np.testing.assert_allclose(found, list(expected.values()), atol=1e-9)


@pytest.mark.parametrize("corner", CORNERS)
def test_samples_agree_with_areas_of_styles(corner: str) -> None:
    points = star_features(1, 6)[0][0][:9]
    layer = line((points - points.mean(axis=0)) * 0.8, 2.0, corner=corner, cap="square",
                 pattern=dashes((0, 3, 1.0, 0.3), period=4))  # fmt: skip
    scene = flat_scene()
    scene.layers = [layer]
    camera, size, crop = plan_camera(40.0), (48, 48), (8, 8, 40, 40)
    exact = ref.exact_coverage(scene, camera, size, 0, 0, crop)
    sampled = ref.sampled_coverage(scene, camera, size, 0, 0, crop)
    partial = (exact > 0) & (exact < 1)
    assert partial.sum() > 20
    assert np.sqrt(np.mean((exact - sampled)[partial] ** 2)) < 0.012


def test_of_strokes_the_nearest_alone_holds_a_point() -> None:
    lines = [[[(-9, 0), (9, 0)]], [[(-9, 1), (9, 1)]], [[(-9, 3), (9, 3)]]]
    layer = make_layer("lines", lines, width=[4.0, 4.0, 0.2])
    points = np.array([(0, 0.2), (0, 0.8), (0, 0.5), (0, 2.5), (0, 3.05), (0, -2.1), (0, -1.9)])
    # On a tie the topmost; the third is nearer to (0, 2.5), but does not reach it.
    expected = [0, 1, 1, 1, 2, -1, 0]
    assert ref.membership(layer, points, nearest=True).topmost().tolist() == expected
    assert ref.membership(layer, points).topmost().tolist() == [1, 1, 1, 1, 2, -1, 0]
    nearest = ref.membership(layer, points, nearest=True)
    assert np.diff(nearest.offsets).tolist() == [1, 1, 1, 1, 1, 0, 1]


def test_casings_and_fills_are_apart_from_the_nearest_stroke() -> None:
    lines = [[[(-9, 0), (9, 0)]], [[(-9, 3), (9, 3)]]]
    layer = make_layer("lines", lines, width=2.0)
    layer.casing = Stroke(np.full((2, 4), 255, dtype=np.uint8), np.array([6.0, 6.0]), (Style(),))
    points = np.array([(0, 0.5), (0, 1.2), (0, 1.9)])
    held = ref.membership(layer, points, nearest=True)
    # The stroke of the first over its casing, and between both strokes the nearer casing.
    assert np.diff(held.offsets).tolist() == [2, 1, 1]
    assert held.topmost().tolist() == [0, 0, 1]
    rings = make_layer("polygons", [[square(-4, -4, 8)], [square(-3, -3, 8)]], width=2.0)
    inner = np.array([(4.6, 0.0), (3.6, 0.0)])
    # Fills lie over each other below the nearest outline.
    assert ref.membership(rings, inner, nearest=True).topmost().tolist() == [1, 0]
    assert np.diff(ref.membership(rings, inner, nearest=True).offsets).tolist() == [2, 3]
    for change in ({"outline_order": "feature"}, {"outline_mode": "inset"}):
        cut = replace(rings, **change)
        ordered, nearest = (ref.membership(cut, inner, nearest=wanted) for wanted in (False, True))
        assert nearest.features.tolist() == ordered.features.tolist()
