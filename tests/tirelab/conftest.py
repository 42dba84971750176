"""Lets the tests of this folder import its helpers, and writes the files and verdicts that several of them read."""

import math
import sys
import warnings
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fmpy.validation
import pytest
from fmpy.model_description import ModelDescription

sys.path.insert(0, str(Path(__file__).parent))

import numpy as np
from drives import Drive, damped, flat_force, read, ride, saved, triangle
from house_form import HOUSE_FORM, loading, write_rows
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.diagnosis_run import DiagnosisRun, run_diagnosis
from tirelab.diagnosis.verdict import Verdict

TWO_LOOPS = ("viscous_damping", "rate_independent_hysteresis")
"""What is looked for in two rides: `damped_run` is a diagnosis with all of the catalogue."""


@pytest.fixture(scope="session", autouse=True)
def names_are_read_once() -> Iterator[None]:
    """What fmpy found a legal name of a variable is not parsed again in the next FMU: it takes longer than all else."""
    genuine = getattr(fmpy.validation, "_validate_variable_names", None)
    if genuine is None:  # it is fmpy's own: another version may have none of that name
        yield
        return
    legal: set[tuple[str, str]] = set()

    def problems_of(description: ModelDescription) -> list[str]:
        convention, variables = description.variableNamingConvention, description.modelVariables
        new = [variable for variable in variables if (convention, variable.name) not in legal]
        asked = copy(description)
        asked.modelVariables = new
        found: list[str] = genuine(asked) if new else []
        if not found:
            legal.update((convention, variable.name) for variable in new)
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fmpy.validation, "_validate_variable_names", problems_of)
        yield


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    """A clean recording in the house form."""
    time, deflection, force = loading()
    return write_rows(tmp_path / "flat.csv", HOUSE_FORM, time, deflection, [math.inf] * len(time), force)


@pytest.fixture(scope="session")
def cluster() -> Iterator[Any]:
    """A Dask cluster in this process."""
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the cluster's own sockets and event loop
        with distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as local:
            yield local


@dataclass(frozen=True)
class DampedRun:
    """A whole diagnosis of files: the folder of ride.csv (fitted) and kept.csv (held out), and what was written."""

    rides: Path
    out: Path
    run: DiagnosisRun
    stages: tuple[str, ...]

    @property
    def verdict(self) -> Verdict:
        return self.run.verdict


@pytest.fixture(scope="session")
def damped_run(tmp_path_factory: pytest.TempPathFactory) -> DampedRun:
    """A ride with 500 N s/m of damping diagnosed from its file, and another one held out."""
    rides, out = tmp_path_factory.mktemp("rides"), tmp_path_factory.mktemp("damped") / "deep" / "out"
    for name, seed in (("ride", 1), ("kept", 2)):
        saved(damped(seed, samples=4000), rides / f"{name}.csv")
    stages: list[str] = []
    run = run_diagnosis([rides / "ride.csv"], out, held_out=[rides / "kept.csv"], progress=stages.append)
    return DampedRun(rides, out, run, tuple(stages))


@pytest.fixture(scope="session")
def unequal_verdict() -> Verdict:
    """Two rides that are no Recording: 500 N s/m of damping in the first, 200 N s/m in the second; nothing held out."""
    return diagnose([damped(1), damped(2, damping=200.0)], catalogue=TWO_LOOPS)


@pytest.fixture(scope="session")
def alike_verdict() -> Verdict:
    """Two rides with the same 500 N s/m of damping; nothing held out."""
    return diagnose([damped(1), damped(2)], catalogue=TWO_LOOPS)


@pytest.fixture(scope="session")
def complete_verdict() -> Verdict:
    """A ride in which nothing is missing; nothing held out."""
    return diagnose([damped(1, damping=0.0)])


@pytest.fixture(scope="session")
def rippled_verdict() -> Verdict:
    """A ripple of 25 N over the deflection, which no effect explains."""
    time, deflection, _ = ride(5)
    force = flat_force(deflection) + 25.0 * np.sin(2.0 * np.pi * deflection / 0.0035)
    return diagnose([read("ride", time, deflection, force, 6)])


@pytest.fixture(scope="session")
def one_rate_press() -> Drive:
    """Friction on a triangle at one rate on one surface: nothing in it separates friction from viscosity."""
    time, deflection = triangle()
    way = np.where(time / 4.0 % 1.0 < 0.5, 1.0, -1.0)
    force = np.maximum(flat_force(deflection) + 28.0 * way * np.minimum(deflection / 1e-3, 1.0), 0.0)
    return read("press", time, deflection, force, 4)


@pytest.fixture(scope="session")
def one_rate_verdict(one_rate_press: Drive) -> Verdict:
    """The verdict on `one_rate_press`, with its alternatives."""
    return diagnose([one_rate_press])
