"""Pairwise covering arrays: few rows in which every two levels of any two factors meet.

Built row by row, greedily, after Cohen et al. 1997, "The AETG system": of some rows that begin with a pair that has
not been met yet, the one that meets most of them is kept.
"""

from __future__ import annotations

from itertools import combinations, product
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence, Set

    Choice = tuple[str, str]
    Pair = frozenset[Choice]
    Row = dict[str, str]

CANDIDATES = 40


def pair(first: str, first_level: str, second: str, second_level: str) -> Pair:
    """Two levels of two factors."""
    return frozenset(((first, first_level), (second, second_level)))


def pairs_of(factors: Mapping[str, Sequence[str]], excluded: Set[Pair] = frozenset()) -> set[Pair]:
    """All pairs of levels that may meet."""
    return {
        pair(one, a, other, b)
        for one, other in combinations(factors, 2)
        for a, b in product(factors[one], factors[other])
    } - excluded


def pairs_in(row: Row) -> set[Pair]:
    """The pairs that a row has."""
    return {frozenset(two) for two in combinations(row.items(), 2)}


def covering_array(
    factors: Mapping[str, Sequence[str]], excluded: Set[Pair] = frozenset(), seed: int = 1
) -> list[Row]:
    """Rows, a level of each factor, that have all pairs but the excluded ones, and none of those.

    The same rows for the same seed. Raises ValueError where no row can have some pair.
    """
    generator = np.random.default_rng(seed)
    left = pairs_of(factors, excluded)
    rows: list[Row] = []
    while left:
        begin = min(left, key=sorted)
        found = [_filled(factors, excluded, left, begin, generator) for _ in range(CANDIDATES)]
        whole = [row for row in found if row is not None]
        if not whole:
            raise ValueError(f"No row can have {sorted(begin)} without an excluded pair.")
        best = max(whole, key=lambda row: len(pairs_in(row) & left))
        rows.append({name: best[name] for name in factors})
        left -= pairs_in(best)
    return rows


def _filled(
    factors: Mapping[str, Sequence[str]],
    excluded: Set[Pair],
    left: Set[Pair],
    begin: Pair,
    generator: np.random.Generator,
) -> Row | None:
    """A row with a pair, and of the other factors, in any order, the level that meets most; None at a dead end."""
    row = dict(begin)
    names = [name for name in factors if name not in row]
    for name in generator.permutation(np.array(names)).tolist():
        levels = generator.permutation(np.array(factors[name])).tolist()
        new = {level: {pair(name, level, *chosen) for chosen in row.items()} for level in levels}
        allowed = [level for level in levels if not new[level] & excluded]
        if not allowed:
            return None
        row[name] = max(allowed, key=lambda level: len(new[level] & left))
    return row
