"""The quarter bicycle's modules, and two of its rides."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from radialtire import TireModel
from tirelab.terrain import Ground, flat, ground_from, log, place, sine

MODULES = (
    "bicycle",
    "wheel",
    "model",
    "coupled",
    "account",
    "rides",
    "fmu_tire",
    "quarter_bicycle_fmu",
    "pack",
    "cosimulate",
    "ride_with_fmu",
)


@pytest.fixture(scope="module")
def example(repository: Path) -> Iterator[dict[str, ModuleType]]:
    """The example's modules, which import each other by their plain names."""
    folder = str(repository / "examples" / "quarter_bicycle")
    sys.path.insert(0, folder)
    yield {name: importlib.import_module(name) for name in MODULES}
    sys.path.remove(folder)
    for name in MODULES:
        del sys.modules[name]


@pytest.fixture(scope="module")
def wavy(example: dict[str, ModuleType]) -> Any:
    """A ride over waves of 2 cm and 1.5 m, where the wheel keeps one contact and everything is smooth."""
    return _ride(example, ground_from(sine(8.0, (0.01, 1.5), spacing=0.002), 0.002))


@pytest.fixture(scope="module")
def bumpy(example: dict[str, ModuleType]) -> Any:
    """A ride over a log 4 cm tall, on which the contact leaps and the wheel leaves the ground."""
    return _ride(example, ground_from(place(flat(5.0, 0.005), log(0.02), 1.5), 0.002))


def _ride(example: dict[str, ModuleType], ground: Ground) -> Any:
    bicycle, tire = example["bicycle"].QuarterBicycle(), example["rides"].elastic(TireModel())
    state = example["model"].at_rest(bicycle, ground, tire, 1.0)
    return example["rides"].RideOnGround(ground.name, bicycle, ground, 4.0, 1.0, 0.3, state)
