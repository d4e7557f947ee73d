"""Styles of lines and polygons: what keywords resolve to, and refusals that name layer, keyword, row and cure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import geopandas
import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, box

import decalgl as dg
from decalgl.strokes import ColorBand, LinePattern, PatternMark, StrokeStyle
from small_scenes import DIAGONAL, assert_usable, flat_scene

if TYPE_CHECKING:
    from collections.abc import Callable

NAN, INF = float("nan"), float("inf")
KINDS = ["road", "track", "path", "road"]
LENGTH = st.floats(0.01, 1e4)


def frame(count: int = 4, **columns: Any) -> geopandas.GeoDataFrame:
    """Lines one above the other."""
    return geopandas.GeoDataFrame(columns, geometry=[LineString([(0, y), (90, y)]) for y in range(count)])


def lines(data: Any = None, **options: Any) -> dg.Layer:
    """A layer of lines in metres, called "roads"."""
    data = [DIAGONAL] if data is None else data
    return flat_scene().add_lines(data, name="roads", **{"width": 4.0, "width_units": "m", **options})


def polygons(count: int = 1, **options: Any) -> dg.Layer:
    """A layer of squares, called "parks"."""
    squares = [box(10 * i, 0, 10 * i + 5, 5) for i in range(count)]
    return flat_scene().add_polygons(squares, name="parks", **options)


def style_of(layer: dg.Layer, feature: int = 0) -> StrokeStyle:
    """The style of a feature's stroke."""
    assert layer.stroke is not None
    return layer.stroke.styles[0 if layer.stroke.style_of is None else layer.stroke.style_of[feature]]


def pattern_of(layer: dg.Layer, feature: int = 0) -> LinePattern:
    """The pattern of a feature's stroke."""
    pattern = style_of(layer, feature).pattern
    assert pattern is not None
    return pattern


def test_plain_lines_have_one_plain_style() -> None:
    layer = lines()
    assert layer.stroke is not None
    assert layer.stroke.styles == (StrokeStyle(),)
    assert layer.stroke.style_of is None
    assert (layer.casing, layer.fill, layer.stroke.widest) == (None, None, 0.0)


def test_words_and_numbers_for_all_rows() -> None:
    layer = lines(corner="miter", cap="butt", miter_limit=20, slope_correction="tangent", widest=9)
    style = StrokeStyle("miter", "butt", 20.0, "tangent")
    assert layer.stroke is not None
    assert (layer.stroke.styles, layer.stroke.style_of, layer.stroke.widest) == ((style,), None, 9.0)


@pytest.mark.parametrize(
    "corner",
    [
        ["miter", "round", "bevel", "miter"],
        np.array(["miter", "round", "bevel", "miter"]),
        pd.Series(["miter", None, "bevel", "miter"]),
        pd.Series(["miter", NAN, "bevel", "miter"], index=[7, 5, 3, 1]),
        pd.Series(["miter", "round", "bevel", "miter"], dtype="category"),
        "joint",
        {"road": "miter", "track": "round", "path": "bevel"},
        {"road": "miter", "track": None, "path": "bevel", "rail": "round"},
    ],
    ids=str,
)
def test_words_by_row_column_and_category(corner: Any) -> None:
    data = frame(kind=KINDS, joint=["miter", "round", "bevel", "miter"])
    layer = lines(data, corner=corner, cap="square", column="kind")
    assert [style_of(layer, i).corner for i in range(4)] == ["miter", "round", "bevel", "miter"]
    assert layer.stroke is not None
    assert len(layer.stroke.styles) == 3
    assert {style.cap for style in layer.stroke.styles} == {"square"}


def test_styles_are_as_few_as_there_are_combinations() -> None:
    layer = lines(frame(), corner=["miter", "miter", "round", "round"], cap=["butt", "round", "butt", "butt"])
    assert layer.stroke is not None
    assert len(layer.stroke.styles) == 3
    assert [style_of(layer, i).cap for i in range(4)] == ["butt", "round", "butt", "butt"]


def test_a_word_is_a_word_where_a_column_has_its_name() -> None:
    data = frame(miter=["bevel"] * 4)
    assert style_of(lines(data, corner="miter")).corner == "miter"


