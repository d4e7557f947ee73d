"""Networks by distance fields: levels of detail, what runs along lines, their ends, and the artefacts of the paper."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from shapely import LineString

import decalgl as dg
from small_networks import (
    EXACT,
    NEAR_AND_FAR,
    RED,
    WHITE,
    network,
    one_line,
    width_at,
)
from small_scenes import draw, flat_scene, pixel

# Levels of detail


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
