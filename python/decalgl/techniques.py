"""The ways to drape a layer over the terrain.

"auto"      chosen by the layer
"static"    world-size lines and polygons, looked up pixel by pixel: docs/techniques/static.md
"loops"     the same, simplified where and as much as the view allows: docs/techniques/loops.md
"volume"    meshes around the terrain, counted in the stencil: docs/techniques/volume.md
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

from . import _core
from .errors import StyleError, close_matches

if TYPE_CHECKING:
    from typing import Any


@dataclass(frozen=True)
class Technique:
    """A technique with what it lets its users choose; each is a class of its own."""

    name: ClassVar[str]
    needs_triangles: ClassVar[bool] = False  # of polygons

    def core_options(self) -> _core.TechniqueOptions | None:
        """The choices as the core takes them; None where there are none."""
        return None


@dataclass(frozen=True)
class Static(Technique):
    """World-size lines and polygons (Zechmeister 2020, Thöny et al. 2018); `Renderer` chooses its index."""

    name = "static"


@dataclass(frozen=True)
class Volume(Technique):
    """Shadow volumes (Schneider and Klein 2007), with which Zechmeister 2020 compares.

    groups: "exact" keeps the draw order, in as many masks as colours and the overlaps of colours ask for; "colors" draws
        one mask for each colour of a layer, in the order in which they first appear, as the thesis does.
    arc_step: degrees between the vertices of round corners and caps, 1 to 90.

    It draws no antialias="coverage", no patterns, bands, hatches, slope corrections and outlines on one side, and stays
    as it was prepared. Raises StyleError for values out of range.
    """

    name = "volume"
    needs_triangles = True
    groups: Literal["exact", "colors"] = "exact"
    arc_step: float = 11.25

    def __post_init__(self) -> None:
        if self.groups not in ("exact", "colors"):
            raise StyleError(f"Volume: groups must be 'exact' or 'colors', but it is {self.groups!r}.")
        if not _is_number(self.arc_step) or not 1.0 <= self.arc_step <= 90.0:
            raise StyleError(
                f"Volume: arc_step must be a number of degrees from 1 to 90, but it is {self.arc_step!r}."
            )

    def core_options(self) -> _core.TechniqueOptions:
        """As the core takes them."""
        return _core.VolumeOptions(exact=self.groups == "exact", arc_step=float(self.arc_step))


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def resolve_technique(technique: str | Technique, layer_name: str) -> Technique:
    """The technique of a layer. Raises StyleError."""
    if isinstance(technique, Technique):
        return technique
    by_name = {each.name: each for each in Technique.__subclasses__()}
    if technique == "auto":
        return Static()
    if isinstance(technique, str) and technique in by_name:
        return by_name[technique]()
    names = ("auto", *by_name)
    raise StyleError(
        f"Layer {layer_name!r}: there is no technique={technique!r}.{close_matches(str(technique), names)} Use"
        f" {', '.join(map(repr, names))} or a decalgl.Technique."
    )
