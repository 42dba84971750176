"""A simulated force that stands in the recordings, as the simulation beside which effects are looked for.

Its elastic law is identified from it as from a recording. What is diagnosed is

    F - F_believed + law(x)

with that law as the baseline: the misfit is that of the simulation, F - F_believed, whatever it holds beside
its law, and effects that grow with the load know the load. The corrected simulation is

    F_believed + corrected tire - law
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray
from radialtire import TireModel

from ..errors import TirelabError
from ..identification.identify import identify
from ..recordings.recording import Recording
from ..simulation.simulate import simulate

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Believed:
    """The law of a believed force, and the recordings with it in the force's place.

    tire: of the law; rmse [N]: what it leaves of the believed force; fitted, kept: F - F_believed + law
    """

    tire: TireModel
    rmse: float
    fitted: tuple[Recording, ...]
    kept: tuple[Recording, ...]

    def notes(self) -> list[str]:
        """Return what a reader of the figures has to know."""
        return [
            "the effects are those beside the simulated force in the recordings: force stands for recorded minus "
            f"simulated force plus the law of the latter ({self.tire.law.name}, which leaves {self.rmse:.3g} N of it); "
            "the corrected simulation is in the files *.corrected.csv, and runs as the simulation plus the force of "
            "BicycleTire.fmu less that of believed/BicycleTire.fmu"
        ]


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
        found = identify([replace(r, force=_believed(r)) for r in fitted], name="the believed simulation")
    except TirelabError as error:
        raise TirelabError(f"the simulated force follows no law of a tire: {error}") from None
    beside = [replace(r, force=r.force - _believed(r) + simulate(found.tire, r)) for r in every]
    return Believed(found.tire, found.rmse, tuple(beside[: len(fitted)]), tuple(beside[len(fitted) :]))


def write_corrected(folder: Path, believed: Believed, corrected: TireModel) -> None:
    """Write each recording with its recorded, simulated and corrected force into `folder`, as NAME.corrected.csv."""
    for r in (*believed.fitted, *believed.kept):
        law = simulate(believed.tire, r)
        simulated = _believed(r)
        columns = {
            "time [s]": r.time,
            "deflection [m]": r.deflection,
            "radius [m]": r.surface_radius,
            "force [N]": r.force + simulated - law,
            "believed_force [N]": simulated,
            "corrected_force [N]": simulated + simulate(corrected, r) - law,
        }
        pl.DataFrame(columns).write_csv(folder / f"{r.name}.corrected.csv")


def _believed(recording: Recording) -> FloatArray:
    force = recording.believed_force
    assert force is not None
    return force
