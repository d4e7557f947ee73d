"""Reading one band of a raster file, with its declared size checked before anything is allocated.

A raster file states its size in its header, and a sparse or well-compressed one of a few kilobytes can
state gigabytes. The header is compared with a limit, with the size of the file and with the memory that is
available; only then are samples read.
"""

from __future__ import annotations

import logging
import math
import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._paths import gdal_name, is_virtual
from ._warp import AffineMap
from .errors import FileError, InputError, MemoryLimitError, warn

if TYPE_CHECKING:
    from numpy.typing import NDArray

MAX_SAMPLES = 16384 * 16384
# Deflate cannot shrink data by more than a factor of about 1030; anything far beyond is a sparse file.
MOST_SHRINKING = 2000
SMALL_BYTES = 64 << 20
METRES_PER_UNIT = {
    **dict.fromkeys(("ft", "foot", "feet", "international foot"), 0.3048),
    **dict.fromkeys(("us-ft", "us survey foot", "us survey feet", "foot_us", "ftus"), 1200.0 / 3937.0),
    **dict.fromkeys(("cm", "centimetre", "centimeter", "centimeters", "centimetres"), 0.01),
    **dict.fromkeys(("km", "kilometre", "kilometer"), 1000.0),
}
log = logging.getLogger("decalgl")


@dataclass(frozen=True)
class RasterBand:
    """Samples as read: heights float32 (rows, columns) with NaN holes, and where they lie."""

    heights: NDArray[np.float32]
    sample_map: AffineMap
    crs: Any


def read_band(
    path: str | os.PathLike[str], band: int, window: Any, max_samples: int | None, nodata: float | None
) -> RasterBand:
    """One band of the raster at `path`. Raises FileError, InputError or MemoryLimitError."""
    import rasterio

    name = os.fspath(path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        try:
            with rasterio.open(gdal_name(name)) as dataset:
                return _read(dataset, name, band, window, max_samples, nodata)
        except rasterio.errors.RasterioIOError as error:
            raise _unreadable(name, error) from error


def _unreadable(name: str, error: Exception) -> FileError:
    if not is_virtual(name) and not Path(name).exists():
        return FileError(f"There is no file {name!r} to read a terrain from. Check the path.")
    return FileError(
        f"{name!r} cannot be read as a raster: {error}. Give a whole raster file of a format that GDAL reads,"
        " such as GeoTIFF; gdalinfo shows what GDAL makes of it."
    )


def _read(
    dataset: Any, name: str, band: int, window: Any, max_samples: int | None, nodata: float | None
) -> RasterBand:
    if dataset.count == 0:
        listed = ", ".join(dataset.subdatasets[:5]) or "none"
        raise InputError(f"{name!r} has no bands of its own. Open one of its subdatasets instead: {listed}.")
    if not 1 <= int(band) <= dataset.count:
        raise InputError(f"{name!r} has no band {band}. Give band= from 1 to {dataset.count}.")
    if np.dtype(dataset.dtypes[band - 1]).kind not in "iuf":
        raise InputError(
            f"Band {band} of {name!r} holds {dataset.dtypes[band - 1]} samples, which are no heights. "
            "Choose a band of integers or floats with band=."
        )
    area = _window(dataset, name, window)
    _check_size(dataset, name, band, area, max_samples)
    samples = _samples(dataset, name, band, area)
    heights = _heights(dataset, band, samples, nodata)
    check_finite(heights, f"{name!r}", "Band " + str(band) + " of ")
    a, b, c, d, e, f = tuple(dataset.transform)[:6]
    if dataset.transform.is_identity and dataset.crs is None:
        _warn_of_no_place(name)
        e, f = -1.0, float(dataset.height)
    column, row = area.col_off, area.row_off
    transform = (a, b, c + a * column + b * row, d, e, f + d * column + e * row)
    return RasterBand(heights, AffineMap.of_transform(transform, repr(name)), dataset.crs)


def _window(dataset: Any, name: str, window: Any) -> Any:
    from rasterio.windows import Window

    if window is None:
        return Window(0, 0, dataset.width, dataset.height)
    try:
        if isinstance(window, Window):
            window = (window.col_off, window.row_off, window.width, window.height)
        column, row, width, height = (int(value) for value in window)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"window={window!r} must be (column, row, columns, rows) or a rasterio Window."
        ) from error
    inside = column >= 0 and row >= 0 and column + width <= dataset.width and row + height <= dataset.height
    if width < 1 or height < 1 or not inside:
        raise InputError(
            f"The window {(column, row, width, height)} (column, row, columns, rows) does not lie inside"
            f" {name!r}, which has {dataset.width} columns and {dataset.height} rows."
        )
    return Window(column, row, width, height)


