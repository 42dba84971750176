"""Anybody's FMU that gives a force for a deflection: which of its variables are which, in which units.

Nothing of the FMU is run here; `foreign_replay` does that, in a process of its own.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import fmpy
import numpy as np
from fmpy.model_description import ModelDescription, ScalarVariable
from radialtire import TireFileError, TireModel
from radialtire.tirefile import from_text

from ..errors import TirelabError
from ..recordings.assignments import assignments
from ..recordings.channels import CHANNELS, assignments_text
from ..recordings.units import UnitError, conversion, measures
from ..recordings.vocabulary import foreign_channel, plain
from .unpacking import description_in, text_in

TIMEOUT = 300.0
"""Time [s] after which the replay of one recording is ended where none is given."""

QUANTITIES = MappingProxyType({"deflection": "m", "force": "N", "radius": "m"})
"""What a variable of an FMU may be, and the SI unit of it."""

SHORT = MappingProxyType(
    {
        "deflection": ("x", "s", "z", "s rel", "dx", "tire deflection", "suspension deflection"),
        "force": ("f", "fz", "fn", "f n", "tire force", "spring force"),
        "radius": ("surface radius", "r"),
    }
)
"""Names that models have for a quantity, besides those of columns in recordings."""

ENDINGS = ("m", "cm", "mm", "um", "N", "kN", "mN", "daN", "lbf", "kgf")
"""Units that a variable's name may end in: x_mm."""

IN_BRACKETS = re.compile(r"(?P<name>.+?)\s+\[(?P<unit>[^\[\]]+)\]")

EXAMPLE = 'deflection=x,force="F [kN]"'


@dataclass(frozen=True)
class Simulation:
    """A simulation that is asked for: the file of its FMU, its variables as named by the user, and a time limit [s]."""

    fmu: Path
    variables: Mapping[str, str] = field(default_factory=dict)
    timeout: float = TIMEOUT

    def words(self) -> list[str]:
        """Return the words of a command line that ask for it."""
        words = ["--fmu", str(self.fmu)]
        if self.variables:
            words += ["--variables", assignments_text(self.variables)]
        return words if self.timeout == TIMEOUT else [*words, "--fmu-timeout", f"{self.timeout:g}"]


@dataclass(frozen=True)
class Terminal:
    """A variable of an FMU, its value reference, and by what its value is multiplied to be SI, compression positive.

    unit: in which it is, as the user or the FMU says, or the end of its name; "" where nothing does: then it is SI
    """

    name: str
    reference: int
    factor: float
    unit: str = ""


@dataclass(frozen=True)
class ForeignFmu:
    """An FMU whose force is replayed.

    version: of FMI, "2.0" or "3.0"; kind: "CoSimulation" or "ModelExchange"; even_steps: whether it takes steps of one
    length only; radius: its input for the ground, None where it has none; notes: what was taken for what
    """

    path: Path
    version: str
    kind: str
    even_steps: bool
    deflection: Terminal
    force: Terminal
    radius: Terminal | None
    notes: tuple[str, ...]


def parse_variables(text: str) -> dict[str, str]:
    """Return the assignments in the text of --variables; raises TirelabError where they cannot be read."""
    return assignments(text, "--variables", EXAMPLE, _known)


def _known(name: str, where: str) -> None:
    if name not in QUANTITIES:
        raise TirelabError(f"{where}: {name!r} is no variable of a simulation; give {', '.join(QUANTITIES)}")


def tire_inside(path: Path) -> TireModel | None:
    """Return the tire in an FMU that tirelab made; None where it is anybody else's. Runs nothing of it.

    Raises TirelabError where it is no archive, or its tire cannot be read.
    """
    text, names = text_in(path, "resources/tire.json")
    if text is not None:
        try:
            return from_text(text)
        except TireFileError as error:
            raise TirelabError(f"{path}: its resources/tire.json cannot be read: {error}") from None
    if "resources/tire.dat" in names:
        raise TirelabError(
            f"{path} is a native FMU of an older tirelab, which holds no tire file; build it again, or give the tire "
            "with --tire"
        )
    return None


def read_foreign(asked: Simulation) -> ForeignFmu:
    """Return what the FMU's description says of its variables; runs nothing of it.

    Raises TirelabError where it is no FMU of FMI 2.0 or 3.0, has no binary for this machine, or where it is not clear
    which variable is which.
    """
    path = asked.fmu
    description = _description(path)
    kind = "CoSimulation" if description.coSimulation is not None else "ModelExchange"
    if getattr(description, kind[0].lower() + kind[1:]) is None:
        raise TirelabError(
            f"{path} is for neither Co-Simulation nor Model Exchange; export it for one of them"
        )
    if fmpy.platform not in fmpy.supported_platforms(str(path)):
        raise TirelabError(f"{path} has no binary for this machine ({fmpy.platform}); export it for that")
    inputs = _reals(description, "input")
    outputs = _reals(description, "output")
    choose = _Chooser(path, asked.variables, inputs, outputs)
    deflection, force = choose("deflection", inputs, True), choose("force", outputs, True)
    radius = choose("radius", inputs, False)
    assert deflection is not None
    assert force is not None
    taken = {deflection.name, force.name, *([] if radius is None else [radius.name])}
    left = [name for name in inputs if name not in taken]
    tool = description.generationTool or "an unknown tool"
    said = [
        f"{path.name} (FMI {description.fmiVersion}, {kind}, of {tool}): its {deflection.name} is "
        f"taken for the deflection [{deflection.unit or 'm'}], its {force.name} for the force [{force.unit or 'N'}]"
        + ("" if deflection.unit and force.unit else ", SI where it states no unit")
        + ("" if radius is None else f", its {radius.name} for the surface's radius")
        + (f"; left at their start: {', '.join(left)}" if left else "")
    ]
    steps = description.coSimulation
    even = steps is not None and not steps.canHandleVariableCommunicationStepSize
    return ForeignFmu(path, description.fmiVersion[:3], kind, even, deflection, force, radius, tuple(said))


