"""Features as flat arrays: rings and lines, plain tables, and what is left out with a count."""

from __future__ import annotations

import warnings
from typing import Any

import geopandas
import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import GeometryCollection, LineString, MultiLineString, MultiPolygon, Point, Polygon, box

from decalgl.errors import DecalWarning, InputError
from decalgl.features import FeatureTable
from vector_data import DONUT, SHAPES, UTM, assert_same, parts_of, read


def test_rings_lose_their_closing_point_and_holes_turn_the_other_way() -> None:
    table = read(SHAPES)
    assert (len(table), len(table.part_offsets) - 1, len(table.coords)) == (3, 8, 32)
    np.testing.assert_array_equal(table.feature_offsets, [0, 3, 7, 8])
    np.testing.assert_allclose(table.sizes(), shapely.area(SHAPES))
    assert table.bounds == (0.0, 0.0, 40.0, 10.0)
    assert not table.coords.flags.writeable


def test_lines_keep_their_points() -> None:
    lines = [LineString([(0, 0), (3, 4)]), MultiLineString([[(0, 0), (1, 0)], [(5, 5), (5, 7), (5, 5)]])]
    lines += [shapely.LinearRing([(0, 0), (1, 0), (0, 1)]), LineString([(2, 2), (2, 2)])]
    table = read(lines, "lines")
    assert parts_of(table)[0] == [[[0, 0], [3, 4]]]
    assert parts_of(table)[1] == [[[0, 0], [1, 0]], [[5, 5], [5, 7], [5, 5]]]
    assert parts_of(table)[3] == [[[2, 2], [2, 2]]], "a line of no length draws a dot"
    np.testing.assert_allclose(table.sizes(), shapely.length(lines))


@pytest.mark.parametrize("wrap", [tuple, lambda pair: dict(zip(("coords", "offsets"), pair, strict=True))])
def test_plain_numpy(wrap: Any) -> None:
    coords = [[0, 0], [4, 0], [4, 4], [9, 9], [12, 13]]
    lines = read(wrap((coords, [0, 3, 5])), "lines", crs=UTM)
    assert parts_of(lines) == [[[[0, 0], [4, 0], [4, 4]]], [[[9, 9], [12, 13]]]]
    np.testing.assert_allclose(lines.sizes(), [8, 5])
    ring = read(wrap((np.array(coords)[[0, 1, 2, 0]], np.array([0, 4]))), crs=UTM)
    assert parts_of(ring) == [[[[0, 0], [4, 0], [4, 4]]]]


@pytest.mark.parametrize(
    ("coords", "offsets"),
    [
        (np.zeros((4, 2)), [0, 3]),
        (np.zeros((4, 2)), [1, 4]),
        (np.zeros((4, 2)), [0, 3, 2, 4]),
        (np.zeros((4, 2)), [0.0, 4.0]),
        (np.zeros((4, 2)), []),
        (np.zeros(4), [0, 4]),
        (np.zeros((4, 5)), [0, 4]),
        ([["a", "b"]], [0, 1]),
    ],
)
def test_plain_numpy_that_does_not_fit_is_refused(coords: Any, offsets: Any) -> None:
    with pytest.raises(InputError, match="'parks'"):
        read((coords, offsets), "lines")


def test_tables_pass_through_and_follow_a_crs() -> None:
    table = read(SHAPES)
    assert_same(read(table), table)
    moved = read(table, crs=UTM, own="EPSG:4326")
    assert moved.bounds != table.bounds
    with pytest.raises(InputError, match="add_polygons instead of add_lines"):
        read(table, "lines")


@pytest.mark.parametrize(
    "arrays",
    [
        (np.zeros((3, 3)), [0, 3], [0, 1], [0]),
        (np.zeros((3, 2)), [0, 2], [0, 1], [0]),
        (np.zeros((3, 2)), [0, 3], [0, 2], [0]),
        (np.zeros((3, 2)), [0, 3], [0, 1], [0, 1]),
        (np.zeros((3, 2)), [0, 3], [0, 1], [-1]),
    ],
)
def test_tables_check_their_arrays(arrays: Any) -> None:
    with pytest.raises(InputError):
        FeatureTable("lines", *arrays)


coordinate = st.integers(-50, 50).map(float)
points = st.tuples(coordinate, coordinate)
lines = st.lists(st.lists(points, min_size=2, max_size=6), min_size=1, max_size=3)


