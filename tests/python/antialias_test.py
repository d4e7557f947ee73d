"""The ways of anti-aliasing of the whole frame, and silhouettes, against finer pictures and the reference."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np
import pytest
from shapely import Polygon, box

import decalgl as dg
import judge
import scenes
import shapes
from decalgl import reference as ref
from scenes import View
from small_scenes import MAP, OBLIQUE, SIZE, draw, flat_scene, hilly_scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Image = NDArray[np.float64]

MODES = ("none", "coverage", "ssaa", "msaa", "fxaa")
# Rows of the samples, column by column, counted from below: cpp/src/frame/sample_pattern.cpp.
ROWS = {2: (1, 0), 4: (2, 0, 3, 1), 8: (6, 3, 0, 5, 2, 7, 4, 1)}
# Bare ground is black, so that a picture is the premultiplied overlay.
BLACK = dg.Relief(color="black", strength=0.0, on_layers=0.0)


def overlay(view: View, antialias: str, **options: object) -> Image:
    """(h, w, 3): premultiplied colours of the layers; black where there is none, and sky."""
    renderer = dg.Renderer(view.size, antialias, **{"terrain_error": 0.0, **options})
    renderer.preprocess(shapes.repainted(view.scene, BLACK))
    renderer.update(view.camera)
    return renderer.render(background="black").image[..., :3] / 255.0


@pytest.mark.parametrize("samples", [2, 4, 8])
@pytest.mark.parametrize("name", ["hills", "coast"])
def test_ssaa_is_the_mean_of_pictures_at_the_samples(name: str, samples: int) -> None:
    """A picture that is finer by the number of samples has a pixel's centre at each of them."""
    width, height = 160, 90
    view = scenes.build(name)._replace(size=(width, height))
    fine = overlay(view._replace(size=(samples * width, samples * height)), "none")
    columns, rows = np.arange(samples), np.array(ROWS[samples])
    places = fine.reshape(height, samples, width, samples, 3)[:, samples - 1 - rows, :, columns]
    off = np.abs(overlay(view, "ssaa", samples=samples) - places.mean(axis=0)).max(axis=-1)
    # The finer picture's corners are snapped to finer steps, so that a few silhouettes differ.
    assert (off > 1.01 / 255).mean() <= 2e-4
    one = np.abs(places[0] - places.mean(axis=0)).max(axis=-1)
    assert (one > 1.01 / 255).mean() > 0.01


def test_one_sample_is_no_antialiasing() -> None:
    scene = hilly_scene()
    scene.add_polygons([box(20, 20, 60, 61.3)], color="green", alpha=0.5)
    for antialias in ("ssaa", "msaa"):
        one = draw(scene, OBLIQUE, antialias=antialias, samples=1, background=None).image.astype(int)
        assert np.abs(one - draw(scene, OBLIQUE, background=None).image).max() <= 1


@pytest.mark.parametrize("antialias", ["ssaa", "msaa"])
def test_more_samples_err_less(antialias: str) -> None:
    view = scenes.build("hills")
    crop = (300, 150, 356, 182)
    expected = ref.render_overlay(view.scene, view.camera, view.size, crop)
    assert expected.varied.sum() > 200
    errors = []
    for samples in (2, 8, 32):
        got = overlay(view, antialias, samples=samples)[crop[1] : crop[3], crop[0] : crop[2]]
        errors.append(np.sqrt(((got - expected.rgba[..., :3])[expected.varied] ** 2).mean()))
    assert errors[0] > 1.5 * errors[1] > 1.5 * 1.25 * errors[2]
    assert errors[2] <= (0.015 if antialias == "ssaa" else 0.02)


def test_msaa_has_the_driver_s_samples() -> None:
    """Nearly all drivers have four samples where ssaa has them."""
    view = scenes.build("coast")._replace(size=(160, 90))
    off = np.abs(overlay(view, "msaa", samples=4) - overlay(view, "ssaa", samples=4)).max(axis=-1)
    assert (off > 1.01 / 255).mean() <= 2e-4


@pytest.mark.parametrize("antialias", ["ssaa", "msaa", "fxaa", "coverage"])
def test_alpha_is_the_share_of_the_terrain(antialias: str) -> None:
    """The ground's one colour is not mixed with the sky's where that is transparent."""
    scene = flat_scene(relief=dg.Relief(color=(0.8, 0.4, 0.2), strength=0.0))
    camera = dg.Camera.look_at((50.0, -20.0, 40.0), (55.0, 60.0, 0.0))
    image = draw(scene, camera, antialias=antialias, background=None).image
    seen = image[..., 3] > 0
    np.testing.assert_allclose(image[seen][:, :3], np.broadcast_to((204, 102, 51), (seen.sum(), 3)), atol=3)
    if antialias != "fxaa":
        exact = ref.render_overlay(scene, camera.for_size(SIZE), SIZE).terrain_fraction
        partly = (exact > 0.0) & (exact < 1.0)
        assert partly.sum() > 100
        error = (image[..., 3] / 255.0 - exact)[partly]
        assert np.sqrt((error**2).mean()) <= 0.08
        assert abs(error.mean()) <= 0.01


