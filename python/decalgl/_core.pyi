"""The C++ core. Use the classes of the package decalgl instead."""

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

__version__: str

class Relief:
    color: Sequence[int]
    ramp: Sequence[int]
    lowest: float
    highest: float
    azimuth: float
    altitude: float
    strength: float
    on_layers: float
    def __init__(self) -> None: ...

class Corner:
    __members__: dict[str, Corner]

class Cap:
    __members__: dict[str, Cap]

class SlopeCorrection:
    __members__: dict[str, SlopeCorrection]

class OutlineMode:
    __members__: dict[str, OutlineMode]

class OutlineOrder:
    __members__: dict[str, OutlineOrder]

class PatternMark:
    def __init__(self, begin: float, end: float, begin_width: float, end_width: float) -> None: ...

class LinePattern:
    def __init__(
        self, period: float, offset: float, marks: Sequence[PatternMark], in_pixels: bool = False
    ) -> None: ...

class ColorBand:
    def __init__(self, reach: float, color: Sequence[int]) -> None: ...

class StrokeStyle:
    corner: Corner
    cap: Cap
    miter_limit: float
    slope_correction: SlopeCorrection
    pattern: LinePattern
    bands: Sequence[ColorBand]
    def __init__(self) -> None: ...

class Stroke:
    colors: NDArray[np.uint8]
    widths: NDArray[np.float64]
    styles: Sequence[StrokeStyle]
    style_of: NDArray[np.uint32]
    widest: float
    in_pixels: bool
    limits: tuple[float, float, float, float]
    margins: NDArray[np.float64]
    def __init__(self) -> None: ...

class Hatch:
    def __init__(self, spacing: float, width: float, angle: float, crossed: bool) -> None: ...

class Fill:
    colors: NDArray[np.uint8]
    hatches: Sequence[Hatch]
    hatch_of: NDArray[np.uint32]
    def __init__(self) -> None: ...

class DecalLook:
    colors: NDArray[np.uint8]
    widths: NDArray[np.float64]
    styles: list[StrokeStyle]
    style_of: NDArray[np.uint32]
    hatches: list[Hatch]
    hatch_of: NDArray[np.uint32]
    def __init__(self) -> None: ...

class LayerLook:
    layer: int
    fill: DecalLook
    stroke: DecalLook
    casing: DecalLook
    draw_order: NDArray[np.int64]
    technique_options: TechniqueOptions | None
    def __init__(self) -> None: ...

class LayerEdit:
    fill: DecalLook
    stroke: DecalLook
    casing: DecalLook
    def __init__(
        self,
        layer: int,
        polygons: bool,
        removed: NDArray[np.uint32],
        replaced: NDArray[np.uint32],
        coordinates: NDArray[np.float64],
        part_offsets: NDArray[np.int64],
        feature_offsets: NDArray[np.int64],
        rows: NDArray[np.int64],
    ) -> None: ...

class Lens:
    def __init__(
        self,
        x: float,
        y: float,
        radius: float,
        coordinates: Sequence[float],
        ring_offsets: Sequence[int],
    ) -> None: ...

class TechniqueOptions: ...

class DetailEye:
    def __init__(self) -> None: ...
    eye: Sequence[float]
    forward: Sequence[float]
    pixels: float
    corner: float
    metres_per_pixel: float

class LoopsDetail:
    def __init__(self) -> None: ...
    uniform: float
    screen: float
    lens: float
    lens_centre: tuple[float, float]
    lens_radius: float
    heat_top: float
    def set_steps(self, steps: Sequence[tuple[float, float]]) -> None: ...
    def set_eye(self, eye: DetailEye) -> None: ...
    def set_shows(self, name: str) -> None: ...

class LoopsBvh:
    def __init__(self) -> None: ...
    primary_branching: Sequence[int]
    node_capacity: int
    largest_share: float
    secondary_depths: Sequence[int]
    secondary_branching: Sequence[int]
    coverage_depth: int
    minimum_coverage: float

class LoopsChoice(TechniqueOptions):
    def __init__(
        self,
        order: str | Callable[[NDArray[np.float64]], tuple[Any, Any]],
        segments: bool,
        bvh: LoopsBvh | None,
        detail: LoopsDetail,
    ) -> None: ...

def loops_simplified(
    polygons: bool,
    coordinates: NDArray[np.float64],
    part_offsets: NDArray[np.int64],
    feature_offsets: NDArray[np.int64],
    bounds: Sequence[float],
    tolerances: Sequence[float],
    choice: LoopsChoice,
) -> list[tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]]: ...

class ClipmapOptions(TechniqueOptions):
    def __init__(
        self,
        solution: int,
        joints: int,
        bevel_below: float,
        thin_below: float,
        widest_line: float,
        widen_from: float,
        widen_to: float,
        window: int,
        samples: int,
        anisotropy: int,
        tiles_a_frame: int,
    ) -> None: ...

class VolumeOptions(TechniqueOptions):
    def __init__(self, exact: bool, arc_step: float) -> None: ...

class DynamicOptions(TechniqueOptions):
    def __init__(self, method: str, width_rule: str, cell: float) -> None: ...

