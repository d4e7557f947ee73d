"""The styling keys of layers in a scene file, checked for names and types, as keywords of `Scene.add_*`.

width = 6 | "column" | { road = 6, track = 3 }      corner, cap likewise, with words
dash = "dashed" | [10, 5] | { arrows = {...} } | { stipple = {...} } | { period, marks, ... } | { track = "dashed" }
norm = "log" | { power = 0.5 } | { center = 0 } | { boundaries = [0, 10, 100] }
hatch = { spacing, width, ... } | { wood = {...} }  outline = { width, ... }     casing = { width, ... }
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from ._colors import colormap
from ._values import is_number
from .patterns import Pattern
from .strokes import Hatch
from .styles import WIDTH_LIMITS, Casing, Outline

if TYPE_CHECKING:
    from collections.abc import Callable

    from ._tables import StrictTable

Made = TypeVar("Made")
WIDTH_UNITS = ("px", "m")
PATTERN_KEYS = ("period", "marks", "offset", "units")


def present(**values: Any) -> dict[str, Any]:
    """Only what was given, so that defaults stay where they are defined."""
    return {key: value for key, value in values.items() if value is not None}


def parse_style(table: StrictTable, kind: str) -> dict[str, Any]:
    """The styling keywords of a layer of lines or polygons. Raises InputError."""
    keywords = _colors(table) | present(
        legend=table.flag("legend"), legend_kwds=_plain_table(table, "legend_kwds")
    )
    if kind == "lines":
        return (
            keywords | _stroke(table) | present(cap=_by_category(table, "cap", _word), casing=_casing(table))
        )
    return keywords | present(outline=_outline(table), hatch=_hatch(table))


def _colors(table: StrictTable) -> dict[str, Any]:
    """The colouring keywords that layers, outlines and casings have, with GeoPandas' names."""
    cmap = table.value("cmap")
    if isinstance(cmap, dict):
        cmap = dict(cmap)
        wrong = [key for key, color in cmap.items() if not isinstance(color, str)]
        if wrong:
            raise table.error(
                f"cmap must give each category a colour in quotes, but {wrong[0]!r} has {cmap[wrong[0]]!r}."
            )
    elif cmap is not None and not isinstance(cmap, str):
        raise table.error(f"cmap must be a colormap's name or a table of colours, but it is {cmap!r}.")
    return present(
        column=table.text("column"),
        cmap=cmap,
        color=table.text("color"),
        vmin=table.number("vmin"),
        vmax=table.number("vmax"),
        norm=_norm(table, cmap),
        alpha=table.number("alpha"),
        categorical=table.flag("categorical"),
        missing_kwds=_plain_table(table, "missing_kwds"),
    )


def _norm(layer: StrictTable, cmap: Any) -> Any:
    """A normalisation of matplotlib's; its limits are vmin and vmax."""
    value = layer.value("norm")
    if value is None:
        return None
    from matplotlib import colors

    if value == "log":
        return colors.LogNorm()
    if not isinstance(value, dict) or len(value) != 1:
        raise layer.error(
            f"norm must be 'log', {{ power = 0.5 }}, {{ center = 0 }} or {{ boundaries = [0, 10, 100] }}, but it is"
            f" {value!r}."
        )
    table = layer.inner(value, f"{layer.name} norm")
    power, center, boundaries = table.number("power"), table.number("center"), table.value("boundaries")
    table.finish()
    if power is not None:
        return colors.PowerNorm(power)
    if center is not None:
        return colors.TwoSlopeNorm(center)
    listed = boundaries if isinstance(boundaries, list) else []
    if len(listed) < 2 or not all(map(is_number, listed)) or sorted(set(listed)) != listed:
        raise table.error(f"boundaries must be an array of numbers that rise, but it is {boundaries!r}.")
    size = colormap(cmap if isinstance(cmap, str) else "viridis").N
    return _made(table, colors.BoundaryNorm, listed, size)


def _plain_table(table: StrictTable, key: str) -> dict[str, Any] | None:
    value = table.value(key)
    if value is not None and not isinstance(value, dict):
        example = "{ color = 'grey' }" if key == "missing_kwds" else "{ title = 'Land cover' }"
        raise table.error(f"{key} must be a table such as {example}, but it is {value!r}.")
    return value


def _stroke(table: StrictTable) -> dict[str, Any]:
    """What lines and outlines have in common."""
    return present(
        width=_by_category(table, "width", _width),
        width_units=table.choice("width_units", WIDTH_UNITS),
        corner=_by_category(table, "corner", _word),
        miter_limit=table.number("miter_limit"),
        dash=_dash(table),
        bands=_bands(table),
        slope_correction=table.text("slope_correction"),
        widest=table.number("widest"),
        **{name: table.number(name) for name in WIDTH_LIMITS},
    )


