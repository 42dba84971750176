"""The time between samples as an engineer or the header of a file states it: a rate or an interval."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

import numpy as np

from .units import MAGNITUDE, UnitError, conversion

_RATE = re.compile(
    r"\bsamp(?:l\w*)?[ _](?:frequency|rate)\b\W*(?:(?P<unit>k?Hz)\W+)?(?P<value>\d+(?:\.\d+)?)\W*(?P<behind>k?Hz\b)?",
    re.I,
)
_STEP = re.compile(r"\ADelta_X\s+(?P<value>\d+(?:\.\d+)?(?:E[+-]?\d+)?)\b", re.I)
"""The time between samples [s] in the header of a LabVIEW measurement file (NI, "Specification for the LabVIEW
Measurement File (.lvm)")."""


def parse_interval(text: str | float) -> float:
    """The time between samples [s] from a rate or an interval: "10 Hz", "0.1s", "100 ms", or a number of hertz.

    Errors: UnitError for what is neither, or not positive.
    """
    found = MAGNITUDE.match(str(text).strip())
    unit = found["unit"].strip() if found else ""
    if found is None or (not unit and isinstance(text, str)):
        raise UnitError(
            f"sampling {str(text)[:40]!r} cannot be read; write a rate or an interval: 10Hz, 0.1s"
        )
    value = float(found["value"])
    if unit.lower() in ("", "hz", "khz", "1/s", "s^-1"):
        rate = value * (1e3 if unit.lower() == "khz" else 1.0)
        interval = 1.0 / rate if rate > 0.0 else 0.0
    else:
        interval = float(conversion(unit, "s").to_si(np.array([value]))[0])
    if not (0.0 < interval < math.inf):
        raise UnitError(
            f"sampling {str(text)[:40]!r} is not positive; write a rate or an interval: 10Hz, 0.1s"
        )
    return interval


def sampling_said(lines: Iterable[str]) -> str:
    """Return the rate or the interval that some lines of text state, as "Sample Frequency (Hz): 100": 100Hz; "" where
    none does.

    A number without a unit is none, but for the interval of a LabVIEW measurement file, which is in seconds.
    """
    for line in lines:
        rate, step = _RATE.search(line), _STEP.match(line)
        unit = (rate["unit"] or rate["behind"]) if rate else ""
        if rate and unit:
            return f"{rate['value']}{'kHz' if unit.lower() == 'khz' else 'Hz'}"
        if step and float(step["value"]) > 0.0:
            return f"{float(step['value']):.12g}s"
    return ""
