"""Nothing needless: a scene pays for what it shows in this view, and not for what it might have shown.

Passes, program variants, GL objects and uploads are counted, so the tests hold on any machine.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, box

import decalgl as dg
from decalgl.report.needless import VIEW_PASSES
from small_scenes import MAP, OBLIQUE, SIZE, draw, hilly_scene

if TYPE_CHECKING:
    from collections.abc import Sequence

SQUARES = [box(10, 10, 40, 40), box(50, 50, 90, 90)]
WAYS = [LineString([(5, 50), (50, 20), (95, 60)]), LineString([(20, 5), (30, 95)])]
SKY = dg.Camera.look_at((50, 50, 60), (50, 90, 140))
GROUND_PASSES = ["terrain", "compose", "readback"]
# What a view takes whatever the scene holds: its uniform block, and which level of detail each tile has.
MOST_VIEW_UPLOADS, MOST_VIEW_BYTES = 8, 4096


@dataclass(frozen=True)
class Way:
    """A technique and how it is asked for.

    names: of its passes, programs and GL objects. restyles: without new buffers. view_bytes: uploaded for a view.
    """

    technique: dg.Technique
    names: Sequence[str]
    polygons: bool = True
    pixels: bool = False
    options: dict[str, Any] = field(default_factory=dict)
    restyles: bool = True
    view_bytes: int = MOST_VIEW_BYTES


TECHNIQUES = {
    "static": Way(dg.Static(), ["static"]),
    "bvh": Way(dg.Static(), ["static_bvh"], options={"index": dg.BvhIndex(cells=8)}),
    "bins": Way(dg.Dynamic(method="bins"), ["dynamic"], polygons=False, pixels=True),
    "lists": Way(dg.Dynamic(method="lists"), ["dynamic"], polygons=False, pixels=True),
    # Cells of what is active in the view.
    "loops": Way(dg.Loops(), ["loops"], view_bytes=65536),
    "volume": Way(dg.Volume(), ["volume"]),
    "clipmap": Way(dg.Clipmap(), ["clipmap"]),
    "distance_field": Way(dg.DistanceField(), ["distance_field", "fields", "stylize"], polygons=False),
}
EACH = pytest.mark.parametrize("name", TECHNIQUES)
EACH_KIND = pytest.mark.parametrize(
    ("name", "kind"),
    [
        (name, kind)
        for name, way in TECHNIQUES.items()
        for kind in ("lines", "polygons")
        if way.polygons or kind == "lines"
    ],
)


def add_lines(scene: dg.Scene, way: Way, **looks: Any) -> dg.Layer:
    keywords = {"color": "red", "width": 4, "width_units": "px" if way.pixels else "m", **looks}
    return scene.add_lines(keywords.pop("data", WAYS), technique=way.technique, **keywords)


def add_polygons(scene: dg.Scene, way: Way, **looks: Any) -> dg.Layer:
    return scene.add_polygons(SQUARES, technique=way.technique, **{"color": "red", **looks})


def scene_of(name: str, kind: str = "lines", **looks: Any) -> dg.Scene:
    """Lines or polygons of a technique over a hill."""
    scene = hilly_scene()
    add = add_lines if kind == "lines" else add_polygons
    add(scene, TECHNIQUES[name], **looks)
    return scene


def shot(scene: dg.Scene, name: str, camera: dg.Camera = MAP, **options: Any) -> dg.Frame:
    return draw(scene, camera, **{**TECHNIQUES[name].options, **options})


def passes(frame: dg.Frame) -> list[str]:
    return [one["name"] for one in frame.stats.passes]


def runs(frame: dg.Frame, name: str) -> bool:
    """Whether any pass of the technique ran."""
    names = TECHNIQUES[name].names
    return any(one.split(":")[0].split(" ")[0] in names for one in passes(frame))


def uploads(frame: dg.Frame) -> tuple[int, int]:
    counts = frame.stats.counts
    return int(counts["uploads"]), int(counts["uploaded_bytes"])


def objects(frame: dg.Frame) -> set[str]:
    """GL objects and prepared arrays of techniques, and the overlay."""
    return {name for name in frame.stats.objects if not name.startswith(("terrain", "frame"))} | {
        name for name in frame.stats.objects if name == "frame: overlay"
    }


@EACH_KIND
@pytest.mark.parametrize("antialias", ["none", "coverage", "ssaa"])
def test_an_unchanged_frame_costs_nothing(name: str, kind: str, antialias: str) -> None:
    if antialias == "coverage" and name in ("lists", "volume"):
        pytest.skip("refuses coverage")
    scene = scene_of(name, kind)
    first = shot(scene, name, OBLIQUE, antialias=antialias)
    assert uploads(first)[0] > 0
    again = shot(scene, name, OBLIQUE, antialias=antialias)
    assert passes(again) == []
    assert uploads(again) == (0, 0)
    np.testing.assert_array_equal(again.image, first.image)
    assert again.image.ctypes.data == first.image.ctypes.data, "not even copied"


def test_an_unchanged_frame_by_hand_and_with_another_sky() -> None:
    scene = scene_of("static")
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    first = renderer.render()
    assert passes(renderer.render()) == []
    report = renderer.update(OBLIQUE)
    assert report["pieces"] > 0, "counters are those of the view, not of the work"
    assert passes(renderer.render()) == []
    other = renderer.render(background="black")
    assert set(passes(other)) <= {"static", "compose", "readback"}, "the ground stays"
    back = renderer.render()
    np.testing.assert_array_equal(back.image, first.image)
    renderer.forget()
    renderer.update(OBLIQUE)
    timed = renderer.render()
    assert passes(timed) == ["terrain", "static", "compose", "readback"]
    np.testing.assert_array_equal(timed.image, first.image)


@EACH
def test_frames_and_layers_alone_are_timed_from_their_beginning(name: str) -> None:
    scene = scene_of(name)
    renderer = dg.Renderer(SIZE, antialias="none", **TECHNIQUES[name].options)
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    first = renderer.render()
    for ground in (False, True):
        renderer.forget(ground)
        renderer.update(OBLIQUE)
        again = renderer.render()
        left_out = ("upload",) if ground else ("upload", "terrain")
        assert passes(again) == [one for one in passes(first) if one not in left_out]
        np.testing.assert_array_equal(again.image, first.image)


def test_reading_of_older_frames_leaves_nothing_stale() -> None:
    scene, other = scene_of("static"), scene_of("static", color="blue")
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    first = renderer.render()
    renderer.preprocess(other)
    renderer.update(OBLIQUE)
    second = renderer.render()
    assert (first.ids >= 0).any()  # draws the older scene
    np.testing.assert_array_equal(renderer.render().image, second.image)
    assert (second.image != first.image).any()


def test_a_failed_update_is_not_taken_for_done() -> None:
    scene = scene_of("volume")
    renderer = dg.Renderer(SIZE, antialias="coverage")
    renderer.preprocess(scene)
    for _ in range(2):
        with pytest.raises(dg.UnsupportedError, match="volume"):
            renderer.update(MAP)


@EACH_KIND
def test_another_camera_uploads_nothing_of_the_layers(name: str, kind: str) -> None:
    scene = scene_of(name, kind)
    shot(scene, name)
    shot(scene, name, OBLIQUE)
    moved = shot(scene, name, dg.Camera.look_at((50, -70, 60), (50, 50, 0)))
    assert "upload" not in passes(moved)
    count, size = uploads(moved)
    assert count <= MOST_VIEW_UPLOADS
    assert size <= TECHNIQUES[name].view_bytes


@EACH_KIND
def test_a_hidden_layer_costs_nothing(name: str, kind: str) -> None:
    bare = shot(hilly_scene(), name)
    hidden = shot(scene_of(name, kind, alpha=0.0), name)
    assert not runs(hidden, name)
    assert hidden.stats.variants == bare.stats.variants
    assert uploads(hidden) == uploads(bare)
    held = objects(hidden)
    # Whatever can be restyled is kept ready to be shown, but not on the GPU; distance fields keep their lines.
    assert held <= {f"{TECHNIQUES[name].names[0]}: {part}" for part in ("prepared", "ground", "network")}
    np.testing.assert_array_equal(hidden.image, bare.image)


@EACH_KIND
def test_nothing_in_view_draws_nothing(name: str, kind: str) -> None:
    scene = scene_of(name, kind)
    sky = shot(scene, name, SKY)
    assert not runs(sky, name)
    assert "terrain" not in passes(sky)
    assert "frame: overlay" not in sky.stats.objects
    assert not any("OVERLAY" in variant for variant in sky.stats.variants)
    assert np.isinf(sky.depth).all()
    assert (sky.ids == -1).all() if name != "clipmap" else True


def wide_scene() -> dg.Scene:
    """Four tiles of ground in a row, 256 m long."""
    return dg.Scene(dg.Terrain(np.zeros((65, 257), np.float32), 0.0, 64.0, 1.0, 1.0))


@pytest.mark.parametrize("name", [name for name, way in TECHNIQUES.items() if not way.pixels])
def test_layers_beside_the_view_are_not_drawn(name: str) -> None:
    scene = wide_scene()
    beside = [LineString([(5, 5), (20, 50)])]
    add_lines(scene, TECHNIQUES[name], data=beside, width=30)
    near = dg.Camera.top_down((10, 10, 40, 30))
    far = dg.Camera.top_down((200, 10, 230, 30))
    assert runs(shot(scene, name, near), name)
    away = shot(scene, name, far)
    # Widths of networks are what their styles say, later ones as well.
    if name != "distance_field":
        assert not runs(away, name)
    bare = shot(wide_scene(), name, far)
    np.testing.assert_array_equal(away.image, bare.image)
    back = shot(scene, name, near)
    assert (back.image != shot(wide_scene(), name, near).image).any()


def test_what_reaches_into_the_view_is_drawn() -> None:
    """Widths, miters and edits count: a line's vertices may lie beside all that is seen."""
    camera = dg.Camera.top_down((66, 10, 96, 30))
    wide = wide_scene()
    wide.add_lines([LineString([(20, 5), (20, 60)])], width=110, width_units="m", color="red")
    assert (draw(wide, camera).ids == 0).any()
    sharp = wide_scene()
    spike = LineString([(5, 18), (45, 20), (5, 22)])
    sharp.add_lines([spike], width=4, width_units="m", color="red", corner="miter", miter_limit=1)
    assert (draw(sharp, camera).ids == 0).any()
    edited = wide_scene()
    edited.add_lines([LineString([(5, 5), (20, 50)])], width=3, width_units="m", color="red", name="ways")
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(edited)
    renderer.update(camera)
    assert "static" not in passes(renderer.render())
    renderer.edit("ways", add=[LineString([(70, 12), (90, 28)])])
    assert (renderer.render().ids == 1).any()


