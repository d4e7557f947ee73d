"""How far a renderer's pictures are from the reference, in numbers that tests bound and benchmarks report.

positions   against the pixels' centres and against what the reference's rays hit
ids         at the renderer's own positions, and at the reference's
overlay     premultiplied colour and coverage, told from two pictures: over black ground and over white
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

import decalgl as dg
from decalgl import reference as ref
from shapes import repainted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from scenes import View

    FloatArray = NDArray[np.float64]
    BoolArray = NDArray[np.bool_]
    IntArray = NDArray[np.int64]
    Crop = tuple[int, int, int, int]

# Pixels. The rasteriser snaps corners to 1/256, so that a centre this close to a silhouette may see past it.
SNAP = 0.01
AROUND = [
    (SNAP * share * x, SNAP * share * y)
    for share in (0.1, 0.25, 0.5, 1.0)
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))
]
# Of a pixel's footprint, and metres: how exact positions are.
SHARE, LEAST = 0.01, 1e-5
# What clipmaps say of scenes that they cannot draw well.
CLIPMAPS_WARN = {"grazing_plain": "looks along the ground", "eye_at_one_metre": "pixels off"}
BLACK = dg.Relief(color="black", strength=0.0)
WHITE = dg.Relief(color="white", strength=0.0)


@dataclass(frozen=True)
class Positions:
    """Errors of `frame.world` and `frame.depth`.

    projected: largest distance from a pixel's centre of its position projected back, pixels.
    surface: largest distance from what the reference sees there, over what is allowed: `SHARE` of the footprint,
        at least `LEAST` metres. Where that is another surface (a silhouette), from one that is seen within `SNAP`
        pixels; infinite where there is none.
    depth: the largest difference of depth, over the same and half a unit in its last place.
    silhouettes: pixels that show another surface, or sky, than the reference does; `other` marks them.
    """

    projected: float
    surface: float
    depth: float
    silhouettes: int
    other: BoolArray


@dataclass(frozen=True)
class Ids:
    """Pixels whose id or layer is wrong: all; those farther from an edge than allowed; the farthest's metres."""

    wrong: int
    far: int
    farthest: float


def draw(
    renderer: dg.Renderer, view: View, antialias: str = "none", relief: dg.Relief | None = None
) -> dg.Frame:
    """A frame of the view at its size; relief: another look of the bare terrain."""
    renderer.set_picture(view.size, antialias)
    renderer.preprocess(view.scene if relief is None else repainted(view.scene, relief))
    renderer.update(view.camera)
    return renderer.render()


def centres_of(view: View) -> FloatArray:
    """All pixel centres (pixels, 2), row by row."""
    return ref.pixel_centres((0, 0, *view.size))


def sides(view: View, points: FloatArray, seen: ref.Surface) -> tuple[FloatArray, FloatArray]:
    """What a pixel to the right and one down are on the surface's tangent plane, metres in space, both (n, 3)."""
    origin, direction = view.camera.rays(points, view.size)
    normal = np.concatenate([-seen.gradient, np.ones((len(points), 1))], axis=1)
    sides = []
    for axis in ((1.0, 0.0), (0.0, 1.0)):
        beside, turned = view.camera.rays(points + axis, view.size)
        with np.errstate(invalid="ignore", divide="ignore"):
            move = (beside - origin) + seen.depth[:, None] * (turned - direction)
            slip = (move * normal).sum(axis=1) / (direction * normal).sum(axis=1)
            sides.append(move - slip[:, None] * direction)
    return sides[0], sides[1]


def footprint(view: View, points: FloatArray, seen: ref.Surface) -> FloatArray:
    """The longer side (n,) in metres of a pixel at points (n, 2) on the surface's tangent plane."""
    right, down = sides(view, points, seen)
    longest: FloatArray = np.maximum(np.linalg.norm(right, axis=1), np.linalg.norm(down, axis=1))
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
    over: FloatArray = excess
    return over


