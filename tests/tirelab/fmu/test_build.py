"""The FMU as an archive: what is in it, what it says of itself, and that it is the same twice."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import fmpy.validation
import pytest
from radialtire import CATALOGUE, Effect, PowerLaw, TireModel, read_tire
from radialtire.effect import PLACES
from tirelab.errors import TirelabError
from tirelab.fmu.build import build_fmu
from tirelab.fmu.foreign import tire_inside
from tirelab.fmu.native.pack import build_native_fmu


def in_order() -> list[Effect]:
    """Every effect, in the order of the signal's path."""
    return sorted(CATALOGUE.values(), key=lambda effect: PLACES.index(effect.place))


def python_fmu(tire: TireModel, folder: Path) -> Path:
    return build_fmu(tire, folder, with_loader=False).path


def native_fmu(tire: TireModel, folder: Path) -> Path:
    return build_native_fmu(tire, folder).path


Build = Callable[[TireModel, Path], Path]
BOTH_KINDS = pytest.mark.parametrize("build", [python_fmu, native_fmu])


def described(fmu: Path) -> ElementTree.Element:
    with zipfile.ZipFile(fmu) as archive:
        return ElementTree.fromstring(archive.read("modelDescription.xml"))


@pytest.fixture(scope="module")
def description(article_fmu: Path) -> ElementTree.Element:
    return described(article_fmu)


def variable(description: ElementTree.Element, name: str) -> dict[str, str]:
    found = description.find(f"ModelVariables/ScalarVariable[@name='{name}']")
    assert found is not None
    return {**found.attrib, **found[0].attrib, "type": found[0].tag}


def test_it_is_valid_fmi_2(article_fmu: Path) -> None:
    assert fmpy.validation.validate_fmu(str(article_fmu)) == []


def test_capabilities(description: ElementTree.Element) -> None:
    assert description.get("fmiVersion") == "2.0"
    assert description.get("modelName") == "Hull, Wang & Moore 1996"
    simulation = description.find("CoSimulation")
    assert simulation is not None
    for capability, value in {
        "modelIdentifier": "BicycleTire",
        "needsExecutionTool": "false",
        "canHandleVariableCommunicationStepSize": "true",
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
        "canBeInstantiatedOnlyOncePerProcess": "false",
    }.items():
        assert simulation.get(capability) == value


def test_variables_have_units_and_meaning(description: ElementTree.Element) -> None:
    expected = {
        "deflection": ("input", "Real", "m", "mm"),
        "surface_radius": ("input", "Real", "m", "cm"),
        "radial_force": ("output", "Real", "N", "N"),
        "radial_stiffness": ("output", "Real", "N/m", "N/mm"),
        "in_tested_range": ("output", "Boolean", None, None),
    }
    for name, (causality, kind, unit, display) in expected.items():
        found = variable(description, name)
        assert (found["causality"], found["type"]) == (causality, kind)
        assert (found.get("unit"), found.get("displayUnit")) == (unit, display)
        assert found["description"]
        assert kind == "Boolean" or float(found["nominal"]) > 0
    assert float(variable(description, "deflection")["max"]) == 0.33
    assert float(variable(description, "radial_force")["min"]) == 0.0
    declared = {unit.get("name") for unit in description.iterfind("UnitDefinitions/Unit")}
    assert {
        v[0].get("unit") for v in description.iterfind("ModelVariables/*") if v[0].get("unit")
    } <= declared


@BOTH_KINDS
def test_start_values_are_the_numbers_themselves(tmp_path: Path, build: Build) -> None:
    """0.1 + 0.2 needs 17 digits."""
    fmu = build(TireModel(law=PowerLaw(718.5, 0.1 + 0.2)), tmp_path)
    assert float(variable(described(fmu), "law.exponent")["start"]) == 0.1 + 0.2


@BOTH_KINDS
def test_units_are_products_of_si_units(tmp_path: Path, build: Build) -> None:
    """Every declared unit says its base units; N/cm^B has none, so it stands in the description only."""
    effects = tuple((effect, effect.nominal) for effect in in_order())
    description = described(build(TireModel(effects=effects), tmp_path))
    units = {unit.get("name"): unit.find("BaseUnit") for unit in description.iterfind("UnitDefinitions/Unit")}
    assert None not in units.values()
    assert units["s/m"].attrib == {"s": "1", "m": "-1"}  # type: ignore[union-attr]
    coefficient = variable(description, "law.flat_coefficient")
    assert "unit" not in coefficient
    assert coefficient["description"].endswith("[N/cm^B]")


