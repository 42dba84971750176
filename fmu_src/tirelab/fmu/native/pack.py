"""A tire as a native FMU: FMI 2.0 or 3.0, Co-Simulation and Model Exchange, binaries for five platforms and sources.

Nothing is compiled here: the binaries serve every tire, whose numbers are in resources/tire.dat. The variables are
those of the Python FMU with the same value references; after them come those that only this kind has.
"""

from __future__ import annotations

import importlib.metadata
import json
import struct
import tempfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from bicycle_tire_fmu import BicycleTire
from fmu_description import BASE_UNITS
from radialtire import Flow, TireModel, flat_law, parameters_of, write_tire
from radialtire.effect import PLACES
from radialtire.flat_step import Stage
from radialtire.tirefile import to_text

from ...errors import TirelabError
from .. import documentation
from ..archive import MODEL, check_fmu, content_guid, named_for_xml, write_archive, xml_text
from . import kernel
from .fmi3 import as_fmi3
from .make import PLATFORMS, c_files, source_files

RATE, ACCELERATION, GIVEN = "deflection_rate", "deflection_acceleration", "motion_given"
"""Variables of a tire whose effects use the rate or the acceleration of the deflection."""


@dataclass(frozen=True)
class NativeFmu:
    """A native FMU that was written: its path and its GUID."""

    path: Path
    guid: str


@dataclass(frozen=True)
class ContinuousState:
    """A state of a solver: its name, its unit, and its index in the kernel's state.

    whole: index of the number that is the sum of this state and of what the steps keep in its place; else `index`
    """

    name: str
    unit: str
    index: int
    whole: int


def build_native_fmu(tire: TireModel, folder: Path, *, fmi: int = 2) -> NativeFmu:
    """Write `folder`/BicycleTire.fmu for `tire`, FMI 2.0 or 3.0, and return what was written.

    Raises TirelabError where the folder cannot be written, the binaries are not there, or the FMU is not valid.
    """
    tire = named_for_xml(tire)
    if tire.remainder is not None:
        raise TirelabError(
            "a learned remainder runs in the Python FMU only; leave out --native, or build the tire without it"
        )
    if tire.curve is not None:
        raise TirelabError("a part with a curve runs in the Python FMU only; leave out --native")
    description = described(tire)
    members = documentation.pages(tire, description, None, fmi=fmi)
    key = "guid"
    if fmi == 3:
        description, key = as_fmi3(description), "instantiationToken"
    members |= {f"sources/{name}": content for name, content in source_files(fmi).items()}
    members["sources/buildDescription.xml"] = xml_text(build_description(fmi))
    for platform in PLATFORMS:
        library = platform.library(fmi)
        if not library.is_file():
            raise TirelabError(
                f"{library} is missing; install the package again, or python -m tirelab.fmu.native.make"
            )
        name = f"binaries/{platform.folder(fmi)}/{MODEL}.{platform.ending}"
        members[name] = library.read_bytes()
    # read by nothing in the FMU: so that its tire can be read from it
    members["resources/tire.json"] = json.dumps(json.loads(to_text(tire)), separators=(",", ":")).encode()
    members["resources/tire.dat"] = data(tire, "")
    guid = content_guid(members, description, key)
    description.set(key, guid)
    members["resources/tire.dat"] = data(tire, guid)
    members["modelDescription.xml"] = xml_text(description)
    path = write_archive(members, folder / f"{MODEL}.fmu", check_fmu)
    return NativeFmu(path, guid)


def continuous_states(tire: TireModel) -> list[ContinuousState]:
    """Return the states that a solver integrates in Model Exchange."""
    _, path, _, _ = kernel.universal()
    stages: list[Stage] = [stage for place in PLACES for stage in getattr(path, place)]
    found = []
    for effect, _ in tire.effects:
        flow: Flow | None = effect.flow
        if flow is not None:
            (stage,) = (stage for stage in stages if stage.respond is effect.respond)
            for index, name, unit in zip(flow.states, flow.names, flow.units, strict=True):
                whole = index if flow.whole is None else flow.whole
                indices = stage.state + index, stage.state + whole
                found.append(ContinuousState(f"{effect.name}.{name}", unit, *indices))
    return found


def data(tire: TireModel, guid: str) -> bytes:
    """Return resources/tire.dat: the tire's numbers, bit by bit, and where each parameter stands."""
    law = flat_law.laid_out(tire.law)
    effects = kernel.parameters_of(tire)
    tested = tire.tested_range
    bounds = (
        ()
        if tested is None
        else (tested.curvature_min, tested.curvature_max, tested.deflection_max, tested.force_max)
    )
    states = continuous_states(tire)
    lines = [
        f"tirelab-tire 2 {kernel.layout()}",
        f"guid {guid}",
        _row("law", law),
        _row("effects", effects),
        _row("range", bounds),
        f"bare {int(tire.bare)}",
        " ".join(["continuous", str(len(states)), *(f"{state.index} {state.whole}" for state in states)]),
        f"parameters {len(parameters_of(tire))}",
    ]
    places = kernel.places()
    of_law = {f"law.{parameter.name}": 1 + i for i, parameter in enumerate(tire.law.parameters)}
    for name, (parameter, _) in parameters_of(tire).items():
        row, index = ("q", of_law[name]) if name in of_law else ("p", places[name])
        lines.append(f"{name} {row} {index} {_bits(parameter.minimum)} {_bits(parameter.maximum)}")
    lines.append(f"channels {len(tire.channels)}")
    for number, channel, start in tire.channels:
        values = (start, channel.minimum, channel.maximum, channel.unknown)
        lines.append(" ".join([channel.variable, str(number), *map(_bits, values)]))
    text = "\n".join(lines) + "\n"
    return f"{text}end {checksum(text.encode()):016x}\n".encode()


