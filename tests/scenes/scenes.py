"""Scenes that tests and benchmarks share, by name: `build("hills")` is a scene, a camera and a picture size.

    ordinary    the demo's Honolulu, hills under polygons, lines and translucent layers
    extreme     far coordinates, eyes near and far, grazing views, holes, slivers, crowds, widths beyond the map

Every scene is the same on every run and every machine, up to the last digits of the C library's functions. They
are built once and kept: do not add layers to them.
"""

from __future__ import annotations

import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import decalgl as dg
from shapes import (
    add_blobs,
    add_stars,
    add_walks,
    blob,
    circle,
    flat_terrain,
    hills_terrain,
    lines,
    nested_rings,
    partition,
    rings,
    tints,
    uneven_terrain,
    walk,
    waves,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    Size = tuple[int, int]

SIZE = (640, 360)
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


class View(NamedTuple):
    """A scene, where it is seen from, and (width, height) of the picture in pixels."""

    scene: dg.Scene
    camera: dg.Camera
    size: Size


SCENES: dict[str, Callable[[], View]] = {}


def build(name: str) -> View:
    """The view of that name; `SCENES` lists them."""
    return SCENES[name]()


def _named(make: Callable[[], View]) -> Callable[[], View]:
    kept = functools.cache(make)
    SCENES[make.__name__] = kept
    return kept


@functools.cache
def hills_scene() -> dg.Scene:
    """A partition, blobs, stars and lines over hills of 2.6 x 1.7 km."""
    scene = dg.Scene(hills_terrain())
    x0, y0, x1, y1 = scene.terrain.bounds
    inner = (x0 + 0.1 * (x1 - x0), y0 + 0.1 * (y1 - y0), x1 - 0.1 * (x1 - x0), y1 - 0.1 * (y1 - y0))
    scene.add_polygons(partition(inner, 14, 11), name="partition", color=tints(14 * 11, 6))
    add_blobs(scene, 1100.0, 40)
    add_stars(scene, 1000.0, 30)
    add_walks(scene, 1000.0, 40, 6.0)
    return scene


# Ordinary scenes


def examples(name: str) -> Any:
    """A module of the examples folder."""
    if str(EXAMPLES) not in sys.path:
        sys.path.insert(0, str(EXAMPLES))
    return __import__(name)


@functools.cache
def honolulu_scene() -> dg.Scene:
    """The scene that the demo draws."""
    scene: dg.Scene = examples("demo").build_scene()
    return scene


@_named
def honolulu() -> View:
    """The demo's own view."""
    place = examples("honolulu")
    return View(honolulu_scene(), dg.Camera.look_at(place.EYE, place.TARGET, fov=place.FIELD_OF_VIEW), SIZE)


@_named
def honolulu_above() -> View:
    """Straight down on the city."""
    eye = (-5000.0, -3500.0, 6000.0)
    return View(honolulu_scene(), dg.Camera.look_at(eye, (eye[0], eye[1], 0.0), fov=40.0), SIZE)


@_named
def hills() -> View:
    """A bird's view of everything ordinary at once."""
    return View(hills_scene(), dg.Camera.orbit((0.0, -100.0, 0.0), 2200.0, 200.0, 35.0), SIZE)


@_named
def hills_orthographic() -> View:
    """The same under parallel rays, obliquely."""
    camera = dg.Camera((-900.0, -1500.0, 1400.0), (0.0, 0.0, 0.0), fov=None, view_height=1100.0)
    return View(hills_scene(), camera, SIZE)


@_named
def line_widths() -> View:
    """Lines from far below a pixel to a tenth of the map, joints and caps included."""
    scene = dg.Scene(hills_terrain(relief=60.0))
    generator = np.random.default_rng(51)
    widths = np.geomspace(120.0, 0.02, 60)
    found = [walk(generator, generator.uniform(-900, 900, 2), 50.0, 25) for _ in widths]
    found.append(np.array([(-800.0, 100.0), (800.0, 101.0), (-800.0, 102.0), (800.0, 300.0)]))  # spikes
    found.append(np.array([(-800.0, -300.0), (0.0, -300.0), (800.0, -300.0)]))  # 180 degrees
    widths = np.append(widths, [12.0, 12.0])
    scene.add_lines(lines(found), width=widths, width_units="m", color=tints(len(found), 52))
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 1500.0, 160.0, 50.0), SIZE)


