"""Scenes: layers with their styles and order, and bad input, which names what is wrong and leaves a scene usable."""

from __future__ import annotations

import json
import warnings
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import geopandas
import numpy as np
import pytest
import shapely
from shapely import GeometryCollection, LineString, Point, Polygon, box

import decalgl as dg
from small_scenes import (
    BLUE,
    DIAGONAL,
    GREEN,
    MAP,
    RED,
    assert_usable,
    count_color,
    draw,
    flat_scene,
    hilly_scene,
    pixel,
)

if TYPE_CHECKING:
    from pathlib import Path

UTM = "EPSG:32604"
NAN, INF = float("nan"), float("inf")


def squares(*places: tuple[float, float, float]) -> list[Any]:
    """Squares (x, y, side)."""
    return [box(x, y, x + side, y + side) for x, y, side in places]


def test_layers_are_numbered_and_named() -> None:
    scene = flat_scene()
    first = scene.add_polygons(squares((0, 0, 10)))
    second = scene.add_lines([DIAGONAL], width=3, width_units="m", name="road")
    assert scene.layers == (first, second)
    assert [(layer.name, layer.index, layer.kind) for layer in scene.layers] == [
        ("polygons 0", 0, "polygons"),
        ("road", 1, "lines"),
    ]
    assert first.colors.tolist() == [[31, 119, 180, 255]]
    assert second.widths.tolist() == [3.0]
    assert "road" in repr(scene)
    for array in (first.colors, second.widths, first.draw_order, first.features.coords):
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0


def test_colors_by_column_and_by_row() -> None:
    parts = squares((10, 10, 20), (40, 10, 20), (70, 10, 20))
    frame = geopandas.GeoDataFrame({"kind": ["a", "b", "a"]}, geometry=parts)
    scene = flat_scene()
    scene.add_polygons(frame, column="kind", cmap={"a": "#ff0000", "b": "#00ff00"})
    scene.add_polygons(squares((10, 50, 20), (40, 50, 20)), color=["blue", "none"])
    picture = draw(scene)
    assert (count_color(picture, RED), count_color(picture, GREEN)) == (800, 400)
    assert count_color(picture, BLUE) == 400
    assert pixel(picture, 50, 60)[3] == 255, "the ground, not a hole"


def test_widths_come_from_numbers_rows_and_columns() -> None:
    lines = [LineString([(10, y), (90, y)]) for y in (20, 50, 80)]
    frame = geopandas.GeoDataFrame({"metres": [2, 6, 10]}, geometry=lines)
    for width in (np.array([2, 6, 10]), "metres"):
        scene = flat_scene()
        scene.add_lines(frame, width=width, width_units="m", color="#0000ff")
        column = draw(scene).image[:, 50]
        assert (column == np.array(BLUE)).all(axis=1).sum() == 18


@pytest.mark.parametrize(
    ("order", "top"),
    [
        ("feature", BLUE),
        ("size", RED),
        ("rank", GREEN),
        (np.array([2, 3, 1]), GREEN),
        ([NAN, 0, NAN], GREEN),
    ],
)
def test_order_inside_a_layer(order: Any, top: tuple[int, ...]) -> None:
    parts = squares((10, 10, 80), (20, 20, 60), (30, 30, 40))
    frame = geopandas.GeoDataFrame({"rank": [1, 2, 0]}, geometry=parts)
    scene = flat_scene()
    layer = scene.add_polygons(frame, color=["#ff0000", "#00ff00", "#0000ff"], order=order)
    assert sorted(layer.draw_order.tolist()) == [0, 1, 2]
    assert pixel(draw(scene), 50, 50) == top


def test_longer_lines_lie_on_top_by_size() -> None:
    lines = [LineString([(0, 50), (100, 50)]), LineString([(50, 20), (50, 80)])]
    scene = flat_scene()
    scene.add_lines(lines, color=["red", "blue"], width=8, width_units="m", order="size")
    assert pixel(draw(scene), 50, 50) == RED


def test_later_layers_lie_on_top_and_let_lower_ones_through() -> None:
    scene = flat_scene()
    scene.add_polygons(squares((0, 0, 100)), color="red")
    scene.add_polygons(squares((20, 20, 60)), color="blue", alpha=0.5)
    red, green, blue, alpha = pixel(draw(scene), 50, 50)
    assert (green, alpha) == (0, 255)
    assert red == pytest.approx(127, abs=1)
    assert blue == pytest.approx(128, abs=1)


def test_features_of_alpha_0_are_not_there() -> None:
    scene = flat_scene()
    scene.add_polygons(squares((0, 0, 100), (20, 20, 60)), color=["red", "red"], alpha=[1.0, 0.0])
    picture = draw(scene)
    assert set(np.unique(picture.ids)) == {0}
    assert [found.row for found in picture.pick(50, 50)] == [0]


