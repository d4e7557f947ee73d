"""A scene as the core takes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _core
from ._colors import colormap, parse_color
from ._triangles import triangles_of

if TYPE_CHECKING:
    from .scene import Layer, Scene
    from .strokes import Fill, Hatch, LinePattern, Stroke, StrokeStyle


def core_scene(scene: Scene) -> _core.Scene:
    """Terrain, relief and layers. Arrays of geometry are shared, not copied."""
    terrain = scene.terrain
    result = _core.Scene(
        heights=terrain.z,
        x0=terrain.x0,
        y0=terrain.y0,
        dx=terrain.dx,
        dy=terrain.dy,
        exaggeration=scene.exaggeration,
        relief=_core_relief(scene),
    )
    for layer in scene.layers:
        _add_layer(layer, result)
        if layer.technique.needs_triangles and layer.kind == "polygons" and layer.fill is not None:
            result.set_triangles(layer.index, *triangles_of(layer.features))
    return result


def _add_layer(layer: Layer, result: _core.Scene) -> None:
    result.add_layer(
        name=layer.name,
        technique=layer.technique.name,
        technique_options=layer.technique.core_options(),
        polygons=layer.features.kind == "polygons",
        coordinates=layer.features.coords,
        part_offsets=layer.features.part_offsets,
        feature_offsets=layer.features.feature_offsets,
        rows=layer.features.rows,
        fill=_core_fill(layer.fill),
        stroke=_core_stroke(layer.stroke),
        casing=_core_stroke(layer.casing),
        outline_mode=_core.OutlineMode.__members__[layer.outline_mode],
        outline_order=_core.OutlineOrder.__members__[layer.outline_order],
        draw_order=layer.draw_order,
    )


def _core_fill(given: Fill | None) -> _core.Fill:
    fill = _core.Fill()
    if given is None:
        return fill
    fill.colors = given.colors.reshape(-1)
    fill.hatches = [core_hatch(each) for each in given.hatches]
    if given.hatch_of is not None:
        fill.hatch_of = given.hatch_of
    return fill


def core_hatch(given: Hatch | None) -> _core.Hatch:
    """None is an even fill."""
    if given is None:
        return _core.Hatch(spacing=0.0, width=0.0, angle=0.0, crossed=False)
    return _core.Hatch(**vars(given))


def _core_stroke(given: Stroke | None) -> _core.Stroke:
    stroke = _core.Stroke()
    if given is None:
        return stroke
    stroke.colors = given.colors.reshape(-1)
    stroke.widths = given.widths
    stroke.styles = [core_style(style) for style in given.styles]
    stroke.widest = given.widest
    stroke.in_pixels = given.units == "px"
    limits = given.limits
    stroke.limits = (limits.least_px, limits.most_px, limits.least_metres, limits.most_metres)
    if given.style_of is not None:
        stroke.style_of = given.style_of
    return stroke


def core_style(given: StrokeStyle) -> _core.StrokeStyle:
    """A style of strokes as the core takes it."""
    style = _core.StrokeStyle()
    style.corner = _core.Corner.__members__[given.corner]
    style.cap = _core.Cap.__members__[given.cap]
    style.miter_limit = given.miter_limit
    style.slope_correction = _core.SlopeCorrection.__members__[given.slope_correction]
    if given.pattern is not None:
        style.pattern = _core_pattern(given.pattern)
    style.bands = [_core.ColorBand(band.reach, band.color) for band in given.bands]
    return style


def _core_pattern(given: LinePattern) -> _core.LinePattern:
    marks = [
        _core.PatternMark(mark.begin, mark.end, mark.begin_width, mark.end_width) for mark in given.marks
    ]
    return _core.LinePattern(given.period, given.offset, marks)


def _core_relief(scene: Scene) -> _core.Relief:
    relief = _core.Relief()
    given = scene.relief
    relief.color = [round(255 * channel) for channel in parse_color(given.color)[:3]]
    relief.azimuth, relief.altitude = given.azimuth, given.altitude
    relief.strength, relief.on_layers = given.strength, given.on_layers
    if given.cmap is not None:
        lowest = float(np.nanmin(scene.heights)) if given.vmin is None else given.vmin
        highest = float(np.nanmax(scene.heights)) if given.vmax is None else given.vmax
        ramp = colormap(given.cmap)(np.linspace(0.0, 1.0, 256))
        relief.ramp = np.rint(255 * ramp[:, :3]).astype(np.uint8).ravel().tolist()
        relief.lowest, relief.highest = lowest, max(highest, lowest + 1e-3)
    return relief
