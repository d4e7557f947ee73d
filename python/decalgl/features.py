"""Vector features as flat arrays on the scene's plane, from every kind of input that GIS people have.

read_features(data, "polygons", terrain_crs=terrain.crs, layer_name="parks")
    load        file, frame, geometry, table     ->  geometries, CRS, columns
    flatten     vectorised                        ->  coords, part_offsets, feature_offsets
    clean       degenerate parts                  ->  one warning with all counts
    reproject   differing CRS                     ->  FeatureTable in metres of the scene
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _ragged, _sources
from ._crs import name_of, parse_crs, same_crs, transform_xy
from ._ragged import Ragged
from ._sources import Attributes
from .errors import CrsError, InputError, warn

if TYPE_CHECKING:
    import pyproj
    from numpy.typing import NDArray

__all__ = ["Attributes", "FeatureTable", "Kind", "read_features"]

Kind = Literal["polygons", "lines"]
LARGEST_COORDINATE = 1e9
log = logging.getLogger("decalgl")


@dataclass(frozen=True, eq=False)
class FeatureTable:
    """Features of one layer as flat arrays, in the scene's plane; the arrays are made read-only.

    kind: "polygons" or "lines".
    coords: float64 (points, 2), metres.
    part_offsets: int64 (parts + 1), part i has the points part_offsets[i] to part_offsets[i + 1].
    feature_offsets: int64 (features + 1) into the parts.
    rows: int64 (features), each feature's row in the user's data; skipped rows leave gaps.

    A polygon's parts are all its rings, outer ones and holes of every member, closed implicitly; a line's
    parts are its polylines. Raises InputError when the arrays do not fit together.
    """

    kind: Kind
    coords: NDArray[np.float64] = field(repr=False)
    part_offsets: NDArray[np.int64] = field(repr=False)
    feature_offsets: NDArray[np.int64] = field(repr=False)
    rows: NDArray[np.int64] = field(repr=False)

    def __post_init__(self) -> None:
        if self.kind not in ("polygons", "lines"):
            raise InputError(f"kind must be 'polygons' or 'lines', but it is {self.kind!r}.")
        for name, kind in (
            ("coords", np.float64),
            ("part_offsets", np.int64),
            ("feature_offsets", np.int64),
            ("rows", np.int64),
        ):
            array = np.ascontiguousarray(getattr(self, name), dtype=kind).view()
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        if self.coords.ndim != 2 or self.coords.shape[1] != 2:
            raise InputError(f"coords must have shape (points, 2), but it is {self.coords.shape}.")
        _check_offsets("part_offsets", self.part_offsets, len(self.coords), "points")
        _check_offsets("feature_offsets", self.feature_offsets, len(self.part_offsets) - 1, "parts")
        if self.rows.shape != (len(self.feature_offsets) - 1,) or (self.rows < 0).any():
            raise InputError(
                f"rows must hold one row number, 0 or more, for each of the {len(self.feature_offsets) - 1}"
                " features."
            )

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def bounds(self) -> tuple[float, float, float, float] | None:
        """(xmin, ymin, xmax, ymax) of all points in metres, None without points."""
        if len(self.coords) == 0:
            return None
        (xmin, ymin), (xmax, ymax) = self.coords.min(axis=0), self.coords.max(axis=0)
        return (float(xmin), float(ymin), float(xmax), float(ymax))

    def sizes(self) -> NDArray[np.float64]:
        """How large each feature is, float64 (features): lengths of lines in metres, areas in m^2.

        Areas take holes off for features that `read_features` made; rings of other tables count by their
        turning.
        """
        if len(self.coords) == 0:
            return np.zeros(len(self))
        if self.kind == "polygons":
            filled = np.flatnonzero(np.diff(self.part_offsets) > 0)
            by_part = np.zeros(len(self.part_offsets) - 1)
            offsets = np.append(self.part_offsets[:-1][filled], len(self.coords))
            by_part[filled] = _ragged.signed_areas(self.coords, offsets)
            return np.abs(_sums(by_part, self.feature_offsets))
        steps = np.zeros(len(self.coords))
        steps[1:] = np.hypot(*np.diff(self.coords, axis=0).T)
        starts = self.part_offsets[:-1]
        steps[starts[starts < len(steps)]] = 0.0
        return _sums(steps, self.part_offsets[self.feature_offsets])


def _check_offsets(name: str, offsets: NDArray[np.int64], end: int, what: str) -> None:
    whole = offsets.ndim == 1 and offsets.size > 0
    if not whole or offsets[0] != 0 or offsets[-1] != end or (offsets[1:] < offsets[:-1]).any():
        raise InputError(f"{name} must rise from 0 to the number of {what}, {end}.")


def _sums(values: NDArray[np.float64], offsets: NDArray[np.int64]) -> NDArray[np.float64]:
    """Sums of consecutive runs of `values`; a run by itself, so that small ones keep their digits."""
    sums = np.zeros(len(offsets) - 1)
    filled = np.flatnonzero(np.diff(offsets) > 0)
    if filled.size:
        sums[filled] = np.add.reduceat(values, offsets[:-1][filled])
    return sums


def read_features(
    data: Any,
    kind: Kind,
    *,
    terrain_crs: pyproj.CRS | None,
    layer_name: str,
    crs: Any = None,
    layer: str | int | None = None,
) -> tuple[FeatureTable, Attributes]:
    """The polygons or lines in `data`, as flat arrays on the scene's plane, and the columns beside them.

    data: a GeoDataFrame, GeoSeries, shapely geometries (one, a list or an array), anything with
        __geo_interface__ or GeoJSON-like dicts, a path that pyogrio or pyarrow reads, an Arrow table with
        GeoArrow or GeoParquet geometry, plain NumPy (coords (n, 2), offsets (features + 1)) or {"coords":
        ..., "offsets": ...} with one ring or polyline a feature, or a FeatureTable.
    kind: "polygons" or "lines"; a layer holds one of the two.
    terrain_crs: the scene's CRS. A layer in another is reprojected; a layer without one is an error, except
        plain NumPy and FeatureTables, which are taken to be in the scene's.
    layer_name: for messages.
    crs: the CRS of data that carries none.
    layer: the layer to read of a file with several.

    Left out, with one DecalWarning that counts them: null and empty geometries, rings of fewer than three
    distinct points, lines without a point. Z is dropped. Raises CrsError, FileError, and InputError (other
    or mixed types, collections, NaN or infinite coordinates, coordinates beyond 1e9 m).
    """
    if kind not in ("polygons", "lines"):
        raise InputError(f"kind must be 'polygons' or 'lines', but it is {kind!r}.")
    source = _table_source(data, kind, layer_name) if isinstance(data, FeatureTable) else None
    plain = source is not None or _sources.is_plain(data)
    source = source or _sources.load(data, layer_name, layer)
    layer_crs = _layer_crs(source.crs, crs, terrain_crs, layer_name, plain)
    ragged, null, empty = _flatten(source, kind, layer_name)
    _check_finite(ragged, layer_name)
    ragged = _cleaned(ragged, kind, layer_name, source.attributes.count, null, empty)
    if layer_crs is not None and terrain_crs is not None and not same_crs(layer_crs, terrain_crs):
        ragged = _reprojected(ragged, layer_crs, terrain_crs, layer_name)
    _check_range(ragged, layer_name)
    ragged = _ragged.orient(ragged)
    table = FeatureTable(kind, ragged.coords, ragged.part_offsets, ragged.feature_offsets, ragged.rows)
    return table, source.attributes


def _table_source(table: FeatureTable, kind: Kind, layer_name: str) -> _sources.Source:
    if table.kind != kind:
        raise InputError(
            f"Layer {layer_name!r} is a FeatureTable of {table.kind}. Draw it with add_{table.kind} instead"
            f" of add_{kind}."
        )
    count = int(table.rows.max()) + 1 if len(table) else 0
    ragged = Ragged(table.coords, table.part_offsets, table.feature_offsets, table.rows)
    return _sources.Source(Attributes(layer_name, count), ragged=ragged)


def _layer_crs(
    own: Any, given: Any, terrain_crs: pyproj.CRS | None, layer_name: str, plain: bool
) -> pyproj.CRS | None:
    stored = parse_crs(own, f"the crs of layer {layer_name!r}")
    named = parse_crs(given, f"the argument crs= of layer {layer_name!r}")
    if stored is not None and named is not None and not same_crs(stored, named):
        raise CrsError(
            f"Layer {layer_name!r} is in {name_of(stored)}, but crs={name_of(named)} was given. Leave crs="
            " out, or correct the layer with gdf.set_crs(..., allow_override=True)."
        )
    found = stored if stored is not None else named
    if terrain_crs is None and found is not None:
        raise CrsError(
            f"Layer {layer_name!r} is in {name_of(found)}, but the terrain has no CRS, so the two cannot be"
            " brought together. Give the terrain its CRS (crs= of Terrain), or drop the layer's with"
            " gdf.set_crs(None, allow_override=True)."
        )
    if terrain_crs is not None and found is None and not plain:
        raise CrsError(
            f"Layer {layer_name!r} has no CRS, but the terrain is in {name_of(terrain_crs)}. Say which CRS"
            " its coordinates are in: gdf.set_crs('EPSG:4326'), or crs='EPSG:4326' for longitude and"
            " latitude."
        )
    return found


def _flatten(source: _sources.Source, kind: Kind, layer_name: str) -> tuple[Ragged, int, int]:
    if source.ragged is not None:
        return source.ragged, 0, 0
    if source.interfaces is not None:
        return _ragged.from_interfaces(source.interfaces, kind, layer_name)
    assert source.shapes is not None
    return _ragged.from_shapely(source.shapes, kind, layer_name)


def _check_finite(ragged: Ragged, layer_name: str) -> None:
    wrong = ~np.isfinite(ragged.coords).all(axis=1)
    if wrong.any():
        point = int(np.flatnonzero(wrong)[0])
        x, y = ragged.coords[point].tolist()
        raise InputError(
            f"Layer {layer_name!r} has {int(wrong.sum())} points with NaN or infinite coordinates, the first"
            f" ({x}, {y}) in the feature at row {ragged.row_of_point(point)}. Repair or drop these features."
        )


def _reprojected(ragged: Ragged, source: pyproj.CRS, target: pyproj.CRS, layer_name: str) -> Ragged:
    log.info("layer %r: reprojected from %s to %s", layer_name, name_of(source), name_of(target))
    moved = transform_xy(source, target, ragged.coords)
    lost = ~np.isfinite(moved).all(axis=1)
    if lost.any():
        point = int(np.flatnonzero(lost)[0])
        x, y = ragged.coords[point].tolist()
        raise CrsError(
            f"Layer {layer_name!r} has {int(lost.sum())} points that {name_of(target)} cannot show, the first"
            f" ({x:.10g}, {y:.10g}) in the feature at row {ragged.row_of_point(point)}. Check that the layer"
            f" is in {name_of(source)}, or cut it to the terrain's surroundings first (gdf.cx or gdf.clip)."
        )
    return replace(ragged, coords=moved)


def _check_range(ragged: Ragged, layer_name: str) -> None:
    wrong = (np.abs(ragged.coords) > LARGEST_COORDINATE).any(axis=1)
    if wrong.any():
        point = int(np.flatnonzero(wrong)[0])
        x, y = ragged.coords[point].tolist()
        raise InputError(
            f"Layer {layer_name!r} has {int(wrong.sum())} points farther than {LARGEST_COORDINATE:g} m from"
            f" the origin, the first ({x:g}, {y:g}) in the feature at row {ragged.row_of_point(point)}. Check"
            " the layer's CRS."
        )


def _cleaned(ragged: Ragged, kind: Kind, layer_name: str, count: int, null: int, empty: int) -> Ragged:
    if kind == "polygons":
        ragged = _ragged.drop_closing_points(ragged)
        keep = _ragged.has_area(ragged)
    else:
        keep = np.diff(ragged.part_offsets) > 0
    skipped, vanished = 0, 0
    if not keep.all() or (np.diff(ragged.feature_offsets) == 0).any():
        skipped = int((~keep).sum())
        ragged, vanished = _ragged.keep_parts(ragged, keep)
    _warn_of_gaps(kind, layer_name, count, null, empty, skipped, vanished)
    return ragged


def _warn_of_gaps(
    kind: Kind, layer_name: str, count: int, null: int, empty: int, skipped: int, vanished: int
) -> None:
    part = "rings of fewer than three distinct points" if kind == "polygons" else "lines without points"
    reasons = [f"{null} null geometries"] * (null > 0) + [f"{empty} empty geometries"] * (empty > 0)
    reasons += [f"{skipped} {part}"] * (skipped > 0)
    if not reasons and not vanished:
        return
    gone = null + empty + vanished
    warn(
        f"Layer {layer_name!r}: {gone} of {count} features are not drawn; left out were "
        f"{', '.join(reasons) or 'features without parts'}."
    )
