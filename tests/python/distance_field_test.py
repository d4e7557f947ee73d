"""Networks by distance fields: against the reference and static decals, and each choice by what it shows."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, box

import decalgl as dg
from decalgl import reference as ref
from judge import judge_ids, overlay_of, own_surface
from scenes import View
from shapes import hills_terrain, walk
from small_scenes import MAP, SIZE, draw, flat_scene, hilly_scene, pixel

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

WHITE, BLACK, RED, GOLD = (255, 255, 255, 255), (0, 0, 0, 255), (255, 0, 0, 255), (255, 215, 0, 255)
EXACT: dict[str, Any] = {"bits": 32, "drop_off": "exact"}
SMALL = (240, 135)
CROSS = [LineString([(0, 50), (50, 50), (100, 50)]), LineString([(50, 0), (50, 50), (50, 100)])]
LOW_AND_HIGH = {
    "low": dg.NetworkStyle(20, "red", "black", main=0.6),
    "high": dg.NetworkStyle(20, "gold", "black", main=0.6),
}


def network(
    lines: Any = CROSS, category: Any = ("low", "high"), styles: Any = None, **options: Any
) -> dg.Scene:
    """Flat ground with a network."""
    scene = flat_scene()
    technique = dg.DistanceField(category=category, styles=styles or LOW_AND_HIGH, **options)
    scene.add_lines(lines, name="roads", technique=technique)
    return scene


def one_line(style: Any, **options: Any) -> dg.Scene:
    """A line from west to east through the middle."""
    return network([CROSS[0]], ["one"], {"one": style}, **options)


def width_at(frame: dg.Frame, x: int) -> int:
    """Pixels of a feature in a column, which are metres."""
    return int((frame.ids[:, x] >= 0).sum())


def walks(technique: Any, camera: dg.Camera | None = None, casing: dg.Casing | None = None) -> View:
    """Lines of three looks over hills, which are categories from the bottom to the top."""
    scene = dg.Scene(hills_terrain(relief=60.0))
    generator = np.random.default_rng(7)
    found = [LineString(walk(generator, generator.uniform(-600, 600, 2), 40.0, 20)) for _ in range(24)]
    widths = np.repeat([9.0, 25.0, 60.0], 8)
    colors = np.repeat(["#1b6", "#c33", "#235"], 8)
    scene.add_lines(
        found, width=widths, width_units="m", color=list(colors), casing=casing, technique=technique
    )
    return View(scene, camera or dg.Camera.orbit((0.0, 0.0, 0.0), 1500.0, 160.0, 45.0), SMALL)


RIDGES = dg.Camera.look_at((-900.0, -700.0, 90.0), (0.0, 0.0, 20.0), fov=40.0)
CAMERAS = {
    "oblique": None,
    "ridges": RIDGES,
    "orthographic": dg.Camera((-900.0, -1500.0, 1400.0), (0.0, 0.0, 0.0), fov=None, view_height=900.0),
}


@pytest.mark.parametrize("camera", CAMERAS)
def test_ids_are_the_references(camera: str) -> None:
    view = walks("distance_field", CAMERAS[camera], dg.Casing(width=4.0))
    frame = draw(view.scene, view.camera, view.size)
    found = judge_ids(view, frame, own_surface(view, frame), 0.02)
    assert (frame.ids >= 0).sum() > 1000
    assert found.far == 0
    assert found.wrong <= 8


def coverage_error(view: View, antialias: str, silhouettes: bool = False) -> tuple[float, float]:
    """Root mean square and the 99th of 100 of the overlay's error, over pixels that are partly covered."""
    found = overlay_of(dg.Renderer(size=view.size, terrain_error=0.0), view, antialias)
    expected = ref.render_overlay(view.scene, view.camera, view.size, samples=8)
    partly = expected.varied & (expected.terrain_fraction == 1.0) & (expected.mixed == silhouettes)
    error = np.abs(found[..., 3] - expected.rgba[..., 3])[partly]
    assert error.size > 500
    return float(np.sqrt((error**2).mean())), float(np.quantile(error, 0.99))


@pytest.mark.parametrize(
    ("options", "rms", "most"),
    [({}, 0.04, 0.15), ({"blending": "nearest", **EXACT}, 0.036, 0.14)],
    ids=["8 bits", "exact"],
)
def test_coverage_comes_near_the_reference(options: Any, rms: float, most: float) -> None:
    found = coverage_error(walks(dg.DistanceField(**options)), "coverage")
    assert found[0] < rms
    assert found[1] < most