def test_rows_that_are_left_out_leave_styles_in_place() -> None:
    data = frame(joint=["miter", "round", "bevel", "miter"])
    data.loc[1, "geometry"] = None
    with pytest.warns(dg.DecalWarning):
        layer = lines(data, corner="joint", width=[1, NAN, 3, 4], dash=["dashed", "dotted", None, "dashed"])
    assert [style_of(layer, i).corner for i in range(3)] == ["miter", "bevel", "miter"]
    assert layer.widths.tolist() == [1.0, 3.0, 4.0]
    assert [style_of(layer, i).pattern is None for i in range(3)] == [False, True, False]


def test_layers_without_rows_take_any_style() -> None:
    layer = lines([], corner=[], dash="dashed", casing=dg.Casing(width=2), width=[])
    assert layer.stroke is not None
    assert len(layer.stroke.styles) == 1


@pytest.mark.parametrize(
    ("name", "lengths"),
    [("dashed", (3.7, 1.6)), ("dotted", (1.0, 1.65)), ("dashdot", (6.4, 1.6, 1.0, 1.6))],
)
def test_named_dashes_are_those_of_matplotlib(name: str, lengths: tuple[float, ...]) -> None:
    import matplotlib as mpl

    assert mpl.rcParamsDefault[f"lines.{name}_pattern"] == list(lengths)
    pattern = pattern_of(lines(dash=name, width=2.0))
    assert pattern.period == pytest.approx(2.0 * sum(lengths))
    drawn = [mark.end - mark.begin for mark in pattern.marks]
    assert drawn == pytest.approx([2.0 * length for length in lengths[::2]])


def test_named_dashes_follow_each_width() -> None:
    layer = lines(frame(), dash=["dashed", "dashed", (8, 2), "solid"], width=[1, 3, 5, 7])
    assert pattern_of(layer, 1).period == pytest.approx(3.0 * pattern_of(layer, 0).period)
    assert pattern_of(layer, 2) == LinePattern(10.0, (PatternMark(0.0, 8.0),))
    assert style_of(layer, 3).pattern is None
    same = lines(frame(), dash=["dashed", "dashed", (8, 2), (8, 2)], width=[1, 1, 5, 7])
    assert same.stroke is not None
    assert len(same.stroke.styles) == 2


def test_too_many_widths_of_dashes_name_the_cure() -> None:
    count = (1 << 16) + 1
    coords = np.tile([[0.0, 0.0], [1.0, 1.0]], (count, 1))
    data = (coords, np.arange(0, 2 * count + 1, 2))
    widths = np.linspace(1.0, 2.0, count)
    with pytest.raises(dg.StyleError, match=r"'roads'.*dash: 65537 different widths.*in metres"):
        lines(data, dash="dashed", width=widths)
    assert style_of(lines(data, dash=(3, 1), width=widths)).pattern is not None


@pytest.mark.parametrize(
    ("dash", "expected"),
    [
        ((4, 2), LinePattern(6.0, (PatternMark(0.0, 4.0),))),
        ([4, 2, 1, 2], LinePattern(9.0, (PatternMark(0.0, 4.0), PatternMark(6.0, 7.0)))),
        (np.array([4, 2]), LinePattern(6.0, (PatternMark(0.0, 4.0),))),
        ((3,), LinePattern(6.0, (PatternMark(0.0, 3.0),))),
        ((3, (4, 2)), LinePattern(6.0, (PatternMark(0.0, 4.0),), 3.0)),
        (dg.Pattern(9, [(1, 2), (3, 9, 1, 0)], 4),
         LinePattern(9.0, (PatternMark(1.0, 2.0), PatternMark(3.0, 9.0, 1.0, 0.0)), 4.0)),
        (dg.Pattern.dashes(4, 2, offset=-1), LinePattern(6.0, (PatternMark(0.0, 4.0),), 5.0)),
        (dg.Pattern.arrows(10, 4), LinePattern(10.0, (PatternMark(6.0, 10.0, 1.0, 0.0),))),
        (dg.Pattern.arrows(10, 4, shaft=0.25),
         LinePattern(10.0, (PatternMark(0.0, 6.0, 0.25, 0.25), PatternMark(6.0, 10.0, 1.0, 0.0)))),
        (dg.Pattern.arrows(4, 4, shaft=0.25), LinePattern(4.0, (PatternMark(0.0, 4.0, 1.0, 0.0),))),
        (dg.Pattern.stipple("11010", 2), LinePattern(10.0, (PatternMark(0.0, 4.0), PatternMark(6.0, 8.0)))),
        (dg.Pattern.stipple("01", 2, units="width"), LinePattern(16.0, (PatternMark(8.0, 16.0),))),
        (dg.Pattern(2, [(0, 1)], 0.5, "width"), LinePattern(8.0, (PatternMark(0.0, 4.0),), 2.0)),
    ],
    ids=str,
)  # fmt: skip
def test_dashes_of_every_form(dash: Any, expected: LinePattern) -> None:
    assert pattern_of(lines(dash=dash)) == expected
    rows = lines(frame(), dash=[None, dash, None, dash])
    assert pattern_of(rows, 3) == expected
    assert style_of(rows, 2).pattern is None


