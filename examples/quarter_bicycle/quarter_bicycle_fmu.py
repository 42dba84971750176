"""The FMI 2.0 face of the quarter bicycle on its ground: radial force in, deflection and surface radius out.

Ground, bicycle and start are the file ride.json in the FMU's resources. The physics is in `bicycle` and `wheel`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from bicycle import QuarterBicycle, State, held_step
from pythonfmu.default_experiment import DefaultExperiment
from pythonfmu.enums import Fmi2Causality, Fmi2Initial, Fmi2Status, Fmi2Variability
from pythonfmu.fmi2slave import Fmi2Slave
from pythonfmu.variables import Real
from wheel import Meeting, OffTheGroundError, Track, meet

FLAT = 1e5
"""Surface radius [m] of flat ground: from here on the tire's law is the flat one, and every importer reads it."""

UNITS: dict[str, dict[str, str]] = {
    "m": {"m": "1"},
    "s": {"s": "1"},
    "m/s": {"m": "1", "s": "-1"},
    "kg": {"kg": "1"},
    "N": {"kg": "1", "m": "1", "s": "-2"},
    "N/m": {"kg": "1", "s": "-2"},
    "N.s/m": {"kg": "1", "s": "-1"},
}
"""Units as products of SI base units."""

OUTPUTS: dict[str, tuple[str, str]] = {
    "deflection": (
        "m",
        "Radial compression of the tire, look_ahead from now; negative by the gap in the air",
    ),
    "surface_radius": ("m", "Average radius of curvature of the ground in contact, look_ahead from now"),
    "position": ("m", "Distance of the hub along the ground"),
    "hub_height": ("m", "Height of the hub"),
    "hub_velocity": ("m/s", "Upward velocity of the hub"),
    "mass_height": ("m", "Height of the mass over the wheel less that at which the fork hangs free"),
    "mass_velocity": ("m/s", "Upward velocity of the mass over the wheel"),
    "upward_force": ("N", "Upward part of the tire's force in the last step"),
}
"""Unit and meaning of each output."""

PARAMETERS: dict[str, tuple[str, float, str]] = {
    "look_ahead": ("s", 0.0, "By how much deflection and surface_radius are with look-ahead"),
    "speed": ("m/s", 0.0, "Forward speed"),
    "sprung_mass": ("kg", 0.1, "Rider and frame on the front wheel"),
    "unsprung_mass": ("kg", 0.1, "Wheel and lower fork"),
    "fork_stiffness": ("N/m", 0.0, "Stiffness of the suspension fork"),
    "fork_damping": ("N.s/m", 0.0, "Damping of the suspension fork"),
}
"""Unit, least value and meaning of each parameter."""


