"""Shadow volumes: against the reference on scenes of every kind, groups and batches, and what they refuse."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely
from shapely import LineString, Point, Polygon, box

import decalgl as dg
import judge
import scenes
from decalgl import reference as ref
from decalgl._triangles import triangles_of
from scenes import View
from shapes import drawn_by, rings
from small_scenes import MAP, SIZE, draw, flat_scene, hilly_scene, pixel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

SCENES = [
    "hills", "hills_orthographic", "translucent", "grazing_plain", "far_coordinates", "eye_at_one_metre",
    "eye_at_500_km_wide", "map_from_above", "nodata_holes", "coast", "one_quad", "larger_than_the_map", "nested_holes",
    "slivers",
]  # fmt: skip
# Pixels: the rasteriser snaps corners to 1/256, and the depth of a face has 24 bits.
NEAR = 0.02
# Of the half width: a chord of a round corner, at the default step.
SAGITTA = 1.0 - np.cos(np.radians(11.25 / 2))
VOLUME = dg.Volume()


def renderer(**options: Any) -> dg.Renderer:
    return dg.Renderer(**{"antialias": "none", "terrain_error": 0.0, **options})


def drawn(view: View, technique: dg.Technique = VOLUME, **options: Any) -> dg.Frame:
    return judge.draw(renderer(**options), view._replace(scene=drawn_by(view.scene, technique)))


def widest(scene: dg.Scene) -> float:
    """Half of the widest line's width, metres."""
    return max((float(layer.widths.max(initial=0.0)) for layer in scene.layers), default=0.0) / 2


@pytest.mark.parametrize("name", SCENES)
def test_ids_are_those_of_the_reference(name: str) -> None:
    view = scenes.build(name)
    frame = drawn(view)
    assert (frame.ids >= 0).any()
    found = judged(view, frame)
    assert found.far == 0, found
    assert found.wrong <= 60, found


def judged(view: View, frame: dg.Frame) -> judge.Ids:
    """Its ids against the reference: far, where they are wrong farther than NEAR from a border."""
    seen = judge.own_surface(view, frame)
    points = judge.centres_of(view)
    surface = ref.Surface(seen.world.reshape(-1, 3), seen.depth.reshape(-1), seen.gradient.reshape(-1, 2))
    allowed = NEAR * judge.footprint(view, points, surface).reshape(frame.ids.shape) + SAGITTA * widest(
        view.scene
    )
    return judge.judge_ids(view, frame, seen, allowed)


@pytest.mark.parametrize("terrain_error", [0.5, 4.0])
def test_levels_of_detail_of_the_terrain_stay_inside_of_the_volumes(terrain_error: float) -> None:
    view = scenes.build("hills")
    frame = drawn(view, terrain_error=terrain_error)
    static = judge.draw(renderer(terrain_error=terrain_error), view)
    assert (frame.ids != static.ids).sum() <= 30


@pytest.mark.parametrize("antialias", ["none", "ssaa", "msaa", "fxaa"])
def test_a_picture_in_rectangles_is_the_same_but_on_borders(antialias: str) -> None:
    view = scenes.build("translucent")
    whole, cut = (drawn(view, antialias=antialias, tile=tile) for tile in (None, 130))
    # Depth is interpolated from the rectangle's corner: a border may pass a centre on the other side, but not farther.
    assert (whole.image != cut.image).any(axis=-1).sum() <= 4
    assert (whole.ids != cut.ids).sum() <= 4
    if antialias == "none":
        assert judged(view, cut).far == 0


@pytest.mark.parametrize("antialias", ["ssaa", "msaa", "fxaa"])
def test_anti_aliasing_is_as_that_of_static_layers(antialias: str) -> None:
    view = scenes.build("hills")._replace(size=(320, 180))
    apart = np.abs(
        judge.draw(renderer(), view, antialias).image.astype(int)
        - judge.draw(renderer(), view._replace(scene=drawn_by(view.scene, VOLUME)), antialias).image
    )
    assert (apart.max(axis=-1) > 40).sum() <= 20


