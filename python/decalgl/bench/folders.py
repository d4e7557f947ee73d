"""Where data and results are kept: in a checkout beside the sources, else in the user's cache and where one stands."""

from __future__ import annotations

import os
from pathlib import Path


def checkout() -> Path | None:
    """The repository that this package is a part of, or None where it was installed from a wheel."""
    root = Path(__file__).resolve().parents[3]
    return root if (root / "bench" / "results").is_dir() else None


def data() -> Path:
    """The folder of what is fetched, and of what is derived from it."""
    root = checkout()
    if root is not None:
        return root / "build" / "data"
    cache = os.environ.get("XDG_CACHE_HOME")
    return (Path(cache) if cache else Path.home() / ".cache") / "decalgl"


def results(whole: bool) -> Path:
    """The file of a run's results. whole: all suites at all sizes, which is what the documentation tells of."""
    root = checkout()
    if root is None:
        return Path("decalgl-bench.json")
    return root / "bench" / "results" / "latest.json" if whole else root / "build" / "bench.json"