@BOTH_KINDS
def test_each_tire_says_who_it_is(tmp_path: Path, article_fmu: Path, build: Build) -> None:
    """Name, description and version are the tire's: those of two tires differ, those of one do not."""
    said = []
    for number, tire in enumerate(
        (
            TireModel(),
            TireModel(law=PowerLaw(), name="Wang & Hull, off road", source="quoted"),
            TireModel(law=PowerLaw(720.0), name="Wang & Hull, off road", source="quoted"),
        )
    ):
        root = described(build(tire, tmp_path / str(number)))
        said.append((root.get("modelName"), root.get("description"), root.get("version")))
        assert said[-1][0] == tire.name
        assert tire.name in str(said[-1][1])
        assert tire.source in str(said[-1][1])
    assert len({version for _, _, version in said}) == 3
    assert described(article_fmu).get("version") == said[0][2]


def test_the_default_step_is_the_one_that_the_text_recommends(either_fmu: Path) -> None:
    experiment = described(either_fmu).find("DefaultExperiment")
    assert experiment is not None
    with zipfile.ZipFile(either_fmu) as archive:
        page = archive.read("documentation/index.html").decode()
    assert "Take h &le; 0.2 ms for a wheel" in page
    assert float(str(experiment.get("stepSize"))) == 0.2e-3


def test_what_makes_fmus_is_not_packed_into_them(article_fmu: Path) -> None:
    with zipfile.ZipFile(article_fmu) as archive:
        packed = {name.rpartition("/")[2] for name in archive.namelist() if "/pythonfmu/" in name}
        face = archive.read("resources/pythonfmu/__init__.py").decode()
    assert packed == {
        "__init__.py",
        "_version.py",
        "default_experiment.py",
        "enums.py",
        "fmi2slave.py",
        "logmsg.py",
        "variables.py",
    }
    assert "builder" not in face
    assert "from .fmi2slave import Fmi2Slave" in face


def test_every_constant_of_the_law_is_a_parameter(description: ElementTree.Element) -> None:
    for parameter in TireModel().law.parameters:
        found = variable(description, f"law.{parameter.name}")
        assert (found["causality"], found["variability"]) == ("parameter", "tunable")
        assert float(found["start"]) == parameter.start
        assert parameter.symbol in found["description"]


def test_outputs_depend_on_both_inputs(description: ElementTree.Element) -> None:
    outputs = list(description.iterfind("ModelStructure/Outputs/Unknown"))
    unknowns = list(description.iterfind("ModelStructure/InitialUnknowns/Unknown"))
    assert [o.get("index") for o in outputs] == [u.get("index") for u in unknowns] == ["3", "4", "5"]
    assert all(o.get("dependencies") == "1 2" for o in outputs)
    assert all((u.get("dependencies") or "").startswith("1 2 6 ") for u in unknowns)


