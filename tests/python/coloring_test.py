"""Styling keywords: the same colours as GeoDataFrame.plot, and clear refusals."""

from __future__ import annotations

from typing import Any

import geopandas
import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot as plt
from matplotlib.colors import BoundaryNorm, LogNorm, Normalize, PowerNorm, TwoSlopeNorm, to_rgba
from shapely import box

from decalgl.coloring import resolve_colors
from decalgl.errors import ColumnError, DecalWarning, InputError, StyleError
from decalgl.features import Attributes, read_features

mpl.use("Agg")


def frame(**columns: Any) -> Any:
    count = len(next(iter(columns.values())))
    return geopandas.GeoDataFrame(columns, geometry=[box(i, 0, i + 1, 1) for i in range(count)])


def attributes_of(data: Any) -> Any:
    return read_features(data, "polygons", terrain_crs=None, layer_name="parks")[1]


def as_bytes(*colors: Any) -> Any:
    return np.rint(np.array([to_rgba(color) for color in colors]) * 255).astype(np.uint8)


def geopandas_colors(data: Any, **style: Any) -> Any:
    """The fill of each row as GeoPandas draws it, found again by the polygons' places."""
    figure, axes = plt.subplots()
    try:
        data.plot(ax=axes, **style)
        figure.canvas.draw()
        colors = np.zeros((len(data), 4))
        shapes: Any
        for shapes in axes.collections:
            rows = [int(path.vertices[:, 0].min()) for path in shapes.get_paths()]
            colors[rows] = shapes.get_facecolor()
        return np.rint(colors * 255).astype(np.uint8)
    finally:
        plt.close(figure)


@pytest.mark.parametrize(
    "style",
    [
        {},
        {"color": "crimson"},
        {"color": "crimson", "alpha": 0.25},
        {"color": (0.2, 0.4, 0.6)},
        {"color": ["red", "#00ff00", "blue", "none"]},
        {"column": "height"},
        {"column": "height", "cmap": "Greens", "vmin": 0, "vmax": 10},
        {"column": "height", "norm": LogNorm(), "alpha": 0.5},
        {"column": "height", "norm": LogNorm(2, 5)},
        {"column": "height", "norm": TwoSlopeNorm(4.0)},
        {"column": "height", "norm": TwoSlopeNorm(0.0), "cmap": "RdBu"},
        {"column": "height", "norm": TwoSlopeNorm(2.0, vmin=-5.0, vmax=5.0)},
        {"column": "height", "norm": BoundaryNorm([0, 2, 6, 9], 256)},
        {"column": "height", "norm": BoundaryNorm([2, 4, 6], 7, extend="both"), "cmap": "Set2"},
        {"column": "height", "norm": PowerNorm(0.5, clip=True)},
        {"column": "height", "categorical": True},
        {"column": "kind"},
        {"column": "kind", "cmap": "Set2"},
        {"column": "flag", "cmap": "viridis"},
        {"column": np.array([4.0, 3.0, 2.0, 9.0])},
        {"column": "class"},
    ],
)
def test_colors_are_those_of_geopandas(style: Any) -> None:
    data = frame(
        height=[1.0, 2.0, 5.0, 9.0], kind=["wood", "park", "wood", "field"], flag=[True, False, True, True]
    )
    data["class"] = pd.Categorical(["low", "high", "low", "mid"], categories=["low", "mid", "high"])
    coloring = resolve_colors(4, attributes_of(data), **style)
    if coloring.kind == "categorical" and tuple(map(int, geopandas.__version__.split(".")[:2])) < (1, 2):
        pytest.skip("GeoPandas chose categories' colours otherwise before 1.2")
    np.testing.assert_array_equal(coloring.colors, geopandas_colors(data, **style))


def test_many_categories_take_longer_colormaps() -> None:
    assert resolve_colors(11, column=list("abcdefghijk")).cmap.name == "tab20"
    assert resolve_colors(30, column=[str(i) for i in range(30)]).cmap.name == "viridis"
    repeated = resolve_colors(12, column=list("abcdefghijkl"), cmap="tab10").colors
    np.testing.assert_array_equal(repeated[10:], repeated[:2])


