"""The diagnosis of a user's own simulation: its elastic law as the baseline, and its correction as an FMU.

The simulated force stands in the recordings or comes from an FMU. Its elastic law is identified from it as from a
recording: the law of a tire on the ground or, for a part that pulls or does not follow such a law, the straight line of
a part that is held at both ends (that of a damper has hardly any slope). Where the recorded part pulls and the
simulation was never driven below a deflection of 0, its law is continued there as that of a part held at both ends:
nothing that is known of it changes, and a law of the ground could not follow the recording. What is diagnosed is

    F - F_believed + law(x)

with that law as the baseline. The misfit is then F - F_believed, that of the simulation, whatever it contains besides
its law, and effects that grow with the load have the load. Effects before the elastic law (an offset or a lag of the
deflection, a series spring) change the deflection that the simulation is given; all others are an additional force:

    F = F_simulation(x_t) + corrected tire(x) - law(x_t),    x_t = x after the effects before the law

Where only the simulated force is known, as a column of the recording, x_t = x and every effect is an additional force.
So it is if changing the deflection leaves an error more than FORCE_FROM times that of the additional force: the law
then does not represent the stiffness of the simulation.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel

from ..errors import TirelabError
from ..fmu.build import Correction, build_correction
from ..fmu.foreign import TIMEOUT, ForeignFmu
from ..fmu.foreign_replay import Progress, native_code, replay_foreign
from ..fmu.replay import driven
from ..fmu.system import SYSTEM, write_system
from ..identification.identify import identify
from ..identification.part_tire import LEAST_SPRING, holds_air
from ..identification.surfaces import CM_PER_M
from ..preprocessing.noise import NEGLIGIBLE
from ..recordings.recording import Recording
from ..report.titles import newtons
from ..simulation.simulate import UPSTREAM, SmoothedMotion, simulate
from .held_out import rmse
from .outcome import Replayed
from .summary import errors_told
from .verdict import Verdict

FloatArray = NDArray[np.float64]


NAME = "the believed simulation"


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
    pull = [_pulls(r.force) for r in recordings]
    if not all(pull) or not all(_pulls(r.force) for r in simulated):
        with suppress(TirelabError):
            tire = identify(simulated, name=NAME).tire
            return _continued(tire, simulated) if any(pull) else tire
    return _straight(simulated)


def _continued(tire: TireModel, simulated: Sequence[Recording]) -> TireModel:
    """Return the law of a part held at both ends, unless the simulated force is known below 0 and is that of ground."""
    held = replace(tire, two_sided=True, inflated=holds_air(simulated))
    left = [rmse([r.force - simulate(law, r) for r in simulated]) for law in (held, tire)]
    return held if left[0] <= left[1] else tire


def _pulls(force: FloatArray) -> bool:
    """Return whether a force [N] (n,) is one that no ground exerts, for more than noise and an amplifier's zero."""
    return float(np.quantile(force, NEGLIGIBLE)) < -NEGLIGIBLE * float(np.max(np.abs(force)))


def _straight(simulated: Sequence[Recording]) -> TireModel:
    """Return the straight line through the forces, of a part that is held at both ends; a slope below 0 is none."""
    x, force = (np.concatenate([getattr(r, c) for r in simulated]) for c in ("deflection", "force"))
    if not np.ptp(x) > 0.0:
        raise TirelabError("the recordings have one constant deflection; record at least one full cycle")
    slope = float(np.polyfit(x, force, 1)[0]) / CM_PER_M
    slope = max(slope, LEAST_SPRING)
    preload = float(np.mean(force - slope * CM_PER_M * x))
    law = PowerLaw(slope, 1.0)
    return TireModel(
        law,
        tested_range=None,
        name=NAME,
        source=NAME,
        two_sided=True,
        preload=preload,
        inflated=holds_air(simulated),
    )


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
    _refuse_other_units(model, with_force)
    found = believed_of(with_force[: len(fitted)], with_force[len(fitted) :])
    assert found is not None
    return replace(found, model=model, timeout=timeout)


