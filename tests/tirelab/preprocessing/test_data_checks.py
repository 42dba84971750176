"""Recordings that cannot be diagnosed are refused with the reason; the least that can is not. Copies are told.

A gauge at the end of its travel is seen, and a hold, a ring or a quick peak is not taken for one.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from radialtire import TireModel
from tirelab.preprocessing.data_checks import (
    FEWEST_BESIDE,
    FEWEST_SAMPLES,
    FEWEST_STEPS,
    SETTLING,
    PoorRecording,
    after_pauses,
    beyond_travel,
    check_recordings,
    check_signal,
    compared,
    copies_told,
    not_compared,
    outliers_told,
    samples_per_cycle,
    spikes,
)
from tirelab.preprocessing.samples import raw_dataset_of
from tirelab.recordings.recording import Recording

FloatArray = NDArray[np.float64]


TIME = np.arange(2000) * 0.01
DEFLECTION = 10e-3 * (1.0 - np.cos(2.0 * np.pi * 0.25 * TIME))
FORCE = 1e5 * DEFLECTION


def recording(**channels: np.ndarray) -> Recording:
    given: dict[str, Any] = {"time": TIME, "deflection": DEFLECTION, "force": FORCE, **channels}
    return Recording("a", surface_radius=np.full(len(given["time"]), np.inf), **given)


def refused(*recordings: Recording) -> str:
    with pytest.raises(PoorRecording) as caught:
        check_recordings(recordings)
    return str(caught.value)


def checked(level: float = 0.0, **channels: np.ndarray) -> None:
    """Check a good recording and one with these channels."""
    pair = [recording(), recording(**channels)]
    check_signal(raw_dataset_of(pair, TireModel()), ["good.csv", "bad.csv"], [0.0, level])


def first(samples: int) -> dict[str, np.ndarray]:
    return {"time": TIME[:samples], "deflection": DEFLECTION[:samples], "force": FORCE[:samples]}


def test_a_good_recording_passes() -> None:
    check_recordings([recording(**first(FEWEST_SAMPLES))])
    check_recordings([recording(), recording(**first(FEWEST_BESIDE))])
    checked()


def test_a_few_samples_are_enough_beside_others_only() -> None:
    assert "has 99 samples; at least 100" in refused(recording(**first(FEWEST_SAMPLES - 1)))
    assert "has 23 samples; at least 24" in refused(recording(), recording(**first(FEWEST_BESIDE - 1)))


def test_nothing_is_refused() -> None:
    assert refused() == "no recording was given; name at least one to diagnose"


@pytest.mark.parametrize(
    ("channels", "reason"),
    [
        ({"deflection": np.full(2000, 0.01)}, "has one constant deflection"),
        ({"force": np.full(2000, 10.0)}, "has one constant force"),
        ({"deflection": DEFLECTION - 0.03}, "never loads the tire"),
        (
            {"deflection": np.arange(2000) % 3 * 0.01},
            f"has only 3 distinct deflections; sample each cycle at {FEWEST_STEPS} or more points",
        ),
    ],
)
def test_what_holds_no_cycle_is_refused(channels: dict[str, np.ndarray], reason: str) -> None:
    assert f"recording a {reason}" in refused(recording(), recording(**channels))
    with pytest.raises(PoorRecording, match=f"^held-out recording a {reason}"):
        check_recordings([recording()], [recording(**channels)])


def test_a_held_out_hold_is_driven_as_what_was_recorded_before_it() -> None:
    """A range of a file: the ramp to the hold is its history. Alone the same hold is refused."""
    hold = recording(deflection=np.full(2000, 0.01))
    with pytest.raises(PoorRecording, match="one constant deflection"):
        check_recordings([recording()], [hold])
    check_recordings([recording()], [replace(hold, history=recording(time=TIME - 20.0))])


def test_a_step_that_is_held_is_a_recording() -> None:
    """A relaxation test: pressed within three samples, then held for all others."""
    step = recording(deflection=np.interp(TIME, [1.0, 1.03], [0.0, 0.01]))
    check_recordings([step], [step])


def test_two_held_out_samples_judge_nothing() -> None:
    with pytest.raises(PoorRecording, match=r"^held-out recording a has 2 samples; at least 24 are needed"):
        check_recordings([recording()], [recording(**first(2))])


@pytest.mark.parametrize("count", [4, 5, 6, 8, 13, 50])
def test_the_samples_of_a_cycle_are_counted(count: int) -> None:
    assert samples_per_cycle(np.sin(2.0 * np.pi / count * np.arange(40.0 * count))) == count


def test_single_steps_between_holds_are_no_cycles() -> None:
    assert samples_per_cycle(np.repeat([0.0, 1.0, 0.0, 1.0], 50)) > 50


@pytest.mark.parametrize(
    ("channels", "reason"),
    [
        (
            {"deflection": 1e-3 * np.random.default_rng(1).standard_normal(2000)},
            "the deflection of recording bad.csv is noise",
        ),
        (
            {"force": np.random.default_rng(2).standard_normal(2000)},
            "does not follow its deflection (correlation",
        ),
        (
            {"deflection": 10e-3 * (1.0 - np.cos(2.0 * np.pi * 19.0 * TIME))},
            "recording bad.csv has about 5 samples per cycle; sample each cycle at 8 or more points",
        ),
        (
            {"deflection": 10e-3 * (1.0 - np.cos(2.0 * np.pi * 23.0 * TIME))},
            "recording bad.csv has four samples per cycle or fewer",
        ),
    ],
)
def test_a_signal_without_a_tire_in_it_is_refused(channels: dict[str, np.ndarray], reason: str) -> None:
    with pytest.raises(PoorRecording) as caught:
        checked(**channels)
    assert reason in str(caught.value)


def test_a_force_that_follows_the_rate_for_the_most_part_is_a_tires() -> None:
    """Damping of ten times the spring's force leaves it a correlation of a tenth with the deflection."""
    rate = np.gradient(DEFLECTION, TIME)
    force = FORCE + 10.0 * float(np.std(FORCE)) / float(np.std(rate)) * rate
    assert abs(np.corrcoef(DEFLECTION, force)[0, 1]) < 0.2
    checked(force=force)


