"""A mass on the tire in Model Exchange, integrated by fmpy's CVode, against closed forms to 1e-6."""

from __future__ import annotations

import math
from ctypes import byref, c_double
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy.sundials import CVodeSolver
from loader_bench import unpacked_archive
from native_me import Unit
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.fmu.native.pack import build_native_fmu

STIFFNESS, MASS, GRAVITY = 150_000.0, 3.0, 9.81
MIDDLE = 0.01
FLAT = 1e5
TOLERANCE = 1e-10
"""Of the solver, relative: over a few periods its error is some hundred times that."""


class Riding:
    """A mass [kg] on a tire under a weight [N]; y: deflection [m], its rate [m/s], the states of the tire.

    Roots: the tire's event indicator, and the passage through `MIDDLE`.
    """

    def __init__(self, tire: TireModel, folder: Path, weight: float, y: list[float]) -> None:
        fmu = unpacked_archive(build_native_fmu(tire, folder).path, folder / "fmu")
        self.given, self.weight, self.time = tire.differentiates, weight, 0.0
        self.y = y
        self.tire = Unit(fmu, self.inputs())
        self.y = [*y, *self.tire.continuous()[len(y) - 2 :]]
        self.solver = CVodeSolver(
            nx=len(self.y),
            nz=2,
            get_x=lambda row, n: self.put(row, self.y),
            set_x=lambda row, n: setattr(self, "y", list(row[:n])),
            get_dx=lambda row, n: self.put(row, self.slopes()),
            get_z=lambda row, n: self.put(row, self.roots()),
            get_nominals=lambda row, n: self.put(row, [1e-2, 1.0, *[1e3] * (n - 2)]),
            set_time=lambda t: setattr(self, "time", t),
            input=self,
            startTime=0.0,
            relativeTolerance=TOLERANCE,
            maxNumSteps=100_000,
        )

    def apply(self, time: float) -> None:
        """The inputs follow from y."""

    @staticmethod
    def put(row: Any, values: list[float]) -> None:
        for i, value in enumerate(values):
            row[i] = value

    def inputs(self) -> list[float]:
        return [self.y[0], FLAT, *([self.y[1], 0.0] if self.given else [])]

    def slopes(self) -> list[float]:
        force, rates = self.tire.evaluate(self.time, self.inputs(), self.y[2:])
        return [self.y[1], (self.weight - force) / MASS, *rates]

    def roots(self) -> list[float]:
        self.slopes()
        return [self.tire.indicator(), self.y[0] - MIDDLE]

    def until(self, end: float) -> tuple[list[float], list[tuple[float, float]]]:
        """Return the times of contact's begins and ends, and times and rates of the passages downwards."""
        contacts, passages, now = [], [], 0.0
        while now < end:
            _, (contact, passage), now = self.solver.step(now, end)
            self.time = now
            self.slopes()
            self.tire.accept()
            if contact:
                contacts.append(now)
                self.tire("EnterEventMode")
                self.tire("NewDiscreteStates", byref((c_double * 4)()))
                self.tire("EnterContinuousTimeMode")
                self.solver.reset(now)
            if passage and self.y[1] > 0.0:
                passages.append((now, self.y[1]))
        return contacts, passages


def tire_with(**effects: dict[str, float]) -> TireModel:
    acting = tuple(
        (CATALOGUE[name], tuple(given.get(p.name, p.start) for p in CATALOGUE[name].parameters))
        for name, given in effects.items()
    )
    return TireModel(law=PowerLaw(STIFFNESS / 100.0, 1.0), effects=acting)


def ringing(riding: Riding, omega: float, periods: int) -> tuple[float, float]:
    """Return circular frequency and loss of the logarithm of the amplitude per cycle."""
    _, passages = riding.until((periods + 0.5) * 2.0 * math.pi / omega)
    (first, fast), (last, slow) = passages[0], passages[-1]
    cycles = len(passages) - 1
    assert cycles >= periods - 1
    return 2.0 * math.pi * cycles / (last - first), math.log(fast / slow) / cycles


def test_the_contact_frequency(tmp_path: Path) -> None:
    """omega^2 = k / m; nothing is lost."""
    expected = math.sqrt(STIFFNESS / MASS)
    riding = Riding(tire_with(), tmp_path, STIFFNESS * MIDDLE, [0.008, 0.0])
    omega, loss = ringing(riding, expected, 4)
    assert omega == pytest.approx(expected, rel=1e-6)
    assert abs(loss) < 1e-6


def test_the_loss_per_cycle_of_a_damper(tmp_path: Path) -> None:
    """m x'' + c x' + k x = 0, c by the input deflection_rate: zeta = c / (2 sqrt(k m))."""
    damping = 100.0
    zeta = damping / (2.0 * math.sqrt(STIFFNESS * MASS))
    expected = math.sqrt(STIFFNESS / MASS * (1.0 - zeta**2))
    tire = tire_with(viscous_damping={"damping": damping})
    omega, loss = ringing(Riding(tire, tmp_path, STIFFNESS * MIDDLE, [0.008, 0.0]), expected, 4)
    assert omega == pytest.approx(expected, rel=1e-6)
    assert loss == pytest.approx(2.0 * math.pi * zeta / math.sqrt(1.0 - zeta**2), rel=1e-6)


def test_the_loss_per_cycle_of_relaxing_rubber(tmp_path: Path) -> None:
    """m s^2 + k (1 + g s tau / (1 + s tau)) = 0, begun in the oscillating mode: x, v = s x, q = k x / (1 + s tau)."""
    g, tau, amplitude = 0.2, 0.005, 0.002
    roots = np.roots([MASS * tau, MASS, STIFFNESS * tau * (1.0 + g), STIFFNESS])
    s = complex(roots[np.argmax(roots.imag)])
    relaxed = (STIFFNESS * amplitude / (1.0 + s * tau)).real
    start = [MIDDLE + amplitude, (s * amplitude).real, STIFFNESS * MIDDLE + relaxed]
    tire = tire_with(viscoelastic_relaxation={"share_1": g, "relaxation_time_1": tau})
    omega, loss = ringing(Riding(tire, tmp_path, STIFFNESS * MIDDLE, start), s.imag, 4)
    assert omega == pytest.approx(s.imag, rel=1e-6)
    assert loss == pytest.approx(-2.0 * math.pi * s.real / s.imag, rel=1e-6)


def test_a_mass_that_bounces(tmp_path: Path) -> None:
    """Dropped from 5 mm: contact at v = sqrt(2 g h), it stays 2 (pi - atan(omega v / g)) / omega and flies 2 v / g."""
    height = 0.005
    omega, fast = math.sqrt(STIFFNESS / MASS), math.sqrt(2.0 * GRAVITY * height)
    begin = fast / GRAVITY
    stay, flight = 2.0 * (math.pi - math.atan(omega * fast / GRAVITY)) / omega, 2.0 * fast / GRAVITY
    expected = np.cumsum([begin, stay, flight, stay, flight])
    riding = Riding(tire_with(), tmp_path, MASS * GRAVITY, [-height, 0.0])
    contacts, _ = riding.until(expected[-1] + 0.5 * stay)
    np.testing.assert_allclose(contacts, expected, rtol=1e-6)
