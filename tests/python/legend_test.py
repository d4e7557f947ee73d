"""Legends: what GeoPandas' own say, in the colours of the picture, read from the pixels of what is saved."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import geopandas
import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot as plt
from matplotlib.colors import BoundaryNorm, LogNorm, to_rgba
from PIL import Image
from shapely import LineString, box

import decalgl as dg
from small_scenes import MAP, flat_scene

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

mpl.use("Agg")
NAN = float("nan")
SIZE = (400, 300)
GROUND = dg.Relief(color="#808080", strength=0.0)


@pytest.fixture
def axes() -> Iterator[Any]:
    """Axes of matplotlib in a figure of their own."""
    figure, made = plt.subplots()
    yield made
    plt.close(figure)


def parks(**columns: Any) -> geopandas.GeoDataFrame:
    """A row of squares in the map's lower left."""
    count = len(next(iter(columns.values())))
    return geopandas.GeoDataFrame(columns, geometry=[box(8 * i, 0, 8 * i + 6, 6) for i in range(count)])


def roads(**columns: Any) -> geopandas.GeoDataFrame:
    count = len(next(iter(columns.values())))
    return geopandas.GeoDataFrame(
        columns, geometry=[LineString([(0, 3 * i), (40, 3 * i)]) for i in range(count)]
    )


def scene_of() -> dg.Scene:
    return flat_scene(relief=GROUND)


def render(scene: dg.Scene, size: tuple[int, int] = SIZE) -> dg.Frame:
    return scene.render(MAP, size, antialias="none", background="#808080")


def saved(frame: dg.Frame, folder: Path, **options: Any) -> NDArray[np.uint8]:
    """The pixels of the picture as it is saved."""
    frame.save(folder / "map.png", **options)
    with Image.open(folder / "map.png") as picture:
        return np.array(picture)


def shown(pixels: NDArray[np.uint8], color: Any) -> int:
    """How many pixels have a colour."""
    rgb = np.rint(np.array(to_rgba(color)) * 255)[:3]
    return int((pixels[..., :3] == rgb).all(axis=-1).sum())


def texts(legend: Any) -> list[str]:
    return [text.get_text() for text in legend.get_texts()]


def face(handle: Any) -> list[int]:
    """The colour of an entry, of whatever artist it is, in bytes."""
    for name in ("get_facecolor", "get_color", "get_edgecolor"):
        if hasattr(handle, name):
            color = np.atleast_2d(getattr(handle, name)())
            if color.size:
                one = to_rgba(color[0] if color.dtype.kind == "f" else color.item())
                return [round(255 * channel) for channel in one]
    raise AssertionError(handle)


@pytest.mark.parametrize(
    "style",
    [
        {"column": "kind"},
        {"column": "kind", "cmap": "Set2"},
        {"column": "kind", "cmap": {"wood": "green", "lake": "#3366cc", "field": "gold"}},
        {"column": "class"},
        {"column": "height", "categorical": True, "cmap": "viridis"},
        {"column": "gap", "missing_kwds": {"color": "lightgrey", "label": "unknown"}},
        {"column": "gap"},
        {"column": "kind", "alpha": 0.5},
    ],
)
@pytest.mark.parametrize("kind", ["polygons", "lines"])
def test_entries_are_those_of_geopandas(style: Any, kind: str, axes: Any) -> None:
    make = parks if kind == "polygons" else roads
    data = make(
        kind=["wood", "lake", "wood", "field"], height=[1, 5, 5, 9], gap=["a", None, "b", "a"],
    )  # fmt: skip
    data["class"] = pd.Categorical(["low", "high", "low", "mid"], categories=["low", "mid", "high", "top"])
    data.plot(ax=axes, legend=True, **style)
    theirs = axes.get_legend()
    scene = flat_scene()
    if kind == "polygons":
        layer = scene.add_polygons(data, legend=True, **style)
    else:
        layer = scene.add_lines(data, legend=True, width=1, width_units="m", **style)
    ours = layer.legend(axes)
    assert texts(ours) == texts(theirs)
    if not (
        kind == "lines" and "alpha" in style
    ):  # GeoPandas keeps the alpha of lines apart from their colour
        assert [face(one) for one in ours.legend_handles] == [face(one) for one in theirs.legend_handles]


