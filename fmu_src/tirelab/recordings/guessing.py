"""Which columns are likely the channels that no name tells: by their units, their numbers and their place."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from .channels import (
    UNIT_OF,
    begins_in_word,
    ends_in_word,
    is_symbol,
    symbolises_another,
    unit_of_column,
)
from .formats import Header
from .matching import Match
from .other_columns import counts_rows, idle, is_measured, is_strained, says_another
from .units import is_unit, meant_unit, measures
from .vocabulary import begins_like, stands_for

FloatArray = NDArray[np.float64]

_AXIS = re.compile(r"(?:^|[\W_])[a-z]?(?P<axis>[xyz])(?=$|[\W_])", re.IGNORECASE)

EVENLY = 1.5
"""Steps of what a drive moves differ by less than this factor, but for a few."""


MOST_ANEW = 0.01
"""Part of its steps in which a clock begins anew at most."""

A_RATE = 0.99
"""Part of the variance of a recorded velocity that the rate of the recorded travel explains."""

SAME_SIZE = 0.02
"""Decades between the two sizes at most, but for a whole number of them: 5 %."""


def rises(values: FloatArray) -> bool:
    """Whether numbers rise from each to the next, evenly enough for a clock; one by one they count the rows.

    A logger that was started anew begins anew, a few times in a file.
    """
    steps = np.diff(values[np.isfinite(values)])
    on = steps[steps > 0.0]
    if not len(on) or np.all(on == 1.0) or len(steps) - len(on) > MOST_ANEW * len(steps):
        return False
    return bool(np.quantile(on, 0.9) < 3.0 * np.median(on))


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


BACK = 0.01
"""Part of its span by which what is driven one way alone comes back at most, by the noise of its gauge."""


def _goes_on(values: FloatArray) -> bool:
    """Whether numbers go one way alone, as a specimen that is crushed is driven, and its force is not."""
    known = values[np.isfinite(values)]
    back = (np.max(np.maximum.accumulate(way) - way, initial=0.0) for way in (known, -known))
    return bool(min(back) < BACK * np.ptp(known))


def rates_among(values: Mapping[int, FloatArray], time: FloatArray) -> dict[int, int]:
    """Return the columns that are the rate of another one over time, as a velocity recorded beside the travel is, each
    with that other one.

    A damper's force goes with its rate too, but only a rate has the size of it, but for the units, a power of ten.
    """
    found = {}
    with np.errstate(all="ignore"):  # a column may hold anything
        for moved, column in values.items():
            rate = np.gradient(column, time)
            for i, other in values.items():
                known = np.isfinite(rate) & np.isfinite(other)
                if np.count_nonzero(known) < 3:
                    continue
                (own, between), (_, of_rate) = np.cov(other[known], rate[known])
                decades = np.log10(np.abs(between / of_rate))
                if between > np.sqrt(A_RATE * own * of_rate) and abs(decades - np.round(decades)) < SAME_SIZE:
                    found[i] = moved
    return found


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


def guessed_columns(
    missing: Sequence[str],
    matches: Mapping[str, Match],
    values: Mapping[int, FloatArray],
    headers: Sequence[Header],
) -> dict[str, int]:
    """Return a likely column for each channel that has none: time rises, others go by their unit, else by their symbol
    in small or large letters, the beginning of their name ("forc"), what stands for them (an angle, a torque), its end
    (`Machine_Load`) or its first word (`Force_data`), else by their size.

    A unit tells where one column alone states a fitting one, the mass on a scale a force, or one of the axis of the
    other channel, disp_z beside Fz. Of several it is the one that stands nearest to the other channel, and where both
    channels have several the two that stand nearest to each other. Of two columns without a unit the one that a drive
    moves evenly is the deflection, else the one that goes one way alone, else the smaller; of more, what is the rate of
    another one is neither, and that other one the deflection; what was asked for is no reading, nor is an acceleration
    one of either. A counter, a strain and a stress are neither, nor is what was sampled another number of times, or
    rests at a few values. Beside a strain and a stress nothing is guessed by its size: these are the readings, by the
    specimen's size.
    """
    taken = {match.index for match in matches.values()}
    free = [i for i in values if i not in taken and np.nanmin(values[i]) < np.nanmax(values[i])]
    free = [i for i in free if not _is_index(headers, i, values[i]) and not idle(values[i])]
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
    for name in ("deflection", "force"):
        turning = [i for i in free if stands_for(headers[i].name, name) and is_measured(headers[i].name)]
        if name in missing and name not in guessed and turning:
            guessed[name] = turning[0]  # of several joints the first
            free.remove(turning[0])
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
        if name in missing and name not in guessed and said:
            guessed[name] = said[0]  # of several sensors the first
            free = [i for i in free if i not in said]
    both = [name for name in ("deflection", "force") if name in missing and name not in guessed]
    free = [i for i in free if is_measured(headers[i].name) and not says_another(headers[i].name)]
    clock = guessed["time"] if "time" in guessed else matches["time"].index if "time" in matches else -1
    if len(free) > len(both) and clock in values:
        rates = rates_among({i: values[i] for i in {*free, *places.values()} - {clock}}, values[clock])
        free = [i for i in free if i not in rates]
        moving = [i for i in free if i in rates.values()]
        if "deflection" in both and len(moving) == 1:
            guessed["deflection"] = moving[0]
            both.remove("deflection")
            free.remove(moving[0])
    strained = [h for h in headers if is_strained(h.name) and not _states(h, "deflection")]
    if len(free) >= len(both) > len(strained):
        # Of many columns the first ones: of trials side by side those of one trial.
        sized = sorted(
            free[: len(both)],
            key=lambda i: (
                not driven(values[i]),
                not _goes_on(values[i]),
                float(np.nanmax(np.abs(values[i]))),
            ),
        )
        guessed |= dict(zip(both, sized, strict=True))
    return guessed
