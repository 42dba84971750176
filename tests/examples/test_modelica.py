"""The Modelica wrappers: their syntax, that they say of the FMU what it says of itself, and that they compile."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from scipy.integrate import solve_ivp
from tirelab.fmu.build import build_fmu
from tirelab.fmu.native.pack import build_native_fmu

parser = pytest.importorskip("pymoca.parser")

NAMES = (
    "flat_coefficient",
    "convex_coefficient_drop",
    "convex_coefficient_decay",
    "concave_coefficient_rise",
    "concave_coefficient_decay",
    "flat_exponent",
    "convex_exponent_drop",
    "convex_exponent_decay",
    "concave_exponent_rise",
    "concave_exponent_decay",
)
WITH_A_RECORD = "record Law\n{parameters}\nend Law;\nLaw law;", "", "law."
FLAT = "{parameters}", "law_", "law_"
"""How a tool declares the FMU's parameters, what it writes before their names there, and where they are used."""

BLOCKS = {"BicycleTire": ("BicycleTire_fmu", WITH_A_RECORD), "BicycleTireOM": ("BicycleTire_me_FMU", FLAT)}
"""The class that each block names: that of tools with structured names; OpenModelica's importFMU writes MODEL_me_FMU
and each dot as an underscore (its CodegenFMU.tpl and FMIImpl.c)."""

IMPORTED = """
block {name} "What a tool makes of the FMU, on flat ground"
  {declared}
  Modelica.Blocks.Interfaces.RealInput deflection;
  Modelica.Blocks.Interfaces.RealInput surface_radius;
  Modelica.Blocks.Interfaces.RealOutput radial_force;
  Modelica.Blocks.Interfaces.RealOutput radial_stiffness;
  Modelica.Blocks.Interfaces.BooleanOutput in_tested_range;
protected
  Real x = if deflection > 0 then 100 * deflection else 0;
equation
  radial_force = {law}flat_coefficient * x ^ {law}flat_exponent;
  radial_stiffness = 100 * {law}flat_coefficient * {law}flat_exponent * x ^ ({law}flat_exponent - 1);
  in_tested_range = deflection < 0.03175;
end {name};
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
  {block} tire(flat_coefficient = 600);
  Real x(start = 0.02, fixed = true);
  Real v(start = 0, fixed = true);
equation
  der(x) = v;
  3 * der(v) = 1000 - tire.radial_force;
  tire.deflection = x;
  tire.surface_radius = 1e5;
end Ringing;
"""


def text_of(repository: Path, block: str) -> str:
    return (repository / "examples" / "modelica" / f"{block}.mo").read_text(encoding="utf-8")


@pytest.fixture(scope="module", params=BLOCKS)
def block(request: pytest.FixtureRequest) -> str:
    """The name of each block."""
    return str(request.param)


@pytest.fixture(scope="module")
def wrapper(repository: Path, block: str) -> Any:
    """The block, parsed."""
    tree = parser.parse(text_of(repository, block))
    assert tree is not None, f"{block}.mo is not Modelica"
    return tree.classes[block]


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
    given = _modified(wrapper.symbols["fmu"])
    if "law" in given:
        handed = {str(a.value.component): str(a.value.modifications[0]) for a in given["law"].arguments}
    else:
        handed = {}  # importFMU declares them with fixed=false, which the value given here would contradict
        for argument in wrapper.symbols["fmu"].class_modification.arguments:
            attributes, value = argument.value.modifications
            (fixed,) = attributes.arguments
            assert (str(fixed.value.component), fixed.value.modifications[0].value) == ("fixed", True)
            handed[str(argument.value.component).removeprefix("law_")] = str(value)
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


def test_the_inputs_of_a_tire_that_needs_its_motion(repository: Path, tmp_path: Path) -> None:
    """Those that the other block has not, with the FMU's units, connected; a force may be negative there."""
    damping = CATALOGUE["viscous_damping"]
    fmu = build_native_fmu(TireModel(effects=((damping, damping.nominal),)), tmp_path).path
    motion = parser.parse(text_of(repository, "BicycleTireMotionOM")).classes["BicycleTireMotionOM"]
    known = parser.parse(text_of(repository, "BicycleTireOM")).classes["BicycleTireOM"].symbols
    units = {
        variable.name: variable.unit
        for variable in fmpy.read_model_description(str(fmu)).modelVariables
        if variable.causality == "input" and variable.name not in known
    }
    assert {name: _modified(symbol)["unit"].value for name, symbol in motion.symbols.items()} == units
    connected = {(str(e.left), str(e.right)) for e in motion.equations}
    assert connected == {(name, f"fmu.{name}") for name in units}
    assert [str(clause.component) for clause in motion.extends] == ["BicycleTireOM"]


def test_the_article_s_force_is_never_negative(wrapper: Any, tmp_path: Path) -> None:
    """min=0 stands where it is true: on force and stiffness of a tire without effects, not on the deflection."""
    fmu = build_native_fmu(TireModel(), tmp_path).path
    variables = {v.name: v for v in fmpy.read_model_description(str(fmu)).modelVariables}
    for name in ("radial_force", "radial_stiffness"):
        assert float(variables[name].min) == _modified(wrapper.symbols[name])["min"].value == 0
    least = _modified(wrapper.symbols["deflection"])["min"]
    assert least.operator == "-"
    assert float(variables["deflection"].min) == -least.operands[0].value < 0.0


def test_the_import_is_named(wrapper: Any, repository: Path, block: str) -> None:
    assert str(wrapper.symbols["fmu"].type) == BLOCKS[block][0]
    assert "dist/BicycleTire.fmu" in text_of(repository, block)


def test_the_blocks_differ_in_the_import_only(repository: Path) -> None:
    """What stands before the imported class, and from the equations to the text on the import."""
    one, other = (text_of(repository, block) for block in BLOCKS)
    for begin, end in (("  parameter Real", "  BicycleTire_"), ("equation", "<h4>Import</h4>")):
        assert one[one.index(begin) : one.index(end)] == other[other.index(begin) : other.index(end)]


def test_the_block_compiles_and_hands_its_parameters_on(
    wrapper: Any, block: str, repository: Path, tmp_path: Path
) -> None:
    """In rumoca, with a class in place of the imported FMU and the interfaces of the standard library: it rings."""
    rumoca = pytest.importorskip("rumoca")
    name, (declared, before, law) = BLOCKS[block]
    assert [name for name, symbol in wrapper.symbols.items() if "parameter" in symbol.prefixes] == [*NAMES]
    parameters = "\n".join(f"parameter Real {before}{parameter} = 1;" for parameter in NAMES)
    imported = IMPORTED.format(name=name, declared=declared.format(parameters=parameters), law=law)
    model = tmp_path / "Ringing.mo"
    text = text_of(repository, block).replace("within ;", "")
    model.write_text(AROUND.format(block=block) + imported + text, encoding="utf-8")
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
