"""Every scene of styles against the reference: ids and colours at pixel centres, coverage over pixels' areas.

Without anti-aliasing each style meets one index, in turns. With coverage the grid is judged over areas in every
scene, the published index at its places in every scene and over areas in half of them.
"""

from __future__ import annotations

import dataclasses
import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import pytest
import shapely

import decalgl as dg
import judge
import rounding
import styles
from decalgl import reference as ref
from decalgl.strokes import StrokeStyle
from shapes import with_features
from styled import above, fill, flat_ground, grid, stroke, styled

if TYPE_CHECKING:
    from scenes import View

INDEXES = ("grid", "bvh")
# Without anti-aliasing, and with coverage, each in one index, which take turns.
EXACT = [(name, INDEXES[i % 2]) for i, name in enumerate(styles.STYLES)]
# The published index asks at places; of the grid's masks only the share of the pixel is told.
FILTERED = [("grid", name) for name in styles.STYLES] + [
    ("bvh", name) for i, name in enumerate(styles.STYLES) if INDEXES[1 - i % 2] == "bvh"
]
# Metres that rounding moves a vertex or a position, in quanta: half of one, twice where a cell's border cuts an edge,
# and as much again for what the shaders compute in 32 bits.
QUANTA = 2.0
# Steps of 1/255 that colours may be off: the published index blends a pass at a time into bytes.
STEPS = {"grid": 1.1, "bvh": 2.1}
# Crops whose coverage is judged: at its own 32 places in a pixel, and over the area by 32 samples a pixel each way.
WIDE_CROP = (160, 90)
CROP, SAMPLES = (36, 20), 32
# Metres of a pixel's shorter side that are surely not drawn from levels of detail, which tell more than 32 places.
NEAR = 0.6
# Root mean square and 99th percentile, over the partly covered pixels of a crop, of the channel that differs most. Of
# 32 places with the right answers 0.024 and 0.08 remain on opaque edges.
RMS = {"grid": 0.015, "bvh": 0.03}
P99 = {"grid": 0.05, "bvh": 0.09}
# The largest difference from the exact area, of pixels that one straight edge crosses.
STRAIGHT = 0.02
# The lack of alpha where a pixel is covered all over.
LEAK = 0.02


@functools.cache
def renderer(index: str) -> dg.Renderer:
    """One renderer for each index; it draws every sample of the terrain."""
    return dg.Renderer(terrain_error=0.0, index=index)


def reach(frame: dg.Frame) -> float:
    """Metres, and no less than how exact positions are."""
    return max(judge.LEAST, QUANTA * float(frame.stats.counts["quantum_m"]))


def shorter_side(view: View, frame: dg.Frame) -> judge.FloatArray:
    """The shorter side (h, w) in metres of each pixel's footprint."""
    surface = judge.own_surface(view, frame).reshape(-1)
    right, down = judge.sides(view, judge.centres_of(view), surface)
    shorter = np.minimum(np.linalg.norm(right, axis=1), np.linalg.norm(down, axis=1))
    return shorter.reshape(frame.depth.shape)


@pytest.mark.parametrize(("name", "index"), EXACT)
def test_ids_are_right(name: str, index: str) -> None:
    view = styles.build(name)
    frame = judge.draw(renderer(index), view)
    assert (frame.ids >= 0).mean() > 0.02
    wrong, unexplained = rounding.unexplained_ids(view, frame, reach(frame))
    assert unexplained == 0
    assert wrong <= 2e-3 * frame.ids.size


@pytest.mark.parametrize(("name", "index"), EXACT)
def test_without_antialiasing_a_pixel_is_the_composite_at_its_centre(name: str, index: str) -> None:
    view = styles.build(name)
    frame = judge.draw(renderer(index), view)
    overlay = judge.overlay_of(renderer(index), view, "none")
    wrong, unexplained = rounding.unexplained_colors(view, frame, overlay, reach(frame), STEPS[index])
    assert unexplained == 0
    assert wrong <= 4e-3 * frame.ids.size


@pytest.mark.parametrize("name", styles.STYLES)
def test_the_published_index_is_right_at_each_of_its_places(name: str) -> None:
    index, view = "bvh", styles.build(name)
    frame = judge.draw(renderer(index), view)
    x0, y0, x1, y1 = crop = judge.busiest_crop(frame, WIDE_CROP)
    expected = rounding.coverage_of_samples(view, frame, crop)
    got = judge.overlay_of(renderer(index), view, "coverage")[y0:y1, x0:x1]
    near = (np.isfinite(frame.depth) & (shorter_side(view, frame) < NEAR))[y0:y1, x0:x1]
    # Where the pixel's area leaves its centre's plane, the frame draws other places.
    near &= ~judge.folded(view, crop, ref.sample_surface(view.scene, view.camera, view.size, crop, 4), 4)
    assert near.mean() > 0.2
    difference = np.abs(got - expected).max(axis=-1)[near]
    # Corners of short segments turn when their vertices are rounded.
    assert difference.max() <= 6.1 / 32
    # A place within a quantum of an edge may fall to either side.
    for angle in np.arange(0.0, 2.0 * np.pi, np.pi / 4):
        if (difference > STEPS[index] / 255).mean() <= 0.005:
            return
        move = reach(frame) * np.array((np.cos(angle), np.sin(angle)))
        expected = rounding.coverage_of_samples(view, frame, crop, (move[0], move[1]))
        difference = np.minimum(difference, np.abs(got - expected).max(axis=-1)[near])
    assert (difference > STEPS[index] / 255).mean() <= 0.005


