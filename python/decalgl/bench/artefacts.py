"""Scenes of the artefacts that papers name, and how far each goes: the tests hold the figures, the docs show them.

blur         of a border in a clipmap: the width of the ramp that is as far from a sharp step, which is four times the
             mean distance that filtering moves colour by; a pixel's own area is 1 pixel wide
overdraw     samples that shadow volumes and tiles of textures write, for each pixel that a decal covers
intrusion    wide lines of a network run into each other; protrusion: they stand out behind narrower ones
steps        of fields of eight bits
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from shapely import LineString, Polygon

import decalgl as dg

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]

BLACK = dg.Relief(color="black", strength=0.0)
TEXELS = 2**20
HALF = 20_000.0
# Of borders that lie askew to the texels, so that every offset from them occurs.
ASKEW = np.radians(63.0)


# Clipmaps


@dataclass(frozen=True)
class Border:
    """The map to the right of a straight border through (x, y), and a camera on it; `heading` from east.

    reach: metres from the border that are looked at.
    """

    terrain: dg.Terrain
    camera: dg.Camera
    size: tuple[int, int]
    reach: float
    heading: float = ASKEW
    x: float = 0.0
    y: float = 0.0

    def blur(self, technique: dg.Technique, antialias: str = "none") -> float:
        """Metres on the map that the border's ramp is wide."""
        along = np.array([np.cos(self.heading), np.sin(self.heading)])
        right = np.array([along[1], -along[0]])
        far = 0.2 * (self.terrain.bounds[2] - self.terrain.bounds[0])
        corners = np.array([self.x, self.y]) + far * np.array([-along, along, along + right, right - along])
        scene = dg.Scene(self.terrain, relief=BLACK)
        scene.add_polygons([Polygon(corners)], color="white", technique=technique)
        with warnings.catch_warnings():
            # Nearer than the lattice, which warns: blur by whole texels is what is looked at.
            warnings.simplefilter("ignore", dg.DecalWarning)
            frame = scene.render(
                self.camera, self.size, antialias=antialias, background="black", terrain_error=0.0
            )
        distance = (frame.world[..., :2] - (self.x, self.y)) @ right
        near = np.abs(distance) < self.reach
        bins = np.linspace(-self.reach, self.reach, 65)
        counts = np.histogram(distance[near], bins)[0]
        if counts.min() <= 3:
            raise dg.InputError(
                "A step across the border is met by three pixels or fewer; take a larger picture."
            )
        off = np.abs(frame.image[..., 0] / 255.0 - (distance > 0.0))
        means = np.histogram(distance[near], bins, weights=off[near])[0] / counts
        return 4.0 * float(means.sum() * (bins[1] - bins[0]))


def texel_of(terrain: dg.Terrain) -> float:
    """Metres of a finest texel: the next power of two metres that is larger than the map is cut into 2^20."""
    left, bottom, right, top = terrain.bounds
    return float(2.0 ** (np.floor(np.log2(max(right - left, top - bottom))) + 1.0)) / TEXELS


def _level() -> dg.Terrain:
    return dg.Terrain.flat((-HALF, -HALF, HALF, HALF))


def near_border() -> Border:
    """From a metre's height, where texels are larger than pixels."""
    terrain = _level()
    camera = dg.Camera.look_at((0.0, -1.0, 1.0), (0.0, 0.0, 0.0), fov=25.0)
    return Border(terrain, camera, (320, 240), 2.5 * texel_of(terrain))


def far_border(height: float) -> Border:
    """From above, in a picture so many metres high."""
    half = 0.5 * height
    camera = dg.Camera.top_down((-half, -half, half, half))
    return Border(_level(), camera, (240, 240), 4.0 * height / 240.0, x=3.0, y=5.0)


def border_on_slope(slope: float) -> Border:
    """Along the contour of a plane that rises to the north, seen head-on."""
    y = np.linspace(HALF, -HALF, 3)[:, None]
    heights = (slope * (y + np.zeros((3, 3)))).astype(np.float32)
    terrain = dg.Terrain(heights, -HALF, HALF, HALF, HALF)
    normal = np.array([0.0, -slope, 1.0]) / np.hypot(1.0, slope)
    camera = dg.Camera.look_at(4.0 * normal, (0.0, 0.0, 0.0), fov=25.0, up=(0.0, 1.0, 0.0))
    return Border(terrain, camera, (320, 320), 2.5 * texel_of(terrain), np.radians(7.0))


