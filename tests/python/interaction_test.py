"""Restyling, lenses and edits: the picture is that of a scene prepared so, and nothing else changes."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import geopandas
import numpy as np
import pytest
from shapely import LineString, Point, Polygon, box

import decalgl as dg
from judge import eroded
from small_scenes import BLUE, GREEN, MAP, OBLIQUE, RED, SIZE, count_color, flat_scene, hilly_scene, pixel

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

BOTH = pytest.mark.parametrize("antialias", ["none", "coverage"])
KINDS = ["a", "b", "c"]


def some_areas(count: int = 40) -> geopandas.GeoDataFrame:
    """Overlapping triangles with a kind and a number."""
    random = np.random.default_rng(5)
    corners = random.uniform(-10.0, 110.0, (count, 1, 2)) + random.uniform(-15.0, 15.0, (count, 3, 2))
    return geopandas.GeoDataFrame(
        {"kind": [KINDS[i % 3] for i in range(count)], "number": np.arange(count)},
        geometry=[Polygon(triangle) for triangle in corners],
    )


def some_ways(count: int = 30) -> geopandas.GeoDataFrame:
    """Lines of several segments with a kind and a number."""
    random = np.random.default_rng(6)
    return geopandas.GeoDataFrame(
        {"kind": [KINDS[i % 3] for i in range(count)], "number": np.arange(count)},
        geometry=[LineString(random.uniform(0.0, 100.0, (4, 2))) for _ in range(count)],
    )


def scene_of(areas: dict[str, Any], ways: dict[str, Any], widest: float = 0.0) -> dg.Scene:
    """A hill with areas and ways, as the keywords say."""
    scene = hilly_scene()
    scene.add_polygons(some_areas(), **{"name": "areas", **areas})
    layer = scene.add_lines(some_ways(), **{"name": "ways", "width": 2.0, "width_units": "m", **ways})
    assert layer.stroke is not None
    scene._layers[1] = replace(layer, stroke=replace(layer.stroke, widest=widest))
    return scene


def prepared(scene: dg.Scene, antialias: str = "none", **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(SIZE, antialias, **options)
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    return renderer


def assert_same(one: dg.Frame, other: dg.Frame) -> None:
    np.testing.assert_array_equal(one.image, other.image)
    np.testing.assert_array_equal(one.ids, other.ids)
    np.testing.assert_array_equal(one.layers, other.layers)


def picks(frame: dg.Frame) -> list[list[tuple[int, int]]]:
    """What lies under some pixels, as layers' places and rows."""
    return [
        [(one.layer.index, one.row) for one in frame.pick(x, y)]
        for x in range(3, SIZE[0], 14)
        for y in range(3, SIZE[1], 14)
    ]


PLAIN: dict[str, Any] = {"color": "tan"}
RESTYLES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "a colour": ({"color": "green"}, {"color": "green"}),
    "a colour of each": ({"color": ["red", "blue"] * 20}, {"color": ["red", "blue"] * 20}),
    "a translucent colour": ({"color": (0.2, 0.4, 0.6, 0.5)}, {"color": (0.2, 0.4, 0.6, 0.5)}),
    "opacity": ({"opacity": 0.25}, {"color": "tan", "alpha": 0.25}),
    "alpha": ({"alpha": 0.25}, {"color": "tan", "alpha": 0.25}),
    "a column of numbers": (
        {"column": "number", "cmap": "magma", "vmax": 50},
        {"column": "number", "cmap": "magma", "vmax": 50},
    ),
    "categories": ({"column": "kind", "cmap": "Set1"}, {"column": "kind", "cmap": "Set1"}),
    "hidden": ({"visible": False}, {"color": "none"}),
    "filtered": (
        {"visible": "kind == 'a' or number > 30"},
        {"color": ["tan" if i % 3 == 0 or i > 30 else "none" for i in range(40)]},
    ),
    "some of them": (
        {"color": "red", "where": "number < 10"},
        {"color": ["red" if i < 10 else "tan" for i in range(40)]},
    ),
    "order by size": (
        {"order": "size", "column": "kind"},
        {"order": "size", "column": "kind"},
    ),
    "order by numbers": (
        {"order": -np.arange(40.0), "column": "kind"},
        {"order": -np.arange(40.0), "column": "kind"},
    ),
}


