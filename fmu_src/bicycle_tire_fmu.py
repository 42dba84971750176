"""The FMI 2.0 interface of a bicycle tire: names, units and states; the physics is in `radialtire`.

The tire is the file tire.json in the FMU's resources, so a corrected tire differs from its baseline by data only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from fmu_description import BASE_UNITS, OPTIONS, complete
from pythonfmu.default_experiment import DefaultExperiment
from pythonfmu.enums import Fmi2Causality, Fmi2Initial, Fmi2Status, Fmi2Variability
from pythonfmu.fmi2slave import Fmi2Slave
from pythonfmu.variables import Boolean, Real
from radialtire import (
    NONE_MEASURED,
    check_inputs,
    check_measured,
    parameters_of,
    power_law,
    read_tire,
    with_parameters,
)
from radialtire.effect import NOT_MEASURED, State
from radialtire.flat_step import TIME
from radialtire.model import DEFLECTION_LOWEST
from radialtire.tirefile import to_text

MODEL = "BicycleTire"
"""The model identifier: the name of the binaries."""

DEFLECTION, SURFACE_RADIUS, RADIAL_FORCE, RADIAL_STIFFNESS, IN_TESTED_RANGE, FIRST_PARAMETER = range(6)
"""Value references: the index of a variable in the model description."""

BOTH_INPUTS, FORCE_ALONE = (DEFLECTION, SURFACE_RADIUS), (RADIAL_FORCE,)
"""What most hosts set and get at every step; the Linux binary passes tuples, the Windows one lists."""

FLAT = 1e5
"""Start value of the surface radius [m]: flat, and unlike infinity read by every importer."""

STOP_TIME, STEP_SIZE = 1.0, 2e-4
"""[s] of the default experiment: the step that holds for a wheel on the tire (see the documentation's last section)."""

ON_TIME = 1e-3
"""Part of a step by which a time may be off: hosts add times up in their own ways."""

TRAITS: dict[int, dict[str, str]] = {
    DEFLECTION: {
        "unit": "m",
        "displayUnit": "mm",
        "min": f"{DEFLECTION_LOWEST:g}",
        "nominal": "0.01",
    },
    SURFACE_RADIUS: {"unit": "m", "displayUnit": "cm", "nominal": "0.3"},
    RADIAL_FORCE: {"unit": "N", "displayUnit": "N", "nominal": "1000"},
    RADIAL_STIFFNESS: {"unit": "N/m", "displayUnit": "N/mm", "nominal": "100000"},
}
"""Attributes that pythonfmu does not write; the unit stands on every variable, since some importers look only there."""


def _off(time: float, step: float) -> float:
    """Return by how much a time [s] may be off."""
    return ON_TIME * step + 1e-9 * max(1.0, abs(time))


class BicycleTire(Fmi2Slave):
    """Radial force of the tire of tire.json, from its deflection and the radius of the surface under it."""

    author = "The tirelab developers"
    license = "MIT"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.modelName = MODEL
        self.default_experiment = DefaultExperiment(start_time=0.0, stop_time=STOP_TIME, step_size=STEP_SIZE)
        self._tire = read_tire(Path(self.resources) / "tire.json")
        self._highest = self._tire.deflection_highest
        self._parameters = {name: value for name, (_, value) in parameters_of(self._tire).items()}
        self._pending: dict[str, float] = {}
        self._channels = self._tire.channels
        self._given = [start for _, _, start in self._channels]
        self._inputs: Sequence[float] = (0.0, FLAT)
        self._surface = math.nan  # the surface of _elastic; NaN where every step needs the full evaluation
        self._elastic = power_law.on_surface(0.0, 1.0)
        self._state = self._tire.initial_state
        self._reached = 0.0  # [s], the end of the last step
        self._stop = math.inf  # [s], the end of the experiment
        self._force = 0.0
        self._current = False

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
        self._first_channel = FIRST_PARAMETER + len(self._names)
        for name, (parameter, _) in parameters_of(self._tire).items():
            text = f"{parameter.symbol}: {parameter.meaning}"
            if parameter.unit not in BASE_UNITS:
                text = f"{text} [{parameter.unit}]"
            self._declare(Real, name, Fmi2Causality.parameter, text)
        for _, channel, _ in self._channels:
            self._declare(Real, channel.variable, Fmi2Causality.input, channel.meaning)

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

    def set_real(self, vrs: Sequence[int], values: Sequence[float]) -> bool:
        """Take inputs and parameters; the step that would use a wrong value reports it."""
        self._current = False
        if vrs == BOTH_INPUTS:
            self._inputs = values
            return True
        for vr, value in zip(vrs, values, strict=True):
            if not (0 <= vr < RADIAL_FORCE or FIRST_PARAMETER <= vr < self._first_channel + len(self._given)):
                name = self.vars[vr].name if vr in self.vars else f"value reference {vr}"
                self._tell(f"{name} = {value:.17g} cannot be set; set inputs and parameters only")
                return False
        self._surface = math.nan
        for vr, value in zip(vrs, values, strict=True):
            if vr < RADIAL_FORCE:
                self._inputs = (value, self._inputs[1]) if vr == DEFLECTION else (self._inputs[0], value)
            elif vr >= self._first_channel:
                self._given[vr - self._first_channel] = value
            else:
                self._pending[self._names[vr - FIRST_PARAMETER]] = value
        return True

    def get_real(self, vrs: Sequence[int]) -> Sequence[float]:
        """Return values for the inputs as they are now, without a step's delay; NaN where there is none."""
        if not self._current:
            self._try(self._now)
        if vrs == FORCE_ALONE:
            return (self._force,)
        return [
            self._force if vr == RADIAL_FORCE else self._inputs[vr] if vr < RADIAL_FORCE else self._other(vr)
            for vr in vrs
        ]

    def get_boolean(self, vrs: Sequence[int]) -> list[bool]:
        """Return in_tested_range for the inputs as they are now; False where the inputs are not allowed."""
        for vr in vrs:
            if vr != IN_TESTED_RANGE:
                raise ValueError(f"value reference {vr} is no Boolean variable of this tire")
        if not self._current:
            self._try(self._now)
        x, R = self._inputs
        inside = math.isfinite(self._force) and self._tire.in_tested_range(x, R, self._force)
        return [inside for _ in vrs]

    def _other(self, vr: int) -> float:
        if vr == RADIAL_STIFFNESS:
            x, R = self._inputs
            return (
                self._tire.stiffness(x, R, self._state, self._measured())
                if math.isfinite(self._force)
                else math.nan
            )
        if not FIRST_PARAMETER <= vr < self._first_channel + len(self._given):
            raise ValueError(f"value reference {vr} is no Real variable of this tire")
        if vr >= self._first_channel:
            return self._given[vr - self._first_channel]
        name = self._names[vr - FIRST_PARAMETER]
        return self._pending.get(name, self._parameters[name])

    def _measured(self) -> tuple[float, ...]:
        """Return the channels as the tire takes them; one that is not known is not measured."""
        found = list(NONE_MEASURED)
        for (number, channel, _), value in zip(self._channels, self._given, strict=True):
            check_measured(channel, value)
            found[number] = NOT_MEASURED if value == channel.unknown else value
        return tuple(found)

    def _tell(self, reason: str) -> None:
        self._current = False
        self.log(reason, Fmi2Status.error)

    @property
    def _now(self) -> float:
        """The time [s] of the state, at which a value is evaluated again."""
        return self._state[TIME]

    def _try(self, time: float) -> tuple[State, str]:
        """Evaluate the inputs at `time` and return the state after it, with the reason where there is none."""
        self._current = True
        try:
            if self._pending:
                self._tire = with_parameters(self._tire, {**self._parameters, **self._pending})
                self._parameters.update(self._pending)
                self._pending.clear()
            x, R = self._inputs
            check_inputs(x, R, self._highest)
            self._force, state = self._tire.step(x, R, time, self._state, self._measured())
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
    ) -> bool:
        """Store the start and stop times of the experiment."""
        if not math.isfinite(start_time):
            self._tell(f"startTime = {start_time:.17g} s is not allowed; it must be a finite number")
            return False
        if stop_time is not None and not stop_time >= start_time:
            self._tell(
                f"stopTime = {stop_time:.17g} s is not allowed; it must not lie before "
                f"startTime = {start_time:.17g} s"
            )
            return False
        self._reached = start_time
        self._stop = math.inf if stop_time is None else stop_time
        return True

    def exit_initialization_mode(self) -> bool:
        """Begin the history with the inputs of the start."""
        start = self._tire.initial_state
        self._state = (self._reached, *start[TIME + 1 :])
        self._state, reason = self._try(self._reached)
        if reason:
            self._tell(reason)
        return not reason

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Accept the inputs at the end of the step, or refuse the step with one message and change nothing."""
        x, R = self._inputs
        if (
            self._surface == R
            and DEFLECTION_LOWEST <= x <= self._highest
            and current_time == self._reached
            and 0.0 <= step_size < math.inf
            and current_time + step_size <= self._stop
        ):
            self._force = self._elastic(x)
            self._current = True
            self._reached += step_size
            return True
        reason = self._misplaced(current_time, step_size)
        state = self._state
        if not reason:
            state, reason = self._try(current_time + step_size)
        if reason:
            self._tell(reason)
            return False
        self._state = state
        self._reached = current_time + step_size
        if self._tire.bare:
            self._surface, self._elastic = R, power_law.on_surface(*self._tire.law.coefficients(R))
        return True

    def _misplaced(self, current_time: float, step_size: float) -> str:
        """Return what is wrong with the times of a step, or nothing."""
        if not 0.0 <= step_size < math.inf:
            return (
                f"communicationStepSize = {step_size:.17g} s is not allowed; it must be positive and finite"
            )
        end, stop = current_time + step_size, self._stop
        if end > stop + _off(stop, step_size):
            return (
                f"communicationStepSize = {step_size:.17g} s is not allowed; the step would end at {end:.17g} s, "
                f"after stopTime = {stop:.17g} s"
            )
        if not abs(current_time - self._reached) <= _off(self._reached, step_size):
            return (
                f"currentCommunicationPoint = {current_time:.17g} s is not allowed; it must be "
                f"{self._reached:.17g} s, the end of the last step"
            )
        return ""

    def _get_fmu_state(self) -> dict[str, Any]:
        return {
            "inputs": list(self._inputs),
            "channels": list(self._given),
            "parameters": {**self._parameters, **self._pending},
            "history": self._state,
            "reached": self._reached,
        }

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._inputs = tuple(state["inputs"])
        self._given = list(state["channels"])
        self._surface = math.nan
        self._pending = dict(state["parameters"])
        self._state = tuple(state["history"])
        self._reached = state["reached"]
        self._current = False

    # Description.

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """Return the model description with units, bounds and dependencies, which pythonfmu does not write."""
        import hashlib  # here, since it takes 10 ms, which an instance need not spend

        root: Element = super().to_xml({**OPTIONS, **(model_options or {})})
        name = self._tire.name or MODEL
        root.set("modelName", name)
        source = f" ({self._tire.source})" if self._tire.source else ""
        learned = "" if self._tire.remainder is None else f"; with {self._tire.remainder}"
        root.set(
            "description", f"Radial force of a bicycle tire on flat or curved ground: {name}{source}{learned}"
        )
        root.set("version", hashlib.sha256(to_text(self._tire).encode()).hexdigest()[:12])
        traits = dict(TRAITS)
        traits[DEFLECTION] = {**traits[DEFLECTION], "max": f"{self._highest:g}"}
        for vr, (parameter, _) in enumerate(parameters_of(self._tire).values(), FIRST_PARAMETER):
            bounds = {"min": parameter.minimum, "max": parameter.maximum}
            finite = {key: repr(float(bound)) for key, bound in bounds.items() if math.isfinite(bound)}
            unit_of = {"unit": parameter.unit} if parameter.unit in BASE_UNITS else {}
            traits[vr] = {**unit_of, **finite}
        for vr, (_, channel, _) in enumerate(self._channels, self._first_channel):
            traits[vr] = {
                "unit": channel.unit,
                "min": repr(float(channel.minimum)),
                "max": repr(float(channel.maximum)),
                "nominal": repr(float(channel.usual)),
            }
        if self._tire.bare:  # damping, inertia or a wrong zero can make the force negative
            for vr in (RADIAL_FORCE, RADIAL_STIFFNESS):
                traits[vr] = {**traits[vr], "min": "0"}
        channels = range(self._first_channel, self._first_channel + len(self._channels))
        inputs = [DEFLECTION, SURFACE_RADIUS, *channels]
        outputs = [inputs] * (FIRST_PARAMETER - RADIAL_FORCE)
        complete(root, traits, outputs, range(FIRST_PARAMETER, self._first_channel))
        for vr, variable in enumerate(root.findall("ModelVariables/ScalarVariable")):
            if "start" in variable[0].attrib:  # pythonfmu writes 16 digits, which are not always the number
                variable[0].set("start", repr(float(self.get_real([vr])[0])))
        return root
