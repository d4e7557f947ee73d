"""Dynamic lines: of constant size on the screen (docs/techniques/dynamic.md)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from . import _core
from ._values import finite_number, is_word
from .errors import StyleError
from .techniques import Technique


@dataclass(frozen=True)
class Dynamic(Technique):
    """Lines whose widths are those on the screen (Zechmeister 2020, sections 3.2.2 and 3.3).

    method: how a pixel finds its lines: "bins", by tiles of the screen; "lists", by lists that boxes around the lines
        fill, as the thesis describes; "auto", the faster one for so many segments.
    width_rule: "screen", as wide as on the screen; "thesis", on the ground by the distance, with "lists" alone.
    cell: pixels; of neighbouring vertices that fall together in one such cell, a line keeps the first. 0 keeps all.

    Raises StyleError.
    """

    name = "dynamic"
    follows_view = True
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
