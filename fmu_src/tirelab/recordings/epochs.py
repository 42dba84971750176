"""From which day a clock of large numbers counts: 1970, 1904, or the first day of a spreadsheet or of MATLAB."""

from __future__ import annotations

import datetime
from dataclasses import dataclass

from .clock_doubt import DAY, YEAR_2001, YEAR_2096

BEGIN_OF_2000 = datetime.date(2000, 1, 1).toordinal()
BEGIN_OF_2100 = datetime.date(2100, 1, 1).toordinal()
"""The days between which a recording is made, as Python counts days."""

SHORTLY_AFTER_1904 = (3.03e9, YEAR_2096)
"""Seconds since 1904 from 2000 on [s]; as seconds since 1970 they are of 2066 on."""


@dataclass(frozen=True)
class CountedDays:
    """Days as a program counts them: what they are called, and the day 0 of them as Python counts days."""

    said: str
    zero: int

    def of_a_recording(self, days: float) -> bool:
        """Whether a number of days is of this century."""
        return BEGIN_OF_2000 <= days + self.zero < BEGIN_OF_2100


DAYS_OF = (
    CountedDays("of a spreadsheet", datetime.date(1899, 12, 30).toordinal()),
    CountedDays("of MATLAB", -366),
    CountedDays("since 1970", datetime.date(1970, 1, 1).toordinal()),
)
"""Who counts days; the first one whose number is of this century is meant."""


def began(first: float, one: float) -> str:
    """Return when a clock began that counts from a known day: `1748959500.250000 s since 1970`; "" for any other.

    first [s]: its first reading; one [s]: the size of its unit
    """
    if one == DAY:
        days = first / DAY
        for counted in DAYS_OF:
            if counted.of_a_recording(days):
                date = datetime.datetime.fromordinal(counted.zero + int(days))
                date += datetime.timedelta(days=days % 1.0)
                return f"day {days:.6f} {counted.said} ({date:%Y-%m-%d %H:%M:%S})"
        return ""
    if SHORTLY_AFTER_1904[0] <= first <= SHORTLY_AFTER_1904[1]:
        return f"{first:.6f} s since 1904"
    return f"{first:.6f} s since 1970" if YEAR_2001 <= first <= YEAR_2096 else ""
