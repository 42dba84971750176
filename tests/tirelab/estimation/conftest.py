"""A ride of 500 N s/m of damping under 5 N of noise, with the signatures of what makes a loop."""

from __future__ import annotations

import pytest
from drives import damped
from radialtire import TireModel
from tirelab.regressors.dataset import Dataset, dataset_of
from tirelab.regressors.signature import Signature, law_signature, signatures_of
from tirelab.selection.search import Discrepancy, discrepancy_of

NAMES = ("viscous_damping", "rate_independent_hysteresis", "inertia")


@pytest.fixture(scope="package")
def dataset() -> Dataset:
    return dataset_of([damped(1, samples=2000)], TireModel())


@pytest.fixture(scope="package")
def signatures(dataset: Dataset) -> tuple[Signature, ...]:
    return (law_signature(dataset), *signatures_of(NAMES, dataset))


@pytest.fixture(scope="package")
def noise(dataset: Dataset) -> Discrepancy:
    return discrepancy_of(dataset.misfit, 0.0)
