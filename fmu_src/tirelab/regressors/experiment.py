"""One recording in blocks of neighbouring samples, as many in a block as the motion allows.

The misfit of the baseline tire is averaged, since it is smoother than the force; the motion is taken in the middle of
each block. A block with a reversal within a sample counts only where the misfit is the same before and after the
reversal.

A long rest tells little more with every second sample: what decays in it does so over the logarithm of time. Where the
blocks would be too long for the motion before it, the blocks of a rest are kept at times in geometric progression, and
all blocks become shorter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from radialtire import TireModel
from radialtire.model import READING_NOISE

from ..preprocessing.data_checks import are_rare, compared, spikes
from ..preprocessing.driven import Driven
from ..preprocessing.gauge import destepped, gauge_step, read_again, staircase_step
from ..preprocessing.levels import NoiseProfile, Scalar
from ..preprocessing.motion import Motion, followed_turns, motion_of, runs, through_turns
from ..preprocessing.noise import Noise, noise_of, resting
from ..preprocessing.noise_floor import SHARE_OF_STEP, NoiseFloor, noise_floor
from ..preprocessing.samples import Recorded, is_timed, surface_numbers
from ..simulation.simulate import SmoothedMotion, simulate, smoothed_motion

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IndexArray = NDArray[np.intp]

FEWEST_BLOCKS = 600
"""Fewest blocks of a recording that has as many samples."""

TURN = 0.5
"""Largest phase [rad] of the motion within a block; its angular frequency is taken as acceleration over rate."""

SECANTS = 40
"""Number of parts of the deflection's span over which the stiffness is computed."""

RESOLVED = 50
"""Least number of blocks in the deflection's span at the largest rate, if it takes thinning the rests: ten between two
heights of a refitted law."""

PROGRESSION = 0.02
"""Time between two kept blocks of a rest, over the time since it began: 35 blocks while that doubles."""

COUNTED = 0.5
"""Least part of the blocks with a resolved motion, a majority; with fewer, all blocks count."""


