"""FMUs that are no tire's, made by other exporters, for tests: springs and dampers.

Each is a script that pythonfmu or pythonfmu3 packs; their variables have names of their own.
"""

from __future__ import annotations

from pathlib import Path

SPRING_DAMPER = """
import time
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

class SpringDamper(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.displacement = 0.0
        self.wheel_load = 0.0
        self.before = None
        continuous = Fmi2Variability.continuous
        self.register_variable(Real("displacement", causality=Fmi2Causality.input, variability=continuous))
        self.register_variable(Real("temperature", causality=Fmi2Causality.input, variability=continuous))
        self.temperature = 20.0
        self.register_variable(Real("wheel_load", causality=Fmi2Causality.output, variability=continuous))
        self.register_variable(Real("power", causality=Fmi2Causality.output, variability=continuous))
        self.power = 0.0

    def exit_initialization_mode(self):
        self.before = self.displacement
        self.wheel_load = 1e5 * self.displacement

    def do_step(self, current_time, step_size):
        {misbehave}
        rate = (self.displacement - self.before) / step_size
        self.wheel_load = 1e5 * self.displacement + 300.0 * rate
        self.before = self.displacement
        return True
"""
"""F = 100 kN/m x + 300 N s/m dx/dt, the rate from the last step: FMI 2.0, Co-Simulation."""

MAXWELL = """
from pythonfmu3 import Fmi3Causality, Fmi3Initial, Fmi3Slave, Fmi3SlaveBase, Fmi3Variability, Float64, ModelExchange

class Maxwell({base}):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.time, self.x, self.f, self.q, self.dq = 0.0, 0.0, 0.0, 0.0, 0.0
        continuous, exact = Fmi3Variability.continuous, Fmi3Initial.exact

        def declare(name, causality, **more):
            self.register_variable(Float64(name, causality=causality, variability=continuous, **more))

        declare("time", Fmi3Causality.independent)
        declare("x", Fmi3Causality.input, start=0.0)
        declare("f", Fmi3Causality.output, getter=self.force)
        declare("q", Fmi3Causality.local, start=0.0, initial=exact)
        declare("dq", Fmi3Causality.local, derivative=3, getter=self.rate)

    def rate(self):
        return (2e4 * self.x - self.q) / 0.5

    def force(self):
        return 1e5 * self.x - self.q

    def get_continuous_state_derivatives(self):
        return [self.rate()]

    def do_step(self, current_time, step_size):
        self.q += step_size * self.rate()
        return True
"""
"""A spring of 80 kN/m beside a spring of 20 kN/m on a damper of 0.5 s: FMI 3.0."""


DAMPER = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

class Damper(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.stroke = 0.0
        self.force = 0.0
        self.before = 0.0
        continuous = Fmi2Variability.continuous
        self.register_variable(Real("stroke", causality=Fmi2Causality.input, variability=continuous))
        self.register_variable(Real("force", causality=Fmi2Causality.output, variability=continuous))

    def exit_initialization_mode(self):
        self.before = self.stroke
        self.force = 0.0

    def do_step(self, current_time, step_size):
        self.force = 1500.0 * (self.stroke - self.before) / step_size
        self.before = self.stroke
        return True
"""
"""F = 1500 N s/m dx/dt and no spring, the rate from the last step: FMI 2.0, Co-Simulation."""


PLAY = """
import math
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

class Play(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.travel = 0.0
        self.load = 0.0
        self.before = None
        continuous = Fmi2Variability.continuous
        self.register_variable(Real("travel", causality=Fmi2Causality.input, variability=continuous))
        self.register_variable(Real("load", causality=Fmi2Causality.output, variability=continuous))

    def exit_initialization_mode(self):
        self.before = self.travel
        self.respond(0.0)

    def respond(self, rate):
        beyond = max(abs(self.travel) - 0.002, 0.0)
        self.load = math.copysign(1.5e5 * beyond, self.travel) + (800.0 * rate if beyond else 0.0)

    def do_step(self, current_time, step_size):
        self.respond((self.travel - self.before) / step_size)
        self.before = self.travel
        return True
"""
"""150 kN/m and 800 N s/m beyond a play of 2 mm on both sides: FMI 2.0, Co-Simulation."""


def play(folder: Path) -> Path:
    """Write Play.fmu of pythonfmu (FMI 2.0 Co-Simulation)."""
    from pythonfmu import FmuBuilder

    script = folder / "play.py"
    script.write_text(PLAY, encoding="utf-8")
    return Path(FmuBuilder.build_FMU(script, dest=folder))


def damper(folder: Path) -> Path:
    """Write Damper.fmu of pythonfmu (FMI 2.0 Co-Simulation)."""
    from pythonfmu import FmuBuilder

    script = folder / "damper.py"
    script.write_text(DAMPER, encoding="utf-8")
    return Path(FmuBuilder.build_FMU(script, dest=folder))


def spring_damper(folder: Path, misbehave: str = "pass", **renamed: str) -> Path:
    """Write SpringDamper.fmu of pythonfmu (FMI 2.0 Co-Simulation); misbehave: a statement for each step; renamed: its
    variables.
    """
    from pythonfmu import FmuBuilder

    script, text = folder / "springdamper.py", SPRING_DAMPER.replace("{misbehave}", misbehave)
    for name, other in renamed.items():
        text = text.replace(name, other)
    script.write_text(text, encoding="utf-8")
    return Path(FmuBuilder.build_FMU(script, dest=folder))


def maxwell(folder: Path, kind: str) -> Path:
    """Write Maxwell.fmu of pythonfmu3 (FMI 3.0); kind: CoSimulation or ModelExchange."""
    from pythonfmu3 import FmuBuilder

    script = folder / "maxwell.py"
    base = {"CoSimulation": "Fmi3Slave", "ModelExchange": "Fmi3SlaveBase, ModelExchange"}[kind]
    script.write_text(MAXWELL.replace("{base}", base), encoding="utf-8")
    return Path(FmuBuilder.build_FMU(script, dest=folder))
