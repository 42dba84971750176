"""Rigs that count compression negative are recognised, and doubtful ones asked about."""

import shlex
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from house_form import loading, refusal, write_rows
from tirelab.cli import main
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.choices import Choices
from tirelab.recordings.reading import Reading
from tirelab.recordings.recording import RecordingError, read_recording, understand
from tirelab.recordings.sign_convention import compressive_signs, mass_alike, work_share


class TestSigns:
    @pytest.mark.parametrize(
        ("deflection_sign", "force_sign", "turned"),
        [(-1, -1, "deflection and force"), (-1, 1, "deflection"), (1, -1, "force")],
    )
    def test_a_rig_that_counts_the_other_way_is_recognised(
        self, tmp_path: Path, deflection_sign: int, force_sign: int, turned: str
    ) -> None:
        time, deflection, force = loading()
        header = "time [s],deflection [cm],force [N]"
        path = write_rows(tmp_path / "a.csv", header, time, deflection * deflection_sign, force * force_sign)
        recording = read_recording(path, radius="flat")
        np.testing.assert_allclose(recording.deflection, deflection / 100.0, rtol=1e-5)
        np.testing.assert_allclose(recording.force, force, rtol=1e-5)
        assert f"the rig counts compression negative: {turned} turned in sign" in recording.notes

    def test_noise_lag_and_lift_off_leave_a_right_rig_as_it_is(self) -> None:
        noise = np.random.default_rng(7)
        x = np.sin(np.linspace(0.0, 60.0, 5000)) * 0.02
        force = np.roll(1.6e5 * np.clip(x, 0.0, None), 20) + 20.0 * noise.normal(size=5000)
        signs = compressive_signs(x, force)
        assert (signs.deflection, signs.force, signs.doubt) == (1, 1, "")

    def test_a_tire_in_the_air_is_left_as_it_is(self) -> None:
        noise = np.random.default_rng(7)
        signs = compressive_signs(
            -0.01 + 0.005 * np.sin(np.arange(5000) / 50.0), 6.0 * noise.normal(size=5000)
        )
        assert (signs.deflection, signs.force, signs.doubt) == (1, 1, "")
        signs = compressive_signs(np.linspace(-0.02, -0.01, 100), np.zeros(100))
        assert (signs.deflection, signs.force, signs.doubt) == (1, 1, "")

    def test_force_that_falls_with_deflection_is_asked_about(self, tmp_path: Path) -> None:
        time, deflection, force = loading(201)
        # A gap between wheel and surface that closes: positive, and smallest under load.
        path = write_rows(
            tmp_path / "a.csv", "time [s],deflection [cm],force [N]", time, 5.0 - deflection, force
        )
        said = refusal(path, radius="flat")
        assert "force falls with deflection" in said
        # the gap is 5 cm where the force begins
        assert "--columns 'deflection=-deflection [cm],force=+force [N]' --zero deflection=50mm" in said

    def test_a_crosshead_that_counts_down_gets_a_command_that_works(self, tmp_path: Path) -> None:
        """From 100 mm on downwards, and the force negative: both signs are turned, and the zero is at 100 mm."""
        time, deflection, force = loading(201)
        header = "Time (s),Crosshead (mm),Force (N)"
        path = write_rows(tmp_path / "a.csv", header, time, 100.0 - 10.0 * deflection, -force)
        asked = CliRunner().invoke(main, ["inspect", str(path), "--radius", "flat"])
        assert asked.exit_code == 2
        proposed = shlex.split(asked.stderr.splitlines()[-1].split("check: ", 1)[1])
        assert "deflection=-Crosshead (mm),force=-Force (N)" in proposed
        assert proposed[-2:] == ["--zero", "deflection=100mm"]
        done = CliRunner().invoke(main, proposed[1:])
        assert done.exit_code == 0, done.output
        recording = read_recording(path)
        np.testing.assert_allclose(recording.deflection, deflection / 100.0, atol=1e-7)
        np.testing.assert_allclose(recording.force, force, rtol=1e-5)
        assert recording.doubts == ()

    def test_a_sign_that_is_given_stays_in_the_command_that_is_proposed(self, tmp_path: Path) -> None:
        """A muscle that pulls while its gauge counts down: turned as asked, the force has to be turned, too."""
        time, deflection, force = loading(201)
        path = write_rows(tmp_path / "a.csv", "Time (s),z (mm),Load (N)", time, 10.0 * deflection, force)
        columns = {"deflection": "-z", "force": "Load"}
        with pytest.raises(RecordingError, match=r"--columns 'deflection=-z.*,force=-Load.*'"):
            Reading(part=True, columns=columns)(path)

    def test_a_part_that_is_loaded_the_other_way_and_breaks_is_turned(self, tmp_path: Path) -> None:
        """After the break the force says nothing of the deflection, which goes on; under load both are negative."""
        time = np.arange(400) / 10.0
        force = np.where(time < 10.0, 4.0 * time, 20.0)
        header = "time [s],Displacement [mm],Force [N]"
        path = write_rows(tmp_path / "a.csv", header, time, -0.05 * time, -force)
        with pytest.raises(RecordingError, match="which way the rig counts cannot be determined"):
            read_recording(path, radius="flat")
        read = Reading(part=True)(path)
        np.testing.assert_allclose(read.force, force, rtol=1e-5)
        np.testing.assert_allclose(read.deflection, 5e-5 * time, rtol=1e-5)
        # the strip may as well be pulled
        assert "deflection and force are both negative under load: both turned in sign" in read.notes
        assert not any("compression" in note for note in read.notes)
        columns = {"deflection": "+Displacement", "force": "+Force"}
        np.testing.assert_allclose(Reading(part=True, columns=columns)(path).force, -force, rtol=1e-5)

    def test_a_specimen_that_fails_and_is_pulled_on_is_not_turned_unasked(self) -> None:
        """Its gauge begins at -0.6 mm; the force rises to -0.4 mm and then falls, over most of the way."""
        deflection = np.linspace(-0.6, 0.8, 300)
        force = np.where(
            deflection < -0.4, 10.0 * (deflection + 0.6), 2.0 * np.exp(-3.0 * (deflection + 0.4))
        )
        found = compressive_signs(deflection, force)
        assert (found.deflection, found.force, found.falls) == (1, 1, False)
        assert found.doubt == "force rises with deflection; under load force is positive, deflection negative"
        # From above to below: the same specimen on a rig that counts down.
        down = compressive_signs(-deflection - 0.2, force)
        assert (down.deflection, down.force) == (-1, 1)

    @pytest.mark.parametrize("counts", [1, -1])
    def test_a_polymer_that_yields_early_and_is_drawn_to_its_break_counts_as_it_is_loaded(
        self, counts: int
    ) -> None:
        """Its force rises over 7 % of the way, in a hundred steps of the gauge, and falls over the rest."""
        way = np.arange(0.0, 40.0, 0.025)
        force = np.interp(way, [0.0, 2.8, 4.0, 20.0, 38.0, 38.4, 40.0], [0, 380, 270, 255, 150, 5, 0])
        found = compressive_signs(counts * way, force + np.random.default_rng(4).normal(0.0, 0.5, way.size))
        assert (found.deflection, found.force, found.doubt) == (counts, 1, "")

    def test_the_noise_of_a_gauge_before_an_early_peak_is_no_loading(self) -> None:
        """A gap that closes; at first the rig rests, and a reading of the force is false there."""
        noise = np.random.default_rng(3).normal(0.0, 0.01, 300)
        gap = np.concatenate([np.full(60, 40.0), np.linspace(40.0, 0.0, 240)]) + noise
        force = 1e3 * np.concatenate([np.zeros(60), np.linspace(0.0, 1.0, 240)])
        force[np.argmax(gap[:60])] = 1500.0
        found = compressive_signs(gap, force)
        assert (found.deflection, found.force, found.falls) == (-1, 1, True)

    @pytest.mark.parametrize("softens_to", [0.6, 0.4])
    def test_a_specimen_that_yields_while_its_gauge_counts_down_is_asked_about(
        self, tmp_path: Path, softens_to: float
    ) -> None:
        """Its force rises over the first third of the way, and falls over the rest."""
        way = np.linspace(0.0, 4.5, 400)
        force = np.interp(way, [0.0, 1.5, 4.5], [0.0, 1200.0, softens_to * 1200.0])
        path = write_rows(tmp_path / "a.csv", "time [s],Displacement [mm],Force [N]", way, -way, force)
        with pytest.raises(IncompleteRecording) as caught:
            Reading(part=True)(path)
        assert caught.value.words() == ["--columns", "deflection=-Displacement [mm],force=+Force [N]"]
        columns = caught.value.settings.columns
        np.testing.assert_allclose(
            Reading(part=True, columns=columns)(path).deflection, 1e-3 * way, rtol=1e-5
        )

    def test_a_part_whose_force_has_both_signs_is_left_as_it_is(self, tmp_path: Path) -> None:
        time = np.arange(400) / 10.0
        header = "time [s],Displacement [mm],Force [N]"
        path = write_rows(tmp_path / "a.csv", header, time, -1.0 - 0.5 * np.sin(time), -5.0 * np.cos(time))
        read = Reading(part=True)(path)
        assert read.deflection.max() < 0.0
        assert read.force[0] == -5.0

    @pytest.mark.parametrize("pull", [15.0, 25.0, 40.0])
    def test_a_damper_that_is_stiffer_one_way_counts_as_its_sister_does(
        self, tmp_path: Path, pull: float
    ) -> None:
        """Force and deflection are of both signs; which of the forces is larger says nothing of how the rig counts."""
        time = np.arange(800) / 20.0
        turn = np.sin(time - 0.6)
        force = 10.0 * np.clip(turn, 0.0, None) + pull * np.clip(turn, None, 0.0)
        path = write_rows(
            tmp_path / "a.csv", "time [s],Displacement [mm],Force [N]", time, 5.0 * np.sin(time), force
        )
        read = Reading(part=True)(path)
        np.testing.assert_allclose(read.force, force, rtol=1e-4, atol=1e-4)
        np.testing.assert_allclose(read.deflection, 5e-3 * np.sin(time), rtol=1e-4, atol=1e-7)

    def test_a_sign_that_the_user_settles_is_taken(self, tmp_path: Path) -> None:
        time, deflection, force = loading()
        path = write_rows(tmp_path / "a.csv", "time [s],gap [cm],force [N]", time, 5.0 - deflection, force)
        turned = read_recording(path, radius="flat", columns={"deflection": "-gap", "force": "+force"})
        np.testing.assert_allclose(turned.deflection, (deflection - 5.0) / 100.0, atol=1e-7)
        assert "deflection turned in sign, as asked" in turned.notes
        kept = read_recording(path, radius="flat", columns={"deflection": "+gap", "force": "+force"})
        np.testing.assert_allclose(kept.deflection, (5.0 - deflection) / 100.0, atol=1e-7)