def checksum(content: bytes) -> int:
    """Return the 64-bit FNV-1a sum."""
    found = 14695981039346656037
    for byte in content:
        found = ((found ^ byte) * 1099511628211) % 2**64
    return found


def _bits(value: float) -> str:
    return struct.pack(">d", value).hex()


def _row(name: str, values: list[float] | tuple[float, ...]) -> str:
    return " ".join([name, str(len(values)), *map(_bits, values)])


def described(tire: TireModel) -> Element:
    """Return the model description: the variables of the Python FMU, and what only this kind has."""
    with tempfile.TemporaryDirectory(prefix="tirelab_") as name:
        write_tire(tire, Path(name) / "tire.json")
        root = BicycleTire(instance_name=MODEL, resources=name).to_xml()
    root.set("generationTool", f"tirelab {importlib.metadata.version('tirelab')}")
    states = continuous_states(tire)
    simulation = root.find("CoSimulation")
    variables = root.find("ModelVariables")
    structure = root.find("ModelStructure")
    assert simulation is not None
    assert variables is not None
    assert structure is not None
    if tire.differentiates:
        _add_motion(variables)
    first = len(variables)
    _add_states(variables, states)
    _add_units(root)

    experiment = root.find("DefaultExperiment")
    assert experiment is not None
    experiment.set("tolerance", "1e-6")  # of a solver
    simulation.set("providesDirectionalDerivative", "true")
    exchange = Element(
        "ModelExchange",
        modelIdentifier=MODEL,
        completedIntegratorStepNotNeeded=str(not tire.effects).lower(),
        canNotUseMemoryManagementFunctions="true",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
        providesDirectionalDerivative="true",
    )
    root.insert(0, exchange)
    root.set("numberOfEventIndicators", "1")
    for kind in (exchange, simulation):
        files = SubElement(kind, "SourceFiles")
        for file in c_files(2):
            SubElement(files, "File", name=file)

    inputs = [i for i, v in enumerate(variables, 1) if v.get("causality") == "input"]
    parameters = [i for i, v in enumerate(variables, 1) if v.get("causality") == "parameter"]
    of_states = list(range(first + 1, first + 1 + len(states)))
    rates = [i + len(states) for i in of_states]
    outputs, unknowns = structure.find("Outputs"), structure.find("InitialUnknowns")
    assert outputs is not None
    assert unknowns is not None
    now, at_start = _words(inputs + of_states), _words(inputs + parameters)
    for output in outputs:
        output.set("dependencies", now)
    for unknown in unknowns:
        unknown.set("dependencies", at_start)
    if states:
        derivatives = Element("Derivatives")
        structure.insert(1, derivatives)
        for index in rates:
            SubElement(derivatives, "Unknown", index=str(index), dependencies=now)
        for index in of_states + rates:
            SubElement(unknowns, "Unknown", index=str(index), dependencies=at_start)
    return root


def _words(numbers: list[int]) -> str:
    return " ".join(map(str, numbers))


def _variable(variables: Element, name: str, text: str, **attributes: str) -> Element:
    reference = str(len(variables))
    known = {"name": name, "valueReference": reference, "description": text}
    return SubElement(variables, "ScalarVariable", {**known, **attributes})


def _add_motion(variables: Element) -> None:
    """Add the inputs for a deflection whose rate and acceleration the host knows."""
    given = f"; used in Model Exchange, and in Co-Simulation where {GIVEN} is true"
    for name, text, unit in (
        (RATE, "Rate of the deflection", "m/s"),
        (ACCELERATION, "Acceleration of the deflection", "m/s2"),
    ):
        one = _variable(variables, name, text + given, causality="input", variability="continuous")
        SubElement(one, "Real", start="0.0", unit=unit)
    one = _variable(
        variables,
        GIVEN,
        f"Whether {RATE} and {ACCELERATION} are used in Co-Simulation; else both follow from the deflection's history",
        causality="parameter",
        variability="tunable",
        initial="exact",
    )
    SubElement(one, "Boolean", start="false")


def _add_states(variables: Element, states: list[ContinuousState]) -> None:
    first = len(variables)
    local = {"causality": "local", "variability": "continuous", "initial": "calculated"}
    for state in states:
        one = _variable(variables, state.name, "State that a solver integrates in Model Exchange", **local)
        SubElement(one, "Real", unit=state.unit)
    for number, state in enumerate(states, first + 1):
        one = _variable(variables, f"der({state.name})", f"Rate of {state.name}", **local)
        unit = "N/s" if state.unit == "N" else "N/s2"
        SubElement(one, "Real", unit=unit, derivative=str(number))


def _add_units(root: Element) -> None:
    """Declare the units that the added variables have."""
    units, variables = root.find("UnitDefinitions"), root.find("ModelVariables")
    assert units is not None
    assert variables is not None
    declared = {unit.get("name") for unit in units}
    for name in sorted({v[0].get("unit", "") for v in variables} - {""}):
        if name not in declared:
            unit = SubElement(units, "Unit", name=name)
            SubElement(unit, "BaseUnit", BASE_UNITS[name])


def build_description(fmi: int) -> Element:
    """Return sources/buildDescription.xml: how an importer may compile the sources."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = SubElement(root, "BuildConfiguration", modelIdentifier=MODEL)
    files = SubElement(
        configuration, "SourceFileSet", language="C99", compilerOptions="-O2 -ffp-contract=off"
    )
    for file in c_files(fmi):
        SubElement(files, "SourceFile", name=file)
    mathematics = "pow, exp, log and others; Windows and macOS have them in their C library"
    SubElement(configuration, "Library", name="m", external="true", description=mathematics)
    return root
