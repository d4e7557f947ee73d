"""Networks by distance fields: docs/techniques/distance_field.md (Trapp et al. 2015).

scene.add_lines(roads, technique=DistanceField(category="highway", styles=road_styles("germany")))
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from . import _core
from ._values import flag, is_listed, is_word
from .errors import StyleError, close_matches
from .networks import Lod, NetworkCategory, NetworkStyle
from .techniques import Technique

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._sources import Attributes

MOST_CATEGORIES = 64
WORDS = {
    "widths_at": ("fragment", "vertex"),
    "drop_off": ("texture", "exact"),
    "blending": ("minimum", "nearest"),
    "borders": ("over", "under", "smooth"),
}


@dataclass(frozen=True, eq=False)
class DistanceField(Technique):
    """A network of lines drawn by a distance field for each category.

    category: each row's category: a column's name, or one value a row. None: features that look the same, by the
        layer's own colours, widths and casing, are a category, those of the first feature in the draw order lowest.
    styles: {category: NetworkCategory, NetworkStyle or [(lod, style), ...]}, the lowest rank first. The key None is
        for rows of other categories, which are not drawn without it. The layer's own width and colour are not read.
    highlight: rows that lie over all others as a category of their own, which looks like highlight_style.
    lod: a `Lod`: which level of detail of the styles holds where.
    widths_at: where widths take their level of detail from: each "fragment", or the line's "vertex" nodes.
    bits: of a texel of a field: 8, as published, or 32.
    drop_off: distances come from "texture"s of 512 x 512 bytes, as published, or are worked out: "exact".
    blending: of overlapping segments, "minimum" keeps the least of each field; "nearest" the nearest segment's.
    borders: "over", each category over those below, borders and all; "under", all main colours over all borders, which
        opens crossings; "smooth", categories flow into each other.
    keep_depth: whether a third field has each category's depth, as published; else the terrain's is read.
    mend_intrusion: lines get narrower where others of their category come near; with widths_at="vertex".
    mend_protrusion: a line that ends at a narrower one of another category is cut at that one's border.

    Raises StyleError.
    """

    name: ClassVar[str] = "distance_field"
    restyles: ClassVar[bool] = True

    category: Any = None
    styles: Mapping[Any, Any] | None = None
    highlight: Any = ()
    highlight_style: Any = None
    lod: Lod = field(default_factory=Lod)
    widths_at: Literal["fragment", "vertex"] = "fragment"
    bits: Literal[8, 32] = 8
    drop_off: Literal["texture", "exact"] = "texture"
    blending: Literal["minimum", "nearest"] = "minimum"
    borders: Literal["over", "under", "smooth"] = "under"
    keep_depth: bool = False
    mend_intrusion: bool = False
    mend_protrusion: bool = False
    category_of: NDArray[np.uint32] | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        for keyword, known in WORDS.items():
            if not is_word(getattr(self, keyword), known):
                raise StyleError(
                    f"DistanceField {keyword} must be {' or '.join(map(repr, known))}, not"
                    f" {getattr(self, keyword)!r}."
                )
        if self.bits not in (8, 32) or isinstance(self.bits, bool):
            raise StyleError(f"DistanceField bits must be 8 or 32, but they are {self.bits!r}.")
        for keyword in ("keep_depth", "mend_intrusion", "mend_protrusion"):
            flag(getattr(self, keyword), f"DistanceField {keyword}")
        if self.mend_intrusion and self.widths_at != "vertex":
            raise StyleError("mend_intrusion narrows lines node by node; give widths_at='vertex' too.")
        if not isinstance(self.lod, Lod):
            raise StyleError(f"lod must be a Lod, such as Lod.by_distance(200, 5000), not {self.lod!r}.")
        self._check_categories()

    def _check_categories(self) -> None:
        if (self.category is None) != (self.styles is None):
            raise StyleError(
                "category= says which rows belong together, and styles= how each category looks. Give both or"
                " neither."
            )
        if self.styles is None:
            if is_listed(self.highlight) and len(self.highlight):
                raise StyleError("highlight= is for networks with category= and styles=.")
            return
        if not isinstance(self.styles, Mapping) or not self.styles:
            raise StyleError("styles= must be a dict {category: style}, the lowest rank first.")
        styles = {name: _as_category(name, style) for name, style in self.styles.items()}
        if len(styles) >= MOST_CATEGORIES:
            raise StyleError(f"styles= has {len(styles)} categories; fewer than {MOST_CATEGORIES} are drawn.")
        object.__setattr__(self, "styles", styles)
        if not is_listed(self.highlight):
            raise StyleError(f"highlight= must be a list of rows, but it is {self.highlight!r}.")
        if len(self.highlight) and self.highlight_style is None:
            raise StyleError("highlight= needs a highlight_style=.")
        if self.highlight_style is not None:
            object.__setattr__(self, "highlight_style", _as_category("highlight", self.highlight_style))

    @property
    def names_widths(self) -> bool:
        return self.styles is not None

    def bound_to(self, layer_name: str, rows: NDArray[np.int64], attributes: Attributes | None) -> DistanceField:
        """With each feature's category looked up. Raises StyleError, ColumnError."""
        if self.styles is None:
            return self
        values = self._categories(layer_name, attributes)
        places = {name: place for place, name in enumerate(self.styles)}
        other = places.get(None, _OTHERS)
        codes = np.array([places.get(value, other) for value in values[rows].tolist()], dtype=np.uint32)
        if len(codes) and (codes == _OTHERS).all():
            raise StyleError(
                f"Layer {layer_name!r}: no row's category is named in styles=, such as {values[rows][0]!r}."
                f"{close_matches(str(values[rows][0]), places)}"
            )
        highlight = np.asarray(self.highlight, dtype=np.int64)
        if highlight.size:
            if highlight.min() < 0 or highlight.max() >= len(values):
                raise StyleError(f"Layer {layer_name!r}: highlight= names rows that there are not.")
            codes[np.isin(rows, highlight)] = len(places)
        return replace(self, category_of=codes)

    def _categories(self, layer_name: str, attributes: Attributes | None) -> NDArray[Any]:
        if attributes is None:
            raise StyleError(f"Layer {layer_name!r} comes from a saved scene, which keeps no categories.")
        if isinstance(self.category, str):
            return attributes.column(self.category).astype(object)
        values = np.asarray(self.category, dtype=object)
        if values.shape != (attributes.count,):
            raise StyleError(
                f"Layer {layer_name!r}: category= has shape {values.shape}, but the layer has"
                f" {attributes.count} rows."
            )
        return values

    def core_options(self) -> _core.TechniqueOptions:
        """The choices as the core takes them."""
        options = _core.DistanceFieldOptions()
        options.lod = self.lod.core()
        options.widths_at = _core.LodPlace.__members__[self.widths_at]
        options.bits = self.bits
        options.drop_off = _core.DropOff.__members__[self.drop_off]
        options.blending = _core.FieldBlending.__members__[self.blending]
        options.borders = _core.Borders.__members__[self.borders]
        options.keep_depth = self.keep_depth
        options.mend_intrusion = self.mend_intrusion
        options.mend_protrusion = self.mend_protrusion
        if self.styles is None:
            return options
        assert self.category_of is not None
        added: dict[int, int] = {}
        categories = [style.core(str(name), options, added) for name, style in self.styles.items()]
        if self.highlight_style is not None:
            categories.append(self.highlight_style.core("highlight", options, added))
        options.categories = categories
        options.set_category_of(self.category_of)
        return options


_OTHERS = 0xFFFFFFFF


def _as_category(name: Any, style: Any) -> NetworkCategory:
    if isinstance(style, NetworkCategory):
        return style
    if isinstance(style, NetworkStyle) or is_listed(style):
        return NetworkCategory(style)
    raise StyleError(
        f"The style of category {name!r} must be a NetworkCategory, a NetworkStyle or [(lod, style), ...], not"
        f" {style!r}."
    )