def test_silhouettes_carry_fields_on_to_their_samples() -> None:
    found = coverage_error(walks(dg.DistanceField(**EXACT), RIDGES), "coverage", silhouettes=True)
    assert found[0] < 0.18


def test_samples_of_whole_pictures_come_near_too() -> None:
    assert coverage_error(walks(dg.DistanceField(**EXACT)), "ssaa")[0] < 0.12


@pytest.mark.parametrize("antialias", ["none", "fxaa", "msaa"])
def test_pictures_are_those_of_static_lines(antialias: str) -> None:
    casing = dg.Casing(width=4.0)
    found, expected = (
        draw(view.scene, view.camera, view.size, antialias=antialias).image.astype(int)
        for view in (walks(dg.DistanceField(**EXACT), casing=casing), walks("static", casing=casing))
    )
    assert (np.abs(found - expected).max(axis=2) > 2).sum() <= 6


def test_an_eye_inside_a_box_sees_the_line() -> None:
    lines = [LineString([(10, 50), (90, 52)]), LineString([(48, 10), (52, 90)])]
    frames = []
    for technique in ("static", dg.DistanceField(**EXACT)):
        scene = hilly_scene()
        scene.add_lines(lines, width=12, width_units="m", color="red", technique=technique)
        camera = dg.Camera.look_at((30.0, 50.0, 12.0), (60.0, 50.0, 15.0), fov=70.0)
        frames.append(draw(scene, camera, (160, 90)))
    assert (frames[0].ids >= 0).sum() > 3000
    np.testing.assert_array_equal(frames[0].ids, frames[1].ids)


def test_a_picture_in_rectangles_has_the_same_bytes() -> None:
    view = walks(dg.DistanceField(), casing=dg.Casing(width=4.0))
    whole, parts = dg.Renderer(size=SMALL), dg.Renderer(size=SMALL, tile=64)
    pictures = []
    for renderer in (whole, parts):
        renderer.preprocess(view.scene)
        renderer.update(view.camera)
        pictures.append(renderer.render())
    np.testing.assert_array_equal(pictures[0].image, pictures[1].image)
    np.testing.assert_array_equal(pictures[0].ids, pictures[1].ids)


def test_pick_names_what_ids_show() -> None:
    view = walks("distance_field", casing=dg.Casing(width=4.0))
    frame = draw(view.scene, view.camera, view.size)
    for y in range(5, SMALL[1], 13):
        for x in range(5, SMALL[0], 13):
            picked = [found.row for found in frame.pick(x, y)]
            assert (frame.ids[y, x] >= 0) == bool(picked)
            assert frame.ids[y, x] in (picked or [-1])


# Categories and borders


def test_categories_lie_over_each_other_by_rank() -> None:
    over, under, smooth = (draw(network(borders=borders)) for borders in ("over", "under", "smooth"))
    for frame in (over, under, smooth):
        assert pixel(frame, 20, 50) == RED
        assert pixel(frame, 50, 20) == GOLD
        assert pixel(frame, 20, 58) == BLACK
    assert pixel(over, 50, 50) == pixel(under, 50, 50) == GOLD
    # The upper road's border crosses the lower road, or opens.
    assert pixel(over, 58, 50) == BLACK
    assert pixel(under, 58, 50) == RED
    assert pixel(smooth, 58, 50) == RED
    # Between the two main colours, from one to the other.
    between = [pixel(smooth, x, 54)[1] for x in (50, 53, 54, 55)]
    assert between == sorted(between, reverse=True)
    assert len(set(between)) > 2


def test_crossings_of_one_category_are_open() -> None:
    frame = draw(network(category=("low", "low"), borders="over"))
    assert pixel(frame, 58, 50) == pixel(frame, 50, 58) == RED
    assert pixel(frame, 58, 58) == BLACK


def test_rows_of_other_categories_are_left_out_or_named_none() -> None:
    frame = draw(network(category=("low", "other")))
    assert (np.unique(frame.ids) == [-1, 0]).all()
    styles = {None: dg.NetworkStyle(10, "cyan"), **LOW_AND_HIGH}
    assert pixel(draw(network(category=("low", "other"), styles=styles)), 50, 20) == (0, 255, 255, 255)


def test_highlighted_rows_lie_over_all_others() -> None:
    frame = draw(network(highlight=[0], highlight_style=dg.NetworkStyle(10, "magenta")))
    assert pixel(frame, 50, 50) == pixel(frame, 20, 50) == (255, 0, 255, 255)
    assert frame.ids[50, 50] == 0
    assert pixel(frame, 50, 20) == GOLD


