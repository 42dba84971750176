"""An effect is named while the catalogue has it; without it the verdict is unknown or an alternative that fits."""

from functools import cache

import pytest
from left_out import Outcome, outcome, size
from tirelab.diagnosis.diagnose import catalogue_names

pytestmark = pytest.mark.slow

REACHED = 1.05
"""An alternative fits where its tire leaves at most this many noises: 20 000 samples show 1.5 %, the noise of the
deflection adds 1 %."""

said = cache(outcome)


@pytest.mark.parametrize("name", catalogue_names())
def test_what_the_catalogue_has_is_named(name: str) -> None:
    assert said(name).whole.names == (name,), said(name).row


@pytest.mark.parametrize("name", catalogue_names())
def test_what_the_catalogue_lacks_is_unknown_or_has_an_alternative_that_fits(name: str) -> None:
    found: Outcome = said(name)
    assert name not in found.without.names
    assert found.without.unexplained or found.misfit < REACHED, found.row


@pytest.mark.parametrize("name", catalogue_names())
def test_every_effect_is_clear_in_its_recordings(name: str) -> None:
    assert 4.0 < size(name, seed=1) < 45.0
