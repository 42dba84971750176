"""An engineer's first files of a slow press: a few triangles at one speed, a coarse gauge, a law fitted to them."""

import math

import numpy as np
from numpy.typing import NDArray

from .. import article
from ..excitation import DepthLimits, cycles_of, polyline, stairs
from ..measurement import CoarseInstrument, drawn_cut_off
from ..motion import Motion
from ..tires import PowerTire, Surface, best_power, distinct
from ..trial import Record

FloatArray = NDArray[np.float64]

#: Sampling rates of a press's data acquisition [Hz].
RATES = (5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
FEWEST_SAMPLES, MOST_SAMPLES = 150, 12_000
#: Speeds [m/s], gauge steps [m], force steps [N] and white noise [N] of a press.
SPEEDS, GAUGE_STEPS, FORCE_STEPS, NOISES = (0.3e-3, 20e-3), (1e-6, 50e-6), (0.1, 5.0), (0.5, 6.0)
#: Time in which a press turns round [s].
TURNING = 0.05
#: Share of the largest force above which the logarithmic fit looks.
FITTED_SHARE = 0.03


def drawn_limits(rng: np.random.Generator) -> DepthLimits:
    """One surface, mostly the flat; one time in four two or three."""
    count = int(rng.integers(2, 4)) if rng.random() < 0.25 else 1
    others = rng.choice(len(article.ARTICLE_SURFACES), count, replace=False)
    surfaces = tuple(article.ARTICLE_SURFACES[int(i)] for i in others)
    if count == 1 and rng.random() < 0.7:
        surfaces = (math.inf,)
    return DepthLimits(surfaces, tuple(float(rng.uniform(0.013, 0.024)) for _ in surfaces))


def drawn_motions(
    rng: np.random.Generator, limits: DepthLimits
) -> tuple[tuple[Motion, ...], tuple[Motion, ...]]:
    """One file of one to three triangles at one speed, and two held-out files: steps with holds, and triangles again.

    Each reversal takes `TURNING` at most.
    """
    cycles = int(rng.choice((1, 1, 2, 3)))
    speed = float(np.exp(rng.uniform(*np.log(SPEEDS))))
    duration = 2.0 * cycles * sum(limits.deepest) / speed
    rates = [r for r in RATES if FEWEST_SAMPLES <= r * duration <= MOST_SAMPLES]
    step = 1.0 / float(rng.choice(rates)) if rates else duration / 2000.0
    train = _triangles(limits, speed, cycles, step)
    held = _triangles(limits.scaled(rng.uniform(0.8, 0.95)), speed, 2, step)
    steps = stairs(rng, limits.scaled(0.9), "press_steps", speed, list(rng.uniform(1.0, 5.0, 6)))
    return (train,), (steps, held)


def _triangles(limits: DepthLimits, speed: float, cycles: int, step: float) -> Motion:
    knots = [cycles_of(deep, 2.0 * deep / speed, cycles) for deep in limits.deepest]
    blend = min(0.02 * limits.shallowest / speed, TURNING)
    return polyline("press_triangle", knots, limits.surfaces, step, blend)


def drawn_instrument(rng: np.random.Generator) -> CoarseInstrument:
    """Gauge and load cell with steps, most of them coarse."""
    steps = rng.random() < 0.7, rng.random() < 0.6
    return CoarseInstrument(
        white=float(np.exp(rng.uniform(*np.log(NOISES)))),
        quantum=float(np.exp(rng.uniform(*np.log(FORCE_STEPS)))) if steps[1] else 0.0,
        gauge=float(rng.uniform(0.0, 5e-6)),
        gauge_step=float(np.exp(rng.uniform(*np.log(GAUGE_STEPS)))) if steps[0] else 0.0,
        cut_off=drawn_cut_off(rng),
    )


def fitted_power_law(records: tuple[Record, ...], *, logarithmic: bool) -> PowerTire:
    """F = A x^B of every surface, fitted to recordings by least squares of F, or of ln F against ln x.

    B lies between 0.6 and 3 in the fit of F.
    """
    radius = np.concatenate([r.radius for r in records])
    x = np.concatenate([r.deflection for r in records])
    force = np.concatenate([r.force for r in records])
    surfaces = []
    for r in sorted(distinct(radius), key=lambda r: 1.0 / r):
        here = (radius == r) & (x > 1e-4) & (force > FITTED_SHARE * float(np.max(force[radius == r])))
        fit = _logarithmic if logarithmic else _linear
        surfaces.append(Surface(r, *fit(100.0 * x[here], force[here])))
    return PowerTire(tuple(surfaces))


def _logarithmic(x: FloatArray, force: FloatArray) -> tuple[float, float]:
    b, level = np.polyfit(np.log(x), np.log(force), 1)
    return float(np.exp(level)), float(b)


def _linear(x: FloatArray, force: FloatArray) -> tuple[float, float]:
    return best_power(x, force, 0.6, 3.0)
