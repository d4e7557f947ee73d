"""Scene files: what they describe, and errors that name the file, the table and the key."""

from __future__ import annotations

import gzip
import json
from typing import TYPE_CHECKING, Any

import pytest
from matplotlib.colors import BoundaryNorm, LogNorm, PowerNorm, TwoSlopeNorm

from decalgl.coloring import resolve_colors
from decalgl.errors import DecalError, FileError, InputError
from decalgl.patterns import Pattern
from decalgl.scene_file import PictureOptions, data_path, load_scene, read_scene_file
from decalgl.strokes import Hatch

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


def layer_keywords(folder: Path, kind: str, text: str) -> Any:
    scene = read_scene_file(write(folder, FLAT + f"[[layers]]\ntype = '{kind}'\npath = 'a.gpkg'\n{text}"))
    (layer,) = scene.layers
    return {key: value for key, value in layer.keywords.items() if key != "name"}


def test_styles_of_lines_are_described(tmp_path: Path) -> None:
    text = """
    column = "class"
    legend = true
    legend_kwds = { title = "Roads", loc = "upper left" }
    width = { road = 6, track = 3.5 }
    width_units = "m"
    corner = "miter"
    cap = { road = "butt", track = "round" }
    miter_limit = 30
    bands = [[0.5, "white"], [1, "#ff0000"]]
    slope_correction = "tangent"
    widest = 12
    [layers.dash]
    road = "solid"
    track = [10, 5]
    path = { arrows = { every = 20, length = 5, shaft = 0.2 } }
    rail = { stipple = { bits = "1101", step = 2 } }
    trail = { period = 9, marks = [[0, 4], [5, 6, 1, 0]], offset = 2 }
    [layers.casing]
    width = "edge"
    column = "class"
    cmap = { road = "black", track = "grey" }
    alpha = 0.5
    dash = "dashed"
    """
    keywords = layer_keywords(tmp_path, "lines", text)
    casing = keywords.pop("casing")
    assert keywords == {
        "column": "class",
        "legend": True,
        "legend_kwds": {"title": "Roads", "loc": "upper left"},
        "width": {"road": 6, "track": 3.5},
        "width_units": "m",
        "corner": "miter",
        "cap": {"road": "butt", "track": "round"},
        "miter_limit": 30.0,
        "bands": [(0.5, "white"), (1, "#ff0000")],
        "slope_correction": "tangent",
        "widest": 12.0,
        "dash": {
            "road": "solid",
            "track": Pattern.dashes(10, 5),
            "path": Pattern.arrows(20, 5, 0.2),
            "rail": Pattern.stipple("1101", 2),
            "trail": Pattern(9, [(0, 4), (5, 6, 1, 0)], 2),
        },
    }
    assert (casing.width, casing.column, casing.alpha, casing.dash) == ("edge", "class", 0.5, "dashed")
    assert casing.cmap == {"road": "black", "track": "grey"}


def test_styles_of_polygons_are_described(tmp_path: Path) -> None:
    text = """
    color = "none"
    hatch = { spacing = 20, width = 4, angle = 30, crossed = true }
    outline = { width = 2, width_units = "m", color = "red", mode = "inset", order = "feature", dash = [4, 2] }
    """
    keywords = layer_keywords(tmp_path, "polygons", text)
    assert keywords["hatch"] == Hatch(20, 4, 30, True)
    outline = keywords["outline"]
    assert (outline.width, outline.width_units, outline.color) == (2, "m", "red")
    assert (outline.mode, outline.order, outline.dash) == ("inset", "feature", Pattern.dashes(4, 2))
    assert outline.corner == "round", "as by default"
    by_kind = "column = 'kind'\n[layers.hatch]\nwood = { spacing = 9, width = 1 }\nlawn = {}"
    assert layer_keywords(tmp_path, "polygons", by_kind)["hatch"] == {"wood": Hatch(9, 1), "lawn": None}
    assert layer_keywords(tmp_path, "lines", "dash = 'dashed'\nwidth = 'w'") == {
        "dash": "dashed",
        "width": "w",
    }
    assert layer_keywords(tmp_path, "lines", "dash = [3, 1]") == {"dash": Pattern.dashes(3, 1)}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("norm = 'log'\nvmin = 1\nvmax = 100", LogNorm(1, 100)),
        ("norm = { power = 0.5 }\nvmax = 9", PowerNorm(0.5, vmax=9)),
        ("norm = { center = 2 }\nvmin = 0\nvmax = 8", TwoSlopeNorm(2, 0, 8)),
        ("norm = { boundaries = [0, 5, 9] }\ncmap = 'Set2'", BoundaryNorm([0, 5, 9], 8)),
    ],
)
def test_transfer_functions_are_described(tmp_path: Path, text: str, expected: Any) -> None:
    keywords = layer_keywords(tmp_path, "polygons", text)
    values = [1.0, 2.0, 8.0]
    coloring = resolve_colors(3, column=values, **keywords)
    wanted = resolve_colors(3, column=values, cmap=keywords.get("cmap"), norm=expected)
    assert type(coloring.norm) is type(expected)
    assert coloring.colors.tolist() == wanted.colors.tolist()
    assert (coloring.vmin, coloring.vmax) == (wanted.vmin, wanted.vmax)