@given(st.lists(LENGTH, min_size=1, max_size=8), st.floats(0.01, 100.0))
def test_dashes_cover_what_their_lengths_say(lengths: list[float], width: float) -> None:
    twice = lengths * 2 if len(lengths) % 2 else lengths
    for units, scale in (("m", 1.0), ("width", width)):
        pattern = dg.Pattern.dashes(*lengths, units=units).for_width(width)  # type: ignore[arg-type]
        assert pattern.period == pytest.approx(scale * sum(twice))
        covered = [mark.end - mark.begin for mark in pattern.marks]
        assert covered == pytest.approx([scale * length for length in twice[::2]])
        assert all(0.0 <= mark.begin < mark.end <= pattern.period for mark in pattern.marks)


@given(st.lists(st.booleans(), min_size=1, max_size=31).filter(any), st.floats(0.1, 100.0))
def test_stipples_cover_the_steps_of_their_ones(bits: list[bool], step: float) -> None:
    pattern = dg.Pattern.stipple("".join("01"[bit] for bit in bits), step)
    middles = (np.arange(len(bits)) + 0.5) * step
    covered = [any(begin <= place <= end for begin, end, *_ in pattern.marks) for place in middles]
    assert covered == bits


@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["round", "miter", "bevel", None]),
            st.sampled_from(["round", "butt", "square"]),
            st.sampled_from([None, "dashed", (3.0, 1.0), "solid"]),
            st.sampled_from([1.0, 2.0, 2.5]),
        ),
        min_size=1,
        max_size=12,
    )
)
def test_each_row_keeps_its_own_style(rows: list[tuple[Any, Any, Any, float]]) -> None:
    corners, caps, dashes, widths = (list(column) for column in zip(*rows, strict=True))
    layer = lines(frame(len(rows)), corner=corners, cap=caps, dash=dashes, width=widths)
    for feature, (corner, cap, dash, width) in enumerate(rows):
        alone = style_of(lines(corner=corner, cap=cap, dash=dash, width=width))
        assert style_of(layer, feature) == alone
    assert layer.stroke is not None
    assert len(layer.stroke.styles) == len(set(layer.stroke.styles))


def test_widths_by_category_beside_a_color() -> None:
    data = frame(kind=KINDS)
    widths = {"road": 6, "track": 3, "path": 1}
    layer = lines(data, column="kind", color="grey", width=widths)
    assert layer.widths.tolist() == [6.0, 3.0, 1.0, 6.0]
    assert layer.coloring.kind == "single"
    cased = lines(data, column="kind", color="grey", casing=dg.Casing(width=widths))
    assert cased.casing is not None
    assert cased.casing.widths.tolist() == [16.0, 10.0, 6.0, 16.0]
    missing = frame(kind=["road", None, "path", "road"])
    with pytest.raises(dg.StyleError, match="'roads', row 1: width nan"):
        lines(missing, column="kind", width=widths)
    assert lines(missing, column="kind", width={**widths, None: 2}).widths.tolist() == [6.0, 2.0, 1.0, 6.0]


def test_bands_across_a_line() -> None:
    layer = lines(bands=[(0.5, "white"), (1, (1.0, 0.0, 0.0, 0.5))])
    assert style_of(layer).bands == (ColorBand(0.5, (255, 255, 255, 255)), ColorBand(1.0, (255, 0, 0, 128)))


