"""The renderer: preprocess a scene or open a saved one, update to a camera, render a frame.

scene ──▶ preprocess ──▶ update(camera) ──▶ render ──▶ Frame
          all cores, no GL   GL from here on
          save │ ▲ open
               ▼ │
              a file
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from . import _core
from ._antialias import checked_antialias, checked_samples
from ._changes import LayerChanges
from ._colors import parse_color
from ._core_scene import core_scene
from ._raster import check_memory
from .camera import checked_size
from .errors import CancelledError, InputError, warn
from .frame import Frame, PreparedLayer
from .indexes import BvhIndex, resolve_index

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from ._looks import LayerState
    from .camera import Camera
    from .lens import Lens
    from .scene import Layer, Scene

    AnyLayer: TypeAlias = Layer | PreparedLayer
    PathLike = str | os.PathLike[str]

    Rgba = tuple[float, float, float, float]
    Progress = Callable[[str, float], bool | None]

COVERAGES = ("exact", "thoeny")
BACKENDS = ("auto", "egl", "osmesa")
# At the horizon, and 45 degrees above it.
SKY: tuple[Rgba, Rgba] = ((0.87, 0.91, 0.94, 1.0), (0.53, 0.70, 0.86, 1.0))
MOST_THREADS = 1024
LARGEST_SIDE = 1 << 20
COVERAGE_SAMPLES = 64
LARGE_PICTURE = 1 << 22  # pixels; a smaller picture is not worth asking how much memory there is
IMAGE_BYTES, SURFACE_BYTES, TARGET_SIDE = 4, 64, 4096
MULTISAMPLED_BYTES, MULTISAMPLED_SIDE = 40, 2048  # a sample


class Renderer:
    """Draws scenes in a GL context of its own, which opens with the first `update`.

    size: (width, height) of the picture in pixels.
    antialias: "coverage" (each pixel shows the mean over its area), "none" (its centre), "ssaa" or "msaa" (the mean of
        samples, each a whole picture; the second with the driver's samples) or "fxaa" (smoothed afterwards).
    terrain_error: pixels on the screen that the terrain's level of detail may be off; 0 draws every sample.
    memory_limit: bytes for prepared data and GL objects together; None: no limit.
    backend: "auto", "egl" or "osmesa".
    threads: for preprocessing; None: all cores.
    tile: larger pictures are drawn in squares of this many pixels; None: chosen. The picture is the same.
    index: of static layers, "grid" (the faster one), "bvh", "thoeny" or a `BvhIndex`: see `decalgl.indexes`.
    coverage: what antialias="coverage" is: "exact", the mean over each pixel's area, or "thoeny", an estimate for
        lines after Thöny et al. 2018: see docs/techniques/static.md.
    samples: a pixel, of "ssaa" and "msaa": 1, 2, 4, 8, 16 or 32.

    Call everything but `preprocess`, `save` and `open` from one thread. A call that fails leaves the renderer usable.
    Raises InputError for arguments out of range.
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
        index: str | BvhIndex = "grid",
        coverage: str = "exact",
        samples: int = 8,
    ) -> None:
        if backend not in BACKENDS:
            raise InputError(f"There is no backend {backend!r}; choose 'auto', 'egl' or 'osmesa'.")
        if coverage not in COVERAGES:
            raise InputError(f"There is no coverage={coverage!r}; choose 'exact' or 'thoeny'.")
        width, height = _checked_picture(size)
        core_index, bvh = resolve_index(index)
        self._options = {
            "terrain_error": terrain_error,
            "memory_limit": memory_limit,
            "backend": backend,
            "threads": threads,
            "tile": tile,
            "index": index,
            "coverage": coverage,
            "samples": samples,
        }
        self.antialias = antialias
        self._samples = checked_samples(samples)
        self._core = _core.Renderer(
            width=width,
            height=height,
            antialias=checked_antialias(antialias),
            terrain_error=_checked_error(terrain_error),
            memory_limit=_checked_count(memory_limit, "memory_limit", "bytes", 2**63),
            backend=backend,
            threads=_checked_count(threads, "threads", "threads", MOST_THREADS),
            rectangle=_checked_count(tile, "tile", "pixels", LARGEST_SIDE),
            index=core_index,
            bvh=bvh.to_dict(),
            coverage=coverage,
            samples=self._samples,
        )
        self.size = (width, height)
        self._changes = LayerChanges(self._core)
        self._prepared: tuple[Any, ...] = ()
        self._cache: bytes = b""
        self._prepared_layers: tuple[AnyLayer, ...] = ()
        self._updated_layers: tuple[AnyLayer, ...] = ()
        self._updated_states: Mapping[int, LayerState] = {}

    def has_options(self, given: Mapping[str, Any]) -> bool:
        """Whether this renderer is what `given`, arguments other than size and antialias, asks for."""
        return self._options == {**DEFAULT_OPTIONS, **given}

    def set_picture(self, size: tuple[int, int], antialias: str) -> None:
        """The size and anti-aliasing of the pictures from the next `update` on."""
        width, height = _checked_picture(size)
        self._core.set_picture(width, height, checked_antialias(antialias))
        self.antialias = antialias
        self.size = (width, height)

    def preprocess(
        self, scene: Scene, progress: Progress | None = None, cache: PathLike | None = None
    ) -> None:
        """Builds the index of a scene on all cores; does nothing where the scene is as it was last time.

        progress: called with the stage's name and the fraction done, from the calling thread. Returning False
            stops the work with CancelledError; an exception of its own stops it too and comes back.
        cache: a file that is opened, as by `open`, where it was saved from exactly this scene. Where it was
            not, is damaged or is not there, the scene is prepared and saved to it.

        Raises MemoryLimitError where the index does not fit, FileError where the cache cannot be written or is
        another kind of file. What was prepared before then stays.
        """
        state = (scene.terrain, scene.exaggeration, scene.relief, scene.layers)
        cache_name = b"" if cache is None else _file_name(cache)
        is_there = self._prepared == state and cache_name in (b"", self._cache)
        if is_there and not self._changes:
            return
        stop = _ExceptionKeeper(progress) if progress is not None else None
        try:
            self._core.preprocess(core_scene(scene), stop, cache_name)
        except CancelledError:
            if stop is not None and stop.error is not None:
                raise stop.error from None
            raise
        for layer in scene.layers:
            layer.technique.warn_of_layer(layer)
        self._prepared = state
        self._cache = cache_name
        self._prepared_layers = scene.layers
        self._changes.begin(scene.layers, scene.terrain.crs)

    def save(self, path: PathLike) -> None:
        """Writes what is prepared to a file that `open` takes; a file that is there is replaced as a whole.

        Raises InputError where nothing is prepared, FileError where it cannot be written.
        """
        self._core.save(_file_name(path))

    def open(self, path: PathLike) -> None:
        """Takes what was saved in place of `preprocess`; the scene and its data are not needed.

        Pictures, ids and picks are the same as those of the renderer that saved the file. The file is mapped
        into memory and checked: while it is in use, replace it with `save`, but do not write into it.

        Raises FileError that says what is wrong with the file and what to do.
        """
        self._core.open(_file_name(path))
        self._prepared = ()
        self._cache = b""
        self._prepared_layers = tuple(
            PreparedLayer(name, index, kind, rows)
            for index, (name, kind, rows) in enumerate(self._core.layers())
        )
        self._changes.begin(self._prepared_layers)

    def restyle(self, layer: AnyLayer | str | int, **keywords: Any) -> None:
        """Other looks for a layer, without preparing anew; the next `render` shows them.

        layer: a layer of the scene, its name or its place.
        color, column, cmap, vmin, vmax, norm, alpha, categorical, missing_kwds: colours, as in
            `Scene.add_polygons`; of the fills of polygons or the strokes of lines. cmap= and vmin= ... without
            column= colour by the column of before.
        width: metres, one or one a row, up to the `widest` that the layer was made with. Casings keep what they show on
            each side, and patterns their lengths.
        visible: which features are there: True or False, one a row, an expression by column such as
            "kind == 'primary' and lanes >= 2", or a function that takes the columns and gives one a row.
        opacity: a factor on what is seen, 0 to 1: one, one a row, or {category: factor} by the column `by`,
            which is the one that the layer is coloured by unless another is named. It fades what has colours.
        order: "feature", "size", a column or numbers, as in `Scene.add_polygons`.
        where: the rows that all of this but `order` changes, given as `visible` is; the others stay as they are.
        technique: the layer's own with other choices, such as a `DistanceField` with other styles.
        corner, miter_limit, dash, bands, hatch: as in `Scene.add_lines` and `add_polygons`, as far as the index has
            their places (docs/interaction.md); hatch=False is an even fill.
        outline, casing: dicts of color ... width and styles, for outlines of polygons and casings of lines.

        Each keyword stays until it is given again. What the scene says is not changed: `preprocess(scene)` gives
        the original again. Frames of before, their ids and picks stay right.

        Raises StyleError, ColumnError, InputError and UnsupportedError, which leave everything as it was.
        """
        self._changes.restyle(layer, keywords)

    def edit(
        self,
        layer: AnyLayer | str | int,
        *,
        add: Any = None,
        remove: Any = None,
        move: Mapping[int, tuple[float, float]] | None = None,
        replace: Mapping[int, Any] | None = None,
        **style: Any,
    ) -> NDArray[np.int64]:
        """Adds, removes, moves and replaces features of a layer; only what lies around them is prepared anew.

        add: features, as `Scene.add_polygons` and `add_lines` read them; geometries alone are in the scene's
            CRS, as `frame.world` is, unless crs= says another. They come on top of the layer, and their rows
            follow those of the layer's data.
        remove: rows. move: {row: (dx, dy)} in metres. replace: {row: geometry}, in the scene's CRS unless crs=
            says another.
        style: color, column, cmap ... alpha and width of what is added, and crs. Without, it looks as the
            layer does, where that is of one colour and width. Outlines and casings are those of the layer.

        Returns the rows of what was added, int64, those without geometry left out. The next `render` shows the
        edit. As with `restyle`, the scene is not changed, and frames of before stay right.

        Raises InputError for rows without a feature, what `Scene.add_lines` raises, and UnsupportedError for
        what `open` took from a file, which has no vertices; all leave everything as it was.
        """
        return self._changes.edit(layer, add, remove, move, replace, style)

    @property
    def lens(self) -> Lens | None:
        """A part of the picture in which layers look otherwise, or None. A lens that is `moved` costs nothing.

        Raises what `restyle` raises.
        """
        return self._changes.lens

    @lens.setter
    def lens(self, lens: Lens | None) -> None:
        self._changes.set_lens(lens)

    @property
    def layers(self) -> tuple[AnyLayer, ...]:
        """The layers of what is prepared, bottom to top: the scene's, or names and rows after `open`."""
        return self._prepared_layers

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(min x, min y, max x, max y) of the prepared terrain. Raises InputError where there is none."""
        return self._core.bounds()

    def update(self, camera: Camera) -> dict[str, int]:
        """Makes ready to draw from a camera.

        Returns counters: `pieces` in the index, `bytes` of GL memory, `longest_walk`, the most pieces that one
        point of a pixel looks at, and `shader_steps`, the most that the driver's shaders can (0: no limit).
        Warns where a pixel may need more. Raises GraphicsError where there is no OpenGL, naming what was tried
        and what to install, and MemoryLimitError where the picture or the scene does not fit.
        """
        width, height = self.size
        if width * height > LARGE_PICTURE:
            targets = _target_bytes(self.size, self.antialias, self._samples)
            needed = IMAGE_BYTES * width * height + targets
            check_memory(needed, f"A picture of {width} x {height} pixels", "draw", "Ask for a smaller size.")
        fitted = camera.for_size(self.size)
        report = self._core.update(
            _core.Camera(
                eye=fitted.eye,
                target=fitted.target,
                up=fitted.up,
                fov=45.0 if fitted.fov is None else fitted.fov,
                view_height=fitted.view_height or 0.0,
            )
        )
        # The other indexes draw one sample after the other.
        sampled = self.antialias == "coverage" and self._options["index"] == "grid"
        _warn_of_long_walks(report, COVERAGE_SAMPLES if sampled else 1)
        layers = [one for one in self._prepared_layers if not isinstance(one, PreparedLayer)]
        for technique in {layer.technique.name: layer.technique for layer in layers}.values():
            technique.warn_of_view(fitted)
        self._updated_layers = self._prepared_layers
        return report

    def render(self, background: Any = "sky") -> Frame:
        """The picture from the camera of the last `update`.

        What has not changed since the last picture is not drawn again: the same view of the same scene costs
        nothing, and another look of a layer draws the layers alone.

        background: "sky", a colour, or None for transparent (alpha 0) where there is no terrain.
        """
        low, high = drawn_background(background)
        if self._updated_layers is self._prepared_layers:
            self._updated_states = self._changes.states
        frame = self._core.render(low, high)
        _warn_of_rounding(frame.stats["counts"])
        return Frame(frame, self._updated_layers, self._updated_states)

    def forget(self, ground: bool = True) -> None:
        """Makes the next `update` and `render` begin anew, for those who time them. What is uploaded stays.

        ground: False keeps what was drawn of the terrain, as long as the camera stays.
        """
        self._core.forget(ground)

    def time_floor(self) -> float:
        """Milliseconds of the pass that overlay passes are measured against: read depth, write a colour."""
        return self._core.time_floor()

    def count_fragments(self) -> int:
        """Samples that the layers' passes write for the view in hand, which are drawn for it once more: what is drawn
        ahead for a view, such as tiles of textures, counts where it is not there yet.
        """
        return self._core.count_fragments()


def _warn_of_rounding(counts: Mapping[str, float]) -> None:
    if counts["quantum_px"] > MOST_ROUNDED:
        warn(
            f"In the middle of this picture, layers may be {counts['quantum_px']:.3g} pixels off: over a terrain of"
            f" this size, vertices are kept to {counts['quantum_m']:.3g} m, and positions to micrometres at best. Cut"
            " the terrain to what you look at, or stay farther away."
        )


# Pixels that positions may be rounded by without a warning. Both ends of a gap, and the ground, are rounded each.
MOST_ROUNDED = 0.25
DEFAULT_OPTIONS = {
    "terrain_error": 0.5,
    "memory_limit": None,
    "backend": "auto",
    "threads": None,
    "tile": None,
    "index": "grid",
    "coverage": "exact",
    "samples": 8,
}


class _ExceptionKeeper:
    """A progress callback whose exception stops the work and is raised again afterwards."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self.error: BaseException | None = None

    def __call__(self, stage: str, fraction: float) -> bool:
        try:
            answer = self._progress(stage, fraction)
        except BaseException as error:
            self.error = error
            return False
        return not (isinstance(answer, (bool, np.bool_)) and not answer)