@BOTH
@pytest.mark.parametrize("name", RESTYLES)
def test_a_restyled_picture_is_that_of_a_scene_prepared_so(name: str, antialias: str) -> None:
    restyle, style = RESTYLES[name]
    ways = {"color": "black", "width": 1.0}
    expected = prepared(scene_of(style, ways), antialias).render()
    renderer = prepared(scene_of(PLAIN, ways), antialias)
    before = renderer.render()
    renderer.restyle("areas", **restyle)
    after = renderer.render()
    assert_same(after, expected)
    assert picks(after) == picks(expected)
    assert (after.image != before.image).any()


@BOTH
def test_widths_change_up_to_the_prepared_maximum(antialias: str) -> None:
    wide = scene_of(PLAIN, {"color": "navy"}, widest=9.0)
    for width in (9.0, 0.5, 2.0):
        renderer = prepared(wide, antialias)
        renderer.restyle("ways", width=width)
        frame = renderer.render()
        ways = {"color": "navy", "width": width}
        # Of the same widest lines, so that vertices are rounded alike.
        same = prepared(scene_of(PLAIN, ways, widest=9.0), antialias).render()
        assert np.abs(frame.image.astype(int) - same.image).max() <= 1
        expected = prepared(scene_of(PLAIN, ways), antialias).render()
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


@pytest.mark.parametrize("keyword", ["dash", "bands", "corner", "cap", "hatch"])
def test_what_lists_are_made_for_is_refused_with_what_to_do(keyword: str) -> None:
    renderer = prepared(scene_of(PLAIN, {}))
    with pytest.raises(dg.StyleError, match=rf"'ways': {keyword}= is what .* call preprocess\(scene\)"):
        renderer.restyle("ways", **{keyword: "round"})


def test_a_width_of_zero_hides_and_comes_back() -> None:
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}, widest=4.0))
    before = renderer.render()
    renderer.restyle("ways", width=0.0)
    assert not (renderer.render().layers == 1).any()
    renderer.restyle("ways", width=2.0)
    assert_same(renderer.render(), before)


@BOTH
def test_what_was_hidden_when_prepared_can_be_shown(antialias: str) -> None:
    renderer = prepared(scene_of({"color": "none"}, {"color": "none"}), antialias)
    empty = renderer.render()
    assert not [name for name in empty.stats.variants if "static" in name]
    renderer.restyle("areas", color="tan")
    renderer.restyle("ways", column="kind")
    assert_same(renderer.render(), prepared(scene_of(PLAIN, {"column": "kind"}), antialias).render())
    renderer.restyle(0, visible=False)
    renderer.restyle(1, visible=False)
    assert_same(renderer.render(), empty)


def test_looks_add_up_and_go_back() -> None:
    scene = scene_of({"column": "kind"}, {})
    renderer = prepared(scene)
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


def test_frames_of_before_stay_right() -> None:
    scene = scene_of({"column": "kind"}, {})
    expected = prepared(scene).render()
    ids, layers, picked = expected.ids.copy(), expected.layers.copy(), picks(expected)
    renderer = prepared(scene)
    frame = renderer.render()
    renderer.restyle("areas", visible=False)
    renderer.restyle("ways", order="size")
    renderer.lens = dg.Lens(circle=(50, 50, 30), styles={"areas": {"visible": True}})
    renderer.render()
    np.testing.assert_array_equal(frame.ids, ids)
    np.testing.assert_array_equal(frame.layers, layers)
    assert picks(frame) == picked
    with_lens = renderer.render()
    renderer.lens = None
    renderer.restyle("areas", visible=True)
    assert (with_lens.ids[with_lens.layers == 0] >= 0).any()
    assert not np.array_equal(with_lens.ids, ids)


def test_preprocessing_again_gives_the_original() -> None:
    scene = scene_of(PLAIN, {})
    renderer = prepared(scene)
    before = renderer.render()
    renderer.restyle("areas", color="red")
    renderer.lens = dg.Lens(circle=(50, 50, 30), hidden=("areas",))
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    assert renderer.lens is None
    assert_same(renderer.render(), before)


