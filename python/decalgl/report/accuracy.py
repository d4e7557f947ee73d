"""How far a technique's picture is from the reference: in a crop, of colours and of coverage.

Only the crop is drawn and a few pixels around it, by a camera that sees no more, as a whole picture has fifty times as
many pixels; but what looks farther is drawn whole. A picture over black ground and one over white tell colour and
coverage of the layers, premultiplied. All samples of the terrain are drawn, so that its levels of detail count for
nothing; what those do is told apart. Pixels that see the sky are left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg
from decalgl import reference

from .case_studies import GROUND
from .settings import Setting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..reference.picture import Overlay
    from .case_studies import Map
    from .part import Row

    FloatArray = NDArray[np.float64]
    Size = tuple[int, int]
    Crop = tuple[int, int, int, int]

SAMPLES = 16  # of the reference, each way
BLACK = dg.Relief(color="black", strength=0.0)
WHITE = dg.Relief(color="white", strength=0.0)
ALL_SAMPLES = {"terrain_error": 0.0}  # of the terrain
BY_DETAIL = Setting("static", "coverage")
MARGIN = 2  # pixels around the crop: creases of the ground are found by what is seen beside
MOVED = 0.05  # by how much a pixel differs for which the ground's level of detail counts


class Judge:
    """Compares pictures of one map with the reference, from several cameras.

    size: of the pictures that the cameras are meant for. crop: (width, height) of what is compared, in the middle,
    smaller by even counts.
    """

    def __init__(self, drawn: Map, cameras: dict[str, dg.Camera], size: Size, crop: Size) -> None:
        assert all((whole - part) % 2 == 0 for whole, part in zip(size, crop, strict=True))
        self._map, self._cameras, self._size, self._crop = drawn, cameras, size, crop
        self._near_size = (crop[0] + 2 * MARGIN, crop[1] + 2 * MARGIN)
        self._near = {view: narrowed(camera, size, self._near_size) for view, camera in cameras.items()}
        self._truth: dict[tuple[str, bool], Overlay] = {}
        self._renderers: dict[str, dg.Renderer] = {}
        self._scenes: dict[tuple[str, dg.Relief], dg.Scene] = {}  # of the techniques that were judged last

    def judge(self, setting: Setting) -> dict[str, Row]:
        """The errors of a setting by view, by the names of rows. Raises DecalError where it does not draw the map."""
        setting = replace(setting, renderer={**ALL_SAMPLES, **setting.renderer})
        over_black, over_white = self._crops(setting, BLACK), self._crops(setting, WHITE)
        return {
            view: self._compared(setting, view, over_black[view], over_white[view]) for view in self._cameras
        }

    def judge_ground(self) -> dict[str, Row]:
        """By view, how far the layers are from where they lie on all samples of the terrain, by its level of detail.

        Of whole pictures.
        """
        every = replace(BY_DETAIL, renderer=ALL_SAMPLES)
        detail, every_sample = (
            self._drawn(setting, BLACK, self._cameras, self._size, None) for setting in (BY_DETAIL, every)
        )
        found: dict[str, Row] = {}
        for view in self._cameras:
            apart = np.abs(detail[view] - every_sample[view])
            moved = (apart.max(axis=-1) > MOVED).mean()
            found[view] = {"ground_rms": float(np.sqrt((apart**2).mean())), "ground_moved": float(moved)}
        return found

    def true_picture(self, view: str) -> NDArray[np.uint8]:
        """The crop as the reference draws it, lines in metres."""
        return _over_ground(self._true(view, pixels=False).rgba)

    def _crops(self, setting: Setting, relief: dg.Relief) -> dict[str, FloatArray]:
        whole = setting.looks_around
        size = self._size if whole else self._near_size
        left, top, right, bottom = self._middle(size)
        pictures = self._drawn(setting, relief, self._cameras if whole else self._near, size)
        return {view: picture[top:bottom, left:right] for view, picture in pictures.items()}

    def _middle(self, size: Size) -> Crop:
        """Where the crop is in a picture."""
        left, top = ((whole - part) // 2 for whole, part in zip(size, self._crop, strict=True))
        return left, top, left + self._crop[0], top + self._crop[1]

    def _drawn(
        self,
        setting: Setting,
        relief: dg.Relief,
        cameras: dict[str, dg.Camera],
        size: Size,
        background: str | None = "sky",
    ) -> dict[str, FloatArray]:
        """The pictures by view."""
        key = repr(sorted(setting.renderer.items(), key=str))
        renderer = self._renderers.setdefault(key, dg.Renderer(size, **setting.renderer))
        renderer.set_picture(size, setting.antialias)
        renderer.preprocess(self._scene(setting, relief))
        pictures = {}
        for view, camera in cameras.items():
            renderer.update(camera)
            pictures[view] = renderer.render(background=background).image[..., :3] / 255.0
        return pictures

    def _scene(self, setting: Setting, relief: dg.Relief) -> dg.Scene:
        """Settings that follow each other often draw the same scenes."""
        techniques = repr((setting.polygons, setting.lines, setting.pixels))
        if (techniques, BLACK) not in self._scenes:
            self._scenes = {
                (techniques, each): self._map.scene(setting.polygons, setting.lines, setting.pixels, each)
                for each in (BLACK, WHITE)
            }
        return self._scenes[techniques, relief]

    def _compared(self, setting: Setting, view: str, black: FloatArray, white: FloatArray) -> Row:
        alpha = 1.0 - (white - black).mean(axis=-1, keepdims=True)
        true = self._true(view, setting.pixels)
        found = reference.compare_overlay(
            np.concatenate([black, alpha], axis=-1), true, ignore=true.terrain_fraction < 1.0
        )
        return {
            "image_rms": found.image_rms,
            "image_max": found.image_maximum,
            "edge_rms": found.rms,
            "edge_p99": found.p99,
            "coverage_rms": found.alpha_rms,
            "coverage_max": found.alpha_maximum,
            "leak": found.leak,
            "partly_covered": found.partial / max(1, found.pixels),
        }

    def _true(self, view: str, pixels: bool) -> Overlay:
        if (view, pixels) not in self._truth:
            scene = self._map.scene("auto", "auto", pixels)
            camera, size = self._near[view], self._near_size
            near = seen_part(scene, camera, size, self._middle(size))
            self._truth[view, pixels] = reference.render_overlay(
                near, camera, size, self._middle(size), SAMPLES
            )
        return self._truth[view, pixels]


def narrowed(camera: dg.Camera, size: Size, crop: Size) -> dg.Camera:
    """The camera whose picture of the size `crop` is the middle of the picture that `camera` makes in `size`."""
    camera = camera.for_size(size)
    share = crop[1] / size[1]
    if camera.fov is None:
        assert camera.view_height is not None
        return replace(camera, view_height=share * camera.view_height)
    half = math.atan(share * math.tan(math.radians(camera.fov) / 2.0))
    return replace(camera, fov=2.0 * math.degrees(half))


@dataclass(frozen=True)
class _Part:
    """Of a scene, what the reference reads."""

    terrain: dg.Terrain
    heights: NDArray[np.float32]
    layers: tuple[dg.Layer, ...]


def seen_part(scene: dg.Scene, camera: dg.Camera, size: Size, crop: Crop) -> _Part:
    """The scene with only those features that can show in a crop, so that the reference need not search millions."""
    left, top, right, bottom = crop
    # A pixel more on each side, and what lies between the rays to the corners of pixels.
    around = (max(0, left - 1), max(0, top - 1), min(size[0], right + 1), min(size[1], bottom + 1))
    seen = reference.raycast(scene, camera, size, reference.sample_points(around, 2).reshape(-1, 2))
    places = seen.world[np.isfinite(seen.depth), :2]
    if not len(places):
        return _Part(scene.terrain, scene.heights, ())
    low, high = places.min(axis=0), places.max(axis=0)
    room = 0.1 * (high - low).max() + max(_widest(layer, camera) for layer in scene.layers)
    return _Part(
        scene.terrain, scene.heights, tuple(_cut(layer, low - room, high + room) for layer in scene.layers)
    )


def _widest(layer: dg.Layer, camera: dg.Camera) -> float:
    """Metres that strokes reach from their middle; lines in pixels by the camera's distance, generously."""
    strokes = [one for one in (layer.stroke, layer.casing) if one is not None and len(one.widths)]
    far = float(np.linalg.norm(np.subtract(camera.eye, camera.target)))
    return max(
        (float(one.widths.max()) * (1.0 if one.units == "m" else 0.01 * far) for one in strokes), default=0.0
    )


