"""A Model Exchange host in few lines of Python and ctypes: a solver of fixed steps around an unpacked native FMU."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from ctypes import (
    CDLL,
    CFUNCTYPE,
    Structure,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_uint,
    c_void_p,
    cast,
)
from pathlib import Path

import fmpy
from loader_bench import guid_of

LOGGER = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)
RADIAL_FORCE = 2


class Callbacks(Structure):
    _fields_ = (("logger", LOGGER), ("rest", c_void_p * 4))


class Unit:
    """One instance in Continuous-Time Mode; `start` are its inputs in the order of their references.

    exchange: whether in Model Exchange; begun: whether it has left Initialization Mode
    """

    def __init__(
        self, folder: Path, start: Sequence[float], *, exchange: bool = True, begun: bool = True
    ) -> None:
        self.library = CDLL(str(folder / "binaries" / "linux64" / "BicycleTire.so"))
        self.messages: list[str] = []
        self._log = LOGGER(lambda _e, _n, _s, _c, text: self.messages.append(text.decode()))
        c_library = CDLL(None)
        memory = (c_void_p * 4)(cast(c_library.calloc, c_void_p), cast(c_library.free, c_void_p))
        self._callbacks = Callbacks(self._log, memory)
        description = fmpy.read_model_description(str(folder), validate=False)
        self.references = [v.valueReference for v in description.modelVariables if v.causality == "input"]
        self.names = {v.name: v.valueReference for v in description.modelVariables}
        self.states = len(description.derivatives)
        self.library.fmi2Instantiate.restype = c_void_p
        resources = (folder / "resources").as_uri().encode()
        found = self.library.fmi2Instantiate(
            b"tire", int(not exchange), guid_of(folder).encode(), resources, byref(self._callbacks), 0, 0
        )
        assert found, self.messages
        self.tire = c_void_p(found)
        self("SetupExperiment", 0, c_double(0), c_double(0), 0, c_double(0))
        self("EnterInitializationMode")
        self.set(start)
        if begun:
            self("ExitInitializationMode")
        if begun and exchange:
            self("NewDiscreteStates", byref((c_double * 4)()))
            self("EnterContinuousTimeMode")

    def __call__(self, name: str, *arguments: object) -> None:
        status = getattr(self.library, "fmi2" + name)(self.tire, *arguments)
        assert status == 0, (name, status, self.messages)

    def set(self, values: Sequence[float]) -> None:
        count = len(values)
        references = (c_uint * count)(*self.references[:count])
        self("SetReal", references, c_size_t(count), (c_double * count)(*values))

    def get(self, reference: int = RADIAL_FORCE) -> float:
        value = c_double()
        self("GetReal", byref(c_uint(reference)), c_size_t(1), byref(value))
        return value.value

    def evaluate(
        self, time: float, inputs: Sequence[float], states: Sequence[float]
    ) -> tuple[float, list[float]]:
        """Return the force and the rates of the states."""
        self("SetTime", c_double(time))
        self.set(inputs)
        row = (c_double * max(self.states, 1))(*states)
        self("SetContinuousStates", row, c_size_t(self.states))
        self("GetDerivatives", row, c_size_t(self.states))
        return self.get(), list(row[: self.states])

    def continuous(self) -> list[float]:
        row = (c_double * max(self.states, 1))()
        self("GetContinuousStates", row, c_size_t(self.states))
        return list(row[: self.states])

    def indicator(self) -> float:
        value = c_double()
        self("GetEventIndicators", byref(value), c_size_t(1))
        return value.value

    def step(self, time: float, width: float) -> None:
        self("DoStep", c_double(time), c_double(width), 1)

    def accept(self) -> None:
        self("CompletedIntegratorStep", 1, byref(c_int()), byref(c_int()))

    def derivative(self, unknown: int, known: Sequence[int], seed: Sequence[float]) -> float:
        value = c_double()
        references, count = (c_uint * len(known))(*known), c_size_t(len(known))
        one, row = c_size_t(1), (c_double * len(seed))(*seed)
        self("GetDirectionalDerivative", byref(c_uint(unknown)), one, references, count, row, byref(value))
        return value.value


Rates = Callable[[float, list[float]], list[float]]


def runge_kutta(rates: Rates, time: float, y: list[float], h: float) -> list[float]:
    """Return y after one step of the classical method of fourth order."""
    a = rates(time, y)
    b = rates(time + 0.5 * h, [u + 0.5 * h * v for u, v in zip(y, a, strict=True)])
    c = rates(time + 0.5 * h, [u + 0.5 * h * v for u, v in zip(y, b, strict=True)])
    d = rates(time + h, [u + h * v for u, v in zip(y, c, strict=True)])
    return [u + h / 6.0 * (p + 2.0 * q + 2.0 * r + s) for u, p, q, r, s in zip(y, a, b, c, d, strict=True)]
