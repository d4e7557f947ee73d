"""What `decalgl info` says about a file, and the table of costs of `decalgl render --stats`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.table import Table
from rich.text import Text

from . import _core
from ._paths import gdal_name
from ._sources import guarded_name
from .errors import FileError
from .scene_file import data_path, read_scene_file

if TYPE_CHECKING:
    from collections.abc import Mapping


def describe(file: Path) -> list[Table]:
    """Tables about a scene file, a saved scene, a raster or a vector file; data itself is not read.

    Raises FileError.
    """
    if not file.exists():
        raise FileError(f"There is no file '{file}'. Check the path.")
    if file.suffix.lower() == ".toml":
        return _describe_scene(file)
    if file.is_file() and _core.is_saved_scene(os.fsencode(file)):
        return _describe_saved_scene(file)
    name = data_path(str(file), Path())
    found = _describe_raster(name) or _describe_vector(name)
    if not found:
        raise FileError(
            f"'{file}' is neither a raster nor a vector file that GDAL reads, nor a scene file (.toml) or a"
            " saved scene."
        )
    return found


def cost_table(stats: Mapping[str, Any]) -> Table:
    """Milliseconds of each stage and pass, bytes of each technique."""
    table = _table("What it cost")
    table.columns[1].justify = "right"
    for stage, milliseconds in stats.get("stages", {}).items():
        table.add_row(stage, f"{milliseconds:,.1f} ms")
    for one in stats.get("passes", []):
        table.add_row(f"pass {one['name']}", f"{one['ms']:,.1f} ms")
    for technique, count in stats.get("bytes", {}).items():
        table.add_row(f"memory {technique}", f"{count / 1e6:,.1f} MB")
    return table


def _table(title: str) -> Table:
    table = Table(title=Text(title), show_header=False, title_justify="left")
    table.add_column()
    table.add_column(overflow="fold")
    return table


def _row(table: Table, what: str, value: object) -> None:
    table.add_row(what, Text(str(value)))


def _bounds(values: Any) -> str:
    return ", ".join(f"{value:.10g}" for value in values)


def _describe_raster(name: str) -> list[Table]:
    import rasterio

    try:
        with rasterio.open(gdal_name(name)) as raster:
            table = _table(f"{Path(name).name}: raster, {raster.driver}")
            _row(table, "samples", f"{raster.width} columns × {raster.height} rows, {raster.count} band(s)")
            _row(table, "type", ", ".join(dict.fromkeys(raster.dtypes)))
            _row(table, "CRS", raster.crs.to_string() if raster.crs else "none")
            _row(table, "step", " × ".join(f"{step:.10g}" for step in raster.res))
            _row(table, "bounds", _bounds(raster.bounds))
            _row(table, "nodata", "none" if raster.nodata is None else f"{raster.nodata:g}")
    except rasterio.errors.RasterioIOError:
        return []
    return [table]


def _describe_vector(name: str) -> list[Table]:
    if name.endswith((".parquet", ".geoparquet")):
        return [_describe_parquet(name)]
    import pyogrio

    source = guarded_name(name)
    try:
        layers = pyogrio.list_layers(source)
    except pyogrio.errors.DataSourceError:
        return []
    tables = []
    for layer, _ in layers:
        found = pyogrio.read_info(source, layer=layer, force_feature_count=True, force_total_bounds=True)
        table = _table(f"{Path(name).name}: vector layer {layer}, {found.get('driver')}")
        _row(table, "features", f"{found['features']:,}")
        _row(table, "geometry", found["geometry_type"])
        _row(table, "CRS", found["crs"] or "none")
        bounds = found.get("total_bounds")
        _row(table, "bounds", "none" if bounds is None else _bounds(bounds))
        columns = zip(found["fields"], found["dtypes"], strict=True)
        _row(table, "columns", ", ".join(f"{column} ({kind})" for column, kind in columns) or "none")
        tables.append(table)
    return tables


def _describe_parquet(name: str) -> Table:
    import json

    try:
        from pyarrow import ArrowException, parquet
    except ImportError as error:
        raise FileError(f"Reading '{name}' needs the package pyarrow: pip install pyarrow.") from error
    try:
        file = parquet.ParquetFile(name)
    except (ArrowException, OSError) as error:
        raise FileError(f"'{name}' cannot be read: {error}.") from error
    schema = file.schema_arrow
    table = _table(f"{Path(name).name}: vector layer, Parquet")
    _row(table, "features", f"{file.metadata.num_rows:,}")
    geo = json.loads((schema.metadata or {}).get(b"geo", b"{}"))
    for column, facts in geo.get("columns", {}).items():
        crs = facts.get("crs", {"name": "OGC:CRS84"}) or {"name": "none"}
        _row(table, "geometry", f"{column}: {', '.join(facts.get('geometry_types', [])) or 'any'}")
        _row(table, "CRS", crs.get("name"))
        if "bbox" in facts:
            _row(table, "bounds", _bounds(facts["bbox"]))
    _row(
        table,
        "columns",
        ", ".join(f"{one.name} ({one.type})" for one in schema if one.name not in geo.get("columns", {})),
    )
    return table


def _describe_scene(file: Path) -> list[Table]:
    scene = read_scene_file(file)
    table = _table(f"{file.name}: scene")
    terrain = scene.terrain
    _row(table, "terrain", terrain.get("path") or f"flat, {_bounds(terrain['bounds'])}")
    _row(table, "exaggeration", f"{scene.exaggeration:g}")
    for layer in scene.layers:
        _row(table, layer.kind, f"{layer.keywords['name']}: {layer.source}")
    for name, view in scene.views.items():
        _row(table, "view", f"{name}: {view.kind}")
    picture = scene.picture
    _row(table, "picture", f"{picture.size[0]} × {picture.size[1]}, antialias {picture.antialias}")
    return [table]


def _describe_saved_scene(file: Path) -> list[Table]:
    found = _core.describe_saved_scene(os.fsencode(file))
    table = _table(f"{file.name}: saved scene, format {found['format']}")
    rows, columns = found["shape"]
    _row(table, "samples", f"{columns} columns × {rows} rows")
    _row(table, "bounds", _bounds(found["bounds"]))
    for name, kind, layer_rows in found["layers"]:
        _row(table, kind, f"{name}: {len(layer_rows):,} features")
    _row(table, "size", f"{found['bytes']:,} bytes")
    for name, count in found["sections"].items():
        _row(table, f"section {name}", f"{count:,} bytes")
    return [table]
