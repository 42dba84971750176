"""Where a recording comes from, as messages name it, and how its user says more about it."""

from __future__ import annotations

import json
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal


@dataclass(frozen=True)
class Origin:
    """A file that a command reads, or a data frame or arrays handed over in Python; `name` as messages show it.

    said: the words of a command line that name the file and say how it is read, but for its zeros
    kept: "columns.force", "units.force" or "skip_rows" -> the file of settings that says it, where the user does not
    """

    name: str
    kind: Literal["file", "frame", "arrays"] = "file"
    said: tuple[str, ...] = ()
    kept: Mapping[str, str] = field(default_factory=dict)

    def __str__(self) -> str:
        return self.name

    def kept_in(self, what: str, *names: str) -> str:
        """Return the file of settings that says it of one of these channels, the last one; "" where none does."""
        files = [self.kept[f"{what}.{name}"] for name in names if f"{what}.{name}" in self.kept]
        return files[-1] if files else ""

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

    def zero(self, zeros: Mapping[str, str]) -> str:
        """Return what to write so that these values are subtracted; of a file a whole command."""
        if self.kind == "frame":
            return self._assignments("zero", dict(zeros))
        if self.kind == "arrays":
            return " and ".join(f"subtract {text} from the {name}" for name, text in zeros.items())
        given = [word for name, text in zeros.items() for word in ("--zero", f"{name}={text}")]
        return f"`{shlex.join(['tirelab', 'inspect', *(self.said or (self.name,)), *given])}`"

    def _assignments(self, option: str, values: dict[str, str]) -> str:
        if self.kind != "file":
            return f"{option}={json.dumps(values)}"
        return f"--{option} " + as_word(
            ",".join(f"{name}={in_quotes(text)}" for name, text in values.items())
        )


def in_quotes(value: str) -> str:
    """Return a value as it stands in a list of assignments: between quotes where it has a comma or a quote itself."""
    if not set(value) & set(",\"'"):
        return value
    # A double quote cannot stand between double quotes: it gets single ones.
    return "'\"'".join(f'"{piece}"' if piece else "" for piece in value.split('"'))


def as_word(text: str) -> str:
    """Return a text as one word of a command line; #3 and words for something else need no quotes within a word."""
    return shlex.quote(text) if set(text) & set(" ()[]{}<>|&;$`*?!~'\"\\") else text
