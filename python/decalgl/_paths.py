"""Paths as GDAL takes them, and files in .gz, which are unpacked while they are read.

A gzip file of some kilobytes can hold gigabytes. So before GDAL sees one, it is unpacked once without being
kept, and refused when it holds more than any map layer of its size would.
"""

from __future__ import annotations

import gzip
import os
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from .errors import FileError

if TYPE_CHECKING:
    from collections.abc import Iterator

LARGEST_UNPACKED = 4 << 30
SMALL_UNPACKED = 64 << 20
# Coordinates as text shrink by a factor of 3 to 30; nothing drawn shrinks like a run of equal bytes.
MOST_SHRINKING = 200
CHUNK_BYTES = 1 << 20
GZIP_PREFIX = "/vsigzip/"


class Readable(Protocol):
    """A stream of bytes."""

    def read(self, size: int, /) -> bytes: ...


def is_virtual(name: str) -> bool:
    """Whether GDAL resolves `name` itself (an archive member, an address, a subdataset)."""
    return name.startswith("/vsi") or "://" in name or (":" in name and not Path(name).drive)


def real_file(name: str) -> Path | None:
    """The file on disk behind `name`, which may be a .gz that GDAL unpacks; None where GDAL resolves more."""
    plain = name.removeprefix(GZIP_PREFIX)
    return None if is_virtual(plain) else Path(plain)


def is_packed(path: Path) -> bool:
    """Whether `path` names a file in gzip."""
    return path.suffix.lower() == ".gz" and path.is_file()


def gdal_name(name: str) -> str:
    """`name` as GDAL takes it: a .gz on disk is unpacked while it is read."""
    path = real_file(name)
    if path is None or not is_packed(path):
        return name
    # Or GDAL leaves a file beside the data that says how large it is unpacked.
    os.environ.setdefault("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO")
    return f"{GZIP_PREFIX}{path.resolve()}"


class Unpacked:
    """The bytes of a file, unpacked where it is a .gz; reading raises FileError past what it may hold."""

    def __init__(self, path: Path) -> None:
        self._path, self._count = path, 0
        self._limit: int | None = None
        if is_packed(path):
            self._limit = min(LARGEST_UNPACKED, max(SMALL_UNPACKED, MOST_SHRINKING * path.stat().st_size))
        self._stream = path.open("rb") if self._limit is None else gzip.GzipFile(path)

    def __enter__(self) -> Unpacked:
        return self

    def __exit__(self, *_: object) -> None:
        self._stream.close()

    @property
    def packed(self) -> bool:
        """Whether the file is a .gz."""
        return self._limit is not None

    def read(self, size: int, /) -> bytes:
        """Up to `size` bytes, fewer only at the end."""
        try:
            found = self._stream.read(size)
        except (gzip.BadGzipFile, EOFError, zlib.error) as error:
            raise FileError(
                f"{str(self._path)!r} cannot be unpacked: {error}. The file may be cut short or damaged;"
                " fetch it again."
            ) from error
        self._count += len(found)
        if self._limit is not None and self._count > self._limit:
            raise FileError(
                f"{str(self._path)!r} unpacks to more than {self._limit >> 20} MiB, so it is not opened."
                " Unpack it with gunzip first if this is meant."
            )
        return bytes(found)

    def rest(self) -> Iterator[bytes]:
        """What is left, piece by piece."""
        while piece := self.read(CHUNK_BYTES):
            yield piece
