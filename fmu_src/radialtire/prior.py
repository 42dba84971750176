"""What is known of a parameter before any recording: a distribution, what it scales with, and where that is from."""

from __future__ import annotations

from dataclasses import dataclass

SHAPES = ("log", "normal")

QUANTITIES = (
    *("1", "force", "travel", "duration", "interval", "rate", "acceleration", "gauge"),
    *("pressure", "temperature"),
)
"""What a recording has: peak force [N], span of the deflection [m], its duration and sampling interval [s], the root
mean squares of the deflection's rate [m/s] and acceleration [m/s^2], the noise of its reading [m], and the median of
each channel [Pa, K] (its usual value where it was not recorded)."""


@dataclass(frozen=True)
class Prior:
    """The distribution of one parameter, cut off at the parameter's bounds.

    shape: "log", a normal law of the logarithm, or "normal"
    centre: the median, a multiple of `scale`
    spread: "log": the standard deviation of the logarithm; "normal": that of the value, a multiple of `scale`
    scale: a quantity of QUANTITIES or a quotient of two of them, such as "force/travel"
    source: where centre and spread come from
    """

    shape: str
    centre: float
    spread: float
    scale: str = "1"
    source: str = "no magnitude was found in the open; wide"

    def __post_init__(self) -> None:
        if self.shape not in SHAPES:
            raise ValueError(f"shape = {self.shape!r} is none of {', '.join(SHAPES)}")
        if not self.spread > 0.0 or (self.shape == "log" and not self.centre > 0.0):
            raise ValueError(f"centre = {self.centre:g} and spread = {self.spread:g} make no distribution")
        if set(self.scale.split("/")) - set(QUANTITIES):
            raise ValueError(f"scale = {self.scale!r} is no quotient of {', '.join(QUANTITIES)}")