def test_missing_values_are_not_drawn_unless_given_a_look() -> None:
    data = frame(height=[1.0, np.nan, 3.0])
    columns = attributes_of(data)
    plain = resolve_colors(3, columns, column="height")
    assert plain.colors[1, 3] == 0
    assert plain.missing == 1
    shown = resolve_colors(3, columns, column="height", missing_kwds={"color": "red", "label": "no data"})
    np.testing.assert_array_equal(shown.colors[1], as_bytes("red")[0])
    np.testing.assert_array_equal(shown.colors[[0, 2]], plain.colors[[0, 2]])
    assert shown.labels == ("no data",)
    default = resolve_colors(3, columns, column="height", missing_kwds={}, alpha=0.5)
    np.testing.assert_array_equal(default.colors[1], as_bytes(("lightgrey", 0.5))[0])


@pytest.mark.parametrize(
    "values",
    [
        pd.Series([1, None, 3], dtype="Int64"),
        pd.Series(pd.to_datetime(["2020-01-01", "NaT", "2022-01-01"])),
        pd.Series(pd.to_datetime(["2020-01-01", "NaT", "2022-01-01"], utc=True)),
        np.array([1, "NaT", 5], dtype="timedelta64[s]"),
        [1, None, 3.0],
    ],
    ids=["nullable", "dates", "utc", "durations", "list"],
)
def test_numbers_come_in_many_kinds(values: Any) -> None:
    coloring = resolve_colors(3, column=values)
    assert coloring.kind == "continuous"
    assert coloring.missing == 1
    np.testing.assert_array_equal(coloring.colors[[0, 2]], as_bytes(*mpl.colormaps["viridis"]([0.0, 1.0])))


@pytest.mark.parametrize("empty", [None, np.nan, pd.NA], ids=["none", "nan", "NA"])
def test_missing_texts(empty: Any) -> None:
    coloring = resolve_colors(3, column=["b", empty, "a"])
    assert coloring.kind == "categorical"
    assert coloring.labels == ("a", "b")
    assert coloring.colors[1, 3] == 0


def test_categories_may_be_named_one_by_one() -> None:
    columns = attributes_of(frame(kind=["wood", "lake", "wood"]))
    coloring = resolve_colors(
        3, columns, column="kind", cmap={"lake": "#3366cc", "wood": "green", "road": "red"}, legend=True
    )
    np.testing.assert_array_equal(coloring.colors, as_bytes("green", "#3366cc", "green"))
    assert coloring.labels == ("lake", "wood")
    np.testing.assert_array_equal(coloring.label_colors, as_bytes("#3366cc", "green"))
    assert (coloring.title, coloring.legend) == ("kind", True)
    codes = resolve_colors(2, column=[7, 11], cmap={7: "red", 11: "blue"})
    np.testing.assert_array_equal(codes.colors, as_bytes("red", "blue"))


def test_a_category_without_a_color_is_no_silent_gap() -> None:
    columns = attributes_of(frame(kind=["wood", "lake"]))
    with pytest.raises(StyleError, match=r"'wood'.*Did you mean 'woods'"):
        resolve_colors(2, columns, column="kind", cmap={"lake": "blue", "woods": "green"})
    rest = resolve_colors(2, columns, column="kind", cmap={"lake": "blue"}, missing_kwds={"color": "grey"})
    np.testing.assert_array_equal(rest.colors, as_bytes("grey", "blue"))


def test_rows_pick_colors_but_not_the_scale() -> None:
    coloring = resolve_colors(4, column=[0.0, 1.0, 2.0, 10.0], rows=np.array([2, 0]))
    full = resolve_colors(4, column=[0.0, 1.0, 2.0, 10.0])
    np.testing.assert_array_equal(coloring.colors, full.colors[[2, 0]])
    assert (coloring.vmin, coloring.vmax) == (0.0, 10.0)


