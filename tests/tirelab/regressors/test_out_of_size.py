"""Effects whose bounds are a tire's: left out, with the reason, of recordings of another size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, CHANNELS, PowerLaw, TireModel
from tirelab.diagnosis.diagnose import diagnose
from tirelab.recordings.recording import Recording
from tirelab.regressors.out_of_size import out_of_size
from tirelab.regressors.scales import Scales
from tirelab.simulation.simulate import simulate

TIRE = Scales(900.0, 0.02, 60.0, 0.01, 0.05, 1.5, 1e-6, {c.name: c.usual for c in CHANNELS})


def of_size(force: float, travel: float) -> list[str]:
    return list(out_of_size(list(CATALOGUE), replace(TIRE, force=force, travel=travel)))


@pytest.mark.parametrize("force", [50.0, 300.0, 3000.0, 30e3])
@pytest.mark.parametrize("travel", [2e-3, 0.02, 0.1, 1.0])
def test_no_effect_is_out_of_size_for_a_tire_or_a_damper(force: float, travel: float) -> None:
    """A tire, one that is lifted by a metre on a ride, and what a large press drives."""
    if force / travel > 30.0:  # nothing softer than a twentieth of the softest tire
        assert of_size(force, travel) == []


def test_those_with_a_bound_in_si_are_out_of_size_for_a_cell_under_a_microscope() -> None:
    assert of_size(1e-8, 14e-6) == [
        "series_compliance",
        "elastic_shape",
        "rate_independent_hysteresis",
        "saturation",
    ]


def test_the_reason_names_parameter_bound_and_size() -> None:
    why = out_of_size(["saturation"], replace(TIRE, force=1e-8))["saturation"]
    # its prior is at 0.85 of the largest force, 8.5e-9 N
    assert "limit is at least 1 N" in why
    assert "about 9e-09 N" in why


def test_a_recording_in_nanonewtons_is_diagnosed_as_it_is() -> None:
    """A sphere on a gel, approached at two speeds and held: relaxation of a quarter in half a second, 10 nN, 14 um."""
    time = np.arange(0.0, 24.0, 5e-3)
    x = 14e-6 * np.interp(
        time, [0.0, 0.2, 6.0, 8.0, 9.0, 13.0, 17.0, 18.0, 20.0], [0, 1, 1, 0, 0, 1, 0, 0, 1]
    )
    numbers = np.random.default_rng(4)
    gel = TireModel(PowerLaw(1e-8 / 1.4e-3**1.5, 1.5), tested_range=None)
    effect = CATALOGUE["viscoelastic_relaxation"]
    values = {p.name: p.start for p in effect.parameters} | {"share_1": 0.25, "relaxation_time_1": 0.5}
    true = replace(gel, effects=((effect, tuple(values[p.name] for p in effect.parameters)),))
    silent = Recording("gel", time, x, np.full(time.size, np.inf), np.zeros(time.size))
    noise = 5e-12 * numbers.normal(size=time.size)
    read = x + 1e-9 * numbers.normal(size=time.size)
    found = diagnose([replace(silent, deflection=read, force=simulate(true, silent) + noise)], gel)
    assert found.names == ("viscoelastic_relaxation",)
    assert found.fit.noise == pytest.approx(5e-12, rel=0.3)
    assert found.fit.after < 1.2 * found.fit.noise
    reasons = {frozenset(a.names) - set(found.names): a.reason for a in found.alternatives}
    assert "its reach is at least 1e-05 m" in reasons[frozenset({"rate_independent_hysteresis"})]
    assert "its limit is at least 1 N" in reasons[frozenset({"saturation"})]