GRAZING_PIXEL = 2.0 * 2000.0 * np.tan(np.radians(1.0)) / 120.0


def grazing_border() -> Border:
    """A border that runs away from the eye, 5 degrees above the ground, where pixels are 11 times as long as wide."""
    elevation, distance = np.radians(5.0), 2000.0
    eye = (0.0, -distance * np.cos(elevation), distance * np.sin(elevation))
    camera = dg.Camera.look_at(eye, (0.0, 0.0, 0.0), fov=2.0)
    return Border(_level(), camera, (240, 120), 16.0 * GRAZING_PIXEL, np.radians(89.5))


# Overdraw


def overdraw(
    scene_of: Callable[[dg.Technique], dg.Scene],
    technique: dg.Technique,
    camera: dg.Camera,
    size: tuple[int, int],
) -> float:
    """Samples that a first drawing of a view writes for each pixel whose centre the layers cover; 0 where none is.

    The pass over the whole picture that every technique has is left out.
    """
    covered = int((scene_of(dg.Static()).render(camera, size, antialias="none").ids >= 0).sum())
    renderer = dg.Renderer(size=size, antialias="none")
    renderer.preprocess(scene_of(technique))
    renderer.update(camera)
    samples = getattr(technique, "samples", 1)  # of a texel
    written = (renderer.count_fragments() - size[0] * size[1]) / samples
    return written / covered if covered else 0.0


# Networks


@dataclass(frozen=True)
class Network:
    """Lines on level ground of 100 m, drawn at a pixel a metre from above."""

    lines: list[LineString]
    category: list[str]
    styles: dict[str, dg.NetworkStyle]
    options: dict[str, Any] = field(default_factory=dict)

    def image(self, pixels: int = 100, **options: Any) -> NDArray[np.uint8]:
        """The picture (pixels, pixels, 4)."""
        bounds = (0.0, 0.0, 100.0, 100.0)
        scene = dg.Scene(dg.Terrain.flat(bounds), relief=BLACK)
        technique = dg.DistanceField(category=self.category, styles=self.styles, **self.options, **options)
        scene.add_lines(self.lines, technique=technique)
        image: NDArray[np.uint8] = scene.render(
            dg.Camera.top_down(bounds), (pixels, pixels), antialias="none", background=None
        ).image
        return image


CLOSE = [LineString([(5, 57), (50, 56), (95, 57)]), LineString([(5, 43), (50, 44), (95, 43)])]
INTRUSION = Network(CLOSE, ["a", "a"], {"a": dg.NetworkStyle(20, "white", "blue", main=0.8)})
PROTRUSION = Network(
    [LineString([(0, 30), (50, 30), (100, 30)]), LineString([(50, 30), (50, 90)])],
    ["narrow", "wide"],
    {"wide": dg.NetworkStyle(40, "red"), "narrow": dg.NetworkStyle(10, "white")},
)
STEPS = Network([LineString([(-20, 45), (120, 55)])], ["a"], {"a": dg.NetworkStyle(60, "white")})


def intrusion(**options: Any) -> float:
    """The share of two lines' length along which neither a border nor ground is left between them."""
    between = INTRUSION.image(**options)[44:56, 10:90, 0]
    return float((between == 255).all(axis=0).mean())


def protrusion(**options: Any) -> float:
    """Metres by which the end of a wide line stands out behind a narrower one, of its half width of 20."""
    behind = PROTRUSION.image(**options)[75:, 50]
    return float(((behind[:, 0] == 255) & (behind[:, 1] == 0)).sum())


def steps(**options: Any) -> float:
    """Pixels by which borders of a line 60 m wide are off, where a metre is ten pixels."""
    counts = [
        (STEPS.image(1000, **one)[..., 0] > 127).sum(axis=0)
        for one in (options, {"bits": 32, "drop_off": "exact"})
    ]
    return float(np.abs(counts[0] - counts[1]).max()) / 2.0