class QuarterBicycleFmu(Fmi2Slave):
    """A quarter bicycle that rides over the ground of ride.json at a constant speed."""

    description = "Front wheel, fork and the mass over it, riding over ground at a constant speed"
    author = "The tirelab developers"
    license = "MIT"
    version = "1"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.modelName = "QuarterBicycle"
        ride = json.loads((Path(self.resources) / "ride.json").read_text(encoding="utf-8"))
        self.default_experiment = DefaultExperiment(0.0, ride["duration"], ride["step"])
        columns = ride["ground"]
        self._track = Track(
            columns["spacing"],
            *(tuple(columns[name]) for name in ("s", "z", "direction", "arc", "curvature")),
        )
        self._start: float = ride["start"]
        self._wheel_radius: float = ride["wheel_radius"]
        self._values: dict[str, float] = {name: ride["parameters"][name] for name in PARAMETERS}
        self._state: State = tuple(ride["state"])
        self._start_time = self._elapsed = 0.0
        self._radial_force = self._upward = 0.0
        self._sent: Meeting | None = None

        self.register_variable(
            Real(
                "radial_force",
                causality=Fmi2Causality.input,
                variability=Fmi2Variability.continuous,
                description="Force of the tire along the line from the ground to the hub, compressive",
                getter=lambda: self._radial_force,
                setter=lambda value: setattr(self, "_radial_force", value),
            )
        )
        for name, (_, text) in OUTPUTS.items():
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality.output,
                    variability=Fmi2Variability.continuous,
                    initial=Fmi2Initial.calculated,
                    description=text,
                    getter=lambda name=name: self._output(name),
                )
            )
        for name, (_, _, text) in PARAMETERS.items():
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality.parameter,
                    variability=Fmi2Variability.fixed,
                    initial=Fmi2Initial.exact,
                    description=text,
                    getter=lambda name=name: self._values[name],
                    setter=lambda value, name=name: self._set(name, value),
                )
            )

    def _set(self, name: str, value: float) -> None:
        self._values[name] = value
        self._sent = None

    def _bicycle(self) -> QuarterBicycle:
        v = self._values
        return QuarterBicycle(
            v["sprung_mass"], v["unsprung_mass"], v["fork_stiffness"], v["fork_damping"], self._wheel_radius
        )

    def _meet(self, ahead: float) -> Meeting:
        """Return how the wheel will meet the ground in `ahead` [s], the hub going on at its velocity."""
        position = self._start + self._values["speed"] * (self._elapsed + ahead)
        return meet(self._track, position, self._state[2] + ahead * self._state[3], self._wheel_radius)

    def _output(self, name: str) -> float:
        mass_height, mass_velocity, hub_height, hub_velocity = self._state
        if name in ("deflection", "surface_radius"):
            if self._sent is None:
                try:
                    self._sent = self._meet(self._values["look_ahead"])
                except OffTheGroundError:
                    return math.nan  # the step that needs it says why
            if name == "deflection":
                return self._sent.deflection
            return min(max(self._sent.surface_radius, -FLAT), FLAT)
        return {
            "position": self._start + self._values["speed"] * self._elapsed,
            "hub_height": hub_height,
            "hub_velocity": hub_velocity,
            "mass_height": mass_height,
            "mass_velocity": mass_velocity,
            "upward_force": self._upward,
        }[name]

    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> None:
        """Remember when the ride starts."""
        self._start_time = start_time

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Move on by `step_size` [s] under the force as it is now, or refuse the step with one message."""
        force = self._radial_force
        try:
            for name, (_, least, _) in PARAMETERS.items():
                if not least <= self._values[name] < math.inf:
                    raise ValueError(
                        f"{name} = {self._values[name]:g} is not allowed; give {least:g} or more"
                    )
            if not math.isfinite(force):
                raise ValueError(f"radial_force = {force} is not allowed; it must be a finite number")
            if not step_size > 0.0:
                raise ValueError(
                    f"communicationStepSize = {step_size:g} s is not allowed; give more than 0 s"
                )
            self._elapsed = current_time - self._start_time
            middle = self._meet(0.5 * step_size)
            upward = force * math.cos(middle.inclination)
            self._state = held_step(self._bicycle(), step_size).advance(self._state, upward)
        except (ValueError, OverflowError) as error:
            self.log(str(error), Fmi2Status.error)
            return False
        self._upward = upward
        self._elapsed = current_time + step_size - self._start_time
        self._sent = None
        return True

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """Return the model description with units, bounds and dependencies, which pythonfmu does not write."""
        root: Element = super().to_xml({"needsExecutionTool": "false", **(model_options or {})})
        del root.attrib["generationDateAndTime"]
        traits: dict[str, dict[str, str]] = {"radial_force": {"unit": "N"}}
        traits |= {name: {"unit": unit} for name, (unit, _) in OUTPUTS.items()}
        traits |= {name: {"unit": unit, "min": f"{least:g}"} for name, (unit, least, _) in PARAMETERS.items()}
        for variable in root.findall("ModelVariables/ScalarVariable"):
            variable[0].attrib.update(traits[variable.get("name", "")])

        units = Element("UnitDefinitions")
        for name, factors in UNITS.items():
            SubElement(SubElement(units, "Unit", name=name), "BaseUnit", factors)
        root.insert(1, units)
        structure = root.find("ModelStructure")
        assert structure is not None
        # No output depends on the force at once: a master has no loop to solve.
        unknowns = SubElement(structure, "InitialUnknowns")
        for output in structure.findall("Outputs/Unknown"):
            output.set("dependencies", "")
            SubElement(unknowns, "Unknown", index=output.get("index", ""))
        return root
