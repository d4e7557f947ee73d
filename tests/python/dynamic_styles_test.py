"""Dynamic lines: patterns that do not crawl, outlines on one side, and what lies behind ridges; by both methods."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
import shapely
from shapely import LineString, Polygon, box

import decalgl as dg
from decalgl import reference as ref
from small_scenes import OBLIQUE, SIZE, flat_scene, hilly_scene

Array = np.ndarray[Any, np.dtype[np.float64]]
Mask = np.ndarray[Any, np.dtype[np.bool_]]

SMALL = (96, 64)
ACROSS = LineString([(-50, 50), (150, 50)])
BLOCK = Polygon(
    [(15, 20), (85, 15), (60, 45), (88, 85), (20, 80)],
    [[(35, 35), (50, 35), (42, 60)], [(50, 70), (60, 60), (64, 72)]],
)


def on_black(scene: dg.Scene) -> dg.Scene:
    scene.relief = dg.Relief(color="black", strength=0.0)
    return scene


def row_of(scene: dg.Scene, side: float) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Which pixels the line covers in a view of a square from above, along the middle."""
    camera = dg.Camera.top_down((50 - side / 2, 50 - side / 2, 50 + side / 2, 50 + side / 2))
    return scene.render(camera, (256, 16), "none", terrain_error=0.0).ids[8] >= 0


@pytest.mark.parametrize("side", [20.0, 7.1, 2.0, 0.011])
def test_dashes_are_as_long_as_asked_to_within_a_factor_of_the_root_of_two(side: float) -> None:
    scene = flat_scene()
    scene.add_lines([ACROSS], width=4, cap="butt", dash=(12, 8))
    covered = row_of(scene, side)
    begins = np.flatnonzero(covered[1:] & ~covered[:-1])
    period = np.diff(begins).mean()
    assert 20 / np.sqrt(2) - 1 <= period <= 20 * np.sqrt(2) + 1
    assert np.isclose(covered[begins[0] : begins[-1]].mean(), 0.6, atol=0.08)


@pytest.mark.parametrize("dash", [(12, 8), dg.Pattern.arrows(16, 8, shaft=0.25)])
def test_dashes_stay_where_they_are_when_the_view_moves(dash: Any) -> None:
    scene = on_black(flat_scene())
    scene.add_lines([LineString([(5, 20), (60, 80), (95, 30)])], width=5, color="#ff0000", dash=dash)
    step = 100.0 / 128.0
    images = [
        scene.render(
            dg.Camera.top_down((shift, 0, 100 + shift, 100)), (128, 128), "coverage", terrain_error=0.0
        ).image[..., 0]
        for shift in (0.0, 9 * step)
    ]
    assert np.abs(images[0][:, 11:-2].astype(int) - images[1][:, 2:-11]).max() <= 8


@pytest.mark.parametrize("mode", ["inset", "offset"])
@pytest.mark.parametrize("corner", ["round", "miter"])
def test_outlines_on_one_side_are_those_of_the_reference(mode: Any, corner: str) -> None:
    outline = dg.Outline(width=5, color="red", mode=mode, corner=corner)
    scene = on_black(hilly_scene())
    scene.add_polygons([BLOCK], color="none", outline=outline)
    frame = scene.render(OBLIQUE, SMALL, "none", terrain_error=0.0)
    expected = ref.render_ids(scene, OBLIQUE, SMALL, distances=False)
    assert (expected.ids >= 0).sum() > 300
    assert (frame.ids != expected.ids).sum() == 0
    if corner == "miter":
        return
    overlay = ref.render_overlay(scene, OBLIQUE, SMALL, samples=16)
    image = scene.render(OBLIQUE, SMALL, "coverage", terrain_error=0.0, background="black").image / 255.0
    got = np.concatenate([image[..., :3], overlay.rgba[..., 3:]], axis=2)
    assert ref.compare_overlay(got, overlay, ignore=overlay.mixed).rms <= 0.015


