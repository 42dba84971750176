"""Where a recording comes from, as messages name it, and how its user says more about it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Origin:
    """A file that a command reads, or a data frame or arrays handed over in Python; `name` as messages show it."""

    name: str
    kind: Literal["file", "frame", "arrays"] = "file"

    def __str__(self) -> str:
        return self.name

    def columns(self, **columns: str) -> str:
        """Return what to write so that channels are read from these columns."""
        written = self._assignments("columns", columns)
        return f"Recording.from_dataframe(frame, {written})" if self.kind == "arrays" else written

    def units(self, **units: str) -> str:
        """Return what to write so that channels are read in these units."""
        return self._assignments("units", units)

    def radius(self, text: str) -> str:
        """Return what to write for a surface of this radius."""
        if self.kind == "file":
            return f"--radius {text}"
        return f'radius="{text}"' if self.kind == "frame" else f'surface_radius="{text}"'

    def sampling(self, text: str) -> str:
        """Return what to write for samples that are so far apart."""
        return f"--sampling {text}" if self.kind == "file" else f'sampling="{text}"'

    def _assignments(self, option: str, values: dict[str, str]) -> str:
        if self.kind != "file":
            return f"{option}={json.dumps(values)}"
        return f"--{option} " + ",".join(f"{name}={value}" for name, value in values.items())
