"""A law that leaves more than the noise of the readings says so, with the command that looks further."""

import json
import math
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from rivals import looking_for
from scipy.signal import lfilter
from tirelab.cli import main
from tirelab.identification.identify import identify
from tirelab.identification.misfit import misfit_sentence
from tirelab.recordings.recording import Recording
from tirelab.recordings.writing import write_recording

T = np.arange(3000) / 50.0
X = 0.022 * (1.0 - np.abs(2.0 * (T / 20.0 % 1.0) - 1.0))
WAY = np.sign(np.gradient(X))


def pressed(friction: float, noise: float) -> Recording:
    force = 600.0 * (100.0 * X) ** 1.4
    force += friction * WAY * np.minimum(X / 2e-3, 1.0) + noise * np.random.default_rng(4).standard_normal(
        T.size
    )
    return Recording("press", T, X, np.full(T.size, np.inf), force)


@pytest.mark.parametrize("noise", [0.5, 4.0, 20.0])
@pytest.mark.parametrize("friction", [0.0, 27.0])
def test_the_noise_is_that_of_the_readings_whatever_the_law_leaves(friction: float, noise: float) -> None:
    found = identify([pressed(friction, noise)])
    assert found.reading_noise == pytest.approx(noise, rel=0.06)
    assert found.rmse == pytest.approx(math.hypot(friction, noise), rel=0.08)


def test_the_notes_of_an_identification_say_it_too() -> None:
    found = identify([pressed(27.0, 4.0)])
    assert found.notes[-1] == found.misfit
    assert found.misfit.endswith("so something else acts here: diagnose the recordings with this tire")
    assert found.misfit in json.loads(found.to_json())["notes"]
    assert identify([pressed(0.0, 4.0)]).misfit == ""
    assert not any("noise" in note for note in identify([pressed(0.0, 4.0)]).notes)


@pytest.mark.parametrize("samples", [3.0, 10.0])
def test_noise_that_a_filter_made_smooth_counts_whole_and_is_no_misfit(samples: float) -> None:
    """White noise behind a first-order filter of so many samples, 4 N in all: from sample to sample it is 0.5 N."""
    white = np.random.default_rng(7).standard_normal(T.size + 100)
    keep = math.exp(-1.0 / samples)
    smooth = 4.0 * math.sqrt(1.0 - keep**2) * lfilter([1.0], [1.0, -keep], white)[100:]
    one = pressed(0.0, 0.0)
    found = identify([replace(one, force=one.force + smooth)])
    # known to 1 / sqrt(2 n) of the 3000 / (2 samples) that are independent, and to the memory that is seen
    assert found.reading_noise == pytest.approx(4.0, rel=0.25)
    assert misfit_sentence(found.rmse, found.reading_noise, "x") == ""


def test_only_what_is_more_than_the_noise_is_said() -> None:
    assert misfit_sentence(27.0, 4.0, "tirelab diagnose a.csv") == (
        "the law leaves 27 N beside 4 N of noise, so something else acts here: try `tirelab diagnose a.csv`"
    )
    assert "the law leaves 240 N beside 5 N of noise" in misfit_sentence(240.4, 5.0, "x")
    assert misfit_sentence(4.2, 4.0, "x") == ""
    assert misfit_sentence(4.2, math.nan, "x") == ""
    assert misfit_sentence(1e-9, 0.0, "x") == ""


def test_the_command_proposes_one_that_runs(tmp_path: Path) -> None:
    write_recording(pressed(27.0, 4.0), tmp_path / "press.csv")
    out = tmp_path / "tire.json"
    done = CliRunner().invoke(main, ["identify", str(tmp_path / "press.csv"), "--out", str(out)])
    assert done.exit_code == 0, done.output
    (said,) = [line for line in done.output.splitlines() if "of noise" in line]
    command = shlex.split(said.split("`")[1])
    assert command[:3] == ["tirelab", "diagnose", str(tmp_path / "press.csv")]
    with looking_for("rate_independent_hysteresis", "viscous_damping"):
        diagnosed = CliRunner().invoke(main, [*command[1:], "--out", str(tmp_path / "d"), "--quiet"])
    assert diagnosed.exit_code == 0, diagnosed.output
    # One speed: friction and damping are alike but for their build-up, so friction is named or an alternative.
    verdict = json.loads((tmp_path / "d" / "diagnosis.json").read_text(encoding="utf-8"))["verdict"]
    sets = [[e["name"] for e in verdict["effects"]], *verdict["alternatives"]]
    assert any("rate_independent_hysteresis" in names for names in sets)
    write_recording(pressed(0.0, 4.0), tmp_path / "press.csv")
    done = CliRunner().invoke(main, ["identify", str(tmp_path / "press.csv"), "--out", str(out)])
    assert "of noise" not in done.output


@pytest.mark.parametrize("part", [[], ["--part", "linear"], ["--part", "compare"]])
def test_no_diagnosis_is_proposed_that_would_be_refused(tmp_path: Path, part: list[str]) -> None:
    """One stroke there and back of 80 samples, on a line with 27 N of friction: a hundred are needed."""
    time = 0.05 * np.arange(80)
    x = 0.02 * (1.0 - np.abs(time - 2.0) / 2.0) + 1e-4
    force = 3e4 * x + 27.0 * np.sign(2.0 - time) + 0.1 * np.random.default_rng(1).standard_normal(80)
    path, out = tmp_path / "press.csv", tmp_path / "tire.json"
    write_recording(Recording.from_arrays(time, x, force, "flat"), path)
    done = CliRunner().invoke(main, ["identify", str(path), "--out", str(out), *part])
    assert done.exit_code == 0, done.output
    (said,) = [line for line in done.output.splitlines() if "of noise" in line]
    assert said.endswith(
        "but no diagnosis can say what: recording press has 80 samples; at least 100 are needed"
    )
    assert "tirelab diagnose" not in done.output