@pytest.mark.parametrize(("index", "name"), FILTERED)
def test_coverage_is_the_mean_over_the_pixel(index: str, name: str) -> None:
    view = styles.build(name)
    x0, y0, x1, y1 = crop = judge.busiest_crop(judge.draw(renderer(index), view), CROP)
    surface = ref.sample_surface(view.scene, view.camera, view.size, crop, SAMPLES)
    expected = ref.render_overlay(view.scene, view.camera, view.size, crop, SAMPLES, surface=surface)
    got = judge.overlay_of(renderer(index), view, "coverage")[y0:y1, x0:x1]
    ignored = expected.mixed | (expected.terrain_fraction < 1.0) | judge.folded(view, crop, surface, SAMPLES)
    found = ref.compare_overlay(got, expected, ignore=ignored)
    assert found.partial >= 30
    assert found.rms <= RMS[index], found
    assert found.p99 <= P99[index], found
    assert found.leak <= LEAK, found


@pytest.mark.parametrize("kind", ["polygons", "lines"])
def test_straight_edges_cover_their_share_of_the_pixel(kind: Literal["polygons", "lines"]) -> None:
    """Pixels that a border crosses farther from all corners than they are wide, against the exact area."""
    scene = flat_ground()
    turns = np.linspace(0.0, np.pi, 24, endpoint=False)
    bar = np.array([(-6.0, -3.0), (6.0, -3.0), (6.0, 3.0), (-6.0, 3.0)])
    bars = []
    for place, turn in zip(grid(6, 4).reshape(-1, 2), turns, strict=True):
        rotation = np.array([(np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))])
        bars.append(place + bar @ rotation)
    if kind == "polygons":
        styled(scene, kind, [[ring] for ring in bars], fill=fill(24, (1.0, 1.0, 1.0)))
    else:
        middles = [[np.array([ring[[0, 3]].mean(axis=0), ring[[1, 2]].mean(axis=0)])] for ring in bars]
        styled(scene, kind, middles, stroke=stroke(24, 6.0, (1.0, 1.0, 1.0), StrokeStyle("miter", "butt")))
    view = above(scene)
    frame = judge.draw(renderer("grid"), view)
    x, y = frame.world[..., 0].reshape(-1), frame.world[..., 1].reshape(-1)
    side = abs(frame.world[0, 1, 0] - frame.world[0, 0, 0])
    pixels = shapely.box(x - side / 2, y - side / 2, x + side / 2, y + side / 2)
    exact = shapely.area(
        shapely.intersection(pixels, shapely.MultiPolygon([shapely.Polygon(b) for b in bars]))
    )
    corners = shapely.MultiPoint(np.concatenate(bars))
    judged = (exact > 0.0) & (exact < side**2) & (shapely.distance(shapely.points(x, y), corners) > 2 * side)
    got = judge.overlay_of(renderer("grid"), view, "coverage")[..., 3].reshape(-1)
    assert judged.sum() > 1000
    error = np.abs(got - exact / side**2)[judged]
    assert error.max() <= STRAIGHT
    assert np.sqrt((error**2).mean()) <= RMS["grid"] / 2


# The judge


@dataclass
class Rounded:
    """What a renderer without a fault would draw of vertices rounded to a lattice."""

    world: judge.FloatArray
    depth: judge.FloatArray
    ids: judge.IntArray
    layers: judge.IntArray


def rounded(view: View, quantum: float) -> Rounded:
    tables = [
        dataclasses.replace(
            layer.features, coords=np.round(np.asarray(layer.features.coords) / quantum) * quantum
        )
        for layer in view.scene.layers
    ]
    seen = ref.raycast(view.scene, view.camera, view.size)
    scene = with_features(view.scene, tables)
    found = ref.render_ids(scene, view.camera, view.size, surface=seen, distances=False)
    return Rounded(seen.world, seen.depth, found.ids, found.layers)


@pytest.mark.parametrize("name", ["caps_and_corners", "short_segments", "dashes_around_corners"])
def test_rounding_explains_what_it_does_and_no_more(name: str) -> None:
    view = styles.build(name)
    quantum = 2.0**-9
    wrong, unexplained = rounding.unexplained_ids(view, rounded(view, quantum), QUANTA * quantum)
    assert wrong > 0
    assert unexplained == 0
    assert rounding.unexplained_ids(view, rounded(view, 10 * quantum), QUANTA * quantum)[1] > 10
