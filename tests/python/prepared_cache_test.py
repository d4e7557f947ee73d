"""Caches of prepared scenes: opened where they were made from the very scene, else made anew."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from shapely import box

import decalgl as dg
from saved_scenes import assert_same, drawn, prepared, sample_scene, save_sample
from small_scenes import MAP, OBLIQUE, SIZE

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample scene, saved."""
    return save_sample(tmp_path_factory)


def cached(scene: dg.Scene, path: Path, **options: Any) -> tuple[dg.Frame, bool]:
    """The frame of a new renderer, and whether the cache was opened for it."""
    renderer = dg.Renderer(SIZE, **options)
    renderer.preprocess(scene, cache=path)
    frame = drawn(renderer)
    hit = set(frame.stats.preprocess) == {"fingerprint", "open"}
    assert hit or set(frame.stats.preprocess) >= {"fingerprint", "terrain", "save"}
    return frame, hit


def test_a_cache_is_made_and_then_opened(tmp_path: Path, saved: Path) -> None:
    path = tmp_path / "map.decal"
    scene = sample_scene()
    made, hit = cached(scene, path)
    assert not hit
    assert path.read_bytes() == saved.read_bytes()
    again, hit = cached(scene, path)
    assert hit
    assert_same(again, made)
    frame, hit = cached(sample_scene(), path)
    assert hit
    assert frame.pick(50, 50)[0].layer.coloring is not None  # layers are the scene's, not the file's
    assert cached(sample_scene(), saved)[1]  # save() serves as well


@pytest.mark.parametrize(
    "options", [{"threads": 1}, {"threads": 3}, {"tile": 20}, {"antialias": "none"}, {"terrain_error": 0.0}]
)
def test_options_of_the_picture_do_not_matter_to_a_cache(saved: Path, options: dict[str, Any]) -> None:
    frame, hit = cached(sample_scene(), saved, **options)
    assert hit
    assert_same(frame, drawn(prepared(sample_scene(), **options)))


CHANGES = [
    {"exaggeration": 1.5},
    {"relief": dg.Relief()},
    {"relief": dg.Relief(cmap="gray")},
    {"relief": dg.Relief(cmap="terrain", vmax=40.0)},
    {"relief": dg.Relief(cmap="terrain", strength=0.5)},
    {"relief": dg.Relief(cmap="terrain", on_layers=0.5)},
    {"name": "meadows"},
    {"color": ["red", "#008001"]},
    {"alpha": 0.6},
    {"order": "size"},
    {"box": (20, 20, 80, 80.001)},
    {"width": [4.0, 8.001]},
    {"vertex": 99.99},
    {"height": 0.01},
]


@pytest.mark.parametrize("change", CHANGES)
def test_any_change_makes_a_cache_anew(saved: Path, tmp_path: Path, change: dict[str, Any]) -> None:
    path = tmp_path / "map.decal"
    path.write_bytes(saved.read_bytes())
    frame, hit = cached(sample_scene(**change), path)
    assert not hit
    assert_same(frame, drawn(prepared(sample_scene(**change))))
    assert cached(sample_scene(**change), path)[1]
    assert not cached(sample_scene(), path)[1]


def test_added_layers_and_exchanged_reliefs_make_a_cache_anew(tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    scene = sample_scene()
    renderer = dg.Renderer(SIZE)
    renderer.preprocess(scene, cache=path)
    scene.relief = replace(scene.relief, azimuth=100.0)
    renderer.preprocess(scene, cache=path)
    assert "save" in drawn(renderer).stats.preprocess
    scene.add_polygons([box(0, 0, 10, 10)], color="black")
    renderer.preprocess(scene, cache=path)
    assert "save" in drawn(renderer).stats.preprocess
    told: list[str] = []
    renderer.preprocess(scene, lambda stage, _: told.append(stage), cache=path)
    renderer.preprocess(scene, lambda stage, _: told.append(stage))
    assert not told
    assert cached(scene, path)[1]


def test_a_scene_keeps_its_cache(tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    sample_scene().render(OBLIQUE, SIZE, cache=path)
    scene = sample_scene()
    assert "open" in scene.render(OBLIQUE, SIZE, cache=path).stats.preprocess
    path.unlink()
    assert "open" in scene.render(MAP, SIZE, cache=path).stats.preprocess  # nothing was left to prepare
    assert not path.exists()


def test_the_other_index_is_not_kept_on_disk(tmp_path: Path) -> None:
    renderer = dg.Renderer(size=SIZE, index="bvh")
    with pytest.raises(dg.UnsupportedError, match="leave cache out"):
        renderer.preprocess(sample_scene(), cache=tmp_path / "map.decal")
    renderer.preprocess(sample_scene())
    with pytest.raises(dg.UnsupportedError, match="index 'grid'"):
        renderer.save(tmp_path / "map.decal")
    assert not list(tmp_path.iterdir())


def test_damaged_caches_are_replaced_and_other_files_are_not(saved: Path, tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    whole = saved.read_bytes()
    other_version = bytearray(whole)
    other_version[12] += 1
    changed = bytearray(whole)
    changed[-20] ^= 1
    for damaged in (whole[:100], whole[:-1], bytes(other_version), bytes(changed), whole + b"more"):
        path.write_bytes(damaged)
        assert not cached(sample_scene(), path)[1]
        assert path.read_bytes() == whole
    for other in (b"", b"DECALG", b"II*\0 a raster"):
        path.write_bytes(other)
        with pytest.raises(dg.FileError, match=r"not a prepared scene.*not replaced.*name another"):
            cached(sample_scene(), path)
        assert path.read_bytes() == other
    with pytest.raises(dg.FileError, match="Is a directory"):
        cached(sample_scene(), tmp_path)


def test_a_cache_that_cannot_be_written_is_known_before_the_work(tmp_path: Path) -> None:
    renderer = dg.Renderer(SIZE)
    with pytest.raises(dg.FileError, match=r"Cannot write .*No such file"):
        renderer.preprocess(
            sample_scene(), lambda *_: pytest.fail("too late"), cache=tmp_path / "none" / "map.decal"
        )
    with pytest.raises(dg.InputError, match="preprocess"):
        renderer.update(OBLIQUE)


def test_cancelling_while_a_cache_is_written(saved: Path, tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    renderer = dg.Renderer(SIZE)
    told: list[str] = []

    def stop(stage: str, fraction: float) -> bool:
        told.append(stage)
        return stage != "saving" or fraction < 0.1

    with pytest.raises(dg.CancelledError, match="saving"):
        renderer.preprocess(sample_scene(), stop, cache=path)
    assert not list(tmp_path.iterdir())
    path.write_bytes(saved.read_bytes())
    with pytest.raises(dg.CancelledError):
        renderer.preprocess(sample_scene(name="other"), stop, cache=path)
    assert path.read_bytes() == saved.read_bytes()


def test_many_renderers_share_a_cache(tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    frames: list[dg.Frame] = []
    threads = [
        threading.Thread(target=lambda: frames.append(cached(sample_scene(), path)[0])) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    expected = drawn(prepared(sample_scene())).image
    assert len(frames) == 4
    assert all((frame.image == expected).all() for frame in frames)
    assert [entry.name for entry in tmp_path.iterdir()] == ["map.decal"]