def _cut(layer: dg.Layer, low: FloatArray, high: FloatArray) -> dg.Layer:
    """The layer with the features whose boxes meet the box between low and high."""
    from .derive import chosen

    table = layer.features
    owner = np.repeat(np.arange(len(table)), np.diff(table.feature_offsets))
    owner = np.repeat(owner, np.diff(table.part_offsets))
    least, most = np.full((len(table), 2), np.inf), np.full((len(table), 2), -np.inf)
    np.minimum.at(least, owner, table.coords)
    np.maximum.at(most, owner, table.coords)
    keep = np.asarray(((least <= high) & (most >= low)).all(axis=1), np.bool_)
    places = np.cumsum(keep) - 1
    order = layer.draw_order[keep[layer.draw_order]]
    return replace(
        layer,
        features=chosen(table, keep),
        draw_order=places[order],
        fill=_of(layer.fill, keep),
        stroke=_of(layer.stroke, keep),
        casing=_of(layer.casing, keep),
    )


def _of(look: Any, keep: NDArray[np.bool_]) -> Any:
    """A fill or stroke of the features that are kept."""
    if look is None:
        return None
    each = {
        name: getattr(look, name)[keep]
        for name in ("colors", "widths", "style_of", "hatch_of")
        if getattr(look, name, None) is not None
    }
    return replace(look, **each)


def _over_ground(rgba: FloatArray) -> NDArray[np.uint8]:
    from matplotlib.colors import to_rgb

    ground = np.asarray(to_rgb(GROUND))
    seen = rgba[..., :3] + (1.0 - rgba[..., 3:]) * ground
    return np.asarray(np.round(255.0 * np.clip(seen, 0.0, 1.0)), np.uint8)