@pytest.mark.parametrize(
    "style",
    [
        {},
        {"cmap": "magma", "vmin": 2},
        {"vmax": 50},
        {"vmin": 2, "vmax": 50},
        {"norm": LogNorm(), "cmap": "Greens"},
        {"norm": BoundaryNorm([0, 10, 100], 256)},
        {"legend_kwds": {"orientation": "horizontal", "label": "height"}},
    ],
)
def test_colorbars_are_those_of_geopandas(style: Any, axes: Any) -> None:
    data = parks(height=[1.0, 10.0, NAN, 100.0])
    data.plot("height", ax=axes, legend=True, **style)
    theirs = axes.figure.axes[1]._colorbar
    layer = flat_scene().add_polygons(data, column="height", legend=True, **style)
    ours = layer.legend(axes)
    assert (ours.vmin, ours.vmax, ours.extend) == (theirs.vmin, theirs.vmax, theirs.extend)
    assert ours.orientation == theirs.orientation
    assert ours.cmap == theirs.cmap
    assert type(ours.norm) is type(theirs.norm)
    values = np.linspace(1.0, 100.0, 7)
    np.testing.assert_allclose(ours.norm(values), theirs.norm(values))
    label = style.get("legend_kwds", {}).get("label", "height")
    assert (ours.ax.get_ylabel() or ours.ax.get_xlabel()) == label