def _warn_of_long_walks(report: dict[str, int], visits: int) -> None:
    """Some drivers end a shader that takes too long, and what lies lowest is then missing from a pixel."""
    if report["shader_steps"] and report["longest_walk"] * visits > report["shader_steps"]:
        warn(
            f"One cell of the index holds {report['longest_walk']:,} pieces, and this driver's shaders stop after"
            f" {report['shader_steps']:,} steps: where that many features lie under one pixel, the lowest may be"
            " missing. Look closer, leave features out, use antialias='none', or draw on a GPU."
        )


def _target_bytes(size: tuple[int, int], antialias: str, samples: int) -> int:
    """What the largest rectangle that is drawn at once takes."""
    multisampled = antialias == "msaa"
    side = MULTISAMPLED_SIDE if multisampled else TARGET_SIDE
    pixel = SURFACE_BYTES + (MULTISAMPLED_BYTES * samples if multisampled else 0)
    return pixel * min(size[0], side) * min(size[1], side)


def _file_name(path: Any) -> bytes:
    """A path as the system takes it. Raises InputError for what is none."""
    try:
        name = os.fsencode(path)
    except (TypeError, UnicodeEncodeError) as error:
        raise InputError(f"A path must be a str or a Path, but it is {path!r}.") from error
    if not name:
        raise InputError("The path is empty. Name a file.")
    return name


def drawn_background(background: Any) -> tuple[Rgba, Rgba]:
    """The colours at the horizon and 45 degrees above it. Raises StyleError."""
    if background is None:
        return (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    if isinstance(background, str) and background == "sky":
        return SKY
    color = parse_color(background)
    return color, color


def _checked_picture(size: tuple[int, int]) -> tuple[int, int]:
    width, height = checked_size(size)
    if max(width, height) > LARGEST_SIDE:
        raise InputError(f"size must be at most {LARGEST_SIDE} pixels a side, but it is {size!r}.")
    return width, height


def _checked_error(value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not 0.0 <= number < np.inf:
        raise InputError(f"terrain_error must be a number of pixels, zero or more, but it is {value!r}.")
    return number


def _checked_count(value: Any, name: str, unit: str, most: int) -> int:
    """A whole number from 1 to `most`; 0 for None, as the core takes it."""
    if value is None:
        return 0
    try:
        number = int(value)
        whole = number == value
    except (TypeError, ValueError, OverflowError):
        number, whole = 0, False
    if not whole or not 1 <= number < most:
        raise InputError(
            f"{name} must be a whole number of {unit} above 0 and below {most}, or None, but it is {value!r}."
        )
    return number