def test_an_inset_outline_lies_inside_and_an_offset_one_outside() -> None:
    for mode, least, most in (("inset", 40.0**2 - 32.0**2, 0.0), ("offset", 0.0, 48.0**2 - 40.0**2)):
        scene = on_black(flat_scene())
        outline = dg.Outline(width=4, color="#ff0000", mode=mode, corner="miter")  # type: ignore[arg-type]
        scene.add_polygons([box(30, 30, 70, 70)], color="none", outline=outline)
        camera = dg.Camera.top_down((0, 0, 100, 100))
        covered = scene.render(camera, SIZE, "coverage", terrain_error=0.0).image[..., 0] / 255.0
        inside = covered[30:70, 30:70].sum()
        assert np.isclose(inside, least, atol=2.0)
        assert np.isclose(covered.sum() - inside, most, atol=2.0)


@pytest.mark.parametrize("corner", ["round", "miter"])
def test_lists_draw_outlines_on_one_side_as_bins_do(corner: Any) -> None:
    # Over each other and translucent, with bands, and beside lines that have no sides.
    banded = [(0.5, "white"), (1.0, "blue")]
    outlines = [
        dg.Outline(width=7, color="red", mode="inset", corner=corner, alpha=0.6),
        dg.Outline(width=6, color="lime", mode="offset", corner=corner, bands=banded),
    ]
    frames = []
    for method in ("bins", "lists"):
        scene = hilly_scene()
        technique = dg.Dynamic(method=method)  # type: ignore[arg-type]
        scene.add_lines([ACROSS], width=9, color="black", technique=technique)
        for outline in outlines:
            scene.add_polygons([BLOCK], color="none", outline=outline, technique=technique)
        frames.append(scene.render(OBLIQUE, SMALL, "none", terrain_error=0.0))
    assert all((frames[0].layers == layer).sum() > 50 for layer in range(3))
    assert (frames[0].layers == frames[1].layers).all()
    assert (frames[0].image == frames[1].image).all()


def test_the_thesis_keeps_one_side_of_outlines_too() -> None:
    for mode, inside in (("inset", True), ("offset", False)):
        scene = flat_scene()
        technique = dg.Dynamic(method="lists", width_rule="thesis")
        outline = dg.Outline(width=6, color="red", mode=mode)  # type: ignore[arg-type]
        scene.add_polygons([BLOCK], color="none", outline=outline, technique=technique)
        frame = scene.render(dg.Camera.top_down((0, 0, 100, 100)), SIZE, "none")
        places = shapely.points(frame.world[..., 0], frame.world[..., 1])
        # Of a stroke that is cut, half is the whole width.
        near = shapely.distance(places, BLOCK.boundary)
        expected = (near <= 6.0) & (shapely.contains(BLOCK, places) == inside)
        certain = (np.abs(near - 6.0) > 0.02) & (near > 0.02)
        assert (expected & certain).sum() > 500
        assert ((frame.ids >= 0) == expected)[certain].all()


def ridges() -> dg.Scene:
    """Steep ridges across the view, with valleys of 40 m between them."""
    y = np.linspace(0.0, 1.0, 41)
    heights = 12.0 * np.abs(np.sin(5.0 * np.pi * y))[:, None] + 2.0 * np.sin(7.0 * y)[None, :]
    return dg.Scene(dg.Terrain(heights.astype(np.float32), 0.0, 200.0, 5.0, 5.0))