def test_saved_pictures_have_the_legends_that_layers_ask_for(tmp_path: Path) -> None:
    scene = scene_of()
    data = parks(kind=["wood", "lake", "wood", None])
    scene.add_polygons(data, column="kind", cmap={"wood": "#00ff00", "lake": "#0000ff"}, legend=True,
                       missing_kwds={"color": "#ff00ff", "label": "unknown"})  # fmt: skip
    frame = render(scene)
    image, pixels = frame.image, saved(frame, tmp_path)
    changed = (image != pixels).any(axis=-1)
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    assert columns.max() > SIZE[0] - 15, "in the upper right corner"
    assert columns.min() > SIZE[0] / 2
    assert rows.max() < SIZE[1] / 2
    box_ = pixels[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    counts = [shown(box_, color) for color in ("#00ff00", "#0000ff", "#ff00ff")]
    assert min(counts) > 100
    assert max(counts) < 1.3 * min(counts), "entries of one size"
    assert shown(box_, "black") > 20, "texts"
    assert (saved(frame, tmp_path, legend=True) == pixels).all()
    assert (saved(frame, tmp_path, legend=False) == image).all()
    assert (frame.image == image).all()


def test_translucent_categories_are_as_translucent_in_the_legend(tmp_path: Path) -> None:
    scene = scene_of()
    scene.add_polygons(parks(kind=["a"]), column="kind", cmap={"a": "red"}, alpha=0.5, legend=True,
                       legend_kwds={"framealpha": 1.0})  # fmt: skip
    pixels = saved(render(scene), tmp_path)
    half = (np.abs(pixels[:150, 200:, :3].astype(int) - (255, 127, 127)) <= 1).all(axis=-1)
    assert half.sum() > 100


@pytest.mark.parametrize("orientation", ["vertical", "horizontal"])
def test_colorbars_in_saved_pictures(orientation: str, tmp_path: Path) -> None:
    scene = scene_of()
    scene.add_polygons(parks(height=[0.0, 1.0, 2.0, NAN]), column="height", cmap=["#ff0000", "#00ff00", "#0000ff"],
                       legend=True, legend_kwds={"orientation": orientation, "label": "height (m)", "shrink": 0.5},
                       missing_kwds={"color": "#ffff00"}, name="heights")  # fmt: skip
    frame = render(scene)
    pixels = saved(frame, tmp_path)
    assert (pixels[150:, :200] == frame.image[150:, :200]).all()
    upper = pixels[:, 200:]
    where = {color: np.argwhere((upper[..., :3] == np.array(to_rgba(color))[:3] * 255).all(axis=-1))
             for color in ("#ff0000", "#00ff00", "#0000ff")}  # fmt: skip
    assert all(len(places) > 300 for places in where.values())
    low, middle, high = (places.mean(axis=0) for places in where.values())
    if orientation == "vertical":
        assert low[0] > middle[0] + 20 > high[0] + 40, "the highest on top"
    else:
        assert low[1] < middle[1] - 20 < high[1] - 40
    assert shown(upper, "#ffff00") > 100, "missing values have a key"


def test_layers_of_one_color_share_a_box_with_their_names(tmp_path: Path) -> None:
    scene = scene_of()
    scene.add_polygons(parks(kind=[1]), color="#00ff00", legend=True, name="woods")
    scene.add_lines(roads(kind=[1]), color="#0000ff", width=2, width_units="m", legend=True, name="roads")
    scene.add_polygons(parks(kind=[1]), color="#ff00ff", name="not asked for")
    handles = [handle for layer in scene.layers[:2] for handle in layer.legend_handles()]
    assert [handle.get_label() for handle in handles] == ["woods", "roads"]
    pixels = saved(render(scene), tmp_path)[:150, 200:]
    assert shown(pixels, "#00ff00") > 100
    assert shown(pixels, "#0000ff") > 50
    assert shown(pixels, "#ff00ff") == 0


def test_several_legends_do_not_overlap(tmp_path: Path) -> None:
    scene = scene_of()
    for number in range(5):
        column = [f"{number} {name}" for name in "abc"]
        scene.add_polygons(parks(kind=column), column="kind", cmap=["red", "lime", "blue"], legend=True)
    pixels = saved(render(scene), tmp_path)[:250]
    counts = [shown(pixels, color) for color in ("red", "lime", "blue")]
    assert min(counts) > 5 * 100, "all of five boxes, one below the other, then beside"


def test_legends_where_their_keywords_say(tmp_path: Path) -> None:
    scene = scene_of()
    keywords = {"loc": "lower left", "title": "Land", "labels": ["forest", "water"], "ncols": 2}
    layer = scene.add_polygons(
        parks(kind=["a", "b"]),
        column="kind",
        cmap={"a": "#00ff00", "b": "#0000ff"},
        legend=True,
        legend_kwds=keywords,
    )
    frame = render(scene)
    changed = (saved(frame, tmp_path) != frame.image).any(axis=-1)
    assert not changed[:, 300:].any()
    assert not changed[:150].any()
    assert changed[250:, :200].any()
    assert keywords["labels"] == ["forest", "water"], "the user's dict stays"
    assert [handle.get_label() for handle in layer.legend_handles()] == ["a", "b"]


def test_pictures_without_alpha_have_legends_too(tmp_path: Path) -> None:
    scene = scene_of()
    scene.add_polygons(parks(kind=["a"]), column="kind", cmap={"a": "lime"}, legend=True)
    frame = scene.render(dg.Camera.top_down((-500, -500, 600, 600)), SIZE, background=None)
    frame.save(tmp_path / "map.jpg")
    with Image.open(tmp_path / "map.jpg") as picture:
        pixels = np.array(picture).astype(int)[:60, 300:]
    assert (np.abs(pixels - (0, 255, 0)).max(axis=-1) < 30).sum() > 100
    transparent = saved(frame, tmp_path)
    assert transparent[-1, 0, 3] == 0
    assert shown(transparent[:60, 300:], "lime") > 100


def keys(layer: dg.Layer, axes: Any, scale: float = 4.0) -> NDArray[np.uint8]:
    """The pixels of the layer's keys, enlarged."""
    axes.set_axis_off()
    legend = layer.legend(axes, fontsize=10 * scale, handlelength=3, loc="center")
    legend.set_frame_on(False)
    for text in legend.get_texts():
        text.set_visible(False)
    axes.figure.canvas.draw()
    return np.array(axes.figure.canvas.buffer_rgba())


def test_keys_of_lines_have_dashes_and_casings(axes: Any) -> None:
    layer = flat_scene().add_lines(
        roads(kind=["a", "b"]), column="kind", cmap={"a": "#ff0000", "b": "#0000ff"}, width={"a": 8, "b": 4},
        width_units="m", dash={"a": None, "b": (20, 10)}, casing=dg.Casing(width=2, color="#00ff00"), cap="butt",
    )  # fmt: skip
    plain, dashed = layer.legend_handles()
    assert plain.get_linewidth() == pytest.approx(2.0 * dashed.get_linewidth())
    assert not plain.is_dashed()
    assert dashed.is_dashed()
    pixels = keys(layer, axes)
    blue = (pixels[..., :3] == (0, 0, 255)).all(axis=-1)
    runs = np.diff(np.concatenate([[0], blue[np.flatnonzero(blue.any(axis=1))[0]].astype(int), [0]])) == 1
    assert runs.sum() >= 2, "dashes"
    assert shown(pixels, "#00ff00") > 100
    red = np.argwhere((pixels[..., :3] == (255, 0, 0)).all(axis=-1))
    above = pixels[red[:, 0].min() - 2, int(red[:, 1].mean()), :3].tolist()
    below = pixels[red[:, 0].max() + 2, int(red[:, 1].mean()), :3].tolist()
    for edge in (above, below):
        assert edge == pytest.approx([0, 255, 0], abs=8), "a casing on both sides"


def test_keys_of_lines_have_bands_and_arrows(axes: Any) -> None:
    scene = flat_scene()
    banded = scene.add_lines(
        roads(kind=[1]), width=8, width_units="m", bands=[(0.5, "#ff0000"), (1, "#0000ff")]
    )
    pixels = keys(banded, axes)
    assert shown(pixels, "#ff0000") > 30
    assert shown(pixels, "#0000ff") > 30
    assert shown(pixels, banded.coloring.label_colors[0] / 255) == 0
    axes.clear()
    arrows = dg.Pattern.arrows(20, 20)
    layer = scene.add_lines(
        roads(kind=[1]), width=40, width_units="m", dash=arrows, color="#0000ff", cap="butt"
    )
    drawn = (keys(layer, axes)[..., :3] == (0, 0, 255)).all(axis=-1)
    heights = drawn.sum(axis=0)[drawn.any(axis=0)]
    assert heights[0] > 1.5 * heights[len(heights) // 2 - 2], "arrowheads grow narrower"


def test_keys_of_polygons_have_outlines_and_hatches(axes: Any) -> None:
    outline = dg.Outline(width=2, width_units="m", color="#0000ff", dash="dashed")
    layer = flat_scene().add_polygons(
        parks(kind=["a", "b"]), column="kind", cmap={"a": "#ff0000", "b": "#00ff00"}, outline=outline,
        hatch={"a": dg.Hatch(10, 2), "b": None},
    )  # fmt: skip
    hatched, even = layer.legend_handles()
    assert hatched.get_hatch() == "////"
    assert to_rgba(hatched.get_facecolor())[3] == 0.0
    assert even.get_hatch() is None
    assert even.get_edgecolor() == to_rgba("#0000ff")
    pixels = keys(layer, axes)
    filled, lines = shown(pixels, "#00ff00"), shown(pixels, "#ff0000")
    assert filled > 1000
    assert 50 < lines < 0.8 * filled
    assert shown(pixels, "#0000ff") > 100


@pytest.mark.parametrize(
    ("hatch", "symbol"),
    [(dg.Hatch(9, 1, 0), "----"), (dg.Hatch(9, 1, 90), "||||"), (dg.Hatch(9, 1, 135), "\\\\" * 2),
     (dg.Hatch(9, 1, -45), "\\\\" * 2), (dg.Hatch(9, 1, crossed=True), "xxxx"), (dg.Hatch(9, 1, 90, True), "++++")],
)  # fmt: skip
def test_hatches_of_keys_have_the_nearest_angle(hatch: dg.Hatch, symbol: str) -> None:
    layer = flat_scene().add_polygons(parks(kind=[1]), hatch=hatch)
    assert layer.legend_handles()[0].get_hatch() == symbol


def test_outlines_by_column_explain_layers_without_fills(tmp_path: Path) -> None:
    scene = scene_of()
    outline = dg.Outline(width=1, width_units="m", column=["a", "b"], cmap={"a": "#ff0000", "b": "#0000ff"})
    layer = scene.add_polygons(parks(kind=[1, 2]), color="none", outline=outline, legend=True)
    handles = layer.legend_handles()
    assert [handle.get_label() for handle in handles] == ["a", "b"]
    assert [handle.get_edgecolor() for handle in handles] == [to_rgba("#ff0000"), to_rgba("#0000ff")]
    assert [handle.get_facecolor()[3] for handle in handles] == [0.0, 0.0]
    pixels = saved(render(scene), tmp_path)[:150, 200:]
    assert shown(pixels, "#ff0000") > 20


def test_layers_without_features_have_legends() -> None:
    scene = flat_scene()
    empty = scene.add_polygons([], column=[], categorical=True, legend=True)
    assert empty.legend_handles() == []
    line = scene.add_lines([], width=2, width_units="m", color="red", legend=True, casing=dg.Casing(width=1))
    assert [handle.get_label() for handle in line.legend_handles()] == ["lines 1"]
    class_ = pd.Categorical(["a"], categories=["a", "b"])
    unused = scene.add_lines(roads(kind=class_), column="kind", width=2, width_units="m", legend=True)
    assert [handle.get_label() for handle in unused.legend_handles()] == ["a", "b"]


def test_colors_by_row_have_no_legend(tmp_path: Path) -> None:
    scene = scene_of()
    with pytest.warns(dg.DecalWarning, match=r"'woods': colours that are given row by row.*column="):
        layer = scene.add_polygons(parks(kind=[1, 2]), color=["red", "blue"], legend=True, name="woods")
    assert layer.legend_handles() == []
    frame = render(scene)
    assert (saved(frame, tmp_path) == frame.image).all()


@pytest.mark.parametrize(
    ("style", "keywords", "message"),
    [
        ({"column": "kind"}, {"titel": "x"}, "'woods': legend_kwds has the unknown key 'titel'.*'title'"),
        ({"column": "height"}, {"lable": "x"}, "'woods': legend_kwds has the unknown key 'lable'.*'label'"),
        ({"column": "height"}, {"title": "x"}, "unknown key 'title'.*Figure.colorbar"),
        ({"column": "kind"}, {"loc": "nowhere"}, "'woods': matplotlib refuses legend_kwds: 'nowhere'"),
        ({"column": "kind"}, {"labels": ["one"]}, "'woods': legend_kwds has 1 labels.*2 entries: a, b"),
        ({"column": "kind"}, {"ncols": "two"}, "'woods': matplotlib refuses legend_kwds"),
        ({"column": "height"}, {"orientation": "up"}, "'woods': matplotlib refuses legend_kwds"),
    ],
)
def test_unusable_keywords_are_refused(style: Any, keywords: Any, message: str, axes: Any) -> None:
    scene = flat_scene()
    data = parks(kind=["a", "b"], height=[1, 2])
    with pytest.raises(dg.StyleError, match=message):
        scene.add_polygons(data, name="woods", legend=True, legend_kwds=keywords, **style)
    assert scene.layers == ()
    layer = scene.add_polygons(data, name="woods", **style)
    with pytest.raises(dg.StyleError, match=message):
        layer.legend(axes, **keywords)


def test_texts_of_the_data_are_no_formulas(tmp_path: Path) -> None:
    scene = scene_of()
    data = parks(**{"$x_$": ["$5 to $10", "^$_$", "50 %"], "y$_$": [1.0, 2.0, 3.0]})
    layer = scene.add_polygons(data, column="$x_$", legend=True)
    scene.add_polygons(data, column="y$_$", legend=True)
    scene.add_polygons(data, color="red", name="z$_$", legend=True)
    render(scene).save(tmp_path / "map.png")
    assert layer.coloring.labels == ("$5 to $10", "50 %", "^$_$")


def test_pictures_without_anything_to_explain(tmp_path: Path) -> None:
    scene = scene_of()
    scene.add_polygons(parks(kind=["a"]), column="kind")
    frame = render(scene)
    assert (saved(frame, tmp_path) == frame.image).all()
    with pytest.raises(dg.StyleError, match=r"no legend to draw\. Add layers with legend=True"):
        frame.save(tmp_path / "map.png", legend=True)
    with pytest.raises(dg.StyleError, match=r"'polygons 0' is not coloured by numbers.*legend_handles"):
        scene.layers[0].scalar_mappable()


def test_legends_show_the_colours_that_layers_were_restyled_to(tmp_path: Path) -> None:
    scene = scene_of()
    data = parks(kind=["wood", "lake", "wood", "marsh"], height=[1.0, 2.0, 3.0, 4.0])
    colors = {"wood": "#00ff00", "lake": "#0000ff", "marsh": "#ff00ff"}
    scene.add_polygons(data, name="parks", column="kind", cmap=colors, legend=True)
    renderer = dg.Renderer(SIZE, "none")
    renderer.preprocess(scene)
    renderer.update(MAP)

    def legend_pixels(frame: dg.Frame) -> NDArray[np.uint8]:
        pixels = saved(frame, tmp_path)
        return pixels[(pixels != frame.image).any(axis=-1)][None]

    first = renderer.render()
    renderer.restyle("parks", column="kind", cmap={**colors, "wood": "#ff8000"})
    recolored = legend_pixels(renderer.render())
    assert shown(recolored, "#ff8000") > 100
    assert shown(recolored, "#00ff00") == 0
    assert shown(legend_pixels(first), "#00ff00") > 100, "frames of before keep theirs"
    renderer.restyle("parks", color="red", where="kind == 'wood'")
    assert (legend_pixels(renderer.render()) == recolored).all(), "what is marked is not explained"
    renderer.restyle("parks", column="kind", cmap=colors, opacity={"lake": 0.0, "marsh": 0.5})
    faded = legend_pixels(renderer.render())
    assert shown(faded, "#00ff00") > 100
    assert shown(faded, "#0000ff") == shown(faded, "#ff00ff") == 0
    renderer.restyle("parks", visible="kind == 'lake'")
    assert (saved(frame := renderer.render(), tmp_path) == frame.image).all(), "nothing is left to explain"
    renderer.restyle("parks", visible=True, opacity=1.0, column="height", cmap=["#000000", "#ff0000"])
    assert shown(legend_pixels(renderer.render()), "#ff0000") > 0
    renderer.restyle("parks", color="teal", alpha=1.0)
    rows = renderer.edit("parks", add=[box(0, 0, 10, 10)], color="yellow")
    assert shown(legend_pixels(renderer.render()), "teal") > 100
    renderer.edit("parks", remove=rows)
    renderer.preprocess(scene)
    renderer.update(MAP)
    assert (saved(renderer.render(), tmp_path) == saved(first, tmp_path)).all()


def test_opened_scenes_have_no_legends(tmp_path: Path) -> None:
    scene = scene_of()
    scene.add_polygons(parks(kind=["a"]), column="kind", legend=True)
    renderer = dg.Renderer(SIZE)
    renderer.preprocess(scene)
    renderer.save(tmp_path / "map.decal")
    renderer.open(tmp_path / "map.decal")
    renderer.update(MAP)
    frame = renderer.render()
    assert (saved(frame, tmp_path) == frame.image).all()
    with pytest.raises(
        dg.StyleError, match=r"from a file has no legends. Open it by preprocess\(scene, cache"
    ):
        frame.save(tmp_path / "map.png", legend=True)
    renderer.preprocess(scene, cache=tmp_path / "map.decal")
    renderer.update(MAP)
    frame = renderer.render()
    assert "open" in frame.stats.preprocess
    assert (saved(frame, tmp_path) != frame.image).any()


def test_legends_that_do_not_fit_are_told_of(tmp_path: Path) -> None:
    scene = scene_of()
    names = [f"category {number}" for number in range(30)]
    scene.add_polygons(parks(kind=names), column="kind", legend=True)
    with pytest.warns(dg.DecalWarning, match="do not fit into a picture of 400 x 300 pixels"):
        render(scene).save(tmp_path / "map.png")


def test_current_axes_are_the_default(axes: Any) -> None:
    plt.sca(axes)
    layer = flat_scene().add_polygons(parks(kind=["a"]), column="kind")
    assert layer.legend(title="Kinds") is axes.get_legend()
    assert axes.get_legend().get_title().get_text() == "Kinds"


def test_without_matplotlib_legends_say_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    layer = flat_scene().add_polygons(parks(kind=["a"]), column="kind")
    for name in ("matplotlib.patches", "matplotlib.legend"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(dg.UnsupportedError, match="pip install matplotlib"):
        layer.legend_handles()
