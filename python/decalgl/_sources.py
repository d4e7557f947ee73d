"""Where features come from: one reader for each kind of input, all giving a `Source`.

    GeoDataFrame, GeoSeries, shapely ---+
    path --- pyogrio --- WKB -----------+--> shapely array --+
    Arrow table, GeoParquet ------------+                    +--> Source
    __geo_interface__ -------------------------> Ragged -----+
    (coords, offsets), FeatureTable -----------> Ragged -----+

geopandas, pyogrio and pyarrow are imported only by the input that needs them.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _nesting
from ._crs import parse_crs
from ._paths import Unpacked, gdal_name, real_file
from ._ragged import Ragged
from .errors import ColumnError, FileError, InputError, close_matches

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

PARQUET_SUFFIXES = (".parquet", ".geoparquet")
FEATHER_SUFFIXES = (".feather", ".arrow")


class Attributes:
    """The columns beside a layer's geometry, read when asked for; one value a row of the user's data.

    count: rows in the user's data, those without geometry included.
    names: the names of the columns.
    """

    def __init__(
        self, layer_name: str, count: int, names: Sequence[Any] = (), read: Callable[[Any], Any] | None = None
    ) -> None:
        self.layer_name, self.count, self.names, self._read = layer_name, count, tuple(names), read

    def raw(self, name: Any) -> Any:
        """The column as it is stored: a pandas Series (with its categories) or an array, length `count`.

        Raises ColumnError, which names close matches, when there is no such column.
        """
        if self._read is None or name not in self.names:
            known = ", ".join(repr(other) for other in self.names[:20]) or "none"
            more = ", ..." if len(self.names) > 20 else ""
            hint = close_matches(name, self.names)
            raise ColumnError(
                f"Layer {self.layer_name!r} has no column {name!r}.{hint} Its columns are: {known}{more}."
            )
        values = self._read(name)
        if getattr(values, "ndim", 1) != 1:
            raise ColumnError(f"Layer {self.layer_name!r} has several columns {name!r}; rename all but one.")
        return values

    def column(self, name: Any) -> NDArray[Any]:
        """The column as a NumPy array (count,). Raises ColumnError."""
        return np.asarray(self.raw(name))

    def numbers(self, value: Any, what: str) -> NDArray[np.float64]:
        """One number a row: `value` is a number, `count` numbers, or the name of a column; NaN where missing.

        what: the argument's name, for messages. Raises ColumnError and InputError.
        """
        found = self.raw(value) if isinstance(value, str) else value
        try:
            if hasattr(found, "to_numpy"):
                numbers = found.to_numpy(dtype=np.float64, na_value=np.nan)
            else:
                numbers = np.asarray(found, dtype=np.float64)
        except (TypeError, ValueError, OverflowError) as error:
            raise InputError(
                f"{what}={value!r} of layer {self.layer_name!r} must be numbers: {error}. Convert the column"
                " first."
            ) from error
        if numbers.ndim == 0:
            return np.full(self.count, float(numbers))
        if numbers.shape != (self.count,):
            raise InputError(
                f"{what} of layer {self.layer_name!r} has shape {numbers.shape}, but the layer has"
                f" {self.count} rows. Give one number, or one for each row."
            )
        return np.asarray(numbers, dtype=np.float64)

    def joined(self, more: Attributes) -> Attributes:
        """These rows and then those of `more`, which miss the columns that they have not."""
        names = list(dict.fromkeys((*self.names, *more.names)))

        def read(name: Any) -> NDArray[Any]:
            parts = [
                each.column(name) if name in each.names else np.full(each.count, np.nan)
                for each in (self, more)
                if each.count
            ]
            same_kind = len({part.dtype.kind in "iufb" for part in parts}) == 1
            return np.concatenate(parts if same_kind else [part.astype(object) for part in parts])

        return Attributes(self.layer_name, self.count + more.count, names, read)


@dataclass(frozen=True)
class Source:
    """What was read: shapely geometries, GeoJSON-like dicts or flat arrays, with their CRS and columns."""

    attributes: Attributes
    crs: Any = None
    shapes: NDArray[Any] | None = None
    interfaces: Sequence[Any] | None = None
    ragged: Ragged | None = None


def load(data: Any, layer_name: str, file_layer: str | int | None) -> Source:
    """Read `data` of any supported kind. Raises InputError, FileError or CrsError."""
    geopandas = sys.modules.get("geopandas")
    if geopandas is not None and isinstance(data, (geopandas.GeoDataFrame, geopandas.GeoSeries)):
        return _from_geopandas(data, layer_name, geopandas)
    if isinstance(data, (str, os.PathLike)):
        return _from_path(data, layer_name, file_layer)
    if is_plain(data):
        return _from_plain(data, layer_name)
    if _is_shapely(data):
        return _from_shapely(np.array([data], dtype=object), None, layer_name)
    if isinstance(data, Mapping) or hasattr(data, "__geo_interface__"):
        return _from_interface(data, layer_name)
    # A pandas Series of geometries streams to Arrow too, but is no table.
    if hasattr(data, "__arrow_c_stream__") and getattr(data, "ndim", 2) == 2:
        return _from_arrow(data, layer_name)
    if isinstance(data, Sequence) or hasattr(data, "__array__"):
        return _from_sequence(data, layer_name)
    raise _unknown(data, layer_name)


def _unknown(data: Any, layer_name: str, found: str | None = None) -> InputError:
    return InputError(
        f"Layer {layer_name!r} cannot be made from {found or 'a ' + type(data).__name__}. Give a"
        " GeoDataFrame, a GeoSeries, shapely geometries, an object with __geo_interface__, a path, an Arrow"
        " table with geometry, or a tuple (coords, offsets) of NumPy arrays."
    )


def _is_shapely(value: Any) -> bool:
    shapely = sys.modules.get("shapely")
    return shapely is not None and isinstance(value, shapely.Geometry)


def _from_geopandas(data: Any, layer_name: str, geopandas: Any) -> Source:
    if isinstance(data, geopandas.GeoSeries):
        return _from_shapely(np.asarray(data.array), data.crs, layer_name)
    try:
        geometry = data.geometry
    except AttributeError as error:
        raise InputError(
            f"The GeoDataFrame of layer {layer_name!r} has no active geometry. Name it with"
            " gdf.set_geometry(...)."
        ) from error
    names = [name for name in data.columns if name != geometry.name]
    attributes = Attributes(layer_name, len(data), names, lambda name: data[name])
    return Source(attributes, geometry.crs, shapes=np.asarray(geometry.array))


def _from_shapely(shapes: NDArray[Any], crs: Any, layer_name: str) -> Source:
    return Source(Attributes(layer_name, len(shapes)), crs, shapes=shapes)


def _from_sequence(data: Any, layer_name: str) -> Source:
    crs = getattr(data, "crs", None)  # a geopandas GeometryArray has one
    if isinstance(data, np.ndarray) and data.dtype != object:
        raise _unknown(data, layer_name, f"an array of {data.dtype} alone")
    import shapely

    # One by one, as NumPy would take lists and arrays apart.
    values: NDArray[Any] = np.fromiter(data, dtype=object, count=len(data))
    usable = shapely.is_valid_input(values)
    for row in np.flatnonzero(~usable).tolist():
        if _is_missing(values[row]):
            values[row], usable[row] = None, True
    if usable.all():
        return _from_shapely(values, crs, layer_name)
    for row in np.flatnonzero(~usable).tolist():
        if not (isinstance(values[row], Mapping) or hasattr(values[row], "__geo_interface__")):
            raise _unknown(
                data, layer_name, f"a {type(data).__name__} with a {type(values[row]).__name__} at row {row}"
            )
    return _from_features(values.tolist(), crs, layer_name)


def _is_missing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and value != value)


def _from_interface(data: Any, layer_name: str) -> Source:
    value = data if isinstance(data, Mapping) else data.__geo_interface__
    if not isinstance(value, Mapping):
        raise InputError(
            f"The __geo_interface__ of layer {layer_name!r} must be a dict, not a {type(value).__name__}."
        )
    if value.get("type") != "FeatureCollection":
        return _from_features([value], _legacy_crs(value, layer_name), layer_name)
    features = value.get("features")
    if not isinstance(features, (list, tuple)):
        raise InputError(f"The FeatureCollection of layer {layer_name!r} has no list of 'features'.")
    return _from_features(features, _legacy_crs(value, layer_name), layer_name)


def _legacy_crs(value: Mapping[str, Any], layer_name: str) -> Any:
    crs = value.get("crs")
    if not isinstance(crs, Mapping):
        return crs
    name = (crs.get("properties") or {}).get("name")
    return parse_crs(name, f"the crs of layer {layer_name!r}")


def _from_features(values: Sequence[Any], crs: Any, layer_name: str) -> Source:
    features = [
        None if _is_missing(v) else v if isinstance(v, Mapping) else v.__geo_interface__ for v in values
    ]
    geometries: list[Any] = []
    properties: list[Mapping[str, Any]] = []
    for feature in features:
        geometry: Any = feature
        columns: Mapping[str, Any] = {}
        if isinstance(feature, Mapping) and feature.get("type") == "Feature":
            geometry, columns = feature.get("geometry"), feature.get("properties") or {}
        if geometry is not None and not isinstance(geometry, Mapping):
            geometry = getattr(geometry, "__geo_interface__", geometry)
        geometries.append(dict(geometry) if isinstance(geometry, Mapping) else geometry)
        properties.append(columns)
    names = list(dict.fromkeys(name for row in properties for name in row))

    def read(name: Any) -> NDArray[Any]:
        column = [row.get(name) for row in properties]
        if all(
            (isinstance(value, (int, float)) and not isinstance(value, bool)) or value is None
            for value in column
        ):
            return np.array([np.nan if value is None else value for value in column], dtype=np.float64)
        array = np.empty(len(column), dtype=object)
        array[:] = column
        return array

    return Source(Attributes(layer_name, len(features), names, read), crs, interfaces=geometries)


def is_plain(data: Any) -> bool:
    """Whether `data` is (coords, offsets) or {"coords": ..., "offsets": ...}."""
    if isinstance(data, Mapping):
        return "coords" in data
    if not (isinstance(data, tuple) and len(data) == 2) or any(_is_shapely(value) for value in data):
        return False
    return not any(isinstance(value, Mapping) or hasattr(value, "__geo_interface__") for value in data)


def _from_plain(data: Any, layer_name: str) -> Source:
    if isinstance(data, Mapping):
        unknown = [key for key in data if key not in ("coords", "offsets")]
        if unknown or "offsets" not in data:
            raise InputError(
                f"The arrays of layer {layer_name!r} must be named 'coords' and 'offsets', not"
                f" {sorted(map(str, data))}."
            )
        data = (data["coords"], data["offsets"])
    try:
        coords = np.array(data[0], dtype=np.float64)  # a copy: the user's array may change later
        offsets = np.asarray(data[1])
    except (TypeError, ValueError) as error:
        raise InputError(
            f"The coords and offsets of layer {layer_name!r} must be numbers: {error}."
        ) from error
    if coords.ndim != 2 or coords.shape[1] not in (2, 3):
        raise InputError(
            f"The coords of layer {layer_name!r} must have shape (n, 2), but it is {coords.shape}."
        )
    whole = offsets.dtype.kind in "iu" and offsets.ndim == 1 and offsets.size > 0
    if not whole or offsets[0] != 0 or offsets[-1] != len(coords) or (offsets[1:] < offsets[:-1]).any():
        raise InputError(
            f"The offsets of layer {layer_name!r} must be integers that rise from 0 to the number of points "
            f"({len(coords)}): feature i has the points offsets[i] to offsets[i + 1]."
        )
    features = np.arange(offsets.size, dtype=np.int64)
    ragged = Ragged(np.ascontiguousarray(coords[:, :2]), offsets.astype(np.int64), features, features[:-1])
    return Source(Attributes(layer_name, offsets.size - 1), ragged=ragged)


def _from_path(data: Any, layer_name: str, file_layer: str | int | None) -> Source:
    name = os.fspath(data)
    path = real_file(name)
    if path is not None and not path.exists():
        raise FileError(f"There is no file {name!r} to read layer {layer_name!r} from. Check the path.")
    if path is not None and path.suffix.lower() in PARQUET_SUFFIXES + FEATHER_SUFFIXES:
        return _from_arrow(_arrow_file(path, name), layer_name)
    return _from_ogr(guarded_name(name), layer_name, file_layer)


def guarded_name(name: str) -> str:
    """`name` as GDAL takes it. Raises FileError for what would harm a parser: nesting without end, bombs."""
    path = real_file(name)
    if path is not None and path.is_file():
        try:
            with Unpacked(path) as stream:
                _nesting.check_json(stream, str(path))
                if stream.packed:
                    for _ in stream.rest():
                        pass
        except PermissionError as error:
            raise FileError(f"{name!r} cannot be read: {error.strerror}. Check its rights.") from error
    return gdal_name(name)


def _from_ogr(name: str, layer_name: str, file_layer: str | int | None) -> Source:
    import pyogrio

    layers = _read_with(pyogrio.list_layers, name)
    names = [str(layer) for layer, _ in layers]
    if file_layer is None:
        file_layer = _only_layer(name, layers)
    elif file_layer not in names and file_layer not in range(len(names)):
        hint = close_matches(file_layer, names)
        raise InputError(f"{name!r} has no layer {file_layer!r}.{hint} Its layers are: {', '.join(names)}.")
    meta, _, blobs, columns = _read_with(pyogrio.raw.read, name, layer=file_layer)
    if blobs is None:
        raise InputError(
            f"{name!r} holds a table without geometry, so there is nothing to draw. Choose another layer."
        )
    fields = {str(field): values for field, values in zip(meta["fields"], columns, strict=True)}
    attributes = Attributes(layer_name, len(blobs), list(fields), fields.__getitem__)
    return Source(attributes, meta["crs"], shapes=shapes_from_wkb(blobs, layer_name))


def _read_with(reader: Any, name: str, **options: Any) -> Any:
    import pyogrio

    try:
        return reader(name, **options)
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError, RuntimeError, ValueError) as error:
        raise FileError(
            f"{name!r} cannot be read as a vector layer: {error}. Give a whole file of a format that GDAL"
            " reads, such as GeoPackage, Shapefile or GeoJSON; ogrinfo shows what GDAL makes of it."
        ) from error


def shapes_from_wkb(blobs: NDArray[Any], layer_name: str) -> NDArray[Any]:
    """Shapely geometries of WKB (bytes or None), guarded against nesting. Raises InputError."""
    import shapely

    _nesting.check_wkb(blobs, layer_name)
    return _parsed(shapely.from_wkb, blobs, layer_name)


def shapes_from_wkt(texts: NDArray[Any], layer_name: str) -> NDArray[Any]:
    """Shapely geometries of WKT (str or None), guarded against nesting. Raises InputError."""
    import shapely

    _nesting.check_wkt(texts, layer_name)
    return _parsed(shapely.from_wkt, texts, layer_name)


def _parsed(parse: Any, values: NDArray[Any], layer_name: str) -> NDArray[Any]:
    import shapely

    shapes = np.asarray(parse(values, on_invalid="ignore"), dtype=object)
    given = np.array([value is not None for value in values], dtype=np.bool_)
    lost = given & shapely.is_missing(shapes)
    if lost.any():
        raise InputError(
            f"Layer {layer_name!r} has {int(lost.sum())} damaged geometries, the first at row"
            f" {int(np.flatnonzero(lost)[0])}. Write the layer anew from its source."
        )
    return shapes


def _only_layer(name: str, layers: Any) -> Any:
    drawn = [layer for layer, geometry in layers if geometry is not None]
    if len(drawn) > 1:
        listed = ", ".join(repr(str(layer)) for layer in drawn[:20])
        raise InputError(f"{name!r} has {len(drawn)} layers; choose one with layer=. They are: {listed}.")
    return drawn[0] if drawn else None


def _arrow_file(path: Path, name: str) -> Any:
    try:
        import pyarrow as pa
        from pyarrow import feather, parquet
    except ImportError as error:
        raise FileError(f"Reading {name!r} needs the package pyarrow: pip install pyarrow.") from error
    reader = parquet.read_table if path.suffix.lower() in PARQUET_SUFFIXES else feather.read_table
    try:
        return reader(path)
    except (pa.ArrowException, OSError) as error:
        raise FileError(f"{name!r} cannot be read: {error}. The file may be cut short or damaged.") from error


def _from_arrow(data: Any, layer_name: str) -> Source:
    from ._arrow import geometry_of

    table, field_name, shapes, crs = geometry_of(data, layer_name)
    names = [name for name in table.column_names if name != field_name]
    attributes = Attributes(layer_name, table.num_rows, names, lambda name: table.column(name).to_pandas())
    return Source(attributes, crs, shapes=shapes)


def geo_metadata(metadata: Mapping[bytes, bytes] | None) -> dict[str, Any]:
    """The GeoParquet description in a table's metadata, or an empty dict."""
    try:
        found = json.loads((metadata or {}).get(b"geo", b"{}"))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