def _casing(layer: StrictTable) -> Casing | None:
    table = layer.table("casing", f"{layer.name} casing")
    if table is None:
        return None
    width = table.required("width", _by_category(table, "width", _width))
    keywords = _colors(table) | present(dash=_dash(table))
    table.finish()
    return Casing(width=width, **keywords)


def _outline(layer: StrictTable) -> Outline | None:
    table = layer.table("outline", f"{layer.name} outline")
    if table is None:
        return None
    keywords = _colors(table) | _stroke(table) | present(mode=table.text("mode"), order=table.text("order"))
    table.finish()
    return Outline(**keywords)


def _hatch(layer: StrictTable) -> Any:
    value = layer.value("hatch")
    if value is None:
        return None
    if not isinstance(value, dict):
        raise layer.error(
            f"hatch must be a table such as {{ spacing = 20, width = 4 }}, but it is {value!r}."
        )
    name = f"{layer.name} hatch"
    if value and all(isinstance(one, dict) for one in value.values()):
        return {key: _one_hatch(layer.inner(one, f"{name} {key}")) for key, one in value.items()}
    return _one_hatch(layer.inner(value, name))


def _one_hatch(table: StrictTable) -> Hatch | None:
    """A hatch; an empty table, for a category, is an even fill."""
    if not table.names():
        return None
    keywords = {key: table.required(key, table.number(key)) for key in ("spacing", "width")}
    keywords |= present(angle=table.number("angle"), crossed=table.flag("crossed"))
    table.finish()
    return _made(table, Hatch, **keywords)


def _dash(layer: StrictTable) -> Any:
    value = layer.value("dash")
    name = f"{layer.name} dash"
    if not isinstance(value, dict) or {"arrows", "stipple", *PATTERN_KEYS} & set(value):
        return _one_dash(layer, value, name)
    return {key: _one_dash(layer, one, f"{name} {key}") for key, one in value.items()}


def _one_dash(layer: StrictTable, value: Any, name: str) -> Any:
    if isinstance(value, dict):
        return _pattern(layer.inner(value, name))
    if isinstance(value, list):
        return _made(layer, Pattern.dashes, *value)
    if value is not None and not isinstance(value, str):
        raise layer.error(
            f"{name[len(layer.name) + 1 :]} must be a text such as 'dashed', an array of lengths on and off, or a"
            f" table, but it is {value!r}."
        )
    return value


def _pattern(table: StrictTable) -> Pattern:
    arrows, stipple = (
        table.table("arrows", f"{table.name} arrows"),
        table.table("stipple", f"{table.name} stipple"),
    )
    if arrows is not None:
        result = _made(
            arrows, Pattern.arrows, **_known(arrows, ("every", "length"), ("shaft", "offset", "units"))
        )
    elif stipple is not None:
        result = _made(stipple, Pattern.stipple, **_known(stipple, ("bits", "step"), ("offset", "units")))
    else:
        return _made(table, Pattern, **_known(table, ("period", "marks"), ("offset", "units")))
    table.finish()
    return result


def _known(table: StrictTable, required: tuple[str, ...], others: tuple[str, ...]) -> dict[str, Any]:
    """The values of these keys, and no others; the pattern checks them itself."""
    values = {key: table.required(key, table.value(key)) for key in required}
    values |= present(**{key: table.value(key) for key in others})
    table.finish()
    return values


def _made(table: StrictTable, make: Callable[..., Made], *values: Any, **keywords: Any) -> Made:
    """What `make` makes; its errors name the table."""
    try:
        return make(*values, **keywords)
    except (ValueError, TypeError) as error:
        raise table.error(str(error)) from error


def _bands(table: StrictTable) -> list[tuple[Any, Any]] | None:
    value = table.value("bands")
    if value is None:
        return None
    if not isinstance(value, list) or not all(isinstance(band, list) and len(band) == 2 for band in value):
        raise table.error(
            f"bands must be an array such as [[0.6, 'white'], [1.0, 'black']], but it is {value!r}."
        )
    return [(reach, color) for reach, color in value]


def _by_category(table: StrictTable, key: str, check: Callable[[StrictTable, str, Any], Any]) -> Any:
    """One value, or a table of one a category."""
    value = table.value(key)
    if isinstance(value, dict):
        return {category: check(table, f"{key} of {category!r}", one) for category, one in value.items()}
    return None if value is None else check(table, key, value)


def _word(table: StrictTable, what: str, value: Any) -> Any:
    if not isinstance(value, str):
        raise table.error(f"{what} must be text in quotes, but it is {value!r}.")
    return value


def _width(table: StrictTable, what: str, value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise table.error(f"{what} must be a number, a column's name or a table, but it is {value!r}.")
    return value
