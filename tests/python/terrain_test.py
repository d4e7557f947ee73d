"""Terrains from files, arrays and bounds: where samples lie, how others are warped, what is refused."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pyproj
import pytest
import rasterio
from affine import Affine
from hypothesis import given, settings
from hypothesis import strategies as st
from rasterio.windows import Window

from decalgl import _raster
from decalgl.errors import CrsError, DecalWarning, FileError, InputError, MemoryLimitError
from decalgl.terrain import Terrain

UTM = "EPSG:32604"
METRES = Affine(10, 0, 1000, 0, -20, 5000)
RAMP = np.arange(12, dtype=np.float32).reshape(3, 4)


def write(path: Any, bands: Any, transform: Any = METRES, crs: Any = UTM, **profile: Any) -> Any:
    bands = np.asarray(bands)
    bands = bands[None] if bands.ndim == 2 else bands
    tags = {name: profile.pop(name) for name in ("scales", "offsets", "units") if name in profile}
    count, height, width = bands.shape
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        options = {"driver": "GTiff", "dtype": bands.dtype, "transform": transform, "crs": crs, **profile}
        with rasterio.open(path, "w", count=count, height=height, width=width, **options) as dataset:
            dataset.write(bands)
            for name, value in tags.items():
                setattr(dataset, name, value)
    return path


def positions(terrain: Any) -> Any:
    rows, columns = np.indices(terrain.shape)
    return terrain.x0 + columns * terrain.dx, terrain.y0 - rows * terrain.dy


def test_samples_lie_in_the_middle_of_cells(tmp_path: Any) -> None:
    for terrain in (Terrain.open(write(tmp_path / "a.tif", RAMP)), Terrain.from_array(RAMP, METRES, UTM)):
        assert (terrain.x0, terrain.y0, terrain.dx, terrain.dy) == (1005, 4990, 10, 20)
        assert terrain.bounds == (1005.0, 4950.0, 1035.0, 4990.0)
        assert terrain.shape == (3, 4)
        assert terrain.crs == pyproj.CRS(UTM)
        np.testing.assert_array_equal(terrain.z, RAMP)
        assert terrain.z.dtype == np.float32
        assert not terrain.z.flags.writeable
        assert "3 x 4 samples" in repr(terrain)


@settings(max_examples=30, deadline=None)
@given(st.sampled_from([-3.0, 3.0]), st.sampled_from([-5.0, 5.0]), st.integers(1, 4), st.integers(1, 4))
def test_any_orientation_starts_in_the_north_west(step_x: Any, step_y: Any, rows: Any, columns: Any) -> None:
    z = np.arange(rows * columns, dtype=float).reshape(rows, columns)
    transform = Affine(step_x, 0, 100, 0, step_y, 200)
    terrain = Terrain.from_array(z, transform)
    assert terrain.dx == 3
    assert terrain.dy == 5
    placed = {
        (x, y): height
        for x, y, height in zip(*map(np.ravel, positions(terrain)), terrain.z.ravel(), strict=True)
    }
    for row in range(rows):
        for column in range(columns):
            assert placed[transform @ (column + 0.5, row + 0.5)] == z[row, column]


def test_six_numbers_are_a_transform() -> None:
    assert Terrain.from_array(RAMP, tuple(METRES)[:6]).bounds == Terrain.from_array(RAMP, METRES).bounds


def test_the_callers_array_is_neither_changed_nor_shared() -> None:
    z = np.array([[1.0, -9999.0]], dtype=np.float32)
    terrain = Terrain.from_array(z, METRES, nodata=-9999)
    z[0, 0] = 7
    assert z[0, 1] == -9999
    assert terrain.z[0, 0] == 1
    assert np.isnan(terrain.z[0, 1])


def test_holes_of_arrays() -> None:
    assert np.isnan(Terrain.from_array(np.ma.masked_equal(RAMP, 3), METRES).z[0, 3])
    assert np.isnan(Terrain.from_array(RAMP.astype(np.int16), METRES, nodata=5).z[1, 1])
    assert Terrain.from_array(RAMP, METRES).z[0, 3] == 3
    assert np.isnan(Terrain.from_array(np.where(RAMP == 2, np.nan, RAMP), METRES).z[0, 2])


def test_holes_scale_offset_and_units_of_files(tmp_path: Any) -> None:
    whole = RAMP.astype(np.int16)
    terrain = Terrain.open(write(tmp_path / "a.tif", whole, nodata=4, scales=[0.5], offsets=[100.0]))
    assert np.isnan(terrain.z[1, 0])
    np.testing.assert_array_equal(terrain.z[0], [100, 100.5, 101, 101.5])
    feet = Terrain.open(write(tmp_path / "b.tif", whole, units=["ft"]))
    np.testing.assert_allclose(feet.z, RAMP * 0.3048, rtol=1e-6)
    other = Terrain.open(write(tmp_path / "c.tif", whole, nodata=4), nodata=0)
    assert np.isnan(other.z[0, 0])
    assert other.z[1, 0] == 4


@pytest.mark.parametrize("dtype", ["uint8", "int16", "uint16", "int32", "float32", "float64"])
def test_sample_types(tmp_path: Any, dtype: Any) -> None:
    np.testing.assert_array_equal(Terrain.open(write(tmp_path / "a.tif", RAMP.astype(dtype))).z, RAMP)


def test_bands_and_windows(tmp_path: Any) -> None:
    path = write(tmp_path / "a.tif", np.stack([RAMP, RAMP * 2]))
    np.testing.assert_array_equal(Terrain.open(path, band=2).z, RAMP * 2)
    for window in ((1, 1, 2, 2), Window(1, 1, 2, 2)):
        part = Terrain.open(path, window=window)
        np.testing.assert_array_equal(part.z, RAMP[1:3, 1:3])
        assert (part.x0, part.y0) == (1015, 4970)
    for window in ((3, 0, 2, 2), (0, 0, 0, 1), (-1, 0, 2, 2)):
        with pytest.raises(InputError, match="does not lie inside"):
            Terrain.open(path, window=window)
    with pytest.raises(InputError, match="must be"):
        Terrain.open(path, window=5)
    with pytest.raises(InputError, match=r"no band 3.*1 to 2"):
        Terrain.open(path, band=3)


def test_other_formats(tmp_path: Any) -> None:
    square = Affine(10, 0, 1000, 0, -10, 5000)
    path = write(tmp_path / "a.asc", RAMP, transform=square, crs=None, driver="AAIGrid")
    np.testing.assert_array_equal(Terrain.open(path, crs=UTM).z, RAMP)


def test_files_without_a_place_say_so(tmp_path: Any) -> None:
    path = write(tmp_path / "a.tif", RAMP, transform=Affine.identity(), crs=None)
    with pytest.warns(DecalWarning, match="no georeference"):
        terrain = Terrain.open(path)
    np.testing.assert_array_equal(terrain.z, RAMP)
    assert terrain.bounds == (0.5, 0.5, 3.5, 2.5)


# Warping


def exact(function: Any, terrain: Any, source: Any) -> Any:
    """Heights of `function` of source coordinates at the terrain's samples."""
    back = pyproj.Transformer.from_crs(terrain.crs, source, always_xy=True)
    return function(*back.transform(*positions(terrain)))


