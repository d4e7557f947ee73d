"""What can draw on this machine."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core


@dataclass(frozen=True)
class Diagnosis:
    """One way to open OpenGL, tried.

    name: "EGL surfaceless Mesa", "EGL device 0", "OSMesa".
    ok: whether it can draw.
    detail: its driver, or why it failed.
    cure: what to install or set where it failed.
    """

    name: str
    ok: bool
    detail: str
    cure: str


def doctor() -> list[Diagnosis]:
    """Tries every way to open OpenGL and says what came of it; raises nothing."""
    return [Diagnosis(p["name"], p["ok"], p["detail"], p["cure"]) for p in _core.probe_backends()]