def test_a_saved_scene_knows_what_is_in_view(tmp_path: Any) -> None:
    scene = wide_scene()
    scene.add_lines([LineString([(5, 5), (20, 50)])], width=3, width_units="m", color="red")
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(scene)
    renderer.save(tmp_path / "scene")
    renderer.open(tmp_path / "scene")
    for bounds, drawn in (((200, 10, 230, 30), False), ((5, 10, 35, 30), True)):
        renderer.update(dg.Camera.top_down(bounds))
        assert ("static" in passes(renderer.render())) == drawn


@pytest.mark.parametrize("name", [name for name, way in TECHNIQUES.items() if way.restyles])
def test_another_colour_rebuilds_nothing(name: str) -> None:
    x = np.linspace(5.0, 95.0, 400)
    ways = [LineString(np.column_stack([x, 50.0 + 40.0 * np.sin(0.1 * x + i)])) for i in range(10)]
    scene, blue_scene = hilly_scene(), hilly_scene()
    add_lines(scene, TECHNIQUES[name], data=ways, name="ways")
    add_lines(blue_scene, TECHNIQUES[name], data=ways, color="blue")
    renderer = dg.Renderer(SIZE, antialias="none", **TECHNIQUES[name].options)
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    first = renderer.render()
    renderer.restyle("ways", color="blue")
    blue = renderer.render()
    assert "terrain" not in passes(blue)
    assert blue.stats.stages["preprocess"] == first.stats.stages["preprocess"]
    assert not [one for one in passes(blue) if one in VIEW_PASSES]
    assert blue.stats.counts["prepared_bytes"] < 1.01 * first.stats.counts["prepared_bytes"]
    _, size = uploads(blue)
    assert size < 0.01 * uploads(first)[1]
    assert (blue.image != first.image).any()
    np.testing.assert_array_equal(blue.image, shot(blue_scene, name, OBLIQUE, antialias="none").image)
    renderer.restyle("ways", visible=False)
    hidden = renderer.render()
    assert not runs(hidden, name)
    renderer.restyle("ways", visible=True)
    shown = renderer.render()
    assert uploads(shown)[1] <= size
    np.testing.assert_array_equal(shown.image, blue.image)