@pytest.mark.parametrize("height", [13.0, 15.0, 25.0])
def test_lines_behind_a_ridge_are_seen_by_no_method(height: float, monkeypatch: pytest.MonkeyPatch) -> None:
    # A plane that is seen edge-on goes on over the ridge, above what lies behind.
    lines = [LineString([(0, y), (200, y + 3)]) for y in range(4, 196, 6)]
    camera = dg.Camera.look_at((100.0, -30.0, height), (100.0, 120.0, 6.0), fov=40)
    found = []
    for method in ("bins", "lists"):
        scene = ridges()
        technique = dg.Dynamic(method=method, cell=0.0)  # type: ignore[arg-type]
        scene.add_lines(lines, width=6, color="red", technique=technique)
        found.append(scene.render(camera, SMALL, "none", terrain_error=0.0).ids)
    expected = ref.render_ids(scene, camera, SMALL, distances=False).ids
    assert (expected >= 0).sum() > 1500
    assert (found[0] != found[1]).sum() == 0
    # Where the ground lies right at the limit, float32 may decide otherwise.
    assert (found[0] != expected).sum() <= 2
    monkeypatch.setattr(ref.screen, "GROUND_SLACK", 1e9)
    assert (found[0] != ref.render_ids(scene, camera, SMALL, distances=False).ids).sum() > 20


def test_wide_lines_in_thousands_of_tiles_are_whole() -> None:
    # A run of segments has more tiles to tell than a software driver takes turns in one shader run.
    lines = [LineString([(-20, y), (120, y + 40)]) for y in np.linspace(-40, 100, 120)]
    pictures = []
    for methods in ("bins", "lists"):
        scene = flat_scene()
        technique = dg.Dynamic(method=methods)  # type: ignore[arg-type]
        scene.add_lines(lines[:1], width=1.0, color="red", technique=technique)
        scene.add_lines(lines, width=90.0, color="blue", technique=technique)
        camera = dg.Camera.top_down((0, 0, 100, 100))
        pictures.append(scene.render(camera, (200, 200), "none", terrain_error=0.0).ids)
    assert (pictures[0] == pictures[1]).all()


def stroke_with_flat_ends(places: Array, line: LineString, half_width: float, longer: float) -> Mask:
    """Which places a stroke with round corners covers; its ends are so much longer."""
    points = np.asarray(line.coords)
    covered = np.zeros(places.shape[:-1], np.bool_)
    for i, (a, b) in enumerate(itertools.pairwise(points)):
        way = (b - a) / np.linalg.norm(b - a)
        along, across = (places - a) @ way, np.abs((places - a) @ np.array([-way[1], way[0]]))
        begin = -longer if i == 0 else 0.0
        end = np.linalg.norm(b - a) + (longer if i == len(points) - 2 else 0.0)
        covered |= (along >= begin) & (along <= end) & (across <= half_width)
    for corner in points[1:-1]:
        covered |= np.linalg.norm(places - corner, axis=-1) <= half_width
    return covered


@pytest.mark.parametrize("technique", [dg.Dynamic(), dg.Dynamic(method="lists")], ids=["tiles", "lists"])
@pytest.mark.parametrize(
    "points", [[(20, 20), (60, 30)], [(21, 70), (58, 31), (61, 27)]], ids=["straight", "bent"]
)
def test_flat_ends_are_flat_wherever_the_ground_cuts_a_line(technique: dg.Dynamic, points: Any) -> None:
    """Ground with samples a metre apart, under a line ten metres wide."""
    scene = dg.Scene(dg.Terrain(np.zeros((101, 101), np.float32), 0.0, 100.0, 1.0, 1.0))
    line = LineString(points)
    scene.add_lines([line], technique=technique, width=16, corner="round", cap="butt")
    frame = scene.render(dg.Camera.top_down((0, 0, 100, 100)), (160, 160), "none", terrain_error=0.0)
    places = frame.world[..., :2]
    # A tenth of a pixel may be off.
    least, most = (stroke_with_flat_ends(places, line, 5.0 + by, by) for by in (-0.0625, 0.0625))
    assert (frame.ids >= 0)[least].all()
    assert not (frame.ids >= 0)[~most].any()
    for x, y in itertools.product(range(80, 110, 2), repeat=2):
        assert bool(frame.pick(x, y)) == (frame.ids[y, x] >= 0) or most[y, x] != least[y, x]
