"""Shadow volumes: meshes around the terrain, counted in the stencil (docs/techniques/volume.md)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from . import _core
from ._values import is_number
from .errors import StyleError
from .techniques import Technique, warn_of_faint_features

if TYPE_CHECKING:
    from .layer import Layer


@dataclass(frozen=True)
class Volume(Technique):
    """Shadow volumes (Schneider and Klein 2007), with which Zechmeister 2020 compares.

    groups: "exact" keeps the draw order, in as many masks as colours and their overlaps ask for; "colors" draws one
        mask for each colour of a layer, in the order in which they first appear, as the thesis does.
    arc_step: degrees between the vertices of round corners and caps, 1 to 90.

    A restyle changes colours, what is visible and the draw order, without meshing anew. It draws no
    antialias="coverage", no patterns, bands, hatches, slope corrections and outlines on one side, and takes no
    edits and no other widths. Raises StyleError for values out of range.
    """

    name = "volume"
    needs_triangles = True
    groups: Literal["exact", "colors"] = "exact"
    arc_step: float = 11.25

    def __post_init__(self) -> None:
        if self.groups not in ("exact", "colors"):
            raise StyleError(f"Volume: groups must be 'exact' or 'colors', but it is {self.groups!r}.")
        if not is_number(self.arc_step) or not 1.0 <= self.arc_step <= 90.0:
            raise StyleError(
                f"Volume: arc_step must be a number of degrees from 1 to 90, but it is {self.arc_step!r}."
            )

    def warn_of_layer(self, layer: Layer) -> None:
        """Warns of faint features."""
        warn_of_faint_features(layer)

    def core_options(self) -> _core.TechniqueOptions:
        """As the core takes them."""
        return _core.VolumeOptions(exact=self.groups == "exact", arc_step=float(self.arc_step))
