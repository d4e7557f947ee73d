"""Styles, indexes, ground, cameras and anti-aliasing against the reference: every two levels of any two of them meet.

The rows are a pairwise covering array over `combined.FACTORS`. What each mode is held to:

    ids         the reference's at the frame's own positions, but where rounded vertices explain another
    none        so are colours, in steps of 1/255
    ssaa, msaa  the mean of the reference at the same places in the pixel; the tolerance is what these samples see when
                they and the vertices are moved by what is rounded (`rounding.unexplained_means`)
    coverage    the mean over the pixel's area, by 32 x 32 places, over the pixels that are partly covered
    thoeny      the same, by bounds that say what his estimate is worth
    fxaa        away from edges the picture without anti-aliasing, on edges no farther from the mean over the area

Index "thoeny" shows the nearest line of a layer, so it is compared with the reference's nearest.
"""

from __future__ import annotations

import functools
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest

import covering
import decalgl as dg
import judge
import rounding
import shapes
from combined import EXCLUDED, FACTORS, combined
from decalgl import reference as ref

if TYPE_CHECKING:
    from scenes import View


class Bounds(NamedTuple):
    """Over the partly covered pixels of a crop: root mean square, 99th percentile; largest lack of alpha elsewhere."""

    rms: float
    p99: float
    leak: float


EXACT = Bounds(0.015, 0.05, 0.02)
# No goal, but what Thöny's estimate is worth against the truth: it has no corners, and multiplies what meets in a
# pixel. That lines cover by his formula is tested in thoeny_coverage_test.py.
ESTIMATED = Bounds(0.09, 0.4, 0.1)
# The same where lines cross, and the one that is nearest to the centre takes all of the pixel.
NEAREST = Bounds(0.12, 0.6, 0.1)
COVERAGE = {
    ("grid", "coverage"): EXACT,
    ("bvh", "coverage"): EXACT,
    ("thoeny", "coverage"): EXACT,
    ("grid", "thoeny"): ESTIMATED,
    ("bvh", "thoeny"): ESTIMATED,
    ("thoeny", "thoeny"): NEAREST,
}
# Metres that rounding moves a vertex or a position, in quanta: half of one, twice where a cell's border cuts an edge,
# and as much again for what the shaders compute in 32 bits.
QUANTA = 2.0
# Steps of 1/255 that colours may be off: the published indexes blend a pass at a time into bytes.
STEPS = {"grid": 1.1, "bvh": 2.1, "thoeny": 2.1}
# And of means: bytes of the layers, and of the two pictures that alpha is told from.
MEAN_STEPS = {index: steps + 0.5 for index, steps in STEPS.items()}
# Pixels that rounding explains, of all.
ROUNDED = 0.01
CROP, SAMPLES = (32, 24), 32
LARGER = 3
# Four samples in a pixel, to the right and down from its corner: rows 2, 0, 3, 1 from below, column by column.
PLACES = np.array([(0.125, 0.375), (0.375, 0.875), (0.625, 0.125), (0.875, 0.625)])

ROWS = covering.covering_array(FACTORS, EXCLUDED)
NAMES = [f"{i}-{row['index']}-{row['antialias']}" for i, row in enumerate(ROWS)]


def rows_of(*modes: str) -> pytest.MarkDecorator:
    """The rows with some ways of anti-aliasing, all by default."""
    chosen = [i for i, row in enumerate(ROWS) if not modes or row["antialias"] in modes]
    return pytest.mark.parametrize("number", chosen, ids=[NAMES[i] for i in chosen])


@functools.cache
def view_of(number: int) -> View:
    """Larger where the grid draws areas: cell by cell, but from far away, and not from levels of detail."""
    view, row = combined(ROWS[number]), ROWS[number]
    if row["index"] == "grid" and row["antialias"] in ("coverage", "thoeny"):
        return view._replace(size=(LARGER * view.size[0], LARGER * view.size[1]))
    return view


@functools.cache
def renderer(index: str, coverage: str) -> dg.Renderer:
    """It draws every sample of the terrain."""
    return dg.Renderer(terrain_error=0.0, index=index, coverage=coverage, samples=len(PLACES))


def renderer_of(number: int) -> dg.Renderer:
    row = ROWS[number]
    return renderer(row["index"], "thoeny" if row["antialias"] == "thoeny" else "exact")


@functools.cache
def frame_of(number: int) -> dg.Frame:
    """Without anti-aliasing."""
    return judge.draw(renderer_of(number), view_of(number))


def overlay_of(number: int) -> judge.FloatArray:
    mode = ROWS[number]["antialias"]
    return judge.overlay_of(renderer_of(number), view_of(number), "coverage" if mode == "thoeny" else mode)


def shows_nearest(number: int) -> bool:
    return ROWS[number]["index"] == "thoeny"


def reach(number: int) -> float:
    """Metres that rounding moves anything by, and no less than how exact positions are."""
    return max(judge.LEAST, QUANTA * float(frame_of(number).stats.counts["quantum_m"]))


