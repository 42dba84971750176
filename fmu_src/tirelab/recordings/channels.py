"""The channels of a recording, and which column of a file is which."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .assignments import assignments
from .formats import Header, RecordingError
from .formats.table import listed, quoted
from .origin import Origin
from .units import measures


@dataclass(frozen=True)
class Channel:
    """One channel: our name for it, its SI unit, and the names and symbols the field gives it."""

    name: str
    unit: str
    words: frozenset[str]
    symbol: str
    required: bool = True


def _channel(name: str, unit: str, words: str, symbol: str, required: bool = True) -> Channel:
    return Channel(name, unit, frozenset([name, *words.split(", ")]), symbol, required)


CHANNELS = (
    _channel("time", "s", "elapsed time, test time, time stamp, timestamp", "t"),
    _channel(
        "deflection",
        "m",
        "tire deflection, tyre deflection, radial deflection, displacement, stroke, compression, travel, "
        "lvdt",
        "x",
    ),
    _channel(
        "radius",
        "m",
        "surface radius, radius of curvature, curvature radius, bump radius, obstacle radius, rb",
        "R",
        required=False,
    ),
    _channel(
        "force",
        "N",
        "radial force, vertical force, normal force, compressive force, load, radial load, vertical load, "
        "load cell, loadcell",
        "F",
    ),
    _channel(
        "pressure",
        "Pa",
        "inflation pressure, gauge pressure, absolute pressure, tire pressure, tyre pressure",
        "p",
        required=False,
    ),
    _channel("temperature", "K", "temp, tire temperature, tyre temperature", "T", required=False),
    _channel("speed", "m/s", "forward speed, riding speed, travel speed, vehicle speed", "v", required=False),
)
"""The channels in the order of the house form of a recording."""

UNIT_OF = {channel.name: channel.unit for channel in CHANNELS}
"""The SI unit of each channel."""

# "force_min" is a minimum and "stroke_in" an input as often as they are minutes and inches.
_NO_SUFFIX_UNITS = frozenset({"in", "min", "max"})


@dataclass(frozen=True)
class Match:
    """The column that holds a channel; sign 1 or -1 where the user says so, 0 where it is still open."""

    index: int
    sign: int = 0


def parse_columns(text: str) -> dict[str, str]:
    """The assignments in the text of an option: `deflection=Stroke,force="Load cell"`.

    Errors: RecordingError for an unknown or repeated channel, a missing = or a quote left open.
    """
    return assignments(text, "--columns", 'deflection=Stroke,force="Load cell"', known_channel)


def parse_units(text: str) -> dict[str, str]:
    """The assignments in the text of an option: `time=ms,deflection=mm,force=kN`.

    Errors: RecordingError for an unknown or repeated channel, a missing = or a quote left open.
    """
    return assignments(text, "--units", "time=ms,deflection=mm,force=kN", known_channel)


def assignments_text(values: Mapping[str, str]) -> str:
    """The text of an option that `parse_columns` and `parse_units` read as these values, quoted where needed."""
    return ",".join(f"{name}={_in_quotes(value)}" for name, value in values.items())


def _in_quotes(value: str) -> str:
    if not set(value) & set(",\"'"):
        return value
    # A double quote cannot stand between double quotes: it gets single ones.
    return "'\"'".join(f'"{piece}"' if piece else "" for piece in value.split('"'))


def known_channel(name: str, where: str) -> None:
    """Refuse a name that is none of the channels'."""
    if name not in UNIT_OF:
        raise RecordingError(f"{where}: {quoted(name)} is no channel; the channels are {', '.join(UNIT_OF)}")


def match_channels(
    origin: Origin, headers: Sequence[Header], time_axis: int | None, columns: Mapping[str, str]
) -> dict[str, Match]:
    """Which column holds which channel.

    A column the user names is found by its text, by its name without the unit (both whatever the case), or by
    its number (#1 the first); `+` or `-` before it fixes its sign; an empty name leaves the channel out.
    Others are found by the words and symbols of `CHANNELS`, symbols in their own case unless a fitting unit
    follows.

    Errors: RecordingError when a column named is not there, a required channel has none, or several may be.
    """
    for name in columns:
        known_channel(name, f"{origin}, columns")
    matches: dict[str, Match] = {}
    for name, text in columns.items():
        if text.strip():
            matches[name] = _named(origin, headers, name, text.strip())
    assigned = {match.index: name for name, match in matches.items()}
    if len(assigned) < len(matches):
        raise RecordingError(f"{origin}: one column is given for two channels; name another for one of them")
    for channel in CHANNELS:
        if channel.name in columns:
            continue
        if channel.name == "time" and time_axis is not None:
            matches["time"] = Match(time_axis)
            continue
        found = [i for i, header in enumerate(headers) if i not in assigned and _may_be(header, channel)]
        if len(found) > 1:
            candidates = " and ".join(f"{quoted(headers[i].text)} (#{i + 1})" for i in found)
            which = origin.columns(**{channel.name: f"#{found[0] + 1}"})
            without = (
                "" if channel.required else f", or leave it out with {origin.columns(**{channel.name: ''})}"
            )
            raise RecordingError(
                f"{origin}: {candidates} may each be the {channel.name}; say which with {which}{without}"
            )
        if found:
            matches[channel.name] = Match(found[0])
    missing = [c.name for c in CHANNELS if c.required and c.name not in matches]
    if missing:
        raise _missing(origin, headers, missing)
    return matches


