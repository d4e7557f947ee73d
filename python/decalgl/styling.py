"""From styling keywords to what the core draws: strokes, fills, and styles that many features share.

keywords of add_lines, add_polygons ──check──▶ before data are read
                                    ──resolve─▶ Looks: a colour and a width for each feature, few styles
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ._choices import Choices, LayerRows, choose, numbers_of
from ._colors import parse_color
from ._values import finite_number, is_listed, is_word
from .coloring import Coloring, resolve_colors
from .errors import StyleError, UnsupportedError, close_matches
from .patterns import NAMED_DASHES, Pattern, is_dash_lengths, parse_dash
from .strokes import ColorBand, Fill, Hatch, Stroke, StrokeStyle, WidthLimits
from .styles import (
    WIDTH_LIMITS,
    Casing,
    ColorKeywords,
    Outline,
    StrokeKeywords,
    color_keywords,
    stroke_keywords,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from .strokes import OutlineMode, OutlineOrder

CORNERS, CAPS = ("round", "miter", "bevel"), ("round", "butt", "square")
MODES, ORDERS = ("normal", "inset", "offset"), ("layer", "feature")
SLOPE_CORRECTIONS = ("thoeny", "tangent")
BY_CATEGORY = ("width", "corner", "cap", "dash")
MOST_BANDS, MOST_STYLES = 16, 1 << 16
# A line this many times as wide as the terrain is long has a width in the wrong unit.
WIDEST_LINE = 1e4


@dataclass(frozen=True)
class Looks:
    """The fields of a `Layer` that say how it looks."""

    coloring: Coloring
    fill: Fill | None = None
    stroke: Stroke | None = None
    casing: Stroke | None = None
    outline_mode: OutlineMode = "normal"
    outline_order: OutlineOrder = "layer"
    outline_coloring: Coloring | None = None


@dataclass(frozen=True)
class LineKeywords:
    """How a layer of lines is to look."""

    colors: ColorKeywords
    stroke: StrokeKeywords
    casing: Casing | None = None

    @property
    def follows_view(self) -> bool:
        """Whether widths on the ground change with the view."""
        return self.stroke.follows_view

    def check(self, layer_name: str) -> None:
        """Raises StyleError and UnsupportedError for all that can be told without the data."""
        with _named(f"Layer {layer_name!r}"):
            _shared_style(self.stroke, "")
            _require_screen_style(self.stroke, "")
            if self.casing is not None and not isinstance(self.casing, Casing):
                raise _wrong_type("casing", self.casing, "Casing(width=2)")
            if self.casing is not None and _limits(self.stroke, "") != WidthLimits():
                raise UnsupportedError(
                    "casing= is not drawn for limited widths (width_min_px and its siblings). Leave the limits out, or"
                    " add the casing as a layer of wider lines."
                )
            if self.casing is not None and self.casing.dash is not None:
                _require_screen_style(replace(self.stroke, dash=self.casing.dash), "casing ")

    def resolve(self, rows: LayerRows) -> Looks:
        """Raises StyleError, ColumnError and InputError that name the layer, the keyword and the row."""
        rows = replace(rows, column=self.colors.column)
        with _named(f"Layer {rows.name!r}"):
            coloring = _coloring(self.colors, rows, self.stroke, self.casing)
            widths = _widths(self.stroke.width, rows, "")
            stroke = _stroke(self.stroke, rows, "", coloring.colors, widths)
            casing = None if self.casing is None else self._casing(self.casing, rows, coloring, stroke)
        return Looks(coloring, stroke=stroke, casing=casing)

    def _casing(self, look: Casing, rows: LayerRows, coloring: Coloring, stroke: Stroke) -> Stroke:
        if look.column is not None:
            rows = replace(rows, column=look.column)
        sides = _widths(look.width, rows, "casing ")
        keywords = replace(self.stroke, dash=look.dash, bands=None, widest=None)
        with _named("casing"):
            colors = _coloring(color_keywords(look), rows, look).colors
        casing = _stroke(
            keywords, rows, "casing ", _without(colors, coloring.left_out), stroke.widths + 2.0 * sides
        )
        if stroke.widest == 0.0:
            return casing
        return replace(casing, widest=stroke.widest + 2.0 * float(sides.max(initial=0.0)))


@dataclass(frozen=True)
class PolygonKeywords:
    """How a layer of polygons is to look."""

    colors: ColorKeywords
    hatch: Any = None
    outline: Outline | None = None

    @property
    def follows_view(self) -> bool:
        """Whether widths on the ground change with the view: of outlines without fills."""
        return self.outline is not None and stroke_keywords(self.outline).follows_view

    def check(self, layer_name: str) -> None:
        """Raises StyleError and UnsupportedError for all that can be told without the data."""
        if self.outline is None:
            return
        with _named(f"Layer {layer_name!r}"):
            if not isinstance(self.outline, Outline):
                raise _wrong_type("outline", self.outline, "Outline(width=2, width_units='m')")
            _shared_style(stroke_keywords(self.outline), "outline ")
            _require_screen_style(stroke_keywords(self.outline), "outline ")
            _require_word("outline mode", self.outline.mode, MODES)
            _require_word("outline order", self.outline.order, ORDERS)

    def resolve(self, rows: LayerRows) -> Looks:
        """Raises StyleError, ColumnError and InputError that name the layer, the keyword and the row."""
        rows = replace(rows, column=self.colors.column)
        with _named(f"Layer {rows.name!r}"):
            coloring = _coloring(self.colors, rows, self.outline, hatch=self.hatch)
            fill = _fill(self.hatch, rows, coloring.colors)
            if self.outline is None:
                return Looks(coloring, fill)
            return replace(self._outlined(self.outline, rows, coloring), fill=fill)

    def _outlined(self, outline: Outline, rows: LayerRows, coloring: Coloring) -> Looks:
        if outline.column is not None:
            rows = replace(rows, column=outline.column)
        keywords = stroke_keywords(outline)
        with _named("outline"):
            own = _coloring(color_keywords(outline), rows, outline)
        colors = _without(own.colors, coloring.left_out)
        stroke = _stroke(keywords, rows, "outline ", colors, _widths(outline.width, rows, "outline "))
        return Looks(
            coloring,
            stroke=stroke,
            outline_mode=outline.mode,
            outline_order=outline.order,
            outline_coloring=own,
        )


@contextmanager
def _named(what: str) -> Iterator[None]:
    """Style errors inside begin with what they are about, where they do not say so already."""
    try:
        yield
    except (StyleError, UnsupportedError) as error:
        if what in str(error):
            raise
        raise type(error)(f"{what}: {error}") from error


def _wrong_type(keyword: str, value: Any, example: str) -> StyleError:
    return StyleError(
        f"{keyword}= must be a decalgl.{example.split('(')[0]}, not a {type(value).__name__}. Give"
        f" {keyword}=decalgl.{example}."
    )


def _coloring(
    keywords: ColorKeywords,
    rows: LayerRows,
    *looks: StrokeKeywords | Casing | Outline | None,
    hatch: Any = None,
) -> Coloring:
    """The colours; a column that only chooses among `looks` by category does not compete with a colour."""
    values = [hatch, *(getattr(look, name, None) for look in looks for name in BY_CATEGORY)]
    if keywords.color is not None and any(isinstance(value, Mapping) for value in values):
        keywords = replace(keywords, column=None)
    return resolve_colors(rows.attributes.count, rows.attributes, rows=rows.rows, **vars(keywords))


def _without(colors: NDArray[np.uint8], left_out: NDArray[np.bool_]) -> NDArray[np.uint8]:
    if left_out.any():
        colors = colors.copy()
        colors[left_out, 3] = 0
    return colors


def _widths(width: Any, rows: LayerRows, what: str) -> NDArray[np.float64]:
    """Metres of each feature. Raises StyleError that names the first row without a usable width."""
    widths = numbers_of(width, rows, f"{what}width")
    wrong = np.flatnonzero(~((widths > 0.0) & (widths <= rows.widest)))
    if wrong.size:
        found = widths[wrong[0]]
        problem = (
            f"is wider than {WIDEST_LINE:g} times the terrain" if found > 0 else "is not a positive length"
        )
        raise StyleError(
            f"Layer {rows.name!r}, row {rows.rows[wrong[0]]}: {what}width {found:g} {problem}."
            f" Give every {'line' if not what else what.strip()} a width above 0, in metres."
        )
    return widths


def _shared_style(keywords: StrokeKeywords, what: str) -> StrokeStyle:
    """What all features of a stroke have in common. Raises StyleError and UnsupportedError."""
    if not is_word(keywords.width_units, ("m", "px")):
        raise StyleError(f"{what}width_units must be 'm' or 'px', but it is {keywords.width_units!r}.")
    limit = checked_miter_limit(keywords.miter_limit, what)
    correction = keywords.slope_correction
    if correction is not None:
        _require_word(f"{what}slope_correction", correction, SLOPE_CORRECTIONS, "or None")
    _limits(keywords, what)
    if keywords.widest is not None and finite_number(keywords.widest, f"{what}widest") <= 0.0:
        raise StyleError(f"{what}widest must be a width above 0 in metres, but it is {keywords.widest:g}.")
    return StrokeStyle(
        miter_limit=limit,
        slope_correction=correction or "none",
        bands=color_bands(keywords.bands, what),
    )


def checked_miter_limit(value: Any, what: str) -> float:
    """Degrees. Raises StyleError."""
    limit = finite_number(value, f"{what}miter_limit")
    if not 0.0 <= limit <= 180.0:
        raise StyleError(f"{what}miter_limit must be an angle from 0 to 180 degrees, but it is {limit:g}.")
    return limit


def _limits(keywords: StrokeKeywords, what: str) -> WidthLimits:
    """What widths are kept between. Raises StyleError."""
    given = {}
    for name, unlimited in zip(WIDTH_LIMITS, (0.0, np.inf, 0.0, np.inf), strict=True):
        value = getattr(keywords, name)
        given[name] = unlimited if value is None else finite_number(value, f"{what}{name}")
        if given[name] < 0.0:
            raise StyleError(f"{what}{name} must be a width of 0 or more, but it is {given[name]:g}.")
    for unit in ("px", "m"):
        least, most = given[f"width_min_{unit}"], given[f"width_max_{unit}"]
        if least > most:
            raise StyleError(
                f"{what}width_min_{unit}={least:g} is above width_max_{unit}={most:g}. Exchange them."
            )
    return WidthLimits(*given.values())


def _require_screen_style(keywords: StrokeKeywords, what: str) -> None:
    """Raises UnsupportedError for what strokes do not have whose widths follow the view."""
    if not keywords.follows_view:
        return
    for name in ("dash", "bands", "slope_correction"):
        if getattr(keywords, name) is not None:
            raise UnsupportedError(
                f"{what}{name}= is not drawn for widths on the screen (width_units='px', the default, and"
                f" width_min_px and its siblings). Leave it out, or give width_units='m' without limits."
            )


def _require_word(keyword: str, value: Any, known: tuple[str, ...], more: str = "") -> None:
    if not is_word(value, known):
        raise StyleError(
            f"{keyword}={value!r} is not known.{close_matches(value, known)} Give one of"
            f" {', '.join(known)}{more and ' ' + more}."
        )


def color_bands(bands: Any, what: str) -> tuple[ColorBand, ...]:
    if bands is None:
        return ()
    shape = f"{what}bands must be a list of (reach, colour), such as [(0.6, 'white'), (1.0, 'black')]"
    if not is_listed(bands):
        raise StyleError(f"{shape}, but they are {bands!r}.")
    if not 1 <= len(bands) <= MOST_BANDS:
        raise StyleError(f"{what}bands must be 1 to {MOST_BANDS} colours, but {len(bands)} are given.")
    found: list[ColorBand] = []
    for number, band in enumerate(bands, start=1):
        if not is_listed(band) or len(band) != 2:
            raise StyleError(f"{shape}, but band {number} is {band!r}.")
        reach = finite_number(band[0], f"{what}bands: the reach of band {number}")
        if not (found[-1].reach if found else 0.0) < reach <= 1.0:
            raise StyleError(
                f"{what}bands must reach farther one by one, as shares of the half width up to 1, but band {number}"
                f" reaches to {reach:g}."
            )
        red, green, blue, alpha = (round(255.0 * channel) for channel in parse_color(band[1]))
        found.append(ColorBand(reach, (red, green, blue, alpha)))
    if found[-1].reach != 1.0:
        raise StyleError(f"{what}bands: the last one must reach to 1, but it reaches to {found[-1].reach:g}.")
    return tuple(found)


def _stroke(
    keywords: StrokeKeywords,
    rows: LayerRows,
    what: str,
    colors: NDArray[np.uint8],
    widths: NDArray[np.float64],
) -> Stroke:
    styles, style_of = _styles(keywords, rows, what, widths)
    widest = 0.0 if keywords.widest is None else float(keywords.widest)
    if widest > rows.widest:
        raise StyleError(
            f"{what}widest={widest:g} is wider than {WIDEST_LINE:g} times the terrain. Lower it."
        )
    if widest and widths.max(initial=0.0) > widest:
        row = rows.rows[int(widths.argmax())]
        raise StyleError(
            f"{what}widest={widest:g} lies below the width {widths.max():g} of row {row}. Give the largest width"
            " that lines may be given later."
        )
    return Stroke(colors, widths, styles, style_of, widest, keywords.width_units, _limits(keywords, what))


def _styles(
    keywords: StrokeKeywords, rows: LayerRows, what: str, widths: NDArray[np.float64]
) -> tuple[tuple[StrokeStyle, ...], NDArray[np.uint32] | None]:
    """The distinct styles, and each feature's place among them."""
    shared = _shared_style(keywords, what)
    corners = choose(
        rows, f"{what}corner", keywords.corner, word_of(CORNERS), lambda value: is_word(value, CORNERS)
    )
    caps = choose(rows, f"{what}cap", keywords.cap, word_of(CAPS), lambda value: is_word(value, CAPS))
    dashes = choose(rows, f"{what}dash", keywords.dash, parse_dash, is_one_dash)
    if len(widths) == 0:
        return (shared,), None
    sizes = widths_of_dashes(dashes, widths)
    keys, count = np.zeros(len(widths), dtype=np.int64), 1
    for codes, distinct in (
        (corners.codes, len(corners.values)),
        (caps.codes, len(caps.values)),
        (dashes.codes, len(dashes.values)),
        (sizes, 1 if sizes is None else int(sizes.max()) + 1),
    ):
        if codes is not None:
            keys, count = keys * distinct + codes, count * distinct
    _, first, style_of = np.unique(keys, return_index=True, return_inverse=True)
    if len(first) > MOST_STYLES:
        raise StyleError(
            f"{what}dash: {len(first)} different widths make as many different dashes, but a layer has at most"
            f" {MOST_STYLES} styles. Give the dash's lengths in metres, or round the widths."
        )
    styles = []
    for place in first:
        dash = dashes.at(place)
        pattern = None if dash is None else dash.for_width(float(widths[place]))
        styles.append(replace(shared, corner=corners.at(place), cap=caps.at(place), pattern=pattern))
    return tuple(styles), None if len(styles) == 1 else style_of.astype(np.uint32)


