"""Which column of a table is which channel."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from .channels import (
    CHANNELS,
    Channel,
    bare_name,
    in_words,
    known_channel,
    may_be,
    may_be_counted,
    may_be_foreign,
    may_be_in_two_languages,
    may_be_qualified,
    may_be_second,
    may_be_symbol,
    unit_of_column,
    without_source,
)
from .formats import Header, RecordingError
from .formats.table import listed, quoted
from .origin import Origin
from .side_by_side import (
    NUMBER,
    SeveralTrials,
    in_own_test,
    no_such_trial,
    number_within,
    of_trial,
    trials_in,
    width_of_a_test,
)
from .units import measures

_COUNTED_AGAIN = re.compile(r"^(?:compressive|tensile) ")


@dataclass(frozen=True)
class Match:
    """The column that holds a channel; sign 1 or -1 where the user says so, 0 where it is still open."""

    index: int
    sign: int = 0


@dataclass(frozen=True)
class Matches:
    """Which column holds which channel, the required channels that none holds, and how many trials the table has.

    trials: 1, or the number of tests that stand side by side, of which the columns of one are taken
    looked_at: the columns among which they were looked for, the first and how many; None: all
    """

    columns: Mapping[str, Match]
    missing: tuple[str, ...]
    trials: int = 1
    looked_at: tuple[int, int] | None = None


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
    trial: which one, from 1, where several tests stand side by side; where their columns have the same names, a
    column is named as in one test alone

    Errors: RecordingError when a column named is not there, or several may be the one of a channel.
    """
    width = len(headers) if time_axis is not None else width_of_a_test(headers)
    equal = None if width == len(headers) else _of_equal_tests(origin, headers, width, columns, trial)
    return equal or _matched(origin, headers, time_axis, columns, trial)


def _of_equal_tests(
    origin: Origin, headers: Sequence[Header], width: int, columns: Mapping[str, str], trial: int | None
) -> Matches | None:
    """Return the columns of one of several tests whose columns have the same names; where none is asked for, those of
    the first if a channel that is needed has no column in it.

    None where the columns are named across the tests, or each holds several tests itself.
    Errors: SeveralTrials where none is asked for, and all that is needed is there.
    """
    tests = len(headers) // width
    within = trial is None or 1 <= trial <= tests
    numbered = filter(None, (NUMBER.fullmatch(text.strip()) for text in columns.values()))
    numbers = [int(number[1]) for number in numbered]
    if trial is None and numbers and (max(numbers) > width or _complete(origin, headers, columns)):
        return None
    first = width * ((trial or 1) - 1) if within else 0
    own = {name: number_within(text, first, width) for name, text in columns.items()}
    try:
        found = _matched(origin, headers[first : first + width], None, own, None)
    except SeveralTrials:
        return None
    if not within:
        raise no_such_trial(origin, tests)
    if trial is None and not {"deflection", "force"} & set(found.missing):
        raise SeveralTrials(origin, tests)
    matches = {name: replace(match, index=first + match.index) for name, match in found.columns.items()}
    return replace(found, columns=matches, trials=tests, looked_at=(first, width))


def _complete(origin: Origin, headers: Sequence[Header], columns: Mapping[str, str]) -> bool:
    """Return whether columns that are named by numbers leave nothing open in the whole table."""
    try:
        return not _matched(origin, headers, None, columns, None).missing
    except RecordingError:
        return False


def _matched(
    origin: Origin,
    headers: Sequence[Header],
    time_axis: int | None,
    columns: Mapping[str, str],
    trial: int | None,
) -> Matches:
    """Return which column holds which channel, as `match_channels`, of tests without regard to how they are named."""
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
    found |= _on_axis_of_force(headers, found)
    trials = trials_in(found)
    if trials > 1:
        all_found, found = found, of_trial(origin, found, trials, trial)
        for name, match in matches.items():
            if NUMBER.fullmatch(columns[name].strip()):
                own = in_own_test(headers, all_found, match.index, trial or 1)
                matches[name] = replace(match, index=own)
    elif trial is not None and trial > 1 and not _names_a_test(headers, columns):
        raise RecordingError(
            f"{origin}: has no trial {trial} side by side with others; leave out @trial{trial}"
        )
    for channel in CHANNELS:
        indices = found.get(channel.name, [])
        if len(indices) > 1:
            raise several_columns(origin, headers, channel.name, indices)
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
    named = {name: text.strip() for name, text in columns.items() if text.strip()}
    absent = {name: text for name, text in named.items() if not _match(headers, text)[0]}
    if absent:
        raise _no_columns(origin, headers, absent)
    for name, text in named.items():
        matches[name] = _named(origin, headers, name, text)
    if len({match.index for match in matches.values()}) < len(matches):
        raise RecordingError(f"{origin}: one column is given for two channels; name another for one of them")
    return matches


def _found(headers: Sequence[Header], channel: Channel, assigned: set[int]) -> list[int]:
    """Return the columns that may hold a channel: by our words, else by foreign ones, else but for a number."""
    free = [(i, header) for i, header in enumerate(headers) if i not in assigned]
    found = [i for i, header in free if may_be(header, channel)]
    if channel.name == "time" and any(header.dated for _, header in free):
        found = _beside_dates(free, channel, found)
    if found:
        return _in_fitting_units(headers, channel, found)
    found = _without_counted_again(headers, _otherwise_named(free, channel))
    return _in_fitting_units(headers, channel, found) if channel.required or len(found) == 1 else []