def test_fields_take_what_the_paper_says() -> None:
    for bits, depth, lengths in ((8, False, False), (32, True, True)):
        style = dg.NetworkCategory(LOW_AND_HIGH["low"], dash=(5, 5) if lengths else None)
        scene = network(styles={"low": style, "high": LOW_AND_HIGH["high"]}, bits=bits, keep_depth=depth)
        objects = draw(scene).stats.to_dict()["objects"]
        fields = ["cross distances", *(["lengths"] if lengths else []), *(["depths"] if depth else [])]
        categories, texel = 2, bits // 8
        for name in fields:
            assert objects[f"distance_field: {name}"] == categories * SIZE[0] * SIZE[1] * texel
        assert sum(name.startswith("distance_field: ") and name.endswith("s") for name in objects) >= len(
            fields
        )
        assert ("distance_field: depths" in objects) == depth


# Levels of detail

NEAR_AND_FAR = [(0.0, dg.NetworkStyle(10, "white")), (1.0, dg.NetworkStyle(30, "black"))]


def test_styles_lie_between_two_levels() -> None:
    for lod, width in ((0.0, 10), (0.5, 20), (1.0, 30)):
        frame = draw(one_line(NEAR_AND_FAR, lod=dg.Lod.at(lod), **EXACT))
        assert abs(width_at(frame, 50) - width) <= 1
        assert abs(pixel(frame, 50, 50)[0] - 255 * (1 - lod)) <= 1


def test_levels_follow_the_distance() -> None:
    scene = one_line(NEAR_AND_FAR, lod=dg.Lod.by_distance(50.0, 250.0), **EXACT)
    for eye, width in ((50.0, 10), (150.0, 20), (300.0, 30)):
        camera = dg.Camera.look_at((50.0, 50.0, eye), (50.0, 50.0, 0.0), up=(0.0, 1.0, 0.0), fov=45.0)
        frame = draw(scene, camera, (200, 200))
        metres = 2.0 * eye * np.tan(np.radians(22.5)) / 200
        assert abs((frame.ids[:, 100] >= 0).sum() * metres - width) <= 2 * metres


@pytest.mark.parametrize(
    "lod",
    [
        dg.Lod.by_texture([[0.0, 1.0]], (0.0, 0.0, 100.0, 100.0)),
        dg.Lod.by_texture([[0.0, 1.0]], space="screen"),
        dg.Lod.by_texture([[0.0, 1.0]], (-50.0, 0.0, 50.0, 1000.0), space="camera"),
        dg.Lod.lens((80.0, 50.0), 25.0),
        dg.Lod.along([(70.0, 50.0), (95.0, 50.0)], 20.0, 5.0),
    ],
    ids=["map", "screen", "camera", "lens", "route"],
)
@pytest.mark.parametrize("widths_at", ["fragment", "vertex"])
def test_levels_follow_a_texture(lod: dg.Lod, widths_at: Any) -> None:
    line = LineString([(x, 50) for x in range(0, 101, 5)])
    scene = network([line], ["one"], {"one": NEAR_AND_FAR}, lod=lod, widths_at=widths_at, **EXACT)
    frame = draw(scene)
    assert abs(width_at(frame, 10) - 10) <= 1
    assert abs(width_at(frame, 85) - 30) <= 1


def test_textures_lie_the_right_way_up() -> None:
    lod = dg.Lod.by_texture([[1.0], [0.0]], (0.0, 0.0, 100.0, 100.0))
    line = LineString([(50, y) for y in range(0, 101, 5)])
    frame = draw(network([line], ["one"], {"one": NEAR_AND_FAR}, lod=lod, **EXACT))
    assert ((frame.ids[10] >= 0).sum(), (frame.ids[90] >= 0).sum()) == (30, 10)


def test_widths_at_nodes_run_straight_between_them() -> None:
    lod = dg.Lod.by_texture([[0.0, 1.0]], (49.0, 0.0, 51.0, 100.0))
    line = LineString([(10, 50), (90, 50)])
    at_nodes, at_pixels = (
        draw(network([line], ["one"], {"one": NEAR_AND_FAR}, lod=lod, widths_at=place, **EXACT))
        for place in ("vertex", "fragment")
    )
    assert [abs(width_at(at_nodes, x) - width) <= 1 for x, width in ((30, 15), (50, 20), (70, 25))] == [
        True
    ] * 3
    assert [abs(width_at(at_pixels, x) - width) <= 1 for x, width in ((30, 10), (70, 30))] == [True] * 2


