"""How a user wants recordings read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .channels import parse_columns, parse_units
from .recording import Recording, read_recording


@dataclass(frozen=True)
class Reading:
    """The texts of the options --columns, --units and --radius; None where the file itself says it."""

    columns: str | None = None
    units: str | None = None
    radius: str | None = None

    def __call__(self, file: Path) -> Recording:
        """Read one recording."""
        return read_recording(
            file,
            columns=parse_columns(self.columns) if self.columns else None,
            units=parse_units(self.units) if self.units else None,
            radius=self.radius,
        )

    def words(self) -> list[str]:
        """Return the options again as words of the command line."""
        given = (("--columns", self.columns), ("--units", self.units), ("--radius", self.radius))
        return [word for option, text in given if text is not None for word in (option, text)]
