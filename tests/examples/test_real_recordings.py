"""The example of real recordings: its readers on files written here, and all of it where the data are."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from tirelab.regressors.dataset import dataset_of
from tirelab.regressors.excitation import excitation_of

FOLDERS = (
    "afm_creep_brain_gel",
    "mr_damper_sine",
    "nanoindent_series_compliance_drift",
    "pneumatic_cylinder_pressure_friction",
)


@pytest.fixture
def examples(repository: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of examples, from which they can be imported."""
    monkeypatch.syspath_prepend(repository / "examples")
    return repository / "examples"


@pytest.fixture
def indentations(examples: Path) -> ModuleType:
    return importlib.import_module("indentations")


@pytest.fixture
def real_recordings(examples: Path) -> ModuleType:
    return importlib.import_module("real_recordings")


@pytest.fixture
def data(shared: Path) -> Path:
    folder = shared / "recordings" / "real"
    if not all((folder / name).is_dir() for name in FOLDERS):
        pytest.skip(f"no real recordings in {folder}")
    return folder


def curve(path: Path, *, coefficient: float, contact: float, baseline: float, creep: float) -> None:
    """A JPK text export of F = baseline + coefficient (d - contact)^1.5 [nN, um]; the hold sinks by `creep` [um]."""
    time = np.arange(9000) * 1e-3
    depth = np.interp(time, [0.0, 3.0, 6.0, 9.0], [0.0, 12.0, 12.0 + creep, 0.0])
    force = baseline + coefficient * np.maximum(depth - contact, 0.0) ** 1.5
    force[3000:6000] = force[2999]
    height = 50e-6 - 1e-6 * (depth + 1e-3 * (force - baseline) / 0.061)
    with path.open("w", encoding="latin-1") as file:
        for i, names in enumerate(
            ("measuredHeight vDeflection seriesTime", "vDeflection measuredHeight seriesTime") * 2
        ):
            if i == 3:
                break
            file.write(f"# segment: {i}\n# columns: {names}\n# units: m N s\n\n")
            for row in range(3000 * i, 3000 * i + 3000):
                h, f = f"{height[row]:.9e}", f"{1e-9 * force[row]:.9e}"
                file.write(f"{h} {f} {time[row]}\n" if names.startswith("m") else f"{f} {h} {time[row]}\n")


def test_contact_law_and_creep_are_found_in_an_indentation(indentations: ModuleType, tmp_path: Path) -> None:
    curve(tmp_path / "curve.txt", coefficient=0.25, contact=4.0, baseline=3.0, creep=1.0)
    found = indentations.indentation(tmp_path / "curve.txt")
    # 1e4 um are 1 cm: 0.25 nN/um^1.5 is 0.25e-9 N / (1e-4 cm)^1.5
    assert found.coefficient == pytest.approx(0.25e-9 * 1e6, rel=1e-3)
    # means over a tenth of a second at both ends of the hold, which sinks evenly for three
    assert found.creep == pytest.approx(1.0 - 0.1 / 3.0, abs=1e-3)
    assert found.recording.deflection.max() == pytest.approx(9e-6, abs=1e-8)
    assert found.recording.force[0] < 0.01e-9


def test_a_hysitron_file_gives_columns_and_compliance(indentations: ModuleType, tmp_path: Path) -> None:
    text = (
        "Time Stamp: now\nMachine Comp: 0.00663947 nm/µN\nDrift Measurement Data Points: 1\nTime_s\tDisp_nm\n0\t1\n\n"
        "Test Data Points: 2\nTime_s\tDisp_nm\tForce_µN\n0.0\t5.8\t204.6\n0.005\t4.7\t206.4\n\nend\n"
    )
    (tmp_path / "test.hld").write_text(text, encoding="latin-1")
    columns, compliance = indentations.read_hysitron(tmp_path / "test.hld")
    assert compliance == 0.00663947
    assert columns["Disp_nm"].tolist() == [5.8, 4.7]
    assert columns["Force_µN"].tolist() == [204.6, 206.4]


def test_a_power_law_gives_its_own_coefficients_back(indentations: ModuleType) -> None:
    x = np.linspace(0.0, 500.0, 200)
    assert indentations.power_law_fit(x, 1.5 * (x + 9.0) ** 1.9) == pytest.approx((1.5, 1.9, -9.0), rel=1e-5)


