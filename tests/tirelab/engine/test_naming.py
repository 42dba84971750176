"""What a set is called: beside something unknown nothing is named that may be its shadow."""

import pytest
from settled_sets import settled
from tirelab.engine.naming import named


def test_the_shape_belongs_to_the_law():
    assert named(settled(0.0, {"inertia": 3.0, "recalibration": 2.0, "shape": 0.1})) == (
        "inertia",
        "recalibration",
    )


@pytest.mark.parametrize("name", ["bottoming", "saturation"])
def test_what_acts_on_one_way_only_casts_a_shadow_on_both(name):
    found = named(settled(0.0, {name: 2.0, "rate and deflection": 0.3, "recalibration": 3.8}))
    assert found == ("recalibration", "unknown")


@pytest.mark.parametrize(("own", "names"), [(2.0, ("inertia", "unknown")), (0.3, ("unknown",))])
def test_beside_something_unknown_what_is_much_smaller_is_not_named(own, names):
    assert named(settled(0.0, {"inertia": own, "time": 1.0})) == names
