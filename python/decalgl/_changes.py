"""What a renderer was told to change since it prepared or opened its scene: looks, and the lens."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from . import _core
from ._edits import edited
from ._looks import LayerState, first_state
from .errors import InputError, close_matches
from .lens import Lens

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyproj
    from numpy.typing import NDArray

    from .frame import PreparedLayer
    from .scene import Layer

    AnyLayer: TypeAlias = Layer | PreparedLayer


class LayerChanges:
    """Keeps the state of each layer that was restyled, and hands what changes on to the core.

    A change that fails leaves the states and the core as they were.
    """

    def __init__(self, core: _core.Renderer) -> None:
        self._core = core
        self._layers: tuple[AnyLayer, ...] = ()
        self._states: dict[int, LayerState] = {}
        self.lens: Lens | None = None
        self._any = False
        self._crs: pyproj.CRS | None = None

    def __bool__(self) -> bool:
        return self._any

    @property
    def states(self) -> Mapping[int, LayerState]:
        """Those of the layers that were changed, by their places; later changes make another mapping."""
        return self._states

    def begin(self, layers: tuple[AnyLayer, ...], crs: pyproj.CRS | None = None) -> None:
        """Forgets everything: these layers were just prepared; crs is the scene's."""
        self._crs = crs
        self._layers = layers
        self._states = {}
        self.lens = None
        self._any = False

    def restyle(self, layer: AnyLayer | str | int, keywords: Mapping[str, Any]) -> None:
        """Renderer.restyle."""
        index = self._index_of(layer)
        before = self._state(index)
        after = before.restyled(keywords)
        states = {**self._states, index: after}
        looks = [] if self.lens is None else self._lens_looks(self.lens, states)
        self._core.restyle([after.core_look(before)])
        self._states = states
        self._any = True
        if self.lens is not None and any(look.layer == index for look in looks):
            self._core.set_lens(_core_lens(self.lens), looks)

    def edit(
        self,
        layer: AnyLayer | str | int,
        add: Any,
        remove: Any,
        move: Mapping[int, Any] | None,
        replacing: Mapping[int, Any] | None,
        style: Mapping[str, Any],
    ) -> NDArray[np.int64]:
        """Renderer.edit."""
        index = self._index_of(layer)
        done = edited(self._state(index), self._crs, add, remove, move, replacing, style)
        states = {**self._states, index: done.state}
        looks = [] if self.lens is None else self._lens_looks(self.lens, states)
        self._core.edit(done.core)
        # What was added looks as the layer was prepared.
        prepared_otherwise = done.state.style_look() if len(done.rows) else None
        if prepared_otherwise is not None:
            self._core.restyle([prepared_otherwise])
        self._states = states
        self._any = True
        if self.lens is not None:
            self._core.set_lens(_core_lens(self.lens), looks)
        return done.rows

    def set_lens(self, lens: Lens | None) -> None:
        """Renderer.lens."""
        if lens is None:
            if self.lens is not None:
                self._core.remove_lens()
            self.lens = None
            return
        if not isinstance(lens, Lens):
            raise InputError(f"lens must be a Lens or None, but it is a {type(lens).__name__}.")
        if lens.shows_as(self.lens):
            self._core.move_lens(_core_lens(lens))
        else:
            self._core.set_lens(_core_lens(lens), self._lens_looks(lens, self._states))
        self.lens = lens
        self._any = True

    def _lens_looks(self, lens: Lens, states: Mapping[int, LayerState]) -> list[_core.LayerLook]:
        inside: dict[int, tuple[LayerState, LayerState]] = {}
        wanted = [*lens.styles.items(), *((layer, {"visible": False}) for layer in lens.hidden)]
        for layer, keywords in wanted:
            index = self._index_of(layer)
            outside = states.get(index) or self._state(index)
            _, state = inside.get(index, (outside, outside))
            inside[index] = (outside, state.restyled(keywords))
        return [state.core_look(outside) for outside, state in inside.values()]

    def _state(self, index: int) -> LayerState:
        known = self._states.get(index)
        return known or first_state(self._layers[index], self._core.look(index))

    def _index_of(self, layer: AnyLayer | str | int) -> int:
        if not self._layers:
            raise InputError(
                "There is no layer to change. Call preprocess(scene) with a scene that has some."
            )
        if isinstance(layer, str):
            named = [index for index, other in enumerate(self._layers) if other.name == layer]
            if len(named) == 1:
                return named[0]
            names = [other.name for other in self._layers]
            problem = "There is no layer" if not named else f"{len(named)} layers are named"
            raise InputError(
                f"{problem} {layer!r}.{close_matches(layer, names)} Layers are {', '.join(map(repr, names))}."
            )
        if isinstance(layer, (int, np.integer)) and not isinstance(layer, bool):
            if not -len(self._layers) <= layer < len(self._layers):
                raise InputError(f"There is no layer {layer}; there are {len(self._layers)}, counted from 0.")
            return int(layer) % len(self._layers)
        for index, other in enumerate(self._layers):
            if other is layer:
                return index
        raise InputError(
            f"{layer!r} is no layer of what is prepared. Name one of renderer.layers, its name or its place."
        )


def _core_lens(lens: Lens) -> _core.Lens:
    x, y, radius = lens.circle or (0.0, 0.0, 0.0)
    coordinates = np.concatenate([ring.reshape(-1) for ring in lens.rings]) if lens.rings else np.zeros(0)
    offsets = np.concatenate([[0], np.cumsum([len(ring) for ring in lens.rings])]).astype(np.int64)
    return _core.Lens(x, y, radius, coordinates.tolist(), offsets.tolist() if lens.rings else [])