def test_casings_add_their_width_on_each_side() -> None:
    data = frame(kind=KINDS)
    layer = lines(
        data, width=[2, 4, 6, 8], widest=10, dash="dashed", corner="miter", bands=[(1, "red")],
        casing=dg.Casing(width=[1, 1, 1, 2], color="white", alpha=0.5),
    )  # fmt: skip
    assert layer.casing is not None
    assert layer.casing.widths.tolist() == [4.0, 6.0, 8.0, 12.0]
    assert layer.casing.colors.tolist() == [[255, 255, 255, 128]] * 4
    assert layer.casing.widest == 14.0
    assert layer.casing.styles == (StrokeStyle("miter"),)
    plain = lines(casing=dg.Casing(width=1)).casing
    assert plain is not None
    assert (plain.colors.tolist(), plain.widest) == ([[0, 0, 0, 255]], 0.0)


def test_casings_by_column_and_with_dashes() -> None:
    data = frame(kind=KINDS, edge=["a", "b", "a", "b"], extra=[1, 2, 3, 4])
    casing = dg.Casing(width="extra", column="edge", cmap={"a": "red", "b": "blue"}, dash=(5, 5))
    layer = lines(data, column="kind", casing=casing)
    assert layer.casing is not None
    assert layer.casing.widths.tolist() == [6.0, 8.0, 10.0, 12.0]
    assert layer.casing.colors[:2].tolist() == [[255, 0, 0, 255], [0, 0, 255, 255]]
    assert layer.casing.styles[0].pattern == LinePattern(10.0, (PatternMark(0.0, 5.0),))
    by_kind = lines(data, column="kind", casing=dg.Casing(width={"road": 2, "track": 1, "path": 1})).casing
    assert by_kind is not None
    assert by_kind.widths.tolist() == [8.0, 6.0, 6.0, 8.0]


def test_rows_without_a_value_have_neither_casing_nor_outline() -> None:
    data = frame(height=[1.0, NAN, 3.0, 4.0])
    layer = lines(data, column="height", casing=dg.Casing(width=1))
    assert layer.casing is not None
    assert layer.casing.colors[:, 3].tolist() == [255, 0, 255, 255]
    shown = lines(data, column="height", missing_kwds={"color": "none"}, casing=dg.Casing(width=1)).casing
    assert shown is not None
    assert shown.colors[:, 3].tolist() == [255] * 4
    outline = dg.Outline(width=1, width_units="m")
    park = polygons(3, column=["a", None, "b"], outline=outline)
    assert park.stroke is not None
    assert park.stroke.colors[:, 3].tolist() == [255, 0, 255]


def test_outlines() -> None:
    outline = dg.Outline(
        width=2, width_units="m", color="red", alpha=0.5, mode="inset", order="feature", corner="bevel",
        miter_limit=30, dash=(4, 2), bands=[(1, "blue")], slope_correction="thoeny", widest=5,
    )  # fmt: skip
    layer = polygons(2, color="green", outline=outline)
    assert layer.fill is not None
    assert layer.stroke is not None
    assert layer.colors.tolist() == [[0, 128, 0, 255]] * 2
    assert layer.widths.tolist() == [0.0, 0.0]
    assert layer.stroke.colors.tolist() == [[255, 0, 0, 128]] * 2
    assert (layer.stroke.widths.tolist(), layer.stroke.widest) == ([2.0, 2.0], 5.0)
    assert (layer.outline_mode, layer.outline_order) == ("inset", "feature")
    pattern, band = LinePattern(6.0, (PatternMark(0.0, 4.0),)), ColorBand(1.0, (0, 0, 255, 255))
    assert layer.stroke.styles == (StrokeStyle("bevel", "round", 30.0, "thoeny", pattern, (band,)),)