@pytest.mark.parametrize(
    ("kind", "text", "expected"),
    [
        ("lines", "hatch = { spacing = 2, width = 1 }", "unknown key 'hatch'"),
        ("lines", "norm = 'logg'", "norm must be 'log', { power = 0.5 }"),
        (
            "polygons",
            "norm = { boundaries = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9] }\ncmap = 'Set2'",
            "number 1 norm: ",
        ),
        ("lines", "norm = { boundaries = 3 }", "number 1 norm: boundaries must be an array"),
        ("lines", "norm = { centre = 0 }", "norm: unknown key 'centre'. Did you mean 'center'"),
        ("lines", "norm = { boundaries = [3, 2, 1] }", "number 1 norm: boundaries must be an array"),
        ("lines", "norm = { boundaries = ['a', 'b'] }", "number 1 norm: boundaries must be an array"),
        ("lines", "outline = { width = 2 }", "unknown key 'outline'"),
        ("polygons", "dash = 'dashed'", "unknown key 'dash'"),
        ("polygons", "casing = { width = 2 }", "unknown key 'casing'"),
        ("lines", "casing = { color = 'red' }", "[[layers]] number 1 casing: the key 'width' is missing"),
        ("lines", "casing = { width = 1, corner = 'miter' }", "casing: unknown key 'corner'"),
        ("lines", "casing = 3", "number 1 casing: must be a table"),
        ("polygons", "outline = { widht = 2 }", "outline: unknown key 'widht'. Did you mean 'width'"),
        (
            "polygons",
            "outline = { width = true }",
            "outline: width must be a number, a column's name or a table",
        ),
        ("polygons", "outline = { cmap = 3 }", "outline: cmap must be"),
        ("lines", "width = [1, 2]", "width must be a number, a column's name or a table"),
        ("lines", "width = { road = true }", "width of 'road' must be a number"),
        ("lines", "corner = 3", "corner must be text"),
        ("lines", "cap = { road = 3 }", "cap of 'road' must be text"),
        ("lines", "miter_limit = '40'", "miter_limit must be a finite number"),
        ("lines", "width_units = 'ft'", "width_units must be one of"),
        ("lines", "bands = ['red']", "bands must be an array such as"),
        ("lines", "legend_kwds = 3", "legend_kwds must be a table"),
        ("lines", "dash = 5", "dash must be a text such as"),
        ("lines", "dash = { road = 5 }", "dash road must be a text such as"),
        ("lines", "dash = [0, 1]", "number 1: Dash length number 1 is 0"),
        ("lines", "dash = { period = 5 }", "dash: the key 'marks' is missing"),
        ("lines", "dash = { period = 5, marks = [[0, 6]] }", "dash: Pattern mark 1 must begin before"),
        ("lines", "dash = { period = 5, marks = [[0, 1]], of = 3 }", "dash: unknown key 'of'"),
        ("lines", "dash = { arrows = { every = 5 } }", "dash arrows: the key 'length' is missing"),
        ("lines", "dash = { arrows = { every = 5, length = 9 } }", "dash arrows: Pattern.arrows length"),
        ("lines", "dash = { arrows = { every = 5, length = 1 }, offset = 1 }", "dash: unknown key 'offset'"),
        ("lines", "dash = { stipple = { bits = 10, step = 1 } }", "dash stipple: Pattern.stipple bits"),
        (
            "lines",
            "dash = { road = { stipple = { bits = '2', step = 1 } } }",
            "dash road stipple: Pattern.stipple",
        ),
        ("polygons", "hatch = '//'", "hatch must be a table such as"),
        ("polygons", "hatch = { spacing = 2 }", "hatch: the key 'width' is missing"),
        ("polygons", "hatch = { spacing = 2, width = 0 }", "hatch: Hatch width must be a length above 0"),
        (
            "polygons",
            "hatch = { wood = { spacing = 2, with = 1 } }",
            "hatch wood: the key 'width' is missing",
        ),
        ("polygons", "hatch = { spacing = 2, width = 1, anglle = 3 }", "Did you mean 'angle'"),
    ],
)
def test_mistakes_in_styles_are_named(tmp_path: Path, kind: str, text: str, expected: str) -> None:
    with pytest.raises(InputError) as caught:
        layer_keywords(tmp_path, kind, text)
    assert expected in str(caught.value)
    assert "scene.toml, [[layers]] number 1" in str(caught.value)


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
    legend = true
    hatch = { park = { spacing = 4, width = 1 } }
    outline = { width = 2, width_units = "m", corner = "miter" }
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
    assert scene.layers[0].fill.hatches == (Hatch(4, 1),)
    assert scene.layers[0].stroke.styles[0].corner == "miter"
    assert scene.layers[0].coloring.legend
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