def test_a_force_that_is_noise_for_the_most_part_is_refused() -> None:
    checked(0.5 * float(np.std(FORCE)))
    varies = float(np.std(FORCE))
    with pytest.raises(PoorRecording, match=rf"varies by {varies:.3g} N, hardly more than the noise"):
        checked(varies)


def test_a_force_that_relaxes_in_a_hold_is_not_refused() -> None:
    """A ramp of 1 s and 200 s of rest: over all samples the force falls while the sensor creeps on."""
    time = np.linspace(0.0, 201.0, 4000)
    deflection = np.where(time < 1.0, 0.03 * time, 0.03 + 1e-6 * (time - 1.0))
    force = 4e4 * deflection * np.where(time < 1.0, 1.0, 0.3 + 0.7 * np.exp(-(time - 1.0) / 20.0))
    assert np.corrcoef(force, deflection)[0, 1] < 0.2
    held = Recording("held.csv", time, deflection, np.full(4000, np.inf), force)
    check_signal(raw_dataset_of([held], TireModel()), [held.name], [0.0])


def test_a_step_within_one_sample_that_is_held_is_no_cycle_sampled_once() -> None:
    """Two minutes of rest, read each second: the way in and the way back take a sample each."""
    time = np.arange(120.0)
    deflection = np.where((time > 1.0) & (time < 118.0), 0.01, 0.0)
    force = 4e4 * deflection * (0.3 + 0.7 * np.exp(-time / 20.0))
    held = Recording("held.csv", time, deflection, np.full(120, np.inf), force)
    assert np.sqrt(np.mean(np.diff(deflection) ** 2)) > 0.7 * np.std(deflection)
    check_signal(raw_dataset_of([held], TireModel()), [held.name], [0.0])


