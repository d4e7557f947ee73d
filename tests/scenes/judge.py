"""How far a renderer's pictures are from the reference, in numbers that tests bound and benchmarks report.

    positions   against the pixels' centres and against what the reference's rays hit
    ids         at the renderer's own positions, and at the reference's
    overlay     premultiplied colour and coverage, told from two pictures: over black ground and over white
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import decalgl as dg
from decalgl import reference as ref
from scenes import View, repainted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    FloatArray = NDArray[np.float64]
    BoolArray = NDArray[np.bool_]
    Crop = tuple[int, int, int, int]

# Pixels. The rasteriser snaps corners to 1/256, so that a centre this close to a silhouette may see past it.
SNAP = 0.01
AROUND = SNAP * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)])
# Of a pixel's footprint, and metres: how exact positions are.
SHARE, LEAST = 0.01, 1e-5
BLACK = dg.Relief(color="black", strength=0.0)
WHITE = dg.Relief(color="white", strength=0.0)


@dataclass(frozen=True)
class Positions:
    """Errors of `frame.world` and `frame.depth`.

    projected: largest distance from a pixel's centre of its position projected back, pixels.
    surface: largest distance from what the reference sees there, over what is allowed: `SHARE` of the footprint,
        at least `LEAST` metres. Where that is another surface (a silhouette), from the nearest one that is seen
        within `SNAP` pixels.
    depth: the largest difference of depth, over the same and half a unit in its last place.
    silhouettes: pixels that show another surface, or sky, than the reference does.
    unexplained: of these, the ones that show what is not seen within `SNAP` pixels either.
    """

    projected: float
    surface: float
    depth: float
    silhouettes: int
    unexplained: int
    other: BoolArray


@dataclass(frozen=True)
class Ids:
    """Pixels whose id or layer is wrong: all; those farther from an edge than allowed; the farthest's metres."""

    wrong: int
    far: int
    farthest: float


def draw(renderer: dg.Renderer, view: View, antialias: str = "none", relief: dg.Relief | None = None) -> dg.Frame:
    """A frame of the view at its size; relief: another look of the bare terrain."""
    renderer.set_picture(view.size, antialias)
    renderer.preprocess(view.scene if relief is None else repainted(view.scene, relief))
    renderer.update(view.camera)
    return renderer.render()


def centres_of(view: View) -> FloatArray:
    """All pixel centres (pixels, 2), row by row."""
    return ref.pixel_centres((0, 0, *view.size))


def footprint(view: View, points: FloatArray, seen: ref.Surface) -> FloatArray:
    """The longer side (n,) of a pixel on the surface's tangent plane, metres in space, at points (n, 2)."""
    origin, direction = view.camera.rays(points, view.size)
    normal = np.concatenate([-seen.gradient, np.ones((len(points), 1))], axis=1)
    sides = []
    for axis in ((1.0, 0.0), (0.0, 1.0)):
        beside, turned = view.camera.rays(points + axis, view.size)
        with np.errstate(invalid="ignore", divide="ignore"):
            move = (beside - origin) + seen.depth[:, None] * (turned - direction)
            slip = (move * normal).sum(axis=1) / (direction * normal).sum(axis=1)
            sides.append(np.linalg.norm(move - slip[:, None] * direction, axis=1))
    longest: FloatArray = np.maximum(*sides)
    return longest


def _excess(view: View, points: FloatArray, world: FloatArray, seen: ref.Surface) -> FloatArray:
    """Distances (n,) between positions, over what is allowed; 0 where both are sky, inf where one is."""
    sky = np.isnan(world[:, 0])
    beside = ~np.isfinite(seen.depth)
    with np.errstate(invalid="ignore"):
        allowed = np.maximum(LEAST, SHARE * footprint(view, points, seen))
        excess = np.linalg.norm(world - seen.world, axis=1) / allowed
    excess[sky | beside] = np.inf
    excess[sky & beside] = 0.0
    return excess


