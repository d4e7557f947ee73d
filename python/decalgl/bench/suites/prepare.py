"""Preparing every scene: P is the time ÷ a radix sort of as many keys with payload, on the same threads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..measure import preprocessing
from ..workload import KINDS

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload


def measure(work: Workload, records: Records) -> None:
    for kind in KINDS:
        for size in work.sizes:
            work.say(f"{kind} {size}")
            times = preprocessing(work.scene(kind, size), work.runs_of(size))
            records.at(f"{kind} {size}", None).update(times)
