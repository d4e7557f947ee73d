"""Who draws a map, and how well: techniques with their settings, from the quickest to the most exact.

A technique that draws no polygons leaves them to "static" with coverage, so that its lines alone tell it from that.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import decalgl as dg

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .part import Context


@dataclass(frozen=True)
class Setting:
    """One way to draw a map.

    group: the technique, as plots show it. polygons, lines: who draws them. renderer: keywords of `Renderer`.
    pixels: whether lines are as wide as on the screen. quick: whether the quick report has it.
    """

    group: str
    name: str
    antialias: str = "coverage"
    polygons: str | dg.Technique = "static"
    lines: str | dg.Technique = "static"
    renderer: dict[str, Any] = field(default_factory=dict)
    pixels: bool = False
    quick: bool = False

    @property
    def prepared(self) -> str:
        """What settings have in common that one preparing serves: all but the anti-aliasing."""
        return repr((self.polygons, self.lines, sorted(self.renderer.items(), key=str), self.pixels))

    @property
    def looks_around(self) -> bool:
        """Whether how a place is drawn depends on what the picture shows elsewhere: detail, and where edges lead."""
        return self.group in ("loops", "clipmap") or self.antialias == "fxaa"


def settings(context: Context) -> list[Setting]:
    """Those that a report of this size compares."""
    every = [*_static(), *_published(), *_dynamic(), *_loops(), *_volume(), *_clipmap(), *_fields()]
    if context.size == "tiny":
        return [one for one in every if one.quick and one.group in ("static", "clipmap", "dynamic")]
    return every if context.size == "full" else [one for one in every if one.quick]


def _static() -> Iterator[Setting]:
    yield Setting("static", "none", "none", quick=True)
    yield Setting("static", "coverage", quick=True)
    yield Setting("static", "fxaa", "fxaa")
    yield Setting("static", "msaa 4", "msaa", renderer={"samples": 4})
    for samples in (2, 4, 8, 16):
        yield Setting("static", f"ssaa {samples}", "ssaa", renderer={"samples": samples}, quick=samples == 4)


def _published() -> Iterator[Setting]:
    """The structures of Zechmeister and of Thöny."""
    yield _bvh("none", "none", quick=True)
    yield _bvh("coverage")
    for cells in (125, 250, 1000):
        yield _bvh(f"{cells}² cells", "none", cells=cells)
    for capacity in (2, 32):
        yield _bvh(f"leaves of {capacity}", "none", leaf_capacity=capacity)
    for depth in (2, 4, 16):
        yield _bvh(f"depth {depth}", "none", depth_limit=depth)
    yield Setting("static thoeny", "none", "none", renderer={"index": "thoeny"}, quick=True)
    yield Setting("static thoeny", "estimated coverage", renderer={"coverage": "thoeny"})


def _bvh(name: str, antialias: str = "coverage", quick: bool = False, **parameters: int) -> Setting:
    return Setting("static bvh", name, antialias, renderer={"index": dg.BvhIndex(**parameters)}, quick=quick)  # type: ignore[arg-type]


def _dynamic() -> Iterator[Setting]:
    for name, technique, antialias in (
        ("tiles, none", dg.Dynamic(), "none"),
        ("tiles, coverage", dg.Dynamic(), "coverage"),
        ("tiles, every vertex", dg.Dynamic(cell=0.0), "coverage"),
        ("tiles, cells of 1 px", dg.Dynamic(cell=1.0), "coverage"),
        ("lists, none", dg.Dynamic(method="lists"), "none"),
        ("lists, fxaa", dg.Dynamic(method="lists"), "fxaa"),
    ):
        quick = name in ("tiles, none", "tiles, coverage", "lists, none")
        yield Setting("dynamic", name, antialias, "auto", technique, pixels=True, quick=quick)


def _loops() -> Iterator[Setting]:
    for error in (0.25, 0.5, 1.0, 2.0, 4.0):
        technique = dg.Loops(detail=dg.Detail(screen=error))
        yield Setting("loops", f"{error:g} px", polygons=technique, lines=technique)
    full = dg.Loops(detail=dg.Detail(screen=None, uniform=0.0))
    yield Setting("loops", "all details", polygons=full, lines=full)
    for error in (0.5, 2.0):
        technique = dg.Loops(detail=dg.Detail(screen=error))
        for mode in ("none", "fxaa"):
            quick = error == 0.5 and mode == "none"
            yield Setting("loops", f"{error:g} px, {mode}", mode, technique, technique, quick=quick)


def _volume() -> Iterator[Setting]:
    volume = dg.Volume()
    yield Setting("volume", "none", "none", polygons=volume, lines=volume, quick=True)
    yield Setting("volume", "fxaa", "fxaa", polygons=volume, lines=volume)
    for samples in (2, 4):
        options = {"samples": samples}
        yield Setting("volume", f"ssaa {samples}", "ssaa", polygons=volume, lines=volume, renderer=options)


def _clipmap() -> Iterator[Setting]:
    for name, technique in (
        ("window 512", dg.Clipmap(window=512)),
        ("window 1024", dg.Clipmap(window=1024)),
        ("window 4096", dg.Clipmap(window=4096)),
        ("one sample a texel", dg.Clipmap(samples=1)),
        ("isotropic", dg.Clipmap(anisotropy=1)),
        ("solution 1", dg.Clipmap(solution="1")),
    ):
        quick = name == "window 1024"
        yield Setting("clipmap", name, "none", polygons=technique, lines=technique, quick=quick)


def _fields() -> Iterator[Setting]:
    for name, technique in (
        ("8 bits", dg.DistanceField()),
        ("32 bits", dg.DistanceField(bits=32)),
        ("32 bits, exact", dg.DistanceField(bits=32, drop_off="exact")),
    ):
        yield Setting("distance_field", name, lines=technique, quick=name == "8 bits")
