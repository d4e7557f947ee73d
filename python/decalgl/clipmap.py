"""Clipmap textures: vectors drawn into tiles of a virtual texture (docs/techniques/clipmap.md)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _core
from ._values import is_listed, is_number, is_whole
from .errors import StyleError, warn
from .techniques import Technique, warn_of_faint_features

if TYPE_CHECKING:
    from .camera import Camera
    from .layer import Layer

Solution = Literal["1", "2", "3a", "3b", "4a", "4b", "4b polar"]
JOINTS = ("1", "3a", "3b")
SOLUTIONS = ("1", "2", "3a", "3b", "4a", "4b", "4b polar")
RANGES: dict[str, tuple[float, float]] = {
    "bevel_below": (10.0, 180.0),
    "thin_below": (0.0, 1000.0),
    "widest_line": (1.0, 255.0),
    "window": (512, 4096),
    "samples": (1, 4),
    "anisotropy": (1, 64),
    "tiles_a_frame": (1, 1 << 20),
}
WHOLE = ("window", "samples", "anisotropy", "tiles_a_frame")
# What warns: the share of corners that may lie wrong, and pixels over which the ground is blurred.
MOST_CROSSED = 0.1
MOST_BLUR = 4.0


@dataclass(frozen=True)
class Clipmap(Technique):
    """Clipmap line textures (Taibo et al. 2014): 2^20 x 2^20 texels in levels of 256 x 256 tiles, drawn on demand.

    solution: how lines get into tiles, by the paper's numbers: "1" line primitives, "2" tessellated before, "3a" both,
        "3b" tessellated, and wireframe where thin, "4a" by a geometry shader, "4b" by offsets worked out before, in
        rectangular or in "4b polar" coordinates.
    joints: of angles below `bevel_below` degrees, "3b" (inner borders meet, so nothing is drawn twice) or "3a"; or "1",
        none at any angle: segments end across, which leaves notches.
    thin_below: texels; thinner lines are line primitives, but for solutions 1 and 2.
    widest_line: texels to which line primitives are clamped.
    widen: (near, far), metres from the camera to the ground: from `near` on widths grow as the distance does, and from
        `far` on they stay, in steps of an eighth of an octave. Tiles are drawn anew at each step.
    window: texels of each level that are kept, 512 to 4096; None: as many as the picture is wide.
    samples: of a texel, 1 (smooth lines, jagged polygons, as in the paper), 2 or 4.
    anisotropy: most samples along the longer side of a pixel.
    tiles_a_frame: the most tiles that are drawn for one picture; None: all that it needs.

    A restyle changes colours, widths, what is visible and the draw order; tiles are drawn anew. It shows what its
    textures hold: no ids, no picking, no patterns, bands, hatches, slope corrections and outlines on one side; it takes
    no edits. Raises StyleError for values out of range.
    """

    name = "clipmap"
    needs_triangles = True
    solution: Solution = "4b"
    joints: Literal["1", "3a", "3b"] = "3b"
    bevel_below: float = 90.0
    thin_below: float = 1.5
    widest_line: float = 10.0
    widen: tuple[float, float] | None = None
    window: int | None = None
    samples: int = 4
    anisotropy: int = 8
    tiles_a_frame: int | None = None

    def __post_init__(self) -> None:
        for name, known in (("solution", SOLUTIONS), ("joints", JOINTS)):
            value = getattr(self, name)
            if value not in known:
                raise StyleError(
                    f"Clipmap: {name} must be one of {', '.join(map(repr, known))}, but it is {value!r}."
                )
        for name, (least, most) in RANGES.items():
            value = getattr(self, name)
            if value is None and name in ("window", "tiles_a_frame"):
                continue
            is_kind = is_whole if name in WHOLE else is_number
            if not is_kind(value) or not least <= value <= most:
                raise StyleError(f"Clipmap: {name} must be from {least:g} to {most:g}, but it is {value!r}.")
        if self.samples == 3:
            raise StyleError("Clipmap: samples must be 1, 2 or 4, but it is 3.")
        if self.widen is not None and not _is_range(self.widen):
            raise StyleError(
                "Clipmap: widen must be two distances in metres, above 0 and rising, or None, but it is"
                f" {self.widen!r}."
            )

    def warn_of_layer(self, layer: Layer) -> None:
        """Warns of faint features, and of lines whose borders cross at many corners, as they are wide and winding."""
        warn_of_faint_features(layer)
        share = _crossed_corners(layer)
        if share > MOST_CROSSED:
            warn(
                f"Layer {layer.name!r}: at {share:.0%} of the corners, the lines are so much wider than their segments"
                " are long that the strips they are drawn as fold over and may leave gaps. Simplify the lines, draw"
                " them narrower, or choose technique='static'."
            )

    def warn_of_view(self, camera: Camera) -> None:
        """Warns of a view so flat that a pixel's samples do not reach along the ground that it shows."""
        down, along = camera.eye[2] - camera.target[2], math.dist(camera.eye, camera.target)
        if abs(down) * MOST_BLUR * self.anisotropy < along:
            angle = math.degrees(math.asin(abs(down) / along))
            warn(
                f"This camera looks along the ground, at {angle:.2g} degrees: clipmap textures are blurred there, as a"
                f" pixel takes at most {self.anisotropy} samples along it. Look from higher, give anisotropy=64, or"
                " choose technique='static'."
            )

    def core_options(self) -> _core.TechniqueOptions:
        """As the core takes them."""
        return _core.ClipmapOptions(
            solution=SOLUTIONS.index(self.solution),
            joints=JOINTS.index(self.joints),
            bevel_below=float(self.bevel_below),
            thin_below=float(self.thin_below),
            widest_line=float(self.widest_line),
            widen_from=0.0 if self.widen is None else float(self.widen[0]),
            widen_to=0.0 if self.widen is None else float(self.widen[1]),
            window=int(self.window or 0),
            samples=int(self.samples),
            anisotropy=int(self.anisotropy),
            tiles_a_frame=int(self.tiles_a_frame or 0),
        )


def _crossed_corners(layer: Layer) -> float:
    """The share of a layer's corners whose inner borders would meet beyond twice the shorter of both segments."""
    strokes = [one for one in (layer.stroke, layer.casing) if one is not None and one.units == "m"]
    if not strokes or len(layer.features.coords) < 3:
        return 0.0
    table = layer.features
    half_widths = np.max([one.widths for one in strokes], axis=0) / 2.0
    parts = np.diff(table.part_offsets)
    owner = np.repeat(np.repeat(np.arange(len(table)), np.diff(table.feature_offsets)), parts)
    part = np.repeat(np.arange(len(parts)), parts)
    steps = np.diff(table.coords, axis=0)
    lengths = np.hypot(*steps.T)
    before, after = steps[:-1], steps[1:]
    shorter = np.minimum(lengths[:-1], lengths[1:])
    is_corner = (part[:-2] == part[2:]) & (shorter > 0.0)
    cross = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])[is_corner]
    straight = (lengths[:-1] * lengths[1:] + (before * after).sum(axis=1))[is_corner]
    # Half the width times the tangent of half the turn.
    crossed = half_widths[owner[1:-1]][is_corner] * cross > 2.0 * shorter[is_corner] * straight
    return float(crossed.mean()) if len(crossed) else 0.0


def _is_range(value: Any) -> bool:
    if not is_listed(value) or len(value) != 2 or not all(is_number(one) for one in value):
        return False
    return bool(0.0 < value[0] <= value[1] < math.inf)
