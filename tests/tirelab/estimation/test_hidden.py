"""What the refitted law of a part is as well cannot be shown beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, PowerLaw, TireModel
from radialtire.part_curve import PartCurve
from tirelab.diagnosis.diagnose import diagnose
from tirelab.estimation.additions import additions
from tirelab.estimation.fit import fitted
from tirelab.estimation.hidden import (
    LIKE_CURVE,
    LIKE_GAP,
    LIKE_PRELOAD,
    LIKE_READING,
    like_law_of_part,
    read_instead,
)
from tirelab.estimation.ranking import Ranking
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import Dataset, dataset_of
from tirelab.regressors.signature import Signature, signatures_of
from tirelab.selection.search import Discrepancy

SPRING = TireModel(PowerLaw(200.0, 1.0), tested_range=None, two_sided=True, inflated=False)
SNAP = PartCurve((0.0, 0.01, 0.02, 0.03), (0.0, 300.0, 350.0, 900.0))
CURVE = replace(SPRING, law=PowerLaw(1e-12, 1.0), curve=SNAP)
GAP = replace(SPRING, two_sided=False, effects=((CATALOGUE["deflection_offset"], (1e-3,)),))
ACTING = ("series_compliance", "deflection_offset", "force_offset", "viscous_damping")


def pressed(seed: int, force: float = 20.0) -> Recording:
    """Two slow cycles of 30 mm, with a force beside noise."""
    time = np.linspace(0.0, 40.0, 801)
    x = 0.015 * (1.0 - np.cos(2.0 * np.pi * time / 20.0))
    noise = np.random.default_rng(seed).normal(size=(2, time.size))
    forces = np.interp(x, SNAP.at, SNAP.force)
    return Recording("p", time, x + 1e-6 * noise[0], np.full(time.size, np.inf), forces + force + noise[1])


@pytest.mark.parametrize(
    ("tire", "told"),
    [
        (TireModel(), {}),
        # Of a straight spring another zero of the gauge is one force, too.
        (SPRING, {"force_offset": LIKE_PRELOAD, "deflection_offset": LIKE_PRELOAD}),
        (CURVE, {"force_offset": LIKE_PRELOAD, "series_compliance": LIKE_CURVE}),
        (GAP, {"deflection_offset": LIKE_GAP}),
    ],
    ids=["tire", "spring", "curve", "gap"],
)
def test_what_a_refitted_law_is_as_well(tire: TireModel, told: dict[str, str]) -> None:
    dataset = dataset_of([pressed(1)], tire)
    assert like_law_of_part(signatures_of(ACTING, dataset), dataset) == told


@pytest.mark.slow
def test_no_spring_in_series_is_an_alternative_beside_a_curve() -> None:
    """It would not change the force, so that no recording could show it."""
    verdict = diagnose([pressed(2, force=0.0)], CURVE)
    told = {a.names: a for a in verdict.alternatives if "series_compliance" in a.names}
    assert all(np.isnan(a.probability) and LIKE_CURVE in a.reason for a in told.values()), told


def test_an_effect_may_be_in_the_place_of_one_whose_loop_its_responses_follow(
    dataset: Dataset, signatures: tuple[Signature, ...], noise: Discrepancy
) -> None:
    """A ride of 500 N s/m: a damper follows what a damper explains, and a mass does not."""
    nothing = fitted(dataset, [{}], noise, noise.highest, -np.inf)
    known = {s.name: s for s in signatures}
    start = additions(
        known["viscous_damping"], nothing.residual, np.zeros((dataset.misfit.size, 0)), 1.0, dataset
    )
    damped = fitted(dataset, [{"viscous_damping": start[0]}], noise, noise.highest, -np.inf)
    ranking = Ranking((damped, nothing), noise)
    unread = [known["viscous_damping"], known["inertia"]]
    assert read_instead(ranking, damped, unread) == (("viscous_damping", "viscous_damping"),)
    assert read_instead(ranking, damped, []) == ()
    assert read_instead(Ranking((damped,), noise), damped, unread) == ()  # what it explains is not known


@pytest.mark.slow
def test_what_the_reading_hides_may_be_in_the_place_of_what_is_named() -> None:
    """A spring and a dashpot, read in seven steps: friction explains the loop, and no rate can be read."""
    time = np.arange(8000) / 1000.0
    angle, step = 0.5 * np.pi * time, 6.28e-7
    x, rate = 2e-6 * np.sin(angle), np.pi * 1e-6 * np.cos(angle)
    force = 4850.0 * x + 2460.0 * rate + 1e-5 * np.random.default_rng(3).normal(size=time.size)
    read = Recording("s", time, step * np.round(x / step), np.full(time.size, np.inf), force)
    verdict = diagnose([read], replace(SPRING, law=PowerLaw(1e-12, 1.0)))
    named = {effect.name: effect.probability for effect in verdict.effects}
    assert named["rate_independent_hysteresis"] <= 0.5
    assert verdict.confidence <= 0.5
    told = [a for a in verdict.alternatives if "viscous_damping" in a.names]
    assert told[0].reason == LIKE_READING
    assert told[0].probability == pytest.approx(verdict.confidence)