def judge_positions(view: View, frame: dg.Frame, seen: ref.Surface) -> Positions:
    """How exact a frame's positions are. seen: what the reference's rays through the centres hit, (pixels,)."""
    points = centres_of(view)
    world, depth = frame.world.reshape(-1, 3), frame.depth.reshape(-1).astype(np.float64)
    hit = np.isfinite(depth)
    back, _ = view.camera.project(world[hit], view.size) if hit.any() else (points[hit], None)
    projected = np.linalg.norm(back - points[hit], axis=1).max(initial=0.0)

    excess = _excess(view, points, world, seen)
    at = np.flatnonzero(excess > 1.0)
    near = excess[at]
    for offset in AROUND:
        moved = points[at] + offset
        beside = ref.raycast(view.scene, view.camera, view.size, moved)
        # The nearest surface is a pixel's hundredth aside: the footprint's share again.
        near = np.minimum(near, np.maximum(_excess(view, moved, world[at], beside) - 1.5, 0.0))
    same = hit & (excess <= 1.0)
    with np.errstate(invalid="ignore"):
        slack = np.maximum(LEAST, SHARE * footprint(view, points, seen)) + np.spacing(frame.depth.reshape(-1)) / 2
        off = np.abs(depth - seen.depth) / slack
    return Positions(
        projected=float(projected),
        surface=float(max(excess[same].max(initial=0.0), near[np.isfinite(near)].max(initial=0.0))),
        depth=float(off[same].max(initial=0.0)),
        silhouettes=len(at),
        unexplained=int((near > 1.0).sum()),
        other=(excess > 1.0).reshape(frame.depth.shape),
    )


def judge_ids(
    view: View, frame: dg.Frame, seen: ref.Surface, tolerance: float | FloatArray, ignore: BoolArray | None = None
) -> Ids:
    """How right ids are. seen: positions to judge them at, (height, width); tolerance: metres from an edge."""
    expected = ref.render_ids(view.scene, view.camera, view.size, surface=seen, distances=False)
    found = ref.compare_ids(frame.ids, frame.layers, expected.ids, expected.layers, ignore=ignore)
    wrong = np.flatnonzero(found.mask)
    distance = ref.edge_distance(view.scene, seen.world.reshape(-1, 3)[wrong, :2])
    allowed = np.broadcast_to(tolerance, found.mask.shape).reshape(-1)[wrong]
    return Ids(len(wrong), int((~(distance <= allowed)).sum()), float(distance.max(initial=0.0)))


def own_surface(frame: dg.Frame) -> ref.Surface:
    """The frame's own positions as a surface, without slopes."""
    return ref.Surface(frame.world, frame.depth.astype(np.float64), np.full((*frame.depth.shape, 2), np.nan))


def overlay_of(renderer: dg.Renderer, view: View, antialias: str) -> FloatArray:
    """What the layers add, premultiplied, (height, width, 4) from 0 to 1, in steps of 1/255. Sky is covered."""
    over_black = draw(renderer, view, antialias, BLACK).image[..., :3] / 255.0
    over_white = draw(renderer, view, antialias, WHITE).image[..., :3] / 255.0
    alpha = 1.0 - (over_white - over_black).mean(axis=-1, keepdims=True)
    both: FloatArray = np.concatenate([over_black, alpha], axis=-1)
    return both


def surface_height(scene: dg.Scene, xy: FloatArray) -> FloatArray:
    """Height (n,) in metres of the full surface at map positions (n, 2): NaN beside it and in holes."""
    terrain, heights = scene.terrain, scene.heights.astype(np.float64)
    rows, columns = heights.shape
    u = (xy[:, 0] - terrain.x0) / terrain.dx
    v = (terrain.y0 - xy[:, 1]) / terrain.dy
    column = np.clip(np.floor(np.nan_to_num(u)), 0, columns - 2).astype(np.int64)
    row = np.clip(np.floor(np.nan_to_num(v)), 0, rows - 2).astype(np.int64)
    u, v = u - column, v - row
    northwest, northeast = heights[row, column], heights[row, column + 1]
    southwest, southeast = heights[row + 1, column], heights[row + 1, column + 1]
    lower = northwest + v * (southwest - northwest) + u * (southeast - southwest)
    upper = northwest + u * (northeast - northwest) + v * (southeast - northeast)
    inside = (np.minimum(u, v) > -1e-6) & (np.maximum(u, v) < 1 + 1e-6)
    return np.where(inside, np.where(v > u, lower, upper), np.nan)


def terrain_errors(view: View, frame: dg.Frame) -> FloatArray:
    """How far on the screen, in pixels (n,), the surface drawn lies from the full one above or below it."""
    world = frame.world.reshape(-1, 3)
    world = world[np.isfinite(world[:, 0])]
    full = world.copy()
    full[:, 2] = surface_height(view.scene, world[:, :2])
    drawn_at, _ = view.camera.project(world, view.size)
    full_at, _ = view.camera.project(full, view.size)
    return np.linalg.norm(drawn_at - full_at, axis=1)
