"""Restyling: the picture is that of a scene prepared so, and nothing else changes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import decalgl as dg
from changed_scenes import (
    BOTH,
    EVERY_WAY,
    FAR,
    INDEXES,
    PLAIN,
    RESTYLES,
    TWO_COVERAGES,
    assert_same,
    picks,
    prepared,
    scene_of,
)
from small_scenes import OBLIQUE, SIZE

if TYPE_CHECKING:
    from pathlib import Path


@EVERY_WAY
@pytest.mark.parametrize("name", RESTYLES)
def test_a_restyled_picture_is_that_of_a_scene_prepared_so(name: str, antialias: str, index: str) -> None:
    restyle, style = RESTYLES[name]
    ways = {"color": "black", "width": 1.0}
    expected = prepared(scene_of(style, ways), antialias, index=index).render()
    renderer = prepared(scene_of(PLAIN, ways), antialias, index=index)
    before = renderer.render()
    assert not any("LEVELS" in variant for variant in before.stats.variants)
    renderer.restyle("areas", **restyle)
    after = renderer.render()
    assert_same(after, expected)
    assert picks(after) == picks(expected)
    assert (after.image != before.image).any()


@INDEXES
@BOTH
def test_widths_change_up_to_the_prepared_maximum(antialias: str, index: str) -> None:
    # In small buckets, as lines that wide have coarser vertices than narrow ones in large ones.
    wide = scene_of(PLAIN, {"color": "navy"}, widest=9.0, south=0.0)
    for width in (9.0, 0.5, 2.0):
        renderer = prepared(wide, antialias, index=index)
        renderer.restyle("ways", width=width)
        frame = renderer.render()
        ways = {"color": "navy", "width": width}
        # Of the same widest lines, so that vertices are rounded alike.
        same = prepared(scene_of(PLAIN, ways, widest=9.0, south=0.0), antialias, index=index).render()
        assert np.abs(frame.image.astype(int) - same.image).max() <= 1
        expected = prepared(scene_of(PLAIN, ways, south=0.0), antialias, index=index).render()
        np.testing.assert_array_equal(frame.ids, expected.ids)
        assert picks(frame) == picks(expected)


def test_widths_are_refused_beyond_what_was_prepared() -> None:
    renderer = prepared(scene_of(PLAIN, {}, widest=9.0))
    before = renderer.render()
    with pytest.raises(dg.StyleError, match=r"'ways'.* 9\.5 m .*widest="):
        renderer.restyle("ways", width=9.5)
    with pytest.raises(dg.StyleError, match="row 3: width -1"):
        renderer.restyle("ways", width=[1.0, 1.0, 1.0, -1.0] + [1.0] * 26)
    with pytest.raises(dg.StyleError, match="fills have no width"):
        renderer.restyle("areas", width=1.0)
    assert_same(renderer.render(), before)
    fixed = prepared(scene_of(PLAIN, {}))
    with pytest.raises(dg.StyleError, match=r"'ways'.*prepared without widest"):
        fixed.restyle("ways", width=1.0)


STYLES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "dashes": ({"dash": (6, 4)}, {"dash": (3, 7)}),
    "corners": ({"corner": "miter"}, {"corner": "bevel"}),
    "corners of some": ({"corner": "round", "cap": "butt"}, {"corner": ["round", "bevel"] * 15}),
    "bands": (
        {"bands": [(0.5, "white"), (1.0, "black")]},
        {"bands": [(0.2, "red"), (0.4, "tan"), (1.0, "blue")]},
    ),
}


@INDEXES
@BOTH
@pytest.mark.parametrize(("south", "most"), [(0.0, 5.0), (1000.0, TWO_COVERAGES)], ids=["levels", "cells"])
@pytest.mark.parametrize("name", STYLES)
def test_styles_change_where_the_index_has_their_places(
    name: str, south: float, most: float, antialias: str, index: str
) -> None:
    """From levels of detail, and cell by cell."""
    before, after = STYLES[name]
    fixed = {"width": 5.0, **({"cap": before["cap"]} if "cap" in before else {})}
    renderer = prepared(scene_of(PLAIN, {**fixed, **before}, south=south), antialias, index=index)
    first = renderer.render()
    renderer.restyle("ways", **after)
    frame, expected = (
        renderer.render(),
        prepared(scene_of(PLAIN, {**fixed, **after}, south=south), antialias, index=index).render(),
    )
    np.testing.assert_array_equal(frame.ids, expected.ids)
    # Lists made for miters lead some pixels another way.
    apart = np.abs(frame.image.astype(int) - expected.image)
    assert apart.max() <= (most if antialias == "coverage" else 0)
    assert (apart.max(axis=-1) > 1).mean() < 0.01
    assert (frame.image != first.image).any()


@INDEXES
def test_hatches_change_as_they_like(index: str) -> None:
    renderer = prepared(scene_of(PLAIN, {}), index=index)
    plain = renderer.render()
    hatches = [dg.Hatch(8, 3), None, dg.Hatch(5, 2, angle=10, crossed=True), None] * 10
    renderer.restyle("areas", hatch=hatches)
    assert_same(renderer.render(), prepared(scene_of({**PLAIN, "hatch": hatches}, {}), index=index).render())
    renderer.edit("areas", remove=list(range(10)))
    renderer.restyle("areas", hatch=False)
    expected = prepared(scene_of(PLAIN, {}), index=index)
    expected.edit("areas", remove=list(range(10)))
    assert_same(renderer.render(), expected.render())
    assert (plain.image != renderer.render().image).any()


REFUSED: dict[str, tuple[dict[str, Any], dict[str, Any], str]] = {
    "a dash of none": ({}, {"dash": (4, 4)}, "keeps its period"),
    "another period": ({"dash": (4, 4)}, {"dash": (4, 5)}, "keeps its period and offset, here 8.0"),
    "a corner of round lines": ({}, {"corner": "bevel"}, "round all over"),
    "a farther corner": ({"corner": "bevel"}, {"corner": "miter"}, "reaches farther"),
    "bands of none": ({}, {"bands": [(1.0, "red")]}, "prepared with bands"),
    "a cap": ({}, {"cap": "butt"}, "cap= is what"),
    "a hatch of lines": ({}, {"hatch": dg.Hatch(1, 1)}, "no style of lines"),
}


@INDEXES
@pytest.mark.parametrize("name", REFUSED)
def test_styles_without_places_are_refused_with_what_to_do(name: str, index: str) -> None:
    style, restyle, message = REFUSED[name]
    renderer = prepared(scene_of(PLAIN, style), index=index)
    before = renderer.render()
    with pytest.raises(dg.StyleError, match=rf"'ways'.*{message}"):
        renderer.restyle("ways", **restyle)
    assert_same(renderer.render(), before)


@INDEXES
def test_a_width_of_zero_hides_and_comes_back(index: str) -> None:
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}, widest=4.0), index=index)
    before = renderer.render()
    renderer.restyle("ways", width=0.0)
    assert not (renderer.render().layers == 1).any()
    renderer.restyle("ways", width=2.0)
    assert_same(renderer.render(), before)


@INDEXES
@BOTH
def test_what_was_hidden_when_prepared_can_be_shown(antialias: str, index: str) -> None:
    renderer = prepared(scene_of({"color": "none"}, {"color": "none"}), antialias, index=index)
    empty = renderer.render()
    assert not [name for name in empty.stats.variants if "static" in name]
    renderer.restyle("areas", color="tan")
    renderer.restyle("ways", column="kind")
    assert_same(
        renderer.render(), prepared(scene_of(PLAIN, {"column": "kind"}), antialias, index=index).render()
    )
    renderer.restyle(0, visible=False)
    renderer.restyle(1, visible=False)
    assert_same(renderer.render(), empty)


@INDEXES
def test_looks_add_up_and_go_back(index: str) -> None:
    scene = scene_of({"column": "kind"}, {})
    renderer = prepared(scene, index=index)
    before = renderer.render()
    renderer.restyle("areas", opacity={"a": 0.5, "b": 0.0})
    faded = renderer.render()
    renderer.restyle("areas", visible="number >= 20")
    hidden = set(np.unique(renderer.render().ids[renderer.render().layers == 0]).tolist())
    assert hidden
    assert all(row >= 20 and row % 3 != 1 for row in hidden)
    renderer.restyle("areas", visible=True)
    assert_same(renderer.render(), faded)
    renderer.restyle("areas", opacity=1.0)
    assert_same(renderer.render(), before)
    renderer.restyle("areas", order="size")
    renderer.restyle("areas", order="feature")
    assert_same(renderer.render(), before)


@pytest.mark.parametrize("name", RESTYLES)
def test_a_far_view_restyled_is_that_of_a_scene_prepared_so(name: str) -> None:
    """Levels of detail are coloured anew from what their samples see, whatever was drawn from them before."""
    restyle, style = RESTYLES[name]
    ways = {"color": "black", "width": 1.0, "bands": [(0.4, "white"), (1.0, "black")]}
    fresh = prepared(scene_of(style, ways), "coverage")
    fresh.update(FAR)
    renderer = prepared(scene_of(PLAIN, ways), "coverage")
    renderer.update(FAR)
    before = renderer.render()
    assert any("LEVELS" in variant for variant in before.stats.variants)
    renderer.restyle("areas", **restyle)
    after = renderer.render()
    np.testing.assert_array_equal(after.image, fresh.render().image)
    assert (after.image != before.image).any()
    renderer.edit("areas", remove=[0, 5])
    edited = renderer.render().image
    renderer.restyle("areas", visible=np.arange(40) > 20)
    renderer.restyle("areas", visible=restyle.get("visible", True))
    np.testing.assert_array_equal(renderer.render().image, edited)


def test_levels_of_one_file_are_not_taken_for_those_of_another(tmp_path: Path) -> None:
    renderer = dg.Renderer(SIZE, "coverage")
    pictures = []
    for color in ("tan", "crimson"):
        path = tmp_path / f"{color}.decal"
        prepared(scene_of({"color": color}, {"color": color})).save(path)
        renderer.open(path)
        renderer.update(FAR)
        pictures.append(renderer.render().image)
    expected = prepared(scene_of({"color": "crimson"}, {"color": "crimson"}), "coverage")
    expected.update(FAR)
    np.testing.assert_array_equal(pictures[1], expected.render().image)
    assert (pictures[0] != pictures[1]).any()


def test_a_far_view_is_restyled_too() -> None:
    """From levels of detail, and through a lens."""
    pictures = []
    for color in ("tan", "crimson"):
        renderer = prepared(scene_of({"color": color}, {"color": color}), "coverage")
        renderer.update(FAR)
        renderer.render()
        renderer.restyle("areas", color="crimson")
        renderer.restyle("ways", color="crimson")
        pictures.append(renderer.render().image)
        renderer.lens = dg.Lens(circle=(50, 50, 100), styles={0: {"color": "teal"}, 1: {"color": "teal"}})
        inside = renderer.render().image
        renderer.lens = None
        renderer.restyle("areas", color="teal")
        renderer.restyle("ways", color="teal")
        np.testing.assert_array_equal(renderer.render().image, inside)
    np.testing.assert_array_equal(*pictures)


def test_features_without_a_number_lie_lowest(tmp_path: Path) -> None:
    """As if it were the least, in the order of first; when prepared, restyled, and restyled in a saved scene."""
    scene = scene_of({}, {})
    prepared(scene).save(tmp_path / "map.decal")
    opened = dg.Renderer(SIZE, "none")
    opened.open(tmp_path / "map.decal")
    opened.update(OBLIQUE)
    numbers = np.where(np.arange(40) % 3 == 0, np.nan, -np.arange(40.0))
    expected = prepared(scene_of({"order": np.nan_to_num(numbers, nan=-100.0)}, {})).render()
    assert_same(prepared(scene_of({"order": numbers}, {})).render(), expected)
    for renderer in (opened, prepared(scene)):
        assert (renderer.render().ids != expected.ids).any()
        renderer.restyle("areas", order=numbers)
        assert_same(renderer.render(), expected)


def test_a_saved_scene_can_be_restyled(tmp_path: Path) -> None:
    scene = scene_of({"column": "kind"}, {})
    prepared(scene).save(tmp_path / "map.decal")
    opened = dg.Renderer(SIZE, "none")
    opened.open(tmp_path / "map.decal")
    opened.update(OBLIQUE)
    expected = prepared(scene)
    for renderer in (opened, expected):
        renderer.restyle("areas", visible=np.arange(40) % 2 == 0, opacity=0.5)
        renderer.restyle("ways", color="red", order=-np.arange(30.0))
    assert_same(opened.render(), expected.render())
    with pytest.raises(dg.InputError, match=r"keeps no columns. Open it by preprocess\(scene, cache"):
        opened.restyle("areas", visible="number > 3")
    with pytest.raises(
        dg.UnsupportedError, match=r"keeps no styles to change. Open it by preprocess\(scene, cache"
    ):
        opened.restyle("ways", corner="bevel")
    # What was changed is saved as it is, and is no cache of the scene.
    expected.save(tmp_path / "changed.decal")
    opened.open(tmp_path / "changed.decal")
    opened.update(OBLIQUE)
    assert_same(opened.render(), expected.render())
    expected.preprocess(scene, cache=tmp_path / "changed.decal")
    expected.update(OBLIQUE)
    assert_same(expected.render(), prepared(scene).render())
