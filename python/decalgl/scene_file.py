"""Scene files: a terrain, its layers and views in TOML.

    [terrain]                        path = "dem.tif"   or   flat = [xmin, ymin, xmax, ymax], height = 0
                                     exaggeration, crs, band
    [relief]                         color, cmap, vmin, vmax, azimuth, altitude, strength, on_layers
    [[layers]]                       type = "polygons" or "lines", path, name, layer, crs,
                                     column, cmap, color, vmin, vmax, norm, alpha, categorical, legend,
                                     legend_kwds, missing_kwds, order
                                     lines: width, width_units, corner, cap, miter_limit, dash, bands, widest,
                                     slope_correction, casing (a table); polygons: hatch, outline (tables)
    [views.NAME]                     look_at  = { eye = [x, y, z], target = [x, y, z], fov, crs }
                                     orbit    = { target = [x, y, z], distance, azimuth, elevation, fov, crs }
                                     top_down = { bounds = [xmin, ymin, xmax, ymax], margin, crs }
    [picture]                        size = [width, height], antialias, samples, background ("none": transparent),
                                     view, index

Layers are drawn bottom to top. Paths are relative to the file; a path that ends in .gz is unpacked while it
is read. Positions are metres of the scene's plane (heights after exaggeration) unless the view names a `crs`
for its x and y. Unknown keys, tables and types are errors: a misspelt key never changes a picture silently.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ._antialias import ANTIALIAS, SAMPLES
from ._crs import parse_crs
from ._scene_file_styles import parse_style, present
from ._tables import StrictTable
from .errors import FileError, InputError
from .indexes import INDEXES

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from .camera import Camera
    from .scene import Scene
    from .terrain import Terrain

LAYER_TYPES = ("polygons", "lines")
LARGEST_FILE = 16 << 20  # a description, not data: larger ones are something else by mistake


@dataclass(frozen=True)
class PictureOptions:
    """How to draw when nothing else is said. size: (width, height) pixels; background None is transparent."""

    size: tuple[int, int] = (1920, 1080)
    antialias: str = "coverage"
    background: str | None = "sky"
    view: str | None = None
    index: str = "grid"
    samples: int = 8


@dataclass(frozen=True)
class LayerDescription:
    """One layer: what `Scene.add_polygons` or `Scene.add_lines` is called with."""

    kind: str
    source: str
    keywords: Mapping[str, Any]


@dataclass(frozen=True)
class ViewDescription:
    """One view: the name of a `Camera` constructor, its keywords, the CRS of their positions (or None)."""

    kind: str
    keywords: Mapping[str, Any]
    crs: str | None = None


@dataclass(frozen=True)
class SceneDescription:
    """A scene file as plain data, checked for keys and types; `build` reads what it names."""

    path: Path
    terrain: Mapping[str, Any]
    exaggeration: float
    relief: Mapping[str, Any]
    layers: tuple[LayerDescription, ...]
    views: Mapping[str, ViewDescription]
    picture: PictureOptions = field(default_factory=PictureOptions)

    def open_terrain(self) -> Terrain:
        """The terrain that [terrain] names. Raises what `Terrain.open` and `Terrain.flat` raise."""
        from .terrain import Terrain

        if "bounds" in self.terrain:
            return Terrain.flat(**self.terrain)
        return Terrain.open(**self.terrain)

    def build(self) -> LoadedScene:
        """The scene with all its layers, its cameras by name, and the picture's options."""
        from .scene import Relief, Scene

        terrain = self.open_terrain()
        scene = Scene(terrain, exaggeration=self.exaggeration, relief=Relief(**self.relief))
        for layer in self.layers:
            add = scene.add_polygons if layer.kind == "polygons" else scene.add_lines
            add(layer.source, **layer.keywords)
        views = {name: make_camera(view, terrain, name) for name, view in self.views.items()}
        return LoadedScene(scene, views, self.picture)


