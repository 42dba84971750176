"""The quarter bicycle as an FMU and as a system with the tire's: what is in the archives, and what is refused."""

from __future__ import annotations

import importlib
import json
import math
import zipfile
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import fmpy
import pytest
from fmpy.ssp.ssd import read_ssd
from radialtire import TireModel

SSD = "{http://ssp-standard.org/SSP1/SystemStructureDescription}"
SSC = "{http://ssp-standard.org/SSP1/SystemStructureCommon}"


def _system(example: dict[str, ModuleType], ride: Any, folder: Path) -> Path:
    path = example["pack"].pack_system(ride, TireModel(), folder, step=1e-3, look_ahead=None)
    assert isinstance(path, Path)
    return path


def test_archive_is_the_same_for_the_same_ride(
    example: dict[str, ModuleType], wavy: Any, tmp_path: Path
) -> None:
    first, second = (_system(example, wavy, tmp_path / name).read_bytes() for name in "ab")
    assert first == second


def test_structure_is_ssp_with_units(example: dict[str, ModuleType], wavy: Any, tmp_path: Path) -> None:
    """fmpy reads it against the standard's schema; every connector's unit is its FMU's and its partner's."""
    path = _system(example, wavy, tmp_path)
    assert read_ssd(str(path)).name == "QuarterBicycle"
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    root = ElementTree.parse(tmp_path / "SystemStructure.ssd").getroot()
    assert root.get("version") == "1.0"
    units = {}
    for component in root.iter(f"{SSD}Component"):
        description = fmpy.read_model_description(str(tmp_path / component.get("source", "")))
        variables = {v.name: v for v in description.modelVariables}
        for connector in component.iter(f"{SSD}Connector"):
            variable, real = variables[connector.get("name", "")], connector.find(f"{SSC}Real")
            assert real is not None
            assert (variable.causality, variable.unit) == (connector.get("kind"), real.get("unit"))
            units[component.get("name"), connector.get("name")] = real.get("unit")
    connections = list(root.iter(f"{SSD}Connection"))
    assert len(connections) == 3
    for c in connections:
        start, end = (
            (c.get("startElement"), c.get("startConnector")),
            (c.get("endElement"), c.get("endConnector")),
        )
        assert units[start] == units[end]
    assert {u.get("name") for u in root.iter(f"{SSC}Unit")} >= set(units.values())
    (step,) = root.iter("{http://opensimulationplatform.com/SSP/OSPAnnotations}FixedStepAlgorithm")
    assert step.get("baseStepSize") == "0.001"


def test_refusals_of_the_bicycle_fmu(example: dict[str, ModuleType], wavy: Any, tmp_path: Path) -> None:
    """One message that says why, the state as before, and on with the next good value."""
    path = example["pack"].pack_bicycle(wavy, tmp_path, step=1e-3)
    replay = importlib.import_module("tirelab.fmu.replay")
    with replay.opened(path) as unit:
        instance, force, hub = (
            unit.instance,
            [unit.references["radial_force"]],
            [unit.references["hub_height"]],
        )
        instance.setupExperiment(startTime=5.0)
        instance.enterInitializationMode()
        instance.exitInitializationMode()
        before = instance.getReal(hub)
        instance.setReal(force, [math.nan])
        with pytest.raises(fmpy.fmi1.FMICallException):
            instance.doStep(5.0, 1e-3)
        assert unit.messages() == ("radial_force = nan is not allowed; it must be a finite number",)
        assert instance.getReal(hub) == before
        instance.setReal(force, [0.0])
        instance.doStep(5.0, 1e-3)
        with pytest.raises(fmpy.fmi1.FMICallException):
            instance.doStep(8.0, 1e-3)
        assert "has not the whole wheel over the ground" in unit.messages()[-1]
        # Let go of the wheel: in 1 ms the fork and gravity move it by (S / m_u + g) t^2 / 2, S carrying 32 kg.
        fallen = before[0] - instance.getReal(hub)[0]
        assert fallen == pytest.approx(0.5 * 9.80665 * (1.0 + 32.0 / 3.5) * 1e-6, rel=0.05)


def test_parameters_of_the_ride_are_in_the_fmu(
    example: dict[str, ModuleType], wavy: Any, tmp_path: Path
) -> None:
    path = example["pack"].pack_bicycle(wavy, tmp_path, step=1e-3)
    variables = {v.name: v for v in fmpy.read_model_description(str(path)).modelVariables}
    assert float(variables["sprung_mass"].start) == 32.0
    assert variables["fork_stiffness"].unit == "N/m"
    with zipfile.ZipFile(path) as archive:
        assert json.loads(archive.read("resources/ride.json"))["state"] == wavy.state.tolist()
