"""Calibrate the stated probabilities: blind trials, also with physics outside the catalogue, and a logistic regression.

Run: python -m tirelab.validation.calibrate --seed SEED --trials N --out FILE
     python -m tirelab.validation.calibrate --proof DIR --out FILE

Every trial is drawn, diagnosed and scored, or read from the folder of a finished `tirelab prove`; its grounds
(`diagnosis.confidence`) and whether it was right are kept. The weights maximise the posterior under independent normal
priors of standard deviation 1, for grounds of standard deviation 1; the weights of `LOWERING` are at most zero, those
of `RAISING` at least zero. The skill is computed by ten-fold cross-validation. The file that is written has the form of
`diagnosis/calibration.json`, which a diagnosis reads.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray
from radialtire import read_tire
from scipy.optimize import minimize
from scipy.special import expit

from ..computing.workers import Cores, work
from ..diagnosis.confidence import LOWERING, OF_EFFECT, OF_VERDICT, RAISING
from ..diagnosis.diagnose import diagnose
from ..diagnosis.diagnosis_file import NOTHING
from ..diagnosis.verdict import Verdict
from ..errors import TirelabError
from ..recordings.recording import read_recording
from .blind_trials import ALL_KINDS, BlindTrials
from .calibration import skill as brier_skill
from .commitment import draw_and_commit
from .folders import Folders, read_json
from .score import Score, right_sets, sizes_over_noise
from .wide_kinds import holds

FloatArray = NDArray[np.float64]

PARTS = 10
"""Parts of the trials, each of which is left out once."""


@dataclass(frozen=True)
class Row:
    """Grounds of one stated probability, and whether what it was stated of came true."""

    trial: str
    grounds: Mapping[str, float]
    right: bool


def verdict_row(score: Score, grounds: Mapping[str, float]) -> Row:
    """Return the row of a verdict; it is right where all that it names holds (`wide_kinds.holds`)."""
    return Row(f"{score.kind} {score.trial}", grounds, holds(score))


def effect_rows(score: Score, grounds: Mapping[str, Mapping[str, float]]) -> list[Row]:
    """Return the rows of the named effects; one is right where a set that counts as right holds it."""
    there = frozenset().union(*score.right)
    return [Row(f"{score.kind} {score.trial}", g, name in there) for name, g in grounds.items()]


def fitted_weights(rows: Sequence[Row], names: Sequence[str]) -> dict[str, float]:
    """Return the weights of the grounds, and the constant."""
    values = np.array([[row.grounds[n] for n in names] for row in rows])
    right = np.array([row.right for row in rows], dtype=float)
    middle, spread = values.mean(axis=0), np.maximum(values.std(axis=0), 1e-9)
    columns = np.column_stack([np.ones(len(rows)), (values - middle) / spread])

    def cost(w: FloatArray) -> tuple[float, FloatArray]:
        line = columns @ w
        value = float(np.sum(np.logaddexp(0.0, line) - right * line) + 0.5 * np.sum(w[1:] ** 2))
        slope = columns.T @ (expit(line) - right) + np.append(0.0, w[1:])
        return value, slope

    bounds = [
        (None, None),
        *((0.0 if n in RAISING else None, 0.0 if n in LOWERING else None) for n in names),
    ]
    found = minimize(cost, np.zeros(len(names) + 1), jac=True, bounds=bounds, method="L-BFGS-B").x
    weights = found[1:] / spread
    constant = float(found[0] - weights @ middle)
    return {"constant": constant, **{n: float(w) for n, w in zip(names, weights, strict=True)}}


def probabilities(rows: Sequence[Row], weights: Mapping[str, float]) -> FloatArray:
    """Return the probabilities of the rows by given weights."""
    lines = [
        weights["constant"] + sum(weights[n] * row.grounds[n] for n in weights if n != "constant")
        for row in rows
    ]
    return np.asarray(expit(np.array(lines)))


def skill(stated: FloatArray, right: FloatArray) -> float:
    """Return the Brier skill over the constant rate (`calibration.skill`)."""
    pairs = zip(stated.tolist(), right.astype(bool).tolist(), strict=True)
    return brier_skill([[pair] for pair in pairs]).value


def skill_left_out(rows: Sequence[Row], names: Sequence[str]) -> float:
    """Return the skill where each part of the trials is judged by the weights of the others."""
    trials = sorted({row.trial for row in rows})
    part = {trial: i % PARTS for i, trial in enumerate(trials)}
    stated = np.zeros(len(rows))
    for number in range(PARTS):
        left_out = [i for i, row in enumerate(rows) if part[row.trial] == number]
        weights = fitted_weights([row for row in rows if part[row.trial] != number], names)
        stated[left_out] = probabilities([rows[i] for i in left_out], weights)
    return skill(stated, np.array([row.right for row in rows], dtype=float))


def calibration_of(
    verdicts: Sequence[Row], effects: Sequence[Row], provenance: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the content of the calibration's file."""
    content: dict[str, Any] = dict(provenance)
    for of, rows, names in (("verdict", verdicts, OF_VERDICT), ("effect", effects, OF_EFFECT)):
        weights = fitted_weights(rows, names)
        right = np.array([row.right for row in rows], dtype=float)
        content[of] = {
            "rows": len(rows),
            "right": float(right.mean()),
            "skill": round(skill(probabilities(rows, weights), right), 4),
            "skill_left_out": round(skill_left_out(rows, names), 4),
            "weights": {n: round(w, 6) for n, w in weights.items()},
        }
    return content


