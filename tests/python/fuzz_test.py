"""Nonsense at the border between Python and the core ends in typed errors, and never in a crash or a hang."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import decalgl as dg
from decalgl import _core
from small_scenes import MAP, flat_scene

REFUSED = (dg.DecalError, TypeError)
slow = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])

odd_floats = st.sampled_from(
    [0.0, -0.0, 1.0, -1.0, 50.0, 1e-300, 5e-324, 1e-9, 1e9, 1e15, 1e30, 1e300, -1e30, np.nan, np.inf, -np.inf]
) | st.floats(-200, 200)
odd_integers = st.sampled_from(
    [0, 1, -1, 2, 3, 4, 1 << 31, -(1 << 31), (1 << 63) - 1, -(1 << 63)]
) | st.integers(-5, 12)
offsets = st.lists(odd_integers, max_size=5).map(lambda values: np.array(values, dtype=np.int64))
dtypes = st.sampled_from([np.float64, np.float32, np.int32, np.int64, np.uint8, np.bool_])


@st.composite
def arrays(draw: Any, values: Any) -> Any:
    """Small arrays of odd shapes and types."""
    shape = draw(
        st.sampled_from([(0,), (1,), (3,), (4,), (8,), (0, 2), (1, 2), (4, 2), (4, 3), (2, 2, 2), ()])
    )
    count = int(np.prod(shape))
    content = draw(st.lists(values, min_size=count, max_size=count))
    with np.errstate(all="ignore"):
        return np.array(content, dtype=np.float64).reshape(shape).astype(draw(dtypes))


def core_scene(terrain: dg.Terrain | None = None) -> _core.Scene:
    """Flat ground of 100 m in the core."""
    ground = terrain or dg.Terrain.flat((0.0, 0.0, 100.0, 100.0))
    return _core.Scene(ground.z, ground.x0, ground.y0, ground.dx, ground.dy, 1.0, _core.Relief())


@pytest.fixture(scope="module", params=["grid", "bvh"])
def renderer(request: pytest.FixtureRequest) -> _core.Renderer:
    few = dg.BvhIndex(cells=20)
    return _core.Renderer(16, 16, "coverage", 0.5, 1 << 30, "auto", 1, 0, request.param, few.to_dict())


CAMERA = _core.Camera((50.0, 50.0, 100.0), (50.0, 50.0, 0.0), (0.0, 1.0, 0.0), 60.0, 0.0)
SKY = (0.0, 0.0, 0.0, 0.0)


def core_fill(colors: Any, *hatches: Any, hatch_of: Any = None) -> _core.Fill:
    fill = _core.Fill()
    fill.colors = colors
    if hatches:
        fill.hatches = list(hatches)
    if hatch_of is not None:
        fill.hatch_of = hatch_of
    return fill


def core_stroke(
    colors: Any, widths: Any, *styles: Any, style_of: Any = None, widest: float = 0.0
) -> _core.Stroke:
    stroke = _core.Stroke()
    stroke.colors, stroke.widths, stroke.widest = colors, widths, widest
    if styles:
        stroke.styles = list(styles)
    if style_of is not None:
        stroke.style_of = style_of
    return stroke


NORMAL, OVER_ALL = _core.OutlineMode.__members__["normal"], _core.OutlineOrder.__members__["layer"]
NO_OUTLINES = (_core.Stroke(), _core.Stroke(), NORMAL, OVER_ALL)
PLAIN = {"fill": _core.Fill(), "stroke": _core.Stroke(), "casing": _core.Stroke(),
         "outline_mode": NORMAL, "outline_order": OVER_ALL}  # fmt: skip


def attempt(*steps: Any) -> bool:
    """Runs the steps until one is refused; whether none was. Any other exception comes through."""
    try:
        for step in steps:
            step()
    except REFUSED:
        return False
    return True


def render_all(renderer: _core.Renderer, scene: _core.Scene, camera: _core.Camera = CAMERA) -> None:
    renderer.preprocess(scene, None)
    renderer.update(camera)
    frame = renderer.render(SKY, SKY)
    for array in (frame.image, frame.ids, frame.layers, frame.depth, frame.world):
        assert array.shape[:2] == (16, 16)
    frame.pick(8, 8)


def assert_draws(renderer: _core.Renderer) -> None:
    """The renderer still works."""
    scene = core_scene()
    square = np.array([[0, 0], [100, 0], [100, 100], [0, 100]], dtype=np.float64)
    one = np.array([0, 1])
    fill = core_fill(np.full(4, 255, np.uint8))
    scene.add_layer("a", "static", None, True, square, 4 * one, one, one[:1], fill, *NO_OUTLINES, one[:1])
    render_all(renderer, scene)


@slow
@given(st.data())
def test_layers(renderer: _core.Renderer, data: Any) -> None:
    scene = core_scene()
    given_arrays = {
        "coordinates": data.draw(arrays(odd_floats)),
        "part_offsets": data.draw(offsets),
        "feature_offsets": data.draw(offsets),
        "rows": data.draw(offsets),
        "draw_order": data.draw(offsets),
    }
    colors = st.integers(0, 255).map(float)
    places = st.none() | arrays(odd_integers.map(float))

    def add() -> None:
        looks = dict(PLAIN)
        if data.draw(st.booleans()):
            looks["fill"] = core_fill(data.draw(arrays(colors)), hatch_of=data.draw(places))
        for role in ("stroke", "casing"):
            if data.draw(st.booleans()):
                widths, style_of = data.draw(arrays(odd_floats)), data.draw(places)
                looks[role] = core_stroke(data.draw(arrays(colors)), widths, style_of=style_of)
        technique = data.draw(st.sampled_from(("static", "static", "static_bvh", "", "odd")))
        polygons = data.draw(st.booleans())
        scene.add_layer("odd", technique, None, polygons, **given_arrays, **looks)

    attempt(add)
    attempt(lambda: render_all(renderer, scene))
    assert_draws(renderer)


lengths = odd_floats | st.floats(0.01, 50.0)


def odd_hatches(plain: bool) -> Any:
    sizes, angles = (st.floats(0.01, 50.0), st.floats(-360, 360)) if plain else (lengths, odd_floats)
    return st.builds(_core.Hatch, spacing=sizes, width=sizes, angle=angles, crossed=st.booleans())


@st.composite
def plain_styles(draw: Any) -> _core.StrokeStyle:
    """Styles that fit."""
    style = any_words(draw)
    style.miter_limit = draw(st.floats(0, 180))
    if draw(st.booleans()):
        period = draw(st.floats(0.5, 50.0))
        begin, end = draw(st.floats(0.0, 0.4)), draw(st.floats(0.5, 1.0))
        shares = draw(st.lists(st.floats(0, 1), min_size=2, max_size=2))
        mark = _core.PatternMark(begin * period, end * period, *shares)
        style.pattern = _core.LinePattern(period, draw(st.floats(-99, 99)), [mark] * draw(st.integers(1, 3)))
    reaches = draw(st.sampled_from([[], [1.0], [0.3, 1.0], [0.1, 0.5, 1.0]]))
    style.bands = [_core.ColorBand(reach, [200, 10, 10, 90]) for reach in reaches]
    return style


def any_words(draw: Any) -> _core.StrokeStyle:
    style = _core.StrokeStyle()
    style.corner = draw(st.sampled_from(list(_core.Corner.__members__.values())))
    style.cap = draw(st.sampled_from(list(_core.Cap.__members__.values())))
    style.slope_correction = draw(st.sampled_from(list(_core.SlopeCorrection.__members__.values())))
    return style


@st.composite
def odd_styles(draw: Any) -> _core.StrokeStyle:
    """Styles of which most are refused."""
    style = any_words(draw)
    style.miter_limit = draw(st.floats(0, 180) | odd_floats)
    if draw(st.booleans()):
        period = draw(lengths)
        ends = sorted(draw(st.lists(st.floats(0, 1), min_size=2, max_size=2)))
        shares = draw(st.lists(st.floats(0, 1) | odd_floats, min_size=2, max_size=2))
        mark = _core.PatternMark(ends[0] * period, ends[1] * period, *shares)
        style.pattern = _core.LinePattern(period, draw(odd_floats), [mark] * draw(st.integers(0, 17)))
    reaches = sorted(draw(st.lists(st.floats(0, 1), max_size=3))) + draw(st.sampled_from([[], [1.0]]))
    style.bands = [_core.ColorBand(reach, [200, 10, 10, 90]) for reach in reaches]
    return style


@st.composite
def fitting_layers(draw: Any) -> dict[str, Any]:
    """Layers whose offsets fit: half of them ordinary, the others with odd coordinates, widths and styles."""
    ordinary = draw(st.booleans())
    places, breadths = (st.floats(-200, 200), st.floats(0, 60)) if ordinary else (odd_floats, odd_floats)
    styles = st.lists(plain_styles() if ordinary else odd_styles(), max_size=1 if ordinary else 2)
    sizes = draw(st.lists(st.integers(0, 6), min_size=1, max_size=4))
    count = len(sizes)
    point = st.tuples(places, places)
    coordinates = draw(st.lists(point, min_size=sum(sizes), max_size=sum(sizes)))
    polygons = draw(st.booleans())
    rgba = np.array([200, 10, 10, draw(st.sampled_from([0, 90, 255]))] * count, dtype=np.uint8)
    looks = dict(PLAIN)
    if polygons:
        looks["fill"] = core_fill(rgba, *draw(st.lists(odd_hatches(plain=ordinary), max_size=2)))
    if not polygons or draw(st.booleans()):
        widths = np.array(draw(st.lists(breadths, min_size=count, max_size=count)))
        looks["outline_mode"] = _core.OutlineMode.__members__[
            draw(st.sampled_from(["normal", "inset", "offset"]))
        ]
        looks["outline_order"] = _core.OutlineOrder.__members__[draw(st.sampled_from(["layer", "feature"]))]
        for role in ("stroke",) if polygons else ("stroke", "casing"):
            looks[role] = core_stroke(
                rgba,
                widths,
                *draw(styles),
                widest=draw(st.just(0.0) | breadths),
            )
    return {
        **looks,
        "polygons": polygons,
        "coordinates": np.array(coordinates, dtype=np.float64).reshape(-1, 2),
        "part_offsets": np.cumsum([0, *sizes]),
        "feature_offsets": np.arange(count + 1),
        "rows": np.arange(count),
        "draw_order": np.array(draw(st.permutations(range(count))), dtype=np.int64),
    }


@slow
@given(fitting_layers())
def test_coordinates_and_widths(renderer: _core.Renderer, layer: dict[str, Any]) -> None:
    scene = core_scene()
    attempt(lambda: scene.add_layer(name="odd", **layer), lambda: render_all(renderer, scene))
    assert_draws(renderer)


@slow
@given(
    st.tuples(odd_floats, odd_floats, odd_floats),
    st.tuples(odd_floats, odd_floats, odd_floats),
    st.tuples(odd_floats, odd_floats, odd_floats),
    st.sampled_from([0.0, 180.0, 1e-300, 1e-9, 179.999999999, 45.0, np.nan, np.inf, -1.0]),
    odd_floats,
)
def test_cameras(renderer: _core.Renderer, eye: Any, target: Any, up: Any, fov: float, height: float) -> None:
    attempt(lambda: render_all(renderer, core_scene(), _core.Camera(eye, target, up, fov, height)))
    attempt(lambda: dg.Camera(eye, target, up, fov), lambda: draw_public(dg.Camera(eye, target, up, fov)))
    attempt(lambda: draw_public(dg.Camera.look_at(eye, target)))
    attempt(lambda: draw_public(dg.Camera(eye, target, up, None, height)))
    attempt(lambda: draw_public(dg.Camera.orbit(eye, height, target[0], target[1], fov)))
    attempt(lambda: draw_public(dg.Camera.top_down((*eye, height))))
    assert_draws(renderer)


PUBLIC = flat_scene()


def draw_public(camera: dg.Camera) -> None:
    frame = PUBLIC.render(camera, (8, 8))
    assert frame.depth.shape == (8, 8)
    assert np.isfinite(frame.world[np.isfinite(frame.depth)]).all()


@slow
@given(arrays(odd_floats), odd_floats, odd_floats, odd_floats, odd_floats, odd_floats)
def test_terrains(
    renderer: _core.Renderer, z: Any, x0: float, y0: float, dx: float, dy: float, exaggeration: float
) -> None:
    def core() -> None:
        scene = _core.Scene(z, x0, y0, dx, dy, exaggeration, _core.Relief())
        one = np.array([0, 1])
        line = np.array([[0.0, 0.0], [1.0, 1.0]])
        color = np.full(4, 255, np.uint8)
        scene.add_layer("a", False, line, 2 * one, one, one[:1], color, np.ones(1), one[:1])
        render_all(renderer, scene)

    attempt(core)
    attempt(lambda: dg.Scene(dg.Terrain(z, x0, y0, dx, dy), exaggeration).render(MAP, (8, 8)))
    assert_draws(renderer)


@slow
@given(st.lists(st.integers(0, 255), max_size=7), odd_floats, odd_floats, odd_floats)
def test_reliefs(renderer: _core.Renderer, ramp: list[int], low: float, high: float, angle: float) -> None:
    relief = _core.Relief()
    relief.ramp, relief.lowest, relief.highest = ramp, low, high
    relief.azimuth, relief.altitude, relief.strength, relief.on_layers = angle, angle, low, high
    ground = dg.Terrain.flat((0.0, 0.0, 100.0, 100.0))
    attempt(lambda: render_all(renderer, _core.Scene(ground.z, 0.0, 100.0, 100.0, 100.0, 1.0, relief)))
    assert_draws(renderer)


@slow
@given(
    odd_integers, odd_integers, st.sampled_from(["none", "coverage", "", "msaa"]), odd_floats, odd_integers
)
def test_renderers(width: int, height: int, antialias: str, error: float, limit: int) -> None:
    def draw() -> None:
        made = _core.Renderer(width, height, antialias, error, limit, "auto", 1, 0)
        made.preprocess(core_scene(), None)
        made.update(CAMERA)
        made.render(SKY, SKY)

    attempt(draw)
    attempt(lambda: dg.Renderer((width, height), antialias, error, limit, tile=width, threads=height))


@slow
@given(odd_integers, odd_integers)
def test_pixels(renderer: _core.Renderer, x: int, y: int) -> None:
    assert_draws(renderer)
    frame = renderer.render(SKY, SKY)
    inside = 0 <= x < 16 and 0 <= y < 16
    assert attempt(lambda: frame.pick(x, y)) == inside
