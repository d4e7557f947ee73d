"""Local edits: the picture is that of the edited data prepared anew, and nothing changes elsewhere."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import geopandas
import numpy as np
import pytest
from shapely import LineString, Polygon, affinity, box

import decalgl as dg
from changed_scenes import BOTH, EVERY_WAY, INDEXES, picks, prepared, some_areas, some_ways
from small_scenes import MAP, OBLIQUE, SIZE, hilly_scene

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

NEW_AREAS = [box(20, 20, 45, 40), Polygon([(60, 60), (90, 65), (70, 95)])]
NEW_WAYS = [LineString([(0, 90), (100, 80)]), LineString([(50, 0), (55, 60), (90, 90)])]


def scene_of(
    areas: geopandas.GeoDataFrame, ways: geopandas.GeoDataFrame, widest: float = 0.0, **style: Any
) -> dg.Scene:
    scene = hilly_scene(south=1000.0)
    scene.add_polygons(areas, name="areas", **(style or {"color": (0.8, 0.7, 0.5, 0.6)}))
    layer = scene.add_lines(ways, color="navy", width=1.5, width_units="m", name="ways")
    assert layer.stroke is not None
    scene._layers[1] = replace(layer, stroke=replace(layer.stroke, widest=widest))
    return scene


def assert_close(one: dg.Frame, other: dg.Frame, rows: dict[int, np.ndarray[Any, Any]] | None = None) -> None:
    """Ids agree, by `rows` of each layer where they are numbered otherwise, and colours by 1."""
    np.testing.assert_array_equal(one.layers, other.layers)
    ids = other.ids.copy()
    for layer, known in (rows or {}).items():
        mine = other.layers == layer
        ids[mine] = known[ids[mine]]
    np.testing.assert_array_equal(one.ids, ids)
    assert np.abs(one.image.astype(int) - other.image).max() <= 1


@EVERY_WAY
@pytest.mark.parametrize("widest", [0.0, 6.0])
def test_an_edited_picture_is_that_of_the_edited_data(antialias: str, widest: float, index: str) -> None:
    areas, ways = some_areas(), some_ways()
    renderer = prepared(scene_of(areas, ways, widest), antialias, index=index)
    renderer.render()

    added = renderer.edit("areas", add=NEW_AREAS, remove=[3, 17], move={5: (10.0, -4.0)})
    assert added.tolist() == [40, 41]
    assert renderer.edit("ways", add=NEW_WAYS, replace={7: NEW_WAYS[0]}, remove=0).tolist() == [30, 31]

    shapes = list(areas.geometry)
    shapes[5] = affinity.translate(shapes[5], 10.0, -4.0)
    kept = [row for row in range(40) if row not in (3, 17)]
    lines = list(ways.geometry)
    lines[7] = NEW_WAYS[0]
    expected = scene_of(
        geopandas.GeoDataFrame(geometry=[shapes[row] for row in kept] + NEW_AREAS),
        geopandas.GeoDataFrame(geometry=lines[1:] + NEW_WAYS),
        widest,
    )
    frame, wanted = renderer.render(), prepared(expected, antialias, index=index).render()
    rows = {0: np.array([*kept, 40, 41]), 1: np.arange(1, 32)}
    assert_close(frame, wanted, rows)
    assert picks(frame) == [
        [(layer, int(rows[layer][row])) for layer, row in found] for found in picks(wanted)
    ]


@INDEXES
def test_many_edits_in_a_row_and_back(index: str) -> None:
    """Through the growth and the compaction of the lists, every picture is right."""
    areas, ways = some_areas(), some_ways()
    renderer = prepared(scene_of(areas, ways), index=index)
    first = renderer.render()
    image, ids = first.image.copy(), first.ids.copy()
    shapes = list(areas.geometry)
    random = np.random.default_rng(1)
    for step in range(60):
        row = int(random.integers(40))
        shift = random.uniform(-20.0, 20.0, 2)
        renderer.edit("areas", move={row: tuple(shift)})
        shapes[row] = affinity.translate(shapes[row], *shift)
        if step % 20 == 7:
            expected = prepared(scene_of(geopandas.GeoDataFrame(geometry=shapes), ways), index=index).render()
            assert_close(renderer.render(), expected)
    renderer.edit("areas", replace=dict(enumerate(areas.geometry)))
    assert_close(renderer.render(), first)
    np.testing.assert_array_equal(first.image, image)
    np.testing.assert_array_equal(first.ids, ids)


@INDEXES
@BOTH
def test_nothing_changes_elsewhere(antialias: str, index: str) -> None:
    renderer = prepared(scene_of(some_areas(), some_ways()), antialias, index=index)
    renderer.update(MAP)
    before = renderer.render()
    renderer.edit("areas", add=[box(70, 70, 80, 80)], color="red")
    after = renderer.render()
    world = before.world[..., :2]
    near = ((world > 69.0) & (world < 81.0)).all(axis=-1)
    assert (after.image[near] != before.image[near]).any()
    np.testing.assert_array_equal(after.image[~near], before.image[~near])
    np.testing.assert_array_equal(after.ids[~near], before.ids[~near])


@BOTH
def test_a_far_view_is_edited_too(antialias: str) -> None:
    far = dg.Camera.top_down((-2000.0, -2000.0, 2100.0, 2100.0))
    areas, ways = some_areas(), some_ways()
    renderer = prepared(scene_of(areas, ways), antialias)
    renderer.update(far)
    renderer.render()
    renderer.edit("areas", add=NEW_AREAS, remove=[3])
    expected = prepared(
        scene_of(
            geopandas.GeoDataFrame(geometry=[*areas.geometry[:3], *areas.geometry[4:], *NEW_AREAS]), ways
        ),
        antialias,
    )
    expected.update(far)
    assert np.abs(renderer.render().image.astype(int) - expected.render().image).max() <= 2


@INDEXES
def test_frames_of_before_stay_right(index: str) -> None:
    renderer = prepared(scene_of(some_areas(), some_ways()), index=index)
    expected = prepared(scene_of(some_areas(), some_ways()), index=index).render()
    frame = renderer.render()
    renderer.edit("areas", remove=list(range(30)), add=NEW_AREAS)
    renderer.edit("ways", remove=list(range(30)))
    between = renderer.render()
    seen = picks(prepared(scene_of(some_areas(), some_ways()), index=index).render())
    renderer.edit("areas", remove=list(range(30, 42)))
    assert (renderer.render().ids == -1).all()
    np.testing.assert_array_equal(frame.ids, expected.ids)
    assert picks(frame) == seen
    assert (between.ids >= 30).any()


@INDEXES
def test_edits_restyles_and_lenses_add_up(index: str) -> None:
    areas, ways = some_areas(), some_ways()
    renderer = prepared(scene_of(areas, ways, widest=6.0, column="kind", cmap="Set1"), index=index)
    renderer.restyle("areas", opacity={"a": 0.5}, visible="kind != 'b'")
    renderer.lens = dg.Lens(circle=(50, 50, 30), styles={"areas": {"visible": True}}, hidden=("ways",))
    more = geopandas.GeoDataFrame({"kind": ["a", "b"]}, geometry=NEW_AREAS)
    renderer.edit("areas", add=more, column="kind", cmap={"a": "red", "b": "blue"})
    renderer.edit("ways", add=NEW_WAYS, width=4.0, color="green")
    renderer.restyle("ways", width=0.5, where=np.arange(32) < 31)
    renderer.restyle("areas", order="size", column="kind", cmap="Set2")
    frame = renderer.render()

    both = geopandas.GeoDataFrame(
        {"kind": [*areas["kind"], "a", "b"], "number": range(42)}, geometry=[*areas.geometry, *NEW_AREAS]
    )
    lines = geopandas.GeoDataFrame(geometry=[*ways.geometry, *NEW_WAYS])
    expected = prepared(scene_of(both, lines, widest=6.0, column="kind", cmap="Set2"), index=index)
    expected.restyle("areas", order="size", opacity={"a": 0.5}, where=np.arange(42) < 40)
    expected.restyle("areas", visible="kind != 'b' or number >= 40")
    expected.restyle("ways", width=[0.5] * 31 + [4.0], color=["navy"] * 30 + ["green"] * 2)
    expected.lens = dg.Lens(circle=(50, 50, 30), styles={"areas": {"visible": True}}, hidden=("ways",))
    assert_close(frame, expected.render())


def test_geometries_alone_are_in_the_scenes_crs() -> None:
    scene = dg.Scene(dg.Terrain.flat((0.0, 0.0, 100.0, 100.0), crs="EPSG:32604"))
    scene.add_polygons([box(0, 0, 10, 10)], crs="EPSG:32604", color="tan")
    renderer = dg.Renderer(SIZE, "none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    renderer.edit(0, add=[box(40, 40, 60, 60)], replace={0: box(0, 0, 20, 20)})
    far = geopandas.GeoDataFrame(geometry=[box(60, 60, 70, 70)], crs="EPSG:32604").to_crs(4326)
    renderer.edit(0, add=far)
    ids = renderer.render().ids
    assert [(ids == row).sum() for row in range(3)] == [400, 400, 100]


BAD: dict[str, tuple[Callable[[dg.Renderer], Any], type[dg.DecalError], str]] = {
    "a row that is not there": (lambda r: r.edit("areas", remove=[40]), dg.InputError, "row 40"),
    "a row that was removed": (lambda r: r.edit("areas", move={2: (1, 1)}), dg.InputError, "row 2"),
    "a row twice": (lambda r: r.edit("areas", remove=[1, 1]), dg.InputError, "twice"),
    "removed and moved": (lambda r: r.edit("areas", remove=1, move={1: (0, 0)}), dg.InputError, "row 1"),
    "moved and replaced": (
        lambda r: r.edit("areas", move={1: (0, 0)}, replace={1: NEW_AREAS[0]}),
        dg.InputError,
        "row 1",
    ),
    "rows by name": (lambda r: r.edit("areas", remove=["x"]), dg.InputError, "whole numbers"),
    "no shift": (lambda r: r.edit("areas", move={1: (1, np.nan)}), dg.InputError, "dx, dy"),
    "another kind": (lambda r: r.edit("areas", add=NEW_WAYS), dg.InputError, "add_lines|polygon"),
    "nothing instead": (lambda r: r.edit("areas", replace={1: Polygon()}), dg.InputError, "remove="),
    "a colour of nothing": (lambda r: r.edit("areas", color="red"), dg.InputError, "add="),
    "an unknown keyword": (lambda r: r.edit("areas", add=NEW_AREAS, colour=1), dg.StyleError, "colour"),
    "another width": (lambda r: r.edit("ways", add=NEW_WAYS, width=-1), dg.StyleError, "above 0"),
}


@pytest.mark.filterwarnings("ignore::decalgl.DecalWarning")
@pytest.mark.parametrize("name", BAD)
def test_errors_leave_everything_as_it_was(name: str) -> None:
    act, kind, message = BAD[name]
    renderer = prepared(scene_of(some_areas(), some_ways()))
    renderer.edit("areas", remove=2)
    before = renderer.render()
    with pytest.raises(kind, match=message):
        act(renderer)
    after = renderer.render()
    np.testing.assert_array_equal(after.image, before.image)
    np.testing.assert_array_equal(after.ids, before.ids)


def test_a_layer_of_several_colours_says_what_it_needs() -> None:
    renderer = prepared(scene_of(some_areas(), some_ways(), column="kind"))
    with pytest.raises(dg.StyleError, match="several colours"):
        renderer.edit("areas", add=NEW_AREAS)


def test_scenes_from_files_are_edited_where_the_data_is_there(tmp_path: Path) -> None:
    scene = scene_of(some_areas(), some_ways())
    prepared(scene).save(tmp_path / "map.decal")
    opened = dg.Renderer(SIZE, "none")
    opened.open(tmp_path / "map.decal")
    with pytest.raises(
        dg.UnsupportedError, match=r"no vertices to edit. Open it by preprocess\(scene, cache"
    ):
        opened.edit("areas", remove=1)
    opened.preprocess(scene, cache=tmp_path / "map.decal")
    opened.update(OBLIQUE)
    expected = prepared(scene)
    assert "open" in opened.render().stats.preprocess
    for renderer in (opened, expected):
        renderer.edit("areas", add=NEW_AREAS, move={5: (10.0, -4.0)}, remove=3)
    np.testing.assert_array_equal(opened.render().image, expected.render().image)
    assert picks(opened.render()) == picks(expected.render())


OUTLINED: dict[str, dict[str, Any]] = {
    "over all": {},
    "over each": {"order": "feature"},
    "inset": {"mode": "inset"},
    "mitred": {"corner": "miter", "dash": (5, 3)},
}


@pytest.mark.parametrize(
    "index", ["grid", "bvh", dg.BvhIndex(cells=20, passes="kind", segment_order="hilbert")]
)
@pytest.mark.parametrize("name", OUTLINED)
def test_outlined_polygons_are_edited(name: str, index: str | dg.BvhIndex) -> None:
    """New ones lie outside of all others, and above them."""
    outline = dg.Outline(width=3, width_units="m", color="navy", **OUTLINED[name])
    areas = [box(30, 30, 50, 50), box(40, 40, 60, 60), box(45, 20, 65, 45)]
    new = [box(55, 10, 95, 35), box(5, 5, 35, 35)]

    def scene(shapes: list[Any]) -> dg.Scene:
        scene = hilly_scene()
        # Another technique below: layers are counted from the scene's first.
        scene.add_lines([LineString([(0, 50), (100, 60)])], color="red", width=2)
        scene.add_polygons(shapes, color="tan", outline=outline, name="areas")
        return scene

    renderer = prepared(scene(areas), index=index)
    renderer.render()
    renderer.edit("areas", add=new, replace={0: box(20, 35, 55, 70)})
    expected = prepared(scene([box(20, 35, 55, 70), *areas[1:], *new]), index=index).render()
    assert_close(renderer.render(), expected)
    assert picks(renderer.render()) == picks(expected)


def test_an_edited_scene_can_be_saved(tmp_path: Path) -> None:
    scene = scene_of(some_areas(), some_ways())
    renderer = prepared(scene)
    renderer.edit("areas", add=NEW_AREAS, remove=[1, 2])
    renderer.save(tmp_path / "map.decal")
    opened = dg.Renderer(SIZE, "none")
    opened.open(tmp_path / "map.decal")
    opened.update(OBLIQUE)
    np.testing.assert_array_equal(opened.render().image, renderer.render().image)
    assert picks(opened.render()) == picks(renderer.render())


def test_a_budget_that_an_edit_passes_leaves_the_map_as_it_was() -> None:
    scene = scene_of(some_areas(), some_ways())
    used = sum(prepared(scene).render().stats.bytes.values())
    renderer = prepared(scene, memory_limit=int(1.05 * used))
    before = renderer.render()
    random = np.random.default_rng(3)
    many = [LineString(random.uniform(0.0, 100.0, (50, 2))) for _ in range(200)]
    with pytest.raises(dg.MemoryLimitError):
        renderer.edit("ways", add=many)
    np.testing.assert_array_equal(renderer.render().image, before.image)
