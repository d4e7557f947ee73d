"""The renderer: preprocess a scene, update to a camera, render a frame.

    scene ──▶ preprocess ──▶ update(camera) ──▶ render ──▶ Frame
              all cores, no GL   GL from here on
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._colors import colormap, parse_color
from .errors import CancelledError, InputError, UnsupportedError
from .frame import Frame

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .camera import Camera
    from .scene import Layer, Scene

    Rgba = tuple[float, float, float, float]

ANTIALIAS = ("none", "coverage")
PLANNED_ANTIALIAS = ("msaa", "ssaa", "fxaa")
SKY: tuple[Rgba, Rgba] = ((0.87, 0.91, 0.94, 1.0), (0.53, 0.70, 0.86, 1.0))  # at the horizon, 45 degrees above it


class Renderer:
    """Draws scenes in a GL context of its own, which opens with the first `update`.

    size: (width, height) of the picture in pixels.
    antialias: "coverage" (each pixel shows the mean over its area) or "none" (its centre).
    terrain_error: pixels on the screen that the terrain's level of detail may be off; 0 draws every sample.
    memory_limit: bytes for prepared data and GL objects together; None: no limit.
    backend: "auto", "egl" or "osmesa".
    threads: for preprocessing; None: all cores.
    tile: larger pictures are drawn in squares of this many pixels; None: chosen. The picture is the same.

    Call everything but `preprocess` from one thread. A call that fails leaves the renderer usable.
    """

    def __init__(
        self,
        size: tuple[int, int] = (1280, 720),
        antialias: str = "coverage",
        terrain_error: float = 0.5,
        memory_limit: int | None = None,
        backend: str = "auto",
        threads: int | None = None,
        tile: int | None = None,
    ) -> None:
        width, height = _checked_size(size)
        given = {
            "terrain_error": terrain_error,
            "memory_limit": memory_limit,
            "backend": backend,
            "threads": threads,
            "tile": tile,
        }
        defaults = {"terrain_error": 0.5, "backend": "auto"}
        self.keywords = {name: value for name, value in given.items() if value != defaults.get(name)}
        if backend not in ("auto", "egl", "osmesa"):
            raise InputError(f"There is no backend {backend!r}; choose 'auto', 'egl' or 'osmesa'.")
        self.size = (width, height)
        self._core = _core.Renderer(
            width=width,
            height=height,
            antialias=_checked_antialias(antialias),
            terrain_error=_at_least(terrain_error, 0.0, "terrain_error"),
            memory_limit=int(_at_least(memory_limit or 0, 0, "memory_limit")),
            backend=backend,
            threads=int(_at_least(threads or 0, 0, "threads")),
            rectangle=int(_at_least(tile or 0, 0, "tile")),
        )
        self._prepared: tuple[Any, ...] = ()
        self._layers: tuple[Layer, ...] = ()

    def set_picture(self, size: tuple[int, int], antialias: str) -> None:
        """The size and anti-aliasing of the pictures from the next `update` on."""
        width, height = _checked_size(size)
        self._core.set_picture(width, height, _checked_antialias(antialias))
        self.size = (width, height)

    def preprocess(self, scene: Scene, progress: Callable[[str, float], bool | None] | None = None) -> None:
        """Builds the index of a scene on all cores; does nothing where the scene is as it was last time.

        progress: called with the stage's name and the fraction done, from the calling thread; returning False stops
        the work with CancelledError.
        """
        state = (scene.terrain, scene.exaggeration, scene.relief, scene.layers)
        if self._prepared == state:
            return
        stop = _ExceptionKeeper(progress) if progress is not None else None
        try:
            self._core.preprocess(_core_scene(scene), stop)
        except CancelledError:
            if stop is not None and stop.error is not None:
                raise stop.error from None
            raise
        self._prepared = state
        self._layers = scene.layers

    def update(self, camera: Camera) -> dict[str, int]:
        """Makes ready to draw from a camera. Returns counters: `pieces` in the index and `bytes` of GL memory.

        Raises GraphicsError where there is no OpenGL, naming what was tried and what to install, and
        MemoryLimitError where the picture or the scene does not fit.
        """
        fitted = camera.for_size(self.size)
        return self._core.update(
            _core.Camera(
                eye=fitted.eye,
                target=fitted.target,
                up=fitted.up,
                fov=45.0 if fitted.is_orthographic else float(fitted.fov or 45.0),
                view_height=float(fitted.view_height or 0.0) if fitted.is_orthographic else 0.0,
            )
        )

    def render(self, background: Any = "sky") -> Frame:
        """The picture from the camera of the last `update`.

        background: "sky", a colour, or None for transparent (alpha 0) where there is no terrain.
        """
        low, high = _background(background)
        return Frame(self._core.render(low, high), self._layers)

    def time_floor(self) -> float:
        """Milliseconds of the pass that overlay passes are measured against: read depth, write a colour."""
        return self._core.time_floor()


class _ExceptionKeeper:
    """A progress callback whose exception stops the work and is raised again afterwards."""

    def __init__(self, progress: Callable[[str, float], bool | None]) -> None:
        self._progress = progress
        self.error: BaseException | None = None

    def __call__(self, stage: str, fraction: float) -> bool:
        try:
            return self._progress(stage, fraction) is not False
        except BaseException as error:
            self.error = error
            return False


def _core_scene(scene: Scene) -> _core.Scene:
    terrain = scene.terrain
    result = _core.Scene(
        heights=terrain.z,
        x0=terrain.x0,
        y0=terrain.y0,
        dx=terrain.dx,
        dy=terrain.dy,
        exaggeration=scene.exaggeration,
        relief=_core_relief(scene),
    )
    for layer in scene.layers:
        polygons = layer.features.kind == "polygons"
        result.add_layer(
            name=layer.name,
            polygons=polygons,
            coordinates=layer.features.coords,
            part_offsets=layer.features.part_offsets,
            feature_offsets=layer.features.feature_offsets,
            rows=layer.features.rows,
            colors=layer.colors,
            widths=np.zeros(0) if polygons else layer.widths,
            draw_order=layer.draw_order,
        )
    return result


def _core_relief(scene: Scene) -> _core.Relief:
    relief = _core.Relief()
    given = scene.relief
    relief.color = [round(255 * channel) for channel in parse_color(given.color)[:3]]
    relief.azimuth, relief.altitude = given.azimuth, given.altitude
    relief.strength, relief.on_layers = given.strength, given.on_layers
    if given.cmap is not None:
        finite = scene.heights[np.isfinite(scene.heights)]
        lowest = float(finite.min()) if given.vmin is None and finite.size else float(given.vmin or 0.0)
        highest = float(finite.max()) if given.vmax is None and finite.size else float(given.vmax or 0.0)
        ramp = colormap(given.cmap)(np.linspace(0.0, 1.0, 256))
        relief.ramp = np.rint(255 * ramp[:, :3]).astype(np.uint8).ravel().tolist()
        relief.lowest, relief.highest = lowest, max(highest, lowest + 1e-6)
    return relief


def _background(background: Any) -> tuple[Rgba, Rgba]:
    if background is None:
        return (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    if isinstance(background, str) and background == "sky":
        return SKY
    color = parse_color(background)
    return color, color


def _checked_size(size: Sequence[int]) -> tuple[int, int]:
    try:
        width, height = (int(side) for side in size)
        whole = (width, height) == tuple(size)
    except (TypeError, ValueError):
        whole = False
    if not whole or width < 1 or height < 1:
        raise InputError(f"size must be (width, height) in whole pixels, at least 1 each, but it is {size!r}.")
    return width, height


def _checked_antialias(antialias: str) -> str:
    if antialias in PLANNED_ANTIALIAS:
        raise UnsupportedError(f"antialias={antialias!r} is not drawn by this version; use 'coverage' or 'none'.")
    if antialias not in ANTIALIAS:
        raise InputError(f"There is no antialias={antialias!r}; choose 'coverage' or 'none'.")
    return antialias


def _at_least(value: float, least: float, name: str) -> float:
    if not np.isfinite(value) or value < least:
        raise InputError(f"{name} must be a finite number, {least:g} or more, but it is {value!r}.")
    return value
