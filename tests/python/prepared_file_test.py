"""Prepared scenes on disk: the same pictures without the scene, damaged files."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import decalgl as dg
from saved_scenes import ARRAYS, assert_same, drawn, opened, prepared, sample_scene, save_sample
from small_scenes import MAP, OBLIQUE, SIZE, flat_scene

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample scene, saved."""
    return save_sample(tmp_path_factory)


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
