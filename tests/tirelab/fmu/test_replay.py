"""Replaying an FMU on a recording: every sample, no delay, nothing left behind."""

from __future__ import annotations

import re
import tempfile
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import CATALOGUE, TireModel
from tirelab.errors import TirelabError
from tirelab.fmu.build import build_fmu
from tirelab.fmu.replay import replay
from tirelab.recordings.recording import Recording


@dataclass(frozen=True)
class Motion:
    time: NDArray[np.float64]
    deflection: NDArray[np.float64]
    surface_radius: NDArray[np.float64]


def motion(samples: int = 400) -> Motion:
    time = 5.0 + np.cumsum(np.full(samples, 0.01))
    deflection = 0.012 + 0.012 * np.sin(7.0 * time) * np.sin(0.3 * time)
    return Motion(time, deflection, np.where(np.arange(samples) % 2 == 0, np.inf, 0.2))


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_fmu(TireModel(), tmp_path_factory.mktemp("replay")).path


def test_replay_is_the_law_at_every_sample(fmu: Path) -> None:
    """The surface changes at every sample, so that a sample of delay would show as hundreds of newtons."""
    m = motion()
    a = np.where(np.isinf(m.surface_radius), 550.9, 550.9 - 337.8 * np.exp(-0.2519 * 20))
    b = np.where(np.isinf(m.surface_radius), 1.422, 1.422 - 0.2469 * np.exp(-0.1651 * 20))
    expected = a * np.maximum(100 * m.deflection, 0) ** b
    np.testing.assert_allclose(replay(fmu, m), expected, rtol=1e-12)


def test_replay_with_a_memory_equals_the_model_stepped_by_hand(tmp_path: Path) -> None:
    friction, damping = CATALOGUE["rate_independent_hysteresis"], CATALOGUE["viscous_damping"]
    tire = TireModel(
        effects=(
            (friction, (40.0, 2e-3, *(p.start for p in friction.parameters[2:]))),
            (damping, (500.0, *(p.start for p in damping.parameters[1:]))),
        )
    )
    m = motion()
    state, expected = tire.initial_state, []
    for t, x, radius in zip(m.time.tolist(), m.deflection.tolist(), m.surface_radius.tolist(), strict=True):
        force, state = tire.step(x, radius, t, state)
        expected.append(force)
    simulated = replay(build_fmu(tire, tmp_path).path, m)
    # time - step + step is rounded once more on its way through the FMI: 1e-16 of 9 s in a rate over 0.01 s.
    np.testing.assert_allclose(simulated, expected, rtol=1e-9, atol=1e-9)


def test_a_part_of_a_file_is_replayed_after_what_was_recorded_before_it(tmp_path: Path) -> None:
    friction = CATALOGUE["rate_independent_hysteresis"]
    tire = TireModel(effects=((friction, (40.0, 2e-3, *(p.start for p in friction.parameters[2:]))),))
    m, fmu = motion(), build_fmu(tire, tmp_path).path
    whole = Recording("whole", m.time, m.deflection, m.surface_radius, np.zeros(m.time.size))

    def cut(part: slice) -> Recording:
        return Recording(
            "part", *(a[part] for a in (m.time, m.deflection, m.surface_radius)), whole.force[part]
        )

    part = replace(cut(slice(100, None)), history=cut(slice(0, 100)))
    np.testing.assert_array_equal(replay(fmu, part), replay(fmu, whole)[100:])
    np.testing.assert_array_equal(replay(fmu, part, most=30), replay(fmu, part)[:30])
    assert abs(replay(fmu, replace(part, history=None))[0] - replay(fmu, part)[0]) > 1.0


def test_nothing_is_left_behind(fmu: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    replay(fmu, motion(10))
    assert list(tmp_path.iterdir()) == []


def test_a_refused_sample_is_named(fmu: Path) -> None:
    m = motion(20)
    m.deflection[7] = np.nan
    with pytest.raises(TirelabError, match=r"refused sample 7 .*deflection = nan m is not allowed"):
        replay(fmu, m)


def test_a_refused_first_sample_is_named(fmu: Path) -> None:
    m = motion(20)
    m.deflection[0] = 5.0
    with pytest.raises(TirelabError, match=r"refused sample 0 .*deflection = 5 m is not allowed"):
        replay(fmu, m)


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 cut off"])
def test_a_file_that_is_no_fmu(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "x.fmu").write_bytes(content)
    with pytest.raises(TirelabError, match=r"x\.fmu .*(cannot be read|breaks)"):
        replay(tmp_path / "x.fmu", motion(3))


def test_a_missing_fmu(tmp_path: Path) -> None:
    with pytest.raises(TirelabError, match="does not exist"):
        replay(tmp_path / "nothing.fmu", motion(3))


def changed(fmu: Path, folder: Path, old: str, new: str) -> Path:
    """Return a copy of `fmu` whose model description has `new` in place of the pattern `old`."""
    path = folder / "changed.fmu"
    with zipfile.ZipFile(fmu) as given, zipfile.ZipFile(path, "w") as copy:
        for name in given.namelist():
            content = given.read(name)
            if name == "modelDescription.xml":
                text, count = re.subn(old, new, content.decode())
                assert count
                content = text.encode()
            copy.writestr(name, content)
    return path


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (
            'fmiVersion="2.0"',
            'fmiVersion="2.0" wrong="1" worse="2"',
            r"changed\.fmu breaks the FMI standard \(.*\); build it again",
        ),
        (
            "<CoSimulation [^>/]*",
            '<ModelExchange modelIdentifier="BicycleTire"',
            "is not an FMI 2.0 Co-Simulation unit; export it as one",
        ),
        ('name="radial_force"', 'name="push"', "has no variable 'radial_force'; a tire has deflection"),
        ('modelIdentifier="BicycleTire"', 'modelIdentifier="Absent"', "has no binary for this machine"),
    ],
)
def test_an_fmu_that_is_no_tire_for_this_machine_is_refused(
    fmu: Path, tmp_path: Path, old: str, new: str, sentence: str
) -> None:
    with pytest.raises(TirelabError, match=sentence) as caught:
        replay(changed(fmu, tmp_path, old, new), motion(3))
    assert "\n" not in str(caught.value)


def test_an_fmu_that_cannot_be_instantiated_says_why(fmu: Path, tmp_path: Path) -> None:
    path = tmp_path / "hollow.fmu"
    with zipfile.ZipFile(fmu) as given, zipfile.ZipFile(path, "w") as copy:
        for name in given.namelist():
            if not name.endswith("tire.json"):
                copy.writestr(name, given.read(name))
    with pytest.raises(TirelabError, match=r"hollow\.fmu cannot be instantiated: .*tire\.json"):
        replay(path, motion(3))