def test_home_shows_the_whole_terrain() -> None:
    scene = hilly_scene(exaggeration=3.0)
    west, south, east, north = scene.terrain.bounds
    corners = [(x, y, 0.0) for x in (west, east) for y in (south, north)]
    positions, depth = scene.home().project(corners, (160, 90))
    assert (depth > 0).all()
    assert ((positions > 0) & (positions < (160, 90))).all()
    assert np.isfinite(draw(scene, scene.home()).depth).any()


def test_exaggeration_lifts_the_ground() -> None:
    low, high = hilly_scene(), hilly_scene(exaggeration=3.0)
    assert np.nanmax(high.heights) == pytest.approx(60.0, abs=0.01)
    assert np.nanmax(draw(high).world[..., 2]) == pytest.approx(
        3 * np.nanmax(draw(low).world[..., 2]), abs=0.01
    )


def test_relief_may_change_between_pictures() -> None:
    scene = hilly_scene(relief=dg.Relief(color="white", strength=0.0))
    assert count_color(draw(scene), (255, 255, 255, 255)) == 100 * 100
    scene.relief = dg.Relief(color=np.array([0.0, 0.0, 1.0]), strength=0.0)
    assert count_color(draw(scene), BLUE) == 100 * 100
    scene.relief = dg.Relief(cmap="Greys", strength=0.0)
    assert len(np.unique(draw(scene).image)) > 20
    shaded = dg.Relief(strength=1.0, on_layers=1.0)
    scene.relief = shaded
    scene.add_polygons(squares((0, 0, 100)), color="red")
    assert len(np.unique(draw(scene).image[..., 0])) > 5, "layers take the shading on"


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"color": "no colour"}, dg.StyleError, "no known colour"),
        ({"cmap": "Gryes"}, dg.StyleError, "Did you mean 'Greys'"),
        ({"altitude": 0}, dg.InputError, "altitude"),
        ({"altitude": NAN}, dg.InputError, "altitude"),
        ({"azimuth": "north"}, dg.InputError, "azimuth"),
        ({"strength": -1}, dg.InputError, "strength"),
        ({"on_layers": 2}, dg.InputError, "on_layers"),
        ({"vmin": INF}, dg.InputError, "vmin"),
        ({"vmin": 5, "vmax": 5}, dg.InputError, "vmin must lie below vmax"),
    ],
)
def test_reliefs_check_themselves(options: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        dg.Relief(**options)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: dg.Scene(None), "needs a Terrain.*Terrain.open"),  # type: ignore[arg-type]
        (lambda: flat_scene(exaggeration=-1), "exaggeration"),
        (lambda: flat_scene(exaggeration=NAN), "exaggeration"),
        (lambda: flat_scene(exaggeration="much"), "exaggeration must be a number"),
        (lambda: hilly_scene(exaggeration=1e30), "lower the exaggeration"),
        (lambda: flat_scene(relief="white"), "relief must be a Relief"),
        (lambda: dg.Scene(dg.Terrain(np.full((3, 3), NAN, np.float32), 0, 0, 1, 1)), "no finite height"),
        (lambda: dg.Scene(dg.Terrain(np.full((3, 3), -3.4e38, np.float32), 0, 0, 1, 1)), "nodata="),
        (lambda: dg.Scene(dg.Terrain(np.zeros((3, 3), np.float32), 1e12, 0, 1, 1)), "transform"),
    ],
)
def test_scenes_check_their_terrain(make: Any, message: str) -> None:
    with pytest.raises(dg.InputError, match=message):
        make()