# Along the line


def test_dashes_rasters_and_sketches_run_along_the_line() -> None:
    style = dg.NetworkStyle(20, "white", texture_share=1.0)
    for options in ({"bits": 8}, {"bits": 32}, {"blending": "nearest"}):
        dashed = draw(one_line(dg.NetworkCategory(style, dash=(20, 20)), **options))
        assert [width_at(dashed, x) for x in (10, 30, 50, 70)] == [20, 0, 20, 0]
        texture = np.zeros((2, 2, 4), dtype=np.uint8)
        texture[..., 3] = 255
        texture[:, 0, 0] = texture[1, :, 1] = 255
        textured = draw(one_line(dg.NetworkCategory(style, texture=texture, texture_length=40.0), **options))
        assert np.abs(np.array(pixel(textured, 49, 49)[:2]) - (255, 0)).max() < 25
        assert np.abs(np.array(pixel(textured, 69, 49)[:2]) - (0, 0)).max() < 25
        assert np.abs(np.array(pixel(textured, 49, 58)[:2]) - (255, 255)).max() < 25
    sketched = draw(one_line(dg.NetworkCategory(style, sketch=(0.5, 10.0)), bits=32))
    shown = (sketched.image != draw(flat_scene()).image).any(axis=2).sum(axis=0)
    assert shown[10:90].min() < 16
    assert shown[10:90].max() > 18


def test_the_nearest_segments_length_is_kept() -> None:
    """At a crossing, the least of both lengths is another line's; the nearest segment's is its own."""
    category = dg.NetworkCategory(dg.NetworkStyle(20, "white"), dash=(10, 10))
    lines = [LineString([(0, 50), (100, 50)]), LineString([(55, 42), (55, 100)])]
    wrong = {}
    for blending in ("minimum", "nearest"):
        frame = draw(network(lines, ["a", "a"], {"a": category}, blending=blending, bits=32))
        row = frame.image[50, 42:70, 0] == 255
        wrong[blending] = int((row != (np.arange(42, 70) % 20 < 10)).sum())
    assert wrong["nearest"] < wrong["minimum"]


# Ends


def test_caps_go_by_the_nodes_grade() -> None:
    style = dg.NetworkStyle(20, "white")
    line = [LineString([(20, 50), (80, 50)])]
    reach = {}
    for cap in ("round", "square", "butt"):
        frame = draw(network(line, ["a"], {"a": dg.NetworkCategory(style, cap=cap)}))
        reach[cap] = (
            int((frame.image[50] == 255).all(axis=1).sum()),
            int((frame.image[41, :] == 255).all(axis=1).sum()),
        )
    assert reach["round"][0] == reach["square"][0] == 80
    assert reach["butt"] == (60, 60)
    assert reach["round"][1] < reach["square"][1] == 80
    tee = [*line, LineString([(80, 50), (80, 90)]), LineString([(80, 50), (80, 10)])]
    category = dg.NetworkCategory(style, cap={1: "butt", 3: "round"})
    frame = draw(network(tee, ["a"] * 3, {"a": category}))
    assert [pixel(frame, 15, 50)[:3] == (255, 255, 255), pixel(frame, 85, 95)[:3] == (255, 255, 255)] == [
        False
    ] * 2
    assert pixel(frame, 88, 50) == WHITE


def test_drop_offs_of_your_own_shape_the_cap() -> None:
    side = np.linspace(0.0, 1.0, 512)
    pointed = np.minimum(side[None, :] + side[:, None], 1.0)
    style = dg.NetworkCategory(dg.NetworkStyle(20, "white"), cap=pointed)
    frame = draw(network([LineString([(20, 50), (80, 50)])], ["a"], {"a": style}))
    assert pixel(frame, 72 + 10, 45) == WHITE
    assert pixel(frame, 86, 57) != WHITE
    assert pixel(frame, 83, 57) != WHITE


# The artefacts that section 6.2 of the paper names

CLOSE = [LineString([(5, 57), (50, 56), (95, 57)]), LineString([(5, 43), (50, 44), (95, 43)])]


