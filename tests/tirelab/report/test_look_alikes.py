"""Tests of what looks like a named effect and is in no catalogue."""

from typing import Any

import pytest
from radialtire import CATALOGUE
from tirelab.diagnosis.diagnose import catalogue_names
from tirelab.report.left_out import effect_shown
from tirelab.report.look_alikes import look_alike_of, look_alikes
from tirelab.report.titles import short_title


def effect(name: str) -> dict[str, Any]:
    return {"name": name, "share": 0.5, "parameters": {}}


@pytest.mark.parametrize("name", catalogue_names())
def test_whatever_a_verdict_may_name_has_something_that_looks_like_it(name: str) -> None:
    ((title, what, check),) = look_alikes({"effects": [effect(name)]})
    found = look_alike_of(name)
    assert found is not None
    assert (title, what, check) == (short_title(name), found.what, found.check)


def test_each_effect_is_told_in_its_order() -> None:
    named = ["gas_compression", "recalibration", "force_drift"]
    titles = [title for title, _, _ in look_alikes({"effects": [effect(name) for name in named]})]
    assert titles == ["gas compression", "refitted law", "force drift"]
    assert look_alikes({"effects": []}) == []


def test_a_name_that_the_catalogue_lacks_has_none() -> None:
    assert look_alike_of("something else") is None


def test_an_effects_card_has_it() -> None:
    shown = effect_shown(effect("inertia"), {})
    assert shown["look_alike"] == CATALOGUE["inertia"].look_alike
