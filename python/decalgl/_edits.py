"""Edits of one layer: features that go, come, move or get another geometry, as the core takes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._looks import COLOR_KEYWORDS, DecalState, LayerState, require_known
from ._sources import Attributes
from ._width_changes import casing_sides
from .coloring import resolve_colors
from .errors import InputError, StyleError, UnsupportedError
from .features import FeatureTable, read_features
from .frame import KEEP_THE_DATA
from .scene import Layer

if TYPE_CHECKING:
    import pyproj
    from numpy.typing import NDArray

ADD_KEYWORDS = (*COLOR_KEYWORDS, "width", "crs")


@dataclass(frozen=True, eq=False)
class Edited:
    """What an edit makes of a layer: its state, what the core is given, and the rows of what was added."""

    state: LayerState
    core: _core.LayerEdit
    rows: NDArray[np.int64]


def edited(
    state: LayerState,
    terrain_crs: pyproj.CRS | None,
    add: Any,
    remove: Any,
    move: Mapping[int, Any] | None,
    replacing: Mapping[int, Any] | None,
    style: Mapping[str, Any],
) -> Edited:
    """Renderer.edit. Raises what `Scene.add_lines` raises, and InputError for rows that are not there."""
    name = state.layer.name
    if not isinstance(state.layer, Layer):
        raise UnsupportedError(
            f"Layer {name!r} comes from a saved scene, which keeps no vertices to edit. {KEEP_THE_DATA}"
        )
    given = {key: value for key, value in style.items() if value is not None}
    require_known(given, ADD_KEYWORDS, name)
    removed = _features_of(state, [] if remove is None else remove, "remove")
    shifts, geometries = _checked_mapping(move, "move"), _checked_mapping(replacing, "replace")
    replaced: dict[int, FeatureTable] = {}
    for feature, shift in zip(
        _features_of(state, list(shifts), "move").tolist(), shifts.values(), strict=True
    ):
        replaced[feature] = _moved(state, feature, shift)
    places = _features_of(state, list(geometries), "replace").tolist()
    for feature, given_geometry in zip(places, geometries.values(), strict=True):
        if feature in replaced:
            row = int(state.rows[feature])
            raise InputError(f"Layer {name!r}: row {row} is moved and replaced. Give one of the two.")
        replaced[feature] = _geometry_of(state, given_geometry, terrain_crs, given.get("crs"))
    both = set(removed.tolist()) & set(replaced)
    if both:
        row = int(state.rows[min(both)])
        raise InputError(f"Layer {name!r}: row {row} is removed and changed. Give one of the two.")
    table, attributes = _added(state, add, terrain_crs, given)
    core = _core_edit(state, removed, replaced, table)
    result = _extended(state, table, attributes, given)
    for role, decal in result.decals.items():
        look = _core.DecalLook()
        look.colors = decal.colors[len(state.rows) :].reshape(-1)
        if decal.widths is not None:
            look.widths = decal.widths[len(state.rows) :]
        setattr(core, role, look)
    first = len(state.rows)
    geometry = {**state.geometry, **replaced}
    geometry.update({first + i: _one(table, i) for i in range(len(table))})
    result = replace(result, removed=state.removed | set(removed.tolist()), geometry=geometry)
    return Edited(result, core, result.rows[first:])


def _checked_mapping(given: Any, keyword: str) -> Mapping[int, Any]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InputError(f"{keyword}= must be a dict {{row: ...}}, not a {type(given).__name__}.")
    return given


def _features_of(state: LayerState, rows: Any, keyword: str) -> NDArray[np.int64]:
    """The features of some rows. Raises InputError for rows without one, and for one that comes twice."""
    wanted = np.atleast_1d(np.asarray(rows))
    if wanted.size == 0:
        return np.zeros(0, np.int64)
    what = f"Layer {state.layer.name!r}: {keyword}="
    if wanted.dtype.kind not in "iu" or wanted.ndim != 1:
        raise InputError(f"{what} must name rows by whole numbers, not by {wanted.dtype}.")
    # Rows rise, since features are read in the order of the data and added at the end.
    found = np.minimum(np.searchsorted(state.rows, wanted), len(state.rows) - 1)
    missing = state.rows[found] != wanted
    missing |= np.isin(found, np.fromiter(state.removed, np.int64, len(state.removed)))
    if missing.any():
        raise InputError(f"{what} names row {wanted[missing][0]}, which has no feature.")
    if len(np.unique(found)) < len(found):
        raise InputError(f"{what} names a row twice.")
    return found.astype(np.int64)


def _table_of(state: LayerState, feature: int) -> FeatureTable:
    """One feature as it is now."""
    if feature in state.geometry:
        return state.geometry[feature]
    assert isinstance(state.layer, Layer)
    return _one(state.layer.features, feature)


def _one(table: FeatureTable, feature: int) -> FeatureTable:
    first, last = table.feature_offsets[feature : feature + 2]
    parts = table.part_offsets[first : last + 1]
    return FeatureTable(
        table.kind,
        table.coords[parts[0] : parts[-1]],
        parts - parts[0],
        np.array([0, last - first]),
        np.zeros(1, np.int64),
    )


def _moved(state: LayerState, feature: int, shift: Any) -> FeatureTable:
    table = _table_of(state, feature)
    try:
        step = np.array(shift, dtype=np.float64)
    except (TypeError, ValueError):
        step = np.full(2, np.nan)
    if step.shape != (2,) or not np.isfinite(step).all():
        raise InputError(
            f"Layer {state.layer.name!r}: move= of row {state.rows[feature]} must be (dx, dy) in metres, not"
            f" {shift!r}."
        )
    return replace(table, coords=table.coords + step)


def _geometry_of(state: LayerState, geometry: Any, terrain_crs: pyproj.CRS | None, crs: Any) -> FeatureTable:
    given = geometry if isinstance(geometry, (tuple, Mapping)) else [geometry]
    crs = terrain_crs if crs is None else crs
    table, _ = read_features(
        given, state.layer.kind, terrain_crs=terrain_crs, layer_name=state.layer.name, crs=crs
    )
    if len(table) != 1:
        raise InputError(
            f"Layer {state.layer.name!r}: replace= needs one feature for each row, not {len(table)}. Use"
            " remove= for a row without geometry."
        )
    return table


def _added(
    state: LayerState, add: Any, terrain_crs: pyproj.CRS | None, given: Mapping[str, Any]
) -> tuple[FeatureTable, Attributes]:
    kind, name = state.layer.kind, state.layer.name
    if add is None:
        if given.keys() - {"crs"}:
            raise InputError(f"Layer {name!r}: colours and widths are those of what is added. Give add= too.")
        nothing = FeatureTable(
            kind, np.zeros((0, 2)), np.zeros(1, np.int64), np.zeros(1, np.int64), np.zeros(0, np.int64)
        )
        return nothing, Attributes(name, 0)
    crs = given.get("crs")
    # Bare geometries come from picks and from frame.world more often than from elsewhere.
    is_bare = (hasattr(add, "geom_type") or isinstance(add, (list, np.ndarray))) and not hasattr(add, "crs")
    if crs is None and is_bare:
        crs = terrain_crs
    return read_features(add, kind, terrain_crs=terrain_crs, layer_name=name, crs=crs)


def _core_edit(
    state: LayerState,
    removed: NDArray[np.int64],
    replaced: Mapping[int, FeatureTable],
    added: FeatureTable,
) -> _core.LayerEdit:
    tables = [*replaced.values(), added]
    points = np.cumsum([0, *(len(table.coords) for table in tables)])
    parts = np.cumsum([0, *(len(table.part_offsets) - 1 for table in tables)])
    rows = [state.rows[list(replaced)], state.row_count + added.rows]
    return _core.LayerEdit(
        state.layer.index,
        state.layer.kind == "polygons",
        removed.astype(np.uint32),
        np.array(list(replaced), dtype=np.uint32),
        np.concatenate([table.coords for table in tables]),
        np.concatenate(
            [[0], *(table.part_offsets[1:] + start for table, start in zip(tables, points, strict=False))]
        ).astype(np.int64),
        np.concatenate(
            [[0], *(table.feature_offsets[1:] + start for table, start in zip(tables, parts, strict=False))]
        ).astype(np.int64),
        np.concatenate(rows).astype(np.int64),
    )


def _extended(
    state: LayerState, table: FeatureTable, attributes: Attributes, given: Mapping[str, Any]
) -> LayerState:
    """The state with what was added at the end: on top of the layer, shown, and opaque."""
    count = len(table)
    if attributes.count == 0:
        return state
    decals: dict[str, DecalState] = {}
    main = "fill" if "fill" in state.decals else "stroke"
    for role, decal in state.decals.items():
        own = given if role == main else {}
        colors = _added_colors(state, decal, table, attributes, own)
        widths = None
        if role == "casing":
            line = decals["stroke"].widths
            assert line is not None
            widths = line[len(state.rows) :] + 2.0 * _same_for_all(casing_sides(state), len(table), "casings")
        elif decal.widths is not None:
            widths = _added_widths(decal, table, attributes, own)
        decals[role] = replace(
            decal,
            colors=np.concatenate([decal.colors, colors]),
            widths=None if widths is None else np.concatenate([decal.widths, widths]),
            styles=None if decal.styles is None else decal.styles.extended(len(table)),
        )
    before, rows = len(state.rows), np.concatenate([state.rows, state.row_count + table.rows])
    order = state.draw_order
    return replace(
        state,
        rows=rows,
        row_count=state.row_count + attributes.count,
        attributes=None if state.attributes is None else state.attributes.joined(attributes),
        decals=decals,
        shown=None if state.shown is None else np.concatenate([state.shown, np.ones(count, np.bool_)]),
        opacity=None if state.opacity is None else np.concatenate([state.opacity, np.ones(count)]),
        draw_order=None if order is None else np.concatenate([order, np.arange(before, len(rows))]),
    )


def _added_colors(
    state: LayerState,
    decal: DecalState,
    table: FeatureTable,
    attributes: Attributes,
    given: Mapping[str, Any],
) -> NDArray[np.uint8]:
    coloring = {key: given[key] for key in COLOR_KEYWORDS if key in given}
    if coloring:
        return resolve_colors(attributes.count, attributes, rows=table.rows, **coloring).colors
    if len(table) and (decal.colors != decal.colors[0]).any():
        raise StyleError(
            f"Layer {state.layer.name!r} has several colours, so what is added needs its own. Give color=, or"
            " column= with cmap=."
        )
    return np.tile(decal.colors[:1], (len(table), 1))


def _same_for_all(widths: NDArray[np.float64], count: int, what: str) -> NDArray[np.float64]:
    if count and len(widths) and np.ptp(widths) > 1e-9 * widths.max():
        needed = "width=" if what == "lines" else "a layer of its own"
        raise StyleError(f"the layer's {what} have several widths, so what is added needs {needed}.")
    return np.full(count, widths[0] if len(widths) else 0.0)


def _added_widths(
    decal: DecalState, table: FeatureTable, attributes: Attributes, given: Mapping[str, Any]
) -> NDArray[np.float64]:
    assert decal.widths is not None
    if "width" not in given:
        return _same_for_all(decal.widths, len(table), "lines")
    widths = attributes.numbers(given["width"], "width")[table.rows]
    most = decal.widest if decal.widest > 0.0 else np.inf
    if not ((widths > 0.0) & (widths <= most) & (widths < np.inf)).all():
        raise StyleError("every width of what is added must be above 0, and at most what widest= says.")
    return widths