class TestWork:
    """Shares of the work by their closed forms; 400 samples to a cycle err by 1e-4."""

    turn = 2.0 * np.pi * np.arange(2000) / 400.0
    x = 0.02 + 0.01 * np.sin(turn)

    def test_a_damper_or_friction_alone_takes_all_of_it(self) -> None:
        for force in (120.0 + 300.0 * np.cos(self.turn), 50.0 * np.sign(np.cos(self.turn))):
            assert work_share(self.x, force) == pytest.approx(1.0, abs=0.01)
            assert work_share(self.x, -force) == pytest.approx(-1.0, abs=0.01)

    def test_a_spring_takes_none_and_one_that_is_read_late_gives_some(self) -> None:
        assert work_share(self.x, 3e4 * self.x**2) == pytest.approx(0.0, abs=1e-3)
        late = 3e4 * (0.02 + 0.01 * np.sin(self.turn - 0.2))
        assert work_share(self.x, late) == pytest.approx(-0.5 * np.pi * np.sin(0.2), rel=0.02)

    def test_the_noise_of_a_gauge_in_one_slow_stroke_makes_no_cycles(self) -> None:
        """Friction of 20 N, and a gauge whose noise of 0.05 mm passes the middle again and again on the way."""
        stroke = np.interp(np.arange(4000.0), [0.0, 1900.0, 3999.0], [0.0, 0.08, 0.0])
        noise = 5e-5 * np.random.default_rng(4).standard_normal(4000)
        force = 20.0 * np.sign(np.gradient(stroke))
        once = stroke + noise
        above = once > np.median(once)
        assert np.count_nonzero(above[1:] & ~above[:-1]) > 2
        assert np.isnan(work_share(once, force))
        assert work_share(np.tile(once, 3), np.tile(force, 3)) > 0.5

    def test_one_ramp_tells_nothing(self) -> None:
        x = np.linspace(0.0, 0.02, 500)
        assert np.isnan(work_share(x, 1e6 * x**1.4))


