"""Clipmap textures: near the reference from everywhere, one picture by every solution, and what is left blurred."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, Polygon, box

import decalgl as dg
import judge
import scenes
from decalgl import reference as ref
from decalgl.report import stability
from decalgl.report.extremes import EXTREMES
from scenes import View
from shapes import drawn_by
from small_scenes import MAP, SIZE, draw, flat_scene, pixel, warned

if TYPE_CHECKING:
    from pathlib import Path

SOLUTIONS = ["1", "2", "3a", "3b", "4a", "4b", "4b polar"]
TESSELLATED = ["3a", "4a", "4b", "4b polar"]


def rms(a: Any, b: Any) -> float:
    """Of the colours of two pictures, in 1/255."""
    difference = a.image[..., :3].astype(float) - b.image[..., :3]
    return float(np.sqrt((difference**2).mean()))


def zigzag(technique: dg.Technique, width: float, alpha: float = 1.0) -> dg.Scene:
    scene = flat_scene()
    line = LineString([(10, 10), (90, 30), (15, 45), (85, 70), (50, 72), (20, 90)])
    scene.add_lines(
        [line],
        color="red",
        alpha=alpha,
        width=width,
        width_units="m",
        cap="butt",
        corner="miter",
        technique=technique,
    )
    return scene


# Against the reference


def test_joints_that_leave_gaps_in_wide_lines_warn() -> None:
    scene = zigzag(dg.Clipmap(joints="3a"), 60.0)
    with pytest.warns(dg.DecalWarning, match="Choose joints='3b'"):
        draw(scene)
    draw(zigzag(dg.Clipmap(joints="3a"), 6.0))
    draw(zigzag(dg.Clipmap(), 60.0))


@pytest.mark.parametrize(("name", "value"), [("line width", 100.0), ("sliver", 1e5)])
def test_lines_wider_than_segments_and_long_slivers_are_right(name: str, value: float) -> None:
    """Segments of a thirtieth of the width, at joints whose inner borders do not meet; triangles 500 times the map."""
    (extreme,) = (one for one in EXTREMES if one.name == name)
    assert stability.judged(stability.WAYS["clipmap"], extreme.make(value))["far"] <= stability.MOST_ROUGH


@pytest.mark.parametrize(
    ("name", "bound"),
    [
        ("hills", 3.0),
        ("hills_orthographic", 3.5),
        ("map_from_above", 3.0),
        ("eye_at_one_metre", 4.0),
        ("far_coordinates", 4.0),
    ],
)
def test_pictures_are_near_those_of_static_layers(name: str, bound: float) -> None:
    view = scenes.build(name)
    static = judge.draw(dg.Renderer(), view, "coverage")
    with warned(judge.CLIPMAPS_WARN.get(name)):
        clip = judge.draw(dg.Renderer(), view._replace(scene=drawn_by(view.scene, dg.Clipmap())), "none")
    assert 0.1 < rms(static, clip) <= bound


def test_the_picture_is_near_the_true_one() -> None:
    scene = zigzag(dg.Clipmap(), 4.0)
    scene.relief = judge.WHITE
    camera = dg.Camera.orbit((50.0, 50.0, 0.0), 110.0, 200.0, 35.0)
    frame = scene.render(camera, (160, 90), antialias="none", background="white")
    true = ref.render_overlay(scene, camera, (160, 90), (0, 0, 160, 90), samples=8).rgba
    shown = true[..., :3] + 1.0 - true[..., 3:]
    error = frame.image[..., :3] / 255.0 - shown
    assert np.sqrt((error**2).mean()) <= 0.05


# Solutions


@pytest.mark.parametrize("width", [0.3, 3.0, 14.0])
def test_tessellating_solutions_draw_the_same(width: float) -> None:
    first, *others = [draw(zigzag(dg.Clipmap(solution=each), width)) for each in TESSELLATED]
    for other in others:
        assert rms(first, other) <= 0.5


@pytest.mark.parametrize("solution", SOLUTIONS)
def test_every_solution_draws_lines_of_a_few_texels(solution: Any) -> None:
    plain = draw(zigzag(dg.Static(), 3.0), antialias="coverage")
    clip = draw(zigzag(dg.Clipmap(solution=solution), 3.0))
    assert rms(plain, clip) <= 9.0


# Of a line a fifth of a texel wide: how dark it is, in that of the static one, and how unevenly along it. As triangles
# it is ragged, more so with one sample a texel; a wireframe has a pair of lines in place of one.
THIN = {
    "4b": ({}, (0.95, 1.05), (0.0, 0.12)),
    "2": ({}, (0.9, 1.1), (0.18, 0.3)),
    "2 of one sample": ({"samples": 1}, (0.9, 1.15), (0.45, 0.7)),
    "3b": ({}, (2.0, 3.0), (0.0, 0.12)),
}


@pytest.mark.parametrize("name", list(THIN))
def test_thin_lines_are_as_dark_and_as_even_as_the_solution_allows(name: str) -> None:
    options, dark, uneven = THIN[name]
    darkness = []
    for technique in (dg.Static(), dg.Clipmap(solution=name.split()[0], **options)):  # type: ignore[arg-type]
        scene = flat_scene()
        line = LineString([(5, 10), (95, 41)])
        scene.add_lines([line], color="black", width=0.2, width_units="m", technique=technique)
        image = draw(scene, antialias="none" if isinstance(technique, dg.Clipmap) else "coverage").image
        darkness.append((image[0, 0, 1].astype(float) - image[:, 10:90, 1]).clip(0).sum(axis=0))
    static, thin = darkness
    assert dark[0] < thin.mean() / static.mean() < dark[1]
    assert uneven[0] <= thin.std() / thin.mean() < uneven[1]


@pytest.mark.parametrize("solution", ["2", "4a", "4b", "4b polar"])
def test_without_joints_segments_lie_alone(solution: Any) -> None:
    technique = dg.Clipmap(solution=solution, joints="1")
    alone = flat_scene()
    path = np.array([(10, 10), (90, 30), (15, 45), (85, 70), (50, 72), (20, 90)])
    segments = [LineString(ends) for ends in itertools.pairwise(path)]
    alone.add_lines(segments, color="red", width=9.0, width_units="m", technique=technique)
    joined = draw(zigzag(dg.Clipmap(solution=solution), 9.0))
    apart = draw(zigzag(technique, 9.0))
    assert rms(apart, draw(alone)) <= 0.5
    assert rms(apart, joined) > 5.0


def test_line_primitives_are_clamped() -> None:
    line = LineString([(0, 50), (100, 50)])
    widths = []
    for solution in ("1", "4b"):
        scene = flat_scene()
        scene.add_lines(
            [line],
            color="red",
            width=40,
            width_units="m",
            technique=dg.Clipmap(solution=solution),  # type: ignore[arg-type]
        )
        widths.append(int((draw(scene).image[:, 50, 1] < 128).sum()))
    assert widths[1] == 40
    assert widths[0] <= 12


def test_inner_borders_that_meet_leave_no_overlap() -> None:
    """Of a translucent line, what method 3a draws twice is darker."""
    covered = []
    for joints in ("3a", "3b"):
        frame = draw(zigzag(dg.Clipmap(joints=joints, samples=1), 8.0, alpha=0.5))  # type: ignore[arg-type]
        once = 0.5 * frame.image[0, 0, 1]
        covered.append((frame.image[..., 1] < 0.75 * once).sum())
    assert covered[0] > 20
    assert covered[1] <= 2


def test_wide_angles_are_mitred_and_sharp_ones_bevelled() -> None:
    tip = LineString([(20, 20), (60, 50), (20, 80)])
    reach = []
    for below in (30.0, 120.0):
        scene = flat_scene()
        scene.add_lines(
            [tip], color="red", width=16, width_units="m", technique=dg.Clipmap(bevel_below=below)
        )
        reach.append(int((draw(scene).image[50, :, 1] < 128).nonzero()[0].max()))
    assert reach[0] == pytest.approx(60 + 8 / np.sin(np.arctan2(30, 40)), abs=1.5)
    assert reach[1] == pytest.approx(60 + 8 * np.sin(np.arctan2(30, 40)), abs=2.5)


# Other looks, without preparing anew


def drawn_after(change: dict[str, Any], scene: dg.Scene, size: tuple[int, int] = SIZE) -> dg.Frame:
    """After a restyle, and a picture from before it."""
    renderer = dg.Renderer(size=size, antialias="none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    renderer.render()
    renderer.restyle(0, **change)
    renderer.update(MAP)
    return renderer.render()


@pytest.mark.parametrize("joints", ["3a", "3b"])
@pytest.mark.parametrize("solution", SOLUTIONS)
def test_another_width_is_as_prepared_anew(solution: Any, joints: Any) -> None:
    technique = dg.Clipmap(solution=solution, joints=joints)
    # Where the line is as wide as this, inner borders meet beyond its segments.
    for before, after in ((3.0, 14.0), (14.0, 0.3)):
        wide = drawn_after({"width": after}, zigzag(technique, before))
        np.testing.assert_array_equal(wide.image, draw(zigzag(technique, after)).image)


def test_colors_order_and_what_is_visible_change() -> None:
    boxes = [box(10, 10, 60, 60), box(40, 40, 90, 90)]
    pictures = []
    for looks in ({"color": ["red", "blue"]}, {"color": ["lime", "cyan"], "order": [2, 1]}):
        scene = flat_scene()
        scene.add_polygons(boxes, technique=dg.Clipmap(), **looks)
        pictures.append(scene)
    changed = drawn_after({"color": ["lime", "cyan"], "order": [2, 1]}, pictures[0])
    np.testing.assert_array_equal(changed.image, draw(pictures[1]).image)
    hidden = drawn_after({"visible": [True, False]}, pictures[0])
    assert pixel(hidden, 50, 50) == (255, 0, 0, 255)
    assert pixel(hidden, 80, 80) == pixel(hidden, 5, 95)


def test_the_lens_shows_other_widths() -> None:
    renderer = dg.Renderer(size=SIZE, antialias="none")
    renderer.preprocess(zigzag(dg.Clipmap(), 2.0))
    renderer.update(MAP)
    renderer.lens = dg.Lens(circle=(50.0, 50.0, 20.0), styles={0: {"width": 12.0}})
    frame = renderer.render()
    from_centre = np.hypot(*(np.mgrid[:100, :100] - 49.5))
    for width, is_here in ((12.0, from_centre < 19.0), (2.0, from_centre > 21.0)):
        alone = draw(zigzag(dg.Clipmap(), width))
        assert np.abs(frame.image[is_here].astype(int) - alone.image[is_here]).max() <= 1


@pytest.mark.parametrize("solution", ["2", "4b"])
def test_widths_grow_with_the_distance(solution: Any) -> None:
    """Between near and far, lines are as wide on the screen from wherever one looks."""
    technique = dg.Clipmap(solution=solution, widen=(100.0, 400.0))
    widths = {}
    for height in (50.0, 100.0, 200.0, 400.0, 800.0):
        scene = dg.Scene(dg.Terrain.flat((-1000.0, -1000.0, 1000.0, 1000.0)))
        line = LineString([(-1000, 3), (1000, 40)])
        scene.add_lines([line], color="red", width=10.0, width_units="m", technique=technique)
        scene.relief = judge.WHITE
        camera = dg.Camera.look_at((0.0, 0.0, height), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), fov=60.0)
        covered = 1.0 - scene.render(camera, (200, 200), antialias="none").image[:, 100, 1] / 255.0
        widths[height] = covered.sum() * 2.0 * height * np.tan(np.radians(30.0)) / 200.0
    expected = [10.0, 10.0, 20.0, 40.0, 40.0]
    assert list(widths.values()) == pytest.approx(expected, rel=0.05)


def test_polygons_far_beyond_the_texture_stay_straight() -> None:
    """A border that leads 10,000 times as far as the map is wide."""
    pictures = []
    for technique in (dg.Static(), dg.Clipmap()):
        scene = flat_scene()
        triangle = Polygon([(-1e6, -2e5), (1e6, 2.0001e5), (-1e6, 1e6)])
        scene.add_polygons([triangle], color="red", technique=technique)
        pictures.append(draw(scene, antialias="none"))
    assert 0.2 < (pictures[0].image[..., 1] < 128).mean() < 0.95
    assert rms(*pictures) < 14.0
    apart = (pictures[0].image[..., 1] < 128) != (pictures[1].image[..., 1] < 128)
    assert apart.sum() <= 100


# Layers, levels and windows


def test_layers_lie_over_each_other_in_order() -> None:
    scene = flat_scene()
    looks: dict[str, Any] = {"technique": dg.Clipmap()}
    scene.add_polygons([box(10, 10, 60, 60)], color="blue", **looks)
    scene.add_lines([LineString([(0, 30), (100, 30)])], color="red", width=10, width_units="m", **looks)
    scene.add_polygons([box(40, 20, 80, 80)], color="lime", alpha=0.5, **looks)
    frame = draw(scene)
    assert pixel(frame, 20, 50) == (0, 0, 255, 255)
    assert pixel(frame, 20, 30) == (255, 0, 0, 255)
    mixed = np.array(pixel(frame, 50, 30))
    assert np.abs(mixed - (127, 128, 0, 255)).max() <= 2


def test_thin_lines_keep_their_coverage() -> None:
    scene = zigzag(dg.Clipmap(), 0.1)
    static = draw(zigzag(dg.Static(), 0.1), antialias="coverage")
    frame = draw(scene)
    ground = frame.image[0, 0].astype(float)
    darker = [(ground - each.image).clip(0)[..., 1].sum() for each in (static, frame)]
    assert darker[1] == pytest.approx(darker[0], rel=0.25)


def test_pictures_do_not_depend_on_earlier_views() -> None:
    view = scenes.build("hills")
    view = View(drawn_by(view.scene, dg.Clipmap()), view.camera, view.size)
    fresh = judge.draw(dg.Renderer(), view)
    used = dg.Renderer(size=view.size, antialias="none")
    used.preprocess(view.scene)
    for azimuth in (20.0, 90.0, 140.0):
        used.update(dg.Camera.orbit((0.0, 0.0, 0.0), 700.0, azimuth, 30.0))
        used.render()
    used.update(view.camera)
    np.testing.assert_array_equal(used.render().image, fresh.image)


def test_a_small_window_and_a_budget_leave_blur() -> None:
    view = scenes.build("hills")
    static = judge.draw(dg.Renderer(), view, "coverage")
    errors = [
        rms(static, judge.draw(dg.Renderer(), view._replace(scene=drawn_by(view.scene, technique))))
        for technique in (dg.Clipmap(), dg.Clipmap(window=512), dg.Clipmap(tiles_a_frame=2))
    ]
    assert errors[0] < errors[1] < errors[2]


def test_more_samples_along_a_pixel_are_sharper_at_a_slant() -> None:
    view = scenes.build("grazing_plain")
    static = judge.draw(dg.Renderer(), view, "coverage")
    errors = []
    for most in (1, 16):
        clipmaps = view._replace(scene=drawn_by(view.scene, dg.Clipmap(anisotropy=most)))
        with warned(judge.CLIPMAPS_WARN["grazing_plain"]):
            errors.append(rms(static, judge.draw(dg.Renderer(), clipmaps)))
    assert errors[1] < 0.8 * errors[0]


@pytest.mark.parametrize("antialias", ["coverage", "ssaa", "fxaa"])
def test_other_ways_of_anti_aliasing(antialias: str) -> None:
    view = scenes.build("hills")._replace(size=(320, 180))
    static = judge.draw(dg.Renderer(), view, antialias)
    clip = judge.draw(dg.Renderer(), view._replace(scene=drawn_by(view.scene, dg.Clipmap())), antialias)
    assert rms(static, clip) <= 9.0


# Errors


def test_ids_and_picking_are_refused() -> None:
    frame = draw(zigzag(dg.Clipmap(), 4.0))
    with pytest.raises(dg.UnsupportedError, match="no ids"):
        _ = frame.ids
    with pytest.raises(dg.UnsupportedError, match="picked"):
        frame.pick(50, 50)


def test_styles_that_tiles_cannot_show_are_refused() -> None:
    scene = flat_scene()
    scene.add_lines(
        [LineString([(0, 0), (90, 90)])],
        width=4,
        width_units="m",
        dash=(4, 4),
        name="way",
        technique=dg.Clipmap(),
    )
    with pytest.raises(dg.UnsupportedError, match=r"'way'.*patterns"):
        scene.render(MAP, SIZE)


@pytest.mark.parametrize(
    "options", [{"solution": "5"}, {"joints": "2"}, {"window": 100}, {"samples": 3}, {"anisotropy": 2.5}]
)
def test_options_out_of_range(options: dict[str, Any]) -> None:
    with pytest.raises(dg.StyleError, match="Clipmap"):
        dg.Clipmap(**options)


def test_saving_and_editing_are_refused(tmp_path: Path) -> None:
    renderer = dg.Renderer(size=SIZE, antialias="none")
    renderer.preprocess(zigzag(dg.Clipmap(), 4.0))
    with pytest.raises(
        dg.UnsupportedError, match="is not kept on disk; draw the layer with technique 'static'"
    ):
        renderer.save(tmp_path / "map.decalgl")
    with pytest.raises(dg.UnsupportedError, match="cannot edit what it prepared"):
        renderer.edit(0, remove=[0])