def test_the_eye_may_be_inside_of_a_volume() -> None:
    scene = hilly_scene()
    scene.add_polygons([box(10, 10, 90, 90)], color="red", technique="volume")
    camera = dg.Camera.look_at((50.0, 50.0, 20.5), (90.0, 55.0, 0.0))
    frame = draw(scene, camera)
    near = (np.abs(frame.world[..., :2] - 50.0).max(axis=-1) < 39.9) & (frame.ids < 0)
    far = (np.abs(frame.world[..., :2] - 50.0).max(axis=-1) > 40.1) & (frame.ids >= 0)
    assert (frame.ids >= 0).sum() > 1000
    assert not near.any()
    assert not far.any()


# Draw order


def crossing_of(colors: list[str], **looks: Any) -> dg.Scene:
    """Bars, each over all of the others before it."""
    scene = flat_scene()
    bars = [box(10 + 5 * i, 20, 30 + 5 * i, 80) for i in range(len(colors))]
    scene.add_polygons(bars, color=colors, **looks)
    return scene


def crossing(**looks: Any) -> dg.Scene:
    """Bars of two colours in turn."""
    return crossing_of(["red", "blue"] * 4, **looks)


def counts(frame: dg.Frame) -> dict[str, float]:
    return frame.stats.counts


def test_exact_groups_keep_the_draw_order() -> None:
    plain, volume = draw(crossing()), draw(crossing(technique=VOLUME))
    np.testing.assert_array_equal(plain.image, volume.image)
    assert counts(volume)["volume_groups"] == 8


def test_groups_by_color_are_as_many_as_colors() -> None:
    volume = draw(crossing(technique=dg.Volume(groups="colors")))
    assert counts(volume)["volume_groups"] == 2
    # Blue came second, so all of it is over all of the red.
    assert pixel(volume, 42.5, 50.0) == (0, 0, 255, 255)
    assert pixel(draw(crossing()), 42.5, 50.0) == (255, 0, 0, 255)


def test_polygons_that_only_touch_share_groups() -> None:
    scene = flat_scene()
    cells = [box(10 * x, 10 * y, 10 * x + 10, 10 * y + 10) for x in range(10) for y in range(10)]
    colors = ["red", "lime", "blue"]
    scene.add_polygons(cells, color=[colors[i % 3] for i in range(100)], technique=VOLUME)
    frame = draw(scene)
    assert counts(frame)["volume_groups"] == 3
    assert (frame.ids >= 0).all()


def test_translucent_decals_of_one_color_add_up() -> None:
    looks: dict[str, Any] = {"color": "red", "alpha": 0.5}
    pictures = []
    for technique in (dg.Static(), VOLUME):
        scene = flat_scene()
        scene.add_polygons([box(10, 10, 60, 60), box(40, 40, 90, 90)], technique=technique, **looks)
        pictures.append(draw(scene).image.astype(int))
    assert np.abs(pictures[0] - pictures[1]).max() <= 1


