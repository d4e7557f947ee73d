"""Styles of lines and polygons: what keywords resolve to."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

import decalgl as dg
from decalgl.strokes import ColorBand, LinePattern, PatternMark, StrokeStyle
from small_scenes import DIAGONAL, assert_usable, flat_scene
from styled_layers import frame, lines, polygons

NAN, INF = float("nan"), float("inf")
KINDS = ["road", "track", "path", "road"]
LENGTH = st.floats(0.01, 1e4)


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
