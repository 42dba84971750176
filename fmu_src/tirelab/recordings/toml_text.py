"""TOML as its standard has it: integers of 64 bits, and no longer ones."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

LARGEST = 2**63 - 1


def parse_toml(text: str) -> dict[str, Any]:
    """Return the content of a TOML text.

    Errors: ValueError for what is none, which names the key of an integer of more than 64 bits (tomllib reads it, and
    it may be beyond every float and too long to be printed); RecursionError for 1000 lists in one another.
    """
    # It raises ValueError too for a decimal integer of 5000 digits.
    content: dict[str, Any] = tomllib.loads(text)
    for key, value in _values(content, ""):
        if isinstance(value, int) and not -LARGEST - 1 <= value <= LARGEST:
            raise ValueError(f"{key} is an integer of more than 64 bits")
    return content


def _values(value: Any, key: str) -> Iterator[tuple[str, Any]]:
    """Yield what is no table and no list, with its key."""
    if isinstance(value, dict):
        for name, below in value.items():
            yield from _values(below, f"{key}.{name}" if key else name)
    elif isinstance(value, list):
        for below in value:
            yield from _values(below, key)
    else:
        yield key, value
