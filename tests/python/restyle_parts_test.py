"""Restyling outlines and casings, filters given as functions, fades, and what a change leaves as it was."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely
from shapely import affinity, box

import decalgl as dg
from changed_scenes import (
    EVERY_INDEX,
    EVERY_WAY,
    INDEXES,
    PLAIN,
    TWO_COVERAGES,
    assert_same,
    picks,
    prepared,
    scene_of,
    some_areas,
    some_ways,
)
from decalgl.errors import StyleError
from small_scenes import MAP, SIZE, hilly_scene

if TYPE_CHECKING:
    from collections.abc import Callable

OUTLINE: dict[str, Any] = {"width": 4.0, "width_units": "m", "color": "navy", "widest": 6.0}
# Each with one of the ways in which outlines lie along their polygons.
OUTLINES: dict[str, tuple[str, dict[str, Any]]] = {
    "a colour": ("normal", {"color": "crimson"}),
    "a colour of each": ("inset", {"color": ["red", "blue"] * 20}),
    "a column": ("offset", {"column": "number", "cmap": "magma"}),
    "translucent": ("inset", {"alpha": 0.5}),
    "a width": ("offset", {"width": 6.0}),
    "widths": ("normal", {"width": [1.0, 5.0] * 20}),
    "marks": ("offset", {"dash": (2, 8)}),
    "corners": ("normal", {"corner": "bevel"}),
    "all of it": ("inset", {"color": "tan", "width": 2.0, "dash": (7, 3), "corner": "bevel"}),
}


def outlined(**outline: Any) -> dict[str, Any]:
    """Keywords of areas with mitred dashes along their borders, of 5 m in 10."""
    return {**PLAIN, "outline": dg.Outline(**{**OUTLINE, "corner": "miter", "dash": (5, 5), **outline})}


@EVERY_WAY
@pytest.mark.parametrize("name", OUTLINES)
def test_a_restyled_outline_is_that_of_a_scene_prepared_so(name: str, antialias: str, index: str) -> None:
    mode, restyle = OUTLINES[name]
    renderer = prepared(scene_of(outlined(mode=mode), {}), antialias, index=index)
    before = renderer.render()
    renderer.restyle("areas", outline=restyle)
    after = renderer.render()
    color = {"color": None} if "column" in restyle else {}
    expected = prepared(
        scene_of(outlined(mode=mode, **color, **restyle), {}), antialias, index=index
    ).render()
    np.testing.assert_array_equal(after.ids, expected.ids)
    assert picks(after) == picks(expected)
    # An index made for miters leads some pixels another way.
    corners = "corner" in restyle and antialias == "coverage"
    assert np.abs(after.image.astype(int) - expected.image).max() <= (TWO_COVERAGES if corners else 0)
    assert (after.image != before.image).any()


CASINGS: dict[str, dict[str, Any]] = {
    "a colour": {"color": "crimson"},
    "a colour of each": {"color": ["red", "blue"] * 15},
    "a column": {"column": "kind", "cmap": "Set1"},
    "translucent": {"alpha": 0.5},
    "marks": {"dash": (2, 8)},
}


@EVERY_WAY
@pytest.mark.parametrize("name", CASINGS)
def test_a_restyled_casing_is_that_of_a_scene_prepared_so(name: str, antialias: str, index: str) -> None:
    def cased(**casing: Any) -> dict[str, Any]:
        return {"color": "white", "casing": dg.Casing(**{"width": 2.0, "dash": (5, 5), **casing})}

    restyle = CASINGS[name]
    renderer = prepared(scene_of(PLAIN, cased(color="navy")), antialias, index=index)
    before = renderer.render()
    renderer.restyle("ways", casing=restyle)
    after = renderer.render()
    color = {} if "column" in restyle else {"color": "navy"}
    expected = prepared(scene_of(PLAIN, cased(**{**color, **restyle})), antialias, index=index).render()
    assert_same(after, expected)
    assert (after.image != before.image).any()


def cased_ways(width: float, sides: Any = 2.0) -> dg.Scene:
    """Ways that may become 7 m wide, with 2 m of casing at most on each side."""
    scene = hilly_scene(1000.0)
    casing = dg.Casing(width=sides, color="navy")
    scene.add_lines(
        some_ways(), name="ways", color="white", width=width, width_units="m", widest=7.0, casing=casing
    )
    return scene


SIDES = [2.0, 0.5] * 15


@EVERY_WAY
@pytest.mark.parametrize(
    ("restyle", "expected"),
    [
        ({"width": 6.0}, cased_ways(6.0)),
        ({"casing": {"width": SIDES}}, cased_ways(3.0, SIDES)),
        ({"width": 5.0, "casing": {"width": SIDES, "color": "navy"}}, cased_ways(5.0, SIDES)),
    ],
    ids=["of lines", "of casings", "of both"],
)
def test_casings_are_as_wide_on_each_side_as_their_lines_change(
    restyle: dict[str, Any], expected: dg.Scene, antialias: str, index: str
) -> None:
    """Also in a lens."""
    picture = prepared(expected, antialias, index=index).render()
    renderer = prepared(cased_ways(3.0), antialias, index=index)
    before = renderer.render()
    renderer.restyle("ways", **restyle)
    assert_same(renderer.render(), picture)
    assert (picture.image != before.image).any()
    lensed = prepared(cased_ways(3.0), antialias, index=index)
    lensed.lens = dg.Lens(circle=(SIZE[0] / 2, SIZE[1] / 2, 4.0 * max(SIZE)), styles={"ways": restyle})
    assert_same(lensed.render(), picture)


@EVERY_INDEX
def test_what_is_added_to_wider_lines_is_cased_as_they_are(index: str) -> None:
    added = shapely.LineString([(15, 15), (80, 35)])
    frames = []
    for renderer in (prepared(cased_ways(6.0), index=index), prepared(cased_ways(3.0), index=index)):
        renderer.restyle("ways", width=6.0)
        renderer.edit("ways", add=[added])
        frames.append(renderer.render())
    assert_same(*frames)


@EVERY_INDEX
def test_a_casing_wider_than_prepared_is_refused(index: str) -> None:
    renderer = prepared(cased_ways(3.0), index=index)
    renderer.restyle("ways", casing={"width": 4.0})
    with pytest.raises(StyleError, match="a width of 12 m is more than the 11 m"):
        renderer.restyle("ways", casing={"width": 4.5})


@EVERY_INDEX
def test_filters_may_be_functions_of_the_columns(index: str) -> None:
    """As wide as the same filter as an expression, and as a mask; of what is seen, and of what is changed."""

    def chosen(columns: Any) -> Any:
        return (columns["kind"] == "a") & (columns["number"] < 30)

    numbers = np.arange(40)
    ways: list[Any] = [chosen, "kind == 'a' and number < 30", (numbers % 3 == 0) & (numbers < 30)]
    plain = prepared(scene_of(PLAIN, {}), index=index)
    all_of_them = plain.render()
    for keywords in ({}, {"color": "red"}):
        frames = []
        for way in ways:
            renderer = prepared(scene_of(PLAIN, {}), index=index)
            given = {"where": way, **keywords} if keywords else {"visible": way}
            renderer.restyle("areas", **given)
            frames.append(renderer.render())
        assert (frames[0].image != all_of_them.image).any()
        for frame in frames[1:]:
            assert_same(frame, frames[0])
    with pytest.raises(dg.InputError, match=r"visible= of layer 'areas'.*\(3,\)"):
        plain.restyle("areas", visible=lambda _: np.ones(3, dtype=bool))
    with pytest.raises(dg.ColumnError, match="kinds"):
        plain.restyle("areas", visible=lambda columns: columns["kinds"] == "a")
    assert_same(plain.render(), all_of_them)


@EVERY_INDEX
def test_a_lens_filters_by_columns(index: str) -> None:
    """All filters, inside: what they leave out is seen around the lens alone."""
    scene = scene_of({"column": "kind"}, {"color": "navy"})
    renderer = prepared(scene, index=index)
    outside = renderer.render()
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    inside = np.hypot(x - 50.0, y - 50.0) <= 30.0
    filters: list[Any] = ["kind == 'a'", lambda columns: columns["kind"] == "a", np.arange(40) % 3 == 0]
    for visible in filters:
        renderer.lens = dg.Lens(circle=(50.0, 50.0, 30.0), styles={"areas": {"visible": visible}})
        frame = renderer.render()
        areas = np.unique(frame.ids[inside & (frame.layers == 0)])
        assert areas.size
        assert (areas % 3 == 0).all()
        np.testing.assert_array_equal(frame.ids[~inside], outside.ids[~inside])
        np.testing.assert_array_equal(frame.image[~inside], outside.image[~inside])
        restyled = prepared(scene, index=index)
        restyled.restyle("areas", visible=visible)
        expected = restyled.render()
        np.testing.assert_array_equal(frame.image[inside], expected.image[inside])


@EVERY_WAY
def test_a_fade_is_the_colours_that_it_comes_to(antialias: str, index: str) -> None:
    """Category by category, each step is a scene whose rows were given their alpha by themselves."""
    shades = {"a": (0.8, 0.2, 0.2), "b": (0.2, 0.6, 0.3), "c": (0.2, 0.3, 0.8)}

    def scene(shares: dict[str, float]) -> dg.Scene:
        colors = [(*shades["abc"[row % 3]], shares["abc"[row % 3]]) for row in range(40)]
        return scene_of({"color": colors}, {"color": "navy"})

    renderer = prepared(scene(dict.fromkeys("abc", 1.0)), antialias, index=index)
    for step in (0.8, 0.4, 0.0, 0.6, 1.0):
        shares = {"a": step, "b": 1.0, "c": 1.0 - step}
        renderer.restyle("areas", opacity=shares, by="kind")
        expected = prepared(scene(shares), antialias, index=index)
        assert_same(renderer.render(), expected.render())
        assert picks(renderer.render()) == picks(expected.render())


MODES: dict[str, dict[str, Any]] = {
    "msaa": {"antialias": "msaa"},
    "ssaa": {"antialias": "ssaa"},
    "fxaa": {"antialias": "fxaa"},
    "thoeny": {"antialias": "coverage", "coverage": "thoeny"},
}


@INDEXES
@pytest.mark.parametrize("mode", MODES)
def test_changes_show_with_all_other_antialiasing(mode: str, index: str) -> None:
    """A restyle, an edit and a lens together."""
    lens = dg.Lens(circle=(50.0, 50.0, 30.0), styles={"ways": {"width": 4.0}})
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}, widest=5.0), **MODES[mode], index=index)
    before = renderer.render()
    renderer.restyle("areas", color="crimson")
    renderer.edit("areas", remove=list(range(10)))
    renderer.lens = lens
    after = renderer.render()
    colors = ["none" if row < 10 else "crimson" for row in range(40)]
    expected = prepared(
        scene_of({"color": colors}, {"color": "navy"}, widest=5.0), **MODES[mode], index=index
    )
    expected.lens = lens
    np.testing.assert_array_equal(after.ids, expected.render().ids)
    # What is removed from trees leaves objects that cover nothing, and lead the points of a pixel elsewhere.
    most = TWO_COVERAGES if mode == "thoeny" and index == "bvh" else 1
    assert np.abs(after.image.astype(int) - expected.render().image).max() <= most
    assert (after.image != before.image).any()


AREA, WAY = some_areas().geometry[8], some_ways().geometry[3]
# What is changed, and where pictures may differ for it.
LOCAL: dict[str, tuple[Callable[[dg.Renderer], Any], list[Any]]] = {
    "an area added": (
        lambda r: r.edit("areas", add=[box(70, 70, 80, 80)], color="red"),
        [box(70, 70, 80, 80)],
    ),
    "an area removed": (lambda r: r.edit("areas", remove=8), [AREA]),
    "an area moved": (
        lambda r: r.edit("areas", move={8: (6.0, 3.0)}),
        [AREA, affinity.translate(AREA, 6.0, 3.0)],
    ),
    "an area replaced": (
        lambda r: r.edit("areas", replace={8: box(10, 80, 20, 90)}),
        [AREA, box(10, 80, 20, 90)],
    ),
    "a way removed": (lambda r: r.edit("ways", remove=3), [WAY]),
    "a way moved": (
        lambda r: r.edit("ways", move={3: (5.0, 0.0)}),
        [WAY, affinity.translate(WAY, 5.0, 0.0)],
    ),
    "an area in another colour": (
        lambda r: r.restyle("areas", color="red", where=np.arange(40) == 8),
        [AREA],
    ),
    "an area hidden": (lambda r: r.restyle("areas", visible=np.arange(40) != 8), [AREA]),
    "a way in another width": (lambda r: r.restyle("ways", width=5.0, where=np.arange(30) == 3), [WAY]),
}


@EVERY_WAY
@pytest.mark.parametrize("name", LOCAL)
def test_a_local_change_leaves_every_byte_elsewhere(name: str, antialias: str, index: str) -> None:
    """Beyond the widest stroke and the reach of anti-aliasing around what is changed."""
    act, places = LOCAL[name]
    renderer = prepared(scene_of({"column": "kind"}, {"color": "navy"}, widest=5.0), antialias, index=index)
    renderer.update(MAP)
    before = renderer.render()
    act(renderer)
    after = renderer.render()
    reach = 2.5 + 2.0
    near = np.zeros(before.ids.shape, dtype=bool)
    for place in places:
        near |= shapely.contains_xy(place.buffer(reach), before.world[..., 0], before.world[..., 1])
    assert (after.image[near] != before.image[near]).any()
    assert near.mean() < 0.5
    np.testing.assert_array_equal(after.image[~near], before.image[~near])
    np.testing.assert_array_equal(after.ids[~near], before.ids[~near])
