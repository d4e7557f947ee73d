"""What got slower or larger from one run to another, beyond the noise: `decalgl bench --compare A B`.

Times come with their spread, half of what lies between the quartiles. A machine that is slower today is so for the
passes that no change touches too, the floor and the radix sort: times are divided by how much longer those took, their
drift, that of the same scene or part where it has some, since hours may lie between them. How far drifts lie apart is
noise. Bytes have none, and errors next to none. What is refused, gone, or judged worse is told too.
"""

from __future__ import annotations

import json
import statistics
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rich.table import Table

from ..errors import FileError, InputError
from .measure import spread

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from .records import Record

    Results = Mapping[str, Any]
    Pair = tuple[Record, Record]

CONTROLS = ("floor_ms", "radix_sort_ms")
# From the best to the worst, as decalgl.report.stability gives them; a technique that says what is wrong is better than
# one that does not.
VERDICTS = (
    "exact",
    "within tolerance",
    "degrades gracefully",
    "warns",
    "refuses with an error",
    "fails",
)
SPREADS = 4.0  # of the noisier run, from which on a difference counts
LEAST_TIME = 0.05  # as a share: less is never a difference
UNKNOWN_SPREAD = 0.05  # of times of one round, and the least of those of two or three
FEW_RUNS = 3
LEAST_BYTES = 0.01
LEAST_ERROR, LEAST_ERROR_SHARE = 0.001, 0.02
ERRORS = ("_rms", "_p99", "_max", "leak", "rough", "far")  # ends of names
# Words of a record that were found out, and so do not tell it from others; and those that follow from others.
FOUND = ("picture", "verdict", "warning", "error", "refused")
NOT_SHOWN = (*FOUND, "source", "like", "sweep", "step")


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
class Drift:
    """How much longer the passes took that no change touches, and the spread of that."""

    share: float = 1.0
    spread: float = 0.0

    @staticmethod
    def of(shares: list[float]) -> Drift:
        """The median, and its spread where there are several."""
        return Drift(statistics.median(shares), spread(shares) if len(shares) > 1 else 0.0)


@dataclass(frozen=True)
class Comparison:
    """Of two runs: what changed beyond the noise, how many numbers both have, and the drift of their machines.

    lost: what the later run refuses, judges worse or has not, of the parts that both have.
    """

    changes: list[Change]
    compared: int
    drift: float
    notes: list[str]
    lost: list[str]

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
    drifts = _drifts(pairs)
    few = [_has_few_runs(run) for run in (before, after)]
    changes = [change for pair in pairs for change in _changes(*pair, _drift_at(drifts, pair), any(few))]
    if not changes:
        raise InputError("The two runs have no time and no size in common. Compare runs of the same suites.")
    whole = drifts.get((), Drift())
    lost = [*_worse_outcomes(pairs), *_gone(earlier, after["records"])]
    return Comparison(changes, len(changes), whole.share, list(_notes(before, after)), lost)


def _worse_outcomes(pairs: list[Pair]) -> Iterator[str]:
    for old, new in pairs:
        for word in ("refused", "error"):
            if word in new and word not in old:
                yield f"{_where(new)}: {new[word]}"
        verdicts = [VERDICTS.index(one["verdict"]) for one in (old, new) if one.get("verdict") in VERDICTS]
        if len(verdicts) == 2 and verdicts[1] > verdicts[0]:
            yield f"{_where(new)}: {old['verdict']}, then {new['verdict']}."


def _gone(earlier: Mapping[tuple[str, ...], Record], records: list[Record]) -> Iterator[str]:
    there, parts = {_key(record) for record in records}, {record.get("part") for record in records}
    for key, record in earlier.items():
        if key not in there and record.get("part") in parts:
            yield f"{_where(record)}: is no longer measured."


def _drifts(pairs: list[Pair]) -> dict[tuple[str, ...], Drift]:
    """By part and scene, by part, and that of all."""
    shares: dict[tuple[str, ...], list[float]] = {}
    for old, new in pairs:
        for name in CONTROLS:
            if _measured(old, new, name):
                for place in _places(new):
                    shares.setdefault(place, []).append(new[name] / old[name])
    return {place: Drift.of(some) for place, some in shares.items()}


def _places(record: Record) -> list[tuple[str, ...]]:
    """Those of a drift, the nearest first."""
    part = str(record.get("part", ""))
    return [(part, str(record.get("scene", ""))), (part,), ()]


def _drift_at(drifts: Mapping[tuple[str, ...], Drift], pair: Pair) -> Drift:
    return next((drifts[place] for place in _places(pair[1]) if place in drifts), Drift())


def _has_few_runs(results: Results) -> bool:
    """Whether spreads are those of so few rounds that they may be small by chance."""
    parts = results.get("parts", {}).values()
    return any(run.get("runs", FEW_RUNS + 1) <= FEW_RUNS for run in (results, *parts))


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
    return "\n".join([*lines, *found.lost, *found.notes])


def _changes(old: Record, new: Record, drift: Drift, few_runs: bool) -> Iterator[Change]:
    for name in new:
        if not _measured(old, new, name) or name in CONTROLS:
            continue
        share = new[name] / old[name]
        if name.endswith("_ms"):
            own = max(one.get(f"{name}_spread", UNKNOWN_SPREAD) for one in (old, new))
            noise = SPREADS * (max(own, UNKNOWN_SPREAD if few_runs else 0.0) + drift.spread)
            limit = 1.0 + max(LEAST_TIME, noise)
            yield Change(_where(new), name, old[name], new[name], share / drift.share, limit)
        elif name.endswith(ERRORS):
            if abs(new[name] - old[name]) >= LEAST_ERROR:
                yield Change(_where(new), name, old[name], new[name], share, 1.0 + LEAST_ERROR_SHARE)
        elif "bytes" in name:
            yield Change(_where(new), name, old[name], new[name], share, 1.0 + LEAST_BYTES)


def _where(record: Record) -> str:
    """The words that tell a record from others, as far as they are short."""
    words = [value for name, value in record.items() if isinstance(value, str) and name not in NOT_SHOWN]
    return ", ".join(word for word in words if word)


def _measured(old: Record, new: Record, name: str) -> bool:
    """Whether both have a positive number of that name."""
    return all(isinstance(one.get(name), (int, float)) and one[name] > 0 for one in (old, new))


def _key(record: Record) -> tuple[str, ...]:
    """What tells a record from the others of its run: its words, but for those that were found out."""
    words = {name: value for name, value in record.items() if isinstance(value, str) and name not in FOUND}
    return tuple(sorted(f"{name}={value}" for name, value in words.items()))


def _notes(before: Results, after: Results) -> Iterator[str]:
    for part in ("processor", "cores", "driver"):
        old, new = (run.get("machine", {}).get(part) for run in (before, after))
        if old != new:
            yield f"Note that the {part} is not the same: {old}, then {new}."
    commits = [run.get("machine", {}).get("commit") or "unknown" for run in (before, after)]
    yield f"Commits: {commits[0]}, then {commits[1]}."
