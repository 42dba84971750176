"""The coordinates of compared blocks over which a remainder may depend."""

from __future__ import annotations

import numpy as np

from ..preprocessing.motion import FloatArray
from ..preprocessing.straight import is_straight
from ..regressors.dataset import Dataset
from ..regressors.experiment import Experiment


def coordinates_of(dataset: Dataset) -> dict[str, FloatArray]:
    """Return the coordinates by their names, over all compared blocks; none that no recording can show."""
    gather, many = dataset.gathered, dataset.experiments
    found = {
        "deflection": gather([e.deflection for e in many]),
        "rate": gather([e.rate for e in many]),
        "acceleration": gather([e.acceleration for e in many]),
        "time": gather([e.time - e.time[0] for e in many]),
        "force": gather([e.baseline for e in many]),
    }
    if all(_at_one_rate(e) for e in many):
        del found["acceleration"]
    return found


def _at_one_rate(experiment: Experiment) -> bool:
    """Whether a recording was driven at one rate between its turns."""
    turned = np.diff(np.sign(experiment.rate), prepend=np.sign(experiment.rate[0])) != 0.0
    return is_straight(experiment.time, experiment.deflection, ~experiment.counts | turned, experiment.gauge)
