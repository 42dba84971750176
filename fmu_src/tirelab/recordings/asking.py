"""What a table does not say, asked for all at once, in options that work when they are copied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .channels import EXAMPLE_UNITS, UNIT_OF, unit_of_column
from .choices import Choices
from .formats import Header, RecordingError, Table, Wanted
from .formats.table import listed, quoted
from .guessing import guessed_columns, stating_time
from .matching import Match, columns_listed
from .metadata import Settings
from .origin import Origin
from .other_columns import is_strained
from .plausibility import guessed_units
from .units import UnitError, given_conversion, meant_unit

FloatArray = NDArray[np.float64]

PULLS = 0.1
"""A force of the other sign, over the largest one, beyond which what was recorded is hardly a tire."""

OF_A_PART = (
    " (the force has both signs: a damper or another part has none, `tirelab inspect FILE --part` keeps that)"
)

MOST_COLUMNS = 16
"""Most columns that are searched for one that may be a channel."""


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

    wrong: of a channel whose unit is none, or one of something else: what is said of it, and the unit that is meant, ""
    where it is to be guessed
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
    guessed = guessed_columns(lacking.columns, matches, values, headers) if lacking.columns else {}
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
    if len(columns) > 1 and columns.get("time") == "NAME":
        columns["time"] = ""  # no column counts up as a clock does: it was not measured
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
    units |= {
        name: meant or likely.get(name, EXAMPLE_UNITS[name]) for name, (_, meant) in lacking.wrong.items()
    }
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
    for name, (what, _) in lacking.wrong.items():
        then = "Then" if what.endswith("?") else "then"
        parts.append((what, f"{then} give it: {origin.units(**{name: whole.units[name]})}"))
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