def widths_of_dashes(
    dashes: Choices[Pattern | None], widths: NDArray[np.float64]
) -> NDArray[np.int64] | None:
    """A number for each width where dashes are as long as the line is wide, 0 for other features."""
    scaled = np.array([dash is not None and dash.units == "width" for dash in dashes.values])
    if not scaled.any():
        return None
    numbers = np.unique(widths, return_inverse=True)[1].astype(np.int64)
    return numbers if dashes.codes is None else np.where(scaled[dashes.codes], numbers, 0)


def word_of(known: tuple[str, ...]) -> Callable[[Any], Any]:
    """A parser of one of a few words; the first is what rows without one have."""

    def parse(value: Any) -> Any:
        if value is not None and not is_word(value, known):
            hint = close_matches(value, known)
            raise StyleError(
                f"{value!r} is not known.{hint} Give one of {', '.join(known)}, or a column's name."
            )
        return known[0] if value is None else value

    return parse


def is_one_dash(value: Any) -> bool:
    if isinstance(value, str):
        return value in NAMED_DASHES
    return value is None or isinstance(value, Pattern) or is_dash_lengths(value)


def hatches_of(hatch: Any, rows: LayerRows) -> Choices[Hatch | None]:
    """The hatch of each feature, None for an even fill. Raises StyleError."""
    return choose(rows, "hatch", hatch, _one_hatch, lambda value: value is None or isinstance(value, Hatch))


def _fill(hatch: Any, rows: LayerRows, colors: NDArray[np.uint8]) -> Fill:
    hatches = hatches_of(hatch, rows)
    codes = None if hatches.codes is None else hatches.codes.astype(np.uint32)
    return Fill(colors, tuple(hatches.values) or (None,), codes)


def _one_hatch(value: Any) -> Hatch | None:
    if value is None or isinstance(value, Hatch):
        return value
    raise StyleError(
        f"{value!r} is no hatch. Give decalgl.Hatch(spacing=20, width=4), or None for an even fill."
    )
