"""How far the artefacts go that papers name: figures of pictures and counts, which no machine changes.

figure   what was measured, in the words of `artefact` and `unit`
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import decalgl as dg

from .. import artefacts
from ..workload import add_lines
from .dynamic import some_lines

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..records import Records
    from ..workload import Workload

SLOPES = (1.0, 5.0)
ANISOTROPY = (1, 4, 16)
OVERDRAWN = {"volume": dg.Volume(groups="colors"), "clipmap": dg.Clipmap()}
VIEWS = ("overview", "oblique", "close")
SHARE = 0.01  # of the smallest isolines


def measure(work: Workload, records: Records) -> None:
    def add(technique: str, artefact: str, figure: float, unit: str) -> None:
        records.at(artefact, None, technique).update(artefact=artefact, figure=figure, unit=unit)

    blurs(add)
    networks(add)
    arrays = work.contours("isolines", next(iter(work.sizes)))
    table = some_lines(arrays, SHARE)

    def scene_of(technique: dg.Technique) -> dg.Scene:
        scene = dg.Scene(work.ground)
        add_lines(scene, table, technique=technique)
        return scene

    size = (work.picture[0] // 2, work.picture[1] // 2)
    for name, technique in OVERDRAWN.items():
        for view in VIEWS:
            work.say(f"overdraw of {name}, {view}")
            figure = artefacts.overdraw(scene_of, technique, work.views[view], size)
            add(name, f"overdraw, isolines, {view}", figure, "samples a covered pixel")


def blurs(add: Callable[[str, str, float, str], None]) -> None:
    """Borders in clipmaps, near and far, on slopes and at grazing angles."""
    near = artefacts.near_border()
    texel = artefacts.texel_of(near.terrain)
    add("clipmap", "blur near the eye", near.blur(dg.Clipmap()) / texel, "texels")
    far = artefacts.far_border(500.0)
    add("clipmap", "blur from afar", far.blur(dg.Clipmap()) / (500.0 / far.size[0]), "pixels")
    for slope in SLOPES:
        border = artefacts.border_on_slope(slope)
        wide = border.blur(dg.Clipmap()) * math.hypot(1.0, slope)
        add("clipmap", f"stretch on a slope of {slope:g}: blur of the ground", wide / texel, "texels")
    grazing = artefacts.grazing_border()
    for most in ANISOTROPY:
        wide = grazing.blur(dg.Clipmap(anisotropy=most, window=2048)) / artefacts.GRAZING_PIXEL
        add("clipmap", f"blur at 5 degrees, anisotropy {most}", wide, "pixels")


def networks(add: Callable[[str, str, float, str], None]) -> None:
    """What the paper on distance fields names, and what mends it."""
    technique, share, metres = "distance_field", "% of the lines' length", "m of 20 m"
    add(technique, "intrusion", 100.0 * artefacts.intrusion(), share)
    mended = artefacts.intrusion(mend_intrusion=True, widths_at="vertex")
    add(technique, "intrusion, mended", 100.0 * mended, share)
    add(technique, "protrusion", artefacts.protrusion(), metres)
    add(technique, "protrusion, mended", artefacts.protrusion(mend_protrusion=True), metres)
    add(technique, "steps of eight bits, of a line 600 pixels wide", artefacts.steps(), "pixels")
