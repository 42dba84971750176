"""The channels of a recording, and the names that columns have for them."""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from .assignments import assignments
from .formats import Header, RecordingError
from .formats.table import quoted
from .origin import in_quotes
from .other_columns import is_measured, is_strained
from .units import meant_unit, measures
from .vocabulary import any_channel, foreign_channel, glued_ends, name_and_unit, second_channel, without_count


@dataclass(frozen=True)
class Channel:
    """One channel: our name for it, its SI unit, and the names and symbols the field gives it.

    largest: magnitude [SI] that no rig and no ride reaches, a number beyond it has the wrong unit; example: the unit
    that advice names; required: whether every recording has it
    """

    name: str
    unit: str
    words: frozenset[str]
    symbol: str
    largest: float
    example: str
    required: bool = True


def _names(text: str) -> frozenset[str]:
    return frozenset(text.split(", "))


CHANNELS = (
    Channel("time", "s", _names("time, elapsed time, test time, time stamp, timestamp"), "t", 1e12, "s"),
    Channel(
        "deflection",
        "m",
        _names(
            "deflection, tire deflection, tyre deflection, radial deflection, displacement, stroke, compression, "
            "travel, lvdt"
        ),
        "x",
        largest=1e3,
        example="mm",
    ),
    Channel(
        "radius",
        "m",
        _names(
            "radius, surface radius, radius of curvature, curvature radius, bump radius, obstacle radius, rb"
        ),
        "R",
        largest=math.inf,
        example="cm",
        required=False,
    ),
    Channel(
        "force",
        "N",
        _names(
            "force, radial force, vertical force, normal force, compressive force, load, radial load, "
            "vertical load, load cell, loadcell"
        ),
        "F",
        largest=1e8,
        example="N",
    ),
    Channel(
        "pressure",
        "Pa",
        _names(
            "pressure, inflation pressure, gauge pressure, absolute pressure, tire pressure, tyre pressure, "
            "abs pressure, abs. pressure, pressure abs, pressure absolute, pressure gauge, air pressure, "
            "internal pressure, tire inflation pressure, tyre inflation pressure"
        ),
        "p",
        largest=1e9,
        example="kPa",
        required=False,
    ),
    Channel(
        "temperature",
        "K",
        _names("temperature, temp, tire temperature, tyre temperature"),
        "T",
        largest=1e4,
        example="degC",
        required=False,
    ),
    Channel(
        "speed",
        "m/s",
        _names("speed, forward speed, riding speed, travel speed, vehicle speed"),
        "v",
        largest=1e4,
        example="m/s",
        required=False,
    ),
    # a force that a simulation gave: read only where the user names its column
    Channel("believed_force", "N", frozenset(), "", largest=1e8, example="N", required=False),
)
"""The channels in the order of the house form of a recording."""

EXAMPLE_UNITS = {channel.name: channel.example for channel in CHANNELS}
"""The unit of each channel that advice names."""

_SYMBOLS = {channel.symbol: channel.name for channel in CHANNELS if channel.symbol}

UNIT_OF = {channel.name: channel.unit for channel in CHANNELS}
"""The SI unit of each channel."""

_NAMED = {word: channel.name for channel in CHANNELS for word in channel.words}
"""The channel of each of these names."""

_GERMAN_SYMBOL = {"deflection": "s"}
"""Symbols of channels in German exports, taken where a fitting unit follows: s [mm]."""

_HUMP = re.compile(r"(?<=[a-z])(?=[A-Z])")
"""Where a word begins in the middle of a name: ForceArray."""

# "force_min" is a minimum and "stroke_in" an input as often as they are minutes and inches.
_NO_SUFFIX_UNITS = frozenset({"in", "min", "max"})


_BETWEEN_WORDS = re.compile(r"[/|()_\s]+")
_JOINED = re.compile(r"(?<=[a-z])(?=[A-Z][a-z])")

# A controller puts the number of its input before every name: Ch 1 Time, C_1_Temps.
_OF_INPUT = re.compile(r"(?:c|ch|chan|channel|kanal)[ ._-]*\d+[ ._:-]+(?P<name>.+)", re.IGNORECASE)


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
    return ",".join(f"{name}={in_quotes(value)}" for name, value in values.items())


