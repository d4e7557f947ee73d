"""A layer of a scene: features, how each of them looks, and the legend that explains it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import legend as legends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._sources import Attributes
    from .coloring import Coloring
    from .features import FeatureTable, Kind
    from .strokes import Fill, OutlineMode, OutlineOrder, Stroke
    from .techniques import Technique


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer of a scene, ready to draw.

    features: the geometry on the scene's plane.
    fill: of polygons; None for lines.
    stroke: of lines, or the outlines of polygons; None for polygons without.
    casing: of lines, under the strokes of all of them; None without.
    outline_mode: which side of a polygon's border its outline lies on. outline_order: over all fills of the layer,
        or each over its own feature's.
    draw_order: int64 (features), features from bottom to top.
    technique: who draws it.
    coloring: how the colours came about, for legends; of polygons' outlines `outline_coloring`, None without.
    attributes: the columns beside the geometry, for restyling by them.
    """

    name: str
    index: int
    features: FeatureTable
    draw_order: NDArray[np.int64] = field(repr=False)
    coloring: Coloring = field(repr=False)
    technique: Technique
    fill: Fill | None = field(default=None, repr=False)
    stroke: Stroke | None = field(default=None, repr=False)
    casing: Stroke | None = field(default=None, repr=False)
    outline_mode: OutlineMode = "normal"
    outline_order: OutlineOrder = "layer"
    outline_coloring: Coloring | None = field(default=None, repr=False)
    attributes: Attributes | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        self.draw_order.flags.writeable = False

    @property
    def kind(self) -> Kind:
        """What its features are: "polygons" or "lines"."""
        return self.features.kind

    @property
    def colors(self) -> NDArray[np.uint8]:
        """uint8 (features, 4), of the fills of polygons or the strokes of lines; alpha 0 is not drawn."""
        own = self.fill or self.stroke
        assert own is not None
        return own.colors

    @property
    def widths(self) -> NDArray[np.float64]:
        """float64 (features), metres on the map plane of the strokes of lines; zeros for polygons."""
        if self.kind == "polygons" or self.stroke is None:
            return np.zeros(len(self.features))
        return self.stroke.widths

    @property
    def rows(self) -> NDArray[np.int64]:
        """int64 (features), each feature's row in the data that the layer was made of."""
        return self.features.rows

    @property
    def legend_coloring(self) -> Coloring:
        """What a legend explains: the outlines' colouring where only they are coloured by a column."""
        outline = self.outline_coloring
        by_column = ("categorical", "continuous")
        if outline is not None and outline.kind in by_column and self.coloring.kind not in by_column:
            return outline
        return self.coloring

    def legend_handles(self) -> list[Any]:
        """matplotlib artists with labels, for `Axes.legend(handles=...)`: patches of polygons, lines of lines.

        One for each category and for missing values, or one with the layer's name where it has one colour. Of a
        continuous colouring only that of missing values: the rest is `scalar_mappable`'s.
        """
        return legends.handles(self)

    def scalar_mappable(self) -> Any:
        """matplotlib's `ScalarMappable` of a continuous colouring, for `Figure.colorbar`. Raises StyleError."""
        return legends.scalar_mappable(self)

    def legend(self, ax: Any = None, **legend_kwds: Any) -> Any:
        """Draws the layer's legend on matplotlib's axes, by default the current ones: a `Legend` or a `Colorbar`.

        legend_kwds: as in `GeoDataFrame.plot`, over those that the layer was added with.
        Raises StyleError for what matplotlib refuses.
        """
        return legends.draw_on(self, ax, legend_kwds)