@pytest.mark.parametrize("name", [name for name in TECHNIQUES if name not in ("static", "bvh")])
def test_another_layers_colour_uploads_that_layer_alone(name: str) -> None:
    scene = scene_of(name)
    scene.add_polygons(SQUARES[:1], color="green", name="field")
    renderer = dg.Renderer(SIZE, antialias="none")
    renderer.preprocess(scene)
    renderer.update(MAP)
    first = renderer.render()
    renderer.restyle("field", color="blue")
    second = renderer.render()
    assert uploads(second)[1] < 1000
    assert (second.image != first.image).any()


# What a first picture of each technique compiles; flags beyond these are for what the scene does not have.
POLYGON_PROGRAMS = {
    "static": {"static_decals[ONE_COLOR,RINGS]"},
    "bvh": {"static_bvh[RINGS]"},
    "loops": {"loops_cells[FILLS]"},
    "volume": {"volume", "volume_depth", "volume_mask"},
    "clipmap": {"clipmap", "clipmap_feedback", "clipmap_tile"},
}
LINE_PROGRAMS = {
    "static": {"static_decals[LINES,ONE_COLOR,ONE_WIDTH]"},
    "bvh": {"static_bvh"},
    "bins": {"dynamic_bins[UNION]"},
    "lists": {"dynamic_list_boxes", "dynamic_lists[UNION]"},
    "loops": {"loops_cells[STROKES]"},
    "volume": {"volume", "volume_depth", "volume_mask"},
    "clipmap": {"clipmap", "clipmap_feedback", "clipmap_offsets"},
    "distance_field": {"distance_field", "distance_field_style[UNDER]"},
}
GROUND_PROGRAMS = {"terrain", "compose[OVERLAY]"}


