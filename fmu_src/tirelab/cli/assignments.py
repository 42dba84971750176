"""The text of an option that assigns something to names: NAME=VALUE,NAME=VALUE."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

from ..errors import TirelabError


def assignments(text: str, option: str, names: Sequence[str], example: str) -> dict[str, str]:
    """Return the assignments in `text`, such as `s=Distance,z="Height of the ground"`.

    names: those that may be assigned to
    Raises TirelabError for an unknown or repeated name, a missing = or a quote left open.
    """
    reader = shlex.shlex(text, posix=True)
    reader.whitespace, reader.whitespace_split, reader.commenters, reader.escape = ",", True, "", ""
    try:
        pieces = list(reader)
    except ValueError:
        raise TirelabError(f"{option} {text!r}: a quote is not closed; write like {example}") from None
    found: dict[str, str] = {}
    for piece in pieces:
        name, equals, value = (part.strip() for part in piece.partition("="))
        if not equals:
            raise TirelabError(f"{option}: {piece!r} has no =; write like {example}")
        if name not in names:
            raise TirelabError(f"{option}: {name!r} is not a column of a profile; name {' or '.join(names)}")
        if name in found:
            raise TirelabError(f"{option}: {name} is given twice; leave one out")
        found[name] = value
    return found
