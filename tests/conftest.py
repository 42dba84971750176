"""Fixtures that every test may use."""

import gc
import os
import sys
from pathlib import Path

import pytest
from hypothesis import Phase, settings

if sys.prefix != sys.base_prefix:  # as the program does: nothing outside the checkout is touched
    os.environ.setdefault("MPLCONFIGDIR", str(Path(sys.prefix) / "var" / "matplotlib"))

# Every core has a worker of its own: second threads of the linear algebra would spin there while they wait.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A program that a test starts would else compile all of the package anew; what it keeps is within the checkout.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# The ordinary run draws the same examples each time and shows the first that fails as it was drawn.
settings.register_profile(
    "steady", derandomize=True, deadline=None, print_blob=True, phases=(Phase.explicit, Phase.generate)
)
settings.register_profile(
    "random", deadline=None, print_blob=True, phases=[phase for phase in Phase if phase is not Phase.explain]
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))

LONGEST = (
    "test_readme.py",
    "test_style.py",
    "test_pages.py",
    "test_diagnose.py",
    "test_diagnose_command.py",
    "test_interface.py",
    "test_explanation.py",
    "test_open.py",
    "test_fuzz.py",
    "test_first_diagnosis.py",
    "test_output.py",
    "test_interactive.py",
    "test_page.py",
    "test_correction.py",
    "test_channels.py",
    "test_make.py",
    "test_build_command.py",
)
"""Files that take longest, begun first: with a file to each worker, one of them must not run alone at the end.

In a new environment the first compiles the physics, which the others find compiled; the one begun beside it needs none.
"""

REPOSITORY = Path(__file__).resolve().parents[1]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Order the files by LONGEST; the tests of a file keep their order."""
    rank = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: rank.get(item.path.name, len(rank)))


@pytest.fixture(scope="module", autouse=True)
def little_to_collect() -> None:
    """Leave all that is there before a file out of garbage collections: each damaged recording asks for a whole one."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session")
def repository() -> Path:
    """The checkout under test."""
    return REPOSITORY


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of recordings kept beside the repository; the test is skipped where it is absent."""
    folder = Path(os.environ.get("TIRELAB_SHARED", REPOSITORY.parent / "shared"))
    if not folder.is_dir():
        pytest.skip(f"no folder of shared recordings at {folder}")
    return folder