@_named
def translucent() -> View:
    """Polygons and lines of alphas from 0.1 to 1, alternating: order and transparency decide every colour."""
    scene = dg.Scene(hills_terrain())
    add_blobs(scene, 1000.0, 120, (0.1, 1.0))
    add_walks(scene, 1000.0, 50, 15.0, alpha=0.4, seed=61)
    bounds = (-900.0, -600.0, 900.0, 600.0)
    scene.add_polygons(partition(bounds, 9, 7, seed=62), name="veil", color=tints(63, 63, (0.2, 0.5)))
    add_walks(scene, 1000.0, 40, 40.0, alpha=0.6, seed=64)
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 1700.0, 140.0, 45.0), SIZE)


# Views that strain positions


@_named
def grazing() -> View:
    """Just above the ground, over ridge after ridge: footprints of a hundred metres and of centimetres."""
    scene = hills_scene()
    ground = float(np.nanmax(scene.heights[170:, 90:110]))
    eye = (-280.0, -800.0, ground + 8.0)
    return View(scene, dg.Camera.look_at(eye, (60.0, 900.0, ground - 120.0), fov=35.0), SIZE)


@_named
def grazing_plain() -> View:
    """A plain under rays that all but lie in it, through a long lens."""
    scene = dg.Scene(uneven_terrain(5000.0, 2.0))
    scene.add_polygons(partition((-4000.0, -4000.0, 4000.0, 4000.0), 20, 20, seed=65), color=tints(400, 66))
    add_walks(scene, 4500.0, 60, 15.0)
    return View(scene, dg.Camera.look_at((0.0, -4900.0, 25.0), (0.0, -1500.0, 0.0), fov=2.0), SIZE)


@_named
def far_coordinates() -> View:
    """Coordinates of 10^7 m, seen from close by."""
    x, y = 10_000_003.7, -9_999_998.3
    scene = dg.Scene(uneven_terrain(200.0, 12.0, x, y))
    generator = np.random.default_rng(71)
    centre = np.array([x, y])
    found = [walk(generator, centre + generator.uniform(-60, 60, 2), 4.0, 20) for _ in range(40)]
    bounds = (x - 60.0, y - 60.0, x + 60.0, y + 60.0)
    scene.add_polygons(partition(bounds, 10, 10, seed=72), color=tints(100, 73))
    scene.add_lines(lines(found), width=0.5, width_units="m", color=tints(40, 74))
    return View(scene, dg.Camera.look_at((x - 60.0, y - 80.0, 50.0), (x, y, 0.0), fov=45.0), SIZE)


@_named
def eye_at_one_metre() -> View:
    """A metre above ground of 100 m between samples: pixels of millimetres in front, of metres behind."""
    scene = dg.Scene(uneven_terrain(1600.0, 40.0))
    ground = float(scene.heights[16, 16])
    scene.add_polygons(partition((-30.0, -30.0, 30.0, 30.0), 30, 30, seed=81), color=tints(900, 82))
    generator = np.random.default_rng(83)
    found = [walk(generator, generator.uniform(-8, 8, 2), 0.3, 40) for _ in range(60)]
    scene.add_lines(lines(found), width=0.03, width_units="m", color=tints(60, 84))
    return View(scene, dg.Camera.look_at((0.0, 0.0, ground + 1.0), (4.0, 6.0, ground - 1.0), fov=60.0), SIZE)


@_named
def eye_at_500_km() -> View:
    """From orbit through a long lens: the hills fill the picture."""
    eye = (-150_000.0, -250_000.0, 400_000.0)
    return View(hills_scene(), dg.Camera.look_at(eye, (0.0, 0.0, 0.0), fov=0.05), SIZE)


