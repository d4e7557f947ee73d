"""Vector input of every kind gives the same arrays and columns, on the scene's plane."""

from __future__ import annotations

import json
import logging
from typing import Any

import geopandas
import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import shapely
from shapely import box

from decalgl.errors import CrsError, FileError, InputError
from decalgl.features import read_features
from vector_data import DONUT, SHAPES, UTM, assert_same, parks, read


@pytest.fixture
def frame() -> Any:
    return parks()


class Interface:
    """Something that is not shapely but has a __geo_interface__."""

    def __init__(self, value: Any) -> None:
        self.__geo_interface__ = value


FILES = ("gpkg", "fgb", "geojson", "parquet", "feather")


@pytest.mark.parametrize("suffix", FILES)
def test_files_give_the_arrays_and_columns_of_their_frame(frame: Any, tmp_path: Any, suffix: Any) -> None:
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


def wkt_table(frame: Any) -> Any:
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
def test_every_kind_of_data_gives_the_same_arrays(frame: Any, convert: Any) -> None:
    table = read(convert(frame), crs=UTM, own=UTM)
    drawn = frame if len(table) == 3 else frame.iloc[[0, 2]]
    assert_same(table, read(drawn, crs=UTM))


def test_single_geometries_and_features() -> None:
    for data in (
        DONUT,
        shapely.geometry.mapping(DONUT),
        {"type": "Feature", "geometry": DONUT, "properties": None},
    ):
        assert_same(read(data), read([DONUT]))


def test_properties_of_features_are_columns() -> None:
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


def test_layers_in_another_crs_are_moved_with_one_log_line(frame: Any, caplog: Any) -> None:
    degrees = frame.set_geometry(frame.translate(5e5, 2.3e6)).set_crs(UTM).to_crs("EPSG:4326")
    with caplog.at_level(logging.INFO, logger="decalgl"):
        table = read(degrees, crs=UTM)
    assert [record.message for record in caplog.records] == [
        "layer 'parks': reprojected from EPSG:4326 to EPSG:32604"
    ]
    np.testing.assert_allclose(table.coords, read(frame.translate(5e5, 2.3e6), crs=UTM).coords, atol=1e-6)


def test_layers_in_the_same_crs_are_left_alone(frame: Any, caplog: Any) -> None:
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
def test_crs_rules(data: Any, terrain_crs: Any, own: Any, message: Any) -> None:
    with pytest.raises(CrsError, match=message):
        read(data, crs=terrain_crs, own=own)


def test_old_geojson_names_its_crs(frame: Any) -> None:
    collection = {
        **frame.__geo_interface__,
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32604"}},
    }
    assert_same(read(collection, crs=UTM), read(frame, crs=UTM))


def test_files_that_cannot_be_read(tmp_path: Any) -> None:
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


def test_files_with_several_layers_ask_for_one(frame: Any, tmp_path: Any) -> None:
    path = tmp_path / "two.gpkg"
    frame.to_file(path, layer="parks")
    frame.iloc[:1].to_file(path, layer="lakes")
    with pytest.raises(InputError, match=r"2 layers.*'parks'.*'lakes'"):
        read(path, crs=UTM)
    assert len(read(path, crs=UTM, layer="lakes")) == 1
    with pytest.raises(InputError, match=r"no layer 'roads'.*parks, lakes"):
        read(path, crs=UTM, layer="roads")