def _description(path: Path) -> ModelDescription:
    description = description_in(path, validate=False, again="export it again")
    if not description.fmiVersion.startswith(("2.", "3.")):
        raise TirelabError(f"{path} is FMI {description.fmiVersion}; export it as FMI 2.0 or 3.0")
    return description


def _reals(description: ModelDescription, causality: str) -> dict[str, ScalarVariable]:
    """Return the scalar real variables of a causality by their names."""
    return {
        v.name: v
        for v in description.modelVariables
        if v.causality == causality and v.type in ("Real", "Float64") and not v.dimensions
    }


@dataclass(frozen=True)
class _Chooser:
    """Chooses the variable that is a quantity: the one that the user names, else the one that its name, its unit, or
    its being the only one tells."""

    path: Path
    named: Mapping[str, str]
    inputs: Mapping[str, ScalarVariable]
    outputs: Mapping[str, ScalarVariable]

    def __call__(self, quantity: str, among: Mapping[str, ScalarVariable], needed: bool) -> Terminal | None:
        if quantity in self.named:
            return self._named(quantity, among)
        words: Callable[[str], bool] = lambda name: _is_called(name, quantity)  # noqa: E731
        rivals = [n for n, v in among.items() if words(n) and self._unit_fits(v, quantity)]
        if not rivals and needed:
            rivals = [n for n, v in among.items() if v.unit and measures(v.unit, QUANTITIES[quantity])]
        if not rivals and needed and len(among) == 1:
            rivals = list(among)
        if len(rivals) == 1 and needed and quantity == "force":
            # One of several forces may be a part of the whole.
            rivals += [n for n in among if n not in rivals and _words(n)[-1:] == ["force"]]
        if len(rivals) == 1:
            return self._terminal(quantity, among[rivals[0]], 1.0, None)
        if not needed:
            return None
        what = "is called so" if not rivals else f"may be it: {', '.join(rivals)}"
        raise TirelabError(
            f"{self.path}: which variable is the {quantity}? {'None' if not rivals else 'More than one'} {what}. Its "
            f"inputs are {_listed(self.inputs)}, its outputs {_listed(self.outputs)}; say it with "
            f"--variables {quantity}=NAME"
        )

    def _named(self, quantity: str, among: Mapping[str, ScalarVariable]) -> Terminal:
        text, unit, sign = self.named[quantity], None, 1.0
        if text not in among and (found := IN_BRACKETS.fullmatch(text)):
            text, unit = found["name"], found["unit"]
        if text not in among and text.startswith("-"):
            text, sign = text[1:], -1.0
        if text not in among:
            kind = "output" if quantity == "force" else "input"
            raise TirelabError(
                f"{self.path} has no real {kind} {text!r} for --variables {quantity}=...; it has {_listed(among)}"
            )
        return self._terminal(quantity, among[text], sign, unit)

    def _terminal(self, quantity: str, variable: ScalarVariable, sign: float, unit: str | None) -> Terminal:
        si = QUANTITIES[quantity]
        behind = _unit_behind(variable.name)
        known = unit or variable.unit or (behind if behind and measures(behind, si) else "")
        try:
            way = conversion(known or si, si)
        except UnitError as error:
            raise TirelabError(
                f"{self.path}: {error}; say the unit of {variable.name} with "
                f'--variables {quantity}="{variable.name} [{si}]"'
            ) from None
        factor = sign * float(way.to_si(np.array([1.0]))[0])
        return Terminal(variable.name, variable.valueReference, factor, known)

    @staticmethod
    def _unit_fits(variable: ScalarVariable, quantity: str) -> bool:
        return not variable.unit or measures(variable.unit, QUANTITIES[quantity])


def _is_called(name: str, quantity: str) -> bool:
    """Whether the last part of a variable's name is a word for a quantity, as for columns of recordings."""
    last = " ".join(_words(name))
    words = {plain(w) for channel in CHANNELS if channel.name == quantity for w in channel.words}
    return last in words or last in SHORT[quantity] or foreign_channel(last) == quantity


def _words(name: str) -> list[str]:
    """Return the words of the last part of a variable's name, without a unit behind them: `rig.piston_force_kN`."""
    return plain(name.rpartition(".")[2].removesuffix(f"_{_unit_behind(name)}")).split()


def _unit_behind(name: str) -> str:
    """Return the unit that a variable's name ends in, "" without one; in `x_rod` and `F_dyn` the word is none."""
    tail = name.rpartition("_")[2]
    return tail if tail in ENDINGS else ""


def _listed(names: Iterable[str]) -> str:
    found = list(names)
    more = f" and {len(found) - 12} more" if len(found) > 12 else ""
    return (", ".join(found[:12]) or "none") + more
