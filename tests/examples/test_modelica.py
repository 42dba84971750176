"""The Modelica wrapper: its syntax, and that it says of the FMU what the FMU says of itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import fmpy
import pytest
from radialtire import TireModel
from tirelab.fmu.build import build_fmu
from tirelab.fmu.native.pack import build_native_fmu

parser = pytest.importorskip("pymoca.parser")


@pytest.fixture(scope="module")
def wrapper(repository: Path) -> Any:
    """The block BicycleTire, parsed."""
    text = (repository / "examples" / "modelica" / "BicycleTire.mo").read_text(encoding="utf-8")
    tree = parser.parse(text)
    assert tree is not None, "BicycleTire.mo is not Modelica"
    return tree.classes["BicycleTire"]


def _modified(symbol: Any) -> dict[str, Any]:
    """The attributes that a declaration modifies, as (unit="m", min=0)."""
    return {
        str(argument.value.component): argument.value.modifications[0]
        for argument in symbol.class_modification.arguments
    }


def test_inputs_outputs_and_units_are_the_fmus(wrapper: Any, tmp_path: Path) -> None:
    fmu = build_fmu(TireModel(), tmp_path).path
    connected = {
        end.child[0].name
        for equation in wrapper.equations
        for end in (equation.left, equation.right)
        if end.name == "fmu"
    }
    for variable in fmpy.read_model_description(str(fmu)).modelVariables:
        if variable.causality not in ("input", "output"):
            continue
        symbol = wrapper.symbols[variable.name]
        kind = "Real" if variable.type == "Real" else "Boolean"
        assert str(symbol.type) == f"Modelica.Blocks.Interfaces.{kind}{variable.causality.capitalize()}"
        assert variable.name in connected
        if variable.unit:
            assert _modified(symbol)["unit"].value == variable.unit
    assert len(connected) == len(wrapper.equations) == 5


def test_the_parameters_are_the_fmus(wrapper: Any, tmp_path: Path) -> None:
    """Ten constants of the law, each with the FMU's start, bounds and unit, and each handed to the FMU by its name."""
    fmu = build_native_fmu(TireModel(), tmp_path).path
    (law,) = (
        argument.value
        for argument in wrapper.symbols["fmu"].class_modification.arguments
        if str(argument.value.component) == "law"
    )
    handed = {str(a.value.component): str(a.value.modifications[0]) for a in law.modifications[0].arguments}
    described = [
        v for v in fmpy.read_model_description(str(fmu)).modelVariables if v.causality == "parameter"
    ]
    assert len(described) == len(handed) == 10
    for variable in described:
        name = variable.name.removeprefix("law.")
        symbol = wrapper.symbols[name]
        assert "parameter" in symbol.prefixes
        assert handed[name] == name
        given = _modified(symbol)
        assert given["value"].value == float(variable.start)
        assert (given["min"].value, given["max"].value) == (float(variable.min), float(variable.max))
        assert ("unit" in given) == (variable.unit is not None)


def test_the_article_s_force_is_never_negative(wrapper: Any, tmp_path: Path) -> None:
    """min=0 stands where it is true: on force and stiffness of a tire without effects, not on the deflection."""
    fmu = build_native_fmu(TireModel(), tmp_path).path
    for variable in fmpy.read_model_description(str(fmu)).modelVariables:
        if variable.name in ("radial_force", "radial_stiffness"):
            assert float(variable.min) == _modified(wrapper.symbols[variable.name])["min"].value == 0


def test_the_import_is_named(wrapper: Any, repository: Path) -> None:
    assert str(wrapper.symbols["fmu"].type) == "BicycleTire_fmu"
    text = (repository / "examples" / "modelica" / "BicycleTire.mo").read_text(encoding="utf-8")
    assert "dist/BicycleTire.fmu" in text
