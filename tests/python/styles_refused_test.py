"""Styles of lines and polygons that cannot be: refusals name layer, keyword, row and cure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

import decalgl as dg
from small_scenes import DIAGONAL, assert_usable, flat_scene

if TYPE_CHECKING:
    from collections.abc import Callable

NAN, INF = float("nan"), float("inf")
KINDS = ["road", "track", "path", "road"]


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
        (lambda: dg.Pattern(5, [(0, 1)], units="ft"), "units must be"),  # type: ignore[arg-type]
        (lambda: dg.Pattern.dashes(), "period|marks"),
        (lambda: dg.Pattern.dashes(1, 1, units="ft"), "units"),  # type: ignore[arg-type]
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