@pytest.mark.parametrize(
    ("longitude", "latitude"), [(-157.9, 21.4), (179.999, -17.0), (-21.5, 64.6), (30, 89.0), (0, 0)]
)
def test_degrees_are_warped_to_a_metric_plane_around_the_centre(longitude: Any, latitude: Any) -> Any:
    step = 1 / 1200
    transform = Affine(step, 0, longitude - 60.5 * step, 0, -step, latitude + 40.5 * step)
    rows, columns = np.mgrid[0:81, 0:121]
    plane = 100 + 2.0 * columns + 3.0 * rows
    terrain = Terrain.from_array(plane, transform, "EPSG:4326")
    x, y = positions(terrain)
    assert abs(x.mean()) < 20
    assert abs(y.mean()) < 200
    ground = pyproj.Geod(ellps="WGS84")
    step_x = ground.inv(longitude - step / 2, latitude, longitude + step / 2, latitude)[2]
    step_y = ground.inv(longitude, latitude - step / 2, longitude, latitude + step / 2)[2]
    assert terrain.dx == pytest.approx(step_x, rel=0.02)
    assert terrain.dy == pytest.approx(step_y, rel=0.02)

    def height(lon: Any, lat: Any) -> Any:
        lon = longitude + (lon - longitude + 180) % 360 - 180
        return 100 + 2.0 * ((lon - longitude) / step + 60) + 3.0 * ((latitude - lat) / step + 40)

    expected = exact(height, terrain, "EPSG:4326")
    inside = ~np.isnan(terrain.z)
    assert inside.mean() > 0.9
    np.testing.assert_allclose(terrain.z[inside], expected[inside], atol=0.01)


