"""One number of a law or an effect: what it is called, means, and may be."""

from __future__ import annotations

import math
from dataclasses import dataclass


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
    off: the value at which the effect it belongs to vanishes exactly, or None
    typical: an everyday value, where the start is not one
    extra: whether the plain form of the equation does without it; a fit keeps it at its start unless there is need
    """

    name: str
    symbol: str
    unit: str
    start: float
    minimum: float
    maximum: float
    meaning: str
    off: float | None = None
    typical: float | None = None
    extra: bool = False

    @property
    def everyday(self) -> float:
        """The typical value, or the start where that is one."""
        return self.start if self.typical is None else self.typical

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