@BOTH
def test_a_lens_shows_other_layers_inside(antialias: str) -> None:
    scene = scene_of({"column": "kind"}, {"color": "navy"}, widest=5.0)
    renderer = prepared(scene, antialias)
    outside = renderer.render()
    inside_styles: dict[Any, dict[str, Any]] = {"ways": {"width": 5.0, "color": "crimson"}}
    renderer.restyle("ways", **inside_styles["ways"])
    renderer.restyle("areas", visible=False)
    inside = renderer.render()
    renderer.restyle("ways", width=2.0, color="navy")
    renderer.restyle("areas", visible=True)
    renderer.lens = dg.Lens(circle=(40.0, 50.0, 20.0), styles=inside_styles, hidden=("areas",))
    frame = renderer.render()
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    apart = np.hypot(x - 40.0, y - 50.0)
    for part, expected in ((apart < 19.4, inside), (apart > 20.6, outside)):
        np.testing.assert_array_equal(frame.image[part], expected.image[part])
    centre = apart <= 20.0
    np.testing.assert_array_equal(frame.ids, np.where(centre, inside.ids, outside.ids))
    np.testing.assert_array_equal(frame.layers, np.where(centre, inside.layers, outside.layers))
    assert picks(frame) == [
        inside_pick if np.hypot(px + 0.5 - 40.0, py + 0.5 - 50.0) <= 20.0 else outside_pick
        for inside_pick, outside_pick, (px, py) in zip(
            picks(inside),
            picks(outside),
            [(px, py) for px in range(3, SIZE[0], 14) for py in range(3, SIZE[1], 14)],
            strict=True,
        )
    ]


@BOTH
def test_a_lens_on_the_map_lies_on_the_terrain(antialias: str) -> None:
    scene = scene_of({"color": "tan"}, {"color": "navy"})
    renderer = prepared(scene, antialias)
    outside = renderer.render()
    renderer.restyle("areas", color="crimson")
    inside = renderer.render()
    renderer.restyle("areas", color="tan")
    shape = box(20, 20, 80, 80).difference(box(40, 40, 60, 60))
    renderer.lens = dg.Lens(polygon=shape, styles={"areas": {"color": "crimson"}})
    frame = renderer.render()
    world = frame.world[..., :2]
    on_ground = np.isfinite(world[..., 0])
    distance = np.full(world.shape[:2], np.inf)
    within = np.zeros(world.shape[:2], dtype=bool)
    for index in np.argwhere(on_ground):
        point = Point(world[tuple(index)])
        distance[tuple(index)] = shape.boundary.distance(point)
        within[tuple(index)] = shape.contains(point)
    far = distance > 3.0
    assert (far & within).any()
    # Where a pixel sees two surfaces, both may be on other sides of the border: all neighbours must be on one.
    for part, expected in ((far & within, inside), (far & ~within, outside)):
        alike = eroded(part, 1)
        assert alike.any()
        np.testing.assert_array_equal(frame.image[alike], expected.image[alike])
    np.testing.assert_array_equal(frame.ids, outside.ids)


def test_a_lens_that_moves_draws_the_layers_alone() -> None:
    scene = scene_of(PLAIN, {})
    renderer = prepared(scene)
    lens = dg.Lens(circle=(50, 50, 20), styles={"areas": {"color": "red"}})
    renderer.lens = lens
    renderer.render()
    renderer.lens = lens.moved(circle=(30, 50, 20))
    moved = renderer.render()
    assert [one["name"] for one in moved.stats.passes] == ["upload", "lens", "static", "compose", "readback"]
    fresh = prepared(scene)
    fresh.lens = dg.Lens(circle=(30, 50, 20), styles={"areas": {"color": "red"}})
    assert_same(moved, fresh.render())
    renderer.lens = None
    assert_same(renderer.render(), prepared(scene).render())


def test_a_lens_follows_what_is_restyled_outside() -> None:
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}))
    renderer.lens = dg.Lens(circle=(50, 50, 40), styles={"areas": {"opacity": 0.5}})
    renderer.restyle("areas", color="red")
    renderer.restyle("ways", color="green")
    frame = renderer.render()
    fresh = prepared(scene_of({"color": "red"}, {"color": "green"}))
    fresh.lens = dg.Lens(circle=(50, 50, 40), styles={"areas": {"opacity": 0.5}})
    assert_same(frame, fresh.render())