def test_outlines_alone_and_by_column() -> None:
    outline = dg.Outline(width=[1, 2], width_units="m", column=["a", "b"], cmap={"a": "red", "b": "blue"})
    layer = polygons(2, color="none", outline=outline)
    assert layer.colors[:, 3].tolist() == [0, 0]
    assert layer.stroke is not None
    assert layer.stroke.colors.tolist() == [[255, 0, 0, 255], [0, 0, 255, 255]]
    assert layer.outline_coloring is not None
    assert layer.outline_coloring.labels == ("a", "b")
    black = polygons(outline=dg.Outline(width=1, width_units="m")).stroke
    assert black is not None
    assert black.colors.tolist() == [[0, 0, 0, 255]]


def test_hatches_by_row_and_category() -> None:
    hatch, other = dg.Hatch(20, 4), dg.Hatch(spacing=9, width=3, angle=0, crossed=True)
    even = polygons()
    assert even.fill is not None
    assert even.fill.hatches == (None,)
    one = polygons(2, hatch=hatch).fill
    assert one is not None
    assert (one.hatches, one.hatch_of) == ((hatch,), None)
    kinds = ["wood", "marsh", "lawn"]
    for given_hatch in ([hatch, other, None], {"wood": hatch, "marsh": other, "lawn": None}):
        fill = polygons(3, column=kinds, hatch=given_hatch).fill
        assert fill is not None
        assert fill.hatch_of is not None
        assert [fill.hatches[code] for code in fill.hatch_of] == [hatch, other, None]


