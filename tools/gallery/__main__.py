"""Draws all pictures, or those that are named: python -m tools.gallery [corners ...] [--out FOLDER]."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from . import changes, lines, maps, networks, polygons

if TYPE_CHECKING:
    from collections.abc import Callable

    from PIL.Image import Image

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "images" / "gallery"
PICTURES: dict[str, Callable[[], Image]] = {
    **lines.PICTURES,
    **polygons.PICTURES,
    **maps.PICTURES,
    **changes.PICTURES,
    **networks.PICTURES,
}


def draw(name: str, folder: Path) -> Path:
    """Draws one picture; its name ends in its format."""
    path = folder / name
    options = {"quality": 82} if path.suffix == ".jpg" else {}
    PICTURES[name]().save(path, optimize=True, **options)
    return path


def main() -> None:
    stems = {Path(name).stem: name for name in PICTURES}
    parser = argparse.ArgumentParser(prog="tools.gallery", description="Draw the pictures of the gallery.")
    parser.add_argument("names", nargs="*", metavar="name", help=f"by default all of {', '.join(stems)}")
    parser.add_argument("--out", type=Path, default=FOLDER)
    arguments = parser.parse_args()
    if unknown := [name for name in arguments.names if name not in stems]:
        parser.error(f"there is no picture {unknown[0]!r}; choose among {', '.join(stems)}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name in arguments.names or stems:
        path = draw(stems[name], arguments.out)
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
