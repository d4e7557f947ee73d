"""Road styles of three countries for OpenStreetMap's classes (Trapp et al. 2015, section 6.1).

One network, restyled as a whole: geometry is not touched.

    renderer.restyle("roads", technique=DistanceField(category="highway", styles=road_styles("france")))
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from .errors import StyleError
from .networks import NetworkCategory, NetworkStyle

if TYPE_CHECKING:
    from collections.abc import Mapping

Country = Literal["germany", "france", "britain"]

# Classes from the lowest rank to the highest, with widths in metres and what is drawn far away.
CLASSES = {
    "path": (2.0, False),
    "service": (4.0, False),
    "residential": (6.0, False),
    "tertiary": (8.0, True),
    "secondary": (10.0, True),
    "primary": (12.0, True),
    "trunk": (14.0, True),
    "motorway": (18.0, True),
}
# Further classes of OpenStreetMap that look the same.
SAME_AS = {
    "footway": "path",
    "cycleway": "path",
    "track": "path",
    "steps": "path",
    "pedestrian": "service",
    "living_street": "residential",
    "unclassified": "residential",
    "road": "residential",
    "tertiary_link": "tertiary",
    "secondary_link": "secondary",
    "primary_link": "primary",
    "trunk_link": "trunk",
    "motorway_link": "motorway",
}
COLORS: Mapping[str, Mapping[str, tuple[str, str]]] = {
    "germany": {
        "path": ("#ffffff", "#b0a89a"),
        "service": ("#ffffff", "#b8b8b8"),
        "residential": ("#ffffff", "#a8a8a8"),
        "tertiary": ("#fffbd0", "#9a9a80"),
        "secondary": ("#ffef8a", "#8c7a20"),
        "primary": ("#ffd83c", "#806000"),
        "trunk": ("#ffb52e", "#7a4a00"),
        "motorway": ("#f58220", "#5c2c00"),
    },
    "france": {
        "path": ("#f7f3ea", "#c9bfa8"),
        "service": ("#ffffff", "#c8c8c8"),
        "residential": ("#ffffff", "#b4b4b4"),
        "tertiary": ("#fdf6b2", "#a39a5a"),
        "secondary": ("#fbe45b", "#968225"),
        "primary": ("#e8432e", "#7d1a0e"),
        "trunk": ("#d5261a", "#6b0f08"),
        "motorway": ("#e98c7e", "#b11d10"),
    },
    "britain": {
        "path": ("#f4efe4", "#bfb6a4"),
        "service": ("#ffffff", "#c4c4c4"),
        "residential": ("#ffffff", "#aaaaaa"),
        "tertiary": ("#fff7c2", "#98905c"),
        "secondary": ("#f6b26b", "#8a5a1f"),
        "primary": ("#5fb36a", "#1f5c2a"),
        "trunk": ("#3f9d57", "#0f4a22"),
        "motorway": ("#4f86d9", "#173f80"),
    },
}


def road_styles(country: Country = "germany", main: float = 0.75) -> dict[str, NetworkCategory]:
    """Styles by OpenStreetMap's `highway`, the lowest rank first.

    At level of detail 1, far away, minor roads are gone and major ones three times as wide.
    main: the share of the width in the main colour.

    Raises StyleError.
    """
    if country not in COLORS:
        raise StyleError(f"There are no road styles of {country!r}; choose {', '.join(map(repr, COLORS))}.")
    styles: dict[str, NetworkCategory] = {}
    for name, (width, is_major) in CLASSES.items():
        color, border = COLORS[country][name]
        near = NetworkStyle(width, color, border, main)
        far = NetworkStyle(3.0 * width if is_major else 0.0, color, border, main)
        styles[name] = NetworkCategory([(0.0, near), (1.0, far)])
    return styles


def road_classes(values: object) -> list[str | None]:
    """Each road's class of `road_styles`, from OpenStreetMap's `highway`; None for those without."""
    classes = [SAME_AS.get(str(value), str(value)) for value in values]  # type: ignore[attr-defined]
    return [name if name in CLASSES else None for name in classes]
