"""Vector input that cannot be drawn, or that would harm a parser, is refused by name."""

from __future__ import annotations

import struct
from typing import Any

import geopandas
import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import shapely
from shapely import GeometryCollection, LineString, MultiLineString, MultiPolygon, Point, Polygon, box

from decalgl.errors import FileError, InputError
from vector_data import DONUT, UTM, assert_same, parks, read


@pytest.fixture
def frame() -> Any:
    return parks()


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
def test_what_cannot_be_drawn_is_refused(data: Any, kind: Any, message: Any) -> None:
    with pytest.raises(InputError, match=message):
        read(data, kind)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_coordinates_that_are_no_numbers_name_their_feature(bad: Any) -> None:
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


def test_coordinates_out_of_reach_are_refused() -> None:
    with pytest.raises(InputError, match=r"farther than 1e\+09 m.*row 1"):
        read(([[0, 0], [1, 1], [2e9, 0], [1, 1]], [0, 2, 4]), "lines")


def wkb_table(blobs: Any) -> Any:
    field = pa.field("shape", pa.binary(), metadata={b"ARROW:extension:name": b"geoarrow.wkb"})
    return pa.table([pa.array(blobs, pa.binary())], schema=pa.schema([field]))


def nested_wkb(kind: Any, depth: Any) -> Any:
    return struct.pack("<BII", 1, kind, 1) * depth + struct.pack("<BIdd", 1, 1, 0, 0)


@pytest.mark.parametrize("kind", [4, 5, 6, 7])
def test_wkb_nested_without_end_never_reaches_a_parser(kind: Any) -> None:
    with pytest.raises(InputError, match="row 1"):
        read(wkb_table([shapely.to_wkb(DONUT), nested_wkb(kind, 100_000)]))


@pytest.mark.parametrize(
    "blob", [b"", b"\x01", b"\x01\x03\x00\x00\x00\xff\xff\xff\xff", b"\x01\x63\x00\x00\x00"]
)
def test_damaged_wkb_names_its_row(blob: Any) -> None:
    with pytest.raises(InputError, match="row 1"):
        read(wkb_table([shapely.to_wkb(DONUT), blob]))


def test_large_multi_geometries_pass_the_guard() -> None:
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
def test_nested_wkt_is_refused(text: Any) -> None:
    field = pa.field("shape", pa.string(), metadata={b"ARROW:extension:name": b"geoarrow.wkt"})
    with pytest.raises(InputError, match="row 0"):
        read(pa.table([pa.array([text])], schema=pa.schema([field])))


def test_objects_nested_without_end_are_refused() -> None:
    deep: Any = {"type": "Point", "coordinates": [0, 0]}
    coordinates: Any = [0.0, 0.0]
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
def test_json_files_nested_without_end_are_not_opened(tmp_path: Any, prefix: Any) -> None:
    path = tmp_path / "deep.geojson"
    start = '{"type":"GeometryCollection","geometries":['
    path.write_text(prefix + start * 100_000 + "]}" * 100_000, encoding="utf-8")
    with pytest.raises(FileError, match="nests brackets more than 128 deep"):
        read(path)


def test_brackets_in_texts_are_not_counted(frame: Any, tmp_path: Any) -> None:
    path = tmp_path / "texts.geojson"
    frame.assign(kind=['[{"' * 300, "\\", '\\"[']).to_file(path)
    assert len(read(path, crs=UTM)) == 3
    hidden = tmp_path / "hidden.geojson"
    hidden.write_text('{"a":"' + "]" * 500 + '","b":' + "[" * 200 + "]" * 200 + "}")
    with pytest.raises(FileError, match="128 deep"):
        read(hidden)