def test_intrusion_is_there_and_mended() -> None:
    style = {"a": dg.NetworkStyle(20, "white", "black", main=0.8)}
    joined = draw(network(CLOSE, ["a", "a"], style))
    apart = draw(network(CLOSE, ["a", "a"], style, mend_intrusion=True, widths_at="vertex"))
    column = [frame.image[:, 50, 0] for frame in (joined, apart)]
    # Two lines that run into each other are one; apart, there is a border or ground between them.
    assert (column[0][40:60] == 255).all()
    assert (column[1][48:52] < 255).all()
    assert pixel(apart, 50, 56) == pixel(apart, 50, 44) == WHITE


def test_protrusion_is_there_and_mended() -> None:
    lines = [LineString([(0, 30), (50, 30), (100, 30)]), LineString([(50, 30), (50, 90)])]
    styles = {"wide": dg.NetworkStyle(40, "red"), "narrow": dg.NetworkStyle(10, "white")}
    stands_out = draw(network(lines, ["narrow", "wide"], styles))
    cut = draw(network(lines, ["narrow", "wide"], styles, mend_protrusion=True))
    assert pixel(stands_out, 50, 15) == RED
    assert pixel(cut, 50, 15) != RED
    for frame in (stands_out, cut):
        assert (pixel(frame, 50, 32), pixel(frame, 50, 60)) == (WHITE, RED)
    assert cut.ids[100 - 15, 50] == -1


# Changes


def restyled(scene: dg.Scene, change: Callable[[dg.Renderer], None]) -> dg.Frame:
    renderer = dg.Renderer(size=SIZE, antialias="coverage")
    renderer.preprocess(scene)
    renderer.update(MAP)
    renderer.render()
    change(renderer)
    return renderer.render()


@pytest.mark.parametrize(
    "options",
    [
        {"styles": {"low": dg.NetworkStyle(30, "navy", "white"), "high": dg.NetworkStyle(4, "lime")}},
        {"borders": "smooth", "lod": dg.Lod.at(1.0)},
        {"highlight": [1], "highlight_style": dg.NetworkStyle(6, "magenta"), "bits": 32},
        {"mend_protrusion": True, "blending": "nearest"},
    ],
    ids=["styles", "borders", "highlight", "mends"],
)
def test_a_restyle_is_as_prepared_anew(options: Any) -> None:
    options = {"category": ("low", "high"), "styles": LOW_AND_HIGH, **options}
    technique = dg.DistanceField(**options)
    found = restyled(network(), lambda renderer: renderer.restyle("roads", technique=technique))
    expected = draw(network(**options), antialias="coverage")
    np.testing.assert_array_equal(found.image, expected.image)
    np.testing.assert_array_equal(found.ids, expected.ids)
    np.testing.assert_array_equal(found.layers, expected.layers)


def test_looks_are_restyled_too() -> None:
    view = walks("distance_field")
    renderer = dg.Renderer(size=SMALL)
    renderer.preprocess(view.scene)
    renderer.update(view.camera)
    renderer.restyle(0, color="red", width=30.0)
    found = renderer.render()
    renderer.restyle(0, visible=np.arange(24) < 3)
    assert set(np.unique(renderer.render().ids)) <= {-1, 0, 1, 2}
    scene = dg.Scene(view.scene.terrain)
    lines = [LineString(view.scene.layers[0].features.coords[a:b]) for a, b in _parts(view.scene)]
    scene.add_lines(lines, color="red", width=30.0, width_units="m", technique="distance_field")
    np.testing.assert_array_equal(found.image, draw(scene, view.camera, SMALL, antialias="coverage").image)


def _parts(scene: dg.Scene) -> list[tuple[int, int]]:
    offsets = scene.layers[0].features.part_offsets.tolist()
    return list(itertools.pairwise(offsets))


@pytest.mark.parametrize("antialias", ["none", "coverage"])
def test_a_lens_shows_other_styles(antialias: str) -> None:
    styles = {name: dg.NetworkStyle(30, "navy") for name in LOW_AND_HIGH}
    inside = dg.DistanceField(category=("low", "high"), styles=styles)
    renderer = dg.Renderer(size=SIZE, antialias=antialias)
    renderer.preprocess(network())
    renderer.update(MAP)
    renderer.lens = dg.Lens(circle=(25.0, 50.0, 15.0), styles={"roads": {"technique": inside}})
    frame = renderer.render()
    assert pixel(frame, 25, 50) == pixel(frame, 25, 62) == (0, 0, 128, 255)
    assert pixel(frame, 75, 50) == RED
    assert pixel(frame, 75, 62) != (0, 0, 128, 255)
    assert (frame.ids[38, 25], frame.ids[38, 75]) == (0, -1)


# What is refused


