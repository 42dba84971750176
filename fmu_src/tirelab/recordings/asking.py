"""What a table does not say, asked for all at once, in options that work when they are copied."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from .channels import (
    EXAMPLE_UNITS,
    UNIT_OF,
    begins_in_word,
    ends_in_word,
    is_symbol,
    symbolises_another,
    unit_of_column,
)
from .choices import Choices
from .formats import Header, RecordingError, Table, Wanted
from .formats.table import listed, quoted
from .matching import Match, columns_listed
from .metadata import Settings
from .origin import Origin
from .plausibility import guessed_units
from .units import UnitError, given_conversion, is_unit, meant_unit, measures
from .vocabulary import begins_like, counts_rows, is_strained

FloatArray = NDArray[np.float64]

PULLS = 0.1
"""A force of the other sign, over the largest one, beyond which what was recorded is hardly a tire."""

OF_A_PART = (
    " (the force has both signs: a damper or another part has none, `tirelab inspect FILE --part` keeps that)"
)

_AXIS = re.compile(r"(?:^|[\W_])[a-z]?(?P<axis>[xyz])(?=$|[\W_])", re.IGNORECASE)

MOST_COLUMNS = 16
"""Most columns that are searched for one that may be a channel."""


EVENLY = 1.5
"""Steps of what a drive moves differ by less than this factor, but for a few."""


A_RATE = 0.99
"""Part of the variance of a recorded velocity that the rate of the recorded travel explains."""

SAME_SIZE = 0.02
"""Decades between the two sizes at most, but for a whole number of them: 5 %."""


class IncompleteRecording(RecordingError):
    """A table that leaves something open: what, and the whole of what has to be written.

    what: the sentence without the advice; columns, units, radius: all settings, those given and those proposed
    """

    def __init__(self, what: str, advice: str, settings: Settings) -> None:
        super().__init__(f"{what}{' ' if what.endswith('?') else '; '}{advice}")
        self.what = what
        self.settings = settings

    def words(self) -> list[str]:
        """Return the words of a command line that say all of it."""
        own = self.settings
        given = Choices(
            columns=own.columns, units=own.units, radius=own.radius, sampling=own.sampling, zero=own.zero
        )
        return given.words()


@dataclass(frozen=True)
class Lacking:
    """What is not known: channels without a column, channels without a unit, the radius of the surface.

    wrong: of a channel whose unit is none, or one of something else: what is said of it, and the unit that is meant
    """

    columns: tuple[str, ...]
    units: tuple[str, ...]
    radius: bool
    wrong: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.columns or self.units or self.radius or self.wrong)


def asked(
    origin: Origin, table: Table, matches: Mapping[str, Match], lacking: Lacking, settings: Settings
) -> RecordingError:
    """Return the error that asks for all that is lacking, with guesses from the sizes of the numbers."""
    headers = table.headers
    values = _numbers(table, {**matches}, headers)
    known_by_unit = lacking.columns == ("time",) and stating_time(headers, ())
    if lacking.columns and not values and not known_by_unit:
        return RecordingError(
            f"{origin}: no column holds numbers (its columns are {columns_listed(headers)}); "
            "export the readings themselves, one row for each sample"
        )
    guessed = _guessed_columns(lacking.columns, matches, values, headers) if lacking.columns else {}
    unknown = {"deflection", "force"} & set(lacking.columns) - set(guessed)
    strained = [quoted(h.text) for h in headers if is_strained(h.name)]
    if strained and unknown:
        return RecordingError(
            f"{origin}: no column for {', '.join(lacking.columns)}: {listed(strained)} "
            f"{'says' if len(strained) == 1 else 'say'} strain or stress, which are neither deflection nor force; "
            "export the readings of the travel and the load cell, or multiply the strain by the gauge length and the "
            "engineering stress by the cross-section"
        )
    taken = {*guessed.values(), *(match.index for match in matches.values())}
    if unknown and taken.issuperset(range(len(headers))) and origin.kind == "file":
        return RecordingError(
            f"{origin}: no column is left for the {' and the '.join(sorted(unknown))} (its columns are "
            f"{columns_listed(headers)}); export {'it' if len(unknown) == 1 else 'them'} with the others"
        )
    sized = {name: values[i] for name, i in guessed.items()}
    sized |= {name: values[match.index] for name, match in matches.items() if match.index in values}
    likely = guessed_units(sized, settings.part, _metres(headers, matches, settings))
    columns = {name: f"#{guessed[name] + 1}" if name in guessed else "NAME" for name in lacking.columns}
    for name in lacking.units:
        if matches[name].index not in values:
            table.read((Wanted(matches[name].index, name),))  # no numbers: no unit helps
    without_unit = [*lacking.units, *(n for n, i in guessed.items() if not unit_of_column(headers[i], n))]
    units = {name: likely.get(name, EXAMPLE_UNITS[name]) for name in without_unit}
    units |= {
        n: meant
        for n, i in guessed.items()
        if (meant := meant_unit(unit_of_column(headers[i], n) or "", UNIT_OF[n]))
    }
    units |= {name: meant for name, (_, meant) in lacking.wrong.items()}
    radius = "flat" if lacking.radius else None
    whole = Settings(
        {**settings.columns, **columns},
        {**settings.units, **units},
        settings.radius if radius is None else radius,
        sampling=settings.sampling,
        part=settings.part,
        zero=settings.zero,
    )
    parts = _parts(origin, headers, matches, lacking, whole)
    if radius is not None and origin.kind == "file" and _pulls(sized.get("force")):
        parts = [(what + OF_A_PART if "radius" in what else what, advice) for what, advice in parts]
    if len(parts) == 1 and len(lacking.units) < 2:
        return IncompleteRecording(parts[0][0], parts[0][1], whole)
    options = [
        *([origin.columns(**columns)] if columns else []),
        *([origin.units(**units)] if units else []),
        *([origin.radius(radius)] if radius else []),
    ]
    what = "; ".join(
        dict.fromkeys(
            what if i == 0 else what.removeprefix(f"{origin}: ") for i, (what, _) in enumerate(parts)
        )
    )
    joined = " ".join(options) if origin.kind == "file" else ", ".join(options)
    return IncompleteRecording(what, f"give all of it, and check what is guessed: {joined}", whole)


def _parts(
    origin: Origin,
    headers: Sequence[Header],
    matches: Mapping[str, Match],
    lacking: Lacking,
    whole: Settings,
) -> list[tuple[str, str]]:
    """Return what is lacking, sentence by sentence, each with its advice."""
    parts = [_no_column(origin, headers, lacking.columns, whole)] if lacking.columns else []
    for name in lacking.units:
        unit = whole.units[name]
        header = headers[matches[name].index]
        parts.append(
            (
                f"{origin}, column {quoted(header.text)}: has no unit",
                f"write it into the header, such as {name} [{unit}], or give it: {origin.units(**{name: unit})}",
            )
        )
    for name, (what, meant) in lacking.wrong.items():
        parts.append((what, f"Then give it: {origin.units(**{name: meant})}"))
    if lacking.radius:
        in_file = "" if origin.kind != "file" else ', or write radius = "flat" into recording.toml beside it'
        parts.append(
            (
                f"{origin}: the radius of the surface is not known",
                f"add a column such as radius [cm] (inf: flat), or give {origin.radius('flat')} (25.4cm, -50.8cm)"
                f"{in_file}",
            )
        )
    if len(parts) > 1 and len(lacking.units) > 1:
        named = ", ".join(quoted(headers[matches[name].index].text) for name in lacking.units)
        others = [part for part in parts if "has no unit" not in part[0]]
        parts = [*others, (f"{origin}: no unit for {named}", "")]
    return parts


def _no_column(
    origin: Origin, headers: Sequence[Header], missing: Sequence[str], whole: Settings
) -> tuple[str, str]:
    """Return which channels have no column, and the advice to name one for each of them."""
    naming = origin.columns(**{name: whole.columns[name] for name in missing})
    units = {name: whole.units[name] for name in missing if name in whole.units}
    if headers and all(header.text == f"#{i + 1}" for i, header in enumerate(headers)):
        skipping = origin.kept.get("skip_rows", "")
        below = f" below the rows that skip_rows in {skipping} leaves out" if skipping else ""
        return (
            f"{origin}: has no header row{below}",
            "put one above the numbers, such as time [s],deflection [mm],force [N], or name columns by number: "
            f"{naming}{f' {origin.units(**units)}' if units else ''}",
        )
    what = f"{origin}: no column for {', '.join(missing)}; its columns are {columns_listed(headers)}"
    advice = naming + (f" and {origin.units(**units)}" if units else "")
    if tuple(missing) == ("time",):
        advice += f", or {origin.columns(time='')} where it was not measured"
    return what, f"name it with {advice}"


def _metres(headers: Sequence[Header], matches: Mapping[str, Match], settings: Settings) -> float | None:
    """Return the unit of the deflection [m]; None where it is not known."""
    match = matches.get("deflection")
    stated = unit_of_column(headers[match.index], "deflection") if match is not None else None
    try:
        return given_conversion(settings.units.get("deflection") or stated or "", "m").multiplied
    except UnitError:
        return None


def _pulls(force: FloatArray | None) -> bool:
    """Whether a force has both signs."""
    if force is None:
        return False
    ends = sorted((abs(float(np.nanmin(force))), abs(float(np.nanmax(force)))))
    return bool(np.nanmin(force) < 0.0 < np.nanmax(force)) and ends[0] > PULLS * ends[1]


def _numbers(table: Table, matches: Mapping[str, Match], headers: Sequence[Header]) -> dict[int, FloatArray]:
    """Return the columns that hold numbers, by their index; those of channels by the channel, others as any."""
    channel_of = {match.index: name for name, match in matches.items()}
    found: dict[int, FloatArray] = {}
    for index in range(min(len(headers), MOST_COLUMNS)):
        try:
            read = table.read(
                (Wanted(index, channel_of.get(index, "time" if headers[index].dated else "speed")),)
            )
        except RecordingError:
            continue
        if np.count_nonzero(np.isfinite(read.values[0])) > 1:
            found[index] = read.values[0]
    return found


def rises(values: FloatArray) -> bool:
    """Whether numbers rise from each to the next, evenly enough for a clock; one by one they count the rows."""
    steps = np.diff(values[np.isfinite(values)])
    if not len(steps) or np.all(steps == 1.0):
        return False
    return bool(steps.min() > 0.0) and bool(np.quantile(steps, 0.9) < 3.0 * np.median(steps))


def _is_index(headers: Sequence[Header], index: int, values: FloatArray) -> bool:
    """Whether a column without a name among named ones counts the rows, as a data frame that was written does."""
    nameless = [header.text == f"#{i + 1}" for i, header in enumerate(headers)]
    return nameless[index] and not all(nameless) and bool(np.all(np.diff(values) == 1.0))


def may_count_time(header: Header) -> bool:
    """Whether a column may be a clock by what it states: it is no counter, and has no unit of anything else."""
    if counts_rows(header.name):
        return False
    stated = {name for name, si in UNIT_OF.items() if measures(unit_of_column(header, name) or "", si)}
    return "time" in stated if stated else header.unit is None or not is_unit(header.unit)


def driven(values: FloatArray) -> bool:
    """Whether numbers go up and down by even steps, as what a drive moves does and a force does not."""
    steps = np.abs(np.diff(values[np.isfinite(values)]))
    return len(steps) > 1 and bool(np.quantile(steps, 0.9) < EVENLY * np.quantile(steps, 0.1))


def rates_among(values: Mapping[int, FloatArray], time: FloatArray) -> frozenset[int]:
    """Return the columns that are the rate of another one over time, as a velocity recorded beside the travel is.

    A damper's force goes with its rate too, but only a rate has the size of it, but for the units, a power of ten.
    """
    found = set()
    with np.errstate(all="ignore"):  # a column may hold anything
        for column in values.values():
            rate = np.gradient(column, time)
            for i, other in values.items():
                known = np.isfinite(rate) & np.isfinite(other)
                if np.count_nonzero(known) < 3:
                    continue
                (own, between), (_, of_rate) = np.cov(other[known], rate[known])
                decades = np.log10(np.abs(between / of_rate))
                if between > np.sqrt(A_RATE * own * of_rate) and abs(decades - np.round(decades)) < SAME_SIZE:
                    found.add(i)
    return frozenset(found)


def _states(header: Header, name: str) -> bool:
    """Whether a column states a unit of a channel, or one by which it is meant."""
    unit = unit_of_column(header, name) or ""
    return measures(unit, UNIT_OF[name]) or bool(meant_unit(unit, UNIT_OF[name]))


def _axis(header: Header) -> str:
    """Return the axis that a name says, z of `Fz_N` and of `disp z [mm]`; "" where it says none."""
    found = _AXIS.search(header.name)
    return found["axis"].lower() if found else ""


def stating_time(headers: Sequence[Header], taken: Collection[int]) -> list[int]:
    """Return the columns with a unit of time, without those that are taken."""
    return [
        i
        for i, header in enumerate(headers)
        if i not in taken and header.unit and measures(header.unit, UNIT_OF["time"])
    ]


def _guessed_columns(
    missing: Sequence[str],
    matches: Mapping[str, Match],
    values: Mapping[int, FloatArray],
    headers: Sequence[Header],
) -> dict[str, int]:
    """Return a likely column for each channel that has none: time rises, others go by their unit, else by their symbol
    in small or large letters, the beginning of their name ("forc"), its end (`Machine_Load`) or its first word
    (`Force_data`), else by their size.

    A unit tells where one column alone states a fitting one, the mass on a scale a force, or one of the axis of the
    other channel, disp_z beside Fz. Of several it is the one that stands nearest to the other channel, and where both
    channels have several the two that stand nearest to each other. Of two columns without a unit the one that a drive
    moves evenly is the deflection, else the smaller; of more, what is the rate of another one is neither. A counter, a
    strain and a stress are neither, nor is what was sampled another number of times.
    """
    taken = {match.index for match in matches.values()}
    free = [i for i in values if i not in taken and np.nanmin(values[i]) < np.nanmax(values[i])]
    free = [i for i in free if not _is_index(headers, i, values[i])]
    others = [i for i in free if headers[i].unit or not np.all(np.diff(values[i]) == 1.0)]
    free = others if len(others) >= len(missing) else free  # what rises by ones counts the rows
    free = [i for i in free if not is_strained(headers[i].name) or _states(headers[i], "deflection")]
    known = [len(values[i]) for i in taken if i in values]
    samples = known[0] if known else max((len(values[i]) for i in free), default=0)
    free = [i for i in free if len(values[i]) == samples]
    guessed: dict[str, int] = {}
    if "time" in missing:
        clocks = [i for i in free if rises(values[i]) and may_count_time(headers[i])]
        stated = stating_time(headers, taken)
        clocks = [i for i in clocks if i in stated] or stated or clocks
        if clocks:
            guessed["time"] = clocks[0]
            free = [i for i in free if i != clocks[0]]
    for name in ("deflection", "force"):
        fits = [i for i in free if _states(headers[i], name)]
        axes = {_axis(headers[matches[other].index]) for other in ("deflection", "force") if other in matches}
        fits = fits if len(fits) < 2 else [i for i in fits if _axis(headers[i]) in axes - {""}]
        if name in missing and len(fits) == 1:
            guessed[name] = fits[0]
            free.remove(fits[0])
    stating = {name: [i for i in free if _states(headers[i], name)] for name in ("deflection", "force")}
    free = [i for i in free if headers[i].unit is None and not counts_rows(headers[i].name)]
    free = [i for i in free if not symbolises_another(headers[i].name)]
    for likely, name in product((is_symbol, begins_like), ("deflection", "force")):
        alike = [i for i in free if likely(headers[i].text, name)]
        if name in missing and name not in guessed and len(alike) == 1:
            guessed[name] = alike[0]
            free.remove(alike[0])
    pairs = [(i, j) for i in stating["deflection"] for j in stating["force"]]
    if pairs and {"deflection", "force"} <= set(missing) - set(guessed):
        guessed["deflection"], guessed["force"] = min(pairs, key=lambda pair: abs(pair[0] - pair[1]))
    places = {name: match.index for name, match in matches.items()} | guessed
    for name, other in (("deflection", "force"), ("force", "deflection")):
        if name in missing and name not in guessed and other in places and len(stating[name]) > 1:
            beside = places[other]
            guessed[name] = min(stating[name], key=lambda i: abs(i - beside))
    for names, name in product((ends_in_word, begins_in_word), ("deflection", "force")):
        said = [i for i in free if names(headers[i].name, name)]
        if name in missing and name not in guessed and len(said) == 1:
            guessed[name] = said[0]
            free.remove(said[0])
    both = [name for name in ("deflection", "force") if name in missing and name not in guessed]
    clock = guessed["time"] if "time" in guessed else matches["time"].index if "time" in matches else -1
    if len(free) > len(both) and clock in values:
        rates = rates_among({i: values[i] for i in free}, values[clock])
        free = [i for i in free if i not in rates]
    if len(free) >= len(both):
        # Of many columns the first ones: of trials side by side those of one trial.
        sized = sorted(
            free[: len(both)], key=lambda i: (not driven(values[i]), float(np.nanmax(np.abs(values[i]))))
        )
        guessed |= dict(zip(both, sized, strict=True))
    return guessed