def test_styled_layers_are_drawn() -> None:
    scene = flat_scene()
    outline = dg.Outline(width=2, width_units="m", dash="dashed", corner="miter", mode="offset")
    scene.add_polygons([box(10, 10, 40, 40)], hatch=dg.Hatch(4, 1), outline=outline)
    casing = dg.Casing(width=2, color="black")
    arrows = dg.Pattern.arrows(8, 4)
    scene.add_lines([DIAGONAL], width=4, width_units="m", cap="butt", dash=arrows, casing=casing, widest=6)
    assert (scene.render(scene.home(), (64, 64)).ids >= 0).any()
    assert_usable(scene)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"corner": "mitre"}, "'roads': corner='mitre' is not known. Did you mean 'miter'"),
        ({"corner": 3}, "'roads': corner=3 is not known"),
        ({"corner": True}, "corner=True is not known"),
        ({"corner": ["round", "mitre"]}, "'roads', row 1: corner='mitre'.*Did you mean 'miter'"),
        ({"corner": ["round", 7]}, "'roads', row 1: corner=7"),
        ({"corner": ["round"]}, "'roads': corner= lists 1 values.*2 rows"),
        ({"corner": np.zeros((2, 2))}, "'roads', row 0: corner="),
        ({"corner": {"a": "round"}}, "'roads': corner= is given by category.*no column="),
        ({"corner": {"a": "round"}, "column": ["a", "b"]}, "'roads': column= holds 'b'.*corner= does not name"),
        ({"corner": {"a": "round", "b": "x"}, "column": ["a", "b"]}, "'roads', category 'b': corner='x'"),
        ({"cap": "flat"}, "'roads': cap='flat' is not known.*butt"),
        ({"cap": None, "corner": "flat"}, "corner='flat'"),
        ({"miter_limit": -1}, "'roads': miter_limit must be an angle from 0 to 180"),
        ({"miter_limit": NAN}, "'roads': miter_limit must be a finite number"),
        ({"miter_limit": "40"}, "miter_limit must be a finite number"),
        ({"slope_correction": "tangential"}, "'roads': slope_correction='tangential'.*Did you mean 'tangent'"),
        ({"slope_correction": 1}, "slope_correction=1 is not known"),
        ({"widest": 0}, "'roads': widest must be a width above 0"),
        ({"widest": INF}, "'roads': widest must be a finite number"),
        ({"widest": 1e9}, "'roads': widest=1e\\+09 is wider than"),
        ({"widest": 3}, "'roads': widest=3 lies below the width 4 of row 0"),
        ({"widest": 3, "width": [2, 5]}, "width 5 of row 1"),
        ({"dash": "dashd"}, "'roads': dash='dashd' is no dash. Did you mean 'dashed'"),
        ({"dash": "--"}, "'roads': dash='--' is no dash. Did you mean 'dashed'"),
        ({"dash": 5}, "'roads': dash=5 is no dash"),
        ({"dash": (0, 4)}, r"'roads': dash=\(0, 4\): Dash length number 1 is 0"),
        ({"dash": (4, -1)}, "Dash length number 2 is -1"),
        ({"dash": (4, NAN)}, "Dash length number 2 must be a finite number"),
        ({"dash": [1.0] * 40}, "from 1 to 16 marks"),
        ({"dash": ()}, r"'roads': dash=\(\) is no dash|dash= lists 0"),
        ({"dash": [None, "dots"]}, "'roads', row 1: dash='dots' is no dash"),
        ({"dash": [None, {"on": 1}]}, "'roads', row 1: dash={'on': 1} is no dash"),
        ({"bands": "red"}, "'roads': bands must be a list of"),
        ({"bands": []}, "bands must be 1 to 16"),
        ({"bands": ["red"]}, "band 1 is 'red'"),
        ({"bands": [(0.5, "red"), (0.5, "blue")]}, "band 2 reaches to 0.5"),
        ({"bands": [(0.5, "red"), (1.5, "blue")]}, "band 2 reaches to 1.5"),
        ({"bands": [(0.5, "red")]}, "'roads': bands: the last one must reach to 1"),
        ({"bands": [(1, "redd")]}, "'roads'.*'redd'"),
        ({"bands": [(NAN, "red")]}, "reach of band 1 must be a finite number"),
        ({"bands": [(i / 20, "red") for i in range(1, 21)]}, "1 to 16 colours, but 20"),
        ({"bands": 3}, "bands must be a list of"),
        ({"casing": 2}, r"'roads': casing= must be a decalgl.Casing, not a int. Give casing=decalgl.Casing\("),
        ({"casing": dg.Casing(width=-1)}, "'roads', row 0: casing width -1 is not a positive"),
        ({"casing": dg.Casing(width=[1, NAN])}, "'roads', row 1: casing width nan"),
        ({"casing": dg.Casing(width=1, color="blak")}, "'roads'.*casing.*'blak'.*Did you mean 'black'"),
        ({"casing": dg.Casing(width=1, dash="dots")}, "'roads': casing dash='dots'"),
        ({"width": {"a": 1}}, "'roads': width= is given by category.*no column="),
        ({"width": {"a": "wide", "b": 2}, "column": ["a", "b"]}, "'roads': width= must give each category"),
        ({"width": {"a": 1}, "column": ["a", "b"]}, "'roads': column= holds 'b', which width= does not name"),
        ({"legend_kwds": "left"}, "'roads': legend_kwds must be a dict"),
    ],
    ids=str,
)  # fmt: skip
def test_unusable_line_styles_are_refused(options: Any, message: str) -> None:
    scene = flat_scene()
    with pytest.raises(dg.StyleError, match=message):
        scene.add_lines([DIAGONAL, DIAGONAL], name="roads", **{"width": 4, "width_units": "m", **options})
    assert_usable(scene)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"outline": "black"}, "'parks': outline= must be a decalgl.Outline, not a str"),
        ({"outline": {"width": 2}}, "'parks': outline= must be a decalgl.Outline, not a dict"),
        ({"outline": dg.Outline(width=-2, width_units="m")}, "'parks', row 0: outline width -2 is not a positive"),
        ({"outline": dg.Outline(width=[1, 2, 3], width_units="m")}, "outline width of layer 'parks'.*2 rows"),
        ({"outline": dg.Outline(width="w", width_units="m")}, "'parks' has no column 'w'"),
        ({"outline": dg.Outline(width=1, width_units="ft")}, "'parks': outline width_units must be 'm'"),
        ({"outline": dg.Outline(width=1, width_units="m", mode="inside")}, "outline mode='inside'.*normal, inset"),
        ({"outline": dg.Outline(width=1, width_units="m", order="top")}, "outline order='top'.*layer, feature"),
        ({"outline": dg.Outline(width=1, width_units="m", corner="mitre")}, "'parks': outline corner='mitre'"),
        ({"outline": dg.Outline(width=1, width_units="m", dash="dots")}, "'parks': outline dash='dots'"),
        ({"outline": dg.Outline(width=1, width_units="m", color="redd")}, "'parks': outline: .*'redd'"),
        ({"outline": dg.Outline(width=1, width_units="m", alpha=2)}, "'parks': outline: alpha"),
        ({"outline": dg.Outline(width=1, width_units="m", bands=[(1, "x")])}, "'parks'.*'x'"),
        ({"hatch": "//"}, "'parks': hatch='//' is no hatch. Give decalgl.Hatch"),
        ({"hatch": [None, 3]}, "'parks', row 1: hatch=3 is no hatch"),
        ({"hatch": [None]}, "'parks': hatch= lists 1 values.*2 rows"),
        ({"hatch": {"a": dg.Hatch(2, 1)}}, "'parks': hatch= is given by category.*no column="),
        ({"hatch": {"a": None}, "column": ["a", "b"]}, "'parks': column= holds 'b', which hatch= does not name"),
    ],
    ids=str,
)  # fmt: skip
def test_unusable_polygon_styles_are_refused(options: Any, message: str) -> None:
    scene = flat_scene()
    with pytest.raises(dg.InputError, match=message):
        scene.add_polygons([box(0, 0, 9, 9), box(0, 0, 5, 5)], name="parks", **options)
    assert_usable(scene)


