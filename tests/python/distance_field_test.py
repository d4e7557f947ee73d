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
from small_networks import BLACK, CROSS, EXACT, GOLD, LOW_AND_HIGH, NEAR_AND_FAR, RED, network
from small_scenes import MAP, SIZE, draw, flat_scene, hilly_scene, pixel

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

SMALL = (240, 135)


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
