"""Blind trials: draw and commit to the answers, diagnose the recordings alone, run recommended tests, open, score."""

from __future__ import annotations

import hashlib
import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import concealed
from radialtire import read_tire

from ..computing.staging import staged
from ..computing.workers import Cores, work
from ..diagnosis.diagnosis_file import Stated, read_stated
from ..diagnosis.diagnosis_run import Diagnoser, diagnose_files
from ..errors import TirelabError, unwritable_folder
from ..recordings.recording import read_recording
from .commitment import add_commitment, derived_key, draw_and_commit, opened, read_commitments, trial_key
from .figures import overview
from .folders import Folders, read_json, write_json
from .follow_up_test import run_recommended_test
from .held_out import errors_on, held_out
from .overlap import RegionScore, region_scores
from .page import Proof, numbers, page
from .score import Score, discrimination, right_sets, sizes_over_noise

SETTINGS_SCHEMA = 6
"""Version of the rig and of the scores; a folder of another version is not continued."""

ALL_KINDS = "all"
"""Trials of the drawn kinds and of each wide kind but pressure in turn."""

Show = Callable[[str], None]


@dataclass(frozen=True)
class BlindTrials:
    """The number of trials, their seed and their folders.

    kind: one of `concealed.KINDS` or `concealed.WIDE_KINDS` for all trials, `ALL_KINDS`, or None: drawn from KINDS

    diagnoser: diagnoses one trial; it gets the recordings and the baseline tire only
    """

    folders: Folders
    seed: int
    trials: int
    kind: str | None = None
    diagnoser: Diagnoser = diagnose_files

    def kind_of(self, number: int) -> str | None:
        """The kind of one trial, None where it is drawn."""
        if self.kind != ALL_KINDS:
            return self.kind
        kinds = (None, *concealed.IN_TURN)
        return kinds[number % len(kinds)]

    @property
    def keys(self) -> dict[str, int]:
        """Names and numbers of the trials."""
        return {trial_key(number): number for number in range(self.trials)}


def prove(trials: BlindTrials, cores: Cores, show: Show) -> Proof:
    """Run the trials that are not done yet, write proof.json, proof.html, proof.png, and return the proof.

    The results of every step are files. What is done is not done again, also where a diagnosis failed: a proof is not
    repeated until it passes. `show` gets one line for every commitment hash, before the first diagnosis.
    Raises TirelabError for a folder that holds other trials, and ChangedAnswerError for a changed answer.
    """
    _claim(trials)
    commitments = _commit_all(trials, cores, show)
    _diagnose_all(trials, cores, second=False)
    _run_tests(trials, cores)
    _diagnose_all(trials, cores, second=True)
    proof = Proof(trials.seed, _score_all(trials, commitments, cores), trials.kind)
    with staged(trials.folders.root) as folder:
        write_json(folder / "proof.json", numbers(proof))
        (folder / "proof.html").write_text(page(proof), encoding="utf-8")
        overview(proof.scores, proof.command).savefig(folder / "proof.png", dpi=110)
    return proof


def _claim(trials: BlindTrials) -> None:
    path = trials.folders.root / "settings.json"
    wanted = {"schema": SETTINGS_SCHEMA, "seed": trials.seed, "kind": trials.kind}
    if not path.exists():
        try:
            write_json(path, wanted)
        except OSError as error:
            raise unwritable_folder(trials.folders.root, error) from None
    elif (found := read_json(path)).get("schema") != SETTINGS_SCHEMA:
        raise TirelabError(
            f"{trials.folders.root} holds trials of another version of this rig; name another folder with --out"
        )
    elif found != wanted:
        raise TirelabError(
            f"{trials.folders.root} holds the trials of seed {found.get('seed')}, kind {found.get('kind')}; "
            "give that seed, or another folder with --out"
        )


def _commit_all(trials: BlindTrials, cores: Cores, show: Show) -> dict[str, str]:
    folders = trials.folders
    commitments = read_commitments(folders)
    tasks = {
        key: (folders, trials.seed, number, trials.kind_of(number))
        for key, number in trials.keys.items()
        if key not in commitments
    }
    for done in work(draw_and_commit, tasks, cores, "committing to the answers"):
        if done.value is None:
            raise TirelabError(f"trial {done.key} cannot be drawn: {done.error}")
        for key, commitment in done.value.items():
            add_commitment(folders, key, commitment)
        commitments |= done.value
    for key in trials.keys:
        show(f"{key}  {commitments[key]}")
    return commitments


