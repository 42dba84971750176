"""The effects that an elastic law leaves out: one file each, one line each here."""

from __future__ import annotations

from ..effect import Effect
from .bottoming import BOTTOMING
from .deflection_drift import DEFLECTION_DRIFT
from .deflection_lag import DEFLECTION_LAG
from .deflection_offset import DEFLECTION_OFFSET
from .elastic_shape import ELASTIC_SHAPE
from .force_drift import FORCE_DRIFT
from .force_lag import FORCE_LAG
from .force_offset import FORCE_OFFSET
from .gas_compression import GAS_COMPRESSION
from .inertia import INERTIA
from .inflation_pressure import INFLATION_PRESSURE
from .mullins_softening import MULLINS_SOFTENING
from .part_shape import PART_SHAPE
from .permanent_set import PERMANENT_SET
from .pressure_leak import PRESSURE_LEAK
from .rate_independent_hysteresis import RATE_INDEPENDENT_HYSTERESIS
from .saturation import SATURATION
from .series_compliance import SERIES_COMPLIANCE
from .viscoelastic_relaxation import VISCOELASTIC_RELAXATION
from .viscous_damping import VISCOUS_DAMPING
from .warm_up import WARM_UP

CATALOGUE: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        DEFLECTION_OFFSET,
        DEFLECTION_DRIFT,
        DEFLECTION_LAG,
        PERMANENT_SET,
        SERIES_COMPLIANCE,
        ELASTIC_SHAPE,
        PART_SHAPE,
        INFLATION_PRESSURE,
        GAS_COMPRESSION,
        MULLINS_SOFTENING,
        PRESSURE_LEAK,
        WARM_UP,
        RATE_INDEPENDENT_HYSTERESIS,
        VISCOUS_DAMPING,
        VISCOELASTIC_RELAXATION,
        BOTTOMING,
        INERTIA,
        FORCE_LAG,
        FORCE_OFFSET,
        FORCE_DRIFT,
        SATURATION,
    )
}
"""Every effect by its name, in the order in which effects of one place act."""
