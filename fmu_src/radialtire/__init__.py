"""The radial force of a bicycle tire: published laws, the effects they leave out, and tires as files.

This package is handed to the FMU whole, so it imports the standard library only.
"""

from .effect import Effect, Flow, Instant, State
from .effects import CATALOGUE
from .hull1996 import FLAT_RADIUS, SECOND_READING, Hull1996
from .model import InputError, TestedRange, TireModel, check_inputs
from .parameter import Parameter, ParameterError
from .power_law import PowerLaw
from .prior import Prior
from .recalibrated import Recalibrated
from .tirefile import TireFileError, parameters_of, read_tire, with_parameters, write_tire

__all__ = [
    "CATALOGUE",
    "FLAT_RADIUS",
    "SECOND_READING",
    "Effect",
    "Flow",
    "Hull1996",
    "InputError",
    "Instant",
    "Parameter",
    "ParameterError",
    "PowerLaw",
    "Prior",
    "Recalibrated",
    "State",
    "TestedRange",
    "TireFileError",
    "TireModel",
    "check_inputs",
    "parameters_of",
    "read_tire",
    "with_parameters",
    "write_tire",
]
