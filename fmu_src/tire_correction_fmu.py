"""The FMI 2.0 interface of a correction: what a simulation of somebody's lacks, beside that simulation.

    x_t = deflection of the tire      (deflection reading and series springs; the deflection where there are none)
    F_a = corrected tire(x) - believed law(x_t)
    corrected_force = simulated_force + F_a

The numbers are the file correction.json in the FMU's resources: two tires, as in tire files; the physics is in
`radialtire`. Outputs follow inputs at once.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from fmu_description import OPTIONS, complete
from pythonfmu.default_experiment import DefaultExperiment
from pythonfmu.enums import Fmi2Causality, Fmi2Initial, Fmi2Status, Fmi2Variability
from pythonfmu.fmi2slave import Fmi2Slave
from pythonfmu.variables import Real
from radialtire import check_inputs, power_law
from radialtire.effect import State
from radialtire.flat_step import TIME
from radialtire.tirefile import from_text

MODEL = "Correction"
"""The model identifier: the name of the binaries."""

VARIABLES = (
    ("deflection", "input", "m", "As the simulation is given it, compressed > 0"),
    ("surface_radius", "input", "m", "Radius of the ground, flat from 1e5 m on; 0: as its start value"),
    ("simulated_force", "input", "N", "Force of the simulation that is corrected"),
    ("tire_deflection", "output", "m", "Deflection to give to the simulation in place of the measured one"),
    ("additional_force", "output", "N", "What the simulation lacks"),
    ("corrected_force", "output", "N", "Simulated force plus additional force"),
)
"""Name, causality, unit and meaning of each variable, by value reference."""

INPUTS = 3
"""Number of inputs: the variables before the outputs."""

USES = ((0, 1), (0, 1), (0, 1, 2))
"""The inputs that each output depends on."""


class TireCorrection(Fmi2Slave):
    """Additional force, and the deflection of the tire, from the deflection."""

    author = "The tirelab developers"
    license = "MIT"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.modelName = MODEL
        self.default_experiment = DefaultExperiment(start_time=0.0, stop_time=1.0, step_size=1e-3)
        content = json.loads((Path(self.resources) / "correction.json").read_text(encoding="utf-8"))
        self._tire = from_text(json.dumps(content["corrected"]))
        self._believed = from_text(json.dumps(content["believed"]))
        self._moves = bool(content["moves"])
        self._start = float(content["surface_radius"])
        self._inputs = [0.0, self._start, 0.0]
        self._state = self._tire.initial_state
        self._reached = 0.0
        self._outputs = (0.0, 0.0, 0.0)
        self._current = False
        for name, causality, _, text in VARIABLES:
            is_input = causality == "input"
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality[causality],
                    variability=Fmi2Variability.continuous,
                    initial=None if is_input else Fmi2Initial.calculated,
                    description=text,
                    start=self._inputs[len(self.vars)] if is_input else None,
                ),
                nested=False,
            )

    def set_real(self, vrs: list[int], values: list[float]) -> bool:
        """Take inputs; the step that would use a wrong value reports it."""
        self._current = False
        for vr, value in zip(vrs, values, strict=True):
            if not 0 <= vr < INPUTS:
                self.log(f"value reference {vr} is no input of this correction", Fmi2Status.error)
                return False
            self._inputs[vr] = value
        return True

    def get_real(self, vrs: list[int]) -> list[float]:
        """Return values for the inputs as they are now, without a step's delay; NaN where there is none."""
        if not self._current:
            self._try(self._state[TIME])
        return [self._inputs[vr] if vr < INPUTS else self._outputs[vr - INPUTS] for vr in vrs]

    def _try(self, time: float) -> tuple[State, str]:
        """Evaluate the inputs at `time` and return the state after it, with the reason where there is none."""
        self._current = True
        x, radius, simulated = self._inputs
        radius = self._start if radius == 0.0 else radius
        try:
            check_inputs(x, radius, self._tire.deflection_highest)
            force, state = self._tire.step(x, radius, time, self._state)
            inside = self._tire.tire_deflection(x, radius, time, self._state) if self._moves else x
            additional = force - self._law_force(inside, radius)
            self._outputs = (inside, additional, simulated + additional)
            if math.isfinite(self._outputs[2]):
                return state, ""
            reason = f"corrected_force is not finite at deflection = {x:.17g} m"
        except (ValueError, ArithmeticError) as error:
            reason = str(error)
        self._outputs = (math.nan, math.nan, math.nan)
        return self._state, reason

    def _law_force(self, deflection: float, radius: float) -> float:
        """Return the force [N] of the law of the simulation, without any effect."""
        coefficients = self._believed.law.coefficients(radius)
        if self._believed.two_sided:
            return self._believed.preload + power_law.two_sided(deflection, *coefficients)
        return power_law.force(deflection, *coefficients)

    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> bool:
        """Store the start time of the experiment."""
        self._reached = start_time
        return True

    def exit_initialization_mode(self) -> bool:
        """Begin the history with the inputs of the start."""
        self._state = (self._reached, *self._tire.initial_state[TIME + 1 :])
        return self._accept(self._reached)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Accept the inputs at the end of the step, or refuse the step with one message and change nothing."""
        return self._accept(current_time + step_size)

    def _accept(self, time: float) -> bool:
        state, reason = self._try(time)
        if reason:
            self._current = False
            self.log(reason, Fmi2Status.error)
            return False
        self._state, self._reached = state, time
        return True

    def _get_fmu_state(self) -> dict[str, Any]:
        return {"inputs": list(self._inputs), "history": self._state, "reached": self._reached}

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._inputs = list(state["inputs"])
        self._state = tuple(state["history"])
        self._reached = state["reached"]
        self._current = False

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """Return the model description with units and dependencies, which pythonfmu does not write."""
        root: Element = super().to_xml({**OPTIONS, **(model_options or {})})
        named = ", ".join(effect.name for effect, _ in self._tire.effects) or "a refitted law"
        root.set("description", f"What a simulation of a tire lacks: {named}; used beside that simulation")
        complete(root, {vr: {"unit": unit} for vr, (_, _, unit, _) in enumerate(VARIABLES)}, USES)
        return root
