"""What an FMU's model description says and pythonfmu does not write: units, bounds, dependencies of the outputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

OPTIONS = {"needsExecutionTool": "false", "canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true"}
"""Capabilities of the FMUs, which pythonfmu takes and writes."""

BASE_UNITS: dict[str, dict[str, str]] = {
    "m": {"m": "1"},
    "s": {"s": "1"},
    "kg": {"kg": "1"},
    "K": {"K": "1"},
    "N": {"kg": "1", "m": "1", "s": "-2"},
    "Pa": {"kg": "1", "m": "-1", "s": "-2"},
    "N/m": {"kg": "1", "s": "-2"},
    "N.s/m": {"kg": "1", "s": "-1"},
    "N/s": {"kg": "1", "m": "1", "s": "-3"},
    "N/s2": {"kg": "1", "m": "1", "s": "-4"},
    "m/s": {"m": "1", "s": "-1"},
    "m/s2": {"m": "1", "s": "-2"},
    "m3": {"m": "3"},
    "1/s": {"s": "-1"},
    "1/m": {"m": "-1"},
    "1/cm": {"m": "-1", "factor": "100"},
    "1/N": {"kg": "-1", "m": "-1", "s": "2"},
    "s/m": {"m": "-1", "s": "1"},
    "m/N": {"kg": "-1", "s": "2"},
    "1": {},
}
"""Units as products of SI base units; one that is not here (N/cm^B) has no fixed dimension: it stands in words only."""

DISPLAY_UNITS: dict[str, dict[str, str]] = {
    "m": {"mm": "1000", "cm": "100", "in": "39.37007874015748"},
    "N": {"kN": "0.001", "lbf": "0.22480894309971047"},
    "N/m": {"N/mm": "0.001", "kN/m": "0.001"},
    "Pa": {"bar": "1e-05", "psi": "0.00014503773773020923"},
}


def complete(
    root: Element,
    traits: Mapping[int, Mapping[str, str]],
    dependencies: Sequence[Sequence[int]],
    parameters: Sequence[int] = (),
) -> None:
    """Write into pythonfmu's model description what it lacks, and take out the date, which no two builds share.

    traits: attributes of variables by value reference, unit among them, which stands on every variable since some
    importers look only there; dependencies: of each output, the value references of the inputs that it uses;
    parameters: value references on which every output depends at the start as well. An index is a reference plus one.
    """
    del root.attrib["generationDateAndTime"]
    variables, structure = root.find("ModelVariables"), root.find("ModelStructure")
    assert variables is not None
    assert structure is not None
    for vr, variable in enumerate(variables):
        variable[0].attrib.update(traits.get(vr, {}))
    units = Element("UnitDefinitions")
    for name in sorted({trait["unit"] for trait in traits.values() if "unit" in trait}):
        unit = SubElement(units, "Unit", name=name)
        SubElement(unit, "BaseUnit", BASE_UNITS[name])
        for display, factor in {name: "1", **DISPLAY_UNITS.get(name, {})}.items():
            SubElement(unit, "DisplayUnit", name=display, factor=factor)
    root.insert(1, units)
    outputs = structure.find("Outputs")
    assert outputs is not None
    unknowns = SubElement(structure, "InitialUnknowns")
    for output, inputs in zip(outputs, dependencies, strict=True):
        output.set("dependencies", _indices(inputs))
        at_start = _indices([*inputs, *parameters])
        SubElement(unknowns, "Unknown", index=output.get("index", ""), dependencies=at_start)


def _indices(references: Sequence[int]) -> str:
    return " ".join(str(vr + 1) for vr in references)
