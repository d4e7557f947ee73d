"""Vector input of every kind: the same arrays from each, CRS rules, and what is refused or left out."""

from __future__ import annotations

import json
import logging
import struct
import warnings

import geopandas
import numpy as np
import pandas as pd
import pyarrow as pa
import pyproj
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import GeometryCollection, LineString, MultiLineString, MultiPolygon, Point, Polygon, box

from decalgl.errors import CrsError, DecalWarning, FileError, InputError
from decalgl.features import FeatureTable, read_features

DONUT = Polygon(box(0, 0, 10, 10).exterior, [box(2, 2, 4, 4).exterior, box(5, 5, 9, 9).exterior])
SHAPES = [DONUT, MultiPolygon([box(20, 0, 21, 1), DONUT]), box(30, 0, 40, 5)]
UTM = pyproj.CRS("EPSG:32604")


def read(data, kind="polygons", crs=None, own=None, **options):
    return read_features(data, kind, terrain_crs=crs, layer_name="parks", crs=own, **options)[0]


def parts_of(table):
    """For each feature the list of its parts, each a list of points."""
    points = np.split(table.coords, table.part_offsets[1:-1]) if len(table.part_offsets) > 1 else []
    ends = zip(table.feature_offsets[:-1], table.feature_offsets[1:], strict=True)
    return [[part.tolist() for part in points[start:end]] for start, end in ends]