@settings(max_examples=80, deadline=None)
@given(st.lists(st.none() | lines, max_size=8))
def test_lines_survive_the_round_trip(features: Any) -> None:
    shapes = [None if parts is None else MultiLineString(parts) for parts in features]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DecalWarning)
        table = read(np.array([*shapes, None], dtype=object)[:-1], "lines")
        mapped = read([None if s is None else shapely.geometry.mapping(s) for s in shapes], "lines")
    expected = [(row, parts) for row, parts in enumerate(features) if parts is not None]
    assert table.rows.tolist() == [row for row, _ in expected]
    assert parts_of(table) == [[[list(p) for p in part] for part in parts] for _, parts in expected]
    assert_same(table, mapped)


rings = st.lists(points, min_size=4, max_size=8)
polygons = st.lists(st.lists(rings, min_size=1, max_size=3), min_size=1, max_size=3)


@settings(max_examples=80, deadline=None)
@given(st.lists(polygons, max_size=5))
def test_polygons_survive_the_round_trip(features: Any) -> None:
    shapes = [MultiPolygon([Polygon(rings[0], rings[1:]) for rings in parts]) for parts in features]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DecalWarning)
        table = read(np.array([*shapes, None], dtype=object)[:-1])
        mapped = read([shapely.geometry.mapping(shape) for shape in shapes])
    assert_same(table, mapped)
    rings = [
        ring if ring[0] != ring[-1] else ring[:-1] for parts in features for part in parts for ring in part
    ]
    kept = [ring for ring in rings if len(set(ring)) >= 3]
    assert len(table.part_offsets) - 1 == len(kept)
    for ring, part in zip(kept, [part for feature in parts_of(table) for part in feature], strict=True):
        same = [list(point) for point in ring]
        assert part in (same, same[::-1]), "the same points, turned at most"


def test_null_and_empty_geometries_are_counted_in_one_warning() -> None:
    data = [DONUT, None, Polygon(), GeometryCollection(), Point(), np.nan, box(0, 0, 1, 1), MultiPolygon()]
    with pytest.warns(
        DecalWarning, match=r"6 of 8 features are not drawn.*2 null geometries, 4 empty"
    ) as caught:
        table = read(data)
    assert len(caught) == 1
    assert table.rows.tolist() == [0, 6]


def test_rings_without_area_are_counted() -> None:
    thin = Polygon([(0, 0), (1, 1), (0, 0), (1, 1), (0, 0)])
    partly = Polygon(DONUT.exterior, [[(1, 1), (1, 1), (1, 1), (1, 1)]])
    with pytest.warns(DecalWarning, match=r"1 of 3 features are not drawn.*2 rings of fewer than three"):
        table = read([thin, partly, box(0, 0, 1, 1)])
    assert table.rows.tolist() == [1, 2]
    assert [len(feature) for feature in parts_of(table)] == [1, 1]


def test_lines_without_points_are_counted_and_dots_kept() -> None:
    with pytest.warns(DecalWarning, match=r"1 of 2 features are not drawn.*1 lines without points"):
        table = read(([[5, 5]], [0, 0, 1]), "lines")
    assert parts_of(table) == [[[[5, 5]]]]


def test_layers_without_features_are_legal() -> None:
    data: Any
    for data in (
        [],
        geopandas.GeoSeries([], dtype="geometry"),
        {"type": "FeatureCollection", "features": []},
    ):
        table = read(data)
        assert len(table) == 0
        assert table.bounds is None
        assert table.sizes().shape == (0,)
    assert len(read((np.zeros((0, 2)), [0]), "lines")) == 0


def test_heights_of_points_are_dropped() -> None:
    assert_same(read([shapely.force_3d(DONUT, 7)]), read([DONUT]))
    assert_same(read(shapely.geometry.mapping(shapely.force_3d(DONUT, 7))), read([DONUT]))


def test_a_million_vertices_take_no_loop() -> None:
    angle = np.arange(1_000_000) * (2 * np.pi / 1_000_000)
    ring = np.column_stack([np.cos(angle), np.sin(angle)]) * 1000
    table = read([Polygon(ring)])
    assert len(table.coords) == 1_000_000
    assert table.sizes()[0] == pytest.approx(np.pi * 1e6)