class Opened(HTMLParser):
    """Collects the text and checks that every element is closed in turn."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_documentation_licences_needs_and_icon(article_fmu: Path, repository: Path) -> None:
    with zipfile.ZipFile(article_fmu) as archive:
        page, needs = Opened(), archive.read("documentation/externalDependencies.txt").decode()
        page.feed(archive.read("documentation/index.html").decode())
        license_text = archive.read("documentation/licenses/license.txt").decode()
        wrapper_license = archive.read("documentation/licenses/pythonfmu.txt").decode()
        icon = archive.read("model.png")
    assert page.open == []
    for words in (
        "0.2519",
        "second reading",
        "Cycling Science",
        "1e5 N/m",
        "2240 N",
        "31.75",
        "surface_radius",
    ):
        assert words in page.text
    assert license_text == (repository / "LICENSE").read_text()
    assert "MIT" in wrapper_license
    for words in ("libpython", "python3.dll", "glibc", "TIRELAB_LIBPYTHON"):
        assert words in needs
    assert icon.startswith(b"\x89PNG")


def test_text_of_a_tire_file_is_escaped(tmp_path: Path) -> None:
    tire = TireModel(law=PowerLaw(), name="<script>alert(1)</script>", source='"&<b>')
    with zipfile.ZipFile(build_fmu(tire, tmp_path, with_loader=False).path) as archive:
        page = archive.read("documentation/index.html").decode()
    assert "<script>" not in page
    assert "&lt;script&gt;" in page


def test_the_same_source_gives_the_same_bytes(article_fmu: Path, tmp_path: Path) -> None:
    again = build_fmu(TireModel(), tmp_path).path
    assert again.read_bytes() == article_fmu.read_bytes()


def test_another_tire_has_another_guid_and_differs_by_data_only(article_fmu: Path, tmp_path: Path) -> None:
    damping = CATALOGUE["viscous_damping"]
    values = (300.0, *(p.start for p in damping.parameters[1:]))
    other = build_fmu(TireModel(effects=((damping, values),)), tmp_path).path
    with zipfile.ZipFile(article_fmu) as a, zipfile.ZipFile(other) as b:
        assert a.namelist() == b.namelist()
        changed = {name for name in a.namelist() if a.read(name) != b.read(name)}
    assert changed == {
        "modelDescription.xml",
        "documentation/index.html",
        "resources/guid.txt",
        "resources/tire.json",
    }


def test_the_fmu_holds_the_tire_it_was_built_from(article_fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(article_fmu) as archive:
        archive.extract("resources/tire.json", tmp_path)
    assert read_tire(tmp_path / "resources" / "tire.json") == TireModel()


@pytest.mark.parametrize(
    "build", [partial(build_fmu, with_loader=False), build_native_fmu, partial(build_native_fmu, fmi=3)]
)
def test_a_name_with_letters_that_no_description_can_hold_is_written_without_them(
    build: Callable[..., Any], tmp_path: Path
) -> None:
    tire = replace(TireModel(), name="<b>\x1b[31m\ud800 Größe\n& 'x'", source="a\x00b")
    built = build(tire, tmp_path)
    inside = tire_inside(built.path)
    assert inside is not None
    assert (inside.name, inside.source) == ("<b>?[31m? Größe\n& 'x'", "a?b")
    assert "<b>?[31m? Größe" in fmpy.read_model_description(str(built.path)).description
    with zipfile.ZipFile(built.path) as archive:
        assert "<b>?" not in archive.read("documentation/index.html").decode()


def test_a_folder_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(TirelabError, match=r"cannot be written .* --out"):
        build_fmu(TireModel(), tmp_path / "file", with_loader=False)


def test_build_command(repository: Path, tmp_path: Path) -> None:
    script = repository / "build_fmu.py"
    tire = repository / "examples" / "tires" / "wang_hull_road.json"
    done = subprocess.run(
        [sys.executable, script, "--tire", tire, "--out", tmp_path],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "road tire" in done.stdout
    assert (tmp_path / "BicycleTire.fmu").is_file()

    (tmp_path / "bad.json").write_text('{"schema": 1, "law": {"name": "cubic"}}')
    failed = subprocess.run(
        [sys.executable, script, "--tire", tmp_path / "bad.json"], capture_output=True, text=True, check=False
    )
    assert failed.returncode == 2
    assert "bad.json: unknown law 'cubic'; known are" in failed.stderr
    assert "Traceback" not in failed.stderr


def test_a_machine_without_a_compiler_still_builds(
    tmp_path: Path, repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """ziglang blocked and an empty PATH: the FMU is written, and one sentence says what it lacks."""
    block = "import sys; sys.modules['ziglang'] = None; sys.argv = ['build_fmu.py', '--out', sys.argv[1]]; "
    run = f"import runpy; runpy.run_path({str(repository / 'build_fmu.py')!r}, run_name='__main__')"
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    done = subprocess.run(
        [sys.executable, "-c", block + run, tmp_path], capture_output=True, text=True, check=True
    )
    (sentence,) = [line for line in done.stdout.splitlines() if "compiler" in line]
    assert "only in tools that are Python themselves" in sentence
    with zipfile.ZipFile(tmp_path / "BicycleTire.fmu") as archive:
        assert "binaries/linux64/BicycleTire.so" in archive.namelist()


def test_without_what_it_needs_the_script_says_what_to_install(repository: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-I", "-S", str(repository / "build_fmu.py")], capture_output=True, text=True
    )
    assert done.returncode == 1
    assert re.fullmatch(
        r"Error: the package \w+ is missing; install what tirelab needs: python -m pip install -e \.\n",
        done.stderr,
    )
