"""The FMI 2.0 interface of a bicycle tire: names, units and states; the physics is in `radialtire`.

The tire is the file tire.json in the FMU's resources, so a corrected tire differs from its baseline by data only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu.default_experiment import DefaultExperiment
from pythonfmu.enums import Fmi2Causality, Fmi2Initial, Fmi2Status, Fmi2Variability
from pythonfmu.fmi2slave import Fmi2Slave
from pythonfmu.variables import Boolean, Real
from radialtire import check_inputs, parameters_of, power_law, read_tire, with_parameters
from radialtire.model import DEFLECTION_HIGHEST, DEFLECTION_LOWEST, ModelState

DEFLECTION, SURFACE_RADIUS, RADIAL_FORCE, RADIAL_STIFFNESS, IN_TESTED_RANGE, FIRST_PARAMETER = range(6)
"""Value references: the index of a variable in the model description."""

BOTH_INPUTS, FORCE_ALONE = (DEFLECTION, SURFACE_RADIUS), (RADIAL_FORCE,)
"""What most hosts set and get at every step; the Linux binary passes tuples, the Windows one lists."""

FLAT = 1e5
"""Start value of the surface radius [m]: flat, and unlike infinity read by every importer."""

BASE_UNITS: dict[str, dict[str, str]] = {
    "m": {"m": "1"},
    "s": {"s": "1"},
    "kg": {"kg": "1"},
    "K": {"K": "1"},
    "N": {"kg": "1", "m": "1", "s": "-2"},
    "Pa": {"kg": "1", "m": "-1", "s": "-2"},
    "N/m": {"kg": "1", "s": "-2"},
    "N.s/m": {"kg": "1", "s": "-1"},
    "N/s": {"kg": "1", "m": "1", "s": "-3"},
    "m/s": {"m": "1", "s": "-1"},
    "m3": {"m": "3"},
    "1/s": {"s": "-1"},
    "1/m": {"m": "-1"},
    "1/cm": {"m": "-1", "factor": "100"},
    "1/N": {"kg": "-1", "m": "-1", "s": "2"},
    "m/N": {"kg": "-1", "s": "2"},
    "1": {},
}
"""Units as products of SI base units; one that is not here (N/cm^B) has no fixed dimension and is declared by name."""

DISPLAY_UNITS: dict[str, dict[str, str]] = {
    "m": {"mm": "1000", "cm": "100", "in": "39.37007874015748"},
    "N": {"kN": "0.001", "lbf": "0.22480894309971047"},
    "N/m": {"N/mm": "0.001", "kN/m": "0.001"},
    "Pa": {"bar": "1e-05", "psi": "0.00014503773773020923"},
}

TRAITS: dict[int, dict[str, str]] = {
    DEFLECTION: {
        "unit": "m",
        "displayUnit": "mm",
        "min": f"{DEFLECTION_LOWEST:g}",
        "max": f"{DEFLECTION_HIGHEST:g}",
        "nominal": "0.01",
    },
    SURFACE_RADIUS: {"unit": "m", "displayUnit": "cm", "nominal": "0.3"},
    RADIAL_FORCE: {"unit": "N", "displayUnit": "N", "nominal": "1000"},
    RADIAL_STIFFNESS: {"unit": "N/m", "displayUnit": "N/mm", "nominal": "100000"},
}
"""Attributes that pythonfmu does not write; the unit stands on every variable, since some importers look only there."""


class BicycleTire(Fmi2Slave):
    """Radial force of the tire of tire.json, from its deflection and the radius of the surface under it."""

    description = "Radial force of a bicycle tire pressed on flat or curved ground (Hull, Wang & Moore 1996)"
    author = "The tirelab developers"
    license = "MIT"
    version = "1"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.modelName = "BicycleTire"
        self.default_experiment = DefaultExperiment(start_time=0.0, stop_time=30.0, step_size=0.2)
        self._tire = read_tire(Path(self.resources) / "tire.json")
        self._parameters = {name: value for name, (_, value) in parameters_of(self._tire).items()}
        self._pending: dict[str, float] = {}
        self._inputs: Sequence[float] = (0.0, FLAT)
        self._surface = math.nan  # the surface of _elastic; NaN where every step needs the full evaluation
        self._elastic = power_law.on_surface(0.0, 1.0)
        self._state = self._tire.initial_state
        self._start_time = 0.0
        self._force = 0.0
        self._current = False
        self._refused = ""

        self._declare(
            Real, "deflection", Fmi2Causality.input, "Radial compression of the tire; <= 0 in the air"
        )
        self._declare(
            Real,
            "surface_radius",
            Fmi2Causality.input,
            "Radius of curvature of the ground: convex > 0, concave < 0, flat from 1e5 m on; not 0",
        )
        self._declare(Real, "radial_force", Fmi2Causality.output, "Compressive force on the ground")
        self._declare(Real, "radial_stiffness", Fmi2Causality.output, "Tangent of force over deflection")
        self._declare(
            Boolean,
            "in_tested_range",
            Fmi2Causality.output,
            "Whether curvature, deflection and force are within the tested range",
        )
        self._names = list(self._parameters)
        for name, (parameter, _) in parameters_of(self._tire).items():
            text = f"{parameter.symbol}: {parameter.meaning}"
            self._declare(Real, name, Fmi2Causality.parameter, text)

    def _declare(
        self, kind: type[Real] | type[Boolean], name: str, causality: Fmi2Causality, text: str
    ) -> None:
        is_parameter = causality is Fmi2Causality.parameter
        initial = Fmi2Initial.exact if is_parameter else None
        variability = Fmi2Variability.tunable if is_parameter else None
        if kind is Real and not is_parameter:
            variability = Fmi2Variability.continuous
        elif kind is Boolean:
            variability = Fmi2Variability.discrete
        if causality is Fmi2Causality.output:
            initial = Fmi2Initial.calculated
        self.register_variable(
            kind(name, causality=causality, description=text, initial=initial, variability=variability),
            nested=False,
        )

    # Values, by value reference: pythonfmu's own accessors check types at every call, ours are on the hot path.

    def set_real(self, vrs: Sequence[int], values: Sequence[float]) -> None:
        """Take inputs and parameters; the step that would use a wrong value reports it."""
        self._current = False
        if vrs == BOTH_INPUTS:
            self._inputs = values
            return
        self._surface = math.nan
        for vr, value in zip(vrs, values, strict=True):
            if vr < RADIAL_FORCE:
                self._inputs = (value, self._inputs[1]) if vr == DEFLECTION else (self._inputs[0], value)
            elif FIRST_PARAMETER <= vr < FIRST_PARAMETER + len(self._names):
                self._pending[self._names[vr - FIRST_PARAMETER]] = value
            else:
                name = self.vars[vr].name if vr in self.vars else f"value reference {vr}"
                self._refused = f"{name} = {value:.17g} cannot be set; set inputs and parameters only"

    def get_real(self, vrs: Sequence[int]) -> Sequence[float]:
        """Return values for the inputs as they are now, without a step's delay; NaN where there is none."""
        if not self._current:
            self._try(self._state.time)
        if vrs == FORCE_ALONE:
            return (self._force,)
        return [
            self._force if vr == RADIAL_FORCE else self._inputs[vr] if vr < RADIAL_FORCE else self._other(vr)
            for vr in vrs
        ]

    def get_boolean(self, vrs: Sequence[int]) -> list[bool]:
        """Return in_tested_range for the inputs as they are now; False where the inputs are not allowed."""
        if not self._current:
            self._try(self._state.time)
        x, R = self._inputs
        inside = math.isfinite(self._force) and self._tire.in_tested_range(x, R, self._force)
        return [inside and vr == IN_TESTED_RANGE for vr in vrs]

    def _other(self, vr: int) -> float:
        if vr == RADIAL_STIFFNESS and math.isfinite(self._force):
            x, R = self._inputs
            return self._tire.stiffness(x, R, self._state)
        name = dict(enumerate(self._names, FIRST_PARAMETER)).get(vr, "")
        return self._pending.get(name, self._parameters.get(name, math.nan))

    def _try(self, time: float) -> tuple[ModelState, str]:
        """Evaluate the inputs at `time` and return the state after it, with the reason where there is none."""
        self._current = True
        try:
            if self._pending:
                self._tire = with_parameters(self._tire, {**self._parameters, **self._pending})
                self._parameters.update(self._pending)
                self._pending.clear()
            x, R = self._inputs
            check_inputs(x, R)
            self._force, state = self._tire.step(x, R, time, self._state)
            if math.isfinite(self._force):
                return state, ""
            reason = f"radial_force is not finite at deflection = {x:.17g} m, surface_radius = {R:.17g} m"
        except (ValueError, ArithmeticError) as error:
            reason = str(error)
        self._force = math.nan
        return self._state, reason

    # Steps.

    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> None:
        """Store the start time of the experiment."""
        self._start_time = start_time

    def exit_initialization_mode(self) -> None:
        """Begin the history with the inputs of the start."""
        self._state = self._tire.initial_state._replace(time=self._start_time)
        self._state, _ = self._try(self._start_time)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Accept the inputs at the end of the step, or discard the step with one message and change nothing."""
        x, R = self._inputs
        if self._surface == R and DEFLECTION_LOWEST <= x <= DEFLECTION_HIGHEST and step_size >= 0.0:
            self._force = self._elastic(x)
            self._current = True
            return True
        state, reason = self._try(current_time + step_size)
        if step_size < 0.0:
            reason = f"communicationStepSize = {step_size:.17g} s is not allowed; it must not be negative"
        if self._refused:
            reason, self._refused = self._refused, ""
        if reason:
            self._current = False
            self.log(reason, Fmi2Status.discard)
            return False
        self._state = state
        if not self._tire.effects:
            self._surface, self._elastic = R, power_law.on_surface(*self._tire.law.coefficients(R))
        return True

    def _get_fmu_state(self) -> dict[str, Any]:
        return {
            "inputs": list(self._inputs),
            "parameters": {**self._parameters, **self._pending},
            "history": self._state,
            "start_time": self._start_time,
        }

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._inputs = tuple(state["inputs"])
        self._surface = math.nan
        self._pending = dict(state["parameters"])
        self._state = ModelState.restored(state["history"])
        self._start_time = state["start_time"]
        self._current = False

    # Description.

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """Return the model description with units, bounds and dependencies, which pythonfmu does not write."""
        options = {
            "needsExecutionTool": "false",
            "canGetAndSetFMUstate": "true",
            "canSerializeFMUstate": "true",
            **(model_options or {}),
        }
        root: Element = super().to_xml(options)
        del root.attrib["generationDateAndTime"]
        traits = dict(TRAITS)
        for vr, (parameter, _) in enumerate(parameters_of(self._tire).values(), FIRST_PARAMETER):
            bounds = {"min": parameter.minimum, "max": parameter.maximum}
            finite = {key: f"{bound:.16g}" for key, bound in bounds.items() if math.isfinite(bound)}
            traits[vr] = {"unit": parameter.unit, **finite}
        if not self._tire.effects:  # damping, inertia or a wrong zero can make the force negative
            for vr in (RADIAL_FORCE, RADIAL_STIFFNESS):
                traits[vr] = {**traits[vr], "min": "0"}
        variables = root.find("ModelVariables")
        structure = root.find("ModelStructure")
        assert variables is not None
        assert structure is not None
        for vr, variable in enumerate(variables):
            variable[0].attrib.update(traits.get(vr, {}))

        units = Element("UnitDefinitions")
        for name in sorted({trait["unit"] for trait in traits.values()}):
            unit = SubElement(units, "Unit", name=name)
            if name in BASE_UNITS:
                SubElement(unit, "BaseUnit", BASE_UNITS[name])
            for display, factor in {name: "1", **DISPLAY_UNITS.get(name, {})}.items():
                SubElement(unit, "DisplayUnit", name=display, factor=factor)
        root.insert(1, units)

        inputs = [DEFLECTION + 1, SURFACE_RADIUS + 1]
        parameters = [vr + 1 for vr in range(FIRST_PARAMETER, len(self.vars))]
        outputs = structure.find("Outputs")
        assert outputs is not None
        unknowns = SubElement(structure, "InitialUnknowns")
        for output in outputs:
            output.set("dependencies", " ".join(map(str, inputs)))
            SubElement(
                unknowns,
                "Unknown",
                index=output.get("index", ""),
                dependencies=" ".join(map(str, inputs + parameters)),
            )
        return root
