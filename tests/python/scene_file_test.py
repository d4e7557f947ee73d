"""Scene files: what they describe, and errors that name the file, the table and the key."""

from __future__ import annotations

import gzip
import json
from typing import TYPE_CHECKING, Any

import pytest

from decalgl.errors import DecalError, FileError, InputError
from decalgl.scene_file import PictureOptions, data_path, load_scene, read_scene_file

if TYPE_CHECKING:
    from pathlib import Path

FLAT = "[terrain]\nflat = [0, 0, 100, 50]\n"
SQUARE = {
    "type": "FeatureCollection",
    "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32604"}},
    "features": [
        {
            "type": "Feature",
            "properties": {"kind": "park"},
            "geometry": {
                "type": "Polygon",
                "coordinates": [[[10, 10], [40, 10], [40, 40], [10, 40], [10, 10]]],
            },
        }
    ],
}


def write(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(text)
    return path


def test_everything_is_described(tmp_path: Path) -> None:
    text = """
    [terrain]
    path = "dem.tif"
    exaggeration = 2
    crs = "EPSG:32604"
    [relief]
    color = "white"
    strength = 0.5
    [[layers]]
    type = "polygons"
    path = "cover.gpkg"
    layer = "land"
    column = "kind"
    cmap = { park = "green" }
    [[layers]]
    type = "lines"
    path = "/data/roads.gpkg"
    name = "roads"
    width = 6
    width_units = "m"
    [views.valley]
    look_at = { eye = [0, 0, 100], target = [1, 2, 3], fov = 40 }
    [views.map]
    top_down = {}
    [picture]
    size = [640, 480]
    background = "none"
    view = "map"
    index = "thoeny"
    antialias = "ssaa"
    samples = 16
    """
    scene = read_scene_file(write(tmp_path, text))
    assert scene.terrain == {"path": str(tmp_path / "dem.tif"), "crs": "EPSG:32604"}
    assert scene.exaggeration == 2.0
    assert scene.relief == {"color": "white", "strength": 0.5}
    cover, roads = scene.layers
    assert (cover.kind, cover.source) == ("polygons", str(tmp_path / "cover.gpkg"))
    assert cover.keywords == {"name": "cover", "layer": "land", "column": "kind", "cmap": {"park": "green"}}
    assert (roads.kind, roads.source) == ("lines", "/data/roads.gpkg")
    assert roads.keywords == {"name": "roads", "width": 6.0, "width_units": "m"}
    assert scene.views["valley"].keywords == {"eye": (0, 0, 100), "target": (1, 2, 3), "fov": 40}
    assert scene.picture == PictureOptions((640, 480), "ssaa", None, "map", "thoeny", 16)


def test_a_flat_terrain_is_enough(tmp_path: Path) -> None:
    scene = read_scene_file(write(tmp_path, FLAT))
    assert scene.terrain == {"bounds": (0, 0, 100, 50)}
    assert scene.layers == ()
    assert scene.picture == PictureOptions()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[terain]\npath = 'a'", "the key 'terrain' is missing. Did you mean 'terain'"),
        (FLAT + "exageration = 2", "[terrain]: unknown key 'exageration'. Did you mean 'exaggeration'"),
        (FLAT + "path = 'a'", "either path"),
        ("[terrain]", "either path"),
        ("[terrain]\nflat = [0, 0, 1]", "array of 4 numbers"),
        ("[terrain]\nflat = [0, 0, 1, nan]", "finite number"),
        ("terrain = 3", "must be a table"),
        (FLAT + "exaggeration = true", "finite number"),
        (FLAT + "[picture]\nantialias = 'smaa'", "Did you mean 'ssaa'"),
        (FLAT + "[picture]\nsamples = 5", "[picture]: samples must be one of 1, 2, 4, 8, 16, 32"),
        (FLAT + "[picture]\nsamples = 2.0", "[picture]: samples must be a whole number"),
        (FLAT + "[relief]\ncolour = 'red'", "[relief]: unknown key 'colour'. Did you mean 'color'"),
        (FLAT + "[layers]\npath = 'a'", "two brackets"),
        (FLAT + "[[layers]]\npath = 'a'", "[[layers]] number 1: the key 'type' is missing"),
        (FLAT + "[[layers]]\ntype = 'polygon'\npath = 'a'", "Did you mean 'polygons'"),
        (
            FLAT + "[[layers]]\ntype = 'lines'\npath = 'a'\nname = 'b'\nwidht = 3",
            "1 (b): unknown key 'widht'",
        ),
        (FLAT + "[[layers]]\ntype = 'polygons'\npath = 'a'\nwidth = 3", "unknown key 'width'"),
        (FLAT + "[[layers]]\ntype = 'polygons'\npath = 'a'\ncmap = { park = 1 }", "'park' has 1"),
        (FLAT + "[[layers]]\ntype = 'polygons'\npath = 'a'\nmissing_kwds = 1", "missing_kwds"),
        (FLAT + "[views.a]", "[views.a]: give one of look_at"),
        (FLAT + "[views.a]\nlook_at = { eye = [0, 0, 1] }", "[views.a] look_at: the key 'target' is missing"),
        (FLAT + "[views.a]\norbit = { target = [0, 0, 0], distance = 1 }", "'azimuth' is missing"),
        (FLAT + "[views.a]\ntop_down = { margn = 1 }", "Did you mean 'margin'"),
        (FLAT + "[picture]\nsize = [0, 10]", "above 0"),
        (FLAT + "[picture]\nsize = [1.5, 10]", "above 0"),
        (FLAT + "[picture]\nview = 'a'", "there is no [views.a]"),
        (FLAT + "[[views]]\n", "must be a table"),
        ("[terrain", "not valid TOML"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, text: str, expected: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(InputError) as caught:
        read_scene_file(path)
    assert expected in str(caught.value)
    assert "scene.toml" in str(caught.value)


def test_missing_and_odd_files(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no scene file"):
        read_scene_file(tmp_path / "absent.toml")
    with pytest.raises(FileError):
        read_scene_file(tmp_path)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match="not valid TOML"):
        read_scene_file(binary)
    nested = tmp_path / "nested.toml"
    nested.write_text("a = " + "[" * 100_000)
    with pytest.raises(InputError, match="not valid TOML"):
        read_scene_file(nested)


def test_paths_are_relative_to_the_file(tmp_path: Path) -> None:
    assert data_path("a/b.tif", tmp_path) == str(tmp_path / "a" / "b.tif")
    assert data_path("/vsizip/a.zip/b.shp", tmp_path) == "/vsizip/a.zip/b.shp"
    assert data_path("https://example.org/a.tif", tmp_path) == "https://example.org/a.tif"


def build(folder: Path, extra: str, square: dict[str, Any] = SQUARE) -> Any:
    (folder / "square.geojson.gz").write_bytes(gzip.compress(json.dumps(square).encode()))
    terrain = "[terrain]\nflat = [-100, -100, 100, 100]\ncrs = 'EPSG:32604'\n"
    return load_scene(write(folder, terrain + extra))


def test_a_scene_is_built(tmp_path: Path) -> None:
    text = """
    [[layers]]
    type = "polygons"
    path = "square.geojson.gz"
    column = "kind"
    cmap = { park = "#00ff00" }
    [views.map]
    top_down = {}
    [views.side]
    orbit = { target = [0, 0, 0], distance = 9, azimuth = 180, elevation = 30 }
    [views.far]
    look_at = { eye = [-157, 21, 900], target = [-157.1, 21.1, 0], crs = "EPSG:4326" }
    """
    scene, cameras, picture = build(tmp_path, text)
    assert picture == PictureOptions()
    assert [made.name for made in scene.layers] == ["square"]
    assert scene.layers[0].colors.tolist() == [[0, 255, 0, 255]]
    assert set(cameras) == {"map", "side", "far"}
    assert cameras["map"].is_orthographic
    assert cameras["side"].eye[1] < 0.0
    x, y, height = cameras["far"].eye
    assert (round(x, -5), round(y, -5), height) == (700_000.0, 2_300_000.0, 900.0)


@pytest.mark.parametrize(
    ("extra", "expected"),
    [
        ("[[layers]]\ntype = 'polygons'\npath = 'absent.gpkg'", "absent.gpkg"),
        ("[[layers]]\ntype = 'lines'\npath = 'absent.gpkg'\nwidth_units = 'm'", "absent.gpkg"),
        ("[[layers]]\ntype = 'lines'\npath = 'square.geojson.gz'\nname = 'roads'", "'roads'"),
        ("[relief]\ncolor = 'graay'", "graay"),
        ("[relief]\naltitude = 0", "altitude"),
        ("[views.a]\nlook_at = { eye = [0, 0, 0], target = [0, 0, 0] }", "[views.a]"),
        ("[views.a]\nlook_at = { eye = [0, 0, 1], target = [0, 0, 0], crs = 'nonsense' }", "nonsense"),
    ],
)
def test_building_names_what_is_wrong(tmp_path: Path, extra: str, expected: str) -> None:
    with pytest.raises(DecalError) as caught:
        build(tmp_path, extra)
    assert expected in str(caught.value)
