"""A simulated force, of the recordings or of an FMU, as the simulation beside which effects are looked for.

Its elastic law is identified from it as from a recording. What is diagnosed is

    F - F_believed + law(x)

with that law as the baseline: the misfit is that of the simulation, F - F_believed, whatever it holds beside
its law, and effects that grow with the load know the load. The corrected simulation is

    F_believed + corrected tire - law        (see `correction`)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel

from ..errors import TirelabError
from ..fmu.foreign import TIMEOUT, ForeignFmu
from ..fmu.foreign_replay import Progress, native_code, replay_foreign
from ..identification.identify import identify
from ..recordings.recording import Recording
from ..simulation.simulate import simulate

FloatArray = NDArray[np.float64]


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

    Raises TirelabError where only some of them have it, or it follows no law.
    """
    every = (*fitted, *kept)
    without = [r.name for r in every if r.believed_force is None]
    if len(without) == len(every):
        return None
    if without:
        raise TirelabError(
            f"{', '.join(without)}: has no simulated force; give its column in every recording"
        )
    try:
        found = identify(
            [replace(r, force=believed_force(r)) for r in fitted], name="the believed simulation"
        )
    except TirelabError as error:
        raise TirelabError(f"the simulated force follows no law of a tire: {error}") from None
    beside = [replace(r, force=r.force - believed_force(r) + simulate(found.tire, r)) for r in every]
    return Believed(found.tire, found.rmse, tuple(beside[: len(fitted)]), tuple(beside[len(fitted) :]))


def simulated_by(
    model: ForeignFmu,
    timeout: float,
    fitted: Sequence[Recording],
    kept: Sequence[Recording],
    report: Progress,
) -> Believed:
    """Return the simulation of an FMU, replayed on every recording; timeout [s]: for each.

    Raises TirelabError where the FMU fails or takes longer, or its force follows no law.
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