def test_color_tables_and_alphas_row_by_row() -> None:
    table = np.array([[255, 0, 0, 128], [1, 2, 3, 4]], dtype=np.uint8)
    np.testing.assert_array_equal(resolve_colors(2, color=table).colors, table)
    faded = resolve_colors(2, color=["red", "none"], alpha=[0.5, 1.0])
    np.testing.assert_array_equal(faded.colors, [[255, 0, 0, 128], [0, 0, 0, 0]])


def test_values_that_are_all_missing_or_all_equal() -> None:
    assert (resolve_colors(2, column=[np.nan, np.nan]).colors[:, 3] == 0).all()
    assert (resolve_colors(2, column=[5.0, 5.0]).colors == as_bytes(mpl.colormaps["viridis"](0.0))).all()
    assert resolve_colors(2, column=[None, None], categorical=True).labels == ()
    assert resolve_colors(0, column=np.zeros(0)).colors.shape == (0, 4)


def test_infinite_values_take_the_ends_of_the_colormap() -> None:
    colors = resolve_colors(4, column=[-np.inf, 0.0, 1.0, np.inf]).colors
    np.testing.assert_array_equal(colors[0], colors[1])
    np.testing.assert_array_equal(colors[3], colors[2])


def test_norms_find_their_limits_among_what_they_can_show() -> None:
    norm = LogNorm()
    with pytest.warns(DecalWarning, match="column=: 2 values are not drawn, as LogNorm gives them no colour"):
        coloring = resolve_colors(5, column=[0.0, 1.0, 10.0, 100.0, -5.0], norm=norm)
    assert (coloring.vmin, coloring.vmax) == (1.0, 100.0)
    np.testing.assert_array_equal(coloring.colors[1:4], as_bytes(*mpl.colormaps["viridis"]([0.0, 0.5, 1.0])))
    assert coloring.colors[[0, 4], 3].tolist() == [0, 0]
    assert coloring.left_out.tolist() == [True, False, False, False, True]
    assert not norm.scaled(), "the user's own stays as it was, for the next layer"
    assert norm.vmin is None


def test_norms_take_the_limits_that_are_given() -> None:
    coloring = resolve_colors(3, column=[1.0, 10.0, 50.0], norm=LogNorm(), vmin=0.1, vmax=10)
    assert (coloring.vmin, coloring.vmax, coloring.extend) == (0.1, 10.0, "max")
    same = resolve_colors(3, column=[1.0, 10.0, 50.0], norm=LogNorm(0.1), vmin=0.1)
    assert (same.vmin, same.vmax, same.extend) == (0.1, 50.0, "neither")
    nothing = resolve_colors(2, column=[np.nan, np.nan], norm=LogNorm(1, 10))
    assert nothing.colors[:, 3].tolist() == [0, 0]


def test_legends_know_each_row() -> None:
    coloring = resolve_colors(4, column=["b", None, "a", "b"], missing_kwds={}, rows=np.array([3, 1, 2]))
    assert coloring.labels == ("a", "b", "NaN")
    assert coloring.label_of.tolist() == [1, 2, 0]
    assert coloring.left_out.tolist() == [False] * 3
    named = resolve_colors(
        3, column=["a", "b", "c"], cmap={"c": "red", "b": "blue"}, missing_kwds={"label": "other"}
    )
    assert named.labels == ("b", "c", "other")
    assert named.label_of.tolist() == [2, 0, 1]
    plain = resolve_colors(2, column=["a", None], alpha=0.5, legend_kwds={"loc": "best"})
    assert plain.label_of.tolist() == [0, -1]
    assert plain.left_out.tolist() == [False, True]
    assert (plain.alpha, plain.legend_kwds) == (0.5, {"loc": "best"})


def test_color_wins_over_column_with_a_warning() -> None:
    with pytest.warns(DecalWarning, match="color= is used"):
        coloring = resolve_colors(2, color="red", column=[1, 2])
    assert coloring.kind == "single"


