"""The zeros of the gauges: given and subtracted on reading, or seen to be off and proposed in a command."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from radialtire.model import DEFLECTION_HIGHEST

from ..names import plain
from .assignments import assignments
from .channels import UNIT_OF, known_channel
from .formats import RecordingError
from .formats.table import quoted
from .origin import Origin
from .units import UnitError, parse_quantity

ZEROED = ("deflection", "force")
"""The channels of which a zero is subtracted."""

EXAMPLE = "deflection=30mm"

EARLY, EARLY_PART = 2e-3, 0.08
"""The force begins at another deflection than zero where it is farther away than this [m], this part of the stroke."""

FARTHEST = 0.01
"""Neither a tire's zero nor a part's gap is farther off than this [m]: beyond, the gauge was not set to zero."""


LOWEST = 0.003
"""The force at the least deflection is told by the readings in this part of the stroke."""

SURE = 3.0
"""Standard errors within which a slope or a force is none."""


@dataclass(frozen=True)
class Zero:
    """Where the force begins [m], and how far the deflection goes beyond that [m].

    low [m], force [N]: the least deflection and the force at it; where the force begins before, that is not seen but
    an extrapolation
    """

    begins: float
    stroke: float
    low: float
    force: float

    @property
    def seen(self) -> bool:
        """Whether the readings reach to where the force begins."""
        return self.begins >= self.low - 0.01 * self.stroke

    @property
    def off(self) -> bool:
        """Whether it is so far from zero that something has to be said."""
        return abs(self.begins) > self._near

    @property
    def far(self) -> bool:
        """Whether no effect holds it: an extrapolation is no reason where the readings begin near zero."""
        return abs(self.begins) > FARTHEST and (self.seen or abs(self.low) > FARTHEST)

    @property
    def _near(self) -> float:
        return max(EARLY, EARLY_PART * self.stroke)

    @property
    def shown(self) -> str:
        """Where the force begins, in mm."""
        return millimetres(self.begins, self.stroke)

    def readings(self) -> dict[str, float]:
        """Return what each gauge reads [SI] when nothing is loaded; of an extrapolation where the readings begin."""
        if self._of_deflection:
            return {"deflection": round(self.begins, 4)}
        moved = {} if abs(self.low) <= self._near else {"deflection": round(self.low, 4)}
        return {**moved, "force": float(f"{self.force:.3g}")}

    def sentence(self) -> str:
        """Return where the force begins, or that it is not seen."""
        if self.seen:
            return f"the force begins at {self.shown} of deflection"
        before = f", and it would begin at {self.shown}" if self._of_deflection else ""
        low = millimetres(self.low, self.stroke)
        return f"the readings begin at {low} of deflection with a force of {plain(self.force, 3)} N{before}"

    @property
    def _of_deflection(self) -> bool:
        return self.seen or self._near < abs(self.low) <= FARTHEST


@dataclass(frozen=True)
class Gauges:
    """The gauges of a recording: what they read at their zeros [SI], as they count; those that were turned.

    names: how the options call the column of each channel
    """

    origin: Origin
    zeros: Mapping[str, float] = field(default_factory=dict)
    turned: frozenset[str] = frozenset()
    names: Mapping[str, str] = field(default_factory=dict)

    def columns(self, flipped: str = "") -> dict[str, str]:
        """Return both columns with their signs as the options name them, one of them the other way round."""
        return {
            name: ("-" if (name in self.turned) != (name == flipped) else "+") + self.names[name]
            for name in ZEROED
        }

    def signed(self, flipped: str = "") -> str:
        """Return the option that names both columns with their signs, with one of them the other way round."""
        return self.origin.columns(**self.columns(flipped))

    def at_zero(self, more: Mapping[str, float]) -> dict[str, str]:
        """Return the zeros to give, where after those that are given so much more [SI] is left."""
        found = dict(self.zeros)
        for name, value in more.items():
            found[name] = found.get(name, 0.0) + (-value if name in self.turned else value)
        return {name: quantity_text(name, value) for name, value in found.items()}

    def doubt(self, zero: Zero) -> str:
        """Return the sentence of a zero that is off, with what to write; "" where it is not."""
        if not zero.off:
            return ""
        readings = zero.readings()
        whose = "the gauges' zeros" if len(readings) > 1 else "the gauge's zero"
        other = "" if zero.far else ", or let the diagnosis find the offset"
        return f"{zero.sentence()}: if that is {whose}, say so: {self.origin.zero(self.at_zero(readings))}{other}"

    def refusal(self, zero: Zero) -> str:
        """Return why no effect holds a zero, and the next step; "" where one does."""
        if not zero.far:
            return ""
        most = millimetres(FARTHEST, FARTHEST)
        return (
            f"{zero.sentence()}, and what is farther off than {most} is the gauge's zero; give it: "
            f"{self.origin.zero(self.at_zero(zero.readings()))}"
        )


class _Named(Protocol):
    @property
    def name(self) -> str: ...


class _Driven(_Named, Protocol):
    @property
    def time(self) -> NDArray[np.float64]: ...
    @property
    def deflection(self) -> NDArray[np.float64]: ...
    @property
    def timed(self) -> bool: ...


def force_at_least(deflection: NDArray[np.float64], force: NDArray[np.float64]) -> tuple[float, float]:
    """Return the force [N] at the least deflection, and its uncertainty [N]. `deflection`, `force`: (samples,).

    A straight line through the nearer half of the first stretch (`LOWEST`) is extrapolated to it. Where that through
    the whole stretch ends elsewhere, as of a force that rises steeply and then less so, it is uncertain by that too.
    """
    beyond = deflection - float(deflection.min())
    reach = LOWEST * float(beyond.max())
    (near, error), (whole, _) = (
        _line_at_zero(beyond[beyond <= r], force[beyond <= r]) for r in (0.5 * reach, reach)
    )
    return near, SURE * error + abs(near - whole)


def _line_at_zero(x: NDArray[np.float64], f: NDArray[np.float64]) -> tuple[float, float]:
    """Return where a line through points meets x = 0, and its standard error; the mean where no slope shows."""
    centred, mean = x - x.mean(), float(f.mean())
    spread, above = float(centred @ centred), f - mean
    if x.size > 2 and spread > 0.0:
        slope = float(centred @ above) / spread
        left = above - slope * centred
        variance = float(left @ left) / (x.size - 2)
        if slope**2 * spread > SURE**2 * variance:
            return mean - slope * float(x.mean()), math.sqrt(
                variance * (1.0 / x.size + x.mean() ** 2 / spread)
            )
    return mean, math.sqrt(float(above @ above) / max(x.size - 1, 1) / x.size)


def refuse_far_zeros(recordings: Iterable[_Named]) -> None:
    """Raise RecordingError where the zero of a recording is so far off that no effect holds it.

    Beside a simulation that stands in the recording the zero may be that of both.
    """
    for recording in recordings:
        far = getattr(recording, "far_zero", "")
        if far and getattr(recording, "believed_force", None) is None:
            raise RecordingError(f"{recording.name}: {far}")


def refuse_too_deep(recordings: Iterable[_Driven]) -> None:
    """Raise RecordingError where a deflection is beyond the wheel's radius, which no tire and no FMU of one takes."""
    for recording in recordings:
        deepest = int(np.argmax(recording.deflection))
        if recording.deflection[deepest] <= DEFLECTION_HIGHEST:
            continue
        at = f"{plain(recording.time[deepest], 6)} s" if recording.timed else f"sample {deepest + 1}"
        least = float(f"{recording.deflection.min():.3g}")
        zero = f", such as --zero deflection={quantity_text('deflection', least)}" if least > FARTHEST else ""
        raise RecordingError(
            f"{recording.name}: the deflection is {plain(recording.deflection[deepest], 6)} m at {at}, and a tire "
            f"takes {DEFLECTION_HIGHEST:g} m at most (the wheel's radius); check its unit, count a part that is pulled "
            "further as negative (--columns 'deflection=-NAME,force=-NAME'), give what the gauge reads when nothing is "
            f"loaded{zero}, or choose a range of the file: FILE@10s:20s (times), FILE@100:2000 (rows)"
        )