def refused(scene: dg.Scene, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        draw(scene)


def test_what_fields_cannot_draw_is_refused_by_name() -> None:
    scene = flat_scene()
    scene.add_polygons([box(0, 0, 9, 9)], technique="distance_field")
    refused(scene, dg.UnsupportedError, "networks of lines")
    for keywords, words in (({"corner": "miter"}, "round corners"), ({"corner": "bevel"}, "round corners")):
        scene = flat_scene()
        scene.add_lines(CROSS, width=3, width_units="m", technique="distance_field", **keywords)
        refused(scene, dg.UnsupportedError, words)
    scene = flat_scene()
    many = [LineString([(0, y), (9, y)]) for y in range(70)]
    scene.add_lines(many, width=np.arange(1.0, 71.0), width_units="m", technique="distance_field")
    refused(scene, dg.StyleError, "more than 64 different looks")


def test_files_and_edits_are_refused(tmp_path: Any) -> None:
    renderer = dg.Renderer(size=SIZE)
    renderer.preprocess(network())
    with pytest.raises(dg.UnsupportedError, match="not kept on disk"):
        renderer.save(tmp_path / "scene.decal")
    with pytest.raises(dg.UnsupportedError, match="prepare the scene anew"):
        renderer.edit("roads", remove=[0])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"category": "kind"}, "Give both or neither"),
        ({"bits": 16}, "8 or 32"),
        ({"borders": "none"}, "'over' or 'under' or 'smooth'"),
        ({"mend_intrusion": True}, "widths_at='vertex'"),
        ({"highlight": [1]}, "category="),
        ({"category": "k", "styles": {}}, "dict"),
        ({"category": "k", "styles": {"a": 3}}, "category 'a'"),
        ({"category": "k", "styles": LOW_AND_HIGH, "highlight": [1]}, "highlight_style"),
        ({"lod": 0.5}, "Lod"),
    ],
)
def test_choices_are_checked(options: Any, words: str) -> None:
    with pytest.raises(dg.StyleError, match=words):
        dg.DistanceField(**options)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: dg.NetworkStyle(-1), "0 or more"),
        (lambda: dg.NetworkStyle(1, main=2), "between 0 and 1"),
        (lambda: dg.NetworkCategory([]), "1 to 16 pairs"),
        (lambda: dg.NetworkCategory(list(reversed(NEAR_AND_FAR))), "must rise"),
        (lambda: dg.NetworkCategory(NEAR_AND_FAR, cap="flat"), "grade 1"),
        (lambda: dg.NetworkCategory(NEAR_AND_FAR, cap={7: "butt"}), "grade 7"),
        (lambda: dg.NetworkCategory(NEAR_AND_FAR, texture=np.zeros((2, 2))), "rows, columns, 4"),
        (lambda: dg.NetworkCategory(NEAR_AND_FAR, sketch=(2.0, 1.0)), "between 0 and 1"),
        (lambda: dg.Lod.by_distance(9.0, 3.0), "below far"),
        (lambda: dg.Lod.by_texture([[2.0]]), "from 0 to 1"),
        (lambda: dg.Lod.by_texture([[1.0]], (1.0, 0.0, 0.0, 1.0)), "rising"),
        (lambda: dg.road_styles("atlantis"), "no road styles"),
    ],
)
def test_styles_are_checked(make: Callable[[], Any], words: str) -> None:
    with pytest.raises(dg.StyleError, match=words):
        make()


def test_categories_are_checked_against_the_layer() -> None:
    scene = flat_scene()
    for category, words in ((["low"], "2 rows"), (["nothing", "else"], "no row's category")):
        with pytest.raises(dg.StyleError, match=words):
            scene.add_lines(CROSS, technique=dg.DistanceField(category=category, styles=LOW_AND_HIGH))
    assert scene.layers == ()


def test_road_styles_of_three_countries_restyle_a_map() -> None:
    pictures: list[NDArray[np.uint8]] = []
    scene = network(category=("residential", "primary"), styles=dg.road_styles("germany"))
    renderer = dg.Renderer(size=SIZE)
    renderer.preprocess(scene)
    renderer.update(MAP)
    for country in ("germany", "france", "britain"):
        styles = dg.road_styles(country)  # type: ignore[arg-type]
        technique = dg.DistanceField(category=("residential", "primary"), styles=styles)
        renderer.restyle("roads", technique=technique)
        pictures.append(renderer.render().image)
    assert len({picture.tobytes() for picture in pictures}) == 3