def judge_positions(view: View, frame: dg.Frame, seen: ref.Surface) -> Positions:
    """How exact a frame's positions are. seen: what the reference's rays through the centres hit, (pixels,)."""
    points = centres_of(view)
    world, depth = frame.world.reshape(-1, 3), frame.depth.reshape(-1).astype(np.float64)
    hit = np.isfinite(depth)
    back = view.camera.project(world[hit], view.size)[0]
    projected = np.linalg.norm(back - points[hit], axis=1).max(initial=0.0)

    excess = _excess(view, points, world, seen)
    at = np.flatnonzero(excess > 1.0)
    silhouettes = _silhouette_excess(view, points[at], world[at], depth[at])
    same = hit & (excess <= 1.0)
    with np.errstate(invalid="ignore"):
        slack = np.maximum(LEAST, SHARE * footprint(view, points, seen))
        slack += np.spacing(frame.depth.reshape(-1)) / 2
        off = np.abs(depth - seen.depth) / slack
    return Positions(
        projected=float(projected),
        surface=max(float(excess[same].max(initial=0.0)), float(silhouettes.max(initial=0.0))),
        depth=float(off[same].max(initial=0.0)),
        silhouettes=len(at),
        other=(excess > 1.0).reshape(frame.depth.shape),
    )


def _silhouette_excess(view: View, points: FloatArray, world: FloatArray, depth: FloatArray) -> FloatArray:
    """What is over the allowed distance (n,) from a surface that is seen within `SNAP` of points (n, 2); inf: none."""
    nearest, farthest = np.full(len(points), np.inf), np.zeros(len(points))
    least = np.full(len(points), np.inf)
    for offset in AROUND:
        beside = ref.raycast(view.scene, view.camera, view.size, points + offset)
        nearest, farthest = np.minimum(nearest, beside.depth), np.maximum(farthest, beside.depth)
        # What is hit a pixel's hundredth aside lies a hundredth of a footprint away.
        least = np.minimum(least, np.maximum(_excess(view, points + offset, world, beside) - 1.5, 0.0))
    height, gradient = surface_below(view.scene, world[:, :2])
    own = ref.Surface(np.column_stack([world[:, :2], height]), depth, gradient)
    between = (nearest <= depth + LEAST) & (depth <= farthest + LEAST)
    return np.where(between, np.fmin(least, _excess(view, points, world, own)), least)


def judge_ids(
    view: View,
    frame: dg.Frame,
    seen: ref.Surface,
    tolerance: float | FloatArray,
    ignore: BoolArray | None = None,
) -> Ids:
    """How right ids are. seen: positions to judge them at, (height, width); tolerance: metres from an edge."""
    expected = ref.render_ids(view.scene, view.camera, view.size, surface=seen, distances=False)
    found = ref.compare_ids(frame.ids, frame.layers, expected.ids, expected.layers, ignore=ignore)
    wrong = np.flatnonzero(found.mask)
    distance = ref.edge_distance(view.scene, seen.world.reshape(-1, 3)[wrong, :2])
    allowed = np.broadcast_to(tolerance, found.mask.shape).reshape(-1)[wrong]
    return Ids(len(wrong), int((~(distance <= allowed)).sum()), float(distance.max(initial=0.0)))


class IdsSeen(Protocol):
    """What of a frame tells which ids it shows where; sizes as of `decalgl.Frame`."""

    @property
    def world(self) -> FloatArray: ...
    @property
    def depth(self) -> NDArray[np.floating[Any]]: ...
    @property
    def ids(self) -> IntArray: ...
    @property
    def layers(self) -> NDArray[np.integer[Any]]: ...


def own_surface(view: View, frame: IdsSeen) -> ref.Surface:
    """The frame's own positions as a surface, with the slopes of the full one above or below them."""
    _, gradient = surface_below(view.scene, frame.world.reshape(-1, 3)[:, :2])
    return ref.Surface(frame.world, frame.depth.astype(np.float64), gradient.reshape(*frame.depth.shape, 2))


def overlay_of(renderer: dg.Renderer, view: View, antialias: str) -> FloatArray:
    """What the layers add, premultiplied, (height, width, 4) from 0 to 1, in steps of 1/255. Sky is covered."""
    over_black = draw(renderer, view, antialias, BLACK).image[..., :3] / 255.0
    over_white = draw(renderer, view, antialias, WHITE).image[..., :3] / 255.0
    alpha = 1.0 - (over_white - over_black).mean(axis=-1, keepdims=True)
    both: FloatArray = np.concatenate([over_black, alpha], axis=-1)
    return both


