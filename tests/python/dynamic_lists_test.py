"""Dynamic lines by lists: the thesis's widths and what is refused; and the update of a view, which bins share."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from shapely import LineString

import decalgl as dg
from decalgl import Dynamic
from small_scenes import MAP, OBLIQUE, SIZE, flat_scene, hilly_scene

LINES = [
    LineString([(10, 30), (35, 70), (40, 30), (60, 30), (62, 75), (90, 50)]),
    LineString([(5, 60), (50, 52), (95, 64)]),
    LineString([(20, 15), (80, 85)]),
]
COLORS = ["crimson", "royalblue", "gold"]


def listed(scene: dg.Scene, **options: Any) -> dg.Scene:
    """The scene with lines that lists draw."""
    technique = Dynamic(
        method=options.pop("method", "lists"),
        width_rule=options.pop("width_rule", "screen"),
        cell=options.pop("cell", 0.125),
    )
    scene.add_lines(LINES, **{"color": COLORS, "width": 5.0, "technique": technique, **options})
    return scene


def counts_of(frame: dg.Frame) -> dict[str, float]:
    return frame.stats.to_dict()["counts"]


@pytest.mark.parametrize("camera", [MAP, OBLIQUE, dg.Camera.look_at((50, -20, 30), (50, 60, 0), fov=70)])
@pytest.mark.parametrize("size", [SIZE, (60, 90)])
def test_the_thesis_widens_lines_with_the_distance_from_the_eye(
    camera: dg.Camera, size: tuple[int, int]
) -> None:
    width = 7.0
    frame = listed(flat_scene(), width=width, width_rule="thesis").render(
        camera, size, "none", terrain_error=0.0
    )
    world = frame.world
    seen = np.isfinite(world[..., 0])
    if camera.fov is None:
        metres = np.full(size[::-1], 100.0 / min(size))  # of the map's shorter side
    else:
        distance = np.linalg.norm(world - np.asarray(camera.eye), axis=2)
        # Equation 4.2, with half of the picture's shorter side for one.
        least = np.tan(np.radians(camera.fov) / 2) * min(1.0, size[0] / size[1])  # of half the smaller angle
        metres = distance * least / (min(size) / 2)
    apart = (
        shapely.distance(
            shapely.points(np.nan_to_num(world[..., 0]), np.nan_to_num(world[..., 1]))[..., None],
            np.array(LINES),
        )
        / metres[..., None]
    )
    certain = (np.abs(apart - width / 2) > 0.01).all(axis=2) & seen
    covered = apart <= width / 2
    topmost = np.where(covered.any(axis=2), 2 - np.argmax(covered[..., ::-1], axis=2), -1)
    assert certain.sum() > 0.8 * seen.sum()
    assert (topmost >= 0).sum() > 100
    assert (frame.ids[certain] == topmost[certain]).all()


def test_coverage_is_refused_with_what_to_do_instead() -> None:
    with pytest.raises(dg.UnsupportedError, match=r"bins.*'screen'"):
        listed(flat_scene(), method="auto", width_rule="thesis").render(MAP, SIZE, "coverage")
    with pytest.raises(dg.UnsupportedError, match="fxaa"):
        listed(flat_scene()).render(MAP, SIZE, "coverage")


@pytest.mark.parametrize("antialias", ["fxaa", "ssaa", "msaa"])
def test_other_ways_of_anti_aliasing_are_those_of_bins(antialias: str) -> None:
    images = [
        listed(hilly_scene(), method=method, alpha=0.6).render(OBLIQUE, SIZE, antialias).image
        for method in ("bins", "lists")
    ]
    assert (images[0] == images[1]).all()


def test_rectangles_and_earlier_views_leave_the_picture_alone() -> None:
    scene = listed(hilly_scene(), alpha=0.6, corner="miter")
    whole = scene.render(OBLIQUE, SIZE, "none").image
    renderer = dg.Renderer(size=SIZE, antialias="none", tile=37)
    renderer.preprocess(scene)
    for camera in (MAP, OBLIQUE):
        renderer.update(camera)
        image = renderer.render().image
    assert np.abs(whole.astype(int) - image).max() <= 1


def test_lists_lie_over_what_is_below() -> None:
    scene = flat_scene()
    scene.add_polygons([shapely.box(0, 0, 100, 50)], color="#0000ff")
    scene.add_lines([LINES[2]], color="#ff0000", alpha=0.5, width=8.0, technique=Dynamic(method="lists"))
    frame = scene.render(MAP, SIZE, "none", background="black")
    below = frame.image[52:][frame.layers[52:] == 1]
    assert len(below) > 50
    # Half of red and half of blue.
    assert np.abs(below[:, [0, 2]].astype(int) - 128).max() <= 1


def test_a_budget_that_lists_pass_is_an_error_and_no_crash() -> None:
    scene = listed(flat_scene(), width=60.0)
    plenty = dg.Renderer(size=(400, 400), antialias="none")
    plenty.preprocess(scene)
    plenty.update(MAP)
    used = plenty.render().stats.bytes
    assert used["dynamic"] > 3_000_000
    renderer = dg.Renderer(size=(400, 400), antialias="none", memory_limit=sum(used.values()) - 500_000)
    renderer.preprocess(scene)
    renderer.update(MAP)
    with pytest.raises(MemoryError, match="Dynamic: lists"):
        renderer.render()


def wavy_line(vertices: int) -> LineString:
    along = np.linspace(5.0, 95.0, vertices)
    return LineString(np.column_stack([along, 50.0 + 20.0 * np.sin(along / 7.0)]))


@pytest.mark.parametrize("method", ["bins", "lists"])
def test_simplification_saves_segments_and_cannot_be_seen(method: str) -> None:
    frames = []
    for cell in (0.0, 0.125, 4.0):
        scene = flat_scene()
        scene.add_lines([wavy_line(20_000)], width=5.0, technique=Dynamic(method=method, cell=cell))
        frames.append(scene.render(MAP, SIZE, "none"))
    kept = [counts_of(frame)["dynamic_segments"] for frame in frames]
    assert kept[0] == counts_of(frames[0])["dynamic_vertices"] - 1
    assert kept[1] < 0.2 * kept[0]
    assert kept[2] < 0.1 * kept[1]
    lines = [frame.ids >= 0 for frame in frames]
    # Half a pixel of the border may change its side where a line moves by a share of an eighth of a pixel.
    assert (lines[0] != lines[1]).sum() < 0.05 * lines[0].sum()
    assert (lines[0] != lines[2]).sum() > (lines[0] != lines[1]).sum()


def test_a_view_without_lines_draws_none() -> None:
    scene = flat_scene()
    scene.add_lines([LineString([(5, 90), (20, 95)])], width=3.0)
    frame = scene.render(dg.Camera.top_down((50, 10, 90, 40)), SIZE, "coverage")
    counts = counts_of(frame)
    assert counts["dynamic_segments"] == 0
    assert counts["dynamic_tile_entries"] == 0
    assert (frame.ids == -1).all()


def test_each_step_of_the_update_is_timed() -> None:
    frame = listed(hilly_scene()).render(OBLIQUE, SIZE, "none")
    ran = {one["name"] for one in frame.stats.to_dict()["passes"]}
    steps = {"simplify", "compact vertices", "cull", "compact segments", "lists", "sort"}
    assert {f"dynamic: {step}" for step in steps} <= ran
    one = listed(hilly_scene(), color="red").render(OBLIQUE, SIZE, "none")
    # One opaque look needs no order.
    assert "dynamic: sort" not in {each["name"] for each in one.stats.to_dict()["passes"]}
