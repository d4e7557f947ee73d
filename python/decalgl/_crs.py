"""Coordinate reference systems: reading them, telling metric ones from others, moving points.

A scene is a plane in metres. A CRS serves as one when it is projected (or local) and its axes are in
metres; anything else is warped to a transverse Mercator plane around the terrain's centre, where scale
is true along the central meridian and within 1e-4 of true up to 90 km from it.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import CrsError

if TYPE_CHECKING:
    import pyproj
    from numpy.typing import NDArray

EARTH_RADIUS = 6_378_137.0


def parse_crs(value: Any, what: str) -> pyproj.CRS | None:
    """`value` as a CRS: anything pyproj reads (a code, WKT, a rasterio CRS, ...), None stays None.

    Raises CrsError that names `what` (such as "the crs of layer 'roads'") when pyproj cannot read it.
    """
    if value is None:
        return None
    import pyproj

    try:
        if hasattr(value, "to_wkt") and not isinstance(value, pyproj.CRS):
            value = value.to_wkt()
        return pyproj.CRS.from_user_input(value)
    except Exception as error:
        raise CrsError(
            f"{what[:1].upper()}{what[1:]} is not a coordinate reference system that PROJ knows: {value!r}. "
            "Give an EPSG code such as 'EPSG:32604', a PROJ string or WKT."
        ) from error


def name_of(crs: Any) -> str:
    """A short name for messages: 'EPSG:4326', a PROJ string, or the CRS's own name."""
    if crs is None:
        return "no CRS"
    text = str(crs.to_string())
    return text if len(text) <= 120 else str(crs.name)


def is_metric(crs: pyproj.CRS) -> bool:
    """Whether the plane of `crs` is measured in metres along both axes."""
    if crs.is_geographic or crs.is_geocentric:
        return False
    axes = crs.axis_info[:2]
    return len(axes) == 2 and all(math.isclose(axis.unit_conversion_factor, 1.0) for axis in axes)


def same_crs(first: pyproj.CRS, second: pyproj.CRS) -> bool:
    """Whether both describe the same horizontal plane (axis order does not matter: always x, y)."""
    return bool(first == second) or bool(first.equals(second, ignore_axis_order=True))


def geographic_turn(crs: pyproj.CRS) -> float:
    """One full turn in the angular unit of a geographic `crs`: 360 for degrees."""
    factor = crs.axis_info[0].unit_conversion_factor
    return 2.0 * math.pi / factor if factor else 360.0


def local_metric_crs(source: pyproj.CRS, x: float, y: float) -> pyproj.CRS:
    """Transverse Mercator in metres around the point (x, y) of `source`, rounded to 1e-4 degree."""
    import pyproj

    geodetic = source.geodetic_crs
    if geodetic is None:
        raise CrsError(
            f"The CRS {name_of(source)} is neither in metres nor tied to the Earth, so it cannot be warped to"
            " a metric plane. Give the terrain a projected CRS in metres."
        )
    longitude, latitude = transformer(source, geodetic).transform(x, y)
    degrees = 360.0 / geographic_turn(geodetic)
    longitude, latitude = longitude * degrees, latitude * degrees
    if not (math.isfinite(longitude) and math.isfinite(latitude) and abs(latitude) <= 90.0):
        raise CrsError(
            f"The terrain's centre ({x:.10g}, {y:.10g}) is no place on the globe in {name_of(source)}. "
            "Check its transform and its CRS."
        )
    longitude = (longitude + 180.0) % 360.0 - 180.0
    centre = f"+lat_0={_decimal(latitude)} +lon_0={_decimal(longitude)}"
    return pyproj.CRS.from_user_input(
        f"+proj=tmerc {centre} +k=1 +x_0=0 +y_0=0 {_figure_of(geodetic)} +units=m +no_defs +type=crs"
    )


def _decimal(degrees: float) -> str:
    # Adding 0.0 turns -0.0 into 0.0; repr keeps every digit of the rounded number.
    return repr(round(float(degrees), 4) + 0.0)


def _figure_of(geodetic: pyproj.CRS) -> str:
    # The datum, not only the ellipsoid: with the bare ellipsoid PROJ skips datum shifts, and a layer in,
    # say, the British grid would land a hundred metres off.
    ellipsoid = geodetic.ellipsoid
    if ellipsoid is None or abs(ellipsoid.semi_major_metre - EARTH_RADIUS) < 10_000.0:
        return "+datum=WGS84"
    return f"+a={ellipsoid.semi_major_metre!r} +b={ellipsoid.semi_minor_metre!r}"


@lru_cache(maxsize=32)
def transformer(source: pyproj.CRS, target: pyproj.CRS) -> Any:
    """A pyproj Transformer from `source` to `target`, x before y on both sides."""
    import pyproj

    try:
        return pyproj.Transformer.from_crs(source, target, always_xy=True)
    except pyproj.exceptions.ProjError as error:
        raise CrsError(
            f"There is no way from {name_of(source)} to {name_of(target)}: {error}. "
            "Give both data sets a CRS that PROJ can connect."
        ) from error


def transform_xy(source: pyproj.CRS, target: pyproj.CRS, xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (n, 2) moved from `source` to `target`; infinite where the projection has no image."""
    moved = np.empty(xy.shape, dtype=np.float64)
    moved[:, 0], moved[:, 1] = transformer(source, target).transform(xy[:, 0], xy[:, 1])
    return moved
