"""The text of an option that assigns something to names: NAME=VALUE,NAME=VALUE."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable

from .formats import RecordingError
from .formats.table import quoted

_APOSTROPHE = re.compile(r"(?<=\w)'(?=\w)")
_KEPT = "\0"


def assignments(text: str, option: str, example: str, check: Callable[[str, str], None]) -> dict[str, str]:
    """Return the assignments in `text`, such as `deflection=Stroke,force="Load cell"`, with names in small letters.

    option, example: what the messages call the option, and how it is written; check: raises for a name that is not
    allowed, and is called with the name and the option. An apostrophe within a word, Temps d'essai, is no quote.
    Raises RecordingError for a repeated name, a missing = or a quote left open.
    """
    reader = shlex.shlex(_APOSTROPHE.sub(_KEPT, text), posix=True)
    reader.whitespace, reader.whitespace_split, reader.commenters, reader.escape = ",", True, "", ""
    found: dict[str, str] = {}
    try:
        pieces = list(reader)
    except ValueError:
        raise RecordingError(
            f"{option} {quoted(text)}: a quote is not closed; write like {example}"
        ) from None
    for piece in (piece.replace(_KEPT, "'") for piece in pieces):
        name, equals, value = piece.partition("=")
        name = name.strip().lower()
        if not equals:
            raise RecordingError(f"{option}: {quoted(piece)} has no =; write like {example}")
        check(name, option)
        if name in found:
            raise RecordingError(f"{option}: {name} is given twice; leave one out")
        found[name] = value.strip()
    return found
