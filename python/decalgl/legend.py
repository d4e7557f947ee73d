"""Legends: a layer's colours, dashes, casings, outlines and hatches as matplotlib shows them.

handles, scalar_mappable, draw_on    for matplotlib's axes, with the names and the meaning of GeoPandas
overlay                              the legends of several layers, beside each other on a picture

     +-------------------+-------+     Boxes go from the upper right corner down, then into the next column
     |                   | kind  |     to the left. matplotlib draws them on nothing, and they are laid over
     |                   | # wood|     the picture, whose other pixels stay as they are.
     |                   +-------+
     |                   |height |
     +-------------------+-------+
"""

from __future__ import annotations

import inspect
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ._legend_keys import keys, plain
from .errors import StyleError, UnsupportedError, close_matches, warn

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from .layer import Layer

DPI = 100
MARGIN = 8  # pixels between boxes, and between boxes and the picture's border
BAR_SIZE = (0.14, 1.6)  # inches, across and along
# What `Figure.colorbar` takes only where it makes its own place.
PLACING = ("ax", "cax", "use_gridspec", "shrink", "aspect", "fraction", "pad", "anchor", "panchor")


def handles(layer: Layer) -> list[Any]:
    """Artists with labels: see `Layer.legend_handles`."""
    with _matplotlib():
        return keys(layer)


def scalar_mappable(layer: Layer) -> Any:
    """See `Layer.scalar_mappable`."""
    with _matplotlib():
        from matplotlib.cm import ScalarMappable
    coloring = layer.legend_coloring
    if coloring.kind != "continuous":
        raise StyleError(
            f"Layer {layer.name!r} is not coloured by numbers, so it has no colormap. Use layer.legend_handles()."
        )
    return ScalarMappable(norm=coloring.norm, cmap=coloring.cmap)


def draw_on(layer: Layer, ax: Any, legend_kwds: Mapping[str, Any]) -> Any:
    """See `Layer.legend`."""
    if ax is None:
        with _matplotlib():
            from matplotlib import pyplot as plt
        ax = plt.gca()
    keywords = _keywords(layer, legend_kwds)
    with _refusals(layer):
        if layer.legend_coloring.kind == "continuous":
            return ax.figure.colorbar(scalar_mappable(layer), ax=ax, **keywords)
        return ax.legend(handles=_relabelled(layer, handles(layer), keywords), **keywords)


def require_drawable(layer: Layer) -> None:
    """Draws the legend once, so that StyleErrors come before a picture is made; warns where there is none."""
    with _matplotlib():
        from matplotlib.figure import Figure
    if layer.legend_coloring.kind == "listed":
        warn(
            f"Layer {layer.name!r}: colours that are given row by row have no names for a legend, so none will be"
            " drawn. Colour by column=, or leave legend=True out."
        )
    else:
        draw_on(layer, Figure().add_subplot(), {})


def overlay(layers: Sequence[Layer], size: tuple[int, int]) -> NDArray[np.uint8]:
    """The layers' legends as uint8 (height, width, 4), sRGB with straight alpha, nothing elsewhere.

    Warns where they do not all fit. Raises StyleError for legend_kwds that matplotlib refuses.
    """
    with _matplotlib():
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    width, height = size
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="none")
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    column = _Column(width, height)
    plain: list[Any] = []
    for layer in layers:
        keywords = _keywords(layer, {})
        with _refusals(layer):
            if layer.legend_coloring.kind == "continuous":
                plain += handles(layer)
                _place_bar(figure, layer, keywords, column)
            elif layer.legend_coloring.kind == "single" and not keywords:
                plain += handles(layer)
            elif layer.legend_coloring.kind != "listed":
                _place_box(axes, _relabelled(layer, handles(layer), keywords), keywords, column)
    if plain:
        _place_box(axes, plain, {}, column)
    if column.crowded:
        warn(
            f"The legends do not fit into a picture of {width} x {height} pixels. Draw a larger one, leave some out, or"
            " make them smaller with legend_kwds={'fontsize': 'small', 'ncols': 2}."
        )
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())


class _Column:
    """Where the next box goes: pixels from the upper right corner."""

    def __init__(self, width: int, height: int) -> None:
        self._limits = (width, height)
        self._right, self._top, self._widest = MARGIN, MARGIN, 0
        self.crowded = False

    def take(self, width: float, height: float) -> tuple[float, float]:
        """The right and upper border of a box of this size, in pixels from the lower left corner."""
        if self._top > MARGIN and self._top + height + MARGIN > self._limits[1]:
            self._right, self._top, self._widest = self._right + self._widest + MARGIN, MARGIN, 0
        right, top = self._limits[0] - self._right, self._limits[1] - self._top
        self.crowded |= right - width < 0 or top - height < 0
        self._top += int(np.ceil(height)) + MARGIN
        self._widest = max(self._widest, int(np.ceil(width)))
        return right, top


