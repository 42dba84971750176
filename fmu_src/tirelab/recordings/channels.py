"""The channels of a recording, and which column of a file is which."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .assignments import assignments
from .formats import Header, RecordingError
from .formats.table import listed, quoted
from .origin import Origin
from .units import measures
from .vocabulary import foreign_channel, is_measured, name_and_unit, without_count


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
    # a force that a simulation gave: read only where the user names its column
    Channel("believed_force", "N", frozenset(), "", required=False),
)
"""The channels in the order of the house form of a recording."""

UNIT_OF = {channel.name: channel.unit for channel in CHANNELS}
"""The SI unit of each channel."""

_GERMAN_SYMBOL = {"deflection": "s"}
"""Symbols of channels in German exports, taken where a fitting unit follows: s [mm]."""

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


@dataclass(frozen=True)
class Matches:
    """Which column holds which channel, the required channels that none holds, and how many trials the table has.

    trials: 1, or the number of tests that stand side by side, of which the columns of one are taken
    """

    columns: Mapping[str, Match]
    missing: tuple[str, ...]
    trials: int = 1


def match_channels(
    origin: Origin,
    headers: Sequence[Header],
    time_axis: int | None,
    columns: Mapping[str, str],
    trial: int | None = None,
) -> Matches:
    """Which column holds which channel.

    A column the user names is found by its text, by its name without the unit (both whatever the case), or by
    its number (#1 the first); `+` or `-` before it fixes its sign; an empty name leaves the channel out.
    Others are found by the words and symbols of `CHANNELS`, symbols in their own case unless a fitting unit
    follows; where there is none, by the words of other languages, and then by names that end in a number.
    trial: which one, from 1, where several tests stand side by side

    Errors: RecordingError when a column named is not there, or several may be the one of a channel.
    """
    matches = _named_columns(origin, headers, columns)
    assigned = {match.index for match in matches.values()}
    found: dict[str, list[int]] = {}
    for channel in CHANNELS:
        if channel.name in columns:
            continue
        if channel.name == "time" and time_axis is not None:
            matches["time"] = Match(time_axis)
            continue
        found[channel.name] = _found(headers, channel, assigned)
    trials = _trials(found, columns)
    if trials > 1:
        found = _of_trial(origin, found, trials, trial)
    elif trial is not None and trial > 1 and not {"deflection", "force"} <= columns.keys():
        raise RecordingError(f"{origin}: has no trials side by side; leave out @trial{trial}")
    for channel in CHANNELS:
        indices = found.get(channel.name, [])
        if len(indices) > 1:
            raise _several(origin, headers, channel, indices)
        if indices:
            matches[channel.name] = Match(indices[0])
    ordered = {c.name: matches[c.name] for c in CHANNELS if c.name in matches}
    given = {name: matches[name] for name in columns if name in matches}
    missing = tuple(
        c.name
        for c in CHANNELS
        if c.required and c.name not in matches and (c.name != "time" or c.name not in columns)
    )
    return Matches({**given, **ordered}, missing, trials)


def _named_columns(origin: Origin, headers: Sequence[Header], columns: Mapping[str, str]) -> dict[str, Match]:
    """Return the columns that the user names."""
    for name in columns:
        known_channel(name, f"{origin}, columns")
    matches: dict[str, Match] = {}
    for name, text in columns.items():
        if text.strip():
            matches[name] = _named(origin, headers, name, text.strip())
    if len({match.index for match in matches.values()}) < len(matches):
        raise RecordingError(f"{origin}: one column is given for two channels; name another for one of them")
    return matches


def _found(headers: Sequence[Header], channel: Channel, assigned: set[int]) -> list[int]:
    """Return the columns that may hold a channel: by our words, else by foreign ones, else but for a number."""
    free = [(i, header) for i, header in enumerate(headers) if i not in assigned]
    found = [i for i, header in free if _may_be(header, channel)]
    if not found and channel.name == "time":
        dated = [i for i, header in free if header.dated]
        found = dated if len(dated) == 1 else []
    if found:
        return _in_fitting_units(headers, channel, found)
    sourceless = [(i, _without_source(header)) for i, header in free]
    for may_be, columns in (
        (_may_be_foreign, free),
        (_may_be_counted, free),
        (_may_be, sourceless),
        (_may_be_foreign, sourceless),
        (_may_be_qualified, free),
    ):
        found = [i for i, header in columns if may_be(header, channel)]
        if found:
            break
    return _in_fitting_units(headers, channel, found) if channel.required or len(found) == 1 else []


def _in_fitting_units(headers: Sequence[Header], channel: Channel, found: list[int]) -> list[int]:
    """Return the columns without those in a unit of something else, such as the volts of the same sensor."""
    units = {i: unit_of_column(headers[i], channel.name) for i in found}
    fitting = [i for i, unit in units.items() if unit and measures(unit, channel.unit)]
    return [i for i in found if i in fitting or not units[i]] if fitting else found


def _trials(found: Mapping[str, Sequence[int]], columns: Mapping[str, str]) -> int:
    """Return how many tests stand side by side: as many deflections as forces, in turn, and one time or as many."""
    deflections, forces = found.get("deflection", ()), found.get("force", ())
    count = len(forces)
    if count < 2 or len(deflections) != count or len(found.get("time", ())) not in (0, 1, count):
        return 1
    starts = [min(pair) for pair in zip(deflections, forces, strict=True)]
    ends = [max(pair) for pair in zip(deflections, forces, strict=True)]
    apart = all(end < start for end, start in zip(ends, starts[1:], strict=False))
    return count if apart else 1


def _of_trial(
    origin: Origin, found: Mapping[str, list[int]], trials: int, trial: int | None
) -> dict[str, list[int]]:
    """Return the columns of one of the tests side by side; a column that all share stays."""
    if trial is None:
        raise SeveralTrials(origin, trials)
    if not 1 <= trial <= trials:
        raise RecordingError(f"{origin}: has {trials} trials side by side; name @trial1 to @trial{trials}")
    return {
        name: [columns[trial - 1]] if len(columns) == trials else columns if len(columns) == 1 else []
        for name, columns in found.items()
    }


class SeveralTrials(RecordingError):
    """Several tests stand side by side in a table, and none is named."""

    def __init__(self, origin: Origin, trials: int) -> None:
        how = (
            f"{origin}@trial1 to {origin}@trial{trials}"
            if origin.kind == "file"
            else 'columns={"force": "#3", ...}'
        )
        super().__init__(f"{origin}: holds {trials} trials side by side; name one: {how}")
        self.trials = trials


def _several(
    origin: Origin, headers: Sequence[Header], channel: Channel, found: Sequence[int]
) -> RecordingError:
    candidates = " and ".join(f"{quoted(headers[i].text)} (#{i + 1})" for i in found)
    which = origin.columns(**{channel.name: f"#{found[0] + 1}"})
    without = "" if channel.required else f", or leave it out with {origin.columns(**{channel.name: ''})}"
    return RecordingError(
        f"{origin}: {candidates} may each be the {channel.name}; say which with {which}{without}"
    )


def recognised(headers: Sequence[Header], columns: Mapping[str, str]) -> frozenset[str]:
    """The channels that have a column by its name: one that the user names, or one of the words and symbols."""
    found = {channel.name for channel in CHANNELS if _found(headers, channel, set())}
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
    if mark and tail not in _NO_SUFFIX_UNITS and measures(tail, UNIT_OF[channel]):
        return tail
    parts = name_and_unit(header.name)
    fits = parts is not None and parts[1] not in _NO_SUFFIX_UNITS and measures(parts[1], UNIT_OF[channel])
    return parts[1] if parts is not None and fits else None


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
            f"{origin}: has no column {quoted(text)}; its columns are {columns_listed(headers)}; "
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
    if not channel.words:
        return False
    if len(name) == 1:
        if header.unit:
            symbols = (channel.symbol.lower(), _GERMAN_SYMBOL.get(channel.name, ""))
            return name.lower() in symbols and measures(header.unit, channel.unit)
        return name == channel.symbol
    if _words(name) in channel.words:
        return True
    base, _, _ = name.rpartition("_")
    return _words(base) in channel.words and unit_of_column(header, channel.name) is not None


def _may_be_foreign(header: Header, channel: Channel) -> bool:
    """Whether the name is a word for the channel in another language, or an English one with its unit behind it.

    A channel that is not required needs a fitting unit too: it must not get in the way.
    """
    unit = header.unit
    names = [header.name]
    parts = name_and_unit(header.name)
    if unit is None and parts is not None and measures(parts[1], channel.unit):
        names, unit = [parts[0]], parts[1]
    elif unit is None and "_" in header.name and unit_of_column(header, channel.name):
        names, unit = [header.name.rpartition("_")[0]], unit_of_column(header, channel.name)
    fits = unit is not None and measures(unit, channel.unit)
    if (unit is not None and not fits) or (not channel.required and not fits):
        return False
    return any(
        foreign_channel(name) == channel.name or (parts is not None and _words(name) in channel.words)
        for name in names
    )


def _may_be_counted(header: Header, channel: Channel) -> bool:
    """Whether the name without the number that counts a trial is one of the channel's."""
    name = without_count(header.name)
    if name is None or not channel.required:
        return False
    bare = Header(name, header.unit, header.text, header.dated)
    return _may_be(bare, channel) or _may_be_foreign(bare, channel)


def _without_source(header: Header) -> Header:
    """Return a column without what its name says in brackets of its source: `Load(Actuator 1:Load) (N)`."""
    return Header(header.name.partition("(")[0].strip(), header.unit, header.text, header.dated)


def _may_be_qualified(header: Header, channel: Channel) -> bool:
    """Whether the name ends in a word of the channel, and its unit fits: `Lead actuator force [kN]`."""
    unit = unit_of_column(header, channel.name)
    if channel.name not in ("deflection", "force") or unit is None or not measures(unit, channel.unit):
        return False
    name = header.name if header.unit else header.name.removesuffix(unit)
    words = _words(name.partition("(")[0]).split()
    ends = (" ".join(words[i:]) for i in range(1, len(words)))
    return is_measured(name) and any(
        end in channel.words or foreign_channel(end) == channel.name for end in ends
    )


def _words(name: str) -> str:
    return " ".join(name.lower().replace("_", " ").replace("-", " ").split())


def columns_listed(headers: Sequence[Header]) -> str:
    """The columns of a table as a message names them."""
    return listed([quoted(header.text) for header in headers], most=20) or "none"