@_named
def eye_at_500_km_wide() -> View:
    """From orbit through an ordinary lens: a terrain of a thousand kilometres."""
    scene = dg.Scene(uneven_terrain(500_000.0, 4000.0, samples=129))
    add_blobs(scene, 450_000.0, 80)
    add_walks(scene, 400_000.0, 40, 3000.0)
    eye = (-150_000.0, -250_000.0, 400_000.0)
    return View(scene, dg.Camera.look_at(eye, (0.0, 0.0, 0.0), fov=60.0), SIZE)


@_named
def map_from_above() -> View:
    """`Camera.top_down`, whose eye is 100 km up, over 80 m of ground."""
    scene = dg.Scene(uneven_terrain(50.0, 9.0))
    scene.add_polygons(partition((-45.0, -45.0, 45.0, 45.0), 12, 12, seed=86), color=tints(144, 87))
    return View(scene, dg.Camera.top_down((-40.0, -22.0, 40.0, 22.0)), SIZE)


# Odd terrains


@_named
def nodata_holes() -> View:
    """Missing samples: single ones, a strip, a ragged coast."""
    heights = waves(150, 170, 80.0, seed=8)
    generator = np.random.default_rng(91)
    heights[generator.random(heights.shape) < 0.01] = np.nan
    heights[60:63, 20:120] = np.nan
    heights[heights < np.nanquantile(heights, 0.15)] = np.nan
    scene = dg.Scene(dg.Terrain(heights, -850.0, 750.0, 10.0, 10.0))
    scene.add_polygons(partition((-800.0, -700.0, 800.0, 700.0), 16, 14, seed=92), color=tints(224, 93))
    add_walks(scene, 700.0, 30, 9.0)
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 1400.0, 20.0, 40.0), SIZE)


@_named
def coast() -> View:
    """A flat sea beside rough cliffs: coarse tiles next to fine ones, and walls that stand upright."""
    heights = waves(193, 257, 60.0, seed=9)
    heights = np.where(np.arange(257) > 128, 120.0 + 1.5 * heights, 0.0).astype(np.float32)
    scene = dg.Scene(dg.Terrain(heights, -1280.0, 960.0, 10.0, 10.0))
    add_blobs(scene, 1000.0, 40)
    add_walks(scene, 1000.0, 30, 12.0)
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 2100.0, 235.0, 35.0), SIZE)


def _thin(rows: int, columns: int) -> View:
    scene = dg.Scene(dg.Terrain(np.full((rows, columns), 5.0, np.float32), -20.0, 20.0, 10.0, 10.0))
    scene.add_polygons(rings([[circle(0.0, 0.0, 10.0)]]), color="red")
    scene.add_lines(lines([np.array([(-10.0, 0.0), (10.0, 3.0)])]), width=2.0, width_units="m", color="blue")
    return View(scene, dg.Camera.look_at((0.0, -40.0, 30.0), (0.0, 0.0, 0.0)), (64, 36))


@_named
def one_sample() -> View:
    """A terrain without a triangle: nothing but sky."""
    return _thin(1, 1)


@_named
def one_row() -> View:
    """A terrain of one row of samples: no triangle either."""
    return _thin(1, 5)


@_named
def one_quad() -> View:
    """The smallest terrain that there is something to see of, bent along its diagonal."""
    terrain = dg.Terrain(np.array([[0.0, 8.0], [3.0, -2.0]], np.float32), -10.0, 10.0, 20.0, 20.0)
    scene = dg.Scene(terrain)
    scene.add_polygons(partition((-10.0, -10.0, 10.0, 10.0), 4, 4, seed=94), color=tints(16, 95))
    return View(scene, dg.Camera.look_at((-8.0, -25.0, 15.0), (0.0, 0.0, 0.0)), SIZE)


# Odd features