class LoadedScene(NamedTuple):
    """What a scene file holds, ready to draw."""

    scene: Scene
    views: dict[str, Camera]
    picture: PictureOptions


def load_scene(path: str | os.PathLike[str]) -> LoadedScene:
    """Reads a scene file and everything that it names: (scene, {view name: camera}, picture options).

    Raises FileError when a file is missing or unreadable and InputError (or one of its kinds) when something
    in it is wrong; messages name the file, the table and the key.
    """
    return read_scene_file(path).build()


def read_scene_file(path: str | os.PathLike[str]) -> SceneDescription:
    """Reads and checks a scene file alone, not the data it names. Raises FileError and InputError."""
    file = Path(path)
    try:
        with file.open("rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError as error:
        raise FileError(f"There is no scene file '{file}'. Check the path.") from error
    except OSError as error:
        raise FileError(f"The scene file '{file}' cannot be read: {error.strerror}.") from error
    if len(content) > LARGEST_FILE:
        raise FileError(f"'{file}' is larger than 16 MiB, so it is hardly a scene file. Give the TOML file.")
    try:
        document = tomllib.loads(content.decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"'{file}' is not valid TOML: {error}.") from error
    return parse_scene(document, file)


def parse_scene(document: Mapping[str, Any], file: Path) -> SceneDescription:
    """Checks a parsed document; paths in it are taken relative to the folder of `file`. Raises InputError."""
    top = StrictTable(document, "top level", str(file))
    terrain = top.required("terrain", top.table("terrain"))
    relief, picture = top.table("relief"), top.table("picture")
    layers, views = top.value("layers"), top.table("views")
    top.finish()
    exaggeration = terrain.number("exaggeration")
    checked = SceneDescription(
        path=file,
        terrain=_parse_terrain(terrain, file.parent),
        exaggeration=1.0 if exaggeration is None else exaggeration,
        relief=_parse_relief(relief) if relief else {},
        layers=_parse_layers(layers, file),
        views={name: _parse_view(views, name) for name in views.names()} if views else {},
        picture=_parse_picture(picture) if picture else PictureOptions(),
    )
    wanted = checked.picture.view
    if picture and wanted is not None and wanted not in checked.views:
        raise picture.error(
            f"there is no [views.{wanted}]. The views are: {', '.join(checked.views) or 'none'}."
        )
    return checked


def data_path(text: str, folder: Path) -> str:
    """A path of a scene file, relative to `folder`; what GDAL resolves by itself stays as it is."""
    return text if text.startswith("/vsi") or "://" in text else str(folder / Path(text).expanduser())


def make_camera(view: ViewDescription, terrain: Terrain, name: str) -> Camera:
    """The camera of a view; positions in another CRS are brought to the terrain's plane."""
    from .camera import Camera

    keywords = dict(view.keywords)
    if view.kind == "top_down":
        keywords.setdefault("bounds", None)
    if view.crs is not None:
        keywords = _to_plane(keywords, view.crs, terrain, name)
    if view.kind == "top_down" and keywords["bounds"] is None:
        keywords["bounds"] = terrain.bounds
    try:
        made: Camera = getattr(Camera, view.kind)(**keywords)
    except InputError as error:
        raise type(error)(f"[views.{name}]: {error}") from error
    return made


def _to_plane(keywords: dict[str, Any], crs: str, terrain: Terrain, name: str) -> dict[str, Any]:
    from pyproj import Transformer

    if terrain.crs is None:
        raise InputError(
            f"[views.{name}] names the crs {crs!r}, but the terrain has none. Give [terrain] a crs, or the "
            "view metres."
        )
    transformer = Transformer.from_crs(parse_crs(crs, f"crs of [views.{name}]"), terrain.crs, always_xy=True)
    for key in ("eye", "target"):
        if key in keywords:
            x, y, height = keywords[key]
            keywords[key] = (*transformer.transform(x, y, errcheck=False), height)
    if keywords.get("bounds") is not None:
        keywords["bounds"] = transformer.transform_bounds(*keywords["bounds"])
    return keywords


def _parse_terrain(table: StrictTable, folder: Path) -> dict[str, Any]:
    path, bounds = table.text("path"), table.numbers("flat", 4)
    if (path is None) == (bounds is None):
        raise table.error("give either path (a raster) or flat (bounds), one of the two.")
    crs = table.text("crs")
    if path is not None:
        result = present(path=data_path(path, folder), crs=crs, band=table.integer("band"))
    else:
        result = present(bounds=bounds, crs=crs, height=table.number("height"))
    table.finish()
    return result


def _parse_relief(table: StrictTable) -> dict[str, Any]:
    result = present(color=table.text("color"), cmap=table.text("cmap"))
    for key in ("vmin", "vmax", "azimuth", "altitude", "strength", "on_layers"):
        result |= present(**{key: table.number(key)})
    table.finish()
    return result


def _parse_layers(layers: Any, file: Path) -> tuple[LayerDescription, ...]:
    if layers is None:
        return ()
    if not isinstance(layers, list):
        raise InputError(f"{file}: layers must be an array of tables; write [[layers]] with two brackets.")
    return tuple(
        _parse_layer(StrictTable(values, f"[[layers]] number {number}", str(file)), file.parent)
        for number, values in enumerate(layers, start=1)
    )


def _parse_layer(table: StrictTable, folder: Path) -> LayerDescription:
    kind = table.required("type", table.choice("type", LAYER_TYPES))
    path = table.required("path", table.text("path"))
    name = table.text("name")
    if name is not None:
        table.name += f" ({name})"
    keywords = present(
        name=name or Path(path).name.split(".")[0],
        layer=table.text("layer"),
        crs=table.text("crs"),
        order=table.text("order"),
    )
    keywords |= parse_style(table, kind)
    table.finish()
    return LayerDescription(kind, data_path(path, folder), keywords)


def _parse_view(views: StrictTable, name: str) -> ViewDescription:
    label = f"[views.{name}]"
    table = views.required(name, views.table(name, label))
    given = {kind: table.table(kind, f"{label} {kind}") for kind in ("look_at", "orbit", "top_down")}
    table.finish()
    kinds = [kind for kind, values in given.items() if values is not None]
    if len(kinds) != 1:
        raise table.error("give one of look_at, orbit and top_down.")
    kind = kinds[0]
    inner = given[kind]
    assert inner is not None
    crs = inner.text("crs")
    if kind == "top_down":
        keywords = present(bounds=inner.numbers("bounds", 4), margin=inner.number("margin"))
    else:
        keywords = {"target": inner.required("target", inner.numbers("target", 3))}
        keywords |= present(fov=inner.number("fov"))
        if kind == "look_at":
            keywords["eye"] = inner.required("eye", inner.numbers("eye", 3))
        else:
            for key in ("distance", "azimuth", "elevation"):
                keywords[key] = inner.required(key, inner.number(key))
    inner.finish()
    return ViewDescription(kind, keywords, crs)


def _parse_picture(table: StrictTable) -> PictureOptions:
    size = table.value("size")
    whole = isinstance(size, list) and len(size) == 2 and all(type(one) is int and one > 0 for one in size)
    if size is not None and not whole:
        raise table.error(
            f"size must be two whole numbers of pixels above 0, [width, height], but it is {size!r}."
        )
    given = present(
        size=tuple(size) if size else None,
        antialias=table.choice("antialias", ANTIALIAS),
        view=table.text("view"),
        background=table.text("background"),
        index=table.choice("index", INDEXES),
        samples=table.integer("samples"),
    )
    if given.get("samples", SAMPLES[0]) not in SAMPLES:
        known = ", ".join(str(one) for one in SAMPLES)
        raise table.error(f"samples must be one of {known}, but it is {given['samples']}.")
    table.finish()
    if given.get("background") == "none":
        given["background"] = None
    return PictureOptions(**given)
