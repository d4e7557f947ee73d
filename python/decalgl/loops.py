"""LOOPS: polygons and lines simplified where and as much as the view allows (Amiraghdam et al.).

layer = scene.add_polygons(data, technique=dg.Loops(order="wang_mueller"))
renderer.restyle(layer, technique=dg.Loops(order="wang_mueller", detail=dg.Detail(screen=1.0)))

The level of detail changes at once: nothing is prepared anew.

docs/techniques/loops.md tells what the parts are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from . import _core
from ._values import is_number
from .errors import InputError, StyleError, close_matches
from .techniques import Technique

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .camera import Camera
    from .features import FeatureTable

ORDERS = ("douglas_peucker", "wang_mueller", "visvalingam_whyatt")
PRIMITIVES = ("tri", "seg")
SHOWS = ("layers", "tested", "active")

RemovalOrder: TypeAlias = Callable[["NDArray[np.float64]"], tuple[Any, Any]]
RingArrays: TypeAlias = "tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]"


@dataclass(frozen=True)
class Detail:
    """How far off what is drawn may be, by place. Of several bounds the least counts.

    screen: pixels on the screen; None: no such bound. It bounds what is seen where errors are distances: with the order
        "douglas_peucker".
    uniform: metres, the same everywhere.
    by_distance: ((distance, tolerance), ...), metres, up to 8 pairs from the nearest to the farthest; linear between
        them and constant beyond. Tolerances must not fall.
    lens: (x, y, radius), a circle on the map with the tolerance `lens_tolerance`, in metres.
    camera: whose distances and pixels count, None for the camera that draws; camera_size: of its pictures.
    shows: "layers"; "tested" or "active" for a heat map of how many primitives each pixel looks at or finds active,
        dark blue for none and red from `heat_top` on. Heat maps are drawn with antialias="none".

    Raises InputError for values out of range, and where no bound holds everywhere.
    """

    screen: float | None = 0.5
    uniform: float | None = None
    by_distance: Sequence[tuple[float, float]] = ()
    lens: tuple[float, float, float] | None = None
    lens_tolerance: float = 0.0
    camera: Camera | None = None
    camera_size: tuple[int, int] = (1920, 1080)
    shows: str = "layers"
    heat_top: float = 64.0

    def __post_init__(self) -> None:
        for name in ("screen", "uniform"):
            value = getattr(self, name)
            if value is not None and not (is_number(value) and 0.0 <= value < math.inf):
                raise InputError(f"Detail: {name} must be zero or more, or None, but it is {value!r}.")
        for name in ("lens_tolerance", "heat_top"):
            value = getattr(self, name)
            if not (is_number(value) and 0.0 <= value < math.inf):
                raise InputError(f"Detail: {name} must be a number of zero or more, but it is {value!r}.")
        _check_choice("Detail", "shows", self.shows, SHOWS)
        if self.lens is not None and len(self.lens) != 3:
            raise InputError(f"Detail: lens must be (x, y, radius), but it is {self.lens!r}.")

    def core(self) -> _core.LoopsDetail:
        """As the core takes it."""
        detail = _core.LoopsDetail()
        detail.screen = -1.0 if self.screen is None else self.screen
        detail.uniform = -1.0 if self.uniform is None else self.uniform
        detail.set_steps([(float(distance), float(tolerance)) for distance, tolerance in self.by_distance])
        if self.lens is not None:
            detail.lens = self.lens_tolerance
            detail.lens_centre = (float(self.lens[0]), float(self.lens[1]))
            detail.lens_radius = float(self.lens[2])
        if self.camera is not None:
            detail.set_eye(_core_eye(self.camera, self.camera_size))
        detail.set_shows(self.shows)
        detail.heat_top = self.heat_top
        return detail


@dataclass(frozen=True)
class LoopsBvh:
    """Parameters of the index (section 4.5 of the paper). Branchings count a node's children: 4, 9, 16, ...

    primary_branching: level by level; empty: chosen from the data.
    node_capacity: primitives in a primary node that is not divided further.
    secondary_depths: of the secondary tree in a primary leaf, by the leaf's level, 0 for the root's. Beyond: 0.
    secondary_branching: level by level.
    coverage_depth: levels below a secondary node at which its coverage by a primitive is judged.
    minimum_coverage: the share of the nodes there that a primitive meets, from which on it stays in the node.
    largest_share: of a primary node's primitives that its children may hold on average; else it is not divided, as
        where wide lines lie all over it. The paper divides always: 1.
    """

    primary_branching: tuple[int, ...] = ()
    node_capacity: int = 45
    secondary_depths: tuple[int, ...] = ()
    secondary_branching: tuple[int, ...] = ()
    coverage_depth: int = 2
    minimum_coverage: float = 1.0
    largest_share: float = 1.0

    def core(self) -> _core.LoopsBvh:
        """As the core takes it. Raises InputError."""
        bvh = _core.LoopsBvh()
        try:
            bvh.primary_branching = list(self.primary_branching)
            bvh.node_capacity = self.node_capacity
            bvh.secondary_depths = list(self.secondary_depths)
            bvh.secondary_branching = list(self.secondary_branching)
            bvh.coverage_depth = self.coverage_depth
            bvh.minimum_coverage = self.minimum_coverage
            bvh.largest_share = self.largest_share
        except TypeError:
            raise InputError(
                f"LoopsBvh: numbers must be whole and zero or more, but this is {self!r}."
            ) from None
        return bvh


# Table 1 of the paper. Its "replica" of LOCALIS divides the primary root whatever it holds.
NAMED_BVHS: dict[str, LoopsBvh] = {
    "fitted": LoopsBvh(node_capacity=24, largest_share=0.25),
    "replica": LoopsBvh((16,), 0, (0, 10), (4,) * 10),
    "constant": LoopsBvh((100,) * 4),
    "descending": LoopsBvh((576, 256, 100, 36)),
    "ascending": LoopsBvh((25, 64, 169, 324)),
    "peak": LoopsBvh((25, 625, 625, 25)),
    "flat6": LoopsBvh((25,) * 5 + (36,)),
    "flat7": LoopsBvh((16,) * 5 + (25,) * 2),
    "flat8": LoopsBvh((9,) * 2 + (16,) * 6),
    "size-efficient": LoopsBvh((9,) * 5, 45, (8, 7, 6, 5, 4, 3, 2), (4,) * 8),
    "efficient": LoopsBvh((9,) * 4 + (16, 36), 45, (8, 7, 6, 5, 4, 3, 2), (4, 4, 4, 4, 16, 16, 4, 4)),
    "even": LoopsBvh((9,) * 5, 45, (4,) * 8, (4,) * 4),
}


@dataclass(frozen=True)
class Loops(Technique):
    """Polygons and lines that lose their details where the view does not show them.

    order: which vertices go first: "douglas_peucker", "wang_mueller", "visvalingam_whyatt", or a function that takes
        the vertices of an arc, float64 (n, 2) in metres, and gives (indices, errors): 1 to n - 2, the first to go
        first, with the metres that each removal is off by.
    primitives: in a bvh, lines and outlines are "tri" (refinement triangles) or "seg" (the segments of all levels).
    bvh: None for cells that are made anew for each view, of what is active in it: the fastest where details are
        left out. Or the paper's index, which is prepared once and read pixel by pixel: one of its table 1 by name,
        "fitted" (chosen from the data), or a `LoopsBvh`.
    detail: what the layer begins with; `Renderer.restyle(layer, technique=)` changes it, for the neighbours too.
        Colours, visibility, widths and order change as those of static layers do; a bvh keeps widths and order.

    Draws even fills, outlines, and round lines of one colour a feature with casings; UnsupportedError for other styles.
    Neighbouring layers of equal options are prepared together, so that borders that they share stay shared.
    Raises InputError.
    """

    name: ClassVar[str] = "loops"
    restyles: ClassVar[bool] = True

    order: str | RemovalOrder = "douglas_peucker"
    primitives: str = "tri"
    bvh: str | LoopsBvh | None = None
    detail: Detail = field(default_factory=Detail)

    def __post_init__(self) -> None:
        if not callable(self.order):
            _check_choice("Loops", "order", self.order, ORDERS, " or a function")
        _check_choice("Loops", "primitives", self.primitives, PRIMITIVES)
        if self.bvh is not None and not isinstance(self.bvh, LoopsBvh):
            _check_choice("Loops", "bvh", self.bvh, tuple(NAMED_BVHS), ", a decalgl.LoopsBvh or None")
        if not isinstance(self.detail, Detail):
            raise InputError(f"Loops: detail must be a decalgl.Detail, but it is {self.detail!r}.")
        self.core_options()

    def require_change_of(self, prepared: Technique) -> None:
        """All but the level of detail must be as it was prepared. Raises StyleError."""
        if not isinstance(prepared, Loops) or replace(self, detail=prepared.detail) != prepared:
            raise StyleError(
                "A restyle of technique 'loops' changes its detail alone; order, primitives and bvh are what the layer"
                " was prepared with. Write dataclasses.replace(layer.technique, detail=...)."
            )

    def core_options(self) -> _core.LoopsChoice:
        """As the core takes it."""
        bvh = NAMED_BVHS[self.bvh] if isinstance(self.bvh, str) else self.bvh
        return _core.LoopsChoice(
            order=self.order,
            segments=self.primitives == "seg",
            bvh=None if bvh is None else bvh.core(),
            detail=self.detail.core(),
        )

    def simplified(self, features: FeatureTable, tolerances: Sequence[float]) -> list[RingArrays]:
        """A layer's features (`Layer.features`) as they are drawn with `uniform` tolerances, on level ground.

        Gives (coords, part_offsets, feature_offsets) for each tolerance, as in `FeatureTable`. Rings of less than three
        vertices are left out.
        """
        bounds = features.bounds
        if bounds is None:
            raise InputError("There are no features to simplify.")
        west, south, east, north = bounds
        # A terrain without extent has no lattice.
        grown = (west, south, max(east, west + 1e-3), max(north, south + 1e-3))
        return [
            (coords.reshape(-1, 2), parts, owners)
            for coords, parts, owners in _core.loops_simplified(
                polygons=features.kind == "polygons",
                coordinates=features.coords.reshape(-1),
                part_offsets=features.part_offsets,
                feature_offsets=features.feature_offsets,
                bounds=grown,
                tolerances=[float(tolerance) for tolerance in tolerances],
                choice=self.core_options(),
            )
        ]


def _core_eye(camera: Camera, size: tuple[int, int]) -> _core.DetailEye:
    fitted = camera.for_size(size)
    width, height = size
    eye = _core.DetailEye()
    eye.eye = fitted.eye
    eye.forward = tuple(map(float, fitted.basis()[2]))
    if fitted.fov is None:
        eye.metres_per_pixel = (fitted.view_height or 0.0) / height
    else:
        eye.pixels = 0.5 * height / math.tan(math.radians(0.5 * fitted.fov))
        eye.corner = 1.0 / math.hypot(1.0, 0.5 * math.hypot(width, height) / eye.pixels)
    return eye


def _check_choice(owner: str, name: str, value: Any, known: tuple[str, ...], more: str = "") -> None:
    if not isinstance(value, str) or value not in known:
        hint = close_matches(str(value), known)
        raise InputError(
            f"{owner}: there is no {name}={value!r}.{hint} Choose {', '.join(map(repr, known))}{more}."
        )
