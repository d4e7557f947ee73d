"""Prepared scenes on disk: the same pictures without the scene, caches that know their scene, damaged files."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapely import LineString, box

import decalgl as dg
from small_scenes import MAP, OBLIQUE, SIZE, flat_scene, hilly_scene

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ARRAYS = ("image", "ids", "layers", "depth", "world")


def sample_scene(**changes: Any) -> dg.Scene:
    """A hill with two polygons and two lines; `changes` exchange one thing of it."""
    given_parts: dict[str, Any] = {
        "exaggeration": 1.0,
        "relief": dg.Relief(cmap="terrain"),
        "name": "fields",
        "color": ["red", "green"],
        "alpha": 0.5,
        "order": "feature",
        "box": (20, 20, 80, 80),
        "width": [4.0, 8.0],
        "vertex": 100.0,
        "height": 0.0,
        **changes,
    }
    hills = hilly_scene().terrain
    z = hills.z.copy()
    z[3, 4] += given_parts["height"]
    terrain = dg.Terrain(z, hills.x0, hills.y0, hills.dx, hills.dy)
    scene = dg.Scene(terrain, given_parts["exaggeration"], given_parts["relief"])
    scene.add_polygons(
        [box(*given_parts["box"]), box(40, 40, 90, 95)],
        name=given_parts["name"],
        color=given_parts["color"],
        alpha=given_parts["alpha"],
        order=given_parts["order"],
    )
    lines = [LineString([(0, 0), (given_parts["vertex"], 100)]), LineString([(0, 60), (100, 50)])]
    scene.add_lines(lines, name="ways", width=given_parts["width"], width_units="m", color="blue")
    return scene


def drawn(renderer: dg.Renderer, camera: dg.Camera = OBLIQUE) -> dg.Frame:
    renderer.update(camera)
    return renderer.render()


def prepared(scene: dg.Scene, **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(SIZE, **options)
    renderer.preprocess(scene)
    return renderer


def opened(path: Path, **options: Any) -> dg.Renderer:
    renderer = dg.Renderer(SIZE, **options)
    renderer.open(path)
    return renderer


def counts_of(frame: dg.Frame) -> dict[str, float]:
    """Without those of uploads, which depend on what was drawn before."""
    return {name: count for name, count in frame.stats.counts.items() if not name.startswith("upload")}


def assert_same(one: dg.Frame, other: dg.Frame) -> None:
    for name in ARRAYS:
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name
    assert counts_of(one) == counts_of(other)
    for x, y in ((50, 50), (70, 60), (5, 5)):
        assert [str(found) for found in one.pick(x, y)] == [str(found) for found in other.pick(x, y)]


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample scene, saved."""
    path = tmp_path_factory.mktemp("saved") / "map.decal"
    prepared(sample_scene()).save(path)
    return path


@pytest.mark.parametrize("antialias", ["coverage", "none"])
def test_what_is_opened_draws_the_same_bytes(saved: Path, antialias: str) -> None:
    renderer = opened(saved, antialias=antialias)
    first = prepared(sample_scene(), antialias=antialias)
    for camera in (OBLIQUE, MAP):
        assert_same(drawn(renderer, camera), drawn(first, camera))


IN_ANOTHER_PROCESS = """
import sys
import decalgl as dg
from small_scenes import OBLIQUE, SIZE
renderer = dg.Renderer(SIZE)
renderer.open(sys.argv[1])
renderer.update(OBLIQUE)
frame = renderer.render()
for name in ("image", "ids", "layers", "depth", "world"):
    sys.stdout.buffer.write(getattr(frame, name).tobytes())
"""