CYCLE_TIME = np.linspace(0.0, 6.0, 2401)
MOTION = 0.012 - 0.012 * np.cos(2.0 * np.pi * 0.5 * CYCLE_TIME)
STIFFENING_FORCE = 8e4 * MOTION * (1.0 + 30.0 * MOTION)


def noisy(reading: FloatArray, seed: int = 0) -> FloatArray:
    return reading + np.random.default_rng(seed).normal(0.0, 8e-6, reading.size)


def test_a_clipped_reading_is_found_where_it_is_clipped() -> None:
    end = 0.021
    found = beyond_travel(noisy(np.minimum(MOTION, end)), STIFFENING_FORCE)
    assert found[end < MOTION].mean() > 0.99
    assert found[end - 1e-3 > MOTION].sum() == 0


def test_at_the_other_end_too() -> None:
    end = -0.009
    pulled = MOTION - 0.012
    found = beyond_travel(noisy(np.maximum(pulled, end)), 8e4 * pulled)
    assert found[pulled < end].mean() > 0.99
    assert found[pulled > end + 1e-3].sum() == 0


@pytest.mark.parametrize("step", [0.0, 5e-5])
def test_a_peak_that_was_followed_is_none(step: float) -> None:
    reading = noisy(MOTION) if step == 0.0 else step * np.round(MOTION / step)
    assert not beyond_travel(reading, STIFFENING_FORCE).any()


@pytest.mark.parametrize("kind", ["stop", "friction"])
def test_a_turn_that_was_followed_is_none_however_steep_the_force_is_there(kind: str) -> None:
    """A stop twenty times as stiff as the rest, and a friction loop: the force changes much while the motion turns."""
    stepped = 5e-6 * np.round(MOTION / 5e-6)
    beyond = np.maximum(MOTION - 0.0238, 0.0)
    loop = 300.0 * np.sign(np.gradient(MOTION, CYCLE_TIME))
    force = 8e4 * MOTION + (1.6e6 * beyond if kind == "stop" else loop)
    assert not beyond_travel(stepped, force).any()


def test_behind_a_pause_no_rate_is_known_and_that_is_said() -> None:
    kept = (CYCLE_TIME < 2.0) | (CYCLE_TIME > 3.0)
    paused = Read("paused", CYCLE_TIME[kept], noisy(MOTION)[kept], STIFFENING_FORCE[kept])
    first = int(np.sum(CYCLE_TIME < 2.0))
    assert np.flatnonzero(after_pauses(paused)).tolist() == list(range(first, first + SETTLING))
    (seen,) = compared([paused])
    assert np.sum(~seen) == SETTLING
    (said,) = not_compared([paused])
    assert said.startswith(f"In paused {SETTLING} samples behind pauses of its clock were not compared")


def test_a_part_that_begins_behind_a_pause_does_not_know_it_either() -> None:
    whole = recording(time=np.where(np.arange(2000) < 900, TIME, TIME + 7.0))

    def cut(begin: int, end: int) -> Recording:
        return Recording("a", *(v[begin:end] for v in (whole.time, DEFLECTION, whole.surface_radius, FORCE)))

    part = replace(cut(900, 2000), history=cut(0, 900))
    assert np.flatnonzero(after_pauses(part)).tolist() == list(range(SETTLING))
    assert not after_pauses(cut(900, 2000)).any()


@pytest.mark.parametrize("steps", [[1e-4, 0.01], [0.01, 0.01, 0.01, 1e-4], [0.01, 0.01, 0.05]])
def test_uneven_intervals_are_how_it_is_sampled(steps: list[float]) -> None:
    time = np.cumsum(np.tile(steps, CYCLE_TIME.size))[: CYCLE_TIME.size]
    assert not after_pauses(Read(time=time)).any()