def known_channel(name: str, where: str) -> None:
    """Refuse a name that is none of the channels'."""
    if name not in UNIT_OF:
        raise RecordingError(f"{where}: {quoted(name)} is no channel; the channels are {', '.join(UNIT_OF)}")


def unit_of_column(header: Header, channel: str) -> str | None:
    """The unit a column states, in brackets, in its properties, or at the end of its name: force_N.

    Behind a word for the channel it may be one that stands for another: load_kg.
    """
    if header.unit:
        return header.unit
    base, mark, tail = header.name.rpartition("_")
    if mark and tail not in _NO_SUFFIX_UNITS and measures(tail, UNIT_OF[channel]):
        return tail
    if (
        mark
        and channel in (_NAMED.get(_words(base)), any_channel(base))
        and meant_unit(tail, UNIT_OF[channel])
    ):
        return tail
    parts = name_and_unit(header.name)
    fits = parts is not None and parts[1] not in _NO_SUFFIX_UNITS and measures(parts[1], UNIT_OF[channel])
    return parts[1] if parts is not None and fits else None


def bare_name(header: Header, unit: str) -> str:
    """Return the name of a column in small letters, without one of these units behind it: `fz` of `Fz_N`."""
    parts = name_and_unit(header.name.replace("_", " "))
    return (parts[0] if parts is not None and measures(parts[1], unit) else header.name).lower()


_STATED = re.compile(
    r"\b(?:units?|einheit(?:en)?|unit\N{LATIN SMALL LETTER E WITH ACUTE}s?|unidad(?:es)?)\s*[:=]\s*(?P<unit>\S.*)",
    re.I,
)


def units_stated(lines: Iterable[str]) -> dict[str, str]:
    """Return the unit of each channel by its name that lines above a table state: `Units: N`, `Travel Unit: mm`.

    Of a quantity for which two units are stated none is returned, and none of the radius: a deflection's unit is not
    that of a surface.
    """
    stated = [told["unit"].strip() for line in lines if (told := _STATED.search(line))]
    found = {
        c.name: {unit for unit in stated if measures(unit, c.unit)} for c in CHANNELS if c.name != "radius"
    }
    return {name: units.pop() for name, units in found.items() if len(units) == 1}


def says_absolute(header: Header) -> bool:
    """Whether the name of a pressure column says that it is absolute."""
    return bool({"abs", "abs.", "absolute", "absolut", "absolutdruck"} & set(_words(header.name).split()))


def may_be(header: Header, channel: Channel) -> bool:
    """Return whether a column has one of the channel's names or its symbol."""
    name = header.name
    if not channel.words:
        return False
    parts = name_and_unit(name)
    if header.unit is None and parts is not None and len(parts[0]) == 1:
        # ISO 80000: a column of numbers is headed by the quantity over its unit, `s / mm`.
        return may_be(Header(*parts, header.text, header.dated), channel)
    if len(name) == 1:
        if header.unit:
            symbols = (channel.symbol.lower(), _GERMAN_SYMBOL.get(channel.name, ""))
            return name.lower() in symbols and measures(header.unit, channel.unit)
        return name == channel.symbol
    if _words(name) in channel.words:
        return True
    base, _, _ = name.rpartition("_")
    return _words(base) in channel.words and unit_of_column(header, channel.name) is not None


def is_symbol(name: str, channel: str) -> bool:
    """Return whether a name is the channel's symbol in small or large letters: `f` of a force."""
    return channel in (_SYMBOLS.get(name.lower()), _SYMBOLS.get(name.upper()))


def may_be_symbol(header: Header, channel: Channel) -> bool:
    """Return whether a column is called by the channel's symbol and a unit behind it: `F_kN`, `t_ms`."""
    base, _, _ = header.name.rpartition("_")
    unit = unit_of_column(header, channel.name)
    return len(base) == 1 and unit is not None and may_be(Header(base, unit, header.text), channel)


def symbolises_another(name: str) -> bool:
    """Return whether a name is the symbol of a channel that is neither deflection nor force: `v` of the speed."""
    return _SYMBOLS.get(name, "force") not in ("deflection", "force")


def may_be_foreign(header: Header, channel: Channel) -> bool:
    """Whether the name is a word for the channel in another language, or an English one with its unit behind it.

    A channel that is not required needs a fitting unit too: it must not get in the way.
    """
    parts = name_and_unit(header.name)
    return any(
        foreign_channel(name) == channel.name or (parts is not None and _words(name) in channel.words)
        for name in _names_in_fitting_units(header, channel)
    )


