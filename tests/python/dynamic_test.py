"""Dynamic lines: widths on the screen, against closed forms and the reference, by both methods."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, Polygon, box

import decalgl as dg
from decalgl import reference as ref
from small_scenes import BOUNDS, MAP, OBLIQUE, RED, SIZE, count_color, draw, flat_scene, hilly_scene, pixel

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

SMALL = (96, 64)
ALONG = LineString([(-200, 50), (300, 50)])
ZIGZAG = [LineString([(12, 20), (40, 75), (52, 24), (85, 80)]), LineString([(15, 85), (88, 60), (20, 55)])]
BENDS = LineString([(10, 30), (35, 70), (40, 30), (60, 30), (62, 75), (90, 50)])


def on_black(scene: dg.Scene) -> dg.Scene:
    scene.relief = dg.Relief(color="black", strength=0.0)
    return scene


def tilted(degrees: float) -> dg.Scene:
    """A plane that rises to the north at an angle, 100 m x 100 m on the map."""
    rows = np.linspace(100.0, 0.0, 41)
    heights = np.repeat(np.tan(np.radians(degrees)) * rows[:, None], 41, axis=1)
    return on_black(dg.Scene(dg.Terrain(heights.astype(np.float32), 0.0, 100.0, 2.5, 2.5)))


def coverage_of(
    scene: dg.Scene, camera: dg.Camera, size: tuple[int, int] = SMALL, **options: Any
) -> NDArray[np.float64]:
    """Of red lines on black ground, (height, width)."""
    options = {"antialias": "coverage", "background": "black", "terrain_error": 0.0, **options}
    return scene.render(camera, size, **options).image[..., 0] / 255.0


@pytest.mark.parametrize("degrees", [0.0, 45.0, 70.0, 80.0])
@pytest.mark.parametrize("view", ["above", "oblique"])
def test_widths_are_right_to_a_tenth_of_a_pixel_on_slopes(degrees: float, view: str) -> None:
    scene = tilted(degrees)
    middle = 50.0 * np.tan(np.radians(degrees))
    camera = dg.Camera.top_down(BOUNDS)
    if view == "oblique":
        camera = dg.Camera.look_at((50.0, 45.0, middle + 120.0), (50.0, 50.0, middle), fov=20)
    scene.add_lines([ALONG], width=7.3, color="#ff0000")
    covered = coverage_of(scene, camera)
    columns = covered[:, 30:66].sum(axis=0)
    assert np.abs(columns - 7.3).max() <= 0.1


@pytest.mark.parametrize("camera", [MAP, OBLIQUE], ids=["above", "tilted"])
def test_lines_thinner_than_a_pixel_fade_and_do_not_break(camera: dg.Camera) -> None:
    columns = []
    for width in (0.4, 4.0):
        scene = on_black(flat_scene())
        scene.add_lines([LineString([(-100, 40), (200, 63)])], width=width, color="#ff0000")
        columns.append(coverage_of(scene, camera)[:, 24:72].sum(axis=0))
    thin, wide = columns
    assert np.isclose(thin.sum(), wide.sum() / 10.0, rtol=0.05)
    assert thin.min() > 0.75 * wide.min() / 10.0


def test_the_width_is_the_same_at_every_zoom() -> None:
    scene = on_black(flat_scene())
    scene.add_lines([LineString([(0, 50), (100, 50)])], width=5, color="#ff0000")
    for side in (100.0, 10.0, 0.1):
        camera = dg.Camera.top_down((50 - side / 2, 50 - side / 2, 50 + side / 2, 50 + side / 2))
        assert np.allclose(coverage_of(scene, camera, (64, 64))[:, 32].sum(), 5.0, atol=0.05)


STYLES: list[dict[str, Any]] = [
    {"width": 1},
    {"width": 6, "alpha": 0.5},
    {"width": 6, "corner": "miter", "cap": "butt"},
    {"width": 6, "corner": "bevel", "cap": "square"},
    {"width": 3, "casing": dg.Casing(width=1.5, color="blue")},
    {"width": [4, 8], "color": ["red", "lime"]},
    {"width": 4, "width_units": "m", "width_min_px": 2, "width_max_px": 5},
    {"width": 4, "width_units": "m", "width_max_px": 4, "casing": dg.Casing(width=1, color="blue")},
    {"width": 5, "dash": (9, 5)},
    {"width": 5, "dash": "dashed", "cap": "butt", "corner": "miter", "alpha": 0.5},
    {"width": 7, "dash": dg.Pattern.arrows(14, 8, shaft=0.3), "cap": "square", "corner": "bevel"},
    {"width": 4, "dash": dg.Pattern.dashes(7, 4, offset=2, units="m")},
    {"width": 8, "bands": [(0.3, "white"), (0.7, "#00f8"), (1.0, "lime")], "alpha": 0.7, "cap": "square"},
    {"width": 6, "bands": [(0.5, "blue"), (1.0, "red")], "dash": (12, 6)},
]


def judged(
    scene: dg.Scene, style: dict[str, Any], ways: Sequence[str] = ("coverage",), samples: int = 16
) -> list[ref.OverlayComparison]:
    """The colours by ways of anti-aliasing against the reference, without pixels that see two surfaces."""
    scene.add_lines(ZIGZAG, **{"color": "red", **style})
    x0, y0, x1, y1 = 20, 18, 76, 44
    overlay = ref.render_overlay(scene, OBLIQUE, SMALL, (x0, y0, x1, y1), samples)
    found = []
    for way in ways:
        frame = scene.render(OBLIQUE, SMALL, way, terrain_error=0.0, background="black", samples=32)
        image = frame.image[y0:y1, x0:x1, :3] / 255.0
        got = np.concatenate([image, overlay.rgba[..., 3:]], axis=2)
        found.append(ref.compare_overlay(got, overlay, ignore=overlay.mixed))
    return found


@pytest.mark.parametrize(
    "style", [*STYLES[:7], STYLES[8], STYLES[10], STYLES[12]], ids=lambda style: "-".join(style)
)
def test_coverage_is_that_of_the_reference(style: dict[str, Any]) -> None:
    (found,) = judged(on_black(flat_scene()), style)
    assert found.partial > 100
    assert found.rms <= 0.015
    assert found.p99 <= 0.05


@pytest.mark.parametrize("style", [STYLES[0], STYLES[2], STYLES[8]], ids=lambda style: "-".join(style))
def test_coverage_over_facets_of_a_few_pixels(style: dict[str, Any]) -> None:
    # Where there is a bend in a pixel at a border, each sample has the plane of its own facet. With 256 samples a pixel the
    # reference itself errs by 0.006.
    coverage, samples = judged(on_black(hilly_scene()), style, ("coverage", "ssaa"), 32)
    assert coverage.partial > 100
    assert coverage.rms <= 0.015
    assert coverage.p99 <= 0.05
    # Half as many samples, and not chosen for borders.
    assert samples.rms <= 0.03


@pytest.mark.parametrize("style", STYLES, ids=lambda style: "-".join(style))
def test_ids_are_those_of_the_reference(style: dict[str, Any]) -> None:
    scene = hilly_scene()
    scene.add_lines(ZIGZAG, **{"color": "red", **style})
    frame = scene.render(OBLIQUE, SMALL, "none", terrain_error=0.0)
    expected = ref.render_ids(scene, OBLIQUE, SMALL, distances=False)
    found = ref.compare_ids(frame.ids, frame.layers, expected.ids, expected.layers)
    assert found.wrong == 0


@pytest.mark.parametrize("corner", ["round", "miter", "bevel"])
def test_lists_and_bins_agree(corner: str) -> None:
    frames = []
    for method in ("bins", "lists"):
        scene = hilly_scene()
        technique = dg.Dynamic(method=method)
        scene.add_lines([BENDS], width=5, color="red", alpha=0.5, corner=corner, technique=technique)
        frames.append(scene.render(OBLIQUE, SIZE, "none", terrain_error=0.0))
    assert (frames[0].ids == frames[1].ids).all()
    assert (frames[0].image == frames[1].image).all()


def test_auto_takes_dynamic_for_pixels_and_for_limits() -> None:
    scene = flat_scene()
    assert scene.add_lines([BENDS]).technique.name == "dynamic"
    assert scene.add_lines([BENDS], width_units="m").technique.name == "static"
    assert scene.add_lines([BENDS], width_units="m", width_min_px=1).technique.name == "dynamic"


def test_layers_of_both_techniques_lie_in_their_order() -> None:
    scene = flat_scene()
    scene.add_polygons([box(0, 0, 100, 100)], color="#0000ff")
    scene.add_lines([LineString([(0, 50), (100, 50)])], width=10, color="#ff0000")
    scene.add_polygons([box(40, 0, 60, 100)], color="#00ff00")
    scene.add_lines([LineString([(50, 0), (50, 100)])], width=4, color="#ffff00")
    frame = draw(scene)
    seen = [pixel(frame, x, y)[:3] for x, y in ((20, 20), (20, 50), (42, 50), (50, 50))]
    assert seen == [(0, 0, 255), (255, 0, 0), (0, 255, 0), (255, 255, 0)]
    assert frame.layers[50, [20, 42, 50]].tolist() == [1, 2, 3]


def test_lines_hide_behind_the_terrain() -> None:
    scene = hilly_scene()
    scene.add_lines([LineString([(50, 80), (50, 81)])], width=6, color="#ff0000")
    low = dg.Camera.look_at((50.0, -150.0, 12.0), (50.0, 50.0, 5.0), fov=30)
    assert count_color(draw(scene, low), RED) == 0
    assert count_color(draw(scene, MAP), RED) > 30


def test_pick_finds_what_is_seen() -> None:
    scene = hilly_scene()
    scene.add_lines(ZIGZAG, width=6, corner="miter", cap="square", color="red", casing=dg.Casing(width=2))
    frame = draw(scene, OBLIQUE, SMALL)
    places = [(x, y) for x in range(0, SMALL[0], 3) for y in range(0, SMALL[1], 3)]
    found = [frame.pick(x, y) for x, y in places]
    assert [(pick[0].row if pick else -1) for pick in found] == [int(frame.ids[y, x]) for x, y in places]


def test_nothing_is_picked_in_the_sky() -> None:
    scene = hilly_scene()
    scene.add_lines(ZIGZAG, width=6)
    frame = draw(scene, dg.Camera.look_at((50.0, -60.0, 30.0), (50.0, 50.0, 60.0)), SMALL)
    assert np.isinf(frame.depth[0, 0])
    assert frame.pick(0, 0) == []


def test_a_view_moved_by_whole_pixels_is_the_picture_moved() -> None:
    scene = on_black(flat_scene())
    scene.add_lines([BENDS], width=2.5, color="#ff0000", corner="bevel")
    before = coverage_of(scene, dg.Camera.top_down((0, 0, 100, 100)), (128, 128), terrain_error=0.5)
    step = 100.0 / 128.0
    after = coverage_of(
        scene, dg.Camera.top_down((step * 7, 0, 100 + step * 7, 100)), (128, 128), terrain_error=0.5
    )
    assert np.abs(before[:, 7 + 2 : -2] - after[:, 2 : -7 - 2]).max() <= 1.01 / 32.0


def test_rectangles_and_files_give_the_same_bytes(tmp_path: Path) -> None:
    scene = hilly_scene()
    scene.add_lines(ZIGZAG, width=3.5, color="red", alpha=0.7)
    whole = scene.render(OBLIQUE, SMALL)
    assert (scene.render(OBLIQUE, SMALL, tile=37).image == whole.image).all()
    renderer = dg.Renderer(size=SMALL)
    renderer.preprocess(scene)
    renderer.save(tmp_path / "lines.decalgl")
    opened = dg.Renderer(size=SMALL)
    opened.open(tmp_path / "lines.decalgl")
    opened.update(OBLIQUE)
    assert (opened.render().image == whole.image).all()


def test_other_widths_and_colours_without_preparing_anew() -> None:
    scene = flat_scene()
    layer = scene.add_lines([LineString([(0, 50), (100, 50)])], width=4, color="red")
    renderer = dg.Renderer(size=SIZE, antialias="none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    renderer.render()
    renderer.restyle(layer.name, color="#ff0000", width=10)
    renderer.update(MAP)
    assert count_color(renderer.render(), RED) == 10 * 100


def test_nothing_in_view_is_nothing_drawn() -> None:
    scene = flat_scene()
    scene.add_lines([LineString([(5, 5), (6, 6)])], width=2)
    frame = draw(scene, dg.Camera.top_down((50, 50, 100, 100)))
    counts = frame.stats.to_dict()["counts"]
    assert counts["dynamic_tile_entries"] == 0
    assert not any("dynamic_bins" in variant for variant in frame.stats.to_dict()["variants"])


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"technique": "static"}, dg.UnsupportedError, "on the screen.*width_units='m'"),
        ({"slope_correction": "tangent"}, dg.UnsupportedError, "slope_correction=.*on every slope"),
        (
            {"dash": dg.Pattern.dashes(3, units="px"), "width_units": "m"},
            dg.UnsupportedError,
            "pattern in pixels.*width_units='px'",
        ),
        ({"width_min_px": -1}, dg.StyleError, "width_min_px"),
        ({"width_min_px": 3, "width_max_px": 2}, dg.StyleError, "above width_max_px"),
    ],
)
def test_what_is_not_drawn_is_refused(options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        flat_scene().add_lines([BENDS], width=2, **options)


def test_lists_refuse_coverage() -> None:
    scene = flat_scene()
    scene.add_lines([BENDS], technique=dg.Dynamic(method="lists"))
    with pytest.raises(dg.UnsupportedError, match="coverage"):
        scene.render(MAP, SIZE, "coverage")


def test_outlines_of_polygons() -> None:
    scene = on_black(flat_scene())
    ring = Polygon([(20, 20), (80, 20), (80, 80), (20, 80)])
    outline = dg.Outline(width=4, color="#ff0000", corner="miter")
    scene.add_polygons([ring], color="none", outline=outline)
    covered = coverage_of(scene, MAP, (100, 100))
    assert np.isclose(covered.sum(), 64.0**2 - 56.0**2, rtol=0.005)


def test_a_view_beside_all_lines_updates_nothing() -> None:
    """Lines around an empty middle: the view into it does no work, and what only reaches into a view is drawn."""
    scene = on_black(flat_scene())
    corners = [(5, 5), (95, 5), (95, 95), (5, 95), (5, 5)]
    scene.add_lines([LineString(ends) for ends in pairwise(corners)], width=6.0, color="#ff0000")
    renderer = dg.Renderer(size=SMALL, antialias="none")
    renderer.preprocess(scene)
    for bounds, is_drawn in (
        ((40, 40, 60, 55), False),
        ((5.2, 40, 35.2, 60), True),
        ((0, 0, 100, 100), True),
    ):
        renderer.update(dg.Camera.top_down(bounds))
        frame = renderer.render()
        assert (frame.stats.counts["dynamic_kept_vertices"] > 0) == is_drawn
        assert ("dynamic: simplify" in {one["name"] for one in frame.stats.passes}) == is_drawn
        assert (frame.image[..., 0] > 0).any() == is_drawn
        assert (frame.ids >= 0).any() == is_drawn