def test_the_local_plane_is_rounded_to_a_ten_thousandth_of_a_degree() -> None:
    terrain = Terrain.flat((-157.99999, 21.2, -157.84444, 21.33333), "EPSG:4326")
    assert terrain.crs is not None
    assert "+proj=tmerc +lat_0=21.2667 +lon_0=-157.9222 " in terrain.crs.to_string() + " "


@pytest.mark.parametrize("start", [-180.0, 0.0, 170.0])
def test_poles_and_whole_turns(start: Any) -> None:
    step = 1.0
    transform = Affine(step, 0, start, 0, -step, 90)
    rows, _ = np.mgrid[0:8, 0:360]
    terrain = Terrain.from_array(rows * 10.0, transform, "EPSG:4326")
    expected = exact(lambda _, lat: (90 - lat - 0.5) * 10, terrain, "EPSG:4326")
    x, y = positions(terrain)
    _, latitude = pyproj.Transformer.from_crs(terrain.crs, 4326, always_xy=True).transform(x, y)
    inside = ~np.isnan(terrain.z)
    np.testing.assert_allclose(terrain.z[inside], expected[inside], atol=0.01)
    assert inside[(latitude < 89.4) & (latitude > 82.6)].all(), "no seam where the turn closes"


def test_holes_stay_holes() -> None:
    z = np.zeros((40, 40))
    z[20, 20] = np.nan
    step = 1 / 3600
    terrain = Terrain.from_array(z, Affine(step, 0, 10, 0, -step, 50), "EPSG:4326")
    columns, rows = pyproj.Transformer.from_crs(terrain.crs, 4326, always_xy=True).transform(
        *positions(terrain)
    )
    columns, rows = (columns - 10) / step - 0.5, (50 - rows) / step - 0.5
    beside = (abs(columns - 20) < 0.99) & (abs(rows - 20) < 0.99)
    assert beside.any()
    assert np.isnan(terrain.z[beside]).all()


def test_feet_become_metres() -> None:
    foot = 1200 / 3937
    terrain = Terrain.from_array(np.zeros((30, 50)), Affine(100, 0, 980_000, 0, -100, 200_000), "EPSG:2263")
    assert terrain.dx == pytest.approx(100 * foot, rel=1e-3)
    assert terrain.bounds[2] - terrain.bounds[0] == pytest.approx(4900 * foot, rel=2e-2)


def test_a_crs_can_be_asked_for(tmp_path: Any) -> None:
    path = write(tmp_path / "a.tif", np.zeros((30, 50)), Affine(0.001, 0, -158, 0, -0.001, 21.5), "EPSG:4326")
    assert Terrain.open(path, crs=UTM).crs == pyproj.CRS(UTM)
    with pytest.raises(CrsError, match="not in metres"):
        Terrain.open(path, crs="EPSG:4326")
    with pytest.raises(CrsError, match=r"crs=.*'nonsense'"):
        Terrain.open(path, crs="nonsense")
    bare = write(tmp_path / "b.tif", np.zeros((30, 50)), crs=None)
    assert Terrain.open(bare, crs=UTM).crs == pyproj.CRS(UTM)
    assert Terrain.open(bare).crs is None


