"""What the features of each prepared layer look like now, and what keywords of `Renderer.restyle` make of it.

A state is never changed: a restyle makes another one. Colours are kept as they were given; what is hidden or faded
is known apart, so that it can come back.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._choices import LayerRows
from ._colors import alpha_values, parse_color
from ._core_scene import core_hatch, core_style
from ._filters import Columns, rows_meant
from ._style_changes import FILL_STYLES, STROKE_STYLES, Styles, changed_hatches, changed_strokes
from ._width_changes import restyled_widths
from .coloring import Coloring, resolve_colors
from .errors import InputError, StyleError, UnsupportedError, close_matches
from .frame import KEEP_THE_DATA
from .scene import Layer, draw_order_by
from .techniques import Technique

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._sources import Attributes
    from .features import FeatureTable
    from .frame import PreparedLayer

COLOR_KEYWORDS = ("color", "column", "cmap", "vmin", "vmax", "norm", "alpha", "categorical", "missing_kwds")
DECAL_KEYWORDS = (*COLOR_KEYWORDS, "width")
KEYWORDS = (
    *DECAL_KEYWORDS,
    *STROKE_STYLES,
    *FILL_STYLES,
    "order",
    "visible",
    "opacity",
    "by",
    "where",
    "outline",
    "casing",
    "technique",
)
# Of layers and their outlines and casings; lists of what lies where are made for them.
PREPARED = ("cap", "slope_correction", "widest", "width_units", "mode")
# Of strokes and of fills.
STYLES_OF = ("styles", "hatches")


@dataclass(frozen=True, eq=False)
class DecalState:
    """Fills, strokes or casings of a layer.

    colors: uint8 (features, 4). widths: float64 (features) or None.
    coloring: what a legend says of them; None for casings, and for what was opened from a file.
    styles: of strokes, or hatches of fills; None for what was opened from a file.
    """

    colors: NDArray[np.uint8]
    widths: NDArray[np.float64] | None = None
    widest: float = 0.0
    coloring: Coloring | None = None
    styles: Styles | None = None


@dataclass(frozen=True, eq=False)
class LayerState:
    """The look of one layer.

    decals: by "fill", "stroke" and "casing", as far as there are any.
    shown: bool (features). opacity: float64 (features). Both None for all of it.
    technique: with other choices than it was prepared with; None for those.
    removed: features that edits removed. geometry: of those that edits moved, replaced or added.
    """

    layer: Layer | PreparedLayer
    rows: NDArray[np.int64]
    row_count: int
    attributes: Attributes | None
    by: str
    decals: Mapping[str, DecalState]
    shown: NDArray[np.bool_] | None = None
    opacity: NDArray[np.float64] | None = None
    draw_order: NDArray[np.int64] | None = None
    technique: Technique | None = None
    removed: frozenset[int] = frozenset()
    geometry: Mapping[int, FeatureTable] = field(default_factory=dict)

    @property
    def columns(self) -> Columns:
        return Columns(self.attributes, self.layer.name)

    def restyled(self, keywords: Mapping[str, Any]) -> LayerState:
        """The state after `keywords`. Raises StyleError, ColumnError and InputError that name the layer."""
        try:
            return _restyled(self, keywords)
        except StyleError as error:
            if repr(self.layer.name) in str(error):
                raise
            raise StyleError(f"Layer {self.layer.name!r}: {error}") from error

    def explained(self) -> Layer | PreparedLayer:
        """The layer as its legend has to explain it: in the colours and widths in force."""
        if not isinstance(self.layer, Layer):
            return self.layer
        return _explained(self, self.layer)

    def core_look(self, before: LayerState | None = None) -> _core.LayerLook:
        """As the core takes it; widths and order only where they differ from those of `before`."""
        look = _core.LayerLook()
        look.layer = self.layer.index
        for role, decal in self.decals.items():
            core = _core.DecalLook()
            core.colors = self._seen_colors(decal).reshape(-1)
            old = None if before is None else before.decals[role]
            if decal.widths is not None and (old is None or old.widths is not decal.widths):
                core.widths = decal.widths
            if decal.styles is not None and (old is None or old.styles is not decal.styles):
                _set_styles(core, decal.styles, role)
            setattr(look, role, core)
        if self.draw_order is not None and (before is None or before.draw_order is not self.draw_order):
            look.draw_order = self.draw_order
        if self.technique is not None and (before is None or before.technique is not self.technique):
            look.technique_options = self.technique.core_options()
        return look

    def style_look(self) -> _core.LayerLook | None:
        """The styles in force alone, or None where they are those of the layer as it was prepared."""
        look = _core.LayerLook()
        look.layer = self.layer.index
        changed = False
        for role, decal in self.decals.items():
            own = getattr(self.layer, role, None)
            if (
                decal.styles is None
                or own is None
                or decal.styles.values is getattr(own, STYLES_OF[role == "fill"])
            ):
                continue
            _set_styles(getattr(look, role), decal.styles, role)
            changed = True
        return look if changed else None

    def seen_shares(self) -> NDArray[np.float64]:
        """How much of each feature's colour is seen: opacity, and 0 for what is hidden."""
        shares = np.ones(len(self.rows)) if self.opacity is None else self.opacity
        return shares if self.shown is None else shares * self.shown

    def _seen_colors(self, decal: DecalState) -> NDArray[np.uint8]:
        if self.shown is None and self.opacity is None:
            return decal.colors
        colors: NDArray[np.uint8] = decal.colors.copy()
        if self.opacity is not None:
            colors[:, 3] = np.rint(colors[:, 3] * self.opacity).astype(np.uint8)
        if self.shown is not None:
            colors[:, 3] *= self.shown
        return colors


