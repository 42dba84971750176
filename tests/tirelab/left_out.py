"""Clear recordings of every effect of the catalogue, and the diagnosis with and without it in the catalogue.

Run as a program it prints the table of all of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from drives import Drive, FloatArray
from radialtire import CATALOGUE, Recalibrated, TireModel
from scipy.ndimage import uniform_filter1d
from tirelab.diagnosis.diagnose import catalogue_names, diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.simulation.simulate import simulate

NOISE = 6.0
"""Noise of the force [N]; every effect below changes the force by four to forty-five times as much (RMS)."""

PARAMETERS: dict[str, dict[str, float]] = {
    "deflection_offset": {"offset": 8e-4},
    "deflection_drift": {"drift": -2e-5},
    "deflection_lag": {"lag": 0.01},
    "force_offset": {"offset": 45.0},
    "rate_independent_hysteresis": {"slip_force": 35.0, "load_share": 0.02},
    "viscous_damping": {"damping": 700.0},
    "viscoelastic_relaxation": {"share_1": 0.1, "relaxation_time_1": 0.4},
    "series_compliance": {"compliance": 1.2e-6},
    "gas_compression": {"lost_volume": 0.12},
    "bottoming": {"stiffness": 2e5, "onset": 0.0195},
    "mullins_softening": {"share": 0.14},
    "permanent_set": {"share": 0.05},
    "pressure_leak": {"rate": 5e-3},
    "warm_up": {"gain": 0.12, "time_constant": 12.0},
    "force_drift": {"drift": 3.0},
    "inertia": {"mass": 25.0},
    "force_lag": {"lag": 0.012, "delay": 0.0},
    "saturation": {"limit": 1000.0},
}


def left_out(name: str) -> TireModel:
    """Return the article's tire with the effect `name`, or with another tire's law."""
    if name == "recalibration":
        return TireModel(law=Recalibrated(surfaces=((float("inf"), 0.09, -0.03), (0.08, 0.07, -0.02))))
    effect = CATALOGUE[name]
    values = tuple(PARAMETERS[name].get(p.name, p.start) for p in effect.parameters)
    return TireModel(effects=((effect, values),))


def motions(seed: int) -> list[tuple[float, FloatArray, FloatArray]]:
    """Return radius [m], time [s] and deflection [m] of a ride to 9 Hz and of presses at three rates with holds."""
    rng = np.random.default_rng(seed)
    time = np.arange(12000) * 0.0025
    frequencies = np.geomspace(0.15, 9.0, 10)
    phases = rng.uniform(0.0, 2.0 * np.pi, 10)
    sway = np.sin(2.0 * np.pi * frequencies * time[:, None] + phases) @ (0.0026 / (1.0 + 0.35 * frequencies))
    knots = [(0.0, 0.0)]
    for peak, rate in (
        (0.009, 0.005),
        (0.016, 0.02),
        (0.016, 0.02),
        (0.023, 0.1),
        (0.023, 0.1),
        (0.023, 0.02),
        (0.023, 0.1),
    ):
        at = knots[-1][0]
        knots += [
            (at + peak / rate, peak),
            (at + peak / rate + 1.5, peak),
            (at + 2.0 * peak / rate + 1.5, 0.0),
        ]
    press = np.arange(0.0, knots[-1][0], 0.0025)
    path = np.interp(press, [k[0] for k in knots], [k[1] for k in knots])
    # No machine turns within a sample: 0.1 s of rounding keep the accelerations at 1 m/s^2.
    rounded = uniform_filter1d(uniform_filter1d(path, 20, mode="nearest"), 20, mode="nearest")
    return [
        (float("inf"), time, 0.0125 + sway),
        (0.08, press, rounded),
    ]


def forces(name: str, bare: Drive) -> FloatArray:
    """Return the force [N] of the tire with the effect `name`, without noise.

    A mass feels the acceleration of its own moment; a tire that is stepped knows that of its last samples only.
    """
    if name == "inertia":
        acceleration = np.gradient(np.gradient(bare.deflection, bare.time), bare.time)
        return simulate(TireModel(), bare) + PARAMETERS[name]["mass"] * acceleration
    return simulate(left_out(name), bare)


def size(name: str, seed: int) -> float:
    """Return the RMS of what the effect `name` adds to the force, over the noise."""
    added = []
    for radius, time, deflection in motions(seed):
        bare = Drive("", time, deflection, np.full(time.size, radius), np.zeros(time.size))
        added.append(forces(name, bare) - simulate(TireModel(), bare))
    return float(np.sqrt(np.mean(np.concatenate(added) ** 2))) / NOISE


def recordings(name: str, seed: int) -> list[Drive]:
    """Return two recordings of the tire with the effect `name`."""
    rng = np.random.default_rng(seed + 1)
    found = []
    for radius, time, deflection in motions(seed):
        radii = np.full(time.size, radius)
        bare = Drive("", time, deflection, radii, np.zeros(time.size))
        force = forces(name, bare) + NOISE * rng.standard_normal(time.size)
        shown = deflection + 1e-6 * rng.standard_normal(time.size)
        found.append(Drive(f"{name} {radius:g}", time, shown, radii, force))
    return found


@dataclass(frozen=True)
class Outcome:
    """A verdict with the effect in the catalogue, and one without; misfit: RMSE left in the latter, in noises."""

    name: str
    whole: Verdict
    without: Verdict

    @property
    def misfit(self) -> float:
        """RMSE left by the tire that was fitted without the effect, over the noise that was put in."""
        return self.without.fit.after / NOISE

    @property
    def row(self) -> str:
        """A line of the table."""
        alternatives = "; ".join("+".join(r.names) for r in self.without.alternatives)
        return (
            f"{self.name:28s} {self.without.fit.before / NOISE:6.1f}  {'+'.join(self.whole.names) or 'nothing':44s} | "
            f"{'+'.join(self.without.names) or 'nothing':60s} misfit {self.misfit:5.2f}  by "
            f"{', '.join(self.without.unexplained_by) or '-'}  alternatives {alternatives or '-'}"
        )


def outcome(name: str, seed: int = 1) -> Outcome:
    """Return what is said of clear recordings of `name`."""
    drives = recordings(name, seed)
    return Outcome(
        name, diagnose(drives), diagnose(drives, catalogue=[n for n in catalogue_names() if n != name])
    )


if __name__ == "__main__":
    print("\n".join(outcome(name).row for name in catalogue_names()))