FAR_OFF = 1000.0**0.5
"""Factor between recorded and simulated force from which their units are in doubt: the root of that from N to kN."""


def _refuse_other_units(model: ForeignFmu, recordings: Sequence[Recording]) -> None:
    """Refuse a force of another size than the recorded one, of a model that does not say its units."""
    if model.deflection.unit and model.force.unit:
        return
    recorded, simulated = (
        float(np.sqrt(np.mean(np.concatenate(forces) ** 2)))
        for forces in ([r.force for r in recordings], [believed_force(r) for r in recordings])
    )
    if simulated * FAR_OFF > recorded and recorded * FAR_OFF > simulated:
        return
    x, force = model.deflection, model.force
    raise TirelabError(
        f"{model.path}: its force is {newtons(simulated)} RMS where {newtons(recorded)} were recorded, and it does not "
        f"say all its units; say them with --variables 'deflection={x.name} [{x.unit or 'mm'}],force={force.name} "
        f"[{force.unit or 'kN'}]', or [m] and [N] if they are right"
    )


def believed_force(recording: Recording) -> FloatArray:
    """Return the simulated force [N] of a recording that has one."""
    force = recording.believed_force
    assert force is not None
    return force


CORRECTION = "Correction.fmu"

FORCE_FROM = 1.1
"""Error with the other deflection over that with the additional force from which the force is delivered."""


@dataclass(frozen=True)
class Corrected:
    """A simulation of others with what it lacks.

    fmu, system: the files that were written, system None where the simulation is no FMU
    forces: [N] on the fitted recordings, where they are known already; remark: for the reader, or nothing
    """

    believed: Believed
    correction: Correction
    fmu: Path
    system: Path | None
    forces: tuple[FloatArray, ...] = ()
    remark: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry `correction` of diagnosis.json."""
        model = self.believed.model
        return {
            "fmu": CORRECTION,
            "system": None if self.system is None else SYSTEM,
            "simulation": None if model is None else model.path.name,
            "variables": {}
            if model is None
            else {"deflection": model.deflection.name, "force": model.force.name},
            **self.correction.to_dict(),
        }

    def notes(self) -> list[str]:
        """Return what a reader of the figures has to know."""
        held = " of a part held at both ends" if self.believed.tire.two_sided else ""
        law = f"{self.believed.tire.law.name}{held}, which leaves {newtons(self.believed.rmse)} of it"
        runs = "as the simulated force plus the output additional_force of Correction.fmu, given the same deflection"
        if self.system is not None:
            runs = f"as {SYSTEM}, which couples {_name(self.believed)} with Correction.fmu"
            if self.correction.moves:
                runs += " (it is given the deflection that Correction.fmu returns: an effect acts before it)"
        return [
            "the effects are those beside the simulation: force stands for recorded minus simulated force plus the law "
            f"of the latter ({law}); the corrected simulation is in the files *.corrected.csv, and runs {runs}",
            *([self.remark] if self.remark else []),
        ]

    def replayed(self, recordings: Sequence[Recording], report: Progress) -> Replayed:
        """Return the recordings with the forces before and after, as they stand in `Believed.fitted`."""
        before, after = [], []
        known = dict(zip((r.name for r in self.believed.fitted), self.forces, strict=False))
        for r in recordings:
            law = simulate(self.believed.tire, r)
            before.append(law)
            force = known[r.name] if r.name in known else self.force(r, report)
            after.append(force - believed_force(r) + law)
        return Replayed(tuple(recordings), tuple(before), tuple(after))

    @staticmethod
    def told(verdict: Verdict, fitted: Replayed, held_out: Replayed) -> Verdict:
        """Return the verdict with the errors [N] that the correction has in replays of the FMUs: the diagnosis itself
        knows the simulation by its law alone.
        """
        errors = {
            f"{of}{when}": one.rmse(forces)
            for of, one in (("", fitted), ("held_out_", held_out))
            for when, forces in (("before", one.before), ("after", one.after))
        }
        known: dict[str, Any] = {name: error for name, error in errors.items() if error is not None}
        fit = replace(verdict.fit, **known)
        named, unexplained = bool(verdict.effects), bool(verdict.residual_models)
        told, anew = (errors_told(named, unexplained, errors) for errors in (verdict.fit, fit))
        return replace(verdict, fit=fit, summary=verdict.summary.replace(told, anew))

    def force(self, recording: Recording, report: Progress) -> FloatArray:
        """Return the force [N] of the simulation with its correction, from the FMUs themselves."""
        r = recording
        report(f"replaying the corrected simulation on {r.name}")
        inputs = {"deflection": r.deflection, "surface_radius": r.surface_radius}
        simulated = believed_force(r)
        if self.correction.moves and self.believed.model is not None:
            x = driven(self.fmu, r.time, inputs, "tire_deflection")
            still = np.zeros_like(x)
            moved = SmoothedMotion(r.time, x, r.surface_radius, still, still)
            simulated = replay_foreign(self.believed.model, moved, r.name, self.believed.timeout, report)
        return driven(self.fmu, r.time, {**inputs, "simulated_force": simulated}, "corrected_force")


def deliver(folder: Path, believed: Believed, corrected: TireModel, report: Progress) -> Corrected:
    """Write the correction's FMU into `folder`, and for the FMU of others the system of both."""
    if believed.model is None or not any(e.place in UPSTREAM for e, _ in corrected.effects):
        return _written(folder, believed, corrected, False)
    moved = _written(folder, believed, corrected, True)
    forces = tuple(moved.force(r, report) for r in believed.fitted)
    pairs = list(zip(believed.fitted, forces, strict=True))
    with_other = rmse([r.force + believed_force(r) - simulate(believed.tire, r) - f for r, f in pairs])
    with_force = rmse([r.force - simulate(corrected, r) for r in believed.fitted])
    if with_other <= FORCE_FROM * with_force:
        return replace(moved, forces=forces)
    remark = (
        "an effect acts before the simulation, yet is delivered as an additional force: given the other deflection the "
        f"simulation leaves {newtons(with_other)}, with the force {newtons(with_force)}"
    )
    return replace(_written(folder, believed, corrected, False), remark=remark)


