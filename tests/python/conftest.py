"""How tests are named: the same in every process."""

from __future__ import annotations

import re


def pytest_make_parametrize_id(val: object) -> str | None:
    """A dict by its text, without the addresses of objects in it; pytest names all else."""
    return re.sub(r" at 0x[0-9a-f]+", "", str(val)) if isinstance(val, dict) else None
