"""What is material: named effects have to be seen, what is beyond the catalogue more so."""

from dataclasses import replace

import pytest
from settled_sets import settled
from tirelab.engine.beyond import AGNOSTIC_FAMILIES
from tirelab.engine.families import CATALOGUE_FAMILIES
from tirelab.engine.judge import material

FAMILIES = {f.name: f for f in (*CATALOGUE_FAMILIES, *AGNOSTIC_FAMILIES)}


@pytest.mark.parametrize(
    ("name", "own", "kept"),
    [("inertia", 0.08, False), ("inertia", 0.15, True), ("rate", 0.15, False), ("rate", 0.3, True)],
)
def test_what_has_no_form_of_its_own_has_to_be_twice_as_large(name: str, own: float, kept: bool) -> None:
    # Over white noise a part of 0.1 raises the RMSE by half a percent, one of 0.2 by two.
    one = settled(0.0, {name: own})
    layout = replace(one.layout, families=FAMILIES)
    assert material(one.products, one.candidate, layout) == ((name,) if kept else ())