@pytest.mark.parametrize(
    ("data", "options", "error", "message"),
    [
        ([box(0, 0, 1, 1), Point(1, 1)], {}, dg.InputError, "'parks' .*Point at row 1.*buffer"),
        ([GeometryCollection([box(0, 0, 1, 1)])], {}, dg.InputError, "'parks'.*row 0.*explode"),
        ([DIAGONAL], {}, dg.InputError, "'parks'.*add_lines"),
        ("absent.gpkg", {}, dg.FileError, "absent.gpkg.*'parks'.*Check the path"),
        (42, {}, dg.InputError, "'parks' cannot be made from a int"),
        (squares((0, 0, 1)), {"color": "crimsn"}, dg.StyleError, "'parks'.*Did you mean 'crimson'"),
        (squares((0, 0, 1)), {"color": ["red", "blue"]}, dg.StyleError, "'parks'.*2 colours.*1 rows"),
        (squares((0, 0, 1)), {"color": [(2, 0, 0)]}, dg.StyleError, "'parks'.*row 0.*255"),
        (squares((0, 0, 1)), {"column": "kind"}, dg.ColumnError, "'parks' has no column 'kind'"),
        (squares((0, 0, 1)), {"column": [1], "cmap": "Gren"}, dg.StyleError, "'parks'.*Did you mean"),
        (squares((0, 0, 1)), {"alpha": 1.5}, dg.StyleError, "'parks'.*alpha"),
        (squares((0, 0, 1)), {"order": "rank"}, dg.ColumnError, "'parks' has no column 'rank'"),
        (squares((0, 0, 1)), {"order": [1, 2]}, dg.InputError, "order of layer 'parks'.*1 rows"),
        (squares((0, 0, 1)), {"technique": "draped"}, dg.StyleError, "'parks'.*'static'"),
        (squares((0, 0, 1)), {"technique": "statik"}, dg.StyleError, "Did you mean 'static'"),
        (squares((0, 0, 1)), {"crs": UTM}, dg.CrsError, "'parks'.*terrain has no CRS"),
        ((np.array([[0, 0], [NAN, 1], [1, 1]]), [0, 3]), {}, dg.InputError, "'parks'.*NaN.*row 0"),
        ((np.array([[0, 0], [INF, 1], [1, 1]]), [0, 3]), {}, dg.InputError, "'parks'.*infinite.*row 0"),
        ((np.array([[0, 0], [1e300, 1], [1, 1]]), [0, 3]), {}, dg.InputError, "'parks'.*row 0.*CRS"),
    ],
)
def test_bad_layers_name_what_is_wrong(data: Any, options: Any, error: type[Exception], message: str) -> None:
    scene = flat_scene()
    with pytest.raises(error, match=message):
        scene.add_polygons(data, name="parks", **options)
    assert scene.layers == ()
    assert_usable(scene)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"technique": "static"}, dg.UnsupportedError, "'roads'.*on the screen.*default.*width_units='m'"),
        ({"width": 2, "width_units": "ft"}, dg.StyleError, "'roads'.*'m' or 'px'"),
        ({"width": 0, "width_units": "m"}, dg.StyleError, "'roads', row 0: width 0 is not a positive"),
        ({"width": -3, "width_units": "m"}, dg.StyleError, "'roads', row 0: width -3 "),
        ({"width": [1, -3], "width_units": "m"}, dg.StyleError, "'roads', row 1: width -3 "),
        ({"width": [1, NAN], "width_units": "m"}, dg.StyleError, "'roads', row 1: width nan"),
        ({"width": INF, "width_units": "m"}, dg.StyleError, "'roads', row 0: width inf is wider than"),
        ({"width": 1e9, "width_units": "m"}, dg.StyleError, "'roads', row 0: width 1e"),
        ({"width": [1, 2, 3], "width_units": "m"}, dg.InputError, "'roads'.*2 rows"),
        ({"width": "breadth", "width_units": "m"}, dg.ColumnError, "'roads' has no column 'breadth'"),
        ({"width": None, "width_units": "m"}, dg.StyleError, "'roads'"),
        ({"width_units": "m", "corner": "mitre"}, dg.StyleError, "Did you mean 'miter'"),
    ],
)
def test_bad_line_styles_name_what_is_wrong(options: Any, error: type[Exception], message: str) -> None:
    scene = flat_scene()
    with pytest.raises(error, match=message):
        scene.add_lines([DIAGONAL, DIAGONAL], name="roads", **options)
    assert_usable(scene)


def test_layers_without_crs_on_a_terrain_with_one() -> None:
    scene = flat_scene(crs=UTM)
    with pytest.raises(dg.CrsError, match=r"'parks' has no CRS.*EPSG:32604.*crs='EPSG:4326'"):
        scene.add_polygons(squares((0, 0, 1)), name="parks")
    with pytest.raises(dg.CrsError, match="EPSG:99999"):
        scene.add_polygons(squares((0, 0, 1)), crs="EPSG:99999")
    assert_usable(scene)


def test_what_is_left_out_is_counted_where_it_was_called() -> None:
    scene = flat_scene()
    thin = Polygon([(0, 0), (1, 1), (0, 0), (1, 1)])
    data = [None, Polygon(), *squares((10, 10, 20)), thin]
    with pytest.warns(dg.DecalWarning, match=r"'parks': 3 of 4 features.*1 null.*1 empty.*1 rings") as caught:
        layer = scene.add_polygons(data, name="parks", color=["red", "red", "blue", "red"])
    assert [warning.filename for warning in caught] == [__file__]
    assert layer.features.rows.tolist() == [2]
    picture = draw(scene)
    assert count_color(picture, BLUE) == 400
    assert set(np.unique(picture.ids)) == {-1, 2}


