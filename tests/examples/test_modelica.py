"""The Modelica wrapper: its syntax, and that it says of the FMU what the FMU says of itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import fmpy
import pytest
from radialtire import TireModel
from tirelab.fmu.build import build_fmu

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


def test_the_import_is_named(wrapper: Any, repository: Path) -> None:
    assert str(wrapper.symbols["fmu"].type) == "BicycleTire_fmu"
    text = (repository / "examples" / "modelica" / "BicycleTire.mo").read_text(encoding="utf-8")
    assert "dist/BicycleTire.fmu" in text