@pytest.mark.parametrize("part", ["part = true\n", ""])
def test_loops_that_run_backwards_are_doubted_and_the_turned_force_is_not(tmp_path: Path, part: str) -> None:
    time = np.arange(2000) / 400.0
    x = 2.0 + np.sin(2.0 * np.pi * time)
    path = write_rows(
        tmp_path / "a.csv", "time [s],deflection [cm],force [N]", time, x, 50.0 - 40.0 * np.gradient(x, time)
    )
    (tmp_path / "recording.toml").write_text(part, encoding="utf-8")
    said = " ".join(read_recording(path, radius="flat", columns=SIGNED).notes)
    assert "loops of force over deflection run backwards: 100% of the work comes out of the part" in said
    turned = {**SIGNED, "force": "-force [N]"}
    assert "backwards" not in " ".join(read_recording(path, radius="flat", columns=turned).notes)


def test_columns_without_names_whose_loops_run_backwards_may_be_exchanged(tmp_path: Path) -> None:
    """A spring with friction whose force is the first column: the loop of x over F runs the other way round."""
    turn = 2.0 * np.pi * np.arange(2000) / 400.0
    x = 2.0 + np.sin(turn)
    path = write_rows(tmp_path / "a.csv", "", 5.0 * x + 20.0 * np.cos(turn), x)
    units = {"deflection": "mm", "force": "N"}
    (doubt,) = Reading(part=True, columns={"deflection": "+#1", "force": "+#2"}, units=units)(path).doubts
    assert "are they exchanged, or is one counted the other way? --columns deflection=#2,force=#1" in doubt
    assert Reading(part=True, columns={"deflection": "+#2", "force": "+#1"}, units=units)(path).doubts == ()
    named = write_rows(tmp_path / "b.csv", "deflection,force", 5.0 * x + 20.0 * np.cos(turn), x)
    columns = {"deflection": "+deflection", "force": "+force"}
    (doubt,) = Reading(part=True, columns=columns, units=units)(named).doubts
    assert "exchanged" not in doubt


