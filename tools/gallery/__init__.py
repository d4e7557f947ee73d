"""The pictures of docs/gallery.md, drawn into docs/images/gallery: `make gallery`, or python -m tools.gallery.

sheet       panels with labels beside each other, as one picture
lines       strokes: corners, caps, patterns, bands, casings
polygons    outlines, hatches, and what lies over what
networks    distance fields: countries, levels of detail, borders, artefacts
changes     lenses, fading, filters, edits
ground      Honolulu's terrain and data
maps        Honolulu: colours with legends, both indexes, anti-aliasing, silhouettes; widths on slopes
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples"))  # of honolulu.py