def test_outlines_in_pixels_have_no_dashes() -> None:
    with pytest.raises(dg.UnsupportedError, match=r"'parks': outline dash=.*width_units='m'"):
        polygons(outline=dg.Outline(width=2, dash="dashed"))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: dg.Hatch(0, 1), "Hatch spacing must be a length above 0"),
        (lambda: dg.Hatch(2, -1), "Hatch width must be a length above 0"),
        (lambda: dg.Hatch(2, NAN), "Hatch width must be a finite number"),
        (lambda: dg.Hatch("2", 1), "Hatch spacing must be a finite number"),  # type: ignore[arg-type]
        (lambda: dg.Hatch(2, 1, angle=INF), "Hatch angle"),
        (lambda: dg.Hatch(2, 1, crossed=3), "Hatch crossed must be True or False"),  # type: ignore[arg-type]
        (lambda: dg.Pattern(0, [(0, 1)]), "Pattern period must be a length above 0"),
        (lambda: dg.Pattern(INF, [(0, 1)]), "Pattern period must be a finite number"),
        (lambda: dg.Pattern(5, []), "from 1 to 16 marks, but 0"),
        (lambda: dg.Pattern(5, "11"), "must be a list of tuples"),  # type: ignore[arg-type]
        (lambda: dg.Pattern(5, [(0, 1, 2)]), "mark 1 must be"),
        (lambda: dg.Pattern(5, [3]), "mark 1 must be"),  # type: ignore[list-item]
        (lambda: dg.Pattern(5, [(0, 6)]), "mark 1 must begin before it ends, within the period of 5"),
        (lambda: dg.Pattern(5, [(0, 1), (3, 2)]), "mark 2 must begin"),
        (lambda: dg.Pattern(5, [(-1, 2)]), "mark 1 must begin"),
        (lambda: dg.Pattern(5, [(0, NAN)]), "mark 1 must be a finite number"),
        (lambda: dg.Pattern(5, [(0, 1, 2, 0)]), "shares of the line's width"),
        (lambda: dg.Pattern(5, [(0, 1)], offset=NAN), "Pattern offset"),
        (lambda: dg.Pattern(5, [(0, 1)], units="px"), "units must be 'm' or 'width'"),  # type: ignore[arg-type]
        (lambda: dg.Pattern.dashes(), "period|marks"),
        (lambda: dg.Pattern.dashes(1, 1, units="px"), "units"),  # type: ignore[arg-type]
        (lambda: dg.Pattern.arrows(10, 11), "length must lie above 0 and up to every=10"),
        (lambda: dg.Pattern.arrows(10, 0), "length must lie above 0"),
        (lambda: dg.Pattern.arrows(10, 2, shaft=2), "shares of the line's width"),
        (lambda: dg.Pattern.stipple("0000", 2), "with a 1"),
        (lambda: dg.Pattern.stipple("12", 2), "text of 0 and 1"),
        (lambda: dg.Pattern.stipple(0xF0, 2), "text of 0 and 1"),  # type: ignore[arg-type]
        (lambda: dg.Pattern.stipple("10", 0), "Pattern period|Pattern mark"),
    ],
)  # fmt: skip
def test_patterns_and_hatches_check_themselves(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(dg.StyleError, match=message):
        make()


@pytest.mark.parametrize(
    "data",
    [
        [np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])],
        [np.zeros((3, 2)), np.zeros((4, 2))],
        [[(0, 0), (1, 0), (1, 1)]],
        np.array([[None, None]], dtype=object),
        [np.zeros(3), None],
    ],
    ids=["one array", "arrays", "tuples", "objects", "with None"],
)
def test_lists_of_plain_points_say_what_to_give(data: Any) -> None:
    scene = flat_scene()
    for add in (scene.add_polygons, scene.add_lines):
        options = {"width_units": "m"} if add == scene.add_lines else {}
        with pytest.raises(dg.InputError, match=r"'parks' cannot be made from .*\(coords, offsets\)"):
            add(data, name="parks", **options)
    assert_usable(scene)