@pytest.mark.parametrize("alpha", [1.0, 0.5])
@pytest.mark.parametrize("copies", [127, 255, 256, 300, 512])
def test_counts_do_not_overflow(copies: int, alpha: float) -> None:
    frames = []
    for technique in (dg.Static(), VOLUME):
        scene = flat_scene()
        if alpha == 1.0:
            scene.add_polygons([box(20, 20, 80, 80)] * copies, color="red", technique=technique)
        else:
            # One line that runs to and fro over itself, and counts once.
            to_and_fro = LineString([(20, 50), (80, 50)] * (copies // 2))
            looks = {"color": "red", "alpha": alpha, "width": 20, "width_units": "m"}
            scene.add_lines([to_and_fro], technique=technique, **looks)
        frames.append(draw(scene))
    # Round ends are chords.
    assert (frames[0].ids != frames[1].ids).sum() <= 8
    shown = (frames[1].image != frames[1].image[0, 0]).any(axis=-1)
    np.testing.assert_array_equal(shown, frames[1].ids >= 0)
    assert len(np.unique(frames[1].image[shown], axis=0)) == 1
    assert (counts(frames[1])["volume_batches"] > 1) == (alpha < 1.0 or copies > 255)


# What changes without meshing anew, and files


def changed(keywords: dict[str, Any], scene: dg.Scene, layer: int = 0) -> dg.Frame:
    """After a restyle of one layer."""
    volumes = renderer(size=SIZE)
    volumes.preprocess(scene)
    volumes.update(MAP)
    volumes.render()
    volumes.restyle(layer, **keywords)
    return volumes.render()


def same(a: dg.Frame, b: dg.Frame) -> None:
    np.testing.assert_array_equal(a.image, b.image)
    np.testing.assert_array_equal(a.ids, b.ids)


@pytest.mark.parametrize("groups", ["exact", "colors"])
def test_a_restyle_is_as_prepared_anew(groups: Any) -> None:
    technique = dg.Volume(groups=groups)
    colors = ["lime", "lime", "red", "blue", "blue", "red", "lime", "cyan"]
    same(
        changed({"color": colors, "opacity": 0.6}, crossing(technique=technique)),
        draw(crossing_of(colors, alpha=0.6, technique=technique)),
    )
    backwards = list(range(8, 0, -1))
    same(
        changed({"order": backwards}, crossing(technique=technique)),
        draw(crossing(order=backwards, technique=technique)),
    )
    shown = np.arange(8) % 3 != 0
    frame = changed({"visible": shown}, crossing(technique=technique))
    assert set(np.unique(frame.ids)) == {-1, *np.flatnonzero(shown)}
    assert frame.stats.counts["volumes"] == shown.sum()


def test_another_width_is_refused_by_name() -> None:
    scene = flat_scene()
    scene.add_lines([LineString([(0, 0), (90, 90)])], width=4, width_units="m", name="way", technique=VOLUME)
    with pytest.raises(dg.StyleError, match=r"'way'.*prepare the scene anew"):
        changed({"width": 8.0}, scene)


def test_the_lens_shows_other_looks() -> None:
    volumes = renderer(size=SIZE)
    volumes.preprocess(crossing(technique=VOLUME))
    volumes.update(MAP)
    volumes.lens = dg.Lens(circle=(50.0, 50.0, 20.0), styles={0: {"color": "lime"}}, hidden=[])
    frame = volumes.render()
    assert pixel(frame, 50, 50) == (0, 255, 0, 255)
    assert pixel(frame, 50, 25) == pixel(draw(crossing(technique=VOLUME)), 50, 25)
    volumes.lens = None
    same(volumes.render(), draw(crossing(technique=VOLUME)))


def test_what_is_saved_opens_as_it_was(tmp_path: Any) -> None:
    volumes, opened = renderer(size=SIZE), renderer(size=SIZE)
    volumes.preprocess(crossing(technique=VOLUME))
    volumes.save(tmp_path / "map.decalgl")
    opened.open(tmp_path / "map.decalgl")
    opened.restyle(0, color="cyan", where=np.arange(8) == 5)
    volumes.restyle(0, color="cyan", where=np.arange(8) == 5)
    frames = []
    for each in (volumes, opened):
        each.update(MAP)
        frames.append(each.render())
    same(*frames)
    assert [one.row for one in frames[1].pick(42, 50)] == [6, 5, 4, 3]


def test_edits_are_refused() -> None:
    volumes = renderer(size=SIZE)
    volumes.preprocess(crossing(technique=VOLUME))
    with pytest.raises(dg.UnsupportedError, match="cannot edit its meshes"):
        volumes.edit(0, remove=[0])


# Lines


@pytest.mark.parametrize("corner", ["round", "miter", "bevel"])
@pytest.mark.parametrize("cap", ["round", "butt", "square"])
def test_strokes_are_those_of_the_reference(corner: str, cap: str) -> None:
    generator = np.random.default_rng(5)
    lines = [LineString(generator.uniform(10, 90, (6, 2))) for _ in range(4)]
    lines += [LineString(Point(30, 30).buffer(8, quad_segs=2).exterior), LineString([(70, 20), (70, 20)])]
    scene = flat_scene()
    scene.add_lines(
        lines,
        width=[6, 3, 1, 9, 5, 4],
        width_units="m",
        corner=corner,
        cap=cap,
        color=["red", "lime", "blue", "cyan", "magenta", "yellow"],
        technique=VOLUME,
    )
    view = View(scene, MAP, (400, 400))
    frame = judge.draw(renderer(), view)
    found = judge.judge_ids(view, frame, judge.own_surface(view, frame), 0.25 * NEAR + 4.5 * SAGITTA)
    assert found.far == 0, found


def test_finer_arcs_are_nearer_to_circles() -> None:
    areas = []
    for step in (45.0, 11.25, 2.0):
        scene = flat_scene()
        scene.add_lines(
            [LineString([(50, 50), (50, 50)])], width=80, width_units="m", technique=dg.Volume(arc_step=step)
        )
        areas.append((draw(scene).ids >= 0).sum() / (np.pi * 40**2))
    assert areas[0] < areas[1] < areas[2]
    assert areas[0] == pytest.approx(np.sin(np.radians(45)) / np.radians(45), abs=0.005)
    assert areas[2] == pytest.approx(1.0, abs=0.002)


# Triangles


def test_triangles_cover_what_the_even_odd_rule_says() -> None:
    square = np.array([(0.0, 0.0), (4, 0), (4, 4), (0, 4)])
    pentagram = np.array([(np.sin(a), np.cos(a)) for a in np.arange(5) * 4 * np.pi / 5])
    features = [
        [square], [square, 0.5 * square + 1], [square, square], [square, square + 2], [pentagram],
        [square, square + 2, square + 2, square + 1],
    ]  # fmt: skip
    scene = flat_scene()
    layer = scene.add_polygons(rings(features))
    triangles, first = triangles_of(layer.features)
    a, b, c = triangles.transpose(1, 2, 0)
    areas = np.abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2
    found = [areas[i:j].sum() for i, j in itertools.pairwise(first)]
    arms = _odd_area(Polygon(pentagram))
    assert found == pytest.approx([16, 12, 0, 24, arms, _odd_rings(features[5])], abs=1e-9)


def _odd_area(polygon: Polygon) -> float:
    """The area of the faces of a star that its border runs around once."""
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all(polygon.exterior)]))
    return float(sum(face.area for face in faces) - max(face.area for face in faces))


