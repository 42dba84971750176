"""Diagnoses of every kind made by hand: what a report is given, without the engine that finds it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import CATALOGUE, Hull1996, TireModel
from tirelab.recordings.recording import Recording
from tirelab.report.page import Simulated, write_report
from tirelab.simulation.simulate import simulate

NOISE = 6.0
"""Noise [N] of the recordings made here."""


@dataclass(frozen=True)
class Diagnosed:
    """What `write_report` takes."""

    diagnosis: dict[str, Any]
    recordings: list[Recording]
    before: list[NDArray[np.float64]]
    after: list[NDArray[np.float64]]
    held_out: Simulated | None


def ridden(
    name: str, tire: TireModel, seed: int, *, samples: int = 8000, surface: float = np.inf
) -> Recording:
    """A recording of `tire`: triangles at three rates, with noise of the force."""
    rng = np.random.default_rng(seed)
    time = np.arange(samples) * 5e-3
    rate = np.array([1e-3, 8e-3, 6e-2])[np.minimum(3 * np.arange(samples) // samples, 2)]
    phase = np.cumsum(rate) * 5e-3 / (2 * 0.022)
    deflection = 0.022 * (1.0 - np.abs(1.0 - 2.0 * (phase % 1.0)))
    quiet = Recording(name, time, deflection, np.full(samples, surface), np.zeros(samples))
    force = simulate(tire, quiet) + rng.normal(0.0, NOISE, samples)
    return replace(quiet, force=force, source=Path("rig") / f"{name}.csv", notes=("force turned in sign",))


def with_effects(**effects: dict[str, float]) -> TireModel:
    """The article's tire with effects of the catalogue, each by some of its parameters."""
    chosen = []
    for name, given in effects.items():
        effect = CATALOGUE[name]
        chosen.append((effect, tuple(given.get(p.name, p.start) for p in effect.parameters)))
    order = list(CATALOGUE)
    return TireModel(effects=tuple(sorted(chosen, key=lambda e: order.index(e[0].name))))


def _rmse(recordings: Sequence[Recording], simulated: Sequence[NDArray[np.float64]]) -> float:
    residual = np.concatenate([r.force - s for r, s in zip(recordings, simulated, strict=True)])
    return float(np.sqrt(np.mean(residual**2)))


def diagnosed(
    truth: TireModel,
    corrected: TireModel,
    effects: list[dict[str, Any]],
    *,
    surfaces: Sequence[float] = (np.inf, 0.254),
    extra: Callable[[Recording], NDArray[np.float64]] | None = None,
    samples: int = 8000,
    **verdict: Any,
) -> Diagnosed:
    """Recordings of `truth`, the last one held out, with the diagnosis `corrected`."""
    made = [
        ridden(f"ride_{i}", truth, i, samples=samples, surface=s)
        for i, s in enumerate((*surfaces, surfaces[0]))
    ]
    if extra is not None:
        made = [replace(r, force=r.force + extra(r)) for r in made]
    before = [simulate(TireModel(), r) for r in made]
    after = [simulate(corrected, r) for r in made]
    diagnosis = {
        "schema": 2,
        "verdict": {
            "effects": effects,
            "confidence": 0.95,
            "alternatives": [],
            "unexplained": False,
            "remainder": {"share": 0.0, "size": 0.1, "rms": 0.6, "depends_on": []},
            "summary": "Two sentences would stand here. They tell the error before and after.",
            "separating_test": None,
            **{k: v for k, v in verdict.items() if k not in _BESIDE},
        },
        "where": _where(),
        "fit": {
            "noise": NOISE,
            "before": _rmse(made[:-1], before[:-1]),
            "after": _rmse(made[:-1], after[:-1]),
            "held_out_before": _rmse(made[-1:], before[-1:]),
            "held_out_after": _rmse(made[-1:], after[-1:]),
            "load": 1000.0,
        },
        "tire": "tire.json",
        "corrected_fmu": "BicycleTire.fmu",
        "report": "report.html",
        "data": "plots.csv",
        "tire_before": "Hull, Wang & Moore 1996",
        "tire_after": corrected.name,
        "command": "tirelab diagnose ride_0.csv ride_1.csv --held-out ride_2.csv --out out",
        **{k: v for k, v in verdict.items() if k in _BESIDE},
    }
    return Diagnosed(diagnosis, made[:-1], before[:-1], after[:-1], (made[-1:], before[-1:], after[-1:]))