@pytest.mark.parametrize("angle", [1.0, 30.0, 90.0, 135.0])
def test_turned_rasters_are_set_upright(angle: Any) -> None:
    transform = Affine.translation(5e5, 2e6) @ Affine.rotation(angle) @ Affine.scale(10, -20)
    rows, columns = np.mgrid[0:30, 0:40]
    terrain = Terrain.from_array(columns + 100.0 * rows, transform, UTM)
    x, y = positions(terrain)
    back = ~transform
    column, row = back.a * x + back.b * y + back.c - 0.5, back.d * x + back.e * y + back.f - 0.5
    expected = column + 100 * row
    inside = ~np.isnan(terrain.z)
    assert inside.sum() > 900
    np.testing.assert_allclose(terrain.z[inside], expected[inside], atol=0.5)
    np.testing.assert_allclose(sorted([terrain.dx, terrain.dy]), [10, 20], rtol=0.05)


def test_extents_that_no_local_plane_holds_are_refused() -> None:
    with pytest.raises(CrsError, match=r"does not fit.*crs="):
        Terrain.from_array(np.zeros((18, 36)), Affine(10, 0, -180, 0, -10, 90), "EPSG:4326")
    with pytest.raises(CrsError, match="no place on the globe"):
        Terrain.from_array(np.zeros((18, 36)), Affine(1, 0, 0, 0, -1, 5000), "EPSG:4326")


@pytest.mark.parametrize("shape", [(1, 1), (1, 5), (4, 1)])
@pytest.mark.parametrize("crs", [None, UTM, "EPSG:4326"])
def test_single_samples_rows_and_columns_are_legal(shape: Any, crs: Any) -> None:
    terrain = Terrain.from_array(np.full(shape, 7.0), Affine(0.1, 0, 10, 0, -0.1, 50), crs)
    assert terrain.shape == shape
    assert (terrain.z == 7).all()


# Flat ground


def test_flat_ground() -> None:
    terrain = Terrain.flat((0, 10, 100, 30), height=5)
    assert terrain.bounds == (0.0, 10.0, 100.0, 30.0)
    assert terrain.shape == (2, 2)
    assert (terrain.z == 5).all()
    assert Terrain.flat((0, 0, 1, 1), UTM).crs == pyproj.CRS(UTM)


def test_flat_ground_in_degrees_holds_all_of_its_bounds() -> None:
    terrain = Terrain.flat((-158, 21, -157, 22), "EPSG:4326")
    edge = np.linspace(0, 1, 200)
    forward = pyproj.Transformer.from_crs(4326, terrain.crs, always_xy=True)
    x, y = forward.transform(np.concatenate([edge - 158, edge - 158]), np.repeat([21.0, 22.0], 200))
    west, south, east, north = terrain.bounds
    assert west - 1 <= x.min() < west + 100
    assert east - 100 < x.max() <= east + 1
    assert south - 1 <= y.min() < south + 100
    assert north - 100 < y.max() <= north + 1


@pytest.mark.parametrize("bounds", [(0, 0, 0, 1), (1, 0, 0, 1), (0, 0, math.nan, 1), (0, 0, 1), "abc", None])
def test_bounds_of_flat_ground_are_checked(bounds: Any) -> None:
    with pytest.raises(InputError, match="bounds must be"):
        Terrain.flat(bounds)
    with pytest.raises(InputError, match="height"):
        Terrain.flat((0, 0, 1, 1), height=math.inf)


# Refusals


@pytest.mark.parametrize(
    ("z", "transform", "message"),
    [
        (np.zeros(5), METRES, "shape"),
        (np.zeros((0, 5)), METRES, "shape"),
        (np.zeros((2, 2), dtype=complex), METRES, "complex128"),
        (np.array([["a"]]), METRES, "table of real heights"),
        (np.full((2, 3), np.nan), METRES, "no finite height among its 2 x 3"),
        (np.array([[0, 1, 2], [3, np.inf, -np.inf]]), METRES, "2 infinite heights.*row 1, column 1"),
        (np.array([[0, 1e300]]), METRES, "row 0, column 1: .*1e.300"),
        (RAMP, Affine(0, 0, 0, 0, -1, 0), "does not span a plane"),
        (RAMP, Affine(math.nan, 0, 0, 0, -1, 0), "does not span a plane"),
        (RAMP, (1, 2, 3), "six numbers"),
        (RAMP, None, "six numbers"),
    ],
)
def test_unusable_arrays_are_refused(z: Any, transform: Any, message: Any) -> None:
    with pytest.raises(InputError, match=message):
        Terrain.from_array(z, transform)