def truth(number: int) -> tuple[judge.Crop, ref.Overlay, judge.BoolArray]:
    """The busiest crop, its mean over the pixels' areas, and where the pixel sees more than one plane."""
    view = view_of(number)
    crop = judge.busiest_crop(frame_of(number), CROP)
    surface = ref.sample_surface(view.scene, view.camera, view.size, crop, SAMPLES)
    expected = ref.render_overlay(
        view.scene, view.camera, view.size, crop, SAMPLES, surface=surface, nearest=shows_nearest(number)
    )
    ignored = expected.mixed | (expected.terrain_fraction < 1.0) | judge.folded(view, crop, surface, SAMPLES)
    return crop, expected, ignored


# The array


def test_every_two_levels_of_any_two_factors_meet() -> None:
    met = {((one, row[one]), (other, row[other])) for row in ROWS for one, other in combinations(FACTORS, 2)}
    for one, other in combinations(FACTORS, 2):
        for a in FACTORS[one]:
            for b in FACTORS[other]:
                excluded = covering.pair(one, a, other, b) in EXCLUDED
                assert (((one, a), (other, b)) in met) != excluded, (one, a, other, b)
    assert all(row[name] in FACTORS[name] for row in ROWS for name in FACTORS)


def test_an_array_is_small_and_the_same_again() -> None:
    factors = {name: tuple("abc") for name in "stuvwxyz"}
    rows = covering.covering_array(factors)
    assert 9 <= len(rows) <= 18
    assert rows == covering.covering_array(factors)


def test_a_pair_that_no_row_can_have_is_an_error() -> None:
    factors = {"s": ("a",), "t": ("a",), "u": ("a", "b")}
    excluded = {covering.pair("s", "a", "u", level) for level in "ab"}
    with pytest.raises(ValueError, match="No row can have"):
        covering.covering_array(factors, excluded)


# Pictures


@rows_of()
def test_ids_are_right(number: int) -> None:
    frame = frame_of(number)
    assert (frame.ids >= 0).mean() > 0.02
    wrong, unexplained = rounding.unexplained_ids(
        view_of(number), frame, reach(number), shows_nearest(number)
    )
    assert unexplained == 0
    assert wrong <= ROUNDED * frame.ids.size


@rows_of("none")
def test_without_antialiasing_a_pixel_is_the_composite_at_its_centre(number: int) -> None:
    frame = frame_of(number)
    wrong, unexplained = rounding.unexplained_colors(
        view_of(number), frame, overlay_of(number), reach(number), STEPS[ROWS[number]["index"]],
        shows_nearest(number),
    )  # fmt: skip
    assert unexplained == 0
    assert wrong <= ROUNDED * frame.ids.size


@rows_of("ssaa", "msaa")
def test_a_pixel_is_the_mean_of_its_samples(number: int) -> None:
    overlay = overlay_of(number)
    wrong, unexplained = rounding.unexplained_means(
        view_of(number), overlay, PLACES, reach(number), MEAN_STEPS[ROWS[number]["index"]],
        shows_nearest(number),
    )  # fmt: skip
    assert unexplained == 0
    assert wrong <= ROUNDED * overlay[..., 0].size


@rows_of("coverage", "thoeny")
def test_coverage_is_the_mean_over_the_pixel(number: int) -> None:
    crop, expected, ignored = truth(number)
    got = overlay_of(number)[crop[1] : crop[3], crop[0] : crop[2]]
    found = ref.compare_overlay(got, expected, ignore=ignored)
    bounds = COVERAGE[ROWS[number]["index"], ROWS[number]["antialias"]]
    assert found.partial >= 50
    assert found.rms <= bounds.rms, found
    assert found.p99 <= bounds.p99, found
    assert found.leak <= bounds.leak, found


@rows_of("coverage", "thoeny")
def test_near_pictures_of_the_grid_are_drawn_cell_by_cell(number: int) -> None:
    row = ROWS[number]
    if row["index"] == "grid":
        fresh = dg.Renderer(terrain_error=0.0, coverage=row["antialias"].replace("coverage", "exact"))
        variants = judge.draw(fresh, view_of(number), "coverage").stats.variants
        assert any("LEVELS" in variant for variant in variants) == (row["camera"] == "far")


@rows_of("fxaa")
def test_fxaa_smooths_edges_alone(number: int) -> None:
    view = view_of(number)
    bare = view._replace(scene=shapes.repainted(view.scene, judge.BLACK))
    hard, soft = (judge.draw(renderer_of(number), bare, mode).image for mode in ("none", "fxaa"))
    even = judge.eroded(np.ones(hard.shape[:2], dtype=np.bool_), 1)
    for y, x in ((0, 1), (1, 0), (1, 1), (1, -1)):
        for sign in (1, -1):
            even &= (hard == np.roll(hard, (sign * y, sign * x), axis=(0, 1))).all(axis=-1)
    assert even.mean() > 0.2
    np.testing.assert_array_equal(soft[even], hard[even])
    (x0, y0, x1, y1), expected, ignored = truth(number)
    edges = expected.varied & ~ignored
    assert edges.sum() >= 50
    rms = [
        np.sqrt(((one[y0:y1, x0:x1, :3] / 255 - expected.rgba[..., :3])[edges] ** 2).mean())
        for one in (hard, soft)
    ]
    assert rms[1] <= rms[0]