def _beside_dates(free: Sequence[tuple[int, Header]], channel: Channel, found: list[int]) -> list[int]:
    """Return what may be the time beside dates: the one clock with a name and unit of time, else what our words find,
    else the one date, which is coarser.
    """
    clocks = [
        (i, h)
        for i, h in free
        if not h.dated and measures(unit_of_column(h, channel.name) or "", channel.unit)
    ]
    named = [i for i, _ in clocks if i in found] or _otherwise_named(clocks, channel)
    dated = [i for i, header in free if header.dated]
    return named if len(named) == 1 else found or (dated if len(dated) == 1 else [])


def _otherwise_named(free: Sequence[tuple[int, Header]], channel: Channel) -> list[int]:
    """Return the columns that may hold a channel by the best of the names that are not our own."""
    sourceless = [(i, without_source(header)) for i, header in free]
    spelled = [(i, in_words(header)) for i, header in free]
    for named, columns in (
        (may_be_foreign, free),
        (may_be_in_two_languages, free),
        (may_be_symbol, free),
        (may_be_counted, free),
        (may_be, sourceless),
        (may_be_foreign, sourceless),
        (may_be_qualified, free),
        (may_be, spelled),
        (may_be_foreign, spelled),
        (may_be_qualified, spelled),
        (may_be_second, free),
    ):
        found = [i for i, header in columns if named(header, channel)]
        if found:
            return found
    return []


def _on_axis_of_force(headers: Sequence[Header], found: Mapping[str, list[int]]) -> dict[str, list[int]]:
    """Return what may be the deflection where x, y and z are axes: that along which the force acts, else all of them.

    Beside y and z an x is no symbol of a deflection: of `x, y, z, Fz` the z belongs to the force.
    """
    of_axis = {bare_name(header, "m"): i for i, header in enumerate(headers)}
    axes = [of_axis[letter] for letter in "xyz" if letter in of_axis]
    if len(axes) < 2 or "deflection" not in found or set(found["deflection"]) - set(axes):
        return {}
    axes = _in_fitting_units(headers, next(c for c in CHANNELS if c.name == "deflection"), axes)
    forces = {bare_name(headers[i], "N")[-1:] for i in found.get("force", ())}
    along = [i for i in axes if bare_name(headers[i], "m") in forces]
    return {"deflection": along if len(along) == 1 else axes}


def _without_counted_again(headers: Sequence[Header], found: list[int]) -> list[int]:
    """Return columns without those that are another counted another way: `Compressive extension` beside `Extension`."""
    names = {i: " ".join(headers[i].name.lower().split()) for i in found}
    again = [i for i, name in names.items() if _COUNTED_AGAIN.sub("", name) in set(names.values()) - {name}]
    return [i for i in found if i not in again]


def _in_fitting_units(headers: Sequence[Header], channel: Channel, found: list[int]) -> list[int]:
    """Return the columns without those in a unit of something else, such as the volts of the same sensor."""
    units = {i: unit_of_column(headers[i], channel.name) for i in found}
    fitting = [i for i, unit in units.items() if unit and measures(unit, channel.unit)]
    return [i for i in found if i in fitting or not units[i]] if fitting else found


def _names_a_test(headers: Sequence[Header], columns: Mapping[str, str]) -> bool:
    """Whether the user names the columns of one test, in a table that is not known to hold a single one."""
    force = next(channel for channel in CHANNELS if channel.name == "force")
    return {"deflection", "force"} <= columns.keys() and len(_found(headers, force, set())) != 1


def several_columns(
    origin: Origin, headers: Sequence[Header], channel: str, found: Sequence[int]
) -> RecordingError:
    """Return the error for several columns that may be a channel; the first of them is what is proposed."""
    candidates = " and ".join(f"{quoted(headers[i].text)} (#{i + 1})" for i in sorted(found))
    which = origin.columns(**{channel: f"#{found[0] + 1}"})
    required = next(c.required for c in CHANNELS if c.name == channel)
    without = "" if required else f", or leave it out with {origin.columns(**{channel: ''})}"
    return RecordingError(
        f"{origin}: {candidates} may each be the {channel}; say which with {which}{without}"
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


def _no_columns(origin: Origin, headers: Sequence[Header], absent: Mapping[str, str]) -> RecordingError:
    """Return the error for columns that are named and not there: who names them, and what to write."""
    likely = {}
    for channel in CHANNELS:
        if channel.name in absent:
            found = _found(headers, channel, set())
            likely[channel.name] = option_name(headers, found[0]) if len(found) == 1 else "NAME"
    giving = origin.columns(**likely)
    kept = origin.kept_in("columns", *absent)
    plural = "columns" if len(absent) > 1 else "column"
    said = f", as {kept} says" if kept else ""
    own = f'[files."{origin}".columns]'
    advice = f"give {giving}, or say it of this file alone in {kept}: {own}" if kept else f"correct {giving}"
    return RecordingError(
        f"{origin}: has no {plural} {listed([*map(quoted, absent.values())])}{said}; its columns are "
        f"{columns_listed(headers)}; {advice}"
    )


def _match(headers: Sequence[Header], text: str) -> tuple[list[int], int]:
    """Return the columns that a name means, and the sign before it, 0 for none."""
    exact = _finds(headers, text)
    if exact or text[0] not in "+-":
        return exact, 0
    return _finds(headers, text[1:].strip()), 1 if text[0] == "+" else -1


def _named(origin: Origin, headers: Sequence[Header], channel: str, text: str) -> Match:
    exact, sign = _match(headers, text)
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


def option_name(headers: Sequence[Header], index: int) -> str:
    """Return how the options call a column: its text, or its number where the text is another's too, or a sign's."""
    text = headers[index].text
    plain = [header.text for header in headers].count(text) == 1 and text[:1] not in "+-#"
    return text if plain else f"#{index + 1}"


def columns_listed(headers: Sequence[Header]) -> str:
    """The columns of a table as a message names them."""
    return listed([quoted(header.text) for header in headers], most=20) or "none"
