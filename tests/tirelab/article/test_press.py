"""The rig records as the article's section Methods says."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from radialtire import CATALOGUE, Hull1996, PowerLaw, TireModel, write_tire
from tirelab.article import press as rig
from tirelab.cli.rig import command
from tirelab.errors import TirelabError
from tirelab.recordings.recording import read_recording


def with_effect(name: str, **values: float) -> TireModel:
    effect = CATALOGUE[name]
    return TireModel(effects=((effect, tuple(values.get(p.name, p.start) for p in effect.parameters)),))


def test_it_has_the_articles_surfaces() -> None:
    # Methods: "Fourteen different surfaces ... 10 convex cylinders, a flat surface and three concave cylinders", from
    # "58.4 cm (23 in.) concave to flat to 58.4 cm (23 in.) convex"; the text names 1.27, 25.4, -38.1 and -50.8 cm
    convex = [r for r in rig.SURFACES if 0.0 < r < math.inf]
    concave = [r for r in rig.SURFACES if r < 0.0]
    assert (len(convex), rig.SURFACES.count(math.inf), len(concave)) == (10, 1, 3)
    assert convex == sorted(convex)
    assert convex[0] == 0.0127
    assert convex[-1] == 0.584
    assert 0.254 in convex
    assert concave == [-0.381, -0.508, -0.584]


@pytest.mark.parametrize("decay", [0.2519, 0.02519])
def test_it_presses_as_deep_as_the_force_allows(decay: float) -> None:
    # "The maximum deflection was varied from 1.27 cm to 3.175 cm in order to keep the maximum force below 2240 N"
    tire = TireModel(law=Hull1996(convex_coefficient_decay=decay))
    for radius in rig.SURFACES:
        deepest = rig.largest_deflection(tire, radius)
        A, B = tire.law.coefficients(radius)
        assert 0.0127 <= deepest <= 0.03175
        assert A * (100.0 * deepest) ** B < 2240.0
        deeper = deepest + 0.003175
        assert deeper > 0.03175 + 1e-9 or A * (100.0 * deeper) ** B >= 2240.0


def test_it_drives_a_triangle_of_30_s_at_5_hz() -> None:
    recording = rig.record(TireModel(), math.inf, cycles=2)
    assert recording.time.size == 2 * 150 + 1
    np.testing.assert_allclose(np.diff(recording.time), 0.2, rtol=1e-12)
    top = recording.deflection.max()
    corners = np.interp(recording.time, [0, 15, 30, 45, 60], [0.0, top, 0.0, top, 0.0])
    np.testing.assert_allclose(recording.deflection, corners, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("radius", rig.SURFACES)
def test_its_force_is_the_law(radius: float) -> None:
    # the tire's scalar step against numpy on equation 2; both round a power and a product
    recording = rig.record(TireModel(), radius)
    A, B = TireModel().law.coefficients(radius)
    np.testing.assert_allclose(recording.force, A * (100.0 * recording.deflection) ** B, rtol=1e-13)
    assert (recording.surface_radius == radius).all()


def test_it_records_the_effects_of_a_tire() -> None:
    # friction of 50 N with a reach far below the travel: loading lies 100 N above unloading
    recording = rig.record(with_effect("rate_independent_hysteresis", slip_force=50.0, reach=1e-4), math.inf)
    up, down = recording.force[40:60], recording.force[150 - 40 : 150 - 60 : -1]
    np.testing.assert_allclose(up - down, 100.0, atol=1e-6)
    assert recording.force.max() < 2240.0


def test_noise_has_the_strength_and_the_correlation_asked_for() -> None:
    clean = rig.record(TireModel(), math.inf, cycles=100).force
    for correlation_time in (0.0, 0.6):
        noisy = rig.record(
            TireModel(), math.inf, cycles=100, noise=rig.ForceNoise(10.0, correlation_time, (4,))
        )
        noise = noisy.force - clean
        memory = math.exp(-0.2 / correlation_time) if correlation_time else 0.0
        # n = 15001: five standard errors of a variance and of a correlation, widened by the correlated samples
        slack = 5.0 * math.sqrt((1.0 + memory) / (1.0 - memory) / noise.size)
        assert noise.std() == pytest.approx(10.0, rel=slack)
        assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(memory, abs=slack)


def test_a_seed_repeats_its_noise_and_no_two_surfaces_share_it() -> None:
    one, same, other = (rig.record_all(noise=rig.ForceNoise(10.0, seed=(seed,))) for seed in (1, 1, 2))
    clean = rig.record_all()
    for a, b in zip(one, same, strict=True):
        np.testing.assert_array_equal(a.force, b.force)
    noises = [
        r.force - c.force for recordings in (one, other) for r, c in zip(recordings, clean, strict=True)
    ]
    correlation = np.corrcoef([noise[:151] for noise in noises]) - np.eye(28)
    # 378 pairs of 151 white samples: none reaches five standard errors
    assert np.abs(correlation).max() < 5.0 / math.sqrt(151)


def test_a_tire_too_stiff_for_the_rig_is_refused() -> None:
    with pytest.raises(TirelabError, match=r"pushes back with 12700 N at 1.27 cm on flat ground"):
        rig.record(TireModel(law=PowerLaw(1e4, 1.0), name="a plank"), math.inf)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"cycles": 0}, "0 cycles"),
        ({"noise": rig.ForceNoise(-1.0)}, "noise of -1 N"),
        ({"noise": rig.ForceNoise(math.nan)}, "noise of nan N"),
        ({"noise": rig.ForceNoise(1.0, -1.0)}, "correlated over -1 s"),
        ({"sampling_rate": 0.01}, "does not see a cycle"),
    ],
)
def test_senseless_arguments_are_refused(arguments: dict[str, Any], sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence):
        rig.record(TireModel(), math.inf, **arguments)


def test_the_command_writes_fourteen_recordings(tmp_path: Path) -> None:
    write_tire(TireModel(law=PowerLaw(600.0, 1.3), name="another"), tmp_path / "tire.json")
    arguments = [
        "--out",
        str(tmp_path / "rig"),
        "--tire",
        str(tmp_path / "tire.json"),
        "--noise",
        "2 lbf",
        "--seed",
        "9",
    ]
    done = CliRunner().invoke(command, arguments)
    assert done.exit_code == 0, done.output
    written = sorted(path.name for path in (tmp_path / "rig").iterdir())
    assert len(written) == 14
    assert {"flat.csv", "convex_1.27cm.csv", "concave_50.8cm.csv"} <= set(written)
    read = read_recording(tmp_path / "rig" / "concave_50.8cm.csv")
    assert read.surface_radius[0] == pytest.approx(-0.508, rel=1e-11)
    noise = read.force - 600.0 * (100.0 * read.deflection) ** 1.3
    # 2 lbf are 8.896 N; 151 samples: four standard errors are 23 %
    assert noise.std() == pytest.approx(8.896, rel=0.23)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--noise", "10"], "'10' is not a number with a unit; write for instance 10N"),
        (["--noise", "10 kg"], "is not a unit of force"),
        (["--tire", "absent.json"], "absent.json: No such file"),
    ],
)
def test_the_command_tells_bad_input_in_a_sentence(
    arguments: list[str], sentence: str, tmp_path: Path
) -> None:
    done = CliRunner().invoke(command, ["--out", str(tmp_path), *arguments])
    assert done.exit_code == 2
    assert sentence in done.output
