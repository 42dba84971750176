"""A recording written as CSV in the house form, from which it is read again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .channels import UNIT_OF
from .formats import RecordingError
from .recording import Recording
from .units import conversion

FloatArray = NDArray[np.float64]

_HOUSE_UNITS = {**UNIT_OF, "deflection": "cm", "radius": "cm", "pressure": "kPa"}

_SIGNIFICANT_DIGITS = 12


def write_recording(recording: Recording, path: Path | str) -> None:
    """Write a recording as CSV in the house form, `time [s],deflection [cm],radius [cm],force [N]`.

    Pressure [kPa] (gauge), temperature [K] and speed [m/s] follow where there are any. Numbers have 12
    significant digits: reading the file again gives each value within 1e-11 of itself.
    Errors: RecordingError when the file cannot be written.
    """
    frame = {}
    for name, values in recording.channels():
        convert = conversion(_HOUSE_UNITS[name], UNIT_OF[name])
        frame[f"{name} [{convert.unit}]"] = _rounded(values * convert.divide / convert.multiply)
    try:
        pl.DataFrame(frame).write_csv(Path(path))
    except OSError as error:
        raise RecordingError(
            f"{path}: cannot be written ({error}); check the folder and its permissions"
        ) from None


def _rounded(values: FloatArray) -> FloatArray:
    """The values to 12 significant digits, so that 2.54 is not written as 2.5400000000000005."""
    # Beyond these magnitudes the scale itself would overflow, and no measurement is that small.
    sized = np.isfinite(values) & (np.abs(values) > 1e-250)
    digits = np.zeros(values.shape)
    np.log10(np.abs(values), out=digits, where=sized)
    scale = 10.0 ** (_SIGNIFICANT_DIGITS - 1 - np.floor(digits))
    return np.where(sized, np.round(values * scale) / scale, values)
