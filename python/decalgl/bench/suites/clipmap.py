"""Clipmap textures, solution by solution: Taibo et al. 2014, sections 5.1 to 5.3, figures 10 to 12, on three line sets.

memory      bytes of what tiles are drawn from
generate    milliseconds of preparing, the terrain apart
width       milliseconds of another width: a restyle, and what is uploaded for it
tiles       milliseconds of drawing all tiles of a view anew, by both strategies as algorithm 2 combines them
wide, thin  the same by the solution's own strategy alone, and as thin lines alone
picture     milliseconds of the view once its tiles are there, in half of the picture's size along each side

The roads of a town, isolines, and a coast; where there are no towns, isolines alone.
"""

from __future__ import annotations

import statistics
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

import decalgl as dg

from .. import cameras
from ..measure import draw, timed
from ..workload import LINE_WIDTH, coast_file, line_table, roads

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload

# Solutions of section 4, and solutions 2 and 4b by other methods of the joints.
WAYS: dict[str, dict[str, Any]] = {
    "1": {"solution": "1"},
    "2, method 1": {"solution": "2", "joints": "1"},
    "2, method 2": {"solution": "2", "bevel_below": 10.0},
    "2, method 3a": {"solution": "2", "joints": "3a"},
    "2, method 3b": {"solution": "2"},
    "3a": {"solution": "3a"},
    "3b": {"solution": "3b"},
    "4a": {"solution": "4a"},
    "4b": {"solution": "4b"},
    "4b, method 1": {"solution": "4b", "joints": "1"},
    "4b, method 3a": {"solution": "4b", "joints": "3a"},
    "4b polar": {"solution": "4b polar"},
}
# Solutions 1 and 2 have one strategy.
COMBINED = ("3a", "3b", "4a", "4b", "4b, method 3a", "4b polar")
# Texels below which lines are thin: none, or all.
ALONE = {"wide": 0.0, "thin": 1000.0}
WIDTHS = (LINE_WIDTH, 2.0 * LINE_WIDTH)
VIEW = "oblique"
# Of Norway, degrees: west, south, east, north.
COAST = (4.0, 58.0, 16.0, 69.0)


def measure(work: Workload, records: Records) -> None:
    for name, scene_of in _line_sets(work).items():
        for way, options in WAYS.items():
            work.say(f"{name}, solution {way}")
            drawing = _Drawing(work, scene_of(dg.Clipmap(**options)))
            found = {**drawing.prepared(), **drawing.changes(), **drawing.picture()}
            for strategy, below in ALONE.items() if way in COMBINED else ():
                alone = _Drawing(work, scene_of(dg.Clipmap(**options, thin_below=below)))
                found[f"{strategy}_ms"] = alone.changes()["tiles_ms"]
            records.at(name, VIEW, f"clipmap {way}").update(way=way, **found)


def _line_sets(work: Workload) -> dict[str, Any]:
    """By name, what makes a scene of the lines with a technique."""
    isolines = line_table(work.contours("isolines", next(iter(work.sizes))))
    sets: dict[str, tuple[dg.Terrain, Any]] = {"isolines": (work.ground, isolines)}
    if work.towns:
        flat = {"roads of Helsinki": roads("helsinki")[0], "coast of Norway": _coast()}
        sets.update({name: (dg.Terrain.flat(_bounds(lines)), lines) for name, lines in flat.items()})

    def making(ground: dg.Terrain, lines: Any) -> Any:
        def scene_of(technique: dg.Technique) -> dg.Scene:
            scene = dg.Scene(ground)
            scene.add_lines(lines, name="lines", width=WIDTHS[0], width_units="m", technique=technique)
            return scene

        return scene_of

    return {name: making(*one) for name, one in sets.items()}


class _Drawing:
    """A renderer that has prepared the lines, and drawn its view once."""

    def __init__(self, work: Workload, scene: dg.Scene) -> None:
        width, height = work.picture
        self._runs = work.runs
        self._renderer = dg.Renderer(size=(width // 2, height // 2), antialias="none")
        self._renderer.preprocess(scene)
        self._camera = cameras.fixed_views(scene.terrain)[VIEW]
        self._first = draw(self._renderer, self._camera, "none").stats.to_dict()

    def prepared(self) -> dict[str, float]:
        counts, parts = self._first["counts"], self._first["preprocess"]
        return {
            "segments": counts["segments"],
            "prepared_bytes": counts["prepared_bytes"],
            "generate_ms": sum(ms for part, ms in parts.items() if part != "terrain"),
        }

    def changes(self) -> dict[str, float]:
        """To one width and back: each time all tiles are drawn anew."""
        changes, tiles = [], []
        for turn in range(self._runs):
            changes.append(timed(partial(self._set_width, WIDTHS[1 - turn % 2])))
            tiles.append(_pass(self._renderer.render(), "clipmap tiles"))
        return {"width_ms": statistics.median(changes), "tiles_ms": statistics.median(tiles)}

    def _set_width(self, width: float) -> None:
        self._renderer.restyle("lines", width=width)
        self._renderer.update(self._camera)

    def picture(self) -> dict[str, float]:
        frames = [draw(self._renderer, self._camera, "none") for _ in range(self._runs)]
        return {"picture_ms": statistics.median(_pass(frame, "clipmap") for frame in frames)}


def _pass(frame: dg.Frame, name: str) -> float:
    return float(sum(one["ms"] for one in frame.stats.passes if one["name"] == name))


def _coast() -> Any:
    """Shores in metres, as lines."""
    import geopandas
    import pyogrio

    land = pyogrio.read_dataframe(coast_file(), bbox=COAST, columns=["level"])
    shores = shapely.clip_by_rect(shapely.boundary(land.geometry.to_numpy()), *COAST)
    lines = geopandas.GeoSeries(shores[~shapely.is_empty(shores)], crs=land.crs)
    return lines.to_crs(lines.estimate_utm_crs()).to_numpy()


def _bounds(lines: Any) -> tuple[float, float, float, float]:
    left, bottom, right, top = np.asarray(shapely.total_bounds(lines)).tolist()
    return left, bottom, right, top
