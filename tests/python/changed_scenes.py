"""Scenes of overlapping areas and ways that tests restyle, look at through lenses and edit."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import geopandas
import numpy as np
import pytest
from shapely import LineString, Polygon

import decalgl as dg
from small_scenes import OBLIQUE, SIZE, hilly_scene

BOTH = pytest.mark.parametrize("antialias", ["none", "coverage"])
INDEXES = pytest.mark.parametrize("index", ["grid", "bvh"])
EVERY_INDEX = pytest.mark.parametrize("index", ["grid", "bvh", "thoeny"])
# Coverage draws what trees of either kind are asked for point by point, so one of them is enough.
EVERY_WAY = pytest.mark.parametrize(
    ("index", "antialias"), [*itertools.product(["grid", "bvh"], ["none", "coverage"]), ("thoeny", "none")]
)
KINDS = ["a", "b", "c"]


def some_areas(count: int = 40) -> geopandas.GeoDataFrame:
    """Overlapping triangles with a kind and a number."""
    random = np.random.default_rng(5)
    corners = random.uniform(-10.0, 110.0, (count, 1, 2)) + random.uniform(-15.0, 15.0, (count, 3, 2))
    return geopandas.GeoDataFrame(
        {"kind": [KINDS[i % 3] for i in range(count)], "number": np.arange(count)},
        geometry=[Polygon(triangle) for triangle in corners],
    )


def some_ways(count: int = 30) -> geopandas.GeoDataFrame:
    """Lines of several segments with a kind and a number."""
    random = np.random.default_rng(6)
    return geopandas.GeoDataFrame(
        {"kind": [KINDS[i % 3] for i in range(count)], "number": np.arange(count)},
        geometry=[LineString(random.uniform(0.0, 100.0, (4, 2))) for _ in range(count)],
    )


def scene_of(
    areas: dict[str, Any], ways: dict[str, Any], widest: float = 0.0, south: float = 1000.0
) -> dg.Scene:
    """A hill with areas and ways, as the keywords say."""
    scene = hilly_scene(south)
    scene.add_polygons(some_areas(), **{"name": "areas", **areas})
    layer = scene.add_lines(some_ways(), **{"name": "ways", "width": 2.0, "width_units": "m", **ways})
    assert layer.stroke is not None
    scene._layers[1] = replace(layer, stroke=replace(layer.stroke, widest=widest))
    return scene


def prepared(scene: dg.Scene, antialias: str = "none", **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(SIZE, antialias, **options)
    renderer.preprocess(scene)
    renderer.update(OBLIQUE)
    return renderer


def assert_same(one: dg.Frame, other: dg.Frame) -> None:
    np.testing.assert_array_equal(one.image, other.image)
    np.testing.assert_array_equal(one.ids, other.ids)
    np.testing.assert_array_equal(one.layers, other.layers)


# How far two pictures by coverage of one map may be apart that come from indexes made otherwise: each is good to 0.02.
TWO_COVERAGES = 2 * 0.02 * 255


def picks(frame: dg.Frame) -> list[list[tuple[int, int]]]:
    """What lies under some pixels, as layers' places and rows."""
    return [
        [(one.layer.index, one.row) for one in frame.pick(x, y)]
        for x in range(3, SIZE[0], 14)
        for y in range(3, SIZE[1], 14)
    ]


PLAIN: dict[str, Any] = {"color": "tan"}
RESTYLES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "a colour": ({"color": "green"}, {"color": "green"}),
    "a colour of each": ({"color": ["red", "blue"] * 20}, {"color": ["red", "blue"] * 20}),
    "a translucent colour": ({"color": (0.2, 0.4, 0.6, 0.5)}, {"color": (0.2, 0.4, 0.6, 0.5)}),
    "opacity": ({"opacity": 0.25}, {"color": "tan", "alpha": 0.25}),
    "alpha": ({"alpha": 0.25}, {"color": "tan", "alpha": 0.25}),
    "a column of numbers": (
        {"column": "number", "cmap": "magma", "vmax": 50},
        {"column": "number", "cmap": "magma", "vmax": 50},
    ),
    "categories": ({"column": "kind", "cmap": "Set1"}, {"column": "kind", "cmap": "Set1"}),
    "hidden": ({"visible": False}, {"color": "none"}),
    "filtered": (
        {"visible": "kind == 'a' or number > 30"},
        {"color": ["tan" if i % 3 == 0 or i > 30 else "none" for i in range(40)]},
    ),
    "some of them": (
        {"color": "red", "where": "number < 10"},
        {"color": ["red" if i < 10 else "tan" for i in range(40)]},
    ),
    "order by size": (
        {"order": "size", "column": "kind"},
        {"order": "size", "column": "kind"},
    ),
    "order by numbers": (
        {"order": -np.arange(40.0), "column": "kind"},
        {"order": -np.arange(40.0), "column": "kind"},
    ),
}


FAR = dg.Camera.top_down((-2000.0, -2000.0, 2100.0, 2100.0))
