"""The Modelica wrapper: its syntax, that it says of the FMU what the FMU says of itself, and that it compiles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from radialtire import TireModel
from scipy.integrate import solve_ivp
from tirelab.fmu.build import build_fmu
from tirelab.fmu.native.pack import build_native_fmu

parser = pytest.importorskip("pymoca.parser")

IMPORTED = """
block BicycleTire_fmu "What a tool makes of the FMU, on flat ground"
  record Law
    {parameters}
  end Law;
  Law law;
  Modelica.Blocks.Interfaces.RealInput deflection;
  Modelica.Blocks.Interfaces.RealInput surface_radius;
  Modelica.Blocks.Interfaces.RealOutput radial_force;
  Modelica.Blocks.Interfaces.RealOutput radial_stiffness;
  Modelica.Blocks.Interfaces.BooleanOutput in_tested_range;
protected
  Real x = if deflection > 0 then 100 * deflection else 0;
equation
  radial_force = law.flat_coefficient * x ^ law.flat_exponent;
  radial_stiffness = 100 * law.flat_coefficient * law.flat_exponent * x ^ (law.flat_exponent - 1);
  in_tested_range = deflection < 0.03175;
end BicycleTire_fmu;
"""

AROUND = """
package Modelica
  package Blocks
    package Interfaces
      connector RealInput = input Real;
      connector RealOutput = output Real;
      connector BooleanOutput = output Boolean;
    end Interfaces;
  end Blocks;
end Modelica;

model Ringing "A mass of 3 kg and a weight of 1000 N on a tire with another A"
  BicycleTire tire(flat_coefficient = 600);
  Real x(start = 0.02, fixed = true);
  Real v(start = 0, fixed = true);
equation
  der(x) = v;
  3 * der(v) = 1000 - tire.radial_force;
  tire.deflection = x;
  tire.surface_radius = 1e5;
end Ringing;
"""


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


def test_the_block_compiles_and_hands_its_parameters_on(
    wrapper: Any, repository: Path, tmp_path: Path
) -> None:
    """In rumoca, with a class in place of the imported FMU and the interfaces of the standard library: it rings."""
    rumoca = pytest.importorskip("rumoca")
    block = (repository / "examples" / "modelica" / "BicycleTire.mo").read_text(encoding="utf-8")
    parameters = [name for name, symbol in wrapper.symbols.items() if "parameter" in symbol.prefixes]
    assert len(parameters) == 10
    imported = IMPORTED.format(parameters="\n    ".join(f"parameter Real {name} = 1;" for name in parameters))
    model = tmp_path / "Ringing.mo"
    model.write_text(AROUND + imported + block.replace("within ;", ""), encoding="utf-8")
    compiled = rumoca.Session().load(str(model), model="Ringing")
    found = compiled.simulate(t=(0, 0.1), dt=0.001)
    exact = solve_ivp(
        lambda _, y: [y[1], (1000.0 - 600.0 * (100.0 * max(y[0], 0.0)) ** 1.422) / 3.0],
        (0.0, 0.1),
        [0.02, 0.0],
        "DOP853",
        t_eval=np.asarray(found.time),
        rtol=1e-10,
        atol=1e-13,
    )
    np.testing.assert_allclose(found["x"], exact.y[0], atol=2e-5)
    assert np.ptp(found["x"]) > 0.005
