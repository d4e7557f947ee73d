"""Strict reading of TOML tables: keys are asked for by name and type; one that nobody asked for is an error.

table = StrictTable({"path": "a.tif", "exageration": 2}, "[terrain]", "scene.toml")
table.text("path")
table.number("exaggeration", 1.0)
table.finish()      InputError: scene.toml, [terrain]: unknown key 'exageration'. Did you mean 'exaggeration'?
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from .errors import InputError, close_matches


class StrictTable:
    """One table of a TOML file. Messages name the file, the table and the key."""

    def __init__(self, values: Any, name: str, file: str) -> None:
        self.name = name
        self.file = file
        if not isinstance(values, Mapping):
            raise InputError(f"{file}, {name}: must be a table, but it is {values!r}.")
        self._values = dict(values)
        self._known: list[str] = []

    def error(self, message: str) -> InputError:
        """An error that begins with the file and the table."""
        return InputError(f"{self.file}, {self.name}: {message}")

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def value(self, key: str) -> Any:
        """The value as it is, None when the key is missing."""
        self._known.append(key)
        return self._values.get(key)

    def required(self, key: str, value: Any) -> Any:
        """`value`, or an error that the key is missing."""
        if value is None:
            given = close_matches(key, self._values)
            raise self.error(f"the key {key!r} is missing.{given}")
        return value

    def text(self, key: str) -> str | None:
        """A string."""
        value = self.value(key)
        if value is not None and not isinstance(value, str):
            raise self.error(f"{key} must be text in quotes, but it is {value!r}.")
        return value

    def choice(self, key: str, choices: tuple[str, ...]) -> str | None:
        """A string out of a few."""
        value = self.text(key)
        if value is not None and value not in choices:
            listed = ", ".join(repr(choice) for choice in choices)
            raise self.error(
                f"{key} must be one of {listed}, but it is {value!r}.{close_matches(value, choices)}"
            )
        return value

    def number(self, key: str) -> float | None:
        """A finite number."""
        value = self.value(key)
        return None if value is None else self._finite(key, value)

    def integer(self, key: str) -> int | None:
        """A whole number."""
        value = self.value(key)
        if value is not None and (isinstance(value, bool) or not isinstance(value, int)):
            raise self.error(f"{key} must be a whole number, but it is {value!r}.")
        return value

    def flag(self, key: str) -> bool | None:
        """true or false."""
        value = self.value(key)
        if value is not None and not isinstance(value, bool):
            raise self.error(f"{key} must be true or false, but it is {value!r}.")
        return value

    def numbers(self, key: str, count: int) -> tuple[float, ...] | None:
        """An array of `count` finite numbers."""
        value = self.value(key)
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != count:
            raise self.error(f"{key} must be an array of {count} numbers, but it is {value!r}.")
        return tuple(self._finite(key, one) for one in value)

    def table(self, key: str, name: str | None = None) -> StrictTable | None:
        """A table inside this one."""
        value = self.value(key)
        return None if value is None else StrictTable(value, name or f"[{key}]", self.file)

    def inner(self, values: Any, name: str) -> StrictTable:
        """A table that lies deeper in this file."""
        return StrictTable(values, name, self.file)

    def names(self) -> list[str]:
        """All keys there are."""
        return list(self._values)

    def finish(self) -> None:
        """Raises InputError for keys that were not asked for."""
        for key in self._values:
            if key not in self._known:
                hint = (
                    close_matches(key, self._known) or f" Known are: {', '.join(dict.fromkeys(self._known))}."
                )
                raise self.error(f"unknown key {key!r}.{hint}")

    def _finite(self, key: str, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise self.error(f"{key} must be a finite number, but it holds {value!r}.")
        return float(value)