def parse_zeros(texts: Iterable[str]) -> dict[str, str]:
    """Return channel -> zero from texts such as `deflection=30mm`; as for `zero_in_si`, checked."""
    found = assignments(",".join(texts), "--zero", EXAMPLE, known_channel)
    for name, text in found.items():
        zero_in_si(name, text, "--zero")
    return found


def zero_in_si(name: str, text: str, where: str) -> float:
    """Return the zero of a channel [SI]. Errors: RecordingError for a channel without one, or what is no such unit."""
    if name not in ZEROED:
        raise RecordingError(
            f"{where}: {quoted(name)} has no zero that is subtracted; those are {' and '.join(ZEROED)}"
        )
    try:
        return parse_quantity(str(text), UNIT_OF[name])
    except UnitError as error:
        what = str(error).partition("; ")[0]
        raise RecordingError(
            f"{where}, {name}: {what}; write what `tirelab inspect` shows there with its unit, such as {EXAMPLE}"
        ) from None


def quantity_text(name: str, value: float) -> str:
    """Return a zero [SI] as people write it: 30mm, 200N."""
    return f"{1e3 * value:.9g}mm" if name == "deflection" else f"{value:.9g}N"


def millimetres(length: float, stroke: float) -> str:
    """Return a length [m] in mm, to the tenth of one or of a shorter stroke [m]."""
    decimals = max(1, 1 - math.floor(math.log10(max(1e3 * stroke, 1e-12))))
    return f"{round(1e3 * length, decimals) + 0.0:.{decimals}f} mm"
