"""The text of recording.toml, as `tirelab inspect` writes it: what was understood of each file; all else stays."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.container import OutOfOrderTableProxy
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Table

from .formats import RecordingError
from .formats.table import listed, quoted

HEAD = (
    "How the recordings beside this file are read, as `tirelab inspect` understood them.",
    "Correct it where it is wrong: every command reads it, and says so.",
)


def settings_text(file: Path, understood: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the text of a file of settings with what was understood of each recording, by the name of its file.

    Where the file is there, the tables of these recordings are written anew, and all else in it stays as it is.
    Nothing is written. Errors: RecordingError where the file is no TOML, or cannot be read.
    """
    try:
        if file.exists():
            document = tomlkit.parse(file.read_text(encoding="utf-8"))
        else:
            document = tomlkit.document()
            for line in HEAD:
                document.add(tomlkit.comment(line))
        files = document.setdefault("files", tomlkit.table(is_super_table=True))
        if not isinstance(files, Table | OutOfOrderTableProxy):
            raise RecordingError(
                f'{file}: files = {files.as_string()} holds no table of a file; write [files."NAME"] in its place'
            )
        for name, settings in understood.items():
            files[name] = _table(settings)
        return tomlkit.dumps(document)
    except (TOMLKitError, UnicodeDecodeError) as error:
        raise RecordingError(
            f"{file} is not TOML ({error}); correct it, or name another with --out"
        ) from None
    except OSError as error:
        raise RecordingError(f"{file} cannot be read ({error.strerror}); name another with --out") from None


def opposite_signs(text: str) -> tuple[str, ...]:
    """Return a sentence on each column that is counted both ways in the recordings of a text of settings.

    A hold in which a gauge drifts, say, shows no sign: the one that it was read with may be the wrong one.
    """
    seen: dict[tuple[str, str], dict[str, list[str]]] = {}
    for file, settings in tomlkit.parse(text).unwrap().get("files", {}).items():
        columns = settings.get("columns", {})
        for channel, column in columns.items() if isinstance(columns, dict) else ():
            if isinstance(column, str) and column[:1] in ("+", "-"):
                seen.setdefault((channel, column[1:]), {}).setdefault(column[0], []).append(file)
    return tuple(
        f"column {quoted(name)}, {channel}: counted positive in {listed(ways['+'])}, negative in {listed(ways['-'])}; "
        "one gauge counts one way: correct the sign where the motion shows it least"
        for (channel, name), ways in seen.items()
        if len(ways) > 1
    )


def _table(settings: Mapping[str, Any]) -> Table:
    table = tomlkit.table()
    plain = {key: value for key, value in settings.items() if not isinstance(value, Mapping)}
    for key, value in plain.items():
        if isinstance(value, list):
            lines = tomlkit.array()
            lines.extend(value)
            table[key] = lines.multiline(True)
        else:
            table[key] = value
    for key, value in settings.items():
        if key not in plain:
            table[key] = {name: str(text) for name, text in value.items()}
    return table