def _diagnose_all(trials: BlindTrials, cores: Cores, *, second: bool) -> None:
    folders = trials.folders
    tasks: dict[str, tuple[Any, ...]] = {}
    for key in trials.keys:
        recordings = folders.recordings(key, "train")
        if second:
            if not folders.test(key).exists():
                continue
            recordings.append(folders.test(key))
        if not folders.outcome(key, second=second).exists():
            tasks[key] = (
                trials.diagnoser,
                recordings,
                folders.tire(key),
                folders.verdict(key, second=second),
            )
    title = "diagnosing with the recommended test" if second else "diagnosing"
    for done in work(timed_diagnosis, tasks, cores, title):
        outcome = done.value or {"error": done.error, "seconds": None}
        write_json(folders.outcome(done.key, second=second), outcome)


def timed_diagnosis(
    diagnoser: Diagnoser, recordings: Sequence[Path], tire: Path, out: Path
) -> dict[str, Any]:
    """Diagnose in an empty folder, and return how it ended: the sentence of its error or None, seconds, SHA-256."""
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    began = time.perf_counter()
    error = None
    try:
        diagnoser(recordings, tire, out)
        read_stated(out)
    except Exception as failure:
        error = f"{type(failure).__name__}: {failure}"
    seconds = time.perf_counter() - began
    file = out / "diagnosis.json"
    found = hashlib.sha256(file.read_bytes()).hexdigest() if file.exists() else None
    return {"error": error, "seconds": seconds, "diagnosis_sha256": found}


def _run_tests(trials: BlindTrials, cores: Cores) -> None:
    folders = trials.folders
    tasks: dict[str, tuple[Any, ...]] = {}
    for key, number in trials.keys.items():
        verdict = _verdict(folders, key)
        recommended = verdict.separating_test if verdict is not None else None
        tried = folders.test(key).exists() or folders.outcome(key, second=True).exists()
        if recommended is not None and not tried:
            tasks[key] = (folders, trials.seed, number, trials.kind_of(number), recommended)
    for done in work(run_recommended_test, tasks, cores, "running recommended tests"):
        if done.error is not None:
            write_json(folders.outcome(done.key, second=True), {"error": done.error, "seconds": None})


def _score_all(trials: BlindTrials, commitments: dict[str, str], cores: Cores) -> tuple[Score, ...]:
    folders = trials.folders
    for key in trials.keys:
        opened(folders, key, commitments[key])
    tasks = {
        key: (folders, key, commitments[key], commitments[derived_key(key)])
        for key in trials.keys
        if not folders.score(key).exists()
    }
    for done in work(score_trial, tasks, cores, "scoring"):
        if done.error is not None:
            raise TirelabError(f"trial {done.key} cannot be scored: {done.error}")
    return tuple(Score.from_json(read_json(folders.score(key))) for key in trials.keys)


def score_trial(folders: Folders, key: str, commitment: str, derived_commitment: str) -> None:
    """Open the answer of a trial, check its commitment hashes, and write the score."""
    answer = opened(folders, key, commitment)
    derived = right_sets(opened(folders, derived_key(key), derived_commitment))
    outcome = read_json(folders.outcome(key))
    verdict = _verdict(folders, key)
    error = outcome["error"]
    errors = fitted = None
    regions: tuple[RegionScore, ...] = ()
    if verdict is not None:
        train = [read_recording(p) for p in folders.recordings(key, "train")]
        regions = region_scores(answer["where"], verdict.places, train)
        try:
            baseline = read_tire(folders.tire(key))
            corrected = baseline if verdict.tire is None else read_tire(verdict.tire)
            fitted = errors_on(baseline, corrected, train, answer["files"])
            errors = held_out(
                baseline,
                corrected,
                verdict.corrected_fmu,
                [read_recording(p) for p in folders.recordings(key, "heldout")],
                answer["files"],
            )
        except Exception as failure:
            error = f"its corrected tire fails on the recordings: {type(failure).__name__}: {failure}"
    decided = None
    if verdict is not None and verdict.alternatives:
        decided = discrimination(right_sets(answer), verdict, _verdict(folders, key, second=True))
    score = Score(
        trial=key,
        kind=answer["kind"],
        right=right_sets(answer),
        verdict=None if verdict is None else verdict.names,
        alternatives=() if verdict is None else verdict.alternatives,
        confidence=None if verdict is None else verdict.confidence,
        error=error,
        sizes=sizes_over_noise(answer),
        regions=regions,
        held_out=errors,
        discrimination=decided,
        seconds=outcome["seconds"] or 0.0,
        derived=() if set(derived) == set(right_sets(answer)) else derived,
        probabilities={} if verdict is None else verdict.probabilities,
        remainder=None if verdict is None else verdict.remainder,
        fitted=fitted,
        same=0.0 if verdict is None else verdict.same,
    )
    write_json(folders.score(key), score.to_json())


def _verdict(folders: Folders, key: str, *, second: bool = False) -> Stated | None:
    """The verdict on a trial, None where there is none or the diagnosis failed."""
    outcome = folders.outcome(key, second=second)
    if not outcome.exists() or read_json(outcome)["error"] is not None:
        return None
    return read_stated(folders.verdict(key, second=second))