JUNK: list[Any] = [
    None, True, 0, -1, 1.5, NAN, INF, 10**400, 1e-320, "", "red", "dashed", "round", b"x", (), [], {}, (1,), (1, 2),
    [None, None], ["red", "blue"], ["round", "butt"], (1, (2, 3)), ((1, 2), (3, 4)), [[1, 2], [3]], [{}, {}],
    np.array(3.0), np.array([1, 2]), np.array(["a", "b"]), np.zeros((2, 2)), np.zeros(0), np.datetime64("2020-01-01"),
    np.ma.array([1, 2], mask=[0, 1]), np.array([None, {}], dtype=object), pd.Series([1, 2]), pd.Series([None, pd.NA]),
    pd.Series(["a", None], dtype="category"), pd.DataFrame({"a": [1, 2]}), pd.Index(["round", "miter"]),
    pd.date_range("2020", periods=2), {"a": 1}, {"a": "round", "b": "miter"}, {1: 2}, {None: 1}, object(), len, 1j,
    range(2), iter([1, 2]), [("a", 1)], [(0.5, "red"), (1, "blue")], dg.Hatch(1, 1), dg.Pattern(1, [(0, 1)]),
    dg.Casing(width=1), dg.Outline(width=1, width_units="m"),
]  # fmt: skip
COLORS = ("color", "column", "cmap", "vmin", "vmax", "norm", "alpha", "categorical", "missing_kwds")
SHAPES = ("width", "width_units", "corner", "miter_limit", "dash", "bands", "slope_correction", "widest")
LAYER = ("legend", "legend_kwds", "order", "name", "technique")


@settings(max_examples=400, deadline=None)
@given(
    st.sampled_from(
        [(dg.Scene.add_lines, name) for name in (*COLORS, *SHAPES, *LAYER, "cap", "casing")]
        + [(dg.Scene.add_polygons, name) for name in (*COLORS, *LAYER, "hatch", "outline")]
        + [(dg.Outline, name) for name in (*COLORS, *SHAPES, "mode", "order")]
        + [(dg.Casing, name) for name in (*COLORS, "width", "dash")]
    ),
    st.sampled_from(JUNK),
    st.sampled_from([{}, {"column": ["a", "b"]}, {"column": [1.0, NAN], "legend": True}]),
)
@pytest.mark.filterwarnings("ignore::decalgl.DecalWarning")
def test_whatever_is_given_is_a_layer_or_a_decal_error(
    where: Any, value: Any, others: dict[str, Any]
) -> None:
    target, keyword = where
    scene = flat_scene()
    metres = {"width": 1, "width_units": "m"}
    squares, ways = [box(0, 0, 9, 9), box(5, 5, 8, 8)], [DIAGONAL, DIAGONAL]
    try:
        if target is dg.Outline:
            scene.add_polygons(squares, outline=dg.Outline(**{**metres, keyword: value}), **others)
        elif target is dg.Casing:
            scene.add_lines(ways, casing=dg.Casing(**{"width": 1, keyword: value}), **metres, **others)
        elif target is dg.Scene.add_polygons:
            scene.add_polygons(squares, **{**others, keyword: value})
        else:
            scene.add_lines(ways, **{**metres, **others, keyword: value})
    except dg.DecalError:
        assert scene.layers == ()
    else:
        assert len(scene.layers) == 1
