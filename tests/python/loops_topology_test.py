"""LOOPS: borders of simplified features neither cross nor open, counted by shapely, in any order of removal."""

from __future__ import annotations

import functools
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

import decalgl as dg
import scenes
import shapes
from decalgl.bench import topology
from decalgl.features import read_features
from small_scenes import BOUNDS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]


@functools.cache
def land_cover() -> Any:
    """Real land cover of a part of Honolulu, every border of which is shared."""
    layer = scenes.build("honolulu").scene.layers[0]
    return layer.features


@pytest.mark.parametrize(
    ("order", "levels"), [("douglas_peucker", 10), ("wang_mueller", 4), ("visvalingam_whyatt", 4)]
)
def test_real_borders_neither_cross_nor_open(order: str, levels: int) -> None:
    tolerances = list(np.geomspace(2.0, 20000.0, levels))
    counts = list(topology.counts_of(land_cover(), order, tolerances))
    assert [(each.crossings, each.openings) for each in counts] == [(0, 0)] * (levels + 1)
    assert counts[-1].edges < 0.2 * counts[0].edges


def test_crossings_and_openings_are_counted() -> None:
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    beside = np.array([[4.0, 0.0], [8.0, 0.0], [8.0, 4.0], [4.0, 4.0], [4.0, 2.0]])
    edges = topology.edges_of(np.concatenate([square, beside]), np.array([0, 4, 9]))
    rim = topology.odd_edges(topology.edges_of(np.concatenate([square, beside[:4]]), np.array([0, 4, 8])))
    # One side is split and the other is not: it is open there, and lies along it.
    assert topology.count_openings(edges, rim.reshape(-1, 2)) == 2
    assert topology.count_crossings(edges) == 2
    crossing = np.array([[0.0, 0.0, 2.0, 2.0], [0.0, 2.0, 2.0, 0.0], [2.0, 0.0, 2.0, 2.0]])
    assert topology.count_crossings(crossing) == 1


def test_partitions_stay_partitions() -> None:
    cells = shapes.partition(BOUNDS, 9, 8, seed=2)
    assert all(shapely.is_valid(cells))
    features = read_features(cells, "polygons", terrain_crs=None, layer_name="cells")[0]
    tolerances = [0.0, 0.5, 1.5, 100.0]
    for order in ("douglas_peucker", "wang_mueller", "visvalingam_whyatt"):
        fewer = len(features.coords) + 1
        for coords, parts, owners in dg.Loops(order=order).simplified(features, tolerances):
            rings = [shapely.Polygon(coords[a:b]) for a, b in itertools.pairwise(parts)]
            assert len(rings) == len(cells)
            assert list(owners) == list(range(len(cells) + 1))
            assert all(shapely.is_valid(rings))
            whole = shapely.union_all(rings)
            assert shapely.area(rings).sum() == pytest.approx(whole.area, rel=1e-9)
            assert whole.geom_type == "Polygon"
            assert len(whole.interiors) == 0
            assert len(coords) < fewer
            fewer = len(coords)


def test_a_function_gives_the_order() -> None:
    ring = shapes.rough_ring(3, 50.0, 50.0, 30.0)

    def by_index(arc: FloatArray) -> tuple[Any, Any]:
        indices = np.arange(1, len(arc) - 1)
        return indices, indices.astype(float)

    def fails(_: FloatArray) -> tuple[Any, Any]:
        raise ZeroDivisionError

    features = read_features([ring], "polygons", terrain_crs=None, layer_name="ring")[0]
    full, half, none = dg.Loops(order=by_index).simplified(features, [0.0, 200.5, 1e6])
    assert len(full[0]) == 400
    assert 100 < len(half[0]) < 300
    assert len(none[0]) == 0
    with pytest.raises(dg.InputError, match="each vertex"):
        dg.Loops(order=lambda _: ([1], [0.0])).simplified(features, [0.0])
    with pytest.raises(ZeroDivisionError):
        dg.Loops(order=fails).simplified(features, [0.0])