def test_without_data_it_says_where_they_are_from(
    real_recordings: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("sys.argv", ["real_recordings.py", str(tmp_path / "none")])
    assert real_recordings.main() == 2
    assert "get the recordings" in capsys.readouterr().err
    for repository in ("afmformats", "micromechanics", "mr-damper", "3D-printed-pneumatic-actuator"):
        assert repository in str(real_recordings.__doc__)


def test_no_file_of_the_data_is_in_the_repository(repository: Path, data: Path) -> None:
    names = {path.name for path in data.rglob("*") if path.is_file()} - {"SOURCE.txt"}
    assert not [path for path in repository.rglob("*") if path.name in names and ".git" not in path.parts]


@pytest.mark.slow
def test_the_tissue_relaxes_and_the_correction_holds_where_it_was_not_fitted(
    real_recordings: ModuleType, data: Path
) -> None:
    for found in (real_recordings.brain(data / FOLDERS[0]), real_recordings.gel(data / FOLDERS[0])):
        assert "viscoelastic_relaxation" in found.verdict.names
        assert found.after < 0.3 * found.before
        assert found.verdict.recordings[0].deflection.max() < 20e-6  # as it was read, in metres
        likely = {e.name for e in found.verdict.effects if e.probability > 0.5}
        assert not likely & {"saturation", "rate_independent_hysteresis"}
        # One approach and a hold: no drift shows in it, however its deflection creeps.
        assert any("drift" in line and "visited again" in line for line in found.not_shown())


@pytest.mark.slow
def test_the_indenters_own_compliance_is_not_claimed(real_recordings: ModuleType, data: Path) -> None:
    found = real_recordings.indenter(data / FOLDERS[2])
    assert "series_compliance" not in found.verdict.names
    # both numbers were measured on this file by its notes: 1.22 as it is, 1.88 without the machine
    assert "B = 1.2" in found.baseline
    assert any("1.9" in line for line in found.evidence)


@pytest.mark.slow
def test_the_damper_has_preload_and_a_loop(real_recordings: ModuleType, data: Path) -> None:
    found = real_recordings.damper(data / FOLDERS[1], "ensaio1")
    # at rest it presses with 120 N by its notes; the line through the strokes has that preload
    assert found.verdict.baseline.preload == pytest.approx(120.0, abs=10.0)
    assert set(found.verdict.names) & {
        "rate_independent_hysteresis",
        "viscous_damping",
        "viscoelastic_relaxation",
        "unknown",
    }
    assert found.after < 0.5 * found.before


@pytest.mark.slow
@pytest.mark.parametrize("bar", [1, 7])
def test_the_pistons_friction_is_not_claimed_from_one_speed(
    real_recordings: ModuleType, data: Path, bar: int
) -> None:
    found = real_recordings.piston(data / FOLDERS[3], bar)
    assert found.verdict.names
    assert found.after < 0.5 * found.before
    assert not any("CLAIMS" in refusal.text(found.verdict) for refusal in found.refusals)
    assert any("49.9 N/bar over all files" in line for line in found.evidence)


@pytest.mark.slow
def test_four_pressures_together_show_what_a_bar_does(real_recordings: ModuleType, data: Path) -> None:
    found = real_recordings.pistons(data / FOLDERS[3])
    assert "inflation_pressure" in found.verdict.names
    files = real_recordings.piston_recordings(data / FOLDERS[3])
    # 499 mm2 of piston: 49.9 N/bar, by the notes of the recordings
    assert real_recordings.gain_per_bar(found.verdict.tire, files[3]) == pytest.approx(49.9, rel=0.02)
    assert found.after < 0.05 * found.before


@pytest.mark.parametrize("bar", [1, 3, 5, 7])
def test_no_pressure_alone_can_show_it(real_recordings: ModuleType, data: Path, bar: int) -> None:
    own = real_recordings.piston_recordings(data / FOLDERS[3])[bar]
    tire = real_recordings.preloaded(float(own.force.mean()))
    for samples in (slice(0, None), slice(0, len(own) // 2), slice(len(own) // 2, None)):
        found = excitation_of(dataset_of([real_recordings.part(own, samples)], tire))
        assert "was the same" in found.hidden("inflation_pressure")
        assert "gas_compression" in found.channels.impossible
