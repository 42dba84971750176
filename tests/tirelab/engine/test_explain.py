"""The columns and the evidence that the search rests on."""

import numpy as np
import pytest
from drives import flat_force, read, ride
from radialtire import TireModel
from scipy.stats import multivariate_normal
from tirelab.engine.evidence import Products, explain, products_of
from tirelab.engine.families import CATALOGUE_FAMILIES, high_pass, jenkins
from tirelab.engine.lag import lagged
from tirelab.engine.place import Point, place_at
from tirelab.engine.scene import scene_of
from tirelab.preprocessing.dataset import dataset_of
from tirelab.preprocessing.kinematics import motion_of


def test_the_evidence_is_that_of_a_gaussian():
    rng = np.random.default_rng(1)
    columns, data = rng.standard_normal((40, 3)), 2.0 * rng.standard_normal(40)
    columns /= np.sqrt(np.mean(columns**2, axis=0))
    p = products_of(columns, data)
    found = explain(p, [np.array([0, 1]), np.array([2])], 1.0)
    empty = explain(p, [], 1.0)
    # For any scales s the evidence is the density of N(0, I + sum s^2 x x'); ours is at its largest over them.
    grid = np.geomspace(1e-3, 10.0, 60)

    def log_density(a, b):
        cov = (
            np.eye(40)
            + a**2 * columns[:, :2] @ columns[:, :2].T
            + b**2 * np.outer(columns[:, 2], columns[:, 2])
        )
        return multivariate_normal(np.zeros(40), cov).logpdf(data)

    best = max(log_density(a, b) for a in grid for b in grid)
    bare = multivariate_normal(np.zeros(40), np.eye(40)).logpdf(data)
    cost = 2.0 * np.log(8.0)
    # A grid 17 % apart and a bounded number of rounds: a tenth.
    assert found.log_evidence + cost - empty.log_evidence == pytest.approx(best - bare, abs=0.1)


def test_a_coarsened_evidence_counts_fewer_samples():
    rng = np.random.default_rng(2)
    column = rng.standard_normal((4000, 1))
    data = 0.2 * column[:, 0] + rng.standard_normal(4000)
    p = products_of(column, data)
    full = explain(p, [np.array([0])], 1.0).log_evidence - explain(p, [], 1.0).log_evidence
    tenth = explain(p, [np.array([0])], 0.1).log_evidence - explain(p, [], 0.1).log_evidence
    # Gain n b^2 / 2 of about 80 against 8, less the same price and the logarithm of fewer samples.
    assert 60.0 < full < 100.0
    assert 1.0 < tenth < 10.0


def test_a_slider_follows_its_loop():
    deflection = np.concatenate([np.linspace(0.0, 5e-3, 501), np.linspace(5e-3, 0.0, 501)])
    z = jenkins(deflection, 1e-3, False)
    assert z[500] == 1.0
    # After a reversal it turns round over twice its reach.
    assert z[501 + 200] == pytest.approx(-1.0, abs=0.02)
    assert z[501 + 100] == pytest.approx(0.0, abs=0.02)


def test_the_maxwell_force_of_a_ramp():
    time = np.linspace(0.0, 3.0, 301)
    force = high_pass(time, 50.0 * time, 0.4)
    assert force == pytest.approx(50.0 * 0.4 * (1.0 - np.exp(-time / 0.4)), abs=1e-9)


@pytest.mark.parametrize("stages", [0, 1, 2])
def test_a_ramp_is_read_late_by_the_lag(stages):
    time = np.linspace(0.0, 4.0, 801)
    late = lagged(time, (30.0 * time)[:, None], 0.05, stages)[:, 0]
    assert late[-1] == pytest.approx(30.0 * (4.0 - 0.05), abs=1e-6)


def test_the_motion_of_a_noisy_sine():
    time, deflection, rate = ride(7)
    noisy = deflection + 1e-5 * np.random.default_rng(8).standard_normal(time.size)
    motion = motion_of(time, noisy)
    assert motion.noise == pytest.approx(1e-5, rel=0.1)
    # The difference of neighbours is wrong by 1.4e-5 / 0.005 = 2.8 mm/s; cubics over 7 to 13 samples by 1 to 2.
    assert np.sqrt(np.mean((motion.rate - rate)[50:-50] ** 2)) < 2.0e-3
    assert np.sqrt(np.mean((motion.deflection - deflection) ** 2)) < 0.95e-5


def test_every_family_of_the_catalogue_has_finite_columns_and_variants_within_them():
    time, deflection, _ = ride(9, samples=800)
    drive = read("ride", time, deflection, flat_force(deflection), 1)
    scene = scene_of(dataset_of([drive], TireModel()))
    place = place_at(scene.records[0], scene, Point(np.zeros((1, 4)), offset=1e-4, compliance=5e-7))
    for family in CATALOGUE_FAMILIES:
        columns = family.build(place)
        assert np.all(np.isfinite(columns)), family.name
        assert max(i for v in family.variants(columns.shape[1]) for i in v) < columns.shape[1]


def test_a_spring_in_series_is_solved():
    time, deflection, _ = ride(9, samples=400)
    drive = read("ride", time, deflection, flat_force(deflection), 1)
    scene = scene_of(dataset_of([drive], TireModel()))
    place = place_at(scene.records[0], scene, Point(np.zeros((1, 4)), compliance=1e-6))
    assert place.deflection + 1e-6 * place.elastic == pytest.approx(
        scene.records[0].motion.deflection, abs=1e-9
    )
    assert place.elastic == pytest.approx(flat_force(place.deflection), rel=1e-9)


def test_columns_so_alike_that_only_rounding_is_left_are_no_evidence():
    # No columns have such products: of two of length 1 the product is at most 1.
    p = Products(
        100.0 * np.array([[1.0, 1.01], [1.01, 1.0]]), np.array([50.0, -50.0]), 100.0, 100, np.ones(2)
    )
    assert explain(p, [np.array([0]), np.array([1])], 1.0).log_evidence == -np.inf
