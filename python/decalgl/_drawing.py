"""What `decalgl render` does between its flags and the frame: the scene, the camera, progress and Ctrl-C."""

from __future__ import annotations

import signal
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from .errors import CancelledError, InputError, close_matches
from .scene_file import LoadedScene, PictureOptions, data_path, load_scene

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import FrameType, TracebackType

    from rich.console import Console

    from .camera import Camera
    from .frame import Frame
    from .scene import Scene

Position = tuple[float, float, float]


@dataclass(frozen=True)
class Flags:
    """A scene given by flags instead of a file."""

    dem: Path | None = None
    exaggeration: float | None = None
    polygons: tuple[Path, ...] = ()
    lines: tuple[Path, ...] = ()
    crs: str | None = None
    column: str | None = None
    cmap: str | None = None
    color: str | None = None
    width: float | None = None

    def given(self) -> list[str]:
        """The flags that were used, as the user writes them."""
        return [f"--{name}" for name, value in vars(self).items() if value not in (None, ())]


@dataclass(frozen=True)
class Place:
    """Where to look from."""

    view: str | None = None
    eye: Position | None = None
    target: Position | None = None
    fov: float | None = None
    top_down: bool = False


@dataclass(frozen=True)
class Picture:
    """How to draw; None is what the scene file says, or the default."""

    size: tuple[int, int] | None = None
    antialias: str | None = None
    background: str | None = None
    renderer: Mapping[str, Any] = field(default_factory=dict)


class ProgressBars:
    """A bar for each stage on standard error, and Ctrl-C as a polite request.

    The first Ctrl-C makes the progress callback return False, so that the renderer stops at a clean place;
    the second one interrupts at once.
    """

    def __init__(self, console: Console, hidden: bool = False) -> None:
        columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
        self._progress = Progress(*columns, console=console, disable=hidden or not console.is_terminal)
        self._tasks: dict[str, TaskID] = {}
        self._cancelled = False
        self._previous: Any = None

    def __enter__(self) -> ProgressBars:
        self._previous = signal.signal(signal.SIGINT, self._interrupt)
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()
        signal.signal(signal.SIGINT, self._previous)

    def __call__(self, stage: str, fraction: float) -> bool:
        """The callback for the renderer: False once the user wants to stop."""
        if stage not in self._tasks:
            self._tasks[stage] = self._progress.add_task(stage, total=1.0)
        self._progress.update(self._tasks[stage], completed=fraction)
        return not self._cancelled

    def check(self) -> None:
        """Raises CancelledError once the user wants to stop; for the steps without a callback."""
        if self._cancelled:
            raise CancelledError("Drawing was cancelled.")

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        if self._cancelled:
            raise KeyboardInterrupt
        self._cancelled = True


def draw(scene_file: Path | None, flags: Flags, place: Place, picture: Picture, bars: ProgressBars) -> Frame:
    """The frame of a scene file or of a scene given by flags. Raises DecalErrors, CancelledError too."""
    bars("reading", 0.0)
    loaded = open_scene(scene_file, flags)
    bars("reading", 1.0)
    bars.check()
    options = loaded.picture
    background = options.background if picture.background is None else picture.background
    renderer = {"index": options.index, "samples": options.samples, **picture.renderer}
    frame: Frame = loaded.scene.render(
        choose_camera(loaded, place),
        size=picture.size or options.size,
        antialias=picture.antialias or options.antialias,
        background=None if background == "none" else background,
        progress=bars,
        **renderer,
    )
    bars.check()
    return frame


def open_scene(scene_file: Path | None, flags: Flags) -> LoadedScene:
    """The scene of the file or of the flags, whichever is given; both or none is an InputError."""
    if scene_file is not None:
        if given := flags.given():
            raise InputError(
                f"A scene file says by itself what {given[0]} says. Change the file, or leave it out."
            )
        return load_scene(scene_file)
    if flags.dem is None:
        raise InputError("Nothing to draw is named. Give a scene file, or --dem with a terrain raster.")
    return LoadedScene(_scene_of(flags, flags.dem), {}, PictureOptions())


def _scene_of(flags: Flags, dem: Path) -> Scene:
    from .scene import Scene
    from .terrain import Terrain

    exaggeration = 1.0 if flags.exaggeration is None else flags.exaggeration
    scene = Scene(Terrain.open(data_path(str(dem), Path())), exaggeration=exaggeration)
    color = {} if flags.color is None else {"color": flags.color}
    by_column = {key: value for key in ("column", "cmap") if (value := getattr(flags, key)) is not None}
    style = by_column or color
    if flags.cmap is not None and flags.column is None:
        raise InputError("--cmap colours by a column, but none is named. Add --column.")
    if flags.width is not None and not flags.lines:
        raise InputError("--width is the width of lines, but there are none. Add --lines.")
    if (by_column or color) and not (flags.polygons or flags.lines):
        raise InputError("There is no layer to colour. Add --polygons or --lines.")
    for path in flags.polygons:
        scene.add_polygons(data_path(str(path), Path()), name=path.name, crs=flags.crs, **style)
    width: dict[str, Any] = {} if flags.width is None else {"width": flags.width}
    line_style = color if flags.polygons else style
    for path in flags.lines:
        keywords = {"name": path.name, "crs": flags.crs, **line_style, **width}
        scene.add_lines(data_path(str(path), Path()), width_units="m", **keywords)
    return scene


def choose_camera(loaded: LoadedScene, place: Place) -> Camera:
    """The camera of the flags, else the view that is named, else the file's first, else the scene's home."""
    from .camera import Camera

    ways = [place.view is not None, place.eye is not None or place.target is not None, place.top_down]
    if sum(ways) > 1:
        raise InputError("Give one of --view, --eye with --target, and --top-down.")
    if place.eye is not None and place.target is not None:
        fov: dict[str, Any] = {} if place.fov is None else {"fov": place.fov}
        return Camera.look_at(place.eye, place.target, **fov)
    if ways[1]:
        raise InputError("--eye and --target belong together. Give both.")
    if place.fov is not None:
        raise InputError("--fov belongs to --eye and --target. Give them too.")
    if place.top_down:
        return Camera.top_down(loaded.scene.terrain.bounds)
    name = place.view or loaded.picture.view or next(iter(loaded.views), None)
    if name is None:
        return loaded.scene.home()
    if name not in loaded.views:
        listed = ", ".join(loaded.views) or "none"
        raise InputError(
            f"There is no view {name!r}. The views are: {listed}.{close_matches(name, loaded.views)}"
        )
    return loaded.views[name]
