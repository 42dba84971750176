"""The model description of FMI 3.0, from that of FMI 2.0: the same variables with the same value references.

FMI 3.0 wants two more variables: time, and the one whose sign tells of contact. Structure names variables by their
value references where FMI 2.0 counts them from 1.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

TIME, CONTACT = "time", "contact_deflection"
"""The variables that FMI 2.0 does not have; their value references follow the others."""

TYPES = {"Real": "Float64", "Boolean": "Boolean"}

KEPT = (
    "modelName",
    "description",
    "author",
    "version",
    "license",
    "generationTool",
    "variableNamingConvention",
)

COMMON = {
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
    "providesDirectionalDerivatives": "true",
}


def as_fmi3(old: Element) -> Element:
    """Return the description in FMI 3.0; its instantiation token is to be set."""
    kept = {name: value for name in KEPT if (value := old.get(name)) is not None}
    root = Element("fmiModelDescription", {"fmiVersion": "3.0", "instantiationToken": "", **kept})
    exchange, simulation = old.find("ModelExchange"), old.find("CoSimulation")
    assert exchange is not None
    assert simulation is not None
    identifier = exchange.get("modelIdentifier", "")
    acting = exchange.get("completedIntegratorStepNotNeeded") != "true"
    own = {"needsCompletedIntegratorStep": str(acting).lower()}
    SubElement(root, "ModelExchange", {"modelIdentifier": identifier, **own, **COMMON})
    own = {"canHandleVariableCommunicationStepSize": "true"}
    SubElement(root, "CoSimulation", {"modelIdentifier": identifier, **own, **COMMON})
    for name in ("UnitDefinitions", "LogCategories", "DefaultExperiment"):
        if (part := old.find(name)) is not None:
            root.append(part)
    for category in root.iterfind("LogCategories/Category"):
        category.set("description", category.get("description", "").replace("fmi2", "fmi3"))
    if (units := root.find("UnitDefinitions")) is not None and all(u.get("name") != "s" for u in units):
        SubElement(SubElement(units, "Unit", name="s"), "BaseUnit", s="1")

    variables = old.find("ModelVariables")
    assert variables is not None
    references = [variable.get("valueReference", "") for variable in variables]
    described = SubElement(root, "ModelVariables")
    for variable in variables:
        described.append(_variable(variable, references))
    _add_own(described)
    root.append(_structure(old, references, CONTACT_OFFSET + len(references), acting))
    return root


CONTACT_OFFSET = 1
"""The contact follows the time, which follows the variables of FMI 2.0."""


def _variable(old: Element, references: list[str]) -> Element:
    """Return one variable: the attributes of FMI 2.0's two elements, in one of the type's name."""
    (typed,) = old
    merged = {**old.attrib, **typed.attrib}
    if "derivative" in merged:
        merged["derivative"] = references[int(merged["derivative"]) - 1]
    if typed.tag == "Boolean" and merged["causality"] == "parameter":
        merged["variability"] = "tunable"
    return Element(TYPES[typed.tag], merged)


def _add_own(variables: Element) -> None:
    first = len(variables)
    for name, reference, text, attributes in (
        (TIME, first, "Time", {"causality": "independent", "unit": "s"}),
        (
            CONTACT,
            first + CONTACT_OFFSET,
            "The tire's own deflection, whose sign tells of contact",
            {"causality": "local", "initial": "calculated", "unit": "m", "nominal": "0.01"},
        ),
    ):
        known = {"name": name, "valueReference": str(reference), "description": text}
        SubElement(variables, "Float64", {**known, "variability": "continuous", **attributes})


def _structure(old: Element, references: list[str], contact: int, acting: bool) -> Element:
    """Return the structure: who depends on whom, by value references.

    acting: whether there are effects. Then what depends on what is left out, which means everything on everything, as
    some effects depend on time itself; the bare law depends on inputs and, other than in FMI 2.0, on parameters.
    """
    variables = old.find("ModelVariables")
    assert variables is not None
    known = [v.get("valueReference", "") for v in variables if v.get("causality") in ("input", "parameter")]
    depends = {} if acting else {"dependencies": " ".join(known)}
    structure = Element("ModelStructure")
    for place, name in (
        ("Outputs", "Output"),
        ("Derivatives", "ContinuousStateDerivative"),
        ("InitialUnknowns", "InitialUnknown"),
    ):
        for unknown in old.iterfind(f"ModelStructure/{place}/Unknown"):
            reference = references[int(unknown.get("index", "")) - 1]
            SubElement(structure, name, {"valueReference": reference, **depends})
    SubElement(structure, "EventIndicator", valueReference=str(contact))
    return structure