def test_the_force_relaxes_in_a_hold() -> None:
    ramp = np.minimum(0.01 * CYCLE_TIME, 0.02)
    force = 8e4 * ramp * (1.0 - 0.2 * (1.0 - np.exp(-np.maximum(CYCLE_TIME - 2.0, 0.0))))
    assert not beyond_travel(noisy(ramp), force).any()


def test_a_frame_rings_in_a_hold() -> None:
    ramp = np.minimum(0.01 * CYCLE_TIME, 0.02)
    since = np.maximum(CYCLE_TIME - 2.0, 0.0)
    force = 8e4 * ramp + 120.0 * np.sin(2.0 * np.pi * 3.0 * since) * np.exp(-2.0 * since)
    assert not beyond_travel(noisy(ramp), force).any()


@dataclass(frozen=True)
class Read:
    name: str = "clipped"
    time: FloatArray = field(default_factory=lambda: CYCLE_TIME)
    deflection: FloatArray = field(default_factory=lambda: noisy(np.minimum(MOTION, 0.021)))
    force: FloatArray = field(default_factory=lambda: STIFFENING_FORCE)
    surface_radius: FloatArray = field(default_factory=lambda: np.full(CYCLE_TIME.size, np.inf))


def test_it_is_said_with_recording_and_place() -> None:
    (said,) = not_compared([Read(), Read("whole", deflection=noisy(MOTION))])
    assert said.startswith("In clipped the deflection's reading stands still at 21 mm in ")
    assert "whole" not in said


def with_lone(**lone: float) -> FloatArray:
    """A misfit that grows by 20 N beside 1 N of noise, with so many newtons more at some samples."""
    misfit = np.linspace(0.0, 20.0, 1000) + np.random.default_rng(8).normal(size=1000)
    for place, more in lone.items():
        misfit[int(place.removeprefix("at_"))] += more
    return misfit


@pytest.mark.parametrize("place", [0, 1, 500, 998, 999])
def test_one_sample_far_off_is_an_outlier_also_at_an_end(place: int) -> None:
    assert np.flatnonzero(spikes(with_lone(**{f"at_{place}": -40.0}))).tolist() == [place]


def test_outliers_are_told_with_the_time_of_the_first() -> None:
    residual = np.random.default_rng(2).normal(0.0, 1.0, TIME.size)
    residual[[400, 1200]] += 25.0
    read = recording(force=FORCE + residual)
    (said,) = outliers_told([read, recording()], [residual, np.zeros(TIME.size)])
    assert said.startswith("In ")
    assert f" 2 single samples stand out from both neighbours, the first at {TIME[400]:.4g} s: " in said
    (said,) = outliers_told([replace(read, timed=False)], [np.where(TIME[400] == TIME, 0.0, residual)])
    assert " 1 single sample stands out from both neighbours, at sample 1201: " in said


def test_what_stands_out_of_the_simulated_force_alone_is_told_as_no_outlier() -> None:
    """A smooth reading beside a simulated force that jumps at two samples, as a mass whose acceleration does."""
    residual = np.random.default_rng(2).normal(0.0, 1.0, TIME.size)
    residual[[400, 1200]] += 25.0
    assert np.flatnonzero(spikes(residual)).tolist() == [400, 1200]
    assert outliers_told([recording()], [residual]) == ()


def test_what_a_mass_does_in_a_reversal_within_a_sample_is_told_as_no_outlier() -> None:
    """Triangles of 4 s: at each corner the acceleration is one sample's, 25 N of a mass."""
    corners = np.arange(200, TIME.size, 200)
    triangles = 5e-3 * np.abs((TIME / 2.0 + 1.0) % 2.0 - 1.0) * 2.0
    residual = np.random.default_rng(2).normal(0.0, 1.0, TIME.size)
    residual[corners] += 25.0
    assert np.flatnonzero(spikes(residual)).tolist() == corners.tolist()
    assert outliers_told([recording(deflection=triangles)], [residual]) == ()


