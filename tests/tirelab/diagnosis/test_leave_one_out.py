"""An effect is named while the catalogue has it; without it no tire is said to be ready that does not fit.

One that leaves up to half as much again as the noise may be used, but then it is said how much is left and on what that
depends.
"""

from functools import cache

import pytest
from left_out import PARAMETERS, Outcome, outcome, size
from radialtire import CATALOGUE
from tirelab.diagnosis.diagnose import catalogue_names
from tirelab.report import first_screen
from tirelab.report.titles import AT_THE_FLOOR

pytestmark = pytest.mark.slow

REACHED = 1.05
"""An alternative fits where its tire leaves at most this many noises: 20 000 samples show 1.5 %, the noise of the
deflection adds 1 %."""

NAMES = (*PARAMETERS, "recalibration")

said = cache(outcome)


def test_all_effects_are_tried_that_act_without_a_channel() -> None:
    others = set(catalogue_names()) - set(NAMES)
    assert others == {n for n in others if CATALOGUE[n].reads is not None}


@pytest.mark.parametrize("name", NAMES)
def test_what_the_catalogue_has_is_named(name: str) -> None:
    assert said(name).whole.names == (name,), said(name).row


@pytest.mark.parametrize("name", NAMES)
def test_what_the_catalogue_lacks_is_unknown_or_what_stands_for_it_is_not_said_to_be_ready(name: str) -> None:
    found: Outcome = said(name)
    assert name not in found.without.names
    told = found.without.to_dict()
    if told["verdict"]["separating_test"] is not None:
        told["verdict"]["separating_test"]["file"] = "as_the_command_writes_it.csv"
    step = first_screen.next_step(told)
    ready = step.action.startswith("Nothing")
    assert found.misfit < AT_THE_FLOOR or not ready, found.row
    assert found.misfit < REACHED or not ready or "The remainder, " in step.why, found.row
    assert found.misfit < REACHED or "o physics is missing" not in first_screen.lead(told), found.row


@pytest.mark.parametrize("name", NAMES)
def test_every_effect_is_clear_in_its_recordings(name: str) -> None:
    assert 4.0 < size(name, seed=1) < 45.0