@dataclass(frozen=True)
class Blocks:
    """Blocks of `size` neighbouring samples, those numbered `kept` (n,) of them; the samples that fill no whole block
    are left out.
    """

    size: int
    kept: IndexArray

    def of(self, values: NDArray[Scalar]) -> NDArray[Scalar]:
        """Return the values of the samples as those of the blocks (n, size)."""
        return values[: values.size // self.size * self.size].reshape(-1, self.size)[self.kept]

    def mean(self, values: FloatArray) -> FloatArray:
        """Return the mean of the values over each block."""
        return np.asarray(self.of(values).mean(axis=1))

    def middle(self, values: FloatArray) -> FloatArray:
        """Return the values in the middle of each block.

        The middle of an even block lies between two samples; taking one of them would be a lag of half a sample.
        """
        blocks = self.of(values)
        return np.asarray(0.5 * (blocks[:, (self.size - 1) // 2] + blocks[:, self.size // 2]))


@dataclass(frozen=True)
class Experiment:
    """One recording in blocks; arrays (n,).

    time [s], deflection [m], rate [m/s], acceleration [m/s^2], surface_radius [m]: in the middle of each block
    baseline [N]: force of the baseline tire there; misfit [N]: recorded force minus that of the baseline, averaged over
    the block; counts: whether a block is compared; noise [N]: standard deviation of the noise of the averaged misfit,
    of all blocks together; profile: that of each over it
    least_noise [N]: noise that the steps of the force reading cause at least; resting [N]: the part of it that
    neighbouring blocks have in common, where the force rests on a step for longer than a block
    floor: noise floor of the samples; gauge [m]: noise of the deflection reading; blocks: of the samples
    interval [s]: between blocks; reading: noise of the samples [N]
    measured: the recorded channels by their names, averaged over the blocks
    left_out [N] (n,): distortion by averaging over blocks that was subtracted from the misfit, see `Samples.left_out`
    """

    name: str
    time: FloatArray
    deflection: FloatArray
    rate: FloatArray
    acceleration: FloatArray
    surface_radius: FloatArray
    baseline: FloatArray
    misfit: FloatArray
    counts: BoolArray
    noise: float
    least_noise: float
    resting: float
    floor: NoiseFloor
    gauge: float
    blocks: Blocks
    interval: float
    reading: Noise
    measured: Mapping[str, FloatArray] = field(default_factory=dict)
    left_out: FloatArray | float = 0.0
    profile: NoiseProfile = NoiseProfile()  # noqa: RUF009

    @property
    def size(self) -> int:
        """Number of samples in a block."""
        return self.blocks.size

    @cached_property
    def noises(self) -> FloatArray:
        """Standard deviation of the noise of each block (n,) [N]."""
        return self.noise * self.profile.of(resting(self.rate), self.baseline)

    def noises_over(self, interval: float, size: int = 1) -> tuple[Noise, Noise]:
        """Return the noise of its readings as that of another recording may be in blocks of so many samples, an
        interval [s] apart: a filter of an amplifier has its time, or follows the sampling.
        """
        own = self.reading if self.reading.memory > 1 else self.reading.of_mains
        return in_blocks(own, interval * self.size / self.interval), in_blocks(own, size)

    def with_noise(self, noise: Noise) -> Experiment:
        """Return the experiment with another noise [N] of its averaged misfit."""
        reading = self.reading
        if noise.memory > 1:
            # Averaging removed a part of the noise of the samples; the readings still have it.
            removed = max(reading.level**2 - self.noise**2, 0.0)
            level = float(np.sqrt(noise.level**2 + removed))
            reading = Noise(level, noise.memory * self.size, reading.hum)
        return replace(self, noise=max(noise.level, self.least_noise), reading=reading)


def experiment_in_blocks(
    recording: Recorded,
    tire: TireModel,
    sizes: tuple[int, int],
    reading: Noise | None,
    series: Sequence[Experiment] = (),
) -> Experiment:
    """Return a recording in blocks.

    sizes: least and most samples of a block; reading: noise of a sample, if known; series: other recordings
    """
    interval = float(np.median(np.diff(recording.time)))
    motion, step = read_motion(recording)
    gauge = step * SHARE_OF_STEP if step > 0.0 else motion.noise
    moved = smoothed_motion(recording, motion)
    baseline = simulate(replace(tire, reading_noise=min(gauge, READING_NOISE.maximum)), moved, moved)
    misfit = recording.force - baseline
    lone = spikes(misfit)
    known = [n for e in series for n in e.noises_over(interval)] if reading is None else [reading]
    if reading is None:
        quiet = np.interp(recording.time, recording.time[~lone], misfit[~lone])  # false readings are no noise
        reading = _noise_along(moved, quiet, interval, known)
    turns = followed_turns(misfit, motion.resolved, reading.level)
    turns &= ~(lone & are_rare(np.array([lone[begin:end].any() for begin, end in runs(turns)], dtype=bool)))
    resolved = motion.resolved & ~lone
    blocks = _blocks(recording.time, motion, resolved, sizes, reading)
    averaged = _averaged(moved, turns, blocks)
    averaged_misfit = blocks.mean(misfit)
    # Changes as quick as the blocks are told from noise later, by the residual of the saturated model.
    known = [in_blocks(noise, blocks.size) for noise in known if noise.memory > blocks.size]
    known.append(reading.of_mains)
    of_blocks = _noise_along(averaged, averaged_misfit, interval * blocks.size, known)
    noise = reading.level * np.sqrt(min(reading.memory / blocks.size, 1.0))
    # Blocks within one memory are not independent, so that a white noise of theirs is a part of it only.
    if reading.memory <= blocks.size or of_blocks.memory > 1:
        noise = min(noise, of_blocks.level)
    force_step = staircase_step(recording.force) or gauge_step(recording.force)
    least_noise, resting = _rounding(recording.force, force_step, blocks.size)
    # The recorded one: where the believed law is stiffer, it would make noise of what the part does.
    stiffness = _stiffness(motion.deflection, recording.force)
    return Experiment(
        name=recording.name,
        time=averaged.time,
        deflection=averaged.deflection,
        rate=averaged.rate,
        acceleration=averaged.acceleration,
        surface_radius=averaged.surface_radius,
        baseline=simulate(tire, averaged, averaged),
        misfit=averaged_misfit,
        counts=_counted(recording, resolved | turns, blocks),
        noise=max(noise, least_noise, 1e-6 * float(np.ptp(recording.force)), 1e-300),
        least_noise=least_noise,
        resting=resting,
        floor=noise_floor(reading.level, stiffness, gauge, step, force_step),
        gauge=gauge,
        blocks=blocks,
        interval=interval * blocks.size,
        reading=reading,
        measured=averaged.measured,
    )


def read_anew(recording: Recorded, experiment: Experiment, tire: TireModel) -> Experiment:
    """Return an experiment as other readings of the same motion, with the noise and the steps of the same gauge, would
    show it, but for the reversals within a sample; tire: the baseline
    """
    random = np.random.default_rng(1)  # the same each time, so that a recording has one verdict
    (motion, step), read = read_motion(recording), recording.deflection
    noise, rounded = (0.0, step) if step > 0.0 else (motion.noise, gauge_step(read))
    other = read_again(motion.deflection, read, noise, rounded, random)
    anew = _without_steps(recording, other, step, keep=False)
    blocks = experiment.blocks
    averaged = _averaged(smoothed_motion(recording, anew), np.zeros(other.size, dtype=bool), blocks)
    known = blocks.of(motion.resolved & anew.resolved).all(axis=1)
    changed = replace(
        experiment,
        deflection=np.where(known, averaged.deflection, experiment.deflection),
        rate=np.where(known, averaged.rate, experiment.rate),
        acceleration=np.where(known, averaged.acceleration, experiment.acceleration),
    )
    return replace(changed, baseline=simulate(tire, changed, changed))


def _noise_along(moved: SmoothedMotion, misfit: FloatArray, interval: float, known: Sequence[Noise]) -> Noise:
    """Return the noise of a misfit [N] (n,) along a motion.

    interval [s]: between its samples; known: noises that it may have
    """
    return noise_of(misfit, driven_by(moved, interval), known=known)


def driven_by(moved: SmoothedMotion, interval: float) -> Driven:
    """Return a motion as what a misfit may follow; interval [s]: between its samples."""
    (surface,) = surface_numbers([moved.surface_radius])
    return Driven(interval, moved.deflection, moved.rate, moved.acceleration, surface)


def in_blocks(noise: Noise, size: float) -> Noise:
    """Return a noise of samples as one of blocks of so many samples."""
    return replace(noise, memory=max(round(noise.memory / size), 1))


def _averaged(moved: SmoothedMotion, turns: BoolArray, blocks: Blocks) -> SmoothedMotion:
    """Return the motion in the middle of each block, and the means of its channels; turns: see `through_turns`."""
    rate, acceleration = through_turns(moved.time, moved.rate, moved.acceleration, turns)
    return SmoothedMotion(
        blocks.middle(moved.time),
        blocks.middle(moved.deflection),
        blocks.of(moved.surface_radius)[:, blocks.size // 2],
        blocks.middle(rate),
        blocks.middle(acceleration),
        {name: blocks.mean(values) for name, values in moved.measured.items()},
    )


def _counted(recording: Recorded, known: BoolArray, blocks: Blocks) -> BoolArray:
    """Return which blocks count: those of samples whose motion is `known`, and that the gauge followed."""
    counts: BoolArray = np.asarray(blocks.of(known).all(axis=1))
    if counts.mean() < COUNTED:
        counts = np.ones_like(counts)
    (followed,) = compared([recording])
    return np.asarray(counts & blocks.of(followed).all(axis=1))


def read_motion(recording: Recorded) -> tuple[Motion, float]:
    """Return the motion without the steps of its gauge, and the step [m], 0 where there is none."""
    step = staircase_step(recording.deflection)
    return _without_steps(recording, recording.deflection, step), step


def _without_steps(recording: Recorded, read: FloatArray, step: float, *, keep: bool = True) -> Motion:
    """Return the motion of readings [m] in steps [m] at the times of a recording; keep: see `motion_of`."""
    level = destepped(recording.time, read, step) if step > 0.0 else read
    return motion_of(recording.time, level, step, timed=is_timed([recording]), keep=keep)


def _blocks(
    time: FloatArray, motion: Motion, resolved: BoolArray, sizes: tuple[int, int], noise: Noise
) -> Blocks:
    """Return blocks as long as the motion allows; sizes: least and most samples; noise: of a sample."""
    interval = float(np.median(np.diff(time)))
    quick = float(np.sqrt(np.mean(motion.acceleration[resolved] ** 2)))
    slow = float(np.sqrt(np.mean(motion.rate[resolved] ** 2)))
    longest = TURN * slow / max(quick * interval, 1e-300)
    least, most = sizes
    # Blocks within the memory of their noise would not be independent of each other.
    most = max(min(most, resolved.size // FEWEST_BLOCKS), noise.memory)
    size = int(max(1, least, min(most, longest)))
    rest = _rest(time, motion.rate)
    fastest = float(np.abs(motion.rate).max())
    wanted = float(np.ptp(motion.deflection)) / max(RESOLVED * fastest * interval, 1e-300)
    if wanted < size and rest.any():
        for shorter in range(int(max(1, noise.memory, wanted)), size):
            thinned = Blocks(shorter, _in_progression(rest[: rest.size // shorter * shorter : shorter]))
            if thinned.kept.size <= resolved.size // size:
                return thinned
    return Blocks(size, np.arange(resolved.size // size))


def _rest(time: FloatArray, rate: FloatArray) -> FloatArray:
    """Return for how long the tire has rested at each sample [s], 0 where it moves."""
    moved = np.where(resting(rate), -np.inf, time)
    moved[0] = time[0]
    return np.asarray(time - np.maximum.accumulate(moved))


def _in_progression(rest: FloatArray) -> IndexArray:
    """Return the numbers of the blocks that are kept, from how long the tire has rested at each [s]."""
    step = np.floor(np.log(np.maximum(rest, 1e-300)) / np.log1p(PROGRESSION))
    return np.flatnonzero((rest <= 0.0) | (np.diff(step, prepend=-np.inf) != 0.0))


def _rounding(force: FloatArray, step: float, size: int) -> tuple[float, float]:
    """Return the rounding error [N] of the average over a block of `size` samples of a force read in steps [N], and the
    part of it that neighbouring blocks have in common.

    A slow force rests on a step for many samples: averaging does not reduce their rounding error.
    """
    moving = float(np.mean(np.abs(np.diff(force)) > 0.5 * step))
    error = step * SHARE_OF_STEP
    shared = float(np.sqrt(max(1.0 - size * moving, 0.0)))
    return error / float(np.sqrt(max(size * moving, 1.0))), error * shared


def _stiffness(deflection: FloatArray, force: FloatArray) -> FloatArray:
    """Return the tangent [N/m] of a force over the deflection, from its means on an even grid."""
    low, span = float(deflection.min()), float(np.ptp(deflection))
    if not span > 0.0:
        return np.zeros_like(deflection)  # a hold that a gauge reads in steps
    which = np.minimum(((deflection - low) / span * SECANTS).astype(int), SECANTS - 1)
    count = np.bincount(which, minlength=SECANTS)
    held = count > 0
    x, f = (np.bincount(which, v, SECANTS)[held] / count[held] for v in (deflection, force))
    grid = low + span * (np.arange(SECANTS) + 0.5) / SECANTS
    return np.asarray(np.interp(deflection, grid, np.gradient(np.interp(grid, x, f), grid)))
