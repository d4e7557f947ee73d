"""Changes one after the other: what came before stays right, and errors change nothing."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, Point, box

import decalgl as dg
from changed_scenes import EVERY_INDEX, INDEXES, PLAIN, TWO_COVERAGES, assert_same, picks, prepared, scene_of
from small_scenes import BLUE, GREEN, MAP, OBLIQUE, RED, SIZE, count_color, flat_scene, pixel

if TYPE_CHECKING:
    from collections.abc import Callable


@INDEXES
def test_frames_of_before_stay_right(index: str) -> None:
    scene = scene_of({"column": "kind"}, {})
    expected = prepared(scene, index=index).render()
    ids, layers, picked = expected.ids.copy(), expected.layers.copy(), picks(expected)
    renderer = prepared(scene, index=index)
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
    "a short order in a lens": (
        lambda r: setattr(r, "lens", dg.Lens(circle=(1, 2, 3), styles={"areas": {"order": [1.0, 2.0]}})),
        dg.InputError,
        "order",
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


@EVERY_INDEX
def test_a_session_is_what_its_steps_are(index: str) -> None:
    """Navigation, lens, pick, restyle and edit in a loop: at its end, the map is as if prepared so."""
    renderer = prepared(scene_of({"column": "kind"}, {"color": "navy"}), "coverage", index=index)
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
    renderer.restyle("areas", color="tan")
    frame = renderer.render()
    expected = prepared(
        scene_of({"color": ["tan" if row in kept else "none" for row in range(40)]}, {"color": "navy"}),
        "coverage",
        index=index,
    ).render()
    np.testing.assert_array_equal(frame.ids, expected.ids)
    assert np.abs(frame.image.astype(int) - expected.image).max() <= TWO_COVERAGES


@INDEXES
def test_other_threads_may_change_what_is_drawn(index: str) -> None:
    """Each picture is of one of the looks, and none of two."""
    renderer = prepared(scene_of(PLAIN, {"color": "navy"}), index=index)
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
