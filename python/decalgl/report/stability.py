"""Stability: how far each technique's pictures are from the reference while one number is driven to the extreme.

A pixel is right where its colour lies between those that the reference sees near its centre: within a fiftieth of a
pixel, which is rounding, or within a whole one, which is blur, simplification or a coarse grid of distances.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

import decalgl as dg
from decalgl import reference as ref

from .extremes import EXTREMES, SIZE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from .extremes import Case, Extreme

    FloatArray = NDArray[np.float64]
    BoolArray = NDArray[np.bool_]
    Row = dict[str, Any]

# Pixels, and steps of colours from 0 to 1 that rounding to bytes may take.
ROUNDING, NEAR = 0.02, 1.0
SLACK = 2.5 / 255.0
# Shares of the picture: a verdict holds up to this many pixels that are farther off than it allows.
MOST_ROUGH, MOST_FAR = 0.0005, 0.02
VERDICTS = ("exact", "within tolerance", "degrades gracefully", "wrong", "refuses with an error")


@dataclass(frozen=True)
class Way:
    """A technique as it is driven: follows_view: its widths are those on the screen; kinds: "both" or "lines"."""

    technique: dg.Technique
    options: dict[str, Any] = field(default_factory=dict)
    follows_view: bool = False
    kinds: str = "both"
    one_color: bool = False

    def scene(self, case: Case) -> dg.Scene:
        """The case as this technique draws it."""
        return case.scene(
            self.technique, follows_view=self.follows_view, one_color=self.one_color, kinds=self.kinds
        )


WAYS = {
    "static": Way(dg.Static()),
    "static, bvh": Way(dg.Static(), {"index": "bvh"}),
    "dynamic, bins": Way(dg.Dynamic(method="bins"), follows_view=True, kinds="lines"),
    "dynamic, lists": Way(dg.Dynamic(method="lists"), follows_view=True, kinds="lines"),
    "loops": Way(dg.Loops()),
    "volume": Way(dg.Volume()),
    "clipmap": Way(dg.Clipmap()),
    "distance_field": Way(dg.DistanceField(), kinds="lines", one_color=True),
}


def rows(full: bool, extremes: Iterable[Extreme] = EXTREMES) -> list[Row]:
    """A row for each extreme, value and technique: `rough` and `far`, shares of the picture's pixels, or the error."""
    return [row for extreme in extremes for row in _driven(extreme, extreme.values if full else extreme.quick)]


def _driven(extreme: Extreme, values: Iterable[float]) -> Iterator[Row]:
    for value in values:
        case = extreme.make(value)
        for name, way in WAYS.items():
            if way.kinds == "lines" and not case.lines:
                continue
            row: Row = {"extreme": extreme.name, "value": value, "technique": name}
            yield {**row, **judged(way, case)}


def judged(way: Way, case: Case) -> Row:
    """How far the picture of a case is from the reference: `rough`, `far` and `verdict`, or an `error`."""
    try:
        scene = way.scene(case)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", dg.DecalWarning)
            frame = scene.render(case.camera, SIZE, antialias="none", background=None, **way.options)
    except dg.DecalError as error:
        return {"verdict": "refuses with an error", "error": str(error)}
    drawn = frame.image[..., :3].reshape(-1, 3) / 255.0
    wrong = np.flatnonzero(~_explained(scene, case, drawn, np.arange(len(drawn)), 0.0))
    wrong = wrong[~_explained(scene, case, drawn, wrong, ROUNDING)]
    far = wrong[~_explained(scene, case, drawn, wrong, NEAR)]
    shares = {"rough": len(wrong) / len(drawn), "far": len(far) / len(drawn)}
    return {**shares, "verdict": verdict_of(**shares)}


def verdict_of(rough: float, far: float) -> str:
    """What shares of pixels that are off by more than rounding, and by more than a pixel, are called."""
    if rough <= MOST_ROUGH:
        return "exact"
    if far <= MOST_ROUGH:
        return "within tolerance"
    return "degrades gracefully" if far <= MOST_FAR else "wrong"


def _explained(scene: dg.Scene, case: Case, drawn: FloatArray, pixels: NDArray[np.int64], reach: float) -> BoolArray:
    """Which of some pixels have a colour between those that the reference sees up to `reach` pixels from the centre."""
    if len(pixels) == 0:
        return np.zeros(0, dtype=np.bool_)
    centres = ref.pixel_centres((0, 0, *SIZE))[pixels]
    found = np.stack([_reference_colors(scene, case, centres + offset) for offset in _offsets(reach)])
    low, high = found.min(axis=0) - SLACK, found.max(axis=0) + SLACK
    between: BoolArray = ((drawn[pixels] >= low) & (drawn[pixels] <= high)).all(axis=1)
    return between


def _offsets(reach: float) -> FloatArray:
    if reach == 0.0:
        return np.zeros((1, 2))
    x, y = np.meshgrid(np.linspace(-reach, reach, 5), np.linspace(-reach, reach, 5))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def _reference_colors(scene: dg.Scene, case: Case, points: FloatArray) -> FloatArray:
    surface = ref.raycast(scene, case.camera, SIZE, points)
    slopes = ref.slopes_of(scene, case.camera, SIZE, surface)
    colors: FloatArray = ref.composite(scene, surface.world[..., :2].reshape(-1, 2), slopes)[:, :3]
    return colors
