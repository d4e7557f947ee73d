"""Patterns along the ground: lengths of dashes on slopes, in the reference and in both indexes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from shapely import LineString, Polygon

import decalgl as dg
from decalgl.reference.ground import Ground
from decalgl.reference.ground_lengths import GroundLengths
from shapes import uneven_terrain

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

DASHED: dict[str, Any] = {"width": 3.0, "width_units": "m", "dash": (6, 4), "slope_correction": "tangent"}
BOTH = pytest.mark.parametrize("index", ["grid", "bvh"])
SIZE = (400, 40)


def ramp(steepness: float) -> dg.Terrain:
    """100 m, rising eastwards."""
    heights = np.tile(steepness * np.linspace(0.0, 100.0, 11), (11, 1)).astype(np.float32)
    return dg.Terrain(heights, 0.0, 100.0, 10.0, 10.0)


def from_above(scene: dg.Scene, **options: Any) -> dg.Frame:
    """A quarter of a metre a pixel, along the middle of the ground."""
    return scene.render(dg.Camera.top_down((0, 45, 100, 55)), size=SIZE, antialias="none", **options)


def test_reference_lengths_are_those_of_a_fine_walk() -> None:
    scene = dg.Scene(uneven_terrain(100.0, 45.0, samples=17))
    ground = Ground(scene)
    generator = np.random.default_rng(6)
    # Some leave the ground, some run along lines of samples or from sample to sample.
    start = np.concatenate(
        [generator.uniform(-120.0, 120.0, (20, 2)), [(-100.0, 0.0), (-100.0, 100.0), (5.0, 5.0)]]
    )
    end = np.concatenate(
        [generator.uniform(-120.0, 120.0, (20, 2)), [(100.0, 0.0), (100.0, -100.0), (5.0, 5.0)]]
    )
    found = GroundLengths(ground, start, end - start)
    shares = np.linspace(0.0, 1.0, 20001)
    for i, (a, b) in enumerate(zip(start, end, strict=True)):
        places = a + shares[:, None] * (b - a)
        steps = np.linalg.norm(np.diff(np.column_stack([places, ground(places)]), axis=0), axis=1)
        walked = np.concatenate([[0.0], np.cumsum(steps)])
        np.testing.assert_allclose(found.total[i], walked[-1], rtol=1e-4)
        np.testing.assert_allclose(
            found.at(np.full(20001, i), shares), walked, atol=1e-4 * walked[-1] + 1e-12
        )


@BOTH
@pytest.mark.parametrize("vertices", [2, 37])
def test_dashes_are_as_long_on_the_slope_as_they_say(index: str, vertices: int) -> None:
    steepness = 0.75  # 5/4 as long uphill
    scene = dg.Scene(ramp(steepness))
    x = np.linspace(0.0, 100.0, vertices)
    scene.add_lines(
        [LineString(np.column_stack([x, np.full(vertices, 50.0)]))], cap="butt", corner="bevel", **DASHED
    )
    frame = from_above(scene, index=index)
    along = 1.25 * (np.arange(SIZE[0]) + 0.5) * 0.25 % 10.0
    far = np.minimum(np.abs(along - 6.0), np.minimum(along, 10.0 - along)) > 0.01
    np.testing.assert_array_equal((frame.ids[20] == 0)[far], (along < 6.0)[far])
    # With Thoeny's correction, or none, they are those on the map.
    for correction in (None, "thoeny"):
        scene = dg.Scene(ramp(steepness))
        scene.add_lines(
            [LineString([(0, 50), (100, 50)])], cap="butt", **{**DASHED, "slope_correction": correction}
        )
        on_map = (np.arange(SIZE[0]) + 0.5) * 0.25 % 10.0 < 6.0
        np.testing.assert_array_equal(from_above(scene, index=index).ids[20] == 0, on_map)


@BOTH
def test_exaggeration_stretches_the_ground(index: str) -> None:
    line = LineString([(0, 50), (100, 50)])
    pictures = []
    for scene in (dg.Scene(ramp(0.5), exaggeration=3.0), dg.Scene(ramp(1.5))):
        scene.add_lines([line], **DASHED)
        pictures.append(from_above(scene, index=index).ids)
    np.testing.assert_array_equal(*pictures)


@BOTH
@pytest.mark.parametrize("kind", ["lines", "polygons"])
def test_edits_follow_the_ground_too(index: str, kind: str) -> None:
    generator = np.random.default_rng(9)
    corners = generator.uniform(-90.0, 90.0, (12, 5, 2))
    shapes: list[Any] = [LineString(each) for each in corners]
    if kind == "polygons":
        shapes = [Polygon(each).buffer(0) for each in corners]

    def scene(some: list[Any]) -> dg.Scene:
        made = dg.Scene(uneven_terrain(100.0, 45.0, samples=17))
        if kind == "lines":
            made.add_lines(some, casing=dg.Casing(width=1), **DASHED)
        else:
            made.add_polygons(some, alpha=0.3, outline=dg.Outline(**DASHED))
        return made

    camera = dg.Camera.orbit((0, 0, 0), 260.0, 200.0, 50.0)
    renderer = dg.Renderer(size=(320, 240), index=index, antialias="none")  # type: ignore[arg-type]
    renderer.preprocess(scene(shapes[:6]))
    renderer.update(camera)
    renderer.edit(0, add=shapes[6:11], replace={2: shapes[11]})
    edited = renderer.render()
    anew = scene([*shapes[:2], shapes[11], *shapes[3:11]]).render(
        camera, size=(320, 240), index=index, antialias="none"
    )
    assert (anew.ids >= 0).mean() > 0.03
    assert (edited.ids != anew.ids).mean() < 5e-4


def test_level_ground_costs_nothing() -> None:
    way = np.cumsum(np.random.default_rng(2).uniform(-3.0, 3.0, (300, 2)), axis=0)
    counts = []
    for correction in ("tangent", None):
        scene = dg.Scene(dg.Terrain.flat((-100, -100, 100, 100)))
        scene.add_lines([LineString(way)], **{**DASHED, "slope_correction": correction})
        frame = scene.render(dg.Camera.top_down(scene.terrain.bounds), size=(64, 64), antialias="none")
        counts.append(frame.stats.counts["segments"])
    assert counts[0] == counts[1]