def test_a_force_that_stands_out_where_the_motion_turns_is_told_as_no_outlier() -> None:
    """A press that turns within three samples, and one that begins to move: a slack part snaps there, and a model does
    not. In the middle of a stroke the same is a false reading.
    """
    ramp = 5e-3 * np.clip(np.abs((TIME / 2.0 + 0.5) % 2.0 - 1.0) * 2.0, 0.02, 1.98)
    shown = ramp + 1e-7 * np.random.default_rng(3).standard_normal(TIME.size)
    ends, middle = np.flatnonzero(np.diff(ramp == ramp.min()))[:4] + 1, np.array([450, 1050])
    for lone, told in ((ends, False), (middle, True)):
        residual = np.random.default_rng(2).normal(0.0, 1.0, TIME.size)
        residual[lone] += 25.0
        assert np.flatnonzero(spikes(residual)).tolist() == lone.tolist()
        read = recording(deflection=shown, force=1e5 * ramp + residual)
        assert bool(outliers_told([read], [residual])) == told


def test_an_outlier_is_what_the_noise_of_all_samples_does_not_show() -> None:
    """By chance at most one sample in a hundred recordings is taken for one; with 3, that has a probability of 2 %.

    The mean of both differences of 8 N has a deviation of 1.2 N, and the limit is 5.4 N.
    """
    noises = np.random.default_rng(5).normal(size=(100, 1000))
    assert sum(int(spikes(noise).sum()) for noise in noises) <= 3
    noises[:, [0, 500]] += 8.0
    found = np.array([spikes(noise)[[0, 500]] for noise in noises])
    assert found[:, 1].mean() > 0.85
    assert found[:, 0].mean() > 0.85


def test_noise_and_a_steep_misfit_have_no_outliers() -> None:
    assert not spikes(with_lone()).any()
    steep = 40.0 * np.arange(1000.0) + with_lone()
    assert not spikes(steep).any()


def test_a_peak_of_several_samples_is_no_outlier_and_two_near_ones_are() -> None:
    sample = np.arange(1000)
    for width in (1.5, 3.0, 10.0):
        # The grip slips: a dip of 100 times the noise with samples on both its sides.
        assert not spikes(with_lone() - 100.0 * np.exp(-0.5 * ((sample - 500) / width) ** 2)).any()
    assert spikes(with_lone(at_500=40.0, at_502=40.0))[[500, 502]].all()


def test_what_stands_out_often_is_noise_of_its_own() -> None:
    often = with_lone(**{f"at_{place}": 40.0 for place in range(5, 1000, 10)})
    assert not spikes(often).any()


def coarse(name: str, seed: int) -> Recording:
    """A press to 10 mm read in steps of 0.1 mm and 1 N, so that most pairs of readings come again in any other."""
    time = np.linspace(0.0, 20.0, 2000)
    x = np.round(0.005 * (1.0 - np.cos(time)), 4)
    force = np.round(2000.0 * x + np.random.default_rng(seed).normal(size=2000))
    return Recording(name, time, x, np.full(2000, np.inf), force)


def test_copies_and_exports_of_one_test_are_told() -> None:
    first, second = coarse("first", 1), coarse("second", 2)
    columns = ("time", "deflection", "surface_radius", "force")
    inches = replace(first, name="export", deflection=first.deflection / 0.0254 * 0.0254)
    later = replace(first, name="cut", **{c: getattr(first, c)[300:] for c in columns})
    assert not copies_told([first, second], [coarse("third", 3)])
    (fitted,) = copies_told([first, inches], [second])
    assert fitted.endswith("they count twice.")
    assert "Most readings of export are those of first" in fitted
    (kept,) = copies_told([first, second], [later])
    assert "Most readings of cut are those of first" in kept
    assert kept.endswith("it tests nothing that is fitted to first; hold out another recording.")
