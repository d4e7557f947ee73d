"""Every scene of styles against the reference: ids and colours at pixel centres, coverage over pixels' areas.

Without anti-aliasing each style meets one index, in turns. With coverage the grid is judged over areas in every
scene, cell by cell (in larger pictures of those that reach as far as levels of detail do), the published index in half
of them.
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
FILTERED = [
    (index, name, 1)
    for i, name in enumerate(styles.STYLES)
    for index in INDEXES
    if index == "grid" or index == INDEXES[1 - i % 2]
]
# Parts of these are seen from as far as the grid takes what it shows from levels of detail.
FAR = ("outlines_of_neighbours", "hatches_aslant", "casings")
FILTERED += [("grid", name, 2) for name in FAR]
# Metres that rounding moves a vertex or a position, in quanta: half of one, twice where a cell's border cuts an edge,
# and as much again for what the shaders compute in 32 bits.
QUANTA = 2.0
# Steps of 1/255 that colours may be off: the published index blends a pass at a time into bytes.
STEPS = {"grid": 1.1, "bvh": 2.1}
# Crops whose coverage is judged over the area, by 32 samples a pixel each way.
CROP, SAMPLES = (36, 20), 32
# Root mean square and 99th percentile, over the partly covered pixels of a crop, of the channel that differs most.
RMS, P99 = 0.015, 0.05
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


def zoomed(view: View, zoom: int) -> View:
    """In a picture of so many times as many pixels each way."""
    return view._replace(size=(zoom * view.size[0], zoom * view.size[1]))


@pytest.mark.parametrize(("index", "name", "zoom"), FILTERED)
def test_coverage_is_the_mean_over_the_pixel(index: str, name: str, zoom: int) -> None:
    view = zoomed(styles.build(name), zoom)
    x0, y0, x1, y1 = crop = judge.busiest_crop(judge.draw(renderer(index), view), CROP)
    surface = ref.sample_surface(view.scene, view.camera, view.size, crop, SAMPLES)
    expected = ref.render_overlay(view.scene, view.camera, view.size, crop, SAMPLES, surface=surface)
    got = judge.overlay_of(renderer(index), view, "coverage")[y0:y1, x0:x1]
    ignored = expected.mixed | (expected.terrain_fraction < 1.0) | judge.folded(view, crop, surface, SAMPLES)
    found = ref.compare_overlay(got, expected, ignore=ignored)
    assert found.partial >= 30
    assert found.rms <= RMS, found
    assert found.p99 <= P99, found
    assert found.leak <= LEAK, found


@pytest.mark.parametrize("name", styles.STYLES)
def test_what_is_near_is_drawn_cell_by_cell(name: str) -> None:
    for zoom in (1, 2) if name in FAR else (1,):
        view = zoomed(styles.build(name), zoom)
        variants = judge.draw(dg.Renderer(terrain_error=0.0), view, "coverage").stats.variants
        assert any("CELLS" in variant for variant in variants)
        assert any("LEVELS" in variant for variant in variants) == (name in FAR and zoom == 1)


@pytest.mark.parametrize(
    ("kind", "spacing", "samples"), [("polygons", 100.0, 64), ("lines", 100.0, 64), ("polygons", 0.0025, 256)]
)
def test_straight_edges_cover_their_share_of_the_pixel(
    kind: Literal["polygons", "lines"], spacing: float, samples: int
) -> None:
    """Pixels that a border crosses farther from all corners than they are wide, against the exact area.

    With vertices `spacing` metres apart: where there are many, cells are small, and samples walk one by one.
    """
    scene = flat_ground()
    turns = np.linspace(0.0, np.pi, 24, endpoint=False)
    bar = np.array([(-6.0, -3.0), (6.0, -3.0), (6.0, 3.0), (-6.0, 3.0)])
    bars = []
    for place, turn in zip(grid(6, 4).reshape(-1, 2), turns, strict=True):
        rotation = np.array([(np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))])
        bars.append(place + bar @ rotation)
    if kind == "polygons":
        rings = [shapely.get_coordinates(shapely.segmentize(shapely.Polygon(b), spacing))[:-1] for b in bars]
        styled(scene, kind, [[ring] for ring in rings], fill=fill(24, (1.0, 1.0, 1.0)))
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
    shares = len(np.unique(np.rint(255.0 * got[judged])))
    assert samples / 3 < shares <= samples + 1
    error = np.abs(got - exact / side**2)[judged]
    assert error.max() <= STRAIGHT
    assert np.sqrt((error**2).mean()) <= RMS / 2


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