@_named
def larger_than_the_map() -> View:
    """A polygon and lines of a thousand times the map, a line wider than it, and a millimetre's worth of detail."""
    scene = dg.Scene(uneven_terrain(500.0, 30.0))
    far = 5e5
    scene.add_polygons(
        rings([[np.array([(-far, -far), (far, -0.9 * far), (0.3, 90.0), (-0.8 * far, far)])]]), color="teal"
    )
    wide = np.array([(-far, -far - 200.0), (far, far - 200.0)])
    scene.add_lines(lines([wide]), width=300.0, width_units="m", color="gold")
    beyond = np.array([(1600.0, -900.0), (1900.0, 1400.0)])
    scene.add_lines(lines([beyond]), width=3000.0, width_units="m", color="brown", alpha=0.5)
    generator = np.random.default_rng(96)
    tiny = [[blob(generator, x, y, 0.002)] for x, y in generator.uniform(-2.0, 2.0, (50, 2))]
    scene.add_polygons(rings(tiny), color="black")
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 900.0, 200.0, 40.0), SIZE)


@_named
def zero_lengths() -> View:
    """Lines of one point, of repeated points and of less than a micrometre: each is a dot."""
    scene = dg.Scene(uneven_terrain(50.0, 3.0))
    generator = np.random.default_rng(97)
    found: list[FloatArray] = []
    for i in range(60):
        point = generator.uniform(-40.0, 40.0, 2)
        repeats = 1 + i % 4
        found.append(
            np.repeat(point[None], repeats, axis=0) + (i % 3 == 2) * generator.uniform(0, 1e-7, (repeats, 2))
        )
    widths = np.geomspace(0.05, 12.0, 60)
    scene.add_lines(lines(found), width=widths, width_units="m", color=tints(60, 98))
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 70.0, 30.0, 55.0), SIZE)


@_named
def nested_holes() -> View:
    """Rings ten deep, one feature each, and rings that touch themselves, repeat and overlap."""
    scene = dg.Scene(uneven_terrain(120.0, 15.0))
    places = [(x, y) for x in (-70.0, 0.0, 70.0) for y in (-70.0, 0.0, 70.0)]
    features = [nested_rings(x, y, 34.0, 10) for x, y in places]
    bow_tie = np.array([(-110.0, -110.0), (-60.0, -60.0), (-60.0, -110.0), (-110.0, -60.0)])
    touching = np.array(
        [(0.0, 100.0), (20.0, 110.0), (0.0, 118.0), (0.0, 100.0), (-20.0, 118.0), (-20.0, 104.0)]
    )
    square = np.array([(80.0, 80.0), (110.0, 80.0), (110.0, 110.0), (80.0, 110.0)])
    features += [[bow_tie], [touching], [square, square + 10.0, square + 10.0, square + 5.0]]
    scene.add_polygons(rings(features), color=tints(len(features), 99))
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 260.0, 190.0, 50.0), SIZE)


@_named
def slivers() -> View:
    """Triangles a kilometre long and from a metre to a tenth of a millimetre wide, that fan out from a point."""
    scene = dg.Scene(uneven_terrain(600.0, 40.0))
    features = []
    for i, width in enumerate(np.geomspace(3.0, 1e-4, 90)):
        angle = 2.0 * np.pi * i / 90
        along, aside = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        features.append(
            [np.array([10.0 * along, 560.0 * along + width * aside, 560.0 * along - width * aside])]
        )
    scene.add_polygons(rings(features), color=tints(90, 100))
    return View(scene, dg.Camera.orbit((0.0, 0.0, 0.0), 1100.0, 170.0, 50.0), SIZE)


@_named
def crowd() -> View:
    """Twenty thousand features over one pixel: the topmost counts, and translucent ones add up."""
    scene = dg.Scene(flat_terrain(100.0))
    generator = np.random.default_rng(101)
    places = generator.uniform(-0.4, 0.4, (10_000, 2))
    angle = np.linspace(0.0, 2.0 * np.pi, 3, endpoint=False)
    triangle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    corners = places[:, None] + generator.uniform(0.05, 0.5, (10_000, 1, 1)) * triangle
    scene.add_polygons((corners.reshape(-1, 2), 3 * np.arange(10_001)), color=tints(10_000, 102, 0.02))
    ends = generator.uniform(-0.6, 0.6, (20_000, 2))
    scene.add_lines(
        (ends, 2 * np.arange(10_001)), width=0.02, width_units="m", color=tints(10_000, 103, 0.05)
    )
    return View(scene, dg.Camera.top_down((-16.0, -9.0, 16.0, 9.0)), (32, 18))