@pytest.mark.parametrize(
    ("style", "message"),
    [
        ({"color": "crimsn"}, "'crimsn'.*'crimson'"),
        ({"color": "#12345"}, "#12345"),
        ({"color": (255, 0, 0)}, "255"),
        ({"color": 5}, "no colour"),
        ({"color": ["red", "blue"]}, "2 colours.*3 rows"),
        ({"color": ["red", "blu", "red"]}, "row 1.*'blu'"),
        ({"color": ["red", None, "red"]}, "row 1"),
        ({"color": np.array([[0, 0, 0], [0, 2.0, 0], [0, 0, 0]])}, "row 1"),
        ({"color": np.zeros((3, 2))}, r"\(rows, 3\)"),
        ({"column": [1, 2, 3], "cmap": "Gren"}, "'Gren'.*Did you mean"),
        ({"column": [1, 2, 3], "cmap": 7}, "cmap=7"),
        ({"column": [1, 2, 3], "vmin": 5, "vmax": 4}, "vmin=5 lies above vmax=4"),
        ({"column": [1, 2, 3], "vmin": "low"}, "vmin must be a number"),
        ({"column": [1, 2, 3], "vmax": np.inf}, "vmax must be finite"),
        ({"column": [1, 2, 3], "norm": "log"}, "norm='log'"),
        ({"column": [1, 2, 3], "norm": LogNorm}, "norm=.*LogNorm.*must be a matplotlib normalisation"),
        ({"column": [1, 2, 3], "norm": LogNorm(-1, 5)}, "norm= cannot show column="),
        ({"column": [-1, -2, -3], "norm": LogNorm()}, "norm= cannot show column="),
        ({"column": [1, 2, 3], "norm": TwoSlopeNorm(2.5), "vmin": 7}, "norm= cannot show column="),
        ({"column": [1, 2, 3], "norm": Normalize(0, 5), "vmax": 3}, "vmax=3 is given, but norm= has vmax=5"),
        ({"column": [1, 2, 3], "norm": LogNorm(), "vmin": "low"}, "vmin must be a number"),
        ({"column": [1, 2]}, "3 rows"),
        ({"column": ["a", "b", "c"], "categorical": False}, "categorical=False"),
        ({"column": "kind"}, "no columns"),
        ({"alpha": 1.5}, "alpha.*1.5"),
        ({"alpha": [0.5, 0.5]}, "3 rows"),
        ({"alpha": "half"}, "alpha='half'"),
        ({"alpha": np.nan}, "nan"),
        ({"column": [1, np.nan, 3], "missing_kwds": {"colour": "red"}}, "'colour'.*Did you mean 'color'"),
        ({"column": [1, np.nan, 3], "missing_kwds": {"color": "redd"}}, "'redd'"),
    ],
)
def test_unusable_styles_are_refused(style: Any, message: Any) -> None:
    with pytest.raises(StyleError, match=message):
        resolve_colors(3, **style)


def test_unknown_columns_name_close_ones() -> None:
    columns = attributes_of(frame(kind=["a"], height=[1.0]))
    with pytest.raises(ColumnError, match=r"'parks' has no column 'kinds'. Did you mean 'kind'") as caught:
        resolve_colors(1, columns, column="kinds")
    assert not str(caught.value).startswith('"'), "a sentence, not the repr that KeyError shows"
    assert isinstance(caught.value, KeyError)
    with pytest.raises(ColumnError, match="Its columns are: none"):
        Attributes("lines", 3).raw("kind")


def test_numbers_by_column_array_or_constant() -> None:
    columns = attributes_of(frame(width=[1, 2], name=["a", "b"]))
    np.testing.assert_array_equal(columns.numbers("width", "width"), [1.0, 2.0])
    np.testing.assert_array_equal(columns.numbers(3, "width"), [3.0, 3.0])
    np.testing.assert_array_equal(columns.numbers([3, 4], "width"), [3.0, 4.0])
    np.testing.assert_array_equal(columns.column("name"), ["a", "b"])
    with pytest.raises(InputError, match="must be numbers"):
        columns.numbers("name", "width")
    with pytest.raises(InputError, match="2 rows"):
        columns.numbers([1, 2, 3], "width")
