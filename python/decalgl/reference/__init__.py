"""A slow, independent renderer in double precision, to judge the fast ones by.

It shares no code with the renderer and needs NumPy and shapely only. `raycast` finds the terrain,
`membership` decides which decals hold a point, `render_ids` and `render_overlay` make the picture,
`exact_coverage` clips areas, and `compare_ids` and `compare_overlay` put differences into numbers.
"""

from .compare import IdComparison, OverlayComparison, compare_ids, compare_overlay
from .coverage import exact_coverage, sampled_coverage
from .edges import edge_distance
from .membership import Membership, membership
from .picture import (
    Ids,
    Overlay,
    composite,
    render_ids,
    render_overlay,
    sample_points,
    sample_surface,
    slopes_of,
)
from .rays import Surface, pixel_centres, raycast
from .strokes import Slopes

__all__ = [
    "IdComparison",
    "Ids",
    "Membership",
    "Overlay",
    "OverlayComparison",
    "Slopes",
    "Surface",
    "compare_ids",
    "compare_overlay",
    "composite",
    "edge_distance",
    "exact_coverage",
    "membership",
    "pixel_centres",
    "raycast",
    "render_ids",
    "render_overlay",
    "sample_points",
    "sample_surface",
    "sampled_coverage",
    "slopes_of",
]
