"""What networks by distance fields cost: Trapp et al. 2015, table 2 and section 5.4, on roads of OpenStreetMap.

sets     a picture with several style sets, a category each ÷ one with one
drawn    the same beside static lines of the same looks
memory   bytes of the fields ÷ categories x width x height x targets x bytes of a texel

The whole network is in view, on level ground, as in the paper, in pictures of its three sizes. Where there are no
towns, streets at random stand in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

import decalgl as dg
from decalgl.road_styles import CLASSES, COLORS, road_classes

from ..measure import draw, interleaved
from ..workload import town_file

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..measure import Measure, Times
    from ..records import Records
    from ..workload import Workload

    Network = tuple[NDArray[np.object_], NDArray[np.int64]]

SETS = (1, 2, 4, 8)
PICTURES = ((390, 260), (670, 450), (1280, 800))  # of the paper's table 2
BITS = (8, 32)


def measure(work: Workload, records: Records) -> None:
    networks = {town: _roads(town) for town in work.towns} or {"streets": _streets()}
    for name, network in networks.items():
        camera = dg.Camera.top_down(_bounds(network))
        for size in PICTURES if work.towns else (work.picture,):
            work.say(f"{name}, {size[0]} x {size[1]}")
            _measure_sets(work, records, name, network, camera, size)
        _measure_memory(work, records, name, network, camera)


def _measure_sets(
    work: Workload, records: Records, name: str, network: Network, camera: dg.Camera, size: tuple[int, int]
) -> None:
    scenes = {str(sets): _scene(network, sets) for sets in SETS} | {"static": _scene(network, SETS[-1], True)}
    renderers = {key: dg.Renderer(size=size, antialias="none") for key in scenes}
    for key, scene in scenes.items():
        renderers[key].preprocess(scene)
    times = interleaved(work.runs, *(_drawing(one, camera, key) for key, one in renderers.items()))
    for sets in SETS:
        found = records.at(f"{name}, {size[0]} x {size[1]}, sets: {sets}", "plan", "distance_field")
        found.update(
            town=name,
            picture=f"{size[0]} x {size[1]}",
            style_sets=sets,
            segments=_segments(network),
            sets_ms=times[f"{sets}_ms"],
            sets=times[f"{sets}_ms"] / times["1_ms"],
            static_ms=times["static_ms"],
            drawn=times[f"{sets}_ms"] / times["static_ms"],
        )


def _measure_memory(work: Workload, records: Records, name: str, network: Network, camera: dg.Camera) -> None:
    for bits in BITS:
        renderer = dg.Renderer(size=work.picture, antialias="none")
        renderer.preprocess(_scene(network, SETS[-1], bits=bits, keep_depth=True, dash=True))
        objects = draw(renderer, camera, "none").stats.to_dict()["objects"]
        targets = ("cross distances", "lengths", "depths")
        taken = sum(objects[f"distance_field: {target}"] for target in targets)
        stored = sum(objects[f"distance_field: {buffer}"] for buffer in ("nodes", "segments"))
        expected = SETS[-1] * work.picture[0] * work.picture[1] * len(targets) * bits // 8
        records.at(f"{name}, {bits} bits", "plan", "distance_field").update(
            town=name,
            bits=bits,
            segments=_segments(network),
            field_bytes=taken,
            field_memory=taken / expected,
            bytes_per_segment_stored=stored / _segments(network),
        )


def _drawing(renderer: dg.Renderer, camera: dg.Camera, name: str) -> Measure:
    def measure() -> Times:
        passes = draw(renderer, camera, "none").stats.passes
        return {f"{name}_ms": sum(one["ms"] for one in passes if one["name"] in ("distance_field", "static"))}

    return measure


def _scene(
    network: Network,
    sets: int,
    as_static: bool = False,
    bits: int = 8,
    keep_depth: bool = False,
    dash: bool = False,
) -> dg.Scene:
    """The roads in so many style sets of as many roads, by their rank."""
    lines, ranks = network
    category = np.empty(len(lines), dtype=np.int64)
    category[np.argsort(ranks, kind="stable")] = np.arange(len(lines)) * sets // len(lines)
    names = list(CLASSES)
    looks = [names[place * len(CLASSES) // sets] for place in range(sets)]
    colors = [COLORS["germany"][look][0] for look in looks]
    widths = [CLASSES[look][0] + place for place, look in enumerate(looks)]
    scene = dg.Scene(dg.Terrain.flat(_bounds(network)))
    if as_static:
        own: dict[str, Any] = {"width": np.take(widths, category), "color": np.take(colors, category)}
        scene.add_lines(lines, **own, width_units="m", technique="static")
        return scene
    styles = {
        place: dg.NetworkCategory(dg.NetworkStyle(width, color, "black"), dash=(20.0, 10.0) if dash else None)
        for place, (width, color) in enumerate(zip(widths, colors, strict=True))
    }
    options: dict[str, Any] = {"bits": bits, "keep_depth": keep_depth}
    scene.add_lines(lines, technique=dg.DistanceField(category=category, styles=styles, **options))
    return scene


def _roads(town: str) -> Network:
    """A town's roads in metres, and the rank of each."""
    import pyogrio

    roads = pyogrio.read_dataframe(town_file(town), layer="lines", columns=["highway"])
    roads["class"] = road_classes(roads["highway"])
    roads = roads[roads["class"].notna()]
    roads = roads.to_crs(roads.estimate_utm_crs())
    places = {name: place for place, name in enumerate(CLASSES)}
    return roads.geometry.to_numpy(), roads["class"].map(places).to_numpy(dtype=np.int64)


def _streets() -> Network:
    generator = np.random.default_rng(9)
    starts = generator.uniform(0.0, 1000.0, (60, 1, 2))
    steps = generator.normal(0.0, 60.0, (60, 8, 2))
    lines = np.asarray(shapely.linestrings(starts + np.cumsum(steps, axis=1)))
    return lines, np.arange(60, dtype=np.int64) % len(CLASSES)


def _bounds(network: Network) -> tuple[float, float, float, float]:
    x0, y0, x1, y1 = shapely.total_bounds(network[0])
    return float(x0), float(y0), float(x1), float(y1)


def _segments(network: Network) -> int:
    return int(shapely.get_num_coordinates(network[0]).sum()) - len(network[0])
