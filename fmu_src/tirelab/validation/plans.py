"""Score recording plans: verdicts after a planned set against verdicts after as much time of slow triangles.

Run: python -m tirelab.validation.plans --seed SEED --trials N

The independent rig hides something in a tire. On its surfaces and within its depth a plan is made from the baseline
tire and the noise alone; the rig drives it. In the same time it drives slow triangles twice: in one recording on its
flattest surface, as without a plan, and in recordings of the plan's number, lengths and surfaces, which shows what the
motions alone are worth. All three sets are diagnosed. A verdict is right where it is the hidden set or one that the
independent rig cannot tell from it with all motions of the three sets together (`concealed.derived_right`), wrong where
it is another one, and undecided where its confidence is below a half or where one of its alternatives has at least half
of its probability and is wrong where it is right, or right where it is wrong. What none of these motions shows at all,
such as a stop beyond the stroke, is no question that a plan can answer: another trial is drawn.
"""

from __future__ import annotations

import json
import math
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import click
import concealed
import numpy as np
from concealed.__main__ import trial_seed
from concealed.motion import Motion
from radialtire import TireModel

from ..computing.workers import Cores, work
from ..diagnosis.diagnose import diagnose
from ..names import UNKNOWN
from ..planning.menu import Drive
from ..planning.plan import RecordingPlan, plan_recordings
from ..planning.rig import Rig
from ..planning.waveforms import sample_times, slow_triangles
from ..recordings.recording import Recording
from ..report.words import DECIDED, NEAR
from .baseline import baseline_tire
from .folders import read_json
from .metrics import COVERAGE, RESAMPLES

SPEED, SAMPLING, TIME = 0.2, 0.005, 120.0
"""Fastest motion [m/s], sampling step [s] and time [s] of the rig: a servo-hydraulic one for two minutes."""

DRAWS, APART = 8, 100_000
"""Draws of one trial at most, until what is hidden shows within the limits of the rig, and how far apart in number."""

MOST_SURFACES = 2
"""Surfaces of a trial that are mounted."""

ARMS = {
    "planned": "after the plan",
    "triangles": "after slow triangles of its lengths on its surfaces",
    "one surface": "after slow triangles on one surface",
}
"""What is compared, in the same time."""

Outcome = Literal["right", "wrong", "undecided"]

Names = frozenset[str]


@dataclass(frozen=True)
class Compared:
    """A trial with the baseline tire, the plan for it, what is driven in each of ARMS, and the sets that are right."""

    trial: concealed.Trial
    tire: TireModel
    plan: RecordingPlan
    arms: Mapping[str, tuple[Drive, ...]]
    right: tuple[Names, ...]
    draw: int


def compare_plan(seed: int, number: int, kind: str | None) -> dict[str, Any]:
    """Return what was hidden in one trial, and verdict, confidence, outcome and alternatives with their
    probabilities after each set of recordings.

    Raises RuntimeError where no draw of the trial shows within the limits of its rig.
    """
    asked = _asked(seed, number, kind)
    return {
        "truth": sorted(asked.right[0]),
        "right": [sorted(names) for names in asked.right],
        "draw": asked.draw,
        **{arm: _verdict(asked, drives) for arm, drives in asked.arms.items()},
        "seconds": asked.plan.seconds,
        "motions": [drive.name for drive in asked.plan.drives],
    }


def _asked(seed: int, number: int, kind: str | None) -> Compared:
    for draw in range(DRAWS):
        trial = concealed.draw(trial_seed(seed, number + draw * APART), kind=kind)
        tire, rig = _baseline(trial), rig_of(trial)
        plan = plan_recordings(tire, rig)
        slow = tuple(slow_instead(drive, rig) for drive in plan.drives)
        arms = dict(zip(ARMS, (plan.drives, slow, (slow_on_one(rig, plan.seconds),)), strict=True))
        right = right_sets(trial, [drive for drives in arms.values() for drive in drives])
        hidden = trial.answer.kind != "none"
        if not (hidden and frozenset() in right):
            return Compared(trial, tire, plan, arms, right, draw)
    raise RuntimeError(f"trial {number}: nothing of {DRAWS} draws shows within the limits of its rig")


def right_sets(trial: concealed.Trial, drives: Sequence[Drive]) -> tuple[Names, ...]:
    """Return the sets of names that the rig of a trial cannot tell from the hidden one by these drives, that one first;
    the empty set stands among them where the drives do not show it at all.
    """
    driven = replace(trial, motions=tuple(_motion(drive) for drive in drives))
    return tuple(frozenset(names) - {"none"} for names in concealed.derived_right(driven))


def _motion(drive: Drive) -> Motion:
    """Return a drive as the rig of a trial makes it, which takes steps no finer than these."""
    return Motion(drive.name, drive.time, drive.deflection, drive.surface_radius)


def _baseline(trial: concealed.Trial) -> TireModel:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "baseline.json"
        concealed.write_baseline(trial, path)
        return baseline_tire(read_json(path))


def rig_of(trial: concealed.Trial) -> Rig:
    """Return the limits of a rig that mounts the trial's surfaces, as deep as all of them allow."""
    radii = np.concatenate([record.radius for record in trial.train])
    depth = np.concatenate([record.deflection for record in trial.train])
    surfaces = sorted(set(radii.tolist()), key=lambda r: abs(1.0 / r))[:MOST_SURFACES]
    stroke = min(float(depth[radii == r].max()) for r in surfaces)
    return Rig(stroke, SPEED, tuple(surfaces), (), TIME, SAMPLING, trial.noise)