@pytest.mark.parametrize("name", POLYGON_PROGRAMS)
def test_opaque_polygons_of_one_colour_compile_for_that_alone(name: str) -> None:
    scene = hilly_scene()
    add_polygons(scene, TECHNIQUES[name])
    frame = shot(scene, name)
    assert set(frame.stats.variants) == GROUND_PROGRAMS | POLYGON_PROGRAMS[name]
    assert not {"half planes", "segments", "owners", "mesh", "offsets"} & {
        each.split(": ")[1] for each in objects(frame)
    }


@pytest.mark.parametrize("name", LINE_PROGRAMS)
def test_opaque_lines_of_one_colour_compile_for_that_alone(name: str) -> None:
    frame = shot(scene_of(name), name)
    assert set(frame.stats.variants) == GROUND_PROGRAMS | LINE_PROGRAMS[name]
    assert not {"half planes", "polygons", "quad-trees"} & {each.split(": ")[1] for each in objects(frame)}


FEATURES: dict[str, dict[str, Any]] = {
    "translucent": {"alpha": 0.5},
    "colours": {"color": ["red", "blue"]},
    "bevels": {"corner": "bevel", "cap": "butt"},
    "dashes": {"dash": (10, 5)},
    "casing": {"casing": dg.Casing(width=2, color="black")},
}


# Flags of programs that a style brings, and those it takes away.
BROUGHT = {
    ("static", "translucent"): {"TRANSLUCENT"},
    ("bins", "translucent"): {"TRANSLUCENT"},
    ("static", "bevels"): {"JOINED", "STYLES"},
    ("bvh", "bevels"): {"CORNERS"},
    ("bins", "bevels"): {"JOINED"},
    ("lists", "bevels"): {"JOINED"},
    ("static", "dashes"): {"JOINED", "STYLES", "PATTERNS"},
    ("bvh", "dashes"): {"CORNERS", "PATTERNS"},
    ("bins", "dashes"): {"JOINED", "STYLED"},
    ("lists", "dashes"): {"JOINED", "STYLED"},
    ("distance_field", "dashes"): {"LENGTHS", "PHASES"},
}
TAKEN = {
    ("static", "translucent"): {"ONE_COLOR"},
    ("static", "colours"): {"ONE_COLOR"},
    ("static", "dashes"): {"ONE_COLOR", "ONE_WIDTH"},
    ("static", "bevels"): {"ONE_COLOR", "ONE_WIDTH"},
    ("static", "casing"): {"ONE_COLOR", "ONE_WIDTH"},
    **{
        (name, feature): {"UNION"}
        for name in ("bins", "lists")
        for feature in FEATURES
        if feature != "bevels"
    },
}
REFUSED = {
    *((name, "bevels") for name in ("loops", "distance_field")),
    *((name, "dashes") for name in ("loops", "volume", "clipmap")),
}


def flags(frame: dg.Frame) -> set[str]:
    """Of all programs of layers."""
    programs = [
        one for one in frame.stats.variants if "[" in one and not one.startswith(("terrain", "compose"))
    ]
    return {flag for one in programs for flag in one.rstrip("]").split("[")[1].split(",")}


@pytest.mark.parametrize("feature", FEATURES)
@EACH
def test_what_a_style_costs_is_paid_by_those_who_use_it(name: str, feature: str) -> None:
    """A plain scene has none of the flags, and at most the objects, of one with the style."""
    plain = shot(scene_of(name), name)
    if (name, feature) in REFUSED:
        with pytest.raises((dg.UnsupportedError, dg.StyleError)):
            shot(scene_of(name, **FEATURES[feature]), name)
        return
    styled = shot(scene_of(name, **FEATURES[feature]), name)
    assert flags(styled) - flags(plain) == BROUGHT.get((name, feature), set())
    assert flags(plain) - flags(styled) == TAKEN.get((name, feature), set())
    assert objects(plain) <= objects(styled)
    assert len(passes(plain)) <= len(passes(styled))


def test_no_layers_no_overlay() -> None:
    for antialias in ("none", "coverage", "ssaa", "msaa", "fxaa"):
        frame = draw(hilly_scene(), OBLIQUE, antialias=antialias)
        assert not [name for name in frame.stats.objects if "overlay" in name]
        assert not any("OVERLAY" in variant for variant in frame.stats.variants)
        assert set(frame.stats.bytes) <= {"frame", "terrain", "silhouettes"}