@dataclass(frozen=True)
class Trial:
    """A diagnosed trial: its score, and the grounds of the verdict and of each named effect."""

    score: Score
    grounds: Mapping[str, float]
    effects: Mapping[str, Mapping[str, float]]

    def to_json(self) -> dict[str, Any]:
        """Return plain values."""
        return {"score": self.score.to_json(), "grounds": self.grounds, "effects": self.effects}

    @classmethod
    def from_json(cls, content: Mapping[str, Any]) -> Trial:
        """Return what `to_json` gave."""
        return cls(Score.from_json(content["score"]), content["grounds"], content["effects"])

    def stating(self, weights: Mapping[str, float]) -> Trial:
        """Return the trial with probabilities of its effects by other weights: what is claimed depends on them."""
        rows = [Row("", g, False) for g in self.effects.values()]
        stated = dict(zip(self.effects, probabilities(rows, weights).tolist(), strict=True)) if rows else {}
        return replace(self, score=replace(self.score, probabilities=stated))


def calibrated(trials: Sequence[Trial], provenance: Mapping[str, Any]) -> dict[str, Any]:
    """Return the content of the calibration's file: the effects first, for whether a verdict is right may depend on
    which effects it claims.
    """
    effects = [row for t in trials for row in effect_rows(t.score, t.effects)]
    weights = fitted_weights(effects, OF_EFFECT)
    verdicts = [verdict_row(t.stating(weights).score, t.grounds) for t in trials]
    return calibration_of(verdicts, effects, provenance)


def diagnosed(folder: Path, seed: int, number: int, kind: str | None) -> dict[str, Any]:
    """Draw, diagnose and score one trial; return it as plain values."""
    folders = Folders(folder / f"{seed}-{number}")
    (key,) = (k for k in draw_and_commit(folders, seed, number, kind) if not k.endswith(".derived"))
    answer = read_json(folders.sealed(key))
    recordings = [read_recording(path) for path in folders.recordings(key, "train")]
    verdict = diagnose(recordings, read_tire(folders.tire(key)))
    # Those that were not named for their small probability, too: without them it would be that of the others.
    effects = {e.name: dict(e.grounds) for e in (*verdict.effects, *verdict.doubted)}
    return Trial(_score(f"{seed}/{number}", answer, verdict), dict(verdict.grounds), effects).to_json()