def _set_styles(look: _core.DecalLook, styles: Styles, role: str) -> None:
    if role == "fill":
        look.hatches = [core_hatch(each) for each in styles.values]
        if styles.place_of is not None:
            look.hatch_of = styles.place_of
        return
    look.styles = [core_style(each) for each in styles.values]
    if styles.place_of is not None:
        look.style_of = styles.place_of


def first_state(layer: Layer | PreparedLayer, look: _core.LayerLook) -> LayerState:
    """The state of a layer as it was prepared or opened; `look` is the core's answer."""
    rows = layer.rows
    scene_layer = layer if isinstance(layer, Layer) else None
    attributes = None if scene_layer is None else scene_layer.attributes
    count = attributes.count if attributes is not None else int(rows.max(initial=-1)) + 1
    decals = {}
    for role in ("fill", "stroke", "casing"):
        core = getattr(look, role)
        if core.colors.size:
            own = None if scene_layer is None else getattr(scene_layer, role)
            widths = core.widths if core.widths.size else getattr(own, "widths", None)
            coloring = _coloring_of(scene_layer, role)
            styles = None
            if own is not None:
                styles = (
                    Styles(own.hatches, own.hatch_of) if role == "fill" else Styles(own.styles, own.style_of)
                )
            decals[role] = DecalState(
                core.colors.reshape(-1, 4), widths, getattr(own, "widest", 0.0), coloring, styles
            )
    title = "" if scene_layer is None else scene_layer.coloring.title
    return LayerState(layer, rows, count, attributes, title, decals)


def _coloring_of(layer: Layer | None, role: str) -> Coloring | None:
    if layer is None or role == "casing":
        return None
    is_outline = layer.kind == "polygons" and role == "stroke"
    return layer.outline_coloring if is_outline else layer.coloring


