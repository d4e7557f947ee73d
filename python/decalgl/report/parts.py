"""The parts of the report, in the order of the page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import error_over_time, factors, needless, odd_inputs, papers, scaling, scenes, sizes, stability

if TYPE_CHECKING:
    from .part import Part

PARTS: dict[str, Part] = {
    "scenes": scenes,
    "sizes": sizes,
    "error_over_time": error_over_time,
    "factors": factors,
    "papers": papers,
    "scaling": scaling,
    "stability": stability,
    "odd_inputs": odd_inputs,
    "needless": needless,
}