FAR = dg.Camera.top_down((-2000.0, -2000.0, 2100.0, 2100.0))


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
    with pytest.raises(dg.InputError, match="keeps no columns"):
        opened.restyle("areas", visible="number > 3")
    # What was changed is saved as it is, and is no cache of the scene.
    expected.save(tmp_path / "changed.decal")
    opened.open(tmp_path / "changed.decal")
    opened.update(OBLIQUE)
    assert_same(opened.render(), expected.render())
    expected.preprocess(scene, cache=tmp_path / "changed.decal")
    expected.update(OBLIQUE)
    assert_same(expected.render(), prepared(scene).render())


BAD: dict[str, tuple[Callable[[dg.Renderer], Any], type[dg.DecalError], str]] = {
    "no such layer": (lambda r: r.restyle("area", color="red"), dg.InputError, "did you mean|areas"),
    "no such place": (lambda r: r.restyle(7, color="red"), dg.InputError, "no layer 7"),
    "another layer": (lambda r: r.restyle(None, color="red"), dg.InputError, "no layer of what is prepared"),
    "no such keyword": (
        lambda r: r.restyle("areas", colour="red"),
        dg.StyleError,
        "'areas'.*'colour'.*color",
    ),
    "no such colour": (lambda r: r.restyle("areas", color="redd"), dg.StyleError, "'areas'.*redd"),
    "no such column": (lambda r: r.restyle("areas", column="kinds"), dg.ColumnError, "kind"),
    "a filter by no column": (lambda r: r.restyle("areas", visible="kin == 'a'"), dg.ColumnError, "kin"),
    "a filter that is code": (
        lambda r: r.restyle("areas", visible="__import__('os').getpid() > 0"),
        dg.InputError,
        "may hold column names",
    ),
    "a broken filter": (lambda r: r.restyle("areas", visible="kind =="), dg.InputError, "no expression"),
    "a filter of numbers": (lambda r: r.restyle("areas", visible="number"), dg.InputError, "true or false"),
    "a short mask": (lambda r: r.restyle("areas", where=[True] * 3), dg.InputError, r"\(3,\).*40 rows"),
    "an opacity of no category": (
        lambda r: r.restyle("areas", opacity={"x": 0.5}, by="kind"),
        dg.StyleError,
        "'x', which no row has",
    ),
    "an opacity by nothing": (lambda r: r.restyle("ways", opacity={"a": 0.5}), dg.StyleError, "by="),
    "an opacity above 1": (lambda r: r.restyle("areas", opacity=2.0), dg.StyleError, "between 0 and 1"),
    "no casing": (lambda r: r.restyle("ways", casing={"color": "red"}), dg.StyleError, "no casing"),
    "no outline": (lambda r: r.restyle("areas", outline={"color": "red"}), dg.StyleError, "no outline"),
    "no lens": (lambda r: setattr(r, "lens", 3), dg.InputError, "must be a Lens"),
    "a lens of no layer": (
        lambda r: setattr(r, "lens", dg.Lens(circle=(1, 2, 3), hidden=("x",))),
        dg.InputError,
        "no layer 'x'",
    ),
    "an order in a lens": (
        lambda r: setattr(r, "lens", dg.Lens(circle=(1, 2, 3), styles={"areas": {"order": "size"}})),
        dg.UnsupportedError,
        "draw order inside a lens",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_errors_leave_everything_as_it_was(name: str) -> None:
    act, kind, message = BAD[name]
    renderer = prepared(scene_of({"column": "kind"}, {}))
    renderer.lens = dg.Lens(circle=(50, 50, 20), styles={"areas": {"color": "red"}})
    before = renderer.render()
    with pytest.raises(kind, match=message):
        act(renderer)
    assert_same(renderer.render(), before)


def test_lenses_are_checked() -> None:
    for wrong in (
        {},
        {"circle": (1, 2, 3), "polygon": box(0, 0, 1, 1)},
        {"circle": (1, 2)},
        {"circle": (1, 2, -1)},
        {"circle": (1, np.nan, 1)},
        {"polygon": [(0, 0), (1, 1)]},
        {"polygon": LineString([(0, 0), (1, 1)])},
        {"circle": (1, 2, 3), "styles": ["areas"]},
    ):
        with pytest.raises(dg.InputError):
            dg.Lens(**wrong)


def test_nothing_can_be_restyled_before_it_is_prepared() -> None:
    with pytest.raises(dg.InputError, match="preprocess"):
        dg.Renderer().restyle("areas", color="red")


def test_the_published_structures_say_that_they_cannot() -> None:
    renderer = prepared(scene_of(PLAIN, {}), index="bvh")
    before = renderer.render()
    with pytest.raises(dg.UnsupportedError, match="index 'grid'"):
        renderer.restyle("areas", color="red")
    assert_same(renderer.render(), before)


def test_colours_of_a_map_from_above() -> None:
    scene = flat_scene()
    scene.add_polygons([box(0, 0, 50, 100), box(40, 0, 100, 100)], color=["red", "lime"], name="halves")
    renderer = dg.Renderer(SIZE, "none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    assert count_color(renderer.render(), GREEN) == 6000
    renderer.restyle("halves", visible=[True, False])
    assert count_color(renderer.render(), GREEN) == 0
    renderer.restyle("halves", visible=True, order=[1, 0])
    assert count_color(renderer.render(), RED) == 5000
    renderer.lens = dg.Lens(polygon=[(10, 10), (30, 10), (30, 30), (10, 30)], styles={0: {"color": "blue"}})
    frame = renderer.render()
    assert count_color(frame, BLUE) == 400
    assert pixel(frame, 20, 20) == BLUE
    assert frame.pick(20, 79)[0].row == 0


def test_a_session_is_what_its_steps_are() -> None:
    """Navigation, lens, pick, restyle and edit in a loop: at its end, the map is as if prepared so."""
    renderer = prepared(scene_of({"column": "kind"}, {"color": "navy"}), "coverage")
    lens = dg.Lens(circle=(0, 0, 15), styles={"areas": {"opacity": 1.0}}, hidden=("ways",))
    marked: list[int] = []
    added: list[int] = []
    for step in range(12):
        camera = dg.Camera.orbit((50.0, 50.0, 0.0), 140.0, azimuth=30.0 * step, elevation=50.0)
        renderer.update(camera)
        renderer.restyle("areas", opacity=1.0 - 0.05 * step)
        renderer.lens = lens.moved(circle=(20.0 + 5 * step, 50.0, 15.0))
        frame = renderer.render()
        columns, lines = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
        inside = np.hypot(columns - 20.0 - 5 * step, lines - 50.0) < 13.0
        assert not (frame.layers[inside] == 1).any()
        seen = np.argwhere(inside & (frame.layers == 0) & (frame.ids < 40))
        if not len(seen):
            continue
        y, x = seen[len(seen) // 2].tolist()
        hits = frame.pick(x, y)
        assert hits[0].row == frame.ids[y, x]
        assert all(hit.layer.name == "areas" for hit in hits)
        marked.append(hits[0].row)
        renderer.edit("areas", remove=hits[0].row)
        east, north, _ = frame.world[y, x]
        rows = renderer.edit("areas", add=[Point(east, north).buffer(4.0)], color="red")
        added.extend(rows.tolist())
        again = renderer.render().pick(x, y)
        assert again[0].row == rows[0]
        assert hits[0].row not in [hit.row for hit in again]
    assert len(marked) >= 3
    renderer.lens = None
    renderer.restyle("areas", opacity=1.0)
    renderer.restyle("areas", visible=False, where=np.arange(40 + len(added)) >= 40)
    renderer.update(OBLIQUE)
    kept = [row for row in range(40) if row not in marked]
    ids = renderer.render().ids
    expected = prepared(
        scene_of({"color": ["tan" if row in kept else "none" for row in range(40)]}, {}), "coverage"
    )
    np.testing.assert_array_equal(ids, expected.render().ids)


def test_other_threads_may_change_what_is_drawn() -> None:
    """Each picture is of one of the looks, and none of two."""
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}))
    allowed = []
    for color in ("tan", "crimson"):
        renderer.restyle("areas", color=color)
        allowed.append(renderer.render().image.copy())
    with ThreadPoolExecutor(2) as pool:
        futures = [pool.submit(lambda: [renderer.restyle("areas", color=c) for c in ("tan", "crimson") * 20])]
        while not all(future.done() for future in futures):
            image = renderer.render().image
            assert any(np.array_equal(image, one) for one in allowed)
        for future in futures:
            future.result()


def test_two_renderers_change_one_scene_each_for_itself() -> None:
    scene = scene_of(PLAIN, {})
    one, other = prepared(scene), prepared(scene)
    before = other.render()
    one.restyle("areas", color="red")
    one.edit("ways", remove=list(range(10)))
    assert (one.render().image != before.image).any()
    assert_same(other.render(), before)
