"""How far a technique's picture is from the reference: in a crop, of colours and of coverage.

A picture over black ground and one over white tell colour and coverage of the layers, premultiplied. All samples of the
terrain are drawn, so that its levels of detail count for nothing; what those do is told apart. Pixels that see the
sky are left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg
from decalgl import reference

from ..bench.measure import LAYER_PASSES
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
MOVED = 0.05  # by how much a pixel differs for which the ground's level of detail counts


@dataclass(frozen=True)
class Judged:
    """Errors and bytes by the names of rows, and the picture of the layers over plain ground, (h, w, 3)."""

    errors: Row
    picture: NDArray[np.uint8]


class Judge:
    """Compares pictures of one map with the reference, from several cameras."""

    def __init__(self, drawn: Map, cameras: dict[str, dg.Camera], size: Size, crop: Size) -> None:
        self._map, self._cameras, self._size = drawn, cameras, size
        width, height = size
        wide, high = crop
        left, top = (width - wide) // 2, (height - high) // 2
        self.crop: Crop = (left, top, left + wide, top + high)
        self._truth: dict[tuple[str, bool], Overlay] = {}
        self._renderers: dict[str, dg.Renderer] = {}
        self._scenes: dict[tuple[str, dg.Relief], dg.Scene] = {}  # of the techniques that were judged last

    def judge(self, setting: Setting) -> dict[str, Judged]:
        """The errors of a setting by view. Raises DecalError where it does not draw the map."""
        setting = replace(setting, renderer={**ALL_SAMPLES, **setting.renderer})
        over_black, held = self._drawn(setting, BLACK)
        over_white, _ = self._drawn(setting, WHITE)
        found = {}
        for view in self._cameras:
            errors, whole = self._compared(setting, view, over_black[view], over_white[view])
            found[view] = Judged({**errors, "layers_bytes": held[view]}, _over_ground(whole))
        return found

    def judge_ground(self) -> dict[str, Row]:
        """By view, how far the layers are from where they lie on all samples of the terrain, by its level of detail."""
        detail, _ = self._drawn(BY_DETAIL, BLACK, None)
        every, _ = self._drawn(replace(BY_DETAIL, renderer=ALL_SAMPLES), BLACK, None)
        found: dict[str, Row] = {}
        for view in self._cameras:
            apart = np.abs(detail[view] - every[view])
            moved = (apart.max(axis=-1) > MOVED).mean()
            found[view] = {"ground_rms": float(np.sqrt((apart**2).mean())), "ground_moved": float(moved)}
        return found

    def true_picture(self, view: str) -> NDArray[np.uint8]:
        """The crop as the reference draws it, lines in metres."""
        return _over_ground(self._true(view, pixels=False).rgba)

    def _drawn(
        self, setting: Setting, relief: dg.Relief, background: str | None = "sky"
    ) -> tuple[dict[str, FloatArray], dict[str, int]]:
        """The pictures by view, and how many bytes the layers held, prepared data and GL objects."""
        key = repr(sorted(setting.renderer.items(), key=str))
        renderer = self._renderers.setdefault(key, dg.Renderer(self._size, **setting.renderer))
        renderer.set_picture(self._size, setting.antialias)
        renderer.preprocess(self._scene(setting, relief))
        pictures, held = {}, {}
        for view, camera in self._cameras.items():
            renderer.update(camera)
            frame = renderer.render(background=background)
            pictures[view] = frame.image[..., :3] / 255.0
            held[view] = sum(count for name, count in frame.stats.bytes.items() if name in LAYER_PASSES)
        return pictures, held

    def _scene(self, setting: Setting, relief: dg.Relief) -> dg.Scene:
        """Settings that follow each other often draw the same scenes."""
        techniques = repr((setting.polygons, setting.lines, setting.pixels))
        if (techniques, BLACK) not in self._scenes:
            self._scenes = {
                (techniques, each): self._map.scene(setting.polygons, setting.lines, setting.pixels, each)
                for each in (BLACK, WHITE)
            }
        return self._scenes[techniques, relief]

    def _compared(
        self, setting: Setting, view: str, black: FloatArray, white: FloatArray
    ) -> tuple[Row, FloatArray]:
        """The errors, and colour and coverage of the whole picture."""
        alpha = 1.0 - (white - black).mean(axis=-1, keepdims=True)
        whole = np.concatenate([black, alpha], axis=-1)
        left, top, right, bottom = self.crop
        true = self._true(view, setting.pixels)
        found = reference.compare_overlay(
            whole[top:bottom, left:right], true, ignore=true.terrain_fraction < 1.0
        )
        errors: Row = {
            "image_rms": found.image_rms,
            "image_max": found.image_maximum,
            "edge_rms": found.rms,
            "edge_p99": found.p99,
            "coverage_rms": found.alpha_rms,
            "coverage_max": found.alpha_maximum,
            "leak": found.leak,
            "partly_covered": found.partial / max(1, found.pixels),
        }
        return errors, whole

    def _true(self, view: str, pixels: bool) -> Overlay:
        if (view, pixels) not in self._truth:
            scene = self._map.scene("auto", "auto", pixels)
            camera = self._cameras[view]
            near = seen_part(scene, camera, self._size, self.crop)
            self._truth[view, pixels] = reference.render_overlay(near, camera, self._size, self.crop, SAMPLES)
        return self._truth[view, pixels]


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
