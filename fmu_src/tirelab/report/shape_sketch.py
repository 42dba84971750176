"""What the constants of a refitted law's shape do: the force that each adds to A x^B."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from radialtire import CATALOGUE, Instant

from ..names import REFITTED_LAW
from .words import SHAPE

POINTS = 60
"""Deflections of a sketch."""

MORE = 1.5
"""A constant is varied by this factor, as the parameters of effects are."""


def shape_sketch(diagnosis: Mapping[str, Any]) -> dict[str, Any]:
    """Return REFITTED_LAW -> its sketch, as `draw_sketch` takes it; nothing where the law has the shape A x^B.

    diagnosis: with the refitted law among its effects, the corrected tire, and the change of the law by its deflections
    """
    law = next(
        (e for e in diagnosis["verdict"]["effects"] if e["name"] == REFITTED_LAW and e.get("law")), None
    )
    tire, changes = diagnosis.get("corrected_tire") or {}, diagnosis.get("law_changes") or []
    values = next((e["parameters"] for e in tire.get("effects", []) if e["name"] == SHAPE), None)
    if law is None or values is None or not changes:
        return {}
    flattest = max(law["law"], key=lambda row: abs(float(row["radius"])))
    a, b = float(flattest["A"]["after"]), float(flattest["B"]["after"])
    x = np.linspace(0.0, max(float(np.max(c["deflection"])) for c in changes), POINTS)
    power = a * (100.0 * x) ** b
    effect = CATALOGUE[SHAPE]
    fitted = tuple(float(values.get(p.name, p.start)) for p in effect.parameters)

    def added(given: tuple[float, ...]) -> list[float]:
        at = (Instant(0.0, 0.0, True, float(d), 0.0, 0.0, a, b, 0.0) for d in x)
        factors = np.array([effect.respond(1.0, instant, (), given)[0] for instant in at])
        return [float(force) for force in power * (factors - 1.0)]

    varied = {}
    for i, parameter in enumerate(effect.parameters):
        if parameter.name not in law["parameters"]:
            continue
        larger = MORE * fitted[i] if fitted[i] != 0.0 else parameter.nominal_value
        larger = min(max(larger, parameter.minimum), parameter.maximum)
        varied[parameter.name] = added((*fitted[:i], larger, *fitted[i + 1 :]))
    force = added(fitted)
    if not varied or not all(map(math.isfinite, force)):
        return {}
    return {REFITTED_LAW: {"deflection": [float(d) for d in x], "force": force, "varied": varied}}