def _explained(state: LayerState, layer: Layer) -> Layer:
    # Features that edits added have no place in the layer's table.
    count = len(layer.features)
    seen = state.seen_shares()[:count]
    main = "fill" if layer.kind == "polygons" else "stroke"
    parts: dict[str, Any] = {}
    for role, decal in state.decals.items():
        own = getattr(layer, role)
        widths = {} if decal.widths is None else {"widths": decal.widths[:count]}
        parts[role] = replace(
            own, colors=decal.colors[:count], **widths, **_explained_styles(decal, role, count)
        )
        if decal.coloring is not None:
            name = "coloring" if role == main else "outline_coloring"
            parts[name] = decal.coloring.seen(seen)
    return replace(layer, **parts)


def _explained_styles(decal: DecalState, role: str, count: int) -> dict[str, Any]:
    if decal.styles is None:
        return {}
    place_of = None if decal.styles.place_of is None else decal.styles.place_of[:count]
    names = (STYLES_OF[role == "fill"], "hatch_of" if role == "fill" else "style_of")
    return dict(zip(names, (decal.styles.values, place_of), strict=True))


def _restyled(state: LayerState, keywords: Mapping[str, Any]) -> LayerState:
    name = state.layer.name
    given = {key: value for key, value in keywords.items() if value is not None}
    require_known(given, KEYWORDS, name)
    where = None
    if "where" in given:
        where = rows_meant(given["where"], state.row_count, state.columns, name, "where")[state.rows]
    main = "fill" if "fill" in state.decals else "stroke"
    every = {role: wanted for role, wanted in _decal_keywords(state, main, given).items() if wanted}
    for role in every:
        if role not in state.decals:
            raise UnsupportedError(
                f"Layer {name!r} has no {role} that could look otherwise without preparing: it has none, or its"
                " technique keeps looks as they were. Use technique='static'."
            )
    decals = restyled_widths(state, every, where)
    for role, wanted in every.items():
        decals[role] = _restyled_decal(state, decals[role], wanted, where)
    result = replace(state, decals=decals)
    if "visible" in given:
        shown = rows_meant(given["visible"], state.row_count, state.columns, name, "visible")[state.rows]
        shown = _merged(state.shown, shown, True, where)
        result = replace(result, shown=None if shown.all() else shown)
    if "opacity" in given:
        opacity = _opacity(state, given["opacity"], given.get("by"))
        opacity = _merged(state.opacity, opacity, 1.0, where)
        result = replace(result, opacity=None if (opacity == 1.0).all() else opacity)
    if "technique" in given:
        result = replace(result, technique=_technique(state, given["technique"]))
    if "order" in given:
        result = replace(result, draw_order=_draw_order(state, given["order"]))
    return result


def _technique(state: LayerState, technique: Any) -> Technique:
    """The layer's own technique with other choices."""
    own = state.layer.technique if isinstance(state.layer, Layer) else None
    if not isinstance(technique, Technique) or own is None or type(own) is not type(technique):
        raise StyleError(
            f"technique= of a restyle must be the layer's own with other choices, but it is {technique!r}. Prepare the"
            " scene anew to draw the layer otherwise."
        )
    if not technique.restyles:
        raise StyleError(f"technique {technique.name!r} has no choices that a restyle could change.")
    technique.require_change_of(own)
    return technique.bound_to(state.layer.name, state.rows, state.attributes)


def require_known(given: Mapping[str, Any], known: tuple[str, ...], name: str) -> None:
    """Raises StyleError, with close matches, for a keyword that is not known."""
    for key in given:
        if key in PREPARED:
            raise StyleError(
                f"Layer {name!r}: {key}= is what the layer was prepared with. Change it where the layer is added, and"
                " call preprocess(scene)."
            )
        if key not in known:
            raise StyleError(
                f"Layer {name!r}: there is no keyword {key!r} here.{close_matches(key, known)} Known are"
                f" {', '.join(known)}."
            )


