"""A slave that tests the loader: the flat tire F = 550.9 x^1.422, x in cm, and a variable of each type."""

import math
from collections.abc import Sequence
from typing import Any

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Integer, Real, String
from pythonfmu.enums import Fmi2Status

A, B = 550.9, 1.422
DEFLECTION, RADIUS, FORCE = range(3)


class BicycleTire(Fmi2Slave):
    """Speaks in every way that a slave can: by values, messages, False, and exceptions."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.deflection = 0.0
        self.radius = math.inf
        self.steps = 0
        self.worn = False
        self.make = "Ground Control/S"
        inputs = {"causality": Fmi2Causality.input}
        self.register_variable(Real("deflection", **inputs))
        self.register_variable(Real("radius", **inputs))
        self.register_variable(Real("force", causality=Fmi2Causality.output, getter=self.compute_force))
        self.register_variable(Integer("steps", **inputs))
        self.register_variable(Boolean("worn", **inputs))
        self.register_variable(String("make", **inputs))
        self.log(f"100 % made from {self.resources}")

    def compute_force(self) -> float:
        """Return the force at the present deflection, N."""
        return A * (100 * self.deflection) ** B if self.deflection > 0 else 0.0

    def set_real(self, vrs: Sequence[int], values: Sequence[float]) -> bool:
        """Set the usual pair fast."""
        if vrs == (DEFLECTION, RADIUS):
            self.deflection, self.radius = values
        else:
            super().set_real(vrs, values)
        if self.radius == 0:
            raise ValueError("radius 0 m is 100 % wrong")
        return self.radius != -1

    def get_real(self, vrs: Sequence[int]) -> Sequence[float]:
        """Get the usual one fast."""
        return (self.compute_force(),) if vrs == (FORCE,) else super().get_real(vrs)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Count the step, unless there is no deflection to make it with."""
        if self.deflection != self.deflection:
            self.log("deflection nan m is 100 % no number", Fmi2Status.discard)
            return False
        self.steps += 1
        return True
