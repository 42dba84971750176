"""A motion with the channels that `simulate` and `replay` take, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """Arrays of one length: time [s], deflection [m], surface radius [m]; measured channels by their names."""

    time: FloatArray
    deflection: FloatArray
    surface_radius: FloatArray
    measured: Mapping[str, FloatArray] = field(default_factory=dict)
