"""What rounding explains of a picture of styles.

A dash's end, a corner of a short segment and a mitre's tip move farther than the vertices do, and farther than any
distance to an edge tells. So wrong pixels are looked at again with vertices and positions moved: a renderer that
rounds them is right if some way to move them gives its answer.
"""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

import decalgl as dg
from decalgl import reference as ref
from judge import SNAP, centres_of, draw, overlay_of, own_surface, sides, surface_below
from shapes import with_features

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from judge import IdsSeen
    from scenes import View

    FloatArray = NDArray[np.float64]
    BoolArray = NDArray[np.bool_]
    IntArray = NDArray[np.int64]
    Crop = tuple[int, int, int, int]

SHADERS = Path(__file__).resolve().parents[2] / "cpp" / "shaders"

# Ways to round a scene that may explain a pixel.
TRIES = 48


def shaken(scene: dg.Scene, reach: float, seed: int) -> dg.Scene:
    """The scene with every vertex moved by up to `reach` metres in x and in y, equal ones alike."""
    tables = []
    for layer in scene.layers:
        table = layer.features
        places, which = np.unique(table.coords, axis=0, return_inverse=True)
        places += np.random.default_rng([0, seed]).uniform(-reach, reach, places.shape)
        coords = places[which.reshape(-1)]
        tables.append(dataclasses.replace(table, coords=coords))
    return with_features(scene, tables)


def pixel_metres(view: View, depth: FloatArray) -> FloatArray:
    """How wide (n,) a pixel is where something is seen head-on at these depths (n,)."""
    origin, direction = view.camera.rays(
        np.array([[0.0, 0.0], [1.0, 0.0]]) + 0.5 * np.array(view.size), view.size
    )
    across: FloatArray = np.linalg.norm(
        np.diff(origin, axis=0) + depth[:, None] * np.diff(direction, axis=0), axis=1
    )
    return across


def unexplained(
    view: View,
    surface: ref.Surface,
    reach: float,
    is_right: Callable[[dg.Scene, ref.Surface, IntArray], BoolArray],
) -> IntArray:
    """Which of a surface's positions (n,) look wrong however their vertices and they themselves are rounded.

    reach: metres that rounding moves a vertex or a position by at most. is_right: whether positions, moved, look
    right in a scene; with the indices of those that are asked about. A dash's end, a corner of a short segment and a
    mitre's tip move farther than the vertices do, and farther than any distance to an edge tells. Which triangle's
    slope a position has is what the rasteriser says, who moves the triangles' corners by `SNAP` pixels.
    """
    snapped = SNAP * pixel_metres(view, surface.depth)
    left = np.arange(len(surface.depth))
    for seed in range(TRIES):
        if not len(left):
            break
        nearer = reach * (1 + seed % 8) / 8
        moves = np.random.default_rng([1, seed]).uniform(-nearer, nearer, (len(left), 2))
        moved = surface[left]
        world = moved.world + np.column_stack([moves, np.zeros(len(left))])
        aside = np.random.default_rng([3, seed]).uniform(-1.0, 1.0, (len(left), 2)) * snapped[left, None]
        _, gradient = surface_below(view.scene, world[:, :2] + aside)
        moved = ref.Surface(world, moved.depth, gradient)
        left = left[~is_right(shaken(view.scene, nearer, seed), moved, left)]
    return left


def unexplained_ids(view: View, frame: IdsSeen, reach: float, nearest: bool = False) -> tuple[int, int]:
    """How many of a frame's ids are not the reference's at its own positions, and how many no rounding explains.

    nearest: see `reference.membership`.
    """
    surface = own_surface(view, frame)
    expected = ref.render_ids(
        view.scene, view.camera, view.size, surface=surface, distances=False, nearest=nearest
    )
    wrong = np.nonzero((frame.ids != expected.ids) | (frame.layers != expected.layers))
    ids, layers = frame.ids[wrong], frame.layers[wrong]

    def is_right(scene: dg.Scene, moved: ref.Surface, which: IntArray) -> BoolArray:
        crop = (0, 0, len(which), 1)
        found = ref.render_ids(
            scene, view.camera, view.size, crop,
            surface=moved.reshape(1, -1), distances=False, nearest=nearest,
        )  # fmt: skip
        right: BoolArray = (found.ids[0] == ids[which]) & (found.layers[0] == layers[which])
        return right

    return len(ids), len(unexplained(view, surface[wrong], reach, is_right))


def unexplained_colors(
    view: View,
    frame: dg.Frame,
    overlay: FloatArray,
    reach: float,
    steps: float = 1.01,
    nearest: bool = False,
) -> tuple[int, int]:
    """The same of an overlay (h, w, 4) without anti-aliasing, whose channels may be some steps of 1/255 off."""
    surface = own_surface(view, frame)
    surface = surface.reshape(-1)
    ground = np.isfinite(surface.depth)
    flat = overlay.reshape(-1, 4)

    def is_off(scene: dg.Scene, seen: ref.Surface, colors: FloatArray) -> BoolArray:
        off: BoolArray = np.abs(composite_of(view, scene, seen, nearest) - colors).max(axis=-1) > steps / 255
        return off

    wrong = np.flatnonzero(ground)[is_off(view.scene, surface[ground], flat[ground])]
    left = unexplained(
        view, surface[wrong], reach,
        lambda scene, moved, which: ~is_off(scene, moved, flat[wrong[which]]),
    )  # fmt: skip
    return len(wrong), len(left)