def test_what_is_opened_in_another_process_draws_the_same_bytes(saved: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    command = [sys.executable, "-c", IN_ANOTHER_PROCESS, str(saved)]
    outcome = subprocess.run(command, env=environment, capture_output=True, check=False)
    assert outcome.returncode == 0, outcome.stderr
    frame = drawn(prepared(sample_scene()))
    assert outcome.stdout == b"".join(getattr(frame, name).tobytes() for name in ARRAYS)


def test_layers_and_bounds_come_from_the_file(saved: Path) -> None:
    renderer = opened(saved)
    assert [(layer.name, layer.index, layer.kind) for layer in renderer.layers] == [
        ("fields", 0, "polygons"),
        ("ways", 1, "lines"),
    ]
    first, second = renderer.layers
    np.testing.assert_array_equal(first.rows, sample_scene().layers[0].rows)
    assert not second.rows.flags.writeable
    assert renderer.bounds == prepared(sample_scene()).bounds
    found = drawn(renderer, MAP).pick(50, 50)
    assert found[-1].layer is first
    del renderer
    np.testing.assert_array_equal(second.rows, [0, 1])


def test_stats_say_that_a_file_was_opened(saved: Path) -> None:
    stats = drawn(opened(saved)).stats
    assert set(stats.preprocess) == {"open"}
    assert stats.stages["preprocess"] >= stats.preprocess["open"] > 0.0
    assert "static: prepared" not in stats.objects


def test_saving_again_writes_the_same_bytes(saved: Path, tmp_path: Path) -> None:
    opened(saved).save(tmp_path / "again.decal")
    assert (tmp_path / "again.decal").read_bytes() == saved.read_bytes()
    prepared(sample_scene(), threads=2).save(tmp_path / "threads.decal")
    assert (tmp_path / "threads.decal").read_bytes() == saved.read_bytes()


def test_files_may_be_replaced_and_removed_while_they_are_open(saved: Path, tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    path.write_bytes(saved.read_bytes())
    first, second = opened(path), opened(path)
    before = drawn(first)
    prepared(flat_scene()).save(path)
    assert_same(drawn(second), before)
    first.open(path)
    assert first.layers == ()
    path.unlink()
    assert_same(drawn(second), before)
    assert (before.ids >= 0).any()


def test_nothing_prepared_is_nothing_to_save(tmp_path: Path) -> None:
    renderer = dg.Renderer(SIZE)
    with pytest.raises(dg.InputError, match=r"Nothing to save yet; call preprocess"):
        renderer.save(tmp_path / "map.decal")
    with pytest.raises(dg.InputError, match="preprocess"):
        renderer.bounds  # noqa: B018
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_opened_leaves_the_renderer(saved: Path, tmp_path: Path) -> None:
    renderer = prepared(sample_scene())
    before = drawn(renderer)
    with pytest.raises(dg.FileError, match="No such file"):
        renderer.open(tmp_path / "none.decal")
    assert_same(drawn(renderer), before)
    renderer.preprocess(flat_scene())
    renderer.open(saved)
    assert_same(drawn(renderer), before)
    renderer.preprocess(flat_scene())
    assert (drawn(renderer).ids == -1).all()


def test_a_memory_limit_counts_what_is_not_mapped(saved: Path) -> None:
    renderer = opened(saved, memory_limit=10_000)
    with pytest.raises(dg.MemoryLimitError, match="Raise memory_limit"):
        renderer.update(OBLIQUE)
    mapped = drawn(opened(saved)).stats.bytes["static"]
    assert mapped < drawn(prepared(sample_scene())).stats.bytes["static"]


# Paths


@pytest.mark.parametrize("method", ["save", "open"])
@pytest.mark.parametrize(
    ("path", "error", "message"),
    [
        (".", dg.FileError, "Is a directory"),
        ("no folder/map.decal", dg.FileError, "No such file"),
        ("a\0b", dg.FileError, "zero byte"),
        ("", dg.InputError, "empty"),
        (7, dg.InputError, "a str or a Path"),
        (None, dg.InputError, "a str or a Path"),
        ("\ud800", dg.InputError, "a str or a Path"),
        ("/dev/full", dg.FileError, "Cannot (read|write)"),
        ("x" * 300, dg.FileError, "File name too long"),
    ],
)
def test_paths_that_are_no_files(
    method: str, path: Any, error: type[Exception], message: str, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    renderer = prepared(flat_scene())
    with pytest.raises(error, match=message):
        getattr(renderer, method)(path)
    assert not list(tmp_path.iterdir())


def test_names_that_are_not_text(saved: Path, tmp_path: Path) -> None:
    path = Path(os.fsdecode(os.fsencode(tmp_path) + b"/m\xffp.decal"))
    with pytest.raises(dg.FileError, match="m\ufffdp"):
        opened(path)
    prepared(sample_scene()).save(path)
    assert path.read_bytes() == saved.read_bytes()
    assert opened(path).bounds


def as_another_user(action: Callable[[], None]) -> None:
    """Runs as nobody where the tests run as root, whom no rights stop."""
    if os.geteuid() != 0:
        action()
        return
    child = os.fork()
    if child == 0:
        try:
            os.setgroups([])
            os.setegid(65534)
            os.seteuid(65534)
            action()
        except BaseException as error:
            sys.stderr.write(f"{error!r}\n")
            os._exit(1)
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0


@pytest.fixture
def open_folder() -> Iterator[Path]:
    """A folder that every user may enter; pytest's own are closed."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        yield Path(name)
        Path(name).chmod(0o755)


def test_folders_and_files_without_rights(open_folder: Path) -> None:
    path = open_folder / "map.decal"
    scene = flat_scene()
    prepared(scene).save(path)

    def read_only() -> None:
        renderer = dg.Renderer(SIZE)
        renderer.preprocess(scene, cache=path)
        renderer.open(path)
        with pytest.raises(dg.FileError, match=r"Cannot write .*Permission denied.*rights"):
            renderer.save(path)
        with pytest.raises(dg.FileError, match="Permission denied"):
            renderer.preprocess(sample_scene(), cache=path)

    def unreadable() -> None:
        with pytest.raises(dg.FileError, match=r"Cannot read .*Permission denied"):
            opened(path)

    open_folder.chmod(0o555)
    as_another_user(read_only)
    path.chmod(0)
    as_another_user(unreadable)
    assert [entry.name for entry in open_folder.iterdir()] == ["map.decal"]


WITHOUT_ROOM = """
import resource, signal, sys
import decalgl as dg
renderer = dg.Renderer((10, 10))
renderer.preprocess(dg.Scene(dg.Terrain.flat((0, 0, 100, 100))))
renderer.save(sys.argv[1])
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))
try:
    renderer.save(sys.argv[1])
except dg.FileError as error:
    print(error)
"""


def test_a_disk_without_room_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "map.decal"
    command = [sys.executable, "-c", WITHOUT_ROOM, str(path)]
    outcome = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "File too large" in outcome.stdout
    assert "room on the disk" in outcome.stdout
    assert opened(path).bounds == (0, 0, 100, 100)
    assert len(list(tmp_path.iterdir())) == 1


# Caches


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


@pytest.mark.parametrize("change", CHANGES, ids=str)
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


# Damage


MESSAGES = [
    (lambda data: data[:5], "not a prepared scene; name a file that was written by save"),
    (lambda data: b"PNG" + data, "not a prepared scene"),
    (lambda data: data[:40], "is cut short; prepare the scene again"),
    (lambda data: data[: len(data) // 2], r"is cut short: it has \d+ of \d+ bytes; copy it again"),
    (lambda data: data[:8] + b"\1\2\3\4" + data[12:], "another byte order"),
    (lambda data: data[:12] + b"\7\0\0\0" + data[16:], "saved in format 7, and .* reads format"),
    (lambda data: data[:60] + b"x" + data[61:], "table of contents has changed"),
    (lambda data: data[:-1] + bytes([data[-1] ^ 1]), "section 'passes/0/slots' has changed"),
]


@pytest.mark.parametrize(("damage", "message"), MESSAGES, ids=[message for _, message in MESSAGES])
def test_messages_say_what_is_wrong(
    saved: Path, tmp_path: Path, damage: Callable[[bytes], bytes], message: str
) -> None:
    path = tmp_path / "map.decal"
    path.write_bytes(damage(saved.read_bytes()))
    with pytest.raises(dg.FileError, match=message) as caught:
        opened(path)
    assert str(path) in str(caught.value)
    assert isinstance(caught.value, OSError)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_damaged_files_are_refused_or_draw_the_same(saved: Path, tmp_path: Path, data: st.DataObject) -> None:
    whole = bytearray(saved.read_bytes())
    # Half of the places in the head, where every byte means something.
    place = st.integers(0, 1000) | st.integers(0, len(whole) - 1)
    for at in data.draw(st.lists(place, min_size=1, max_size=4)):
        whole[at] = data.draw(st.integers(0, 255))
    cut = data.draw(st.none() | place)
    path = tmp_path / "map.decal"
    path.write_bytes(whole[:cut])
    renderer = dg.Renderer(SIZE)
    try:
        renderer.open(path)
    except dg.FileError:
        return
    assert_same(drawn(renderer), drawn(prepared(sample_scene())))
