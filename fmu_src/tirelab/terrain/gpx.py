"""The track points of a GPX file, read as what it is: XML from a stranger.

Expat reads it as a stream, without a tree. A document type declaration is refused outright: GPX has none, and without
one there are no entities to expand and no files or addresses to fetch.

Format: GPX 1.0 and 1.1, https://www.topografix.com/GPX/1/1/ : <trkpt lat="" lon=""><ele>metres</ele></trkpt>.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from xml.parsers import expat

import numpy as np

from ..errors import TirelabError
from .profile import Floats


@dataclass
class _Track:
    """What the parser has read so far."""

    path: str
    parser: expat.XMLParserType
    points: list[tuple[float, float, float]] = field(default_factory=list)
    segments: int = 0
    place: tuple[float, float] | None = None
    elevation: float | None = None
    text: list[str] | None = None

    def fail(self, sentence: str) -> TirelabError:
        return TirelabError(f"{self.path}, line {self.parser.CurrentLineNumber}: {sentence}")

    def refuse_doctype(self, *_: object) -> None:
        raise self.fail("a document type declaration is not allowed in GPX; remove it")

    def start(self, name: str, attributes: dict[str, str]) -> None:
        tag = name.rpartition(" ")[2]
        if tag == "trkpt":
            if self.points and self.segments > 1:
                raise self.fail(
                    "a second track segment begins; keep one, for the ground between two is not known"
                )
            self.place = (self.angle(attributes, "lat", 90.0), self.angle(attributes, "lon", 180.0))
            self.elevation = None
        elif tag == "trkseg":
            self.segments += 1
        elif tag == "ele" and self.place is not None:
            self.text = []

    def characters(self, data: str) -> None:
        if self.text is not None:
            self.text.append(data)

    def end(self, name: str) -> None:
        tag = name.rpartition(" ")[2]
        if tag == "ele" and self.text is not None:
            self.elevation = self.number("".join(self.text), "elevation")
            self.text = None
        elif tag == "trkpt" and self.place is not None:
            if self.elevation is None:
                raise self.fail(
                    f"track point {len(self.points) + 1} has no elevation; add one to every point"
                )
            self.points.append((*self.place, self.elevation))
            self.place = None

    def angle(self, attributes: dict[str, str], key: str, limit: float) -> float:
        value = self.number(attributes.get(key, ""), key)
        if abs(value) > limit:
            raise self.fail(f"{key} = {value:g} is not within {limit:g} degrees; check the coordinates")
        return value

    def number(self, text: str, what: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.fail(
                f"track point {len(self.points) + 1}: {what} '{text.strip()[:40]}' is not a number; correct it"
            )
        return value


def track_points(data: bytes, path: str) -> Floats:
    """Return latitude [degree], longitude [degree] and elevation [m] of the track in `data`; shape (n, 3).

    Raises TirelabError, with the line, for XML that is not well-formed or has a document type, for points without a
    number for each of the three, for several track segments, and for files without a track.
    """
    parser = expat.ParserCreate(namespace_separator=" ")
    track = _Track(path, parser)
    parser.StartDoctypeDeclHandler = track.refuse_doctype
    parser.StartElementHandler = track.start
    parser.EndElementHandler = track.end
    parser.CharacterDataHandler = track.characters
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise TirelabError(
            f"{path}, line {error.lineno}: not well-formed XML ({expat.ErrorString(error.code)}); export it again"
        ) from None
    if not track.points:
        raise TirelabError(f"{path}: no track points; export a track, not a route or waypoints")
    return np.array(track.points)
