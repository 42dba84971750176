"""An effect is named while the catalogue has it; without it the verdict is something unknown, or as good a rival."""

from functools import cache

import pytest
from left_out import Outcome, outcome
from tirelab.diagnosis.diagnose import CATALOGUE_NAMES

pytestmark = pytest.mark.slow

REACHED = 1.05
"""A rival is honest where its tire leaves no more than this many noises: 20 000 samples show 1.5 %, the reading of the
deflection adds 1 %."""

said = cache(outcome)


@pytest.mark.parametrize("name", CATALOGUE_NAMES)
def test_what_the_catalogue_has_is_named(name: str) -> None:
    assert said(name).whole.names == (name,), said(name).row


@pytest.mark.parametrize("name", CATALOGUE_NAMES)
def test_what_the_catalogue_lacks_is_unknown_or_has_an_honest_rival(name: str) -> None:
    found: Outcome = said(name)
    assert name not in found.without.names
    assert found.without.unexplained or found.misfit < REACHED, found.row


def test_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    with capsys.disabled():
        print("\n" + "\n".join(said(name).row for name in CATALOGUE_NAMES))
