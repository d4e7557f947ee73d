"""A frame: one picture, and what can be asked about its pixels."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._raster import check_memory
from .errors import FileError, InputError, StyleError

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from . import _core
    from ._looks import LayerState
    from .features import Kind
    from .layer import Layer


# While they are made, the surface takes 60 bytes a pixel and the ids 16 and 4 more a technique.
BYTES_PER_PIXEL = 64
KEEP_ALPHA = ("PNG", "WEBP", "TIFF")
KEEP_THE_DATA = "Open it by preprocess(scene, cache=path), which keeps the scene's data beside it."
LARGE_PICTURE = 1 << 22  # pixels; a smaller picture is not worth asking how much memory there is


@dataclass(frozen=True, eq=False)
class PreparedLayer:
    """What a saved scene knows of one of its layers.

    rows: int64 (features), each feature's row in the data that the layer was made of.
    """

    name: str
    index: int
    kind: Kind
    rows: NDArray[np.int64] = field(repr=False)


@dataclass(frozen=True)
class Picked:
    """A feature under a pixel: its layer, and its row in the data that the layer was made of.

    layer: the scene's, or a `PreparedLayer` where the renderer opened a saved scene.
    """

    layer: Layer | PreparedLayer
    row: int

    def __str__(self) -> str:
        return f"{self.layer.name}, row {self.row}"


@dataclass(frozen=True)
class Stats:
    """What a picture cost.

    passes: [{"name", "ms"}] of the passes that ran, in order; each waits for the driver.
    stages: milliseconds of preprocess, update, render (without reading back) and readback.
    preprocess: milliseconds of its parts: the terrain and each technique; "open" in their place where a saved
        scene was opened, "fingerprint" and "save" too where there is a cache.
    bytes: held by each technique, the terrain and the frame, prepared data and GL objects together.
    objects: the same, object by object.
    counts: triangles, features, segments, pieces, prepared_bytes, and quantum_m, how far a vertex may have
        moved, and quantum_px, the same in pixels in the middle of the picture, of positions as well; uploads and
        uploaded_bytes, what buffers and textures took since the picture before.
    variants: the program variants compiled so far.
    """

    passes: list[dict[str, Any]]
    stages: dict[str, float]
    preprocess: dict[str, float]
    bytes: dict[str, int]
    objects: dict[str, int]
    counts: dict[str, float]
    variants: list[str]

    def to_dict(self) -> dict[str, Any]:
        """As plain dicts and lists, for JSON."""
        return {
            "passes": [dict(one) for one in self.passes],
            "stages": dict(self.stages),
            "preprocess": dict(self.preprocess),
            "bytes": dict(self.bytes),
            "objects": dict(self.objects),
            "counts": dict(self.counts),
            "variants": list(self.variants),
        }


class Frame:
    """One picture. Arrays are read-only, row 0 at the top; all but the image are made when first read.

    They stay right after the renderer has gone on to other views or scenes; read them on the renderer's
    thread. Reading raises MemoryLimitError where an array does not fit.
    """

    def __init__(
        self,
        core: _core.Frame,
        layers: tuple[Layer | PreparedLayer, ...],
        states: Mapping[int, LayerState],
    ) -> None:
        self._core = core
        self._layers = layers
        self._states = states  # of layers that were changed, for legends
        self._read: set[str] = set()

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
        """(height, width): row in its layer's data of the topmost feature at each pixel's centre; or -1."""
        self._check_memory("ids")
        return self._core.ids

    @property
    def layers(self) -> NDArray[np.int32]:
        """(height, width): place in the scene of the layer that `ids` belongs to, -1 for none."""
        self._check_memory("layers")
        return self._core.layers

    @property
    def depth(self) -> NDArray[np.float32]:
        """(height, width): planar eye depth in metres, inf where there is sky."""
        self._check_memory("depth")
        return self._core.depth

    @property
    def world(self) -> NDArray[np.float64]:
        """(height, width, 3): scene coordinates of the surface at each pixel's centre, NaN: sky."""
        self._check_memory("world")
        return self._core.world

    def pick(self, x: int, y: int) -> list[Picked]:
        """Every feature at the centre of pixel (x, y), topmost first.

        Raises InputError outside the picture.
        """
        try:
            column, row = int(x), int(y)
            whole = column == x and row == y
        except (TypeError, ValueError, OverflowError):
            whole = False
        width, height = self.size
        if not whole or not (0 <= column < width and 0 <= row < height):
            raise InputError(
                f"({x!r}, {y!r}) is no pixel of this picture. Give whole numbers from (0, 0) to"
                f" ({width - 1}, {height - 1})."
            )
        self._check_memory("pick")
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
            passes=given["passes"],
            stages=given["stages"],
            preprocess=given["preprocess"],
            bytes=owners,
            objects=given["bytes"],
            counts=given["counts"],
            variants=list(given["variants"]),
        )

    def save(self, path: str | Path, *, legend: bool | None = None) -> None:
        """Writes the image in the format of the file's ending, such as .png, .jpg or .tif.

        legend: None lays the legends of the layers that were added with legend=True over it, as they were restyled
            since; True does so and
            raises StyleError where there is none; False leaves them out. `image` never has them.

        PNG, WebP and TIFF keep alpha; in other formats what is transparent becomes white. Raises FileError.
        """
        from PIL import Image

        path = Path(path)
        file_format = picture_format(path)
        picture = Image.fromarray(self.image)
        explained = [] if legend is False else self._explained_layers()
        if explained:
            from .legend import overlay

            self._check_memory("legends")
            picture = Image.alpha_composite(picture, Image.fromarray(overlay(explained, self.size)))
        elif legend:
            raise StyleError(
                "There is no legend to draw. Add layers with legend=True. A scene that was opened from a file has no"
                f" legends. {KEEP_THE_DATA}"
            )
        if file_format not in KEEP_ALPHA:
            white = Image.new("RGBA", picture.size, "white")
            picture = Image.alpha_composite(white, picture).convert("RGB")
        try:
            picture.save(path)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise FileError(f"Cannot write {path}: {reason}. Check the folder and its rights.") from error

    def _explained_layers(self) -> list[Layer]:
        from .layer import Layer

        asking = [
            self._states[place].explained() if place in self._states else layer
            for place, layer in enumerate(self._layers)
            if isinstance(layer, Layer) and layer.coloring.legend
        ]
        return [layer for layer in asking if isinstance(layer, Layer) and layer.coloring.legend]

    def _check_memory(self, what: str) -> None:
        if what in self._read or self._core.image.nbytes < 4 * LARGE_PICTURE:
            return
        width, height = self.size
        check_memory(
            BYTES_PER_PIXEL * width * height,
            f"{what} of a picture of {width} x {height} pixels",
            "read",
            "Draw a smaller picture.",
        )
        self._read.add(what)


def picture_format(path: Path) -> str:
    """The name of the picture format that the ending of `path` means. Raises FileError."""
    from PIL import Image

    ending = path.suffix.lower()
    file_format = Image.registered_extensions().get(ending, "")
    if file_format not in Image.SAVE:
        raise FileError(
            f"Cannot write {path}: no picture format is known by the ending {ending!r}. Use .png."
        )
    return file_format