def proved(folder: Path) -> dict[str, dict[str, Any]]:
    """Return the trials of a finished proof as plain values, by seed and number; raises TirelabError where there is
    none, or one does not say on which grounds its effects were doubted.
    """
    folders, found = Folders(folder), dict[str, dict[str, Any]]()
    if not (folders.root / "scores").is_dir():
        raise TirelabError(f"{folder} holds no scores; finish `tirelab prove` there first")
    seed = read_json(folders.root / "settings.json")["seed"]
    for path in sorted((folders.root / "scores").glob("*.json")):
        score = Score.from_json(read_json(path))
        if score.verdict is None:
            continue
        verdict = read_json(folders.verdict(path.stem) / "diagnosis.json")["verdict"]
        effects = {e["name"]: e.get("grounds") for e in (*verdict["effects"], *verdict["doubted"])}
        if None in effects.values():
            raise TirelabError(f"{folder}: it was made by an older version; run its `tirelab prove` again")
        key = f"{seed}/{score.trial}"
        found[key] = Trial(replace(score, trial=key), verdict["grounds"], effects).to_json()
    return found


def _score(key: str, answer: Mapping[str, Any], verdict: Verdict) -> Score:
    return Score(
        trial=key,
        kind=answer["kind"],
        right=right_sets(answer),
        verdict=frozenset(verdict.names) or NOTHING,
        alternatives=tuple(frozenset(a.names) or NOTHING for a in verdict.alternatives),
        confidence=verdict.confidence,
        error=None,
        sizes=sizes_over_noise(answer),
        regions=(),
        held_out=None,
        discrimination=None,
        seconds=0.0,
        probabilities={e.name: e.probability for e in verdict.effects},
        remainder=verdict.remainder.size,
    )


@click.command()
@click.option("--seed", type=int, multiple=True, help="Seeds, each with that many trials.")
@click.option(
    "--proof",
    type=click.Path(file_okay=False, path_type=Path),
    multiple=True,
    help="Folders of finished proofs, of which all trials are taken.",
)
@click.option("--trials", type=click.IntRange(min=PARTS), default=100, show_default=True)
@click.option("--out", type=click.Path(path_type=Path), required=True, help="File to write.")
@click.option(
    "--kept", type=click.Path(path_type=Path), help="File for the trials; one that is there is gone on with."
)
def main(seed: Sequence[int], proof: Sequence[Path], trials: int, out: Path, kept: Path | None) -> None:
    """Calibrate on trials of all kinds in turn."""
    done: dict[str, Any] = json.loads(kept.read_text(encoding="utf-8")) if kept and kept.exists() else {}
    try:
        for folder in proof:
            done |= proved(folder)
    except TirelabError as error:
        raise click.ClickException(str(error)) from None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tasks: dict[str, tuple[Any, ...]] = {}
        for one in seed:
            kinds = BlindTrials(Folders(folder), one, trials, ALL_KINDS)
            keys = {f"{one}/{n}": n for n in range(trials)}
            tasks |= {k: (folder, one, n, kinds.kind_of(n)) for k, n in keys.items() if k not in done}
        for one_done in work(diagnosed, tasks, Cores(), "calibrating"):
            if one_done.value is None:
                click.echo(f"trial {one_done.key} failed and is left out: {one_done.error}")
                continue
            done[one_done.key] = one_done.value
            if kept:
                kept.write_text(json.dumps(done), encoding="utf-8")
    if len(done) < PARTS:
        raise click.ClickException(
            f"{len(done)} trials are too few; give --seed or --proof with {PARTS} at least"
        )
    words = [
        *(f"--seed {s}" for s in seed),
        *([f"--trials {trials}"] if seed else []),
        *["--proof DIR"] * len(proof),
    ]
    provenance = {
        "command": f"python -m tirelab.validation.calibrate {' '.join(words)}",
        "seeds": sorted({int(key.partition("/")[0]) for key in done}),
        "kinds": "all in turn",
    }
    ordered = [Trial.from_json(done[key]) for key in sorted(done)]
    content = calibrated(ordered, provenance)
    out.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    for of in ("verdict", "effect"):
        click.echo(f"{of}: skill {content[of]['skill_left_out']:.2f} left out, {content[of]['rows']} rows")


if __name__ == "__main__":
    main()
