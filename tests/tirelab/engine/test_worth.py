"""What one effect of a fit is worth, and that it is not judged by a fit that went astray."""

import numpy as np
import pytest
from fits import BARE, NOISE, fitted, ridden, with_effect
from radialtire import CATALOGUE, TireModel
from tirelab.engine.refit import fit_knobs, knobs_of
from tirelab.engine.worth import begun_anew, gain, without
from tirelab.simulation.simulate import simulate


def worth(name, found, cases, scene):
    return gain(found, without(name, found, BARE, cases, scene.radii), 1.0)


@pytest.mark.parametrize("seed", range(3))
def test_what_is_there_gains_and_what_is_not_costs(seed):
    tire = with_effect("viscous_damping", damping=100.0)
    found, cases, scene = fitted(ridden(seed, tire), tire, ["mullins_softening", "viscous_damping"])
    assert worth("viscous_damping", found, cases, scene) > 0.0
    # Two parameters at half the logarithm of 6000 each; what noise gives back is chi square of two: 7 once in 1000.
    assert worth("mullins_softening", found, cases, scene) < 7.0 - 2.0 * 0.5 * np.log(6000.0)


def test_the_gain_of_the_only_effect_is_half_of_what_it_takes_off_the_sum_of_squares():
    tire = with_effect("viscous_damping", damping=60.0)
    recording = ridden(5, tire)
    found, cases, scene = fitted(recording, tire, ["viscous_damping"])
    rows = scene.records[0].rows
    before, after = ((recording.force - simulate(t, recording))[rows] / NOISE for t in (BARE, found.tire))
    price = len(found.knobs) * 0.5 * np.log(rows.size)
    taken = 0.5 * float(before @ before - after @ after)
    # The loss counts what lies beyond three noises less, and so a normal residual by a tenth.
    assert worth("viscous_damping", found, cases, scene) + price == pytest.approx(taken, rel=0.2)


def test_a_rim_that_the_fit_has_lost_is_found_again():
    """A rim beyond the largest deflection has no slope there: the fit stays, and seems to gain nothing."""
    names = ("viscous_damping", "bottoming")
    true = {"viscous_damping": {"damping": 200.0}, "bottoming": {"stiffness": 6e4, "onset": 0.0195}}
    effects = tuple(
        (CATALOGUE[n], tuple(true[n].get(p.name, p.start) for p in CATALOGUE[n].parameters)) for n in names
    )
    tire = TireModel(effects=effects)
    _, cases, scene = fitted(ridden(7, tire), tire, ["viscous_damping"])
    knobs = knobs_of(names, scene.radii, False, scene.deepest)
    lost = {"damping": 200.0, "stiffness": 6e4, "onset": 2.0 * scene.deepest, "softness": 2e-4}
    astray = fit_knobs(BARE, knobs, np.array([lost[k.label] for k in knobs]), cases, scene.radii)
    less = without("bottoming", astray, BARE, cases, scene.radii)
    assert gain(astray, less, 1.0) < 0.0
    anew = begun_anew("bottoming", astray, less, BARE, cases, scene.radii, scene.deepest, scene.highest)
    found = {k.label: v for k, v in zip(anew.knobs, anew.values, strict=True)}
    assert gain(anew, less, 1.0) > 0.0
    # Half a millimetre: the knee is rounded over 0.2 mm, and a softer spring that begins earlier is nearly the same.
    assert found["onset"] == pytest.approx(0.0195, abs=5e-4)