def assert_same(first, second):
    assert first.kind == second.kind
    for name in ("coords", "part_offsets", "feature_offsets", "rows"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def test_rings_lose_their_closing_point_and_holes_turn_the_other_way():
    table = read(SHAPES)
    assert (len(table), len(table.part_offsets) - 1, len(table.coords)) == (3, 8, 32)
    np.testing.assert_array_equal(table.feature_offsets, [0, 3, 7, 8])
    np.testing.assert_allclose(table.sizes(), shapely.area(SHAPES))
    assert table.bounds == (0, 0, 40, 10)
    assert not table.coords.flags.writeable


def test_lines_keep_their_points():
    lines = [LineString([(0, 0), (3, 4)]), MultiLineString([[(0, 0), (1, 0)], [(5, 5), (5, 7), (5, 5)]])]
    lines += [shapely.LinearRing([(0, 0), (1, 0), (0, 1)]), LineString([(2, 2), (2, 2)])]
    table = read(lines, "lines")
    assert parts_of(table)[0] == [[[0, 0], [3, 4]]]
    assert parts_of(table)[1] == [[[0, 0], [1, 0]], [[5, 5], [5, 7], [5, 5]]]
    assert parts_of(table)[3] == [[[2, 2], [2, 2]]], "a line of no length draws a dot"
    np.testing.assert_allclose(table.sizes(), shapely.length(lines))


class Interface:
    """Something that is not shapely but has a __geo_interface__."""

    def __init__(self, value):
        self.__geo_interface__ = value


@pytest.fixture
def frame():
    return geopandas.GeoDataFrame({"kind": ["a", "b", "c"], "size": [1, 2, 3]}, geometry=SHAPES, crs=UTM)


FILES = ("gpkg", "fgb", "geojson", "parquet", "feather")


@pytest.mark.parametrize("suffix", FILES)
def test_files_give_the_arrays_and_columns_of_their_frame(frame, tmp_path, suffix):
    path = tmp_path / f"parks.{suffix}"
    if suffix in ("parquet", "feather"):
        getattr(frame, f"to_{suffix}")(path)
    else:
        frame.to_file(path, **({"SPATIAL_INDEX": "NO"} if suffix == "fgb" else {}))
    table, columns = read_features(path, "polygons", terrain_crs=UTM, layer_name="parks")
    assert_same(table, read(frame, crs=UTM))
    assert list(columns.names) == ["kind", "size"]
    assert columns.count == 3
    assert columns.column("kind").tolist() == ["a", "b", "c"]
    assert_same(read(str(path), crs=UTM), table)


def wkt_table(frame):
    fields = [pa.field("shape", pa.string(), metadata={b"ARROW:extension:name": b"geoarrow.wkt"})]
    return pa.table(
        [pa.array(shapely.to_wkt(frame.geometry.array, rounding_precision=-1))], schema=pa.schema(fields)
    )


@pytest.mark.parametrize(
    "convert",
    [
        lambda frame: frame.geometry,
        lambda frame: frame.geometry.array,
        lambda frame: np.asarray(frame.geometry.array),
        lambda frame: list(frame.geometry),
        lambda frame: pd.Series(list(frame.geometry)),
        lambda frame: frame.__geo_interface__,
        lambda frame: Interface(frame.__geo_interface__),
        lambda frame: [Interface(shapely.geometry.mapping(shape)) for shape in frame.geometry],
        lambda frame: json.loads(frame.to_json())["features"],
        lambda frame: pa.table(frame.to_arrow()),
        lambda frame: frame.to_arrow(),
        lambda frame: pa.table(frame.iloc[[0, 2]].to_arrow(geometry_encoding="geoarrow")),
        wkt_table,
    ],
    ids=[
        "series",
        "array",
        "numpy",
        "list",
        "pandas",
        "collection",
        "object",
        "objects",
        "features",
        "wkb",
        "stream",
        "geoarrow",
        "wkt",
    ],
)
def test_every_kind_of_data_gives_the_same_arrays(frame, convert):
    table = read(convert(frame), crs=UTM, own=UTM)
    drawn = frame if len(table) == 3 else frame.iloc[[0, 2]]
    assert_same(table, read(drawn, crs=UTM))


def test_single_geometries_and_features():
    for data in (
        DONUT,
        shapely.geometry.mapping(DONUT),
        {"type": "Feature", "geometry": DONUT, "properties": None},
    ):
        assert_same(read(data), read([DONUT]))


def test_properties_of_features_are_columns():
    features = [
        {
            "type": "Feature",
            "geometry": shapely.geometry.mapping(DONUT),
            "properties": {"kind": "a", "size": 3},
        },
        {"type": "Feature", "geometry": shapely.geometry.mapping(DONUT), "properties": {"kind": "b"}},
    ]
    _, columns = read_features(features, "polygons", terrain_crs=None, layer_name="parks")
    assert columns.names == ("kind", "size")
    assert columns.column("kind").tolist() == ["a", "b"]
    np.testing.assert_array_equal(columns.column("size"), [3, np.nan])


@pytest.mark.parametrize("wrap", [tuple, lambda pair: dict(zip(("coords", "offsets"), pair, strict=True))])
def test_plain_numpy(wrap):
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
def test_plain_numpy_that_does_not_fit_is_refused(coords, offsets):
    with pytest.raises(InputError, match="'parks'"):
        read((coords, offsets), "lines")


def test_tables_pass_through_and_follow_a_crs():
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
def test_tables_check_their_arrays(arrays):
    with pytest.raises(InputError):
        FeatureTable("lines", *arrays)


coordinate = st.integers(-50, 50).map(float)
points = st.tuples(coordinate, coordinate)
lines = st.lists(st.lists(points, min_size=2, max_size=6), min_size=1, max_size=3)


@settings(max_examples=80, deadline=None)
@given(st.lists(st.none() | lines, max_size=8))
def test_lines_survive_the_round_trip(features):
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
def test_polygons_survive_the_round_trip(features):
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


def test_null_and_empty_geometries_are_counted_in_one_warning():
    data = [DONUT, None, Polygon(), GeometryCollection(), Point(), np.nan, box(0, 0, 1, 1), MultiPolygon()]
    with pytest.warns(
        DecalWarning, match=r"6 of 8 features are not drawn.*2 null geometries, 4 empty"
    ) as caught:
        table = read(data)
    assert len(caught) == 1
    assert table.rows.tolist() == [0, 6]


def test_rings_without_area_are_counted():
    thin = Polygon([(0, 0), (1, 1), (0, 0), (1, 1), (0, 0)])
    partly = Polygon(DONUT.exterior, [[(1, 1), (1, 1), (1, 1), (1, 1)]])
    with pytest.warns(DecalWarning, match=r"1 of 3 features are not drawn.*2 rings of fewer than three"):
        table = read([thin, partly, box(0, 0, 1, 1)])
    assert table.rows.tolist() == [1, 2]
    assert [len(feature) for feature in parts_of(table)] == [1, 1]


def test_lines_without_points_are_counted_and_dots_kept():
    with pytest.warns(DecalWarning, match=r"1 of 2 features are not drawn.*1 lines without points"):
        table = read(([[5, 5]], [0, 0, 1]), "lines")
    assert parts_of(table) == [[[[5, 5]]]]


def test_layers_without_features_are_legal():
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


def test_heights_of_points_are_dropped():
    assert_same(read([shapely.force_3d(DONUT, 7)]), read([DONUT]))
    assert_same(read(shapely.geometry.mapping(shapely.force_3d(DONUT, 7))), read([DONUT]))


@pytest.mark.parametrize(
    ("data", "kind", "message"),
    [
        ([DONUT, Point(1, 1)], "polygons", "a Point at row 1.*gdf.buffer"),
        ([DONUT, None, LineString([(0, 0), (1, 1)])], "polygons", "LineString at row 2.*add_lines"),
        ([DONUT], "lines", "Polygon at row 0.*add_polygons"),
        ([GeometryCollection([DONUT])], "polygons", "GeometryCollection at row 0.*explode"),
        ([shapely.geometry.mapping(Point(0, 0))], "lines", "Point at row 0"),
        ([shapely.geometry.mapping(GeometryCollection([DONUT]))], "polygons", "GeometryCollection at row 0"),
        ({"type": "Blob", "coordinates": []}, "lines", "'Blob'"),
        ({"type": "LineString", "coordinates": [1, 2]}, "lines", "row 0.*nest 1 deep instead of 2"),
        ({"type": "LineString", "coordinates": [[0, 0], ["a", 1]]}, "lines", "row 0.*no pairs of numbers"),
        ({"type": "LineString", "coordinates": [[0], [1]]}, "lines", "row 0.*no pairs"),
        ({"type": "FeatureCollection", "features": 5}, "lines", "no list of 'features'"),
        (5, "lines", "cannot be made from a int"),
        (np.zeros((3, 2)), "lines", "an array of float64 alone.*coords, offsets"),
        ([DONUT, 3], "polygons", "a int at row 1"),
        (pa.table({"a": [1]}), "polygons", "no geometry column"),
        (pd.DataFrame({"a": [1]}), "polygons", "no geometry column"),
        (pa.chunked_array([[1, 2]]), "polygons", "no Arrow table|cannot be made"),
        (geopandas.GeoDataFrame({"a": [1]}), "polygons", "no active geometry"),
    ],
)
def test_what_cannot_be_drawn_is_refused(data, kind, message):
    with pytest.raises(InputError, match=message):
        read(data, kind)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_coordinates_that_are_no_numbers_name_their_feature(bad):
    good = [[0, 0], [1, 0], [1, 1]]
    with pytest.raises(InputError, match=r"'parks' has 1 points with NaN or infinite.*row 2"):
        read(([*good, *good, [0, bad], [5, 5]], [0, 3, 6, 8]), "lines")
    ring = {"type": "Polygon", "coordinates": [[[0, 0], [bad, 1], [3, 3]]]}
    with pytest.raises(InputError, match="row 1"):
        read([shapely.geometry.mapping(DONUT), ring])
    with np.errstate(invalid="ignore"):
        shapes = shapely.polygons([[(0, 0), (1, 1), (0, 3)], [(0, 0), (bad, 1), (3, 3)]])
    with pytest.raises(InputError, match="row 1"):
        read(shapes)


def test_coordinates_out_of_reach_are_refused():
    with pytest.raises(InputError, match=r"farther than 1e\+09 m.*row 1"):
        read(([[0, 0], [1, 1], [2e9, 0], [1, 1]], [0, 2, 4]), "lines")


def test_layers_in_another_crs_are_moved_with_one_log_line(frame, caplog):
    degrees = frame.set_geometry(frame.translate(5e5, 2.3e6)).set_crs(UTM).to_crs("EPSG:4326")
    with caplog.at_level(logging.INFO, logger="decalgl"):
        table = read(degrees, crs=UTM)
    assert [record.message for record in caplog.records] == [
        "layer 'parks': reprojected from EPSG:4326 to EPSG:32604"
    ]
    np.testing.assert_allclose(table.coords, read(frame.translate(5e5, 2.3e6), crs=UTM).coords, atol=1e-6)


def test_layers_in_the_same_crs_are_left_alone(frame, caplog):
    with caplog.at_level(logging.INFO, logger="decalgl"):
        assert_same(read(frame, crs=UTM), read(SHAPES))
    assert not caplog.records


@pytest.mark.parametrize(
    ("data", "terrain_crs", "own", "message"),
    [
        (SHAPES, UTM, None, r"'parks' has no CRS.*set_crs.*crs="),
        (SHAPES, None, UTM, "terrain has no CRS"),
        (geopandas.GeoSeries(SHAPES, crs=UTM), None, None, "terrain has no CRS"),
        (geopandas.GeoSeries(SHAPES, crs=UTM), UTM, "EPSG:4326", "Leave crs= out"),
        (SHAPES, UTM, "EPSG:0", "EPSG:0"),
        ([box(500, 100, 510, 110)], UTM, "EPSG:4326", "cannot show.*row 0"),
    ],
)
def test_crs_rules(data, terrain_crs, own, message):
    with pytest.raises(CrsError, match=message):
        read(data, crs=terrain_crs, own=own)


def test_old_geojson_names_its_crs(frame):
    collection = {
        **frame.__geo_interface__,
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32604"}},
    }
    assert_same(read(collection, crs=UTM), read(frame, crs=UTM))


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(FileError, match="There is no file"):
        read(tmp_path / "none.gpkg")
    broken = tmp_path / "broken.gpkg"
    broken.write_bytes(b"not a map")
    with pytest.raises(FileError, match="cannot be read as a vector layer"):
        read(broken)
    broken = tmp_path / "broken.parquet"
    broken.write_bytes(b"not a map")
    with pytest.raises(FileError, match="cut short or damaged"):
        read(broken)


def test_files_with_several_layers_ask_for_one(frame, tmp_path):
    path = tmp_path / "two.gpkg"
    frame.to_file(path, layer="parks")
    frame.iloc[:1].to_file(path, layer="lakes")
    with pytest.raises(InputError, match=r"2 layers.*'parks'.*'lakes'"):
        read(path, crs=UTM)
    assert len(read(path, crs=UTM, layer="lakes")) == 1
    with pytest.raises(InputError, match=r"no layer 'roads'.*parks, lakes"):
        read(path, crs=UTM, layer="roads")


def wkb_table(blobs):
    field = pa.field("shape", pa.binary(), metadata={b"ARROW:extension:name": b"geoarrow.wkb"})
    return pa.table([pa.array(blobs, pa.binary())], schema=pa.schema([field]))


def nested_wkb(kind, depth):
    return struct.pack("<BII", 1, kind, 1) * depth + struct.pack("<BIdd", 1, 1, 0, 0)


@pytest.mark.parametrize("kind", [4, 5, 6, 7])
def test_wkb_nested_without_end_never_reaches_a_parser(kind):
    with pytest.raises(InputError, match="row 1"):
        read(wkb_table([shapely.to_wkb(DONUT), nested_wkb(kind, 100_000)]))


@pytest.mark.parametrize(
    "blob", [b"", b"\x01", b"\x01\x03\x00\x00\x00\xff\xff\xff\xff", b"\x01\x63\x00\x00\x00"]
)
def test_damaged_wkb_names_its_row(blob):
    with pytest.raises(InputError, match="row 1"):
        read(wkb_table([shapely.to_wkb(DONUT), blob]))


def test_large_multi_geometries_pass_the_guard():
    many = MultiPolygon([Polygon(box(i, 0, i + 0.5, 1).exterior) for i in range(500)])
    for options in ({}, {"byte_order": 0}, {"flavor": "iso", "include_srid": False}):
        for shape in (many, shapely.force_3d(many, 5)):
            assert_same(read(wkb_table([shapely.to_wkb(shape, **options)])), read([many]))
    tagged = shapely.to_wkb(shapely.set_srid(many, 4326), include_srid=True)
    assert_same(read(wkb_table([tagged])), read([many]))
    line = MultiLineString([[(i, 0), (i, 1)] for i in range(500)])
    assert_same(read(wkb_table([shapely.to_wkb(line)]), "lines"), read([line], "lines"))


@pytest.mark.parametrize(
    "text", ["GEOMETRYCOLLECTION(" * 9 + ")" * 9, "MULTIPOLYGON" + "(" * 9, "COMPOUNDCURVE((0 0, 1 1))"]
)
def test_nested_wkt_is_refused(text):
    field = pa.field("shape", pa.string(), metadata={b"ARROW:extension:name": b"geoarrow.wkt"})
    with pytest.raises(InputError, match="row 0"):
        read(pa.table([pa.array([text])], schema=pa.schema([field])))


def test_objects_nested_without_end_are_refused():
    deep = {"type": "Point", "coordinates": [0, 0]}
    coordinates = [0.0, 0.0]
    for _ in range(100_000):
        deep = {"type": "GeometryCollection", "geometries": [deep]}
        coordinates = [coordinates]
    with pytest.raises(InputError, match="GeometryCollection at row 0"):
        read(deep)
    with pytest.raises(InputError, match="more than 4 deep"):
        read({"type": "Polygon", "coordinates": coordinates})
    with pytest.raises(InputError, match="row 0"):
        read({"type": "LineString", "coordinates": [[0, 0], coordinates]}, "lines")
    while isinstance(deep, dict):  # taken apart by hand: freeing it would recurse
        deep = deep.get("geometries", [None])[0]
    while isinstance(coordinates, list):
        coordinates = coordinates[0]


@pytest.mark.parametrize("prefix", ["", "\ufeff", "  "])
def test_json_files_nested_without_end_are_not_opened(tmp_path, prefix):
    path = tmp_path / "deep.geojson"
    start = '{"type":"GeometryCollection","geometries":['
    path.write_text(prefix + start * 100_000 + "]}" * 100_000, encoding="utf-8")
    with pytest.raises(FileError, match="nests brackets more than 128 deep"):
        read(path)


def test_brackets_in_texts_are_not_counted(frame, tmp_path):
    path = tmp_path / "texts.geojson"
    frame.assign(kind=['[{"' * 300, "\\", '\\"[']).to_file(path)
    assert len(read(path, crs=UTM)) == 3
    hidden = tmp_path / "hidden.geojson"
    hidden.write_text('{"a":"' + "]" * 500 + '","b":' + "[" * 200 + "]" * 200 + "}")
    with pytest.raises(FileError, match="128 deep"):
        read(hidden)


def test_a_million_vertices_take_no_loop():
    angle = np.arange(1_000_000) * (2 * np.pi / 1_000_000)
    ring = np.column_stack([np.cos(angle), np.sin(angle)]) * 1000
    table = read([Polygon(ring)])
    assert len(table.coords) == 1_000_000
    assert table.sizes()[0] == pytest.approx(np.pi * 1e6)