def surface_below(scene: dg.Scene, xy: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(height (n,), gradient (n, 2)) of the full surface at map positions (n, 2): NaN in holes and at NaN.

    Beyond the terrain's edge the last triangles go on.
    """
    terrain, heights = scene.terrain, scene.heights.astype(np.float64)
    rows, columns = heights.shape
    u = (xy[:, 0] - terrain.x0) / terrain.dx
    v = (terrain.y0 - xy[:, 1]) / terrain.dy
    column = np.clip(np.floor(np.nan_to_num(u)), 0, columns - 2).astype(np.int64)
    row = np.clip(np.floor(np.nan_to_num(v)), 0, rows - 2).astype(np.int64)
    u, v = u - column, v - row
    northwest, northeast = heights[row, column], heights[row, column + 1]
    southwest, southeast = heights[row + 1, column], heights[row + 1, column + 1]
    east = np.where(v > u, southeast - southwest, northeast - northwest)
    south = np.where(v > u, southwest - northwest, southeast - northeast)
    gradient = np.column_stack([east / terrain.dx, -south / terrain.dy])
    return northwest + u * east + v * south, gradient


def terrain_errors(view: View, frame: dg.Frame) -> FloatArray:
    """How far on the screen, in pixels (n,), the surface drawn lies from the full one above or below it."""
    world = frame.world.reshape(-1, 3)
    world = world[np.isfinite(world[:, 0])]
    full = world.copy()
    full[:, 2] = surface_below(view.scene, world[:, :2])[0]
    drawn_at, _ = view.camera.project(world, view.size)
    full_at, _ = view.camera.project(full, view.size)
    errors: FloatArray = np.linalg.norm(drawn_at - full_at, axis=1)
    return errors


def rim_distance(view: View, frame: dg.Frame) -> FloatArray:
    """How far (h, w) the surface at each pixel is from the terrain's outer rim on the map, in footprints."""
    x0, y0, x1, y1 = view.scene.terrain.bounds
    points, world = centres_of(view), frame.world.reshape(-1, 3)
    _, gradient = surface_below(view.scene, world[:, :2])
    across = footprint(view, points, ref.Surface(world, frame.depth.reshape(-1).astype(np.float64), gradient))
    inside = np.minimum(world[:, :2] - (x0, y0), (x1, y1) - world[:, :2]).min(axis=1)
    distance: FloatArray = (inside / across).reshape(frame.depth.shape)
    return distance


def folded(view: View, crop: Crop, seen: ref.Surface, samples: int) -> BoolArray:
    """Pixels (h, w) of a crop whose area shows ground far from the tangent plane at their centre.

    seen: `ref.sample_surface` of the crop. Far: some place of the pixel's area lies on the map where the plane's
    picture has it a tenth of a pixel aside, as at the foot of a cliff or where facets are smaller than pixels.
    """
    height, width = seen.depth.shape[:2]
    points = ref.sample_points(crop, samples).reshape(-1, 2)
    centres = ref.pixel_centres(crop)
    middle = ref.raycast(view.scene, view.camera, view.size, centres)
    right, down = (np.repeat(side[:, :2], samples**2, axis=0) for side in sides(view, centres, middle))
    apart = (seen.world.reshape(-1, 3) - np.repeat(middle.world, samples**2, axis=0))[:, :2]
    offset = points - np.repeat(centres, samples**2, axis=0)
    area = right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0]
    with np.errstate(invalid="ignore", divide="ignore"):
        x = (apart[:, 0] * down[:, 1] - apart[:, 1] * down[:, 0]) / area
        y = (right[:, 0] * apart[:, 1] - right[:, 1] * apart[:, 0]) / area
        off = np.hypot(x - offset[:, 0], y - offset[:, 1])
    # A place that sees sky has no number, and is far.
    near: BoolArray = off.reshape(height, width, -1).max(axis=-1) <= 0.1
    return ~near


def busiest_crop(frame: dg.Frame, size: tuple[int, int]) -> Crop:
    """The crop (x0, y0, x1, y1) of a size, among some, with the most borders between features."""
    ids = frame.ids + 2**40 * frame.layers.astype(np.int64)
    edges = (np.diff(ids, axis=0)[:, :-1] != 0) | (np.diff(ids, axis=1)[:-1] != 0)
    height, width = frame.ids.shape
    wide, high = min(size[0], width), min(size[1], height)
    corners = [
        (x, y)
        for y in range(0, height - high + 1, max(1, high // 2))
        for x in range(0, width - wide + 1, max(1, wide // 2))
    ]
    x, y = max(corners, key=lambda at: int(edges[at[1] : at[1] + high, at[0] : at[0] + wide].sum()))
    return (x, y, x + wide, y + high)


def eroded(mask: BoolArray, pixels: int) -> BoolArray:
    """A mask (h, w) without what lies within some pixels of its border."""
    result: BoolArray = mask.copy()
    for _ in range(pixels):
        inner = np.zeros_like(result)
        inner[1:-1, 1:-1] = result[1:-1, 1:-1]
        for shift in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            inner &= np.roll(result, shift, axis=(0, 1))
        result = inner
    return result
