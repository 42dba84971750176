"""One number of a law or an effect: its name, its meaning and its allowed values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from .prior import Prior

Role = Literal["strength", "form", "limit", "reading"]


class ParameterError(ValueError):
    """A parameter's value is not allowed; the sentence names it, its value and what is allowed."""


@dataclass(frozen=True)
class Parameter:
    """The description of one parameter.

    name: the word used in code, tire files and the FMU
    symbol: the letter used in its equation
    unit: the unit in which the value is stored ("1" for a pure number)
    start: the value where nothing else is said
    minimum, maximum: the closed interval of allowed values
    meaning: one line for a reader who does not know the equation
    neutral: the value at which the effect it belongs to vanishes exactly, or None
    nominal: a value of usual size, where the start is not one
    role: "strength" (the response vanishes with it), "limit" (it vanishes beyond it), "form", or "reading" (it follows
    from the noise of the reading and is not fitted); prior: its distribution before any recording
    optional: whether the simplest form of the equation omits it; a fit keeps it at its start unless it is needed
    """

    name: str
    symbol: str
    unit: str
    start: float
    minimum: float
    maximum: float
    meaning: str
    neutral: float | None = None
    nominal: float | None = None
    optional: bool = False
    role: Role = "form"
    prior: Prior | None = None

    @property
    def nominal_value(self) -> float:
        """The nominal value, or the start where none is given."""
        return self.start if self.nominal is None else self.nominal

    def checked(self, value: float) -> float:
        """Return `value` as a float, or raise ParameterError if it is not a number within the bounds."""
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ParameterError(f"{self.name} = {value!r} is not a number; {self.allowed()}")
        if not self.minimum <= value <= self.maximum:
            raise ParameterError(f"{self.name} = {value:.17g} is not allowed; {self.allowed()}")
        return float(value)

    def allowed(self) -> str:
        """Return the clause that says which values are allowed."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        if math.isinf(self.maximum):
            return f"it must be at least {self.minimum:g}{unit}"
        return f"it must lie between {self.minimum:g} and {self.maximum:g}{unit}"
