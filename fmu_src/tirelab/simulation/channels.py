"""The channels beside the motion that effects read: which of them something that is simulated holds."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from radialtire import CHANNELS
from radialtire.effect import NOT_MEASURED

FloatArray = NDArray[np.float64]


def measured_of(sampled: object) -> Mapping[str, FloatArray]:
    """Return the channels (n,) by name: those of its attribute `measured`, or its attributes of the channels' names.

    A channel that is absent or None was not measured.
    """
    given = getattr(sampled, "measured", None)
    if given is not None:
        return dict(given)
    found = {channel.name: getattr(sampled, channel.name, None) for channel in CHANNELS}
    return {name: values for name, values in found.items() if values is not None}


def channel_rows(measured: Mapping[str, FloatArray], samples: int) -> tuple[FloatArray, ...]:
    """Return every one of CHANNELS (samples,), NOT_MEASURED where it was not recorded."""
    # Copies: a recording's arrays are read-only, which is another type to the compiled loops.
    nothing = np.full(samples, NOT_MEASURED)
    return tuple(np.array(measured.get(channel.name, nothing), dtype=np.float64) for channel in CHANNELS)
