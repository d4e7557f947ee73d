"""What got slower or larger from one run to another, beyond the noise: `decalgl bench --compare A B`.

Times come with their spread, half of what lies between the quartiles. A machine that is slower today is so for the
passes that no change touches too, the floor and the radix sort: times are divided by how much longer those took, their
drift. Bytes have no noise.
"""

from __future__ import annotations

import json
import statistics
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rich.table import Table

from ..errors import FileError, InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from .records import Record

    Results = Mapping[str, Any]

CONTROLS = ("floor_ms", "radix_sort_ms")
SPREADS = 4.0  # of the noisier run, from which on a difference counts
LEAST_TIME = 0.05  # as a share: less is never a difference
UNKNOWN_SPREAD = 0.05  # of times of one round
LEAST_BYTES = 0.01


@dataclass(frozen=True)
class Change:
    """A number of a record before and after, and the factor that counts as noise. share: after ÷ before."""

    where: str
    name: str
    before: float
    after: float
    share: float
    noise: float

    @property
    def worse(self) -> bool:
        """Whether it grew beyond the noise."""
        return self.share > self.noise

    @property
    def better(self) -> bool:
        """Whether it shrank beyond the noise."""
        return self.share < 1.0 / self.noise


@dataclass(frozen=True)
class Comparison:
    """Of two runs: what changed beyond the noise, how many numbers both have, and the drift of their machines."""

    changes: list[Change]
    compared: int
    drift: float
    notes: list[str]

    @property
    def worse(self) -> list[Change]:
        """What grew, the most first."""
        return sorted((one for one in self.changes if one.worse), key=lambda one: -one.share)

    @property
    def better(self) -> list[Change]:
        """What shrank, the most first."""
        return sorted((one for one in self.changes if one.better), key=lambda one: one.share)


def read(path: Path) -> Results:
    """A file of results, of `decalgl bench` or `decalgl report`. Raises FileError and InputError."""
    try:
        results = json.loads(path.read_text())
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror}.") from error
    except ValueError as error:
        raise InputError(f"{path} is not JSON: {error}.") from error
    if not isinstance(results, dict) or not isinstance(results.get("records"), list):
        raise InputError(f"{path} holds no records. Name a file that decalgl bench or decalgl report wrote.")
    return results


def compare(before: Results, after: Results) -> Comparison:
    """The numbers that both runs have, beside each other. Raises InputError where there are none."""
    earlier = {_key(record): record for record in before["records"]}
    pairs = [(earlier[key], record) for record in after["records"] if (key := _key(record)) in earlier]
    shares = [new[name] / old[name] for old, new in pairs for name in CONTROLS if _measured(old, new, name)]
    drift = statistics.median(shares) if shares else 1.0
    changes = [change for old, new in pairs for change in _changes(old, new, drift)]
    if not changes:
        raise InputError("The two runs have no time and no size in common. Compare runs of the same suites.")
    return Comparison(changes, len(changes), drift, list(_notes(before, after)))


def table(found: Comparison) -> Table:
    """What changed, worse first."""
    result = Table("where", "what", "before", "after", "× after drift", "noise up to")
    for color, changes in (("red", found.worse), ("green", found.better)):
        for one in changes:
            cells = (f"{one.before:,.4g}", f"{one.after:,.4g}", f"[{color}]{one.share:.2f}[/]")
            result.add_row(one.where, one.name, *cells, f"{one.noise:.2f}")
    return result


def summary(found: Comparison) -> str:
    """The outcome in words."""
    lines = [
        f"{len(found.worse)} worse, {len(found.better)} better, of {found.compared} times and sizes.",
        f"The machine took {found.drift:.2f} times as long for what no change touches.",
    ]
    return "\n".join([*lines, *found.notes])


def _changes(old: Record, new: Record, drift: float) -> Iterator[Change]:
    for name in new:
        if not _measured(old, new, name) or name in CONTROLS:
            continue
        where = ", ".join(str(new[part]) for part in ("scene", "technique", "view") if new.get(part))
        share = new[name] / old[name]
        if name.endswith("_ms"):
            spread = max(one.get(f"{name}_spread", UNKNOWN_SPREAD) for one in (old, new))
            yield Change(
                where, name, old[name], new[name], share / drift, 1.0 + max(LEAST_TIME, SPREADS * spread)
            )
        elif "bytes" in name:
            yield Change(where, name, old[name], new[name], share, 1.0 + LEAST_BYTES)


def _measured(old: Record, new: Record, name: str) -> bool:
    """Whether both have a positive number of that name."""
    return all(isinstance(one.get(name), (int, float)) and one[name] > 0 for one in (old, new))


def _key(record: Record) -> tuple[str, ...]:
    """What tells a record from the others of its run: its words."""
    return tuple(sorted(f"{name}={value}" for name, value in record.items() if isinstance(value, str)))


def _notes(before: Results, after: Results) -> Iterator[str]:
    for part in ("processor", "cores", "driver"):
        old, new = (run.get("machine", {}).get(part) for run in (before, after))
        if old != new:
            yield f"Note that the {part} is not the same: {old}, then {new}."
    commits = [run.get("machine", {}).get("commit") or "unknown" for run in (before, after)]
    yield f"Commits: {commits[0]}, then {commits[1]}."
