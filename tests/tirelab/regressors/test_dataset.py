"""Recordings in blocks: which of them are compared with a model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from scipy.signal import butter, lfilter
from tirelab.preprocessing.noise import Noise
from tirelab.recordings.recording import Recording
from tirelab.regressors.dataset import arranged, dataset_of, samples_of
from tirelab.simulation.simulate import simulate

FORCE_NOISE = 5.0


def triangle(samples: int, turns: int) -> Recording:
    """Return so many turns within 20 mm on the flat: the force of the article's tire with its noise."""
    phase = np.arange(samples) * turns / samples
    x = 0.02 * (1.0 - np.abs(phase % 2.0 - 1.0))
    noise = FORCE_NOISE * np.random.default_rng(3).normal(size=samples)
    silent = Recording("triangle", 0.01 * np.arange(samples), x, np.full(samples, np.inf), noise)
    return replace(silent, force=simulate(TireModel(), silent) + noise)


def test_a_block_that_holds_a_turn_is_compared_where_the_misfit_is_the_same_on_both_sides() -> None:
    """A flat top lies in the turns; a loop that opens there, by a force of the direction, is not followed."""
    samples, turns = 16_000, 8
    same = triangle(samples, turns)
    opened = replace(same, force=same.force + 20.0 * FORCE_NOISE * np.sign(np.gradient(same.deflection)))
    at = np.arange(1, turns) * samples // turns
    counted = []
    for recording in (same, opened):
        (experiment,) = dataset_of([recording], TireModel()).experiments
        assert experiment.size > 1
        counted.append(experiment.counts[at // experiment.size])
        assert experiment.counts.mean() > 0.95
    assert counted[0].all()
    assert not counted[1].any()


def ramp_and_hold(loaded: float) -> Recording:
    """Return a ramp of 4 s to 20 mm and a hold of 1000 s, every 0.05 s; a force that relaxes by a third in all.

    A Maxwell element of 100 N decays with a time constant of 0.4 s, faster than 1 / 4000 of the recording, and one of
    200 N with 100 s; loaded [s]: when the ramp ends
    """
    time = np.arange(0.0, 1004.0, 0.05)
    way = np.minimum(time / loaded, 1.0)
    force = 600.0 * way
    for size, tau in ((100.0, 0.4), (200.0, 100.0)):
        rise = size * tau / loaded * -np.expm1(-np.minimum(time, loaded) / tau)
        force = force + rise * np.exp(-np.maximum(time - loaded, 0.0) / tau)
    noise = np.random.default_rng(4).normal(size=time.size)
    return Recording("hold", time, 0.02 * way, np.full(time.size, np.inf), force + noise)


def test_a_long_hold_does_not_make_the_blocks_of_the_ramp_long() -> None:
    recording = ramp_and_hold(4.0)
    (e,) = dataset_of([recording], TireModel()).experiments
    ramp = e.time < 4.0
    # Without the hold, each of the 80 samples would be a block; fifty are wanted in the span.
    assert ramp.sum() >= 50
    rest = e.time[e.time > 4.1] - 4.0
    assert np.all(np.diff(rest) < 0.06 + 0.05 * rest[:-1])
    assert e.time.size < 4000
    # What is kept is the mean of its own samples.
    first = np.searchsorted(recording.time, e.time - 0.5 * e.interval)
    beside = np.array([recording.force[i : i + e.size].mean() for i in first[10:-1]])
    np.testing.assert_allclose((e.misfit + e.baseline)[10:-1], beside, atol=5.0)


def test_cycles_with_holds_stay_in_even_blocks() -> None:
    """Where a triangle's blocks are short enough, every sample counts, those of its holds as well."""
    whole = triangle(16_000, 8)
    time = 0.01 * np.arange(20_000)
    held = Recording(
        "held",
        time,
        np.append(whole.deflection, np.full(4000, whole.deflection[-1])),
        np.full(20_000, np.inf),
        np.append(whole.force, np.full(4000, whole.force[-1])),
    )
    (e,) = dataset_of([held], TireModel()).experiments
    np.testing.assert_allclose(np.diff(e.time), e.interval)
    assert e.time.size == 20_000 // e.size


def test_a_noise_that_blocks_remember_is_no_smaller_than_that_of_the_samples() -> None:
    """Averaging takes the quick part of a noise out, not out of the readings: it belongs to their floor."""
    dataset = dataset_of([triangle(16_000, 8)], TireModel())
    (before,) = dataset.experiments
    slow = 0.8 * FORCE_NOISE
    (after,) = dataset.with_noise([Noise(slow, 3)]).experiments
    assert after.reading.memory == 3 * before.size
    # White noise of 5 N and slow noise: the mean of n samples holds a variance of 25 / n of the former.
    slow_part = slow**2 - FORCE_NOISE**2 / before.size
    assert after.reading.level == pytest.approx(np.sqrt(slow_part + FORCE_NOISE**2), rel=0.02)


def test_what_blocks_took_out_of_a_filtered_noise_belongs_to_the_samples() -> None:
    """A block as long as the noise's memory still halves its variance or so: the samples have what they had."""
    white = triangle(16_000, 2)
    filtered = lfilter(*butter(2, 0.13), np.random.default_rng(5).normal(size=16_100))[100:]
    noise = FORCE_NOISE * filtered / np.std(filtered)
    silent = replace(white, force=simulate(TireModel(), replace(white, force=np.zeros(16_000))) + noise)
    dataset = dataset_of([silent], TireModel())
    (before,) = dataset.experiments
    assert before.size == before.reading.memory == 8
    assert before.noise < 0.85 * FORCE_NOISE
    (after,) = dataset.with_noise([Noise(before.noise, 2)]).experiments
    # A level from third differences over few lags is known to a twentieth.
    assert after.reading.level == pytest.approx(FORCE_NOISE, rel=0.1)


@pytest.mark.parametrize("follows_sampling", [False, True])
def test_recordings_of_a_series_have_the_noise_of_one_amplifier(follows_sampling: bool) -> None:
    """A ride as quick as the filter of the amplifier does not show its noise; a slow press beside it does, sampled
    half as often by a filter of the same time, or a tenth as often by one of as many samples. Alone, the ride seems to
    have less.
    """
    drawn = np.random.default_rng(7)
    noise = lfilter(*butter(2, 0.13), drawn.normal(size=24_000))[1000:]
    noise *= FORCE_NOISE / np.std(noise)
    interval = 0.1 if follows_sampling else 0.02
    slow = replace(triangle(8000, 2), time=interval * np.arange(8000.0), force=np.zeros(8000))
    own = noise[:8000] if follows_sampling else noise[:16_000:2]
    slow = replace(slow, force=simulate(TireModel(), slow) + own)
    time = 0.01 * np.arange(2000.0)
    frequencies, phases = np.linspace(0.1, 4.0, 60), drawn.uniform(0.0, 2.0 * np.pi, 60)
    waves = np.cos(2.0 * np.pi * frequencies * time[:, None] + phases).sum(axis=1)
    ride = Recording("ride", time, 0.012 + 6e-4 * waves, np.full(2000, np.inf), np.zeros(2000))
    ride = replace(ride, force=simulate(TireModel(), ride) + noise[-2000:])
    (alone,) = dataset_of([ride], TireModel()).experiments
    one, other = dataset_of([slow, ride], TireModel()).experiments
    assert alone.reading.memory == 1
    assert alone.reading.level < 0.6 * FORCE_NOISE
    assert one.reading.memory > 1
    assert other.reading.memory in (4, 8, 16)
    assert other.reading.level == pytest.approx(FORCE_NOISE, rel=0.1)


def test_a_hold_that_the_gauge_reads_in_steps_has_no_stiffness() -> None:
    """The noise of its gauge makes no noise of the force; the amplifier's is all."""
    held = triangle(2000, 1)
    still = np.full(2000, 0.01)
    noise = FORCE_NOISE * np.random.default_rng(3).normal(size=2000)
    (experiment,) = dataset_of([replace(held, deflection=still, force=noise)], TireModel()).experiments
    assert experiment.floor.level == pytest.approx(FORCE_NOISE, rel=0.1)
    assert experiment.floor.gauge == experiment.floor.steps == 0.0


def test_recordings_of_a_series_have_the_hum_of_one_amplifier() -> None:
    """8 N RMS at 50.03 Hz: within 40 s it drifts against cycles of 20 s, within 8 s hardly against those of 2 s."""
    several = []
    for name, duration, period in (("slow", 40.0, 20.0), ("fast", 8.0, 2.0)):
        time = np.arange(0.0, duration, 0.005)
        x = 0.02 * (1.0 - np.abs(2.0 * (time / period % 1.0) - 1.0))
        silent = Recording(name, time, x, np.full(time.size, np.inf), np.zeros(time.size))
        hum = 8.0 * np.sqrt(2.0) * np.sin(2.0 * np.pi * 50.03 * time + 1.0)
        noise = 3.0 * np.random.default_rng(1).standard_normal(time.size)
        several.append(replace(silent, force=simulate(TireModel(), silent) + hum + noise))
    alone = [dataset_of([r], TireModel()).experiments[0].reading.hum for r in several]
    together = [e.reading.hum for e in dataset_of(several, TireModel()).experiments]
    assert alone == [pytest.approx(8.0, rel=0.05), 0.0]
    assert together == [pytest.approx(8.0, rel=0.05)] * 2


def test_false_readings_do_not_hide_a_filtered_noise() -> None:
    """Two readings of twenty times the noise in 600: they are most of its whole variation."""
    noise = lfilter(*butter(2, 0.13), np.random.default_rng(11).normal(size=700))[100:]
    noise *= FORCE_NOISE / np.std(noise)
    clean = replace(triangle(600, 2), force=np.zeros(600))
    clean = replace(clean, force=simulate(TireModel(), clean) + noise)
    force = clean.force.copy()
    force[[150, 450]] += 20.0 * FORCE_NOISE
    (one,), (other,) = (
        dataset_of([r], TireModel()).experiments for r in (clean, replace(clean, force=force))
    )
    assert one.reading.memory > 1
    assert other.reading.memory == one.reading.memory
    assert other.reading.level == pytest.approx(one.reading.level, rel=0.02)


def test_samples_beside_a_turn_are_compared_where_nothing_is_averaged() -> None:
    """What limits the force at its peak is seen there and nowhere else."""
    samples, turns = 2000, 8
    (experiment,) = dataset_of([triangle(samples, turns)], TireModel()).experiments
    assert experiment.size == 1
    side = samples // turns
    near = [*range(side - 10, side - 4), *range(side + 5, side + 11)]
    assert experiment.counts[near].all()


def test_a_rare_spike_is_left_out_and_a_noisy_part_is_not() -> None:
    """The noise's level is that of the quiet part; single samples of the noisy one stand out of it all the same."""
    quiet = triangle(2000, 2)
    noise = 0.01 * np.random.default_rng(4).normal(size=2000)
    silent = replace(quiet, force=simulate(TireModel(), replace(quiet, force=np.zeros(2000))) + noise)
    spiked = silent.force.copy()
    spiked[[300, 1500]] += 50.0
    noisy = silent.force + np.where(np.arange(2000) < 400, 100.0 * noise, 0.0)
    counts = [
        dataset_of([replace(silent, force=f)], TireModel()).experiments[0].counts for f in (spiked, noisy)
    ]
    assert not counts[0][[300, 1500]].any()
    assert counts[0].mean() > 0.98
    assert counts[1][:400].mean() > 0.98


def test_lone_peaks_at_the_turns_count_and_a_spike_at_one_does_not() -> None:
    """What comes at every upper turn, or at three of sixteen turns, comes from the motion; one peak comes by chance."""
    samples, turns = 2000, 16
    quiet = triangle(samples, turns)
    upper, one = np.arange(1, turns, 2) * (samples // turns), samples // turns
    counted = []
    for at in (upper, upper[::3], np.array([one])):
        force = quiet.force.copy()
        force[at] -= 40.0 * FORCE_NOISE
        counted.append(dataset_of([replace(quiet, force=force)], TireModel()).experiments[0].counts)
    assert counted[0][upper].mean() > 0.8
    assert counted[1][upper[::3]].mean() > 0.6
    assert not counted[2][one]


def test_a_force_that_rests_on_a_step_errs_alike_in_neighbouring_blocks() -> None:
    """In a hold almost all of the error of rounding, q / sqrt(12), is shared; of one that passes many steps none."""
    time = 0.01 * np.arange(8000)
    hold, ramp = np.minimum(2e-4 * np.arange(8000), 0.015), np.linspace(0.005, 0.02, 8000)
    shared = []
    for x, step in ((hold, 2.0), (ramp, 0.002)):
        silent = Recording("coarse", time, x, np.full(8000, np.inf), np.zeros(8000))
        noise = 0.1 * step * np.random.default_rng(9).normal(size=8000)
        force = step * np.round((simulate(TireModel(), silent) + noise) / step)
        dataset = dataset_of([replace(silent, force=force)], TireModel())
        (e,) = dataset.experiments
        shared.append(dataset.rounding_error * e.noise * np.sqrt(12.0) / step)
    assert shared[0] > 0.9
    assert shared[1] < 0.1


def test_a_force_that_hardly_rests_on_its_steps_errs_by_their_rounding() -> None:
    """A force that changes by a step and a half with each sample, and a line along which few readings repeat."""
    silent = replace(triangle(1000, 6), force=np.zeros(1000))
    force = simulate(TireModel(), silent)
    step = float(np.mean(np.abs(np.diff(force)))) / 1.5
    read = replace(silent, force=step * np.round(force / step))
    assert np.mean(np.diff(read.force) == 0.0) < 0.3
    (e,) = dataset_of([read], TireModel()).experiments
    assert e.noise >= step / np.sqrt(12.0) * (1.0 - 1e-6)
    assert e.floor.level == pytest.approx(step / np.sqrt(12.0), rel=0.1)


def test_a_delay_shorter_than_a_block_errs_in_blocks_and_hardly_in_samples() -> None:
    """A sine through a chord over one interval misses p^2 / 8 of its amplitude in its middle: half of that is rms."""
    time = 0.002 * np.arange(16_000)
    x = 0.015 + 0.005 * np.sin(2.0 * np.pi * 4.0 * time)
    silent = Recording("sine", time, x, np.full(16_000, np.inf), np.zeros(16_000))
    force = simulate(TireModel(), silent)
    read = replace(silent, force=force + 0.2 * np.random.default_rng(5).normal(size=16_000))
    lag = CATALOGUE["force_lag"]
    values = tuple({"lag": 0.0, "delay": 0.005}.get(p.name, p.start) for p in lag.parameters)
    coarse = dataset_of([read], TireModel())
    delayed = arranged(TireModel(), [(lag.name, values)])
    (e,) = coarse.experiments
    assert e.size > 2
    bound = (2.0 * np.pi * 4.0 * 0.002 * e.size) ** 2 / 8.0 * np.std(force) / e.noise
    samples = samples_of([read], TireModel())
    (missed,) = samples.left_out(coarse, delayed)
    assert 0.1 * bound < np.sqrt(np.mean(missed[e.counts] ** 2)) / e.noise < bound
    response = simulate(delayed, silent) - simulate(TireModel(), silent)
    averaged = response[: missed.size * e.size].reshape(-1, e.size).mean(axis=1)
    corrected = coarse.corrected([missed])
    left = (corrected.misfit - corrected.response(delayed)) * e.noise
    assert left == pytest.approx((e.misfit - averaged)[e.counts], abs=0.02 * e.noise)
    # Corrected again, the first correction is taken back.
    assert corrected.corrected([np.zeros(missed.size)]).misfit == pytest.approx(coarse.misfit, abs=1e-9)


def test_blocks_of_one_sample_leave_nothing_out() -> None:
    time = 0.002 * np.arange(1000)
    x = 0.015 + 0.005 * np.sin(2.0 * np.pi * 4.0 * time)
    silent = Recording("sine", time, x, np.full(1000, np.inf), np.zeros(1000))
    read = replace(silent, force=simulate(TireModel(), silent))
    dataset = dataset_of([read], TireModel())
    assert dataset.experiments[0].size == 1
    lag = CATALOGUE["force_lag"]
    values = tuple({"lag": 0.005}.get(p.name, p.start) for p in lag.parameters)
    lagging = arranged(TireModel(), [(lag.name, values)])
    assert not samples_of([read], TireModel()).left_out(dataset, lagging)[0].any()


def coarse_swing(step: float) -> tuple[Recording, np.ndarray, np.ndarray]:
    """Return a growing swing of 10 mm that a gauge reads in steps [m], every 2 ms, its rate and its acceleration."""
    time, depth, w = np.arange(0.0, 8.0, 2e-3), 0.01, np.pi
    size, growth = depth * (0.3 + 0.0875 * time), depth * 0.0875
    x = size * np.sin(w * time) + 0.37 * step
    rate = growth * np.sin(w * time) + w * size * np.cos(w * time)
    acceleration = 2.0 * w * growth * np.cos(w * time) - w**2 * size * np.sin(w * time)
    read = step * np.round(x / step)
    force = 1e4 * x + 0.1 * np.random.default_rng(2).normal(size=time.size)
    return Recording("swing", time, read, np.full(time.size, np.inf), force), rate, acceleration


def test_a_swing_that_is_read_in_steps_has_its_rate_and_its_acceleration() -> None:
    """Its readings stay on a level for two samples in the middle, and for dozens at its ends."""
    recording, rate, acceleration = coarse_swing(1e-4)
    (found,) = samples_of([recording], TireModel()).motions
    inside = slice(50, -50)
    assert np.std((found.rate - rate)[inside]) < 0.02 * np.std(rate)
    assert np.std((found.acceleration - acceleration)[inside]) < 0.2 * np.std(acceleration)


def test_a_written_tire_is_guarded_against_the_steps_of_its_gauge() -> None:
    """Their rounding is a noise of q / sqrt(12) (Widrow): the difference of two readings is a step or none."""
    step = 1e-4
    dataset = dataset_of([coarse_swing(step)[0]], TireModel())
    assert dataset.tire.reading_noise == pytest.approx(step / np.sqrt(12.0))
    (experiment,) = dataset.experiments
    assert experiment.floor.gauge == 0.0
    assert experiment.floor.steps > 0.0