def may_be_in_two_languages(header: Header, channel: Channel) -> bool:
    """Whether the name is several words, each of them one for the channel: `Zeit / Time`, `时间 Time`."""
    return any(
        len(parts := [part for part in _BETWEEN_WORDS.split(name) if part]) > 1
        and all(channel.name in (_NAMED.get(_words(part)), foreign_channel(part)) for part in parts)
        for name in _names_in_fitting_units(header, channel)
    )


def may_be_second(header: Header, channel: Channel) -> bool:
    """Whether the name is one for the channel where no column has a better one: `Fx` where there is no `Fz`."""
    return any(second_channel(name) == channel.name for name in _names_in_fitting_units(header, channel))


def _names_in_fitting_units(header: Header, channel: Channel) -> list[str]:
    """Return what a column is called, without the unit behind its name; nothing where its unit is not the channel's."""
    unit = header.unit
    names = [header.name]
    parts = name_and_unit(header.name)
    if unit is None and is_strained(header.name):
        return []
    if unit is None and parts is not None and measures(parts[1], channel.unit):
        names, unit = [parts[0]], parts[1]
    elif unit is None and "_" in header.name and unit_of_column(header, channel.name):
        names, unit = [header.name.rpartition("_")[0]], unit_of_column(header, channel.name)
    fits = unit is not None and measures(unit, channel.unit)
    return [] if (unit is not None or not channel.required) and not fits else names


def may_be_counted(header: Header, channel: Channel) -> bool:
    """Whether the name without the number that counts a trial is one of the channel's."""
    name = without_count(header.name)
    if name is None or not channel.required:
        return False
    bare = Header(name, header.unit, header.text, header.dated)
    return may_be(bare, channel) or may_be_foreign(bare, channel)


def in_words(header: Header) -> Header:
    """Return a column with spaces between the words that its name joins: `ElapsedTime`, `TestForce`."""
    return Header(_JOINED.sub(" ", header.name), header.unit, header.text, header.dated)


def without_source(header: Header) -> Header:
    """Return a column without what its name says in brackets of its source: `Load(Actuator 1:Load) (N)`."""
    return Header(header.name.partition("(")[0].strip(), header.unit, header.text, header.dated)


def may_be_qualified(header: Header, channel: Channel) -> bool:
    """Whether the name ends in a word of the channel, and its unit fits: `Lead actuator force [kN]`, `Ch 1 Time`,
    `350T位移(mm)`."""
    unit = unit_of_column(header, channel.name)
    if channel.required and unit is not None and measures(unit, channel.unit) and is_measured(header.name):
        bare = header.name.partition("(")[0].strip()
        if any(foreign_channel(end) == channel.name for end in glued_ends(bare)):
            return True
    of_input = _OF_INPUT.fullmatch(header.name)
    if channel.name == "time" and of_input and unit and measures(unit, channel.unit):
        name = of_input["name"]
        return _words(name) in channel.words or foreign_channel(name) == channel.name
    if channel.name not in ("deflection", "force") or unit is None or not measures(unit, channel.unit):
        return False
    return ends_in_word(header.name if header.unit else header.name.removesuffix(unit), channel.name)


def ends_in_word(name: str, channel: str) -> bool:
    """Whether a name of what is measured ends in a word of the channel: `Lead actuator force`, `Machine_Load`."""
    words = _words(_HUMP.sub(" ", name.partition("(")[0])).split()
    return _one_is_of(name, (" ".join(words[i:]) for i in range(1, len(words))), channel)


def begins_in_word(name: str, channel: str) -> bool:
    """Whether a name of what is measured begins with a word of the channel: `Load sensor 2`, `ForceArray`."""
    words = _words(_HUMP.sub(" ", name.partition("(")[0])).split()
    return _one_is_of(name, (" ".join(words[:i]) for i in range(1, len(words))), channel)


def _one_is_of(name: str, parts: Iterable[str], channel: str) -> bool:
    return is_measured(name) and any(channel in (_NAMED.get(part), foreign_channel(part)) for part in parts)


def _words(name: str) -> str:
    return " ".join(name.lower().replace("_", " ").replace("-", " ").split())
