"""A frame: one picture, and what can be asked about its pixels."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import FileError, InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from . import _core
    from .scene import Layer


@dataclass(frozen=True)
class Picked:
    """A feature under a pixel: its layer, and its row in the data that the layer was made of."""

    layer: Layer
    row: int

    def __str__(self) -> str:
        return f"{self.layer.name}, row {self.row}"


@dataclass(frozen=True)
class Stats:
    """What a picture cost.

    passes: [{"name", "ms"}] of the passes that ran, in order; each waits for the driver.
    stages: milliseconds of preprocess, update, render (without reading back) and readback.
    bytes: held by each technique, the terrain and the frame, prepared data and GL objects together.
    objects: the same, object by object.
    counts: triangles, features, segments, pieces, prepared_bytes, and quantum_m, how far a vertex may have moved.
    variants: the program variants compiled so far.
    """

    passes: list[dict[str, Any]]
    stages: dict[str, float]
    bytes: dict[str, int]
    objects: dict[str, int]
    counts: dict[str, float]
    variants: list[str]

    def to_dict(self) -> dict[str, Any]:
        """As plain dicts and lists, for JSON."""
        return {
            "passes": [dict(one) for one in self.passes],
            "stages": dict(self.stages),
            "bytes": dict(self.bytes),
            "objects": dict(self.objects),
            "counts": dict(self.counts),
            "variants": list(self.variants),
        }


class Frame:
    """One picture. Arrays are read-only, row 0 at the top; all but the image are made when first read.

    They stay right after the renderer has gone on to other views or scenes; read them on the renderer's thread.
    """

    def __init__(self, core: _core.Frame, layers: tuple[Layer, ...]) -> None:
        self._core = core
        self._layers = layers

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        height, width = self._core.image.shape[:2]
        return width, height

    @property
    def image(self) -> NDArray[np.uint8]:
        """(height, width, 4), sRGB with straight alpha."""
        return self._core.image

    @property
    def ids(self) -> NDArray[np.int64]:
        """(height, width): row of the topmost feature at each pixel's centre in its layer's data, -1 for none."""
        return self._core.ids

    @property
    def layers(self) -> NDArray[np.int32]:
        """(height, width): place in the scene of the layer that `ids` belongs to, -1 for none."""
        return self._core.layers

    @property
    def depth(self) -> NDArray[np.float32]:
        """(height, width): planar eye depth in metres, inf where there is sky."""
        return self._core.depth

    @property
    def world(self) -> NDArray[np.float64]:
        """(height, width, 3): scene coordinates of the surface at each pixel's centre, NaN where there is sky."""
        return self._core.world

    def pick(self, x: int, y: int) -> list[Picked]:
        """Every feature at the centre of pixel (x, y), topmost first. Raises InputError outside the picture."""
        try:
            column, row = int(x), int(y)
            whole = column == x and row == y
        except (TypeError, ValueError, OverflowError):
            whole = False
        width, height = self.size
        if not whole or not (0 <= column < width and 0 <= row < height):
            raise InputError(
                f"({x!r}, {y!r}) is no pixel of this picture. Give whole numbers from (0, 0) to ({width - 1}, {height - 1})."
            )
        return [Picked(self._layers[layer], feature) for layer, feature in self._core.pick(column, row)]

    @property
    def stats(self) -> Stats:
        """What the picture cost, stage by stage and pass by pass."""
        given = self._core.stats
        owners: dict[str, int] = {}
        for name, count in given["bytes"].items():
            owner = name.split(":")[0]
            owners[owner] = owners.get(owner, 0) + count
        return Stats(
            given["passes"], given["stages"], owners, given["bytes"], given["counts"], list(given["variants"])
        )

    def save(self, path: str | Path) -> None:
        """Writes the image in the format of the file's ending; PNG keeps alpha. Raises FileError."""
        from PIL import Image

        path = Path(path)
        picture = Image.fromarray(self.image)
        if path.suffix.lower() in (".jpg", ".jpeg"):
            picture = picture.convert("RGB")
        try:
            picture.save(path)
        except ValueError as error:
            raise FileError(
                f"Cannot write {path}: no picture format is known by the ending {path.suffix!r}. Use .png."
            ) from error
        except OSError as error:
            raise FileError(f"Cannot write {path}: {error.strerror or error}. Check the folder and its rights.") from error