def test_fxaa_smooths_edges_alone() -> None:
    scene = flat_scene()
    edge = Polygon([(0, 31.3), (100, 42.9), (100, 100), (0, 100)])
    scene.add_polygons([edge], color="black")
    exact = draw(scene, antialias="ssaa", samples=32).image[..., :3].astype(float)
    hard, soft = (draw(scene, antialias=mode).image[..., :3].astype(float) for mode in ("none", "fxaa"))
    partly = np.abs(hard - exact).max(axis=-1) > 2.0
    assert partly.sum() > 50
    rms = [np.sqrt(((one - exact)[partly] ** 2).mean()) for one in (hard, soft)]
    assert rms[1] <= 0.5 * rms[0]
    near = ~judge.eroded(~partly, 2)
    np.testing.assert_array_equal(soft[~near], hard[~near])


def test_no_mode_changes_what_the_pixels_centres_see() -> None:
    view = scenes.build("coast")._replace(size=(160, 90))
    first = judge.draw(dg.Renderer(), view)
    for mode in MODES[1:]:
        frame = judge.draw(dg.Renderer(), view, mode)
        assert frame.image.tobytes() != first.image.tobytes()
        for name in ("ids", "layers", "depth", "world"):
            assert getattr(frame, name).tobytes() == getattr(first, name).tobytes(), (mode, name)


def test_passes_and_variants_of_each_mode() -> None:
    programs, passes = {}, {}
    for mode in MODES:
        scene = hilly_scene()
        scene.add_polygons([box(20, 20, 60, 60)])
        stats = draw(scene, OBLIQUE, antialias=mode, samples=4).stats
        programs[mode] = {name.split("[")[0] for name in stats.variants}
        passes[mode] = Counter(one["name"] for one in stats.passes)
    always = {"terrain", "static_decals", "compose"}
    assert programs["none"] == always
    assert programs["coverage"] == always | {"silhouettes", "gathered", "facets", "spread", "mean_gathered"}
    assert programs["ssaa"] == always | {"mean"}
    assert programs["msaa"] == always | {"mean", "one_sample"}
    assert programs["fxaa"] == always | {"fxaa"}
    assert passes["ssaa"]["terrain"] == passes["ssaa"]["static"] == passes["ssaa"]["compose"] == 4
    assert 4 % passes["msaa"]["terrain"] == 0
    assert passes["msaa"]["one_sample"] == passes["msaa"]["static"] == passes["msaa"]["compose"] == 4
    assert passes["fxaa"]["terrain"] == passes["fxaa"]["fxaa"] == 1


# Silhouettes


def silhouette_crop(view: View, size: tuple[int, int]) -> judge.Crop:
    """The crop of a size, among some, with the most pixels beside other depths or the sky."""
    depth = np.minimum(judge.draw(dg.Renderer(), view).depth, 1e9)
    jumps = np.abs(np.diff(np.log(depth), axis=0)) > 0.1
    corners = [
        (x, y)
        for y in range(0, view.size[1] - size[1] + 1, size[1] // 2)
        for x in range(0, view.size[0] - size[0] + 1, size[0] // 2)
    ]
    x, y = max(corners, key=lambda at: int(jumps[at[1] : at[1] + size[1], at[0] : at[0] + size[0]].sum()))
    return (x, y, x + size[0], y + size[1])


@pytest.mark.parametrize(
    ("name", "index"),
    [
        ("hills", "grid"),
        ("hills", "bvh"),
        ("grazing", "grid"),
        ("honolulu", "grid"),
        ("nodata_holes", "grid"),
    ],
)
def test_coverage_filters_silhouettes(name: str, index: str) -> None:
    """Pixels that see two surfaces, or terrain and sky; beside holes there are some that no pixel's centre sees."""
    view = scenes.build(name)
    crop = silhouette_crop(view, (64, 36))
    expected = ref.render_overlay(view.scene, view.camera, view.size, crop)
    hard, soft = (
        overlay(view, mode, terrain_error=0.5, index=index)[crop[1] : crop[3], crop[0] : crop[2]]
        for mode in ("none", "coverage")
    )
    mixed = expected.mixed & expected.varied
    assert mixed.sum() >= 20
    errors = [np.sqrt(((one - expected.rgba[..., :3])[mixed] ** 2).mean()) for one in (hard, soft)]
    assert errors[1] <= 0.015
    assert errors[1] <= 0.5 * errors[0]


def test_a_scene_without_silhouettes_draws_none() -> None:
    scene = flat_scene()
    scene.add_polygons([box(20, 20, 60, 60)])
    inside = dg.Camera.top_down((10, 10, 90, 90))
    assert draw(scene, inside, antialias="coverage").stats.counts["silhouette_pixels"] == 0
    assert draw(scene, MAP, antialias="none").stats.counts["silhouette_pixels"] == 0
    oblique = draw(scene, OBLIQUE, antialias="coverage").stats.counts["silhouette_pixels"]
    assert 0 < oblique < 0.1 * SIZE[0] * SIZE[1]