SIGNED = {"deflection": "+deflection [cm]", "force": "+force [N]"}


@pytest.mark.parametrize("rests", [0.0, 3.0])
def test_a_mass_is_found_by_the_force_that_falls_with_its_way(rests: float) -> None:
    """F = m a of a sine is -m w^2 x, also where the motion rests between its cycles."""
    moving = np.arange(0.0, 2.0, 1e-3)
    x = 0.012 * np.sin(2.0 * np.pi * 5.0 * moving)
    still = np.zeros(int(1e3 * rests))
    deflection = np.concatenate([x, still, x])
    time = 1e-3 * np.arange(len(deflection))
    force = -1.7 * (2.0 * np.pi * 5.0) ** 2 * deflection
    assert mass_alike(time, deflection, force) == pytest.approx(1.7, rel=0.02)
    assert mass_alike(time, deflection, -force) == np.inf


def test_a_clock_that_stands_tells_no_mass() -> None:
    """Segments of a file that each begin at 0, or a clock that was not read."""
    x = 1e-3 * np.sin(np.linspace(0.0, 20.0 * np.pi, 2000))
    assert mass_alike(np.zeros(x.size), x, -1e4 * x) == np.inf
    assert mass_alike(np.linspace(0.0, 10.0, x.size), x, -1e4 * x) == pytest.approx(
        1e4 / (2.0 * np.pi) ** 2, rel=0.01
    )


def test_a_rest_at_one_end_that_is_longer_than_the_motion_hides_neither_mass_nor_work() -> None:
    """2 s at 5 Hz between 0 and 24 mm, then 5 s at 24 mm: a mass of 1.7 kg, or friction of 10 N."""
    time = 1e-3 * np.arange(7000)
    x = np.where(time < 2.1, 0.012 - 0.012 * np.cos(2.0 * np.pi * 5.0 * time), 0.024)
    acceleration = np.where(time < 2.1, 0.012 * (10.0 * np.pi) ** 2 * np.cos(10.0 * np.pi * time), 0.0)
    assert mass_alike(time, x, 1.7 * acceleration) < 10.0
    assert work_share(x, 10.0 * np.sign(np.gradient(x))) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("rate", "asked"), [(5.0, True), (0.05, False)])
@pytest.mark.parametrize("part", [True, False])
def test_a_part_that_is_driven_so_fast_that_a_mass_does_it_is_not_turned_unasked(
    tmp_path: Path, rate: float, asked: bool, part: bool
) -> None:
    """A cell with a rod on it and some damping, which hangs at -18 N; slow, the same force is a spring's."""
    time = np.arange(0.0, 4.0 / rate, 0.005 / rate)
    phase = 2.0 * np.pi * rate * time
    force = -18.0 - 15.0 * np.sin(phase) + 1.0 * np.cos(phase)
    path = write_rows(
        tmp_path / "a.csv", "t [s],position [mm],force [N]", time, 12.0 + 12.0 * np.sin(phase), force
    )
    how = Choices(part=part, radius="flat")
    if not (asked and part):
        assert any("force turned in sign" in note for note in understand(path, how).recording.notes)
        return
    with pytest.raises(IncompleteRecording, match=r"1\.3 kg at this speed") as caught:
        understand(path, how)
    assert caught.value.words()[1] == "deflection=+position [mm],force=+force [N]"
