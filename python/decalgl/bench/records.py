"""What was measured: a record for each scene, technique and view, which the suites fill together."""

from __future__ import annotations

from typing import Any

Record = dict[str, Any]


class Records:
    """Records in the order in which they were begun.

    scene: such as "isolines 5M".
    technique: "static"; "bvh" and "thoeny" for the papers' structures.
    view: its name, None for what does not depend on one.
    """

    def __init__(self) -> None:
        self._records: dict[tuple[str, str, str | None], Record] = {}

    def at(self, scene: str, view: str | None, technique: str = "static") -> Record:
        """The record to read and to add to, which is begun where there is none."""
        begun = {"scene": scene, "technique": technique, "view": view}
        return self._records.setdefault((scene, technique, view), begun)

    def list(self) -> list[Record]:
        """All records."""
        return list(self._records.values())