def _check_size(dataset: Any, name: str, band: int, area: Any, max_samples: int | None) -> None:
    count = int(area.width) * int(area.height)
    item = np.dtype(dataset.dtypes[band - 1]).itemsize
    shape = f"{int(area.height)} x {int(area.width)}"
    limit = MAX_SAMPLES if max_samples is None else int(max_samples)
    cure = "Read a part with window=(column, row, columns, rows), or raise max_samples= if this is meant."
    if count > limit:
        raise MemoryLimitError(
            f"{name!r} declares {shape} samples ({size_text(count * item)}), more than the limit of {limit} "
            f"samples. {cure}"
        )
    block = math.prod(dataset.block_shapes[band - 1])
    if block > max(limit, 1 << 24):
        raise MemoryLimitError(
            f"{name!r} is stored in blocks of {block} samples, more than the limit of {limit}. Rewrite it in "
            "smaller tiles with gdal_translate -co TILED=YES, or raise max_samples=."
        )
    stored = _stored_bytes(dataset)
    if max_samples is None and stored and count * item > max(SMALL_BYTES, MOST_SHRINKING * stored):
        raise MemoryLimitError(
            f"{name!r} declares {shape} samples ({size_text(count * item)}) but holds only"
            f" {size_text(stored)}, so nearly all of it is empty. {cure}"
        )
    # The samples as stored, their mask, and the heights live side by side for a moment.
    check_memory(count * (item + 1 + 8), f"{name!r} declares {shape} samples, which", "read", cure)


def check_memory(needed: int, what: str, purpose: str, cure: str) -> None:
    """Raise MemoryLimitError when `needed` bytes, to do `purpose` with `what`, are not available."""
    available = available_memory()
    if available is not None and needed > available:
        raise MemoryLimitError(
            f"{what} would take {size_text(needed)} of memory to {purpose}, and {size_text(available)} are"
            f" available. {cure}"
        )


def _stored_bytes(dataset: Any) -> int | None:
    files = [Path(file) for file in dataset.files]
    if not files or not all(file.is_file() for file in files):
        return None
    return sum(file.stat().st_size for file in files)


def available_memory() -> int | None:
    """Bytes that can be allocated now: the machine's, or what a control group leaves of it."""
    found = []
    try:
        machine = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        found += [int(line.split()[1]) * 1024 for line in machine if line.startswith("MemAvailable:")]
        group = Path("/sys/fs/cgroup")
        limit = (group / "memory.max").read_text(encoding="ascii").strip()
        if limit != "max":
            used = int((group / "memory.current").read_text(encoding="ascii"))
            found.append(max(0, int(limit) - used + _file_cache(group)))
    except (OSError, ValueError):
        pass
    return min(found, default=None)


def _file_cache(group: Path) -> int:
    # Cached file pages count as used in a control group but are given up under pressure.
    for line in (group / "memory.stat").read_text(encoding="ascii").splitlines():
        if line.startswith("inactive_file "):
            return int(line.split()[1])
    return 0


def _samples(dataset: Any, name: str, band: int, area: Any) -> Any:
    try:
        return dataset.read(band, window=area, masked=True)
    except Exception as error:
        if isinstance(error, MemoryError):
            raise MemoryLimitError(
                f"Memory ran out while reading {name!r}. Read a part with window=(column, row, columns,"
                " rows)."
            ) from error
        raise FileError(
            f"Band {band} of {name!r} cannot be read: {error}. The file may be cut short or damaged; fetch it"
            " again."
        ) from error


def _heights(dataset: Any, band: int, samples: Any, nodata: float | None) -> NDArray[np.float32]:
    values, mask = np.ma.getdata(samples), np.ma.getmaskarray(samples)
    if nodata is not None:
        mask = values == nodata
    scale, offset = float(dataset.scales[band - 1]), float(dataset.offsets[band - 1])
    unit = str(dataset.units[band - 1] or "").strip().casefold()
    metres = METRES_PER_UNIT.get(unit, 1.0)
    if metres != 1.0:
        log.info("%s: heights in %s taken as %g metres each", dataset.name, unit, metres)
    if (scale, offset, metres) == (1.0, 0.0, 1.0):
        heights = as_heights(values, mask, repr(dataset.name))
    else:
        heights = as_heights((values * scale + offset) * metres, mask, repr(dataset.name))
    return heights


def as_heights(values: NDArray[Any], mask: NDArray[np.bool_] | None, what: str) -> NDArray[np.float32]:
    """`values` as float32 with NaN where `mask`; raises InputError at the first infinite height."""
    with np.errstate(over="ignore", invalid="ignore"):
        heights = values.astype(np.float32)
    if mask is not None:
        heights[mask] = np.nan
    infinite = np.isinf(heights)
    if infinite.any():
        row, column = (int(index) for index in np.argwhere(infinite)[0])
        raise InputError(
            f"{what[:1].upper()}{what[1:]} has {int(infinite.sum())} infinite heights (beyond float32), the"
            f" first at row {row}, column {column}: {values[row, column]!r}. Make them NaN, or name the value"
            " that marks holes with nodata=."
        )
    return heights


def check_finite(heights: NDArray[np.float32], what: str, prefix: str = "") -> None:
    if heights.size == 0 or not np.isfinite(heights).any():
        raise InputError(
            f"{prefix}{what} has no finite height among its {heights.shape[0]} x {heights.shape[1]} samples,"
            " so there is no terrain to draw. Check its nodata value, or choose another band or area."
        )


def _warn_of_no_place(name: str) -> None:
    warn(
        f"{name!r} has no georeference: its samples are taken to lie 1 m apart, the lower left corner at"
        " (0, 0)."
    )


def size_text(count: int) -> str:
    """A number of bytes as text, such as '9.0 GiB'."""
    for unit, size in (("GiB", 1 << 30), ("MiB", 1 << 20), ("KiB", 1 << 10)):
        if count >= size:
            return f"{count / size:.1f} {unit}"
    return f"{count} bytes"
