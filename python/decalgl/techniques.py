"""The ways to drape a layer over the terrain.

"auto"      chosen by the layer
"static"    world-size lines and polygons, looked up pixel by pixel: docs/techniques/static.md
"dynamic"   lines of constant size on the screen: docs/techniques/dynamic.md
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from . import _core
from ._values import finite_number, is_word
from .errors import StyleError, UnsupportedError, close_matches


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


@dataclass(frozen=True)
class Dynamic(Technique):
    """Lines whose widths are those on the screen (Zechmeister 2020, sections 3.2.2 and 3.3).

    method: how a pixel finds its lines: "bins", by tiles of the screen; "lists", by lists that boxes around the lines
        fill, as the thesis describes; "auto", tiles, which are faster, but for width_rule="thesis".
    width_rule: "screen", as wide as on the screen; "thesis", on the ground by the distance, with "lists" alone.
    cell: pixels; of neighbouring vertices that fall together in one such cell, a line keeps the first. 0 keeps all.

    Raises StyleError.
    """

    name = "dynamic"
    method: Literal["auto", "bins", "lists"] = "auto"
    width_rule: Literal["screen", "thesis"] = "screen"
    cell: float = 0.125

    def __post_init__(self) -> None:
        for keyword, known in (("method", ("auto", "bins", "lists")), ("width_rule", ("screen", "thesis"))):
            if not is_word(getattr(self, keyword), known):
                raise StyleError(
                    f"Dynamic {keyword} must be one of {', '.join(known)}, but it is {getattr(self, keyword)!r}."
                )
        object.__setattr__(self, "cell", finite_number(self.cell, "Dynamic cell"))
        if self.cell < 0.0:
            raise StyleError(f"Dynamic cell must be 0 or more pixels, but it is {self.cell:g}.")
        if self.width_rule == "thesis" and self.method == "bins":
            raise StyleError("Dynamic width_rule='thesis' needs method='lists'.")

    def core_options(self) -> _core.TechniqueOptions:
        """The choices as the core takes them."""
        return _core.DynamicOptions(self.method, self.width_rule, self.cell)


TECHNIQUES: tuple[type[Technique], ...] = (Static, Dynamic)


def resolve_technique(technique: str | Technique, layer_name: str, follows_view: bool) -> Technique:
    """The technique of a layer. follows_view: whether its widths are those on the screen. Raises StyleError."""
    by_name = {each.name: each for each in TECHNIQUES}
    if is_word(technique, ("auto",)):
        return Dynamic() if follows_view else Static()
    if isinstance(technique, str) and technique in by_name:
        technique = by_name[technique]()
    if isinstance(technique, Static) and follows_view:
        raise UnsupportedError(
            f"Layer {layer_name!r}: technique 'static' draws widths on the ground, but these are on the screen"
            " (width_units='px', the default, or limits). Give width_units='m', or technique='auto'."
        )
    if isinstance(technique, Technique):
        return technique
    names = ("auto", *by_name)
    raise StyleError(
        f"Layer {layer_name!r}: there is no technique={technique!r}.{close_matches(str(technique), names)} Use"
        f" {', '.join(map(repr, names))} or a decalgl.Technique."
    )