def _odd_rings(parts: list[FloatArray]) -> float:
    area = Polygon()
    for part in parts:
        area = area.symmetric_difference(Polygon(part))
    return float(area.area)


# Errors


@pytest.mark.parametrize(
    ("looks", "what"),
    [
        ({"dash": (4, 4)}, "patterns"),
        ({"slope_correction": "tangent"}, "slopes"),
    ],
)
def test_styles_that_volumes_cannot_show_are_refused(looks: dict[str, Any], what: str) -> None:
    scene = flat_scene()
    scene.add_lines(
        [LineString([(0, 0), (90, 90)])], width=4, width_units="m", name="way", technique=VOLUME, **looks
    )
    with pytest.raises(dg.UnsupportedError, match=rf"'way'.*{what}"):
        draw(scene)


def test_coverage_is_refused() -> None:
    with pytest.raises(dg.UnsupportedError, match=r"antialias='coverage'.*ssaa"):
        crossing(technique=VOLUME).render(MAP, SIZE, antialias="coverage")


@pytest.mark.parametrize("options", [{"groups": "none"}, {"arc_step": 0.0}, {"arc_step": True}])
def test_options_out_of_range(options: dict[str, Any]) -> None:
    with pytest.raises(dg.StyleError, match="Volume"):
        dg.Volume(**options)


def test_memory_is_accounted_and_limited() -> None:
    frame = draw(crossing(technique=VOLUME))
    objects = frame.stats.to_dict()["objects"]
    # Of a square: four places of 12 bytes, two lids and two bottoms, eight triangles of walls.
    assert objects["volume: vertices"] == 8 * 4 * 12
    assert objects["volume: corners"] == 8 * 3 * 12 * 2
    with pytest.raises(dg.MemoryLimitError, match="Volume"):
        draw(drawn_by(scenes.build("hills").scene, VOLUME), memory_limit=900_000)


def test_picking_lists_what_lies_over_each_other() -> None:
    frame = draw(crossing(technique=VOLUME))
    picked = frame.pick(42, 50)
    assert [one.row for one in picked] == [6, 5, 4, 3]