def recognised(headers: Sequence[Header], columns: Mapping[str, str]) -> frozenset[str]:
    """The channels that have a column by its name: one that the user names, or one of the words and symbols."""
    found = {channel.name for channel in CHANNELS if any(_may_be(header, channel) for header in headers)}
    for name, text in columns.items():
        column = text.strip()
        if not column.lstrip("+- ").startswith("#") and (
            _finds(headers, column) or _finds(headers, column.lstrip("+-").strip())
        ):
            found.add(name)
    return frozenset(found)


def unit_of_column(header: Header, channel: str) -> str | None:
    """The unit a column states, in brackets, in its properties, or at the end of its name: force_N."""
    if header.unit:
        return header.unit
    _, mark, tail = header.name.rpartition("_")
    fits = mark and tail not in _NO_SUFFIX_UNITS and measures(tail, UNIT_OF[channel])
    return tail if fits else None


def says_absolute(header: Header) -> bool:
    """Whether the name of a pressure column says that it is absolute."""
    return bool({"abs", "absolute"} & set(_words(header.name).split()))


def _named(origin: Origin, headers: Sequence[Header], channel: str, text: str) -> Match:
    exact = _finds(headers, text)
    if exact:
        sign = 0
    elif text[0] in "+-":
        exact, sign = _finds(headers, text[1:].strip()), 1 if text[0] == "+" else -1
    if not exact:
        raise RecordingError(
            f"{origin}: has no column {quoted(text)}; its columns are {_all(headers)}; "
            f"correct {origin.columns(**{channel: 'NAME'})}"
        )
    if len(exact) > 1:
        numbers = " and ".join(f"#{i + 1}" for i in exact)
        raise RecordingError(
            f"{origin}: columns {numbers} are both named {quoted(text)}; "
            f"say which by its number: {origin.columns(**{channel: f'#{exact[0] + 1}'})}"
        )
    return Match(exact[0], sign)


def _finds(headers: Sequence[Header], text: str) -> list[int]:
    if text.startswith("#") and text[1:].isdecimal() and text.isascii():
        number = int(text[1:7])
        return [number - 1] if 1 <= number <= len(headers) else []
    for same in (
        [i for i, h in enumerate(headers) if text == h.text],
        [i for i, h in enumerate(headers) if text == h.name],
        [i for i, h in enumerate(headers) if text.casefold() in (h.text.casefold(), h.name.casefold())],
    ):
        if same:
            return same
    return []


def _may_be(header: Header, channel: Channel) -> bool:
    name = header.name
    if len(name) == 1:
        if header.unit:
            return name.lower() == channel.symbol.lower() and measures(header.unit, channel.unit)
        return name == channel.symbol
    if _words(name) in channel.words:
        return True
    base, _, _ = name.rpartition("_")
    return _words(base) in channel.words and unit_of_column(header, channel.name) is not None


def _words(name: str) -> str:
    return " ".join(name.lower().replace("_", " ").replace("-", " ").split())


def _all(headers: Sequence[Header]) -> str:
    return listed([quoted(header.text) for header in headers], most=20) or "none"


def _missing(origin: Origin, headers: Sequence[Header], missing: Sequence[str]) -> RecordingError:
    if headers and all(header.text == f"#{i + 1}" for i, header in enumerate(headers)):
        return RecordingError(
            f"{origin}: has no header row; put one above the numbers, such as time [s],deflection [mm],"
            f"force [N], or name columns by number: {origin.columns(time='#1', deflection='#2', force='#3')} "
            f"{origin.units(time='s', deflection='mm', force='N')}"
        )
    return RecordingError(
        f"{origin}: no column for {', '.join(missing)}; its columns are {_all(headers)}; "
        f"name it with {origin.columns(**dict.fromkeys(missing, 'NAME'))}"
    )
