"""The ways to drape a layer over the terrain.

"auto"      "dynamic" for widths in pixels, else "static"
"static"    world-size lines and polygons, looked up pixel by pixel: docs/techniques/static.md
"dynamic"   lines of constant size on the screen: docs/techniques/dynamic.md
"loops"     world-size, simplified where and as much as the view allows: docs/techniques/loops.md
"clipmap"   textures in levels that follow the view: docs/techniques/clipmap.md
"volume"    meshes around the terrain, counted in the stencil: docs/techniques/volume.md
"distance_field"   networks of lines, restyled as a whole: docs/techniques/distance_field.md
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from .errors import StyleError, UnsupportedError, close_matches, warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from . import _core
    from ._sources import Attributes
    from .camera import Camera
    from .layer import Layer


@dataclass(frozen=True)
class Technique:
    """A technique with what it lets its users choose; each is a class of its own.

    name: for `technique=`. needs_triangles: of polygons. follows_view: whether it draws widths on the screen.
    restyles: whether its choices may change without preparing anew.
    """

    name: ClassVar[str]
    needs_triangles: ClassVar[bool] = False
    follows_view: ClassVar[bool] = False
    restyles: ClassVar[bool] = False

    def core_options(self) -> _core.TechniqueOptions | None:
        """The choices as the core takes them; None where there are none."""
        return None

    def require_change_of(self, prepared: Technique) -> None:
        """That these choices differ from a layer's only in what needs no preparing. Raises StyleError."""

    def warn_of_layer(self, layer: Layer) -> None:
        """Warns where a layer asks for more than the technique can draw well."""

    def warn_of_view(self, camera: Camera) -> None:
        """Warns where a view asks for more than the technique can draw well."""

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


# Of a colour that is blended into bytes: below, rounding at each feature adds up to more than a sixteenth of all steps.
FAINTEST_BLENDED = 8  # of 255
MOST_FAINT = 100  # features of a layer


def warn_of_faint_features(layer: Layer) -> None:
    """Warns of many features so translucent that blending them into bytes, one after the other, rounds them away."""
    alpha = layer.colors[:, 3]
    faint = (alpha > 0) & (alpha <= FAINTEST_BLENDED)
    count = int(np.count_nonzero(faint))
    if count > MOST_FAINT:
        least = int(alpha[faint].min())
        warn(
            f"Layer {layer.name!r}: {count} features have an opacity of {FAINTEST_BLENDED / 255:.2g} or less, down to"
            f" {least / 255:.2g}. Technique {layer.technique.name!r} blends them into bytes one after the other: where"
            f" many lie over each other, colours may be {255 // (2 * least)} of 255 off. Make them more opaque, or"
            " choose technique='static'."
        )


def resolve_technique(technique: str | Technique, layer_name: str, follows_view: bool) -> Technique:
    """The technique of a layer. follows_view: whether its widths are those on the screen.

    Raises StyleError, and UnsupportedError for a technique that draws no such widths.
    """
    by_name = {each.name: each for each in Technique.__subclasses__()}
    if isinstance(technique, str) and technique == "auto":
        technique = "dynamic" if follows_view else "static"
    if isinstance(technique, str) and technique in by_name:
        technique = by_name[technique]()
    if not isinstance(technique, Technique):
        names = ("auto", *by_name)
        raise StyleError(
            f"Layer {layer_name!r}: there is no technique={technique!r}.{close_matches(str(technique), names)} Use"
            f" {', '.join(map(repr, names))} or a decalgl.Technique."
        )
    if follows_view and not technique.follows_view and not technique.names_widths:
        raise UnsupportedError(
            f"Layer {layer_name!r}: technique {technique.name!r} draws widths on the ground, but these are on the"
            " screen (width_units='px', the default, or limits). Give width_units='m', or technique='auto'."
        )
    return technique