def unexplained_means(
    view: View, overlay: FloatArray, places: FloatArray, reach: float, steps: float, nearest: bool = False
) -> tuple[int, int]:
    """The same of an overlay of which a pixel is the mean of what samples at these places (n, 2) in it see.

    places: to the right and down from the pixel's upper left corner. Pixels that see sky are not looked at.

    The tolerance is that of the samples: each of them is looked at again with vertices, positions and, by `SNAP`, its
    place moved. A pixel is right where no channel lies outside of the means of the least and of the most that its
    samples see then.
    """
    points = (centres_of(view) - 0.5)[:, None] + places
    surface = ref.raycast(view.scene, view.camera, view.size, points.reshape(-1, 2))
    ground = np.flatnonzero(np.isfinite(surface.depth).reshape(len(points), -1).all(axis=1))
    seen = composite_of(view, view.scene, surface, nearest).reshape(*points.shape[:2], 4)[ground]
    points, colors = points[ground], overlay.reshape(-1, 4)[ground]
    low, high = seen.copy(), seen.copy()

    def is_off(some: IntArray) -> BoolArray:
        least, most = low[some].mean(axis=1) - steps / 255, high[some].mean(axis=1) + steps / 255
        off: BoolArray = ((colors[some] < least) | (colors[some] > most)).any(axis=-1)
        return off

    left = np.arange(len(ground))
    left = left[is_off(left)]
    wrong = len(left)
    for seed in range(TRIES):
        if not len(left):
            break
        generator = np.random.default_rng([2, seed])
        nearer = reach * (1 + seed % 8) / 8
        there = points[left] + generator.uniform(-SNAP, SNAP, points[left].shape)
        moved = ref.raycast(view.scene, view.camera, view.size, there.reshape(-1, 2))
        moved.world[:, :2] += generator.uniform(-nearer, nearer, (len(moved.depth), 2))
        found = composite_of(view, shaken(view.scene, nearer, seed), moved, nearest)
        found = found.reshape(len(left), -1, 4)
        low[left], high[left] = np.minimum(low[left], found), np.maximum(high[left], found)
        left = left[is_off(left)]
    return wrong, len(left)


def composite_of(view: View, scene: dg.Scene, surface: ref.Surface, nearest: bool = False) -> FloatArray:
    """The reference's colours (n, 4) of a scene at positions (n,) of the view."""
    slopes = ref.slopes_of(scene, view.camera, view.size, surface)
    return ref.composite(scene, surface.world[..., :2].reshape(-1, 2), slopes, nearest)


def sample_offsets() -> FloatArray:
    """Where in a pixel techniques look that ask 32 places (samples, 2), to the right and up from the centre."""
    text = (SHADERS / "shared" / "sample_offsets.h").read_text(encoding="utf-8")
    pairs = re.findall(r"vec2\(([-.\d]+), ([-.\d]+)\)", text)
    return np.array(pairs, dtype=np.float64)


def coverage_of_samples(view: View, frame: dg.Frame, crop: Crop) -> FloatArray:
    """The reference's mean colour (h, w, 4) of those places, on the pixels' planes.

    What differs from it is a wrong answer at some place, whereas the mean over the whole area differs from it by what
    so few places can tell.
    """
    x0, y0, x1, y1 = crop
    surface = own_surface(view, frame)[y0:y1, x0:x1].reshape(-1)
    right, down = sides(view, ref.pixel_centres(crop), surface)
    total = np.zeros((len(surface.depth), 4))
    offsets = sample_offsets()
    for x, y in offsets:
        there = dataclasses.replace(surface, world=surface.world + x * right - y * down)
        total += composite_of(view, view.scene, there)
    return (total / len(offsets)).reshape(y1 - y0, x1 - x0, 4)


def write_pictures(
    renderer: dg.Renderer, view: View, antialias: str, folder: Path, name: str, samples: int = 8
) -> None:
    """Writes what the renderer draws, what the reference does, and 8 times the difference, as PNG files to look at."""
    got = overlay_of(renderer, view, antialias)
    if antialias == "none":
        surface = own_surface(view, draw(renderer, view)).reshape(-1)
        expected = composite_of(view, view.scene, surface).reshape(got.shape)
    else:
        expected = ref.render_overlay(view.scene, view.camera, view.size, samples=samples).rgba
    folder.mkdir(parents=True, exist_ok=True)
    paper = np.full(3, 0.93)
    for label, overlay in (("renderer", got), ("reference", expected)):
        _write_png(
            folder / f"{name}-{antialias}-{label}.png", overlay[..., :3] + (1 - overlay[..., 3:]) * paper
        )
    _write_png(folder / f"{name}-{antialias}-difference.png", 8 * np.abs(got - expected)[..., :3])


def _write_png(path: Path, colors: FloatArray) -> None:
    Image.fromarray(np.rint(255 * np.clip(colors, 0.0, 1.0)).astype(np.uint8)).save(path)
