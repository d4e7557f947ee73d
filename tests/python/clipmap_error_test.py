"""How far clipmap textures are from the truth, in texels and pixels: near the eye, far away and on steep slopes.

Blur is that of decalgl.bench.artefacts. Where texels are larger than pixels, a texel's area and
linear interpolation make three boxes of one texel: 4 * 13 / 32 = 1.625 texels.
"""

from __future__ import annotations

import numpy as np
import pytest

import decalgl as dg
import judge
import scenes
from decalgl import reference as ref
from decalgl.bench import artefacts
from shapes import drawn_by
from small_scenes import warned

THREE_BOXES = 4.0 * 13.0 / 32.0


def test_near_the_eye_borders_are_as_wide_as_filtered_texels() -> None:
    border = artefacts.near_border()
    texel = artefacts.texel_of(border.terrain)
    assert border.blur(dg.Clipmap()) / texel == pytest.approx(THREE_BOXES, rel=0.1)


@pytest.mark.parametrize("height", [400.0, 500.0, 700.0])
def test_far_borders_are_less_than_two_pixels_wide(height: float) -> None:
    border = artefacts.far_border(height)
    pixel = height / border.size[0]
    assert 1.2 < border.blur(dg.Clipmap()) / pixel < 2.0
    assert border.blur(dg.Static(), "coverage") / pixel == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize("slope", [0.0, 1.0, 5.0])
def test_on_slopes_texels_are_stretched(slope: float) -> None:
    """Seen head-on, a border along the slope's contour is blurred over as many metres of the map at any slope, so over
    sqrt(1 + slope^2) times as many of the ground and the screen.
    """
    border = artefacts.border_on_slope(slope)
    texel = artefacts.texel_of(border.terrain)
    assert border.blur(dg.Clipmap()) / texel == pytest.approx(THREE_BOXES, rel=0.12)


# Pixels across: without samples along them, pixels take texels as wide as they are long. A window that does not reach
# along all of the border leaves blur, whatever the samples.
GRAZING = {
    "one sample": (dg.Clipmap(anisotropy=1, window=2048), 8.0, 25.0),
    "enough samples": (dg.Clipmap(anisotropy=16, window=2048), 0.8, 2.0),
    "a small window": (dg.Clipmap(anisotropy=16, window=512), 4.0, np.inf),
}


@pytest.mark.parametrize("name", list(GRAZING))
def test_grazing_borders_are_as_sharp_as_samples_and_window_allow(name: str) -> None:
    technique, least, most = GRAZING[name]
    wide = artefacts.grazing_border().blur(technique) / artefacts.GRAZING_PIXEL
    assert least < wide < most


# Against the reference: rms and 99th percentile of the overlay's error, of pixels that show one piece of ground.
ERRORS = {
    "hills": (0.018, 0.075),
    "grazing_plain": (0.025, 0.09),
    "map_from_above": (0.006, 0.03),
    "eye_at_one_metre": (0.01, 0.045),
}
SAMPLES = 8


@pytest.mark.parametrize("name", list(ERRORS))
def test_error_against_the_reference(name: str) -> None:
    view = scenes.build(name)
    renderer = dg.Renderer(antialias="none", terrain_error=0.0)
    crop = judge.busiest_crop(judge.draw(renderer, view), (80, 48))
    clipmaps = view._replace(scene=drawn_by(view.scene, dg.Clipmap()))
    with warned(judge.CLIPMAPS_WARN.get(name)):
        shown = judge.overlay_of(renderer, clipmaps, "none")
    surface = ref.sample_surface(view.scene, view.camera, view.size, crop, SAMPLES)
    true = ref.render_overlay(view.scene, view.camera, view.size, crop, SAMPLES, surface=surface)
    left, top, right, bottom = crop
    error = np.abs(shown[top:bottom, left:right] - true.rgba)
    judged = (true.terrain_fraction == 1.0) & ~judge.folded(view, crop, surface, SAMPLES)
    assert judged.mean() > 0.1
    rms, p99 = float(np.sqrt((error[judged] ** 2).mean())), float(np.percentile(error[judged], 99))
    assert rms <= ERRORS[name][0]
    assert p99 <= ERRORS[name][1]
