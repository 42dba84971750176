"""What a trial is: recordings, the baseline tire, and the answer."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .bench import Bench
from .measurement import Instrument
from .motion import FINEST_STEP, FloatArray, Motion, even_grid, rounded
from .reading import estimated
from .sizing import Size
from .tires import INFLATION, PowerTire

Parameters = Mapping[str, object]

#: The name of the effect that acts by the gauge pressure, which is recorded where it is hidden.
PRESSURE = "inflation_pressure"
#: Noise of the pressure's reading over the reading [1], and its step [Pa].
PRESSURE_NOISE, PRESSURE_STEP = 2e-3, 100.0


@dataclass(frozen=True)
class Record:
    """One recording as the rig wrote it down.

    time [s], deflection [m], radius [m] (convex > 0, concave < 0, flat = inf), force [N]; of one shape; so is the gauge
    pressure [Pa] where it was measured.
    """

    name: str
    excitation: str
    time: FloatArray
    deflection: FloatArray
    radius: FloatArray
    force: FloatArray
    pressure: FloatArray | None = None


@dataclass(frozen=True)
class FileTruth:
    """What is known of one recording: samples, excitation, RMSE [N] of the baseline tire, noise floors [N].

    floor_rmse: RMSE of the true tire where rate and acceleration are known exactly: the error of the force reading,
    and the error of the deflection reading times the tire's stiffness. read_floor_rmse: RMSE of the true tire on the
    readings as they are, where rate and acceleration are estimated from them (see `reading.estimated`).
    """

    samples: int
    excitation: str
    baseline_rmse: float
    floor_rmse: float
    read_floor_rmse: float


@dataclass(frozen=True)
class Answer:
    """What is hidden in a trial.

    effects: parameters of every named effect (`recalibration` included); hidden: those of an effect that no
    catalogue names; right: the sets of names that count as right, the true one first; margins: loss of
    log-likelihood of each other right set; sizes over the noise; where: regions of localized effects; noise [N];
    files: truth by file name; rule: why sets beside the exact one count as right, or ""; tire and instrument: their
    constants. The names of the fields are the keys of the answer's file.
    """

    kind: str
    effects: Mapping[str, Parameters]
    hidden: Mapping[str, Parameters]
    right: tuple[tuple[str, ...], ...]
    margins: Mapping[str, float]
    rule: str
    sizes: Mapping[str, Size]
    where: tuple[Parameters, ...]
    noise: float
    files: Mapping[str, FileTruth]
    tire: Parameters
    instrument: Parameters


@dataclass(frozen=True)
class Trial:
    """Recordings to diagnose, recordings to show the improvement on, and the answer.

    heldout: tests of other kinds than the training ones, then one test of a training kind.
    baseline: the tire that the user starts from; baseline_source: "hull1996" where it is the article's tire, "table"
    where A and B were identified surface by surface. bench and instrument can make further recordings; motions: those
    of the training recordings.
    """

    seed: int
    train: tuple[Record, ...]
    heldout: tuple[Record, ...]
    answer: Answer
    baseline: PowerTire
    baseline_source: str
    noise: float
    bench: Bench
    instrument: Instrument
    motions: tuple[Motion, ...] = ()


def recorded(
    bench: Bench, instrument: Instrument, motion: Motion, name: str, rng: np.random.Generator
) -> tuple[Record, tuple[float, float]]:
    """A recording of a motion, and its two noise floors [N] (see `FileTruth`)."""
    clean = bench.force(motion)
    time, true = motion.recorded(motion.time), motion.recorded(motion.deflection)
    radius = motion.recorded(motion.radius)
    shown = bench.shown(true)
    readings = instrument.read(rng, shown)
    force = instrument.converted(
        motion.recorded(clean) + instrument.force_error(rng, time.size, motion.sample_step)
    )
    ones = np.ones_like(true)
    by_stiffness = bench.tire.force(readings, radius, ones) - bench.tire.force(shown, radius, ones)
    # what a gauge shows wrongly is no noise: rate and acceleration are estimated without that error
    near = readings if shown is true else true + (readings - shown)
    by_rate = motion.recorded(bench.force(estimated(motion, near)) - clean)
    error = force - motion.recorded(clean) - by_stiffness
    floor, read_floor = (float(np.sqrt(np.mean(e**2))) for e in (error, error - by_rate))
    pressure = _pressure(bench, motion, rng)
    return Record(name, motion.name, time, readings, radius, force, pressure), (floor, read_floor)


def _pressure(bench: Bench, motion: Motion, rng: np.random.Generator) -> FloatArray | None:
    """Gauge pressure [Pa] as it is read, None where nothing that acts through it by its reading is on the bench."""
    level = next((e.gauge_pressure() for e in bench.effects if e.name == PRESSURE), None)
    if level is None:
        return None
    contact = bench.contact(motion)
    ratio = np.full_like(motion.time, level)
    for effect in bench.effects:
        ratio = (
            ratio
            * effect.pressure_ratio(motion)
            * effect.gas_ratio(np.maximum(contact.deflection, 0.0), motion.radius)
        )
    true = INFLATION * motion.recorded(ratio)
    noisy = true * (1.0 + PRESSURE_NOISE * rng.standard_normal(true.size))
    return np.asarray(PRESSURE_STEP * np.round(noisy / PRESSURE_STEP), dtype=np.float64)


def rerun(
    trial: Trial,
    time: FloatArray,
    deflection: FloatArray,
    radius: FloatArray,
    *,
    seed: int,
    name: str = "test",
) -> Record:
    """Run another test on the rig of a trial, for instance one that discriminates between alternatives.

    time [s] on an even grid, deflection [m], radius [m] (convex > 0, concave < 0, flat = inf); one shape
    (n,), n >= 8. Between the samples the deflection is linear; corners are rounded over one step.
    Errors: ValueError for a grid that is not even, or too few samples.
    """
    if time.size < 8:
        raise ValueError(f"a test needs at least 8 samples, this one has {time.size}")
    steps = np.diff(time)
    step = float(np.median(steps))
    if step <= 0.0 or float(np.max(np.abs(steps - step))) > 1e-3 * step:
        worst = int(np.argmax(np.abs(steps - step)))
        raise ValueError(
            f"the rig drives an even time grid, but sample {worst + 1} comes {steps[worst]:g} s after "
            f"the one before and the others {step:g} s: resample the test"
        )
    stride = max(1, int(np.ceil(step / FINEST_STEP - 1e-9)))
    fine = time[0] + even_grid((time.size - 1) * stride + 1, step / stride)
    mounted = radius[np.minimum((np.arange(fine.size) + stride - 1) // stride, time.size - 1)]
    path = rounded(np.interp(fine, time, deflection), step / stride, step)
    motion = Motion("test", fine, path, mounted, stride)
    rng = np.random.default_rng(np.random.SeedSequence([trial.seed, seed]))
    return recorded(trial.bench, trial.instrument, motion, name, rng)[0]
