"""What is simulated, beside its motion: the channels that effects read, and the history that it starts with."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from radialtire import CHANNELS
from radialtire.effect import NOT_MEASURED

FloatArray = NDArray[np.float64]


class Sampled(Protocol):
    """What is simulated: arrays of one length, time rising; the channels that effects read as `measured_of` says."""

    @property
    def time(self) -> FloatArray:
        """[s]."""
        ...

    @property
    def deflection(self) -> FloatArray:
        """[m], compressed > 0."""
        ...

    @property
    def surface_radius(self) -> FloatArray:
        """[m], convex > 0, concave < 0, flat infinite."""
        ...


def measured_of(sampled: object) -> Mapping[str, FloatArray]:
    """Return the channels (n,) by name: those of its attribute `measured`, or its attributes of the channels' names.

    A channel that is absent or None was not measured.
    """
    given = getattr(sampled, "measured", None)
    if given is not None:
        return dict(given)
    found = {channel.name: getattr(sampled, channel.name, None) for channel in CHANNELS}
    return {name: values for name, values in found.items() if values is not None}


def begun(sampled: Sampled) -> tuple[Sampled, int]:
    """Return the samples from which a simulation starts, and how many of them lie before those of `sampled`.

    A part of a file has the attributes `history`, what was recorded before it, and `whole`, both together.
    """
    history = getattr(sampled, "history", None)
    return (sampled, 0) if history is None else (sampled.whole, len(history))  # type: ignore[attr-defined]


def channel_rows(measured: Mapping[str, FloatArray], samples: int) -> tuple[FloatArray, ...]:
    """Return every one of CHANNELS (samples,), NOT_MEASURED where it was not recorded."""
    nothing = np.full(samples, NOT_MEASURED)
    return tuple(writable(measured.get(channel.name, nothing)) for channel in CHANNELS)


def writable(values: FloatArray) -> FloatArray:
    """Return values as an array that may be written to: one that may not, as those of a recording, is another type, for
    which each loop would be compiled once more.
    """
    return np.require(values, np.float64, ["C", "W"])