class NetworkStyle:
    lod: float
    width: float
    main: float
    main_color: Sequence[float]
    border_color: Sequence[float]
    texture_share: float
    def __init__(self) -> None: ...

class NetworkCategory:
    name: str
    styles: Sequence[NetworkStyle]
    caps: Sequence[int]
    slope_correction: SlopeCorrection
    pattern: LinePattern
    raster: int
    raster_length: float
    sketch: tuple[float, float]
    def __init__(self) -> None: ...

class LodSource:
    __members__: dict[str, LodSource]

class LodSpace:
    __members__: dict[str, LodSpace]

class LodPlace:
    __members__: dict[str, LodPlace]

class FieldBlending:
    __members__: dict[str, FieldBlending]

class DropOff:
    __members__: dict[str, DropOff]

class Borders:
    __members__: dict[str, Borders]

class LevelOfDetail:
    source: LodSource
    value: float
    near: float
    far: float
    space: LodSpace
    extent: Sequence[float]
    def __init__(self) -> None: ...
    def set_texels(self, texels: NDArray[np.uint8]) -> None: ...

class DistanceFieldOptions(TechniqueOptions):
    categories: Sequence[NetworkCategory]
    lod: LevelOfDetail
    widths_at: LodPlace
    bits: int
    drop_off: DropOff
    blending: FieldBlending
    borders: Borders
    keep_depth: bool
    mend_intrusion: bool
    mend_protrusion: bool
    def __init__(self) -> None: ...
    def set_category_of(self, category_of: NDArray[np.uint32]) -> None: ...
    def add_raster(self, texels: NDArray[np.uint8]) -> None: ...
    def add_drop_off(self, texels: NDArray[np.uint8]) -> None: ...

class Scene:
    def __init__(
        self,
        heights: NDArray[np.float32],
        x0: float,
        y0: float,
        dx: float,
        dy: float,
        exaggeration: float,
        relief: Relief,
    ) -> None: ...
    def add_layer(
        self,
        name: str,
        technique: str,
        technique_options: TechniqueOptions | None,
        polygons: bool,
        coordinates: NDArray[np.float64],
        part_offsets: NDArray[np.int64],
        feature_offsets: NDArray[np.int64],
        rows: NDArray[np.int64],
        fill: Fill,
        stroke: Stroke,
        casing: Stroke,
        outline_mode: OutlineMode,
        outline_order: OutlineOrder,
        draw_order: NDArray[np.int64],
    ) -> None: ...
    def set_triangles(
        self, layer: int, coordinates: NDArray[np.float64], first_of: NDArray[np.int64]
    ) -> None: ...

class Camera:
    def __init__(
        self,
        eye: Sequence[float],
        target: Sequence[float],
        up: Sequence[float],
        fov: float,
        view_height: float,
    ) -> None: ...

class Frame:
    @property
    def image(self) -> NDArray[np.uint8]: ...
    @property
    def ids(self) -> NDArray[np.int64]: ...
    @property
    def layers(self) -> NDArray[np.int32]: ...
    @property
    def depth(self) -> NDArray[np.float32]: ...
    @property
    def world(self) -> NDArray[np.float64]: ...
    @property
    def stats(self) -> dict[str, Any]: ...
    def pick(self, x: int, y: int) -> list[tuple[int, int]]: ...

class Renderer:
    def __init__(
        self,
        width: int,
        height: int,
        antialias: str,
        terrain_error: float,
        memory_limit: int,
        backend: str,
        threads: int,
        rectangle: int,
        index: str,
        bvh: dict[str, Any],
        coverage: str = "exact",
        samples: int = 8,
    ) -> None: ...
    def set_picture(self, width: int, height: int, antialias: str) -> None: ...
    def preprocess(
        self, scene: Scene, progress: Callable[[str, float], bool | None] | None, cache: bytes = b""
    ) -> None: ...
    def save(self, path: bytes) -> None: ...
    def open(self, path: bytes) -> None: ...
    def look(self, layer: int) -> LayerLook: ...
    def restyle(self, looks: Sequence[LayerLook]) -> None: ...
    def edit(self, edit: LayerEdit) -> None: ...
    def set_lens(self, lens: Lens, looks: Sequence[LayerLook]) -> None: ...
    def move_lens(self, lens: Lens) -> None: ...
    def remove_lens(self) -> None: ...
    def layers(self) -> list[tuple[str, Literal["polygons", "lines"], NDArray[np.int64]]]: ...
    def bounds(self) -> tuple[float, float, float, float]: ...
    def update(self, camera: Camera) -> dict[str, int]: ...
    def render(
        self, sky_low: tuple[float, float, float, float], sky_high: tuple[float, float, float, float]
    ) -> Frame: ...
    def forget(self, ground: bool) -> None: ...
    def time_floor(self) -> float: ...
    def count_fragments(self) -> int: ...

def ascending(keys: NDArray[np.float64]) -> NDArray[np.int64]: ...
def describe_saved_scene(path: bytes) -> dict[str, Any]: ...
def is_saved_scene(path: bytes) -> bool: ...
def probe_backends() -> list[dict[str, Any]]: ...
def time_radix_sort(count: int, threads: int) -> float: ...