_BESIDE = ("evidence", "reasons", "correction", "waveform", "warnings", "law_changes", "sketches")


def _where() -> list[dict[str, Any]]:
    return [
        {"by": "rate", "from": 0.04, "to": 0.06, "unit": "m/s", "share": 0.48, "mean_residual": 19.3},
        {"by": "direction", "from": -1.5, "to": 0.0, "unit": "1", "share": 0.51, "mean_residual": -9.2},
        {"by": "direction", "from": 0.0, "to": 1.5, "unit": "1", "share": 0.49, "mean_residual": 9.1},
        {"by": "deflection", "from": 0.018, "to": 0.022, "unit": "m", "share": 0.22, "mean_residual": -0.4},
        {"by": "radius", "from": "inf", "to": "inf", "unit": "m", "share": 0.5, "mean_residual": 0.2},
        {"by": "time", "from": 26.7, "to": 40.0, "unit": "s", "share": 0.97, "mean_residual": 0.003},
    ]


def effect(
    name: str, share: float, probability: float = 0.97, **parameters: tuple[float, float | None, str]
) -> dict[str, Any]:
    """An entry of the verdict's effects."""
    told = {p: {"value": v, "std": s, "unit": u} for p, (v, s, u) in parameters.items()}
    return {
        "name": name,
        "parameters": told,
        "share": share,
        "probability": probability,
        "size": 40.0 * share,
    }


def nothing_missing() -> Diagnosed:
    return diagnosed(
        TireModel(), TireModel(), [], evidence=_evidence([], ["force_offset"], ["viscous_damping"])
    )


def one_effect() -> Diagnosed:
    truth = with_effects(viscous_damping={"damping": 900.0})
    found = with_effects(viscous_damping={"damping": 896.0})
    return diagnosed(
        truth,
        found,
        [effect("viscous_damping", 0.99, damping=(896.0, 4.2, "N.s/m"))],
        evidence=_evidence(["viscous_damping"], ["viscous_damping", "force_offset"], ["force_lag"]),
    )


def two_and_another_tire() -> Diagnosed:
    law = Hull1996(flat_coefficient=600.0, flat_exponent=1.38)
    effects = with_effects(
        rate_independent_hysteresis={"slip_force": 30.0, "load_share": 0.02, "reach": 1e-3},
        deflection_offset={"offset": 8e-4},
    ).effects
    tire = TireModel(law=law, effects=effects, name="another tire")
    a, b = (550.9, 600.0, 1.2), (1.422, 1.38, 0.004)
    flat = {k: dict(zip(("before", "after", "std"), v, strict=True)) for k, v in (("A", a), ("B", b))}
    x = np.linspace(0.0, 0.022, 12)
    sketch = {"deflection": x.tolist(), "force": (1e3 * x).tolist()}
    return diagnosed(
        tire,
        tire,
        [
            {
                **effect(
                    "recalibration",
                    0.61,
                    **{"log factor on A, flat": (0.085, 0.003, "1"), "bend": (0.011, 0.004, "1")},
                ),
                "law": [{"radius": "inf", **flat}],
            },
            effect(
                "rate_independent_hysteresis",
                0.27,
                slip_force=(30.1, 0.6, "N"),
                load_share=(0.0199, 0.0008, "1"),
                reach=(1.02e-3, 4e-5, "m"),
            ),
            effect("deflection_offset", 0.12, offset=(8e-4, 2.1e-5, "m")),
        ],
        surfaces=(np.inf, 0.254, -0.381, 0.1, 0.05, 0.4),
        samples=4000,
        confidence=0.74,
        law_changes=[{"radius": np.inf, "deflection": x.tolist(), "difference": (3e3 * x).tolist()}],
        sketches={
            "rate_independent_hysteresis": {
                **sketch,
                "varied": {p: (2e3 * x).tolist() for p in ("slip_force", "load_share", "reach")},
            },
            "deflection_offset": {**sketch, "varied": {"offset": (2e3 * x).tolist()}},
        },
    )


