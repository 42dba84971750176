"""The residual is located on what it depends on, and noise is not located at all."""

import numpy as np
from drives import flat_force, read, ride
from radialtire import TireModel
from scipy.signal import lfilter
from tirelab.explain.scene import scene_of
from tirelab.locate import locate
from tirelab.noise import noise_of


def scene_and_residual(added, colour=0.0):
    time, deflection, rate = ride(3)
    drive = read("ride", time, deflection, flat_force(deflection), 4, noise=0.0)
    noise = lfilter(
        [np.sqrt(1.0 - colour**2)], [1.0, -colour], np.random.default_rng(5).standard_normal(time.size)
    )
    scene = scene_of([(drive.time, drive.deflection, drive.surface_radius, drive.force)], TireModel())
    own = noise_of(5.0 * noise, np.zeros(time.size), 0.0, np.ones(time.size, dtype=bool))
    return scene, [5.0 * noise + added(deflection, rate)], [own]


def test_a_force_while_unloading_is_found_by_direction_with_its_share():
    spans = locate(*scene_and_residual(lambda x, v: np.where(v < 0.0, 12.0, 0.0)))
    side = {s.label: s for s in spans if s.by == "direction"}
    assert side["unloading"].significant
    # 12 N on all of the unloading; small reversals inside it are not counted as loading.
    assert abs(side["unloading"].mean_residual - 12.0) < 1.0
    assert side["unloading"].share > 0.9
    assert not side["loading"].significant or abs(side["loading"].mean_residual) < 1.0


def test_a_knee_is_found_at_large_deflections():
    spans = locate(*scene_and_residual(lambda x, v: 1e5 * np.maximum(x - 0.016, 0.0)))
    assert spans[0].significant
    deepest = max((s for s in spans if s.by == "deflection"), key=lambda s: s.stop)
    assert deepest.significant
    assert deepest.mean_residual > 0.0


def test_correlated_noise_is_not_located():
    # Counted sample by sample, AR(1) noise of 0.95 would make dozens of spans significant.
    spans = locate(*scene_and_residual(lambda x, v: 0.0 * x, colour=0.95))
    assert sum(s.significant for s in spans) <= 1


def test_the_contract_of_a_place():
    span = locate(*scene_and_residual(lambda x, v: 0.0 * x))[0]
    assert set(span.to_contract()) == {"by", "from", "to", "unit", "share", "mean_residual"}
