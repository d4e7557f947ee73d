"""The factors of Zechmeister 2020, table 5.4: what grows, through which values, and what the thesis saw.

Disagreements have their reasons here, by factor, way and column; the report shows those that a run comes upon. What
they say was counted on the maps of the quick report: pieces, longest lists and bytes of both values (`Renderer.update`,
`frame.stats`), and times of opaque lines beside translucent ones.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg

from . import derive, views
from .case_studies import build

if TYPE_CHECKING:
    from collections.abc import Callable

    from .part import Context

COLUMNS = {"memory_bytes": "memory", "update_ms": "update", "render_ms": "render"}


@dataclass(frozen=True)
class Case:
    """What is prepared and drawn for one value of a factor."""

    scene: dg.Scene
    camera: dg.Camera
    size: tuple[int, int]
    renderer: dict[str, Any] = field(default_factory=dict)
    antialias: str = "none"


@dataclass(frozen=True)
class Factor:
    """A row of table 5.4.

    thesis: its signs of memory, update and render, a point for none. few: the values of quick reports.
    """

    name: str
    decals: str
    figure: str
    thesis: str
    values: tuple[Any, ...]
    ways: dict[str, Callable[[Maps, Any], Case]]
    few: tuple[Any, ...] = ()
    tiny: bool = False

    @property
    def signs(self) -> tuple[str, ...]:
        """Those of the thesis, an empty text for none."""
        return tuple(sign.strip(".") for sign in self.thesis)

    def __post_init__(self) -> None:
        if not self.few:
            object.__setattr__(self, "few", (self.values[0], self.values[-1]))


class Maps:
    """The scenes that factors are measured on: slices of height and isolines, whole or in parts."""

    def __init__(self, context: Context) -> None:
        # Large enough that drawing static lines alone takes several of the milliseconds from which on signs count.
        self.size = context.chosen((32, 18), (192, 108), (640, 360))
        self._map = build("floods", context.step)

    @functools.cached_property
    def cameras(self) -> dict[str, dg.Camera]:
        """The views of the report."""
        return views.views(self._map)

    @property
    def ground(self) -> dg.Terrain:
        """Below everything."""
        return self._map.ground

    @property
    def nothing(self) -> dg.Camera:
        """Onto a corner of the ground that nothing lies on where the data is shrunk."""
        x0, y0, x1, _ = self.ground.bounds
        step = 0.02 * (x1 - x0)
        return dg.Camera.top_down((x0, y0, x0 + step, y0 + step))

    @property
    def line_width(self) -> float:
        """Metres."""
        return 0.3 * self.ground.dx

    @functools.cached_property
    def polygons(self) -> dg.FeatureTable:
        """The slices."""
        table: dg.FeatureTable = self._map.parts[0].data
        return table

    @functools.cached_property
    def lines(self) -> dg.FeatureTable:
        """The isolines."""
        table: dg.FeatureTable = self._map.parts[1].data
        return table

    def part(self, table: dg.FeatureTable, share: float) -> dg.FeatureTable:
        """A share of the features, scattered over all of them."""
        return derive.chosen(table, np.random.default_rng(1).random(len(table)) < share)

    def shrunk(self, table: dg.FeatureTable, share: float) -> dg.FeatureTable:
        """All features on a smaller part of the map."""
        x0, y0, x1, y1 = self.ground.bounds
        middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
        coords = middle + share * (table.coords - middle)
        return dg.FeatureTable(table.kind, coords, table.part_offsets, table.feature_offsets, table.rows)


def _static(
    index: Any, draw: Callable[[Maps, Any], tuple[dg.Scene, dg.Camera]]
) -> Callable[[Maps, Any], Case]:
    def case(maps: Maps, value: Any) -> Case:
        scene, camera = draw(maps, value)
        return Case(scene, camera, maps.size, {"index": index})

    return case


def _both(draw: Callable[[Maps, Any], tuple[dg.Scene, dg.Camera]]) -> dict[str, Callable[[Maps, Any], Case]]:
    return {"published": _static("bvh", draw), "ours": _static("grid", draw)}


def scene_of(maps: Maps, polygons: Any = None, lines: Any = None, **looks: Any) -> dg.Scene:
    """Polygons and lines of the maps; looks: of lines."""
    scene = dg.Scene(maps.ground)
    if polygons is not None:
        scene.add_polygons(polygons, color="#7fb2dd", technique="static")
    if lines is not None:
        scene.add_lines(
            lines,
            **{
                "color": "#7a5a36",
                "width": maps.line_width,
                "width_units": "m",
                "technique": "static",
                **looks,
            },
        )
    return scene


def _complexity(maps: Maps, share: float) -> tuple[dg.Scene, dg.Camera]:
    return scene_of(maps, maps.part(maps.polygons, share), maps.part(maps.lines, share)), maps.cameras[
        "oblique"
    ]


def _distribution(maps: Maps, share: float) -> tuple[dg.Scene, dg.Camera]:
    """The camera follows, so that the same pixels are covered."""
    x0, y0, x1, y1 = maps.ground.bounds
    middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
    half = 0.5 * share * np.array([x1 - x0, y1 - y0])
    camera = dg.Camera.top_down((*(middle - half), *(middle + half)))
    return scene_of(maps, maps.shrunk(maps.polygons, share), maps.shrunk(maps.lines, share)), camera


def _zoom(maps: Maps, nearer: float) -> dg.Camera:
    target = maps.cameras["close"].target
    wide = maps.ground.bounds[2] - maps.ground.bounds[0]
    return dg.Camera.orbit(target, wide / nearer, azimuth=200, elevation=50)


def _static_zoom(maps: Maps, nearer: float) -> tuple[dg.Scene, dg.Camera]:
    return scene_of(maps, maps.polygons, maps.lines), _zoom(maps, nearer)


def _kinds(maps: Maps, what: str) -> tuple[dg.Scene, dg.Camera]:
    polygons = derive.without_holes(maps.polygons) if what == "exterior rings" else maps.polygons
    return scene_of(maps, polygons, maps.lines if what == "and lines" else None), maps.cameras["oblique"]


def _turned(maps: Maps, where: str) -> tuple[dg.Scene, dg.Camera]:
    """At the map, or at a corner of the ground that nothing lies on."""
    halves = (maps.polygons, maps.lines)
    shrunk = (maps.shrunk(table, 0.9) for table in halves)
    return scene_of(maps, *shrunk), maps.cameras["overview"] if where == "in view" else maps.nothing


def _samples(index: str) -> Callable[[Maps, int], Case]:
    def case(maps: Maps, samples: int) -> Case:
        scene = scene_of(maps, maps.polygons, maps.lines)
        mode = "none" if samples == 1 else "ssaa"
        return Case(scene, maps.cameras["oblique"], maps.size, {"index": index, "samples": samples}, mode)

    return case


def _index(parameter: str, with_lines: bool) -> Callable[[Maps, int], Case]:
    def case(maps: Maps, value: int) -> Case:
        scene = scene_of(maps, maps.polygons, maps.lines if with_lines else None)
        index = dg.BvhIndex(**{parameter: value})  # type: ignore[arg-type]
        return Case(scene, maps.cameras["oblique"], maps.size, {"index": index})

    return case


def _line_looks(name: str) -> Callable[[Maps, Any], tuple[dg.Scene, dg.Camera]]:
    def draw(maps: Maps, value: Any) -> tuple[dg.Scene, dg.Camera]:
        looks = {
            "width": {"width": maps.line_width * (value if name == "width" else 4)},
            "alpha": {"width": maps.line_width * 4, "alpha": value},
            "corner": {"width": maps.line_width * 4, "corner": value},
        }[name]
        return scene_of(maps, None, maps.lines, **looks), maps.cameras["oblique"]

    return draw


def _dynamic(
    look: Callable[[Maps, Any], tuple[dict[str, Any], dg.Camera, tuple[int, int]]],
) -> dict[str, Callable[[Maps, Any], Case]]:
    def way(method: Any) -> Callable[[Maps, Any], Case]:
        def case(maps: Maps, value: Any) -> Case:
            looks, camera, size = look(maps, value)
            looks = {"width": 2.0, "width_units": "px", **looks, "technique": dg.Dynamic(method=method)}
            return Case(scene_of(maps, None, maps.lines, **looks), camera, size)

        return case

    return {"published": way("lists"), "ours": way("bins")}


def _larger(maps: Maps, times: float) -> tuple[dict[str, Any], dg.Camera, tuple[int, int]]:
    width, height = maps.size
    return {}, maps.cameras["oblique"], (round(width * times), round(height * times))


FACTORS = (
    Factor(
        "data complexity", "all decals", "Figure 5.5", "+++", (0.25, 0.5, 1.0), _both(_complexity), tiny=True
    ),
    Factor("data distribution", "all decals", "Section 5.3", ".––", (0.1, 0.3, 1.0), _both(_distribution)),
    Factor(
        "anti-aliasing (samples)",
        "all decals",
        "Figure 5.9",
        "..+",
        (1, 2, 4, 8),
        {"published": _samples("bvh"), "ours": _samples("grid")},
    ),
    Factor(
        "kinds of decals",
        "all decals",
        "Figure 5.6",
        "+++",
        ("exterior rings", "interior rings too", "and lines"),
        _both(_kinds),
    ),
    Factor("leaving the view", "all decals", "Figure 5.7", "..–", ("in view", "out of view"), _both(_turned)),
    Factor("zooming in", "static decals", "Figure 5.8", "..–", (1, 4, 16), _both(_static_zoom)),
    Factor(
        "grid resolution",
        "static decals",
        "Figure 5.10",
        "++–",
        (125, 250, 500, 1000),
        {"published": _index("cells", with_lines=True)},
        few=(64, 250),
        tiny=True,
    ),
    Factor(
        "leaf capacity",
        "polygons",
        "Figure 5.12",
        "––+",
        (2, 8, 32, 128),
        {"published": _index("leaf_capacity", with_lines=False)},
    ),
    Factor(
        "quad-tree depth",
        "polygons",
        "Figure 5.13",
        "++–",
        (2, 4, 8, 16),
        {"published": _index("depth_limit", with_lines=False)},
    ),
    Factor("width", "static lines", "Figure 5.14", "+~+", (1, 4, 16), _both(_line_looks("width"))),
    Factor(
        "transparency", "static lines", "Figure 5.14", "..+", (1.0, 0.5, 0.25), _both(_line_looks("alpha"))
    ),
    Factor(
        "corner style",
        "static lines",
        "Figure 5.16",
        "+~+",
        ("round", "miter", "bevel"),
        _both(_line_looks("corner")),
    ),
    Factor(
        "zooming in",
        "dynamic lines",
        "Figure 5.8",
        "..–",
        (1, 4, 16),
        _dynamic(lambda maps, nearer: ({}, _zoom(maps, nearer), maps.size)),
    ),
    Factor(
        "width",
        "dynamic lines",
        "Figure 5.15",
        "+.+",
        (1.0, 2.0, 4.0, 8.0),
        _dynamic(lambda maps, width: ({"width": width}, maps.cameras["oblique"], maps.size)),
        few=(1.0, 4.0),
    ),
    Factor(
        "transparency",
        "dynamic lines",
        "Figure 5.15",
        "..+",
        (1.0, 0.5, 0.25),
        _dynamic(lambda maps, alpha: ({"alpha": alpha}, maps.cameras["oblique"], maps.size)),
    ),
    Factor(
        "corner style",
        "dynamic lines",
        "Figure 5.16",
        "..+",
        ("round", "miter", "bevel"),
        _dynamic(lambda maps, corner: ({"corner": corner}, maps.cameras["oblique"], maps.size)),
    ),
    Factor("image resolution", "dynamic lines", "Figure 5.17", "+.+", (0.5, 1.0, 2.0), _dynamic(_larger)),
)

_WITHIN = "Both are prepared so soon that they differ by less than the 5 ms from which on a sign counts."
_GROWTH = "A pixel looks into one cell: the longest list grows by a third at most, references threefold to fivefold."
_BUCKETS = (
    "Cells are made bucket by bucket: crowded data lies in fewer buckets, which hold a twelfth of the cells."
)
_BUFFERS = "Buffers hold the segments that the view shows, a fortieth of them from the nearest place."
_SUBTREES = (
    "Cells refer to subtrees, and to none where all is outside. Large leaves and shallow trees leave more cells with a"
    " reference, two and a half and one and a half times as many, which outweighs the smaller quad-trees."
)
_CELLS = (
    "A line sixteen times as wide has sixteen times the references in the thesis's grid, four times in ours."
)
_CAPS = "Corners are not stored. Round ones reach farther: a bevelled line has a third fewer references."
# (factor, decals, column): of both ways or of one.
_SHARED = {
    ("data complexity", "all decals", "update_ms"): _WITHIN,
    ("kinds of decals", "all decals", "update_ms"): _WITHIN,
    ("width", "static lines", "update_ms"): _CELLS,
    ("zooming in", "dynamic lines", "memory_bytes"): _BUFFERS,
}
_PUBLISHED = {
    ("data distribution", "all decals", "memory_bytes"): (
        "Lines stay as wide in metres: on a map a tenth as large they have eight times the references."
    ),
    ("data distribution", "all decals", "update_ms"): (
        "It falls by a sixth, as references do; a sign counts from a quarter on."
    ),
    ("data distribution", "all decals", "render_ms"): (
        "The same pixels are covered, and walks grow with the logarithm of what a cell holds: 43 to 41 ms."
    ),
    ("zooming in", "static decals", "render_ms"): (
        "From afar half the picture sees ground, from nearby all of it: a pixel of ground takes a third as long."
    ),
    ("grid resolution", "static decals", "update_ms"): _WITHIN,
    ("grid resolution", "static decals", "render_ms"): (
        "Rings are searched in quad-trees, which are the same whatever the grid; the longest list shrinks by a fifth."
    ),
    ("leaf capacity", "polygons", "memory_bytes"): _SUBTREES,
    ("leaf capacity", "polygons", "update_ms"): (
        "It falls, by two fifths of the processor's time, but as time on the clock by less than its spread."
    ),
    ("quad-tree depth", "polygons", "memory_bytes"): _SUBTREES,
    ("quad-tree depth", "polygons", "update_ms"): (
        "Cells are decided by the leaves that they meet: at depth 2 the fullest has 1,610 edges, at depth 16 97."
    ),
    (
        "transparency",
        "static lines",
        "render_ms",
    ): "No two of these isolines lie over each other at any pixel.",
    ("transparency", "dynamic lines", "render_ms"): (
        "All segments that cover a pixel are in its list whatever their opacity, and filling lists takes the time."
    ),
    ("corner style", "static lines", "memory_bytes"): _CAPS,
    ("corner style", "static lines", "render_ms"): _CAPS,
    ("corner style", "static lines", "update_ms"): (
        "Outlines of corners that are not round depend on the segments before and after; those of round ones do not."
    ),
    ("corner style", "dynamic lines", "render_ms"): (
        "It grows by a third, less than four times its spread: lists of all segments nearby are filled either way."
    ),
    ("corner style", "dynamic lines", "memory_bytes"): (
        "A list has each segment that covers the pixel: with round ends, short ones cover their neighbours' pixels too,"
        " and the lists have five times the entries."
    ),
}
_OURS = {
    ("data complexity", "all decals", "render_ms"): _GROWTH,
    ("kinds of decals", "all decals", "render_ms"): _GROWTH,
    ("zooming in", "static decals", "render_ms"): (
        "From afar half the picture sees ground, from nearby all of it: a pixel of ground takes half as long."
    ),
    ("data distribution", "all decals", "memory_bytes"): _BUCKETS,
    ("data distribution", "all decals", "update_ms"): (
        "About as many pieces are cut, since cells are as fine as the data is dense: 58 to 66 ms."
    ),
    ("data distribution", "all decals", "render_ms"): (
        "The same pixels are covered, and lists stay as short, since cells are as fine as the data is dense."
    ),
    ("width", "static lines", "render_ms"): (
        "Opaque lines end the walk: as wide but translucent ones take four times as long."
    ),
    ("corner style", "static lines", "memory_bytes"): (
        "Corners are not stored here: one is found between two edges that follow each other in a list."
    ),
}
REASONS: dict[tuple[str, str, str, str], str] = {
    (name, decals, way, column): why
    for way, own in (("published", _PUBLISHED), ("ours", _OURS))
    for (name, decals, column), why in {**_SHARED, **own}.items()
}