def test_layers_without_features_draw_nothing() -> None:
    scene = flat_scene()
    empty = draw(scene).image
    scene.add_polygons([])
    scene.add_lines([], width=1, width_units="m")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", dg.DecalWarning)
        scene.add_lines([None], width=1, width_units="m")
    picture = draw(scene)
    assert (picture.image == empty).all()
    assert (picture.ids == -1).all()
    assert (picture.layers == -1).all()
    assert picture.pick(50, 50) == []
    assert_usable(scene)


def test_arrays_may_change_after_they_were_given() -> None:
    coords = shapely.get_coordinates(box(20, 20, 60, 60))[:-1]
    scene = flat_scene()
    scene.add_polygons((coords, [0, 4]), color="red")
    coords[:] = NAN
    assert count_color(draw(scene), RED) == 1600


def test_files_nested_without_end_are_refused(tmp_path: Path) -> None:
    import gzip

    start = '{"type":"GeometryCollection","geometries":['
    deep = (start * 100_000 + "]}" * 100_000).encode()
    plain, packed = tmp_path / "deep.geojson", tmp_path / "deep.geojson.gz"
    plain.write_bytes(deep)
    packed.write_bytes(gzip.compress(deep))
    scene = flat_scene()
    for path in (plain, packed, f"/vsigzip/{packed}"):
        with pytest.raises(dg.FileError, match="more than 128 deep"):
            scene.add_polygons(path, crs=None)
    assert_usable(scene)


def test_packed_files_are_read_like_others(tmp_path: Path) -> None:
    import gzip

    square = json.dumps(shapely.geometry.mapping(box(20, 20, 60, 60))).encode()
    path = tmp_path / "square.geojson.gz"
    path.write_bytes(gzip.compress(square))
    scene = flat_scene(crs="EPSG:3857")
    layer = scene.add_polygons(path)  # GeoJSON is in degrees unless it says otherwise
    assert len(layer.features) == 1
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["square.geojson.gz"]
    path.write_bytes(gzip.compress(square)[:-12])
    with pytest.raises(dg.FileError, match="cut short or damaged"):
        scene.add_polygons(path)
    path.write_bytes(square)
    with pytest.raises(dg.FileError, match="cannot be unpacked"):
        scene.add_polygons(path)


def test_packed_rasters_are_read_like_others(tmp_path: Path) -> None:
    import gzip

    import rasterio

    heights = np.arange(12, dtype=np.float32).reshape(3, 4)
    plain, packed = tmp_path / "dem.tif", tmp_path / "dem.tif.gz"
    place = rasterio.transform.from_origin(0, 0, 30, 30)
    profile = {"driver": "GTiff", "width": 4, "height": 3, "count": 1, "dtype": "float32", "transform": place}
    with rasterio.open(plain, "w", **profile) as raster:
        raster.write(heights, 1)
    packed.write_bytes(gzip.compress(plain.read_bytes()))
    np.testing.assert_array_equal(dg.Terrain.open(packed).z, heights)
    with pytest.raises(dg.FileError, match=r"There is no file .*absent\.tif\.gz"):
        dg.Terrain.open(tmp_path / "absent.tif.gz")


def test_bombs_are_not_unpacked_to_the_end(tmp_path: Path) -> None:
    import gzip

    bomb = tmp_path / "bomb.geojson.gz"
    bomb.write_bytes(
        gzip.compress(b'{"type": "FeatureCollection", "features": []' + b" " * (80 << 20) + b"}")
    )
    scene = flat_scene()
    with pytest.raises(dg.FileError, match=r"bomb.* unpacks to more than 64 MiB.*gunzip"):
        scene.add_polygons(bomb)


def test_rasters_that_declare_too_much(tmp_path: Path) -> None:
    import rasterio

    path = tmp_path / "huge.tif"
    profile = {"driver": "GTiff", "width": 48_000, "height": 48_000, "count": 1, "dtype": "float32"}
    with rasterio.open(
        path, "w", **profile, sparse_ok=True, tiled=True, blockxsize=512, blockysize=512,
        crs=UTM, transform=rasterio.transform.from_origin(0, 0, 30, 30),
    ):  # fmt: skip
        pass
    assert path.stat().st_size < 150_000
    with pytest.raises(dg.MemoryLimitError, match=r"huge\.tif.*48000 x 48000.*window="):
        dg.Terrain.open(path)


def test_lines_of_any_width_up_to_the_limit_are_drawn() -> None:
    for width in (1e-9, 1e-3, 1e3, 1e6):
        scene = flat_scene()
        scene.add_lines([DIAGONAL], width=width, width_units="m", color="red")
        # A lattice that reaches so far is coarser than pixels.
        with pytest.warns(dg.DecalWarning, match="pixels off") if width == 1e6 else nullcontext():
            picture = scene.render(MAP, (64, 64), antialias="none")
        covered = int((picture.ids == 0).sum())
        assert covered == (64 * 64 if width >= 1e3 else 64)