def _place_box(axes: Any, shown: list[Any], keywords: dict[str, Any], column: _Column) -> None:
    """A legend in the next place, or where its keywords say."""
    placed = "loc" in keywords or "bbox_to_anchor" in keywords
    own = {} if placed else {"loc": "upper right", "borderaxespad": 0.0}
    box = axes.legend(handles=shown, **{**own, **keywords})
    axes.add_artist(box)
    extent = box.get_window_extent(axes.figure.canvas.get_renderer())
    if not placed:
        right, top = column.take(extent.width, extent.height)
        width, height = axes.figure.bbox.size
        box.set_bbox_to_anchor((right / width, top / height), axes.transAxes)


def _place_bar(figure: Any, layer: Layer, keywords: dict[str, Any], column: _Column) -> None:
    """A colorbar with its ticks and label on a panel like those of legends, in the next place."""
    from matplotlib.patches import FancyBboxPatch

    level = keywords.get("orientation") == "horizontal" or keywords.get("location") in ("top", "bottom")
    across, along = (size * DPI for size in BAR_SIZE)
    bar_width, bar_height = (along, across) if level else (across, along)
    width, height = figure.bbox.size
    axes = figure.add_axes((0.0, 0.0, bar_width / width, bar_height / height), zorder=2)
    kept = {key: value for key, value in keywords.items() if key not in PLACING}
    figure.colorbar(scalar_mappable(layer), cax=axes, **kept)
    around = axes.get_tightbbox(figure.canvas.get_renderer())
    pad = 6.0
    right, top = column.take(around.width + 2 * pad, around.height + 2 * pad)
    x, y = right - pad - around.x1, top - pad - around.y1
    axes.set_position((x / width, y / height, bar_width / width, bar_height / height))
    corner = (x + around.x0 - pad, y + around.y0 - pad)
    panel = FancyBboxPatch(
        corner, around.width + 2 * pad, around.height + 2 * pad, boxstyle="round,pad=0,rounding_size=3",
        facecolor="white", edgecolor="0.8", alpha=0.8, transform=None, zorder=1,
    )  # fmt: skip
    figure.add_artist(panel)


def _keywords(layer: Layer, given: Mapping[str, Any]) -> dict[str, Any]:
    """The layer's legend_kwds, those of a call over them, and defaults. Raises StyleError for unknown ones."""
    coloring = layer.legend_coloring
    keywords = {**layer.coloring.legend_kwds, **given}
    known = _known_keywords(coloring.kind == "continuous")
    unknown = [key for key in keywords if key not in known]
    if unknown:
        raise StyleError(
            f"Layer {layer.name!r}: legend_kwds has the unknown key {unknown[0]!r}."
            f"{close_matches(unknown[0], known)} It takes what matplotlib's"
            f" {'Figure.colorbar' if coloring.kind == 'continuous' else 'Axes.legend'} takes."
        )
    if coloring.kind == "continuous":
        defaults: dict[str, Any] = {
            "extend": coloring.extend,
            "label": plain(coloring.title),
            "alpha": coloring.alpha,
        }
    else:
        defaults = {"title": plain(coloring.title)} if coloring.title else {}
    return {**defaults, **keywords}


def _known_keywords(continuous: bool) -> list[str]:
    with _matplotlib():
        from matplotlib.colorbar import Colorbar
        from matplotlib.legend import Legend
    if continuous:
        names = [*inspect.signature(Colorbar.__init__).parameters, *PLACING, "location", "orientation"]
        return [name for name in names if name not in ("self", "ax", "cax", "mappable", "kwargs")]
    names = list(inspect.signature(Legend.__init__).parameters)
    return [name for name in names if name not in ("self", "parent", "handles")]


def _relabelled(layer: Layer, shown: list[Any], keywords: dict[str, Any]) -> list[Any]:
    """The handles with the labels of legend_kwds, which are taken out of the keywords."""
    labels = keywords.pop("labels", None)
    if labels is None:
        return shown
    texts = [str(label) for label in labels]
    own = layer.legend_coloring.labels or (layer.name,)
    if len(texts) != len(shown):
        raise StyleError(
            f"Layer {layer.name!r}: legend_kwds has {len(texts)} labels, but the legend has {len(shown)} entries:"
            f" {', '.join(own)}. Give as many."
        )
    for handle, text in zip(shown, texts, strict=True):
        handle.set_label(text)
    return shown


@contextmanager
def _matplotlib() -> Iterator[None]:
    try:
        yield
    except ImportError as error:
        raise UnsupportedError(
            f"Legends are drawn by matplotlib, which cannot be imported ({error}). Install it: pip install matplotlib"
        ) from error


@contextmanager
def _refusals(layer: Layer) -> Iterator[None]:
    """What matplotlib refuses, as an error that names the layer."""
    try:
        yield
    except (StyleError, UnsupportedError):
        raise
    except (TypeError, ValueError, AttributeError, KeyError) as error:
        raise StyleError(f"Layer {layer.name!r}: matplotlib refuses legend_kwds: {error}.") from error