def slow_instead(drive: Drive, rig: Rig) -> Drive:
    """Return slow triangles of the length and on the surface of a drive."""
    path = slow_triangles(rig.limits(drive.duration))[: drive.time.size]
    return replace(drive, name="slow triangles", deflection=np.resize(path, drive.time.size))


def slow_on_one(rig: Rig, seconds: float) -> Drive:
    """Return one recording of slow triangles on the first surface of a rig."""
    limits = rig.limits(seconds)
    time = sample_times(limits)
    return Drive("slow triangles", time, slow_triangles(limits), np.full(time.size, rig.surfaces[0]))


def _verdict(
    asked: Compared, drives: Sequence[Drive]
) -> tuple[list[str], float, Outcome, list[tuple[list[str], float]]]:
    trial, recordings = asked.trial, []
    for number, drive in enumerate(drives):
        record = concealed.rerun(
            trial, drive.time, drive.deflection, drive.surface_radius, seed=number + 1, name=f"test_{number}"
        )
        recordings.append(Recording(record.name, record.time, record.deflection, record.radius, record.force))
    verdict = diagnose(recordings, asked.tire)
    names = frozenset(effect.name for effect in verdict.effects)
    names |= {UNKNOWN} if verdict.unexplained_by else frozenset()
    others = [(frozenset(a.names), a.probability) for a in verdict.alternatives]
    outcome = outcome_of(names, verdict.confidence, others, asked.right)
    told = [(sorted(other), p) for other, p in others if math.isfinite(p)]
    return sorted(names), verdict.confidence, outcome, told


def outcome_of(
    names: Names, confidence: float, alternatives: Sequence[tuple[Names, float]], right: Sequence[Names]
) -> Outcome:
    """Return what a verdict is worth, see the module; alternatives: with their probabilities. A right one beside a
    right verdict does not count: nothing that any of the sets drives tells the two apart.
    """
    correct = names in right
    near = any((other in right) != correct and p >= NEAR * confidence for other, p in alternatives)
    if confidence < DECIDED or near:
        return "undecided"
    return "right" if correct else "wrong"


def summary(found: Sequence[dict[str, Any]]) -> list[str]:
    """Return the counts of every set, and how many of the missed verdicts of each the plan leaves."""
    counted = {arm: Counter(row[arm][2] for row in found) for arm in ARMS}
    missed = {arm: counts["wrong"] + counts["undecided"] for arm, counts in counted.items()}
    lines = [
        f"{counts['right']} right, {counts['wrong']} wrong, {counts['undecided']} undecided of {len(found)} {ARMS[arm]}"
        for arm, counts in counted.items()
    ]
    planned, *others = ARMS
    for other in others:
        if missed[other]:
            rows = [[row[arm][2] != "right" for row in found] for arm in (planned, other)]
            low, high = ratio_interval(*rows)
            told = (
                f"{missed[planned] / missed[other]:.2f} (95 %: {low:.2f} to {high:.2f}; wanted: at most 0.33)"
            )
        else:
            told = "none of the latter is wrong or undecided, more trials are needed"
        lines.append(f"wrong or undecided after the plan over {ARMS[other]}: {told}")
    return lines


def ratio_interval(first: Sequence[bool], second: Sequence[bool]) -> tuple[float, float]:
    """Return the 95 % interval of how many times as many trials are missed in the first way as in the second, by
    resampling the trials: both ways are tried on each, so they share its luck.
    """
    missed = np.array([first, second], dtype=np.float64)
    drawn = np.random.default_rng(1).integers(missed.shape[1], size=(RESAMPLES, missed.shape[1]))
    one, other = missed[:, drawn].sum(axis=2)
    ratios = np.full(RESAMPLES, math.inf)  # where nothing is missed in the second way
    np.divide(one, other, out=ratios, where=other > 0.0)
    tail = 50.0 * (1.0 - COVERAGE)
    low, high = np.percentile(ratios, [tail, 100.0 - tail], method="inverted_cdf")
    return float(low), float(high)


@click.command()
@click.option("--seed", type=click.IntRange(min=0), required=True)
@click.option("--trials", type=click.IntRange(min=1), default=12, show_default=True)
@click.option("--kind", type=click.Choice(list(concealed.KINDS)), default="single", show_default=True)
@click.option("--jobs", type=int, default=1, show_default=True, help="Number of processes.")
@click.option("--out", type=click.Path(path_type=Path), help="File for the trials, one JSON line each.")
def main(seed: int, trials: int, kind: str, jobs: int, out: Path | None) -> None:
    """Print the verdicts of every trial after a planned set and after two of slow triangles, and their counts."""
    found = []
    tasks = {str(n): (seed, n, kind) for n in range(trials)}
    for done in work(compare_plan, tasks, Cores(jobs, None), "comparing plans"):
        if done.value is None:
            click.echo(f"trial {done.key} failed: {done.error}")
            continue
        found.append(done.value)
        line = json.dumps({"trial": int(done.key), **done.value})
        click.echo(line)
        if out is not None:
            with out.open("a", encoding="utf-8") as stream:
                stream.write(line + "\n")
    for text in summary(found):
        click.echo(text)


if __name__ == "__main__":
    main()
