"""The ways to drape a layer over the terrain.

"auto"      chosen by the layer
"static"    world-size lines and polygons, looked up pixel by pixel: docs/techniques/static.md
"loops"     the same, simplified where and as much as the view allows: docs/techniques/loops.md
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from .errors import StyleError, close_matches

if TYPE_CHECKING:
    from . import _core


@dataclass(frozen=True)
class Technique:
    """A technique with what it lets its users choose; each is a class of its own."""

    name: ClassVar[str]

    def core_options(self) -> _core.TechniqueOptions | None:
        """The choices as the core takes them; None where there are none."""
        return None


@dataclass(frozen=True)
class Static(Technique):
    """World-size lines and polygons (Zechmeister 2020, Thöny et al. 2018); `Renderer` chooses its index."""

    name = "static"


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
