"""A simulated force, of the recordings or of an FMU, as the simulation beside which effects are looked for.

Its elastic law is identified from it as from a recording: that of a tire on the ground, or, of a part that pulls or has
no law of a tire, a straight line of a part that is held at both ends (a damper has hardly any slope). What is diagnosed
is

    F - F_believed + law(x)

with that law as the baseline: the misfit is that of the simulation, F - F_believed, whatever it holds beside its
law, and effects that grow with the load know the load. The corrected simulation is

    F_believed + corrected tire - law        (see `correction`)
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel

from ..errors import TirelabError
from ..fmu.foreign import TIMEOUT, ForeignFmu
from ..fmu.foreign_replay import Progress, native_code, replay_foreign
from ..identification.identify import identify
from ..identification.part_laws import LEAST_SPRING
from ..identification.surfaces import CM_PER_M
from ..recordings.recording import Recording
from ..simulation.simulate import simulate
from .held_out import rmse

FloatArray = NDArray[np.float64]

NAME = "the believed simulation"

OFTEN, FAR = 0.05, 0.1
"""A part pulls where a force is below 0 by more than this part of its largest size in at least this part of the
samples: a tire never does, but for noise and the zero of an amplifier."""


@dataclass(frozen=True)
class Believed:
    """The law of a believed force, and the recordings with it in the force's place.

    tire: of the law; rmse [N]: what it leaves of the believed force; fitted, kept: F - F_believed + law
    model: the FMU that the force is of, None where it is a column of the recordings; timeout [s]: of its replay
    """

    tire: TireModel
    rmse: float
    fitted: tuple[Recording, ...]
    kept: tuple[Recording, ...]
    model: ForeignFmu | None = None
    timeout: float = TIMEOUT


def believed_of(fitted: Sequence[Recording], kept: Sequence[Recording]) -> Believed | None:
    """Return the simulation that stands in the recordings, None where there is none.

    Raises TirelabError where only some of them have it, or the force is no number of a part that it could be.
    """
    every = (*fitted, *kept)
    without = [r.name for r in every if r.believed_force is None]
    if len(without) == len(every):
        return None
    if without:
        raise TirelabError(
            f"{', '.join(without)}: has no simulated force; give its column in every recording"
        )
    tire = _law_of(fitted)
    forces = [simulate(tire, r) for r in every]
    left = [f - believed_force(r) for f, r in zip(forces, fitted, strict=False)]
    beside = [replace(r, force=r.force - believed_force(r) + f) for f, r in zip(forces, every, strict=True)]
    return Believed(tire, rmse(left), tuple(beside[: len(fitted)]), tuple(beside[len(fitted) :]))


def _law_of(recordings: Sequence[Recording]) -> TireModel:
    """Return the law of the simulated force, without what else it does."""
    simulated = [replace(r, force=believed_force(r)) for r in recordings]
    if not all(_pulls(r.force) for r in recordings) or not all(_pulls(r.force) for r in simulated):
        with suppress(TirelabError):
            return identify(simulated, name=NAME).tire
    return _straight(simulated)


def _pulls(force: FloatArray) -> bool:
    """Return whether a force [N] (n,) is one that no ground exerts, for more than noise and an amplifier's zero."""
    return float(np.quantile(force, OFTEN)) < -FAR * float(np.max(np.abs(force)))


def _straight(simulated: Sequence[Recording]) -> TireModel:
    """Return the straight line through the forces, of a part that is held at both ends; a slope below 0 is none."""
    x, force = (np.concatenate([getattr(r, c) for r in simulated]) for c in ("deflection", "force"))
    if not np.ptp(x) > 0.0:
        raise TirelabError("the recordings have one constant deflection; record at least one full cycle")
    slope = float(np.polyfit(x, force, 1)[0]) / CM_PER_M
    slope = max(slope, LEAST_SPRING)
    preload = float(np.mean(force - slope * CM_PER_M * x))
    law = PowerLaw(slope, 1.0)
    return TireModel(law, tested_range=None, name=NAME, source=NAME, two_sided=True, preload=preload)


def simulated_by(
    model: ForeignFmu,
    timeout: float,
    fitted: Sequence[Recording],
    kept: Sequence[Recording],
    report: Progress,
) -> Believed:
    """Return the simulation of an FMU, replayed on every recording; timeout [s]: for each.

    Raises TirelabError where the FMU fails or takes longer.
    """
    report(native_code(model))
    with_force = [
        replace(r, believed_force=replay_foreign(model, r, r.name, timeout, report)) for r in (*fitted, *kept)
    ]
    found = believed_of(with_force[: len(fitted)], with_force[len(fitted) :])
    assert found is not None
    return replace(found, model=model, timeout=timeout)


def believed_force(recording: Recording) -> FloatArray:
    """Return the simulated force [N] of a recording that has one."""
    force = recording.believed_force
    assert force is not None
    return force