def _written(folder: Path, believed: Believed, corrected: TireModel, moves: bool) -> Corrected:
    surfaces = np.unique(np.concatenate([r.surface_radius for r in (*believed.fitted, *believed.kept)]))
    correction = Correction(believed.tire, corrected, float(surfaces[-1]), moves)
    fmu = build_correction(correction, folder).path
    system = None
    if believed.model is not None:
        system = write_system(believed.model, fmu, folder, moves=moves, surfaces=surfaces.size > 1)
    return Corrected(believed, correction, fmu, system)


NO_NAME = r'[<>:"/\\|?*\x00-\x1f]+'
"""What no file's name may hold on some system."""


def write_corrected(folder: Path, replayed: Replayed) -> None:
    """Write each recording with its recorded, simulated and corrected force into `folder`, as NAME.corrected.csv.

    What a name may not hold, as that of a part of a file does ("press@10s:20s"), is "_" there.
    """
    for r, law, after in zip(replayed.recordings, replayed.before, replayed.after, strict=True):
        simulated = believed_force(r)
        columns: Mapping[str, FloatArray] = {
            "time [s]": r.time,
            "deflection [m]": r.deflection,
            "radius [m]": r.surface_radius,
            "force [N]": r.force + simulated - law,
            "believed_force [N]": simulated,
            "corrected_force [N]": after + simulated - law,
        }
        name = re.sub(NO_NAME, "_", r.name).lstrip(".")
        pl.DataFrame(columns).write_csv(folder / f"{name}.corrected.csv")


def _name(believed: Believed) -> str:
    return "the simulation" if believed.model is None else believed.model.path.name
