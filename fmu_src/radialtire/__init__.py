"""The radial force of a bicycle tire: published laws, the effects they leave out, and tires as files.

This package is handed to the FMU whole, so it imports the standard library only.
"""

from .effect import CHANNELS, NONE_MEASURED, Channel, Effect, Flow, Instant, Reading, State
from .effects import CATALOGUE
from .hull1996 import FLAT_RADIUS, SECOND_READING, Hull1996
from .model import InputError, TestedRange, TireModel, check_inputs, check_measured
from .parameter import Parameter, ParameterError
from .power_law import PowerLaw
from .prior import Prior
from .recalibrated import Recalibrated
from .tirefile import TireFileError, parameters_of, read_tire, with_parameters, write_tire

__all__ = [
    "CATALOGUE",
    "CHANNELS",
    "FLAT_RADIUS",
    "NONE_MEASURED",
    "SECOND_READING",
    "Channel",
    "Effect",
    "Flow",
    "Hull1996",
    "InputError",
    "Instant",
    "Parameter",
    "ParameterError",
    "PowerLaw",
    "Prior",
    "Reading",
    "Recalibrated",
    "State",
    "TestedRange",
    "TireFileError",
    "TireModel",
    "check_inputs",
    "check_measured",
    "parameters_of",
    "read_tire",
    "with_parameters",
    "write_tire",
]
