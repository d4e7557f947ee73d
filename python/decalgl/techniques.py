"""The ways to drape a layer over the terrain.

"auto"      chosen by the layer
"static"    world-size lines and polygons, looked up pixel by pixel: docs/techniques/static.md
"distance_field"   networks of lines, restyled as a whole: docs/techniques/distance_field.md
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from .errors import StyleError, close_matches

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from . import _core
    from ._sources import Attributes


@dataclass(frozen=True)
class Technique:
    """A technique with what it lets its users choose; each is a class of its own."""

    name: ClassVar[str]
    restyles: ClassVar[bool] = False  # whether its choices may change without preparing anew

    def core_options(self) -> _core.TechniqueOptions | None:
        """The choices as the core takes them; None where there are none."""
        return None

    @property
    def names_widths(self) -> bool:
        """Whether the choices say how wide lines are, so that the layer's width is not read."""
        return False

    def bound_to(
        self,
        layer_name: str,  # noqa: ARG002
        rows: NDArray[np.int64],  # noqa: ARG002
        attributes: Attributes | None,  # noqa: ARG002
    ) -> Technique:
        """With what the choices say of features looked up; `rows` are the features' rows. Raises StyleError."""
        return self


@dataclass(frozen=True)
class Static(Technique):
    """World-size lines and polygons (Zechmeister 2020, Thöny et al. 2018); `Renderer` chooses its index."""

    name = "static"


def resolve_technique(technique: str | Technique, layer_name: str) -> Technique:
    """The technique of a layer. Raises StyleError."""
    if isinstance(technique, Technique):
        return technique
    from .distance_field import DistanceField

    by_name: dict[str, type[Technique]] = {each.name: each for each in (Static, DistanceField)}
    if technique == "auto":
        return Static()
    if isinstance(technique, str) and technique in by_name:
        return by_name[technique]()
    names = ("auto", *by_name)
    raise StyleError(
        f"Layer {layer_name!r}: there is no technique={technique!r}.{close_matches(str(technique), names)} Use"
        f" {', '.join(map(repr, names))} or a decalgl.Technique."
    )