def test_unreadable_files_are_refused(tmp_path: Any) -> None:
    with pytest.raises(FileError, match="There is no file"):
        Terrain.open(tmp_path / "none.tif")
    path = tmp_path / "broken.tif"
    path.write_bytes(b"II*\0 not a raster")
    with pytest.raises(FileError, match="cannot be read as a raster"):
        Terrain.open(path)
    whole = write(tmp_path / "whole.tif", np.random.default_rng(0).random((300, 300)), compress="deflate")
    path.write_bytes(whole.read_bytes()[:50_000])
    with pytest.raises(FileError, match="damaged"):
        Terrain.open(path)


def test_files_without_heights_are_refused(tmp_path: Any) -> None:
    with pytest.raises(InputError, match=r"Band 1 of .*no finite height"):
        Terrain.open(write(tmp_path / "a.tif", np.full((2, 2), -1, dtype=np.int16), nodata=-1))
    with pytest.raises(InputError, match="complex64"):
        Terrain.open(write(tmp_path / "b.tif", np.zeros((2, 2), dtype=np.complex64)))
    with pytest.raises(InputError, match=r"infinite heights.*row 0, column 0"):
        Terrain.open(write(tmp_path / "c.tif", np.full((2, 2), -1.7e308)))


def sparse(path: Any, side: Any) -> Any:
    profile = {
        "driver": "GTiff",
        "dtype": "float32",
        "count": 1,
        "tiled": True,
        "blockxsize": 512,
        "blockysize": 512,
    }
    with rasterio.open(
        path, "w", height=side, width=side, transform=METRES, crs=UTM, sparse_ok=True, **profile
    ):
        pass
    return path


def test_a_small_file_that_declares_gigabytes_is_refused(tmp_path: Any) -> None:
    path = sparse(tmp_path / "bomb.tif", 49_152)
    assert path.stat().st_size < 200_000
    with pytest.raises(MemoryLimitError, match=r"bomb.tif.*49152 x 49152.*9.0 GiB.*window=.*max_samples="):
        Terrain.open(path)
    with pytest.raises(MemoryError):
        Terrain.open(path, crs=UTM)


def test_an_empty_file_below_the_limit_is_refused_unless_it_is_meant(tmp_path: Any) -> None:
    path = sparse(tmp_path / "empty.tif", 8192)
    with pytest.raises(MemoryLimitError, match="nearly all of it is empty"):
        Terrain.open(path)
    assert Terrain.open(path, window=(0, 0, 8, 8)).shape == (8, 8)
    with pytest.raises(MemoryLimitError, match="limit of 1000"):
        Terrain.open(path, max_samples=1000)


def test_memory_that_is_not_there_is_not_asked_for(tmp_path: Any, monkeypatch: Any) -> None:
    path = write(tmp_path / "a.tif", RAMP)
    monkeypatch.setattr(_raster, "available_memory", lambda: 100)
    with pytest.raises(MemoryLimitError, match=r"a.tif.*100 bytes are available"):
        Terrain.open(path)


def test_warps_that_grow_beyond_the_limit_are_refused(tmp_path: Any) -> None:
    turned = Affine.rotation(45) @ Affine.scale(10, -10)
    path = write(tmp_path / "a.tif", np.zeros((30, 30)), turned)
    with pytest.raises(MemoryLimitError, match="max_samples=1000"):
        Terrain.open(path, max_samples=1000)


def test_terrains_check_their_numbers() -> None:
    with pytest.raises(InputError, match="steps positive"):
        Terrain(RAMP, 0, 0, -1, 1)
    with pytest.raises(InputError, match="at least one sample"):
        Terrain(np.zeros((0, 3), np.float32), 0, 0, 1, 1)
