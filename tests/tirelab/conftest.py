"""Lets the tests of this folder import its helpers, and writes the file that several of them read."""

import math
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from house_form import HOUSE_FORM, loading, write_rows


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    """A clean recording in the house form."""
    time, deflection, force = loading()
    return write_rows(tmp_path / "flat.csv", HOUSE_FORM, time, deflection, [math.inf] * len(time), force)
