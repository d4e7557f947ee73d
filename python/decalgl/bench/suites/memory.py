"""Peak memory while preparing ÷ the input, 16 bytes a vertex and offsets, each in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import TYPE_CHECKING

from ..workload import KINDS

if TYPE_CHECKING:
    from ..records import Records
    from ..workload import Workload


def measure(work: Workload, records: Records) -> None:
    for kind in KINDS:
        for size in work.sizes:
            work.say(f"{kind} {size}")
            path = work.contours_path(kind, size)
            command = [
                sys.executable,
                "-m",
                "decalgl.bench.peak_memory",
                kind,
                str(path),
                *map(str, work.ground.bounds),
            ]
            out = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
            found = json.loads(out)
            ratio = found["peak_bytes"] / found["input_bytes"]
            records.at(f"{kind} {size}", None).update(**found, peak_memory=ratio)