def _decal_keywords(state: LayerState, main: str, given: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Keywords by the decals that they are for."""
    own = (*DECAL_KEYWORDS, *(FILL_STYLES if main == "fill" else STROKE_STYLES))
    wanted: dict[str, Mapping[str, Any]] = {main: {key: given[key] for key in own if key in given}}
    for key in (*FILL_STYLES, *STROKE_STYLES):
        if key in given and key not in own:
            raise StyleError(
                f"Layer {state.layer.name!r}: {key}= is no style of {'fills' if main == 'fill' else 'lines'}."
                f"{' Give it to outline=.' if main == 'fill' else ''}"
            )
    for keyword, role in (("outline", "stroke"), ("casing", "casing")):
        if keyword not in given:
            continue
        if role not in state.decals or (keyword == "outline") != (state.layer.kind == "polygons"):
            raise StyleError(
                f"Layer {state.layer.name!r} has no {keyword} to restyle. Prepare it with one; it may be"
                " hidden until it is wanted."
            )
        if not isinstance(given[keyword], Mapping):
            raise StyleError(f"{keyword}= must be a dict of keywords such as {{'color': 'red'}}.")
        wanted[role] = {key: value for key, value in given[keyword].items() if value is not None}
        styles = STROKE_STYLES if role == "stroke" else ("dash",)
        require_known(wanted[role], (*DECAL_KEYWORDS, *styles), state.layer.name)
    # Casings turn as their lines do.
    turns = {key: given[key] for key in ("corner", "miter_limit") if key in given}
    if turns and "casing" in state.decals:
        wanted["casing"] = {**wanted.get("casing", {}), **turns}
    return wanted


def _restyled_decal(
    state: LayerState, decal: DecalState, wanted: Mapping[str, Any], where: NDArray[np.bool_] | None
) -> DecalState:
    colors, coloring = _colors(state, decal, wanted)
    if where is not None:
        # Rows that are marked are no part of what the legend explains.
        colors, coloring = np.where(where[:, None], colors, decal.colors), decal.coloring
    decal = replace(decal, colors=colors, coloring=coloring)
    if any(key in wanted for key in (*STROKE_STYLES, *FILL_STYLES)):
        decal = replace(decal, styles=_styles(state, decal, wanted, where))
    return decal


def _styles(
    state: LayerState, decal: DecalState, wanted: Mapping[str, Any], where: NDArray[np.bool_] | None
) -> Styles:
    if not isinstance(state.layer, Layer) or state.attributes is None or decal.styles is None:
        raise UnsupportedError(
            f"Layer {state.layer.name!r} comes from a saved scene, which keeps no styles to change."
            f" {KEEP_THE_DATA}"
        )
    if state.layer.technique.name != "static":
        raise StyleError(
            f"technique {state.layer.technique.name!r} keeps the styles that it was prepared with. Use"
            " technique='static'."
        )
    column = wanted.get("column", state.by)
    rows = LayerRows(state.layer.name, state.attributes, state.rows, np.inf, column)
    if "hatch" in wanted:
        return changed_hatches(decal.styles, wanted["hatch"], rows, where)
    assert decal.widths is not None
    return changed_strokes(decal.styles, wanted, rows, decal.widths, where)


def _colors(
    state: LayerState, decal: DecalState, wanted: Mapping[str, Any]
) -> tuple[NDArray[np.uint8], Coloring | None]:
    """Colours, and what a legend says of them."""
    coloring = {key: wanted[key] for key in COLOR_KEYWORDS if key in wanted}
    if not coloring:
        return decal.colors, decal.coloring
    if coloring.keys() == {"alpha"}:
        opacity = alpha_values(coloring["alpha"], state.row_count)
        assert opacity is not None
        colors: NDArray[np.uint8] = decal.colors.copy()
        alpha = np.broadcast_to(opacity, state.row_count)[state.rows]
        colors[:, 3] = np.where(colors[:, 3] > 0, np.rint(255.0 * alpha), 0).astype(np.uint8)
        if opacity.ndim or decal.coloring is None:
            return colors, decal.coloring
        return colors, decal.coloring.with_alpha(float(opacity))
    if "color" not in coloring and "column" not in coloring:
        coloring["column"] = _column_of(state, None, "color")
    if coloring.keys() == {"color"} and (one := parse_color(coloring["color"], strict=False)) is not None:
        channels = np.rint(np.array(one) * 255.0).astype(np.uint8)
        colors = np.tile(channels, (len(state.rows), 1))
        return colors, _following(decal.coloring, Coloring(colors, "single", label_colors=channels[None]))
    resolved = resolve_colors(state.row_count, state.attributes, rows=state.rows, **coloring)
    return resolved.colors, _following(decal.coloring, resolved)


def _following(before: Coloring | None, after: Coloring) -> Coloring | None:
    """`after` with the legend that was asked for; how it was to look goes for the same column alone."""
    if before is None:
        return None
    same = before.kind == after.kind and before.title == after.title
    return replace(after, legend=before.legend, legend_kwds=before.legend_kwds if same else {})


def _column_of(state: LayerState, by: Any, keyword: str) -> Any:
    if by is not None:
        return by
    if not state.by:
        raise StyleError(
            f"{keyword}= goes by a column, but the layer was not coloured by one. Name it with"
            f" {'column=' if keyword == 'color' else 'by='}."
        )
    return state.by


def _opacity(state: LayerState, opacity: Any, by: Any) -> NDArray[np.float64]:
    if not isinstance(opacity, Mapping):
        values = alpha_values(opacity, state.row_count)
        assert values is not None
        return np.array(np.broadcast_to(values, state.row_count)[state.rows])
    column = _column_of(state, by, "opacity")
    categories = state.columns[column] if isinstance(column, str) else np.asarray(column)
    if categories.shape != (state.row_count,):
        raise StyleError(
            f"by= has shape {categories.shape}, but the layer has {state.row_count} rows. Give one value a row."
        )
    result = np.ones(len(state.rows))
    own = categories[state.rows]
    for category, value in opacity.items():
        is_category = np.asarray(own == category, dtype=np.bool_)
        one = alpha_values(value, 0)
        assert one is not None
        result[is_category] = float(one)
    unknown = [category for category in opacity if not (categories == category).any()]
    if unknown:
        known = list(dict.fromkeys(map(str, categories.tolist())))
        raise StyleError(
            f"opacity= names {unknown[0]!r}, which no row has.{close_matches(str(unknown[0]), known)}"
        )
    return result


def _merged(before: Any, wanted: Any, default: Any, where: NDArray[np.bool_] | None) -> Any:
    if where is None:
        return np.array(wanted)
    return np.where(where, wanted, default if before is None else before)


def _draw_order(state: LayerState, order: Any) -> NDArray[np.int64]:
    if isinstance(state.layer, Layer) and state.attributes is not None:
        if isinstance(order, str) and order == "feature":
            return np.arange(len(state.rows), dtype=np.int64)
        if isinstance(order, str) and order == "size":
            return _core.ascending(_sizes(state, state.layer))
        return draw_order_by(order, state.rows, state.attributes)
    if isinstance(order, str):
        if order == "feature":
            return np.arange(len(state.rows), dtype=np.int64)
        raise InputError(
            f"Layer {state.layer.name!r} comes from a saved scene, which keeps no columns. {KEEP_THE_DATA} Or"
            " give one number a row."
        )
    keys = np.asarray(order, dtype=np.float64)
    if keys.shape != (state.row_count,):
        raise InputError(f"order= has shape {keys.shape}, but the layer has {state.row_count} rows.")
    return _core.ascending(keys[state.rows])


def _sizes(state: LayerState, layer: Layer) -> NDArray[np.float64]:
    sizes = np.zeros(len(state.rows))
    sizes[: len(layer.features)] = layer.features.sizes()
    for feature, table in state.geometry.items():
        sizes[feature] = table.sizes()[0]
    return sizes
