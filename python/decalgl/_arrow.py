"""Geometry columns of Arrow tables: GeoArrow extension types, and the binary columns of GeoParquet."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ._crs import parse_crs
from ._sources import geo_metadata, shapes_from_wkb, shapes_from_wkt
from .errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

TEXT_ENCODINGS = ("geoarrow.wkt", "ogc.wkt")
BINARY_ENCODINGS = ("geoarrow.wkb", "ogc.wkb", "wkb")


def geometry_of(data: Any, layer_name: str) -> tuple[Any, str, NDArray[Any], Any]:
    """(table, name of its geometry column, shapely geometries (rows,), CRS or None) of an Arrow table.

    The first geometry column counts, or the primary one where GeoParquet metadata names it.
    """
    import pyarrow as pa

    try:
        table = data if isinstance(data, pa.Table) else pa.table(data)
    except (pa.ArrowException, TypeError, ValueError) as error:
        raise InputError(f"Layer {layer_name!r} is no Arrow table with named columns: {error}.") from error
    field_name, encoding, crs = _geometry_column(table, layer_name)
    column = table.column(field_name)
    if isinstance(column.type, pa.BaseExtensionType):
        column = pa.chunked_array([chunk.storage for chunk in column.chunks], type=column.type.storage_type)
    if encoding in BINARY_ENCODINGS:
        blobs = column.to_numpy(zero_copy_only=False)
        return table, field_name, shapes_from_wkb(blobs, layer_name), crs
    if encoding in TEXT_ENCODINGS:
        texts = column.to_numpy(zero_copy_only=False)
        return table, field_name, shapes_from_wkt(texts, layer_name), crs
    # The nested encodings (geoarrow.polygon, ...) have a fixed depth, so nothing needs guarding.
    import geopandas

    try:
        frame = geopandas.GeoDataFrame.from_arrow(
            _as_geoarrow(table, field_name, encoding), geometry=field_name
        )
    except (TypeError, ValueError, NotImplementedError) as error:
        raise InputError(
            f"The geometry column {field_name!r} of layer {layer_name!r} cannot be read: {error}. "
            "Write it as geoarrow.wkb."
        ) from error
    return table, field_name, np.asarray(frame.geometry.array), crs


def _geometry_column(table: Any, layer_name: str) -> tuple[str, str, Any]:
    described = geo_metadata(table.schema.metadata)
    columns = described.get("columns") or {}
    primary = described.get("primary_column")
    if primary in columns and primary in table.column_names:
        # GeoParquet says: no "crs" means longitude and latitude, null means unknown.
        crs = columns[primary].get("crs", "OGC:CRS84")
        text = json.dumps(crs) if isinstance(crs, dict) else crs
        return str(primary), str(columns[primary].get("encoding", "WKB")).lower(), _crs(text, layer_name)
    for field in table.schema:
        encoding = _extension_name(field)
        if encoding.startswith(("geoarrow.", "ogc.")):
            return field.name, encoding, _crs(_extension_crs(field), layer_name)
    raise InputError(
        f"The Arrow table of layer {layer_name!r} has no geometry column among {table.column_names[:20]}."
        " Mark one as geoarrow.wkb, or build a GeoDataFrame with geopandas.GeoSeries.from_wkb."
    )


def _extension_name(field: Any) -> str:
    if getattr(field.type, "extension_name", None):
        return str(field.type.extension_name)
    name: bytes = (field.metadata or {}).get(b"ARROW:extension:name", b"")
    return name.decode()


def _extension_crs(field: Any) -> str | None:
    if hasattr(field.type, "__arrow_ext_serialize__"):
        stored = field.type.__arrow_ext_serialize__()
    else:
        stored = (field.metadata or {}).get(b"ARROW:extension:metadata", b"")
    try:
        crs = json.loads(stored or b"{}").get("crs")
    except (ValueError, AttributeError):
        return None
    return json.dumps(crs) if isinstance(crs, dict) else crs


def _crs(text: str | None, layer_name: str) -> Any:
    return parse_crs(text, f"the crs of layer {layer_name!r}")


def _as_geoarrow(table: Any, field_name: str, encoding: str) -> Any:
    # GeoParquet names its nested encodings without the prefix and without the field's extension type.
    index = table.schema.get_field_index(field_name)
    field = table.schema.field(index)
    if _extension_name(field):
        return table.select([field_name])
    import pyarrow as pa

    metadata = {b"ARROW:extension:name": f"geoarrow.{encoding}".encode(), b"ARROW:extension:metadata": b"{}"}
    return pa.table(
        [table.column(field_name)],
        schema=pa.schema([pa.field(field_name, field.type, metadata=metadata)]),
    )
