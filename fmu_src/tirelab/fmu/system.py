"""A simulation and its correction coupled: an SSP archive, System Structure and Parameterization 1.0.

    deflection -> [before: Correction.fmu ->] simulation: FMU of others -> correction: Correction.fmu -> corrected_force

`before` stands there where the correction acts before the simulation; it is the same FMU once more, so that no
connection runs back. References: SSP 1.0, Modelica Association 2019, sections 4 and 5.3; its XML schema as fmpy has it.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from fmpy.ssp.ssd import read_ssd

from ..errors import TirelabError
from .archive import write_archive, xml_text
from .foreign import ForeignFmu, Terminal

SSC = "http://ssp-standard.org/SSP1/SystemStructureCommon"
SSD = "http://ssp-standard.org/SSP1/SystemStructureDescription"

SYSTEM = "Corrected.ssp"

Ends = tuple[str, str, str, str]
"""Of a connection: element and connector of its start and of its end; "" is the system itself."""


def write_system(
    simulation: ForeignFmu, correction: Path, folder: Path, *, moves: bool, surfaces: bool
) -> Path:
    """Write `folder`/Corrected.ssp and return its path.

    moves: whether the simulation is given the correction's deflection; surfaces: whether the surface's radius is an
    input of the system (else the correction keeps its own)
    Raises TirelabError where it cannot be written or breaks the standard's schema.
    """
    members = {
        "SystemStructure.ssd": xml_text(_described(simulation, moves, surfaces)),
        "resources/Simulation.fmu": simulation.path.read_bytes(),
        "resources/Correction.fmu": correction.read_bytes(),
    }
    return write_archive(members, folder / SYSTEM, _check_system)


def _check_system(path: Path) -> None:
    try:
        read_ssd(str(path))
    except Exception as error:  # fmpy raises plain Exception where the schema refuses it
        raise TirelabError(
            f"{path.name} breaks the SSP standard ({error}); report this with the FMU"
        ) from None


def _described(simulation: ForeignFmu, moves: bool, surfaces: bool) -> Element:
    ElementTree.register_namespace("ssc", SSC)
    ElementTree.register_namespace("ssd", SSD)
    root = Element(f"{{{SSD}}}SystemStructureDescription", version="1.0", name="Corrected")
    system = SubElement(root, f"{{{SSD}}}System", name="corrected")
    ends, ways = _connections(simulation, moves, surfaces)
    _connectors(system, "", ends, {"": "output", "inner": "input"})
    elements = SubElement(system, f"{{{SSD}}}Elements")
    for name in ("before", "simulation", "correction"):
        if not any(name in (start, end) for start, _, end, _ in ends):
            continue
        file = "Simulation" if name == "simulation" else "Correction"
        kind = simulation.kind if name == "simulation" else "CoSimulation"
        component = SubElement(
            elements, f"{{{SSD}}}Component", name=name, source=f"resources/{file}.fmu", implementation=kind
        )
        _connectors(component, name, ends, {"": "input", "inner": "output"})
    connections = SubElement(system, f"{{{SSD}}}Connections")
    for (start, out, end, into), factor in zip(ends, ways, strict=True):
        elements_of = {key: value for key, value in (("startElement", start), ("endElement", end)) if value}
        connection = SubElement(
            connections, f"{{{SSD}}}Connection", elements_of, startConnector=out, endConnector=into
        )
        if factor != 1.0:
            SubElement(connection, f"{{{SSC}}}LinearTransformation", factor=repr(factor), offset="0.0")
    return root


def _connectors(parent: Element, name: str, ends: list[Ends], kinds: dict[str, str]) -> None:
    """Write the connectors of an element that connections use; kinds: of ends "" and of starts "inner"."""
    found: dict[str, str] = {}
    for start, out, end, into in ends:
        if start == name:
            found[out] = kinds["inner"]
        if end == name:
            found[into] = kinds[""]
    connectors = SubElement(parent, f"{{{SSD}}}Connectors")
    for connector, kind in found.items():
        entry = SubElement(connectors, f"{{{SSD}}}Connector", name=connector, kind=kind)
        SubElement(entry, f"{{{SSC}}}Real")


def _connections(simulation: ForeignFmu, moves: bool, surfaces: bool) -> tuple[list[Ends], list[float]]:
    """Return the connections, and the factor of each from the start's value to the end's."""
    radius = "surface_radius"
    found: list[tuple[Ends, float]] = [(("", "deflection", "correction", "deflection"), 1.0)]
    source = ""
    if moves:
        found.append((("", "deflection", "before", "deflection"), 1.0))
        source = "before"
    deflection = "tire_deflection" if moves else "deflection"
    found.append(((source, deflection, "simulation", simulation.deflection.name), _to(simulation.deflection)))
    if surfaces:
        found += [(("", radius, name, radius), 1.0) for name in ("before", "correction")[0 if moves else 1 :]]
        if simulation.radius is not None:
            found.append((("", radius, "simulation", simulation.radius.name), _to(simulation.radius)))
    force = simulation.force
    found.append((("simulation", force.name, "correction", "simulated_force"), force.factor))
    found.append((("correction", "corrected_force", "", "corrected_force"), 1.0))
    return [ends for ends, _ in found], [factor for _, factor in found]


def _to(terminal: Terminal) -> float:
    return 1.0 / terminal.factor