def alternatives() -> Diagnosed:
    found = with_effects(rate_independent_hysteresis={"slip_force": 25.0, "reach": 1e-3})
    time = np.arange(0.0, 60.0, 5e-3)
    return diagnosed(
        found,
        found,
        [
            effect(
                "rate_independent_hysteresis",
                0.98,
                0.56,
                slip_force=(25.0, 0.4, "N"),
                reach=(1e-3, 6e-5, "m"),
            )
        ],
        confidence=0.46,
        alternatives=[["viscous_damping"], ["viscoelastic_relaxation", "recalibration"]],
        alternative_details=[
            {
                "difference": "viscous damping instead of friction loop",
                "probability": 0.3,
                "reason": "one speed only",
                "action": "repeat at 30 mm/s",
            },
            {
                "difference": "+ series spring",
                "probability": 0.07,
                "reason": "no hold",
                "action": "hold 10 s at 14 mm",
            },
        ],
        reasons=["one speed only: repeat at 30 mm/s", "no hold: hold 10 s at 14 mm"],
        separating_test={
            "waveform": "triangles at three rates",
            "duration": 60.0,
            "amplitude": 0.022,
            "rate_max": 0.25,
            "surfaces": ["inf"],
            "between": [["rate_independent_hysteresis"], ["viscous_damping"]],
            "separation": 210.0,
            "sentence": "Drive triangles at three rates to 22 mm on flat ground.",
            "file": "separating_test.csv",
        },
        waveform={
            "time": time.tolist(),
            "deflection": (0.011 - 0.011 * np.cos(time * (0.1 + time / 12))).tolist(),
        },
        evidence=_evidence(["rate_independent_hysteresis"], ["viscous_damping"]),
    )


def unknown() -> Diagnosed:
    x = np.linspace(0.0, 0.022, 40)
    ripple = 25.0 * np.sin(2.0 * np.pi * x / 0.006)
    return diagnosed(
        TireModel(),
        TireModel(),
        [],
        extra=lambda r: np.asarray(25.0 * np.sin(2.0 * np.pi * r.deflection / 0.006)),
        unexplained=True,
        confidence=0.9,
        correction={
            "by": "deflection",
            "unit": "m",
            "x": x.tolist(),
            "force": ripple.tolist(),
            "std": [1.0] * 40,
            "repeats": "It repeats: it explains 88 % of the remainder on held-out blocks of time.",
        },
        warnings=["the corrected FMU and the simulation differ by 3.1 N at most"],
    )


def _evidence(*sets: list[str]) -> list[dict[str, Any]]:
    return [
        {
            "effects": names,
            "log_evidence": -4.5 * i,
            "rmse": 6.01 + 0.3 * i,
            "held_out_rmse": 6.03 + 0.4 * i if i < 2 else None,
            "remark": "chosen" if i == 0 else "",
        }
        for i, names in enumerate(sets)
    ]


KINDS: dict[str, Callable[[], Diagnosed]] = {
    "nothing": nothing_missing,
    "one": one_effect,
    "two": two_and_another_tire,
    "alternatives": alternatives,
    "unknown": unknown,
}


@pytest.fixture(scope="session")
def kinds() -> dict[str, Diagnosed]:
    """A diagnosis of every kind."""
    return {name: make() for name, make in KINDS.items()}


@pytest.fixture(scope="session")
def reports(kinds: dict[str, Diagnosed], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The report of every kind of diagnosis."""
    folder = tmp_path_factory.mktemp("reports")
    for name, made in kinds.items():
        write_report(
            folder / f"{name}.html",
            made.diagnosis,
            made.recordings,
            made.before,
            made.after,
            held_out=made.held_out,
        )
    return {name: folder / f"{name}.html" for name in kinds}
