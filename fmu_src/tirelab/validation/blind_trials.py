"""A series of blind trials: draw and seal, diagnose from the recordings alone, run suggested tests, open and score."""

from __future__ import annotations

import hashlib
import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from radialtire import read_tire

from ..batch.workers import Cores, work
from ..diagnosis.diagnosis_file import Stated, read_stated
from ..diagnosis.diagnosis_run import Diagnoser, diagnose_files
from ..errors import TirelabError
from ..recordings.recording import read_recording
from .figures import overview
from .folders import Folders, read_json, write_json
from .follow_up_test import run_suggested_test
from .held_out import held_out
from .overlap import place_scores
from .page import Proof, numbers, page
from .score import Score, right_sets, separation, sizes_over_noise
from .seal import add_seal, draw_and_seal, key_of, opened, read_seals

SCHEMA = 3

Told = Callable[[str], None]


@dataclass(frozen=True)
class Series:
    """So many trials from a seed in a folder; kind: of all trials (see `concealed.KINDS`), None: as they come.

    diagnoser: what stands for the user with the command; it is handed recordings and the believed tire alone
    """

    folders: Folders
    seed: int
    trials: int
    kind: str | None = None
    diagnoser: Diagnoser = diagnose_files

    @property
    def keys(self) -> dict[str, int]:
        """Names and numbers of the trials."""
        return {key_of(number): number for number in range(self.trials)}


def prove(series: Series, cores: Cores, tell: Told) -> Proof:
    """Run what of the series is not done yet, write proof.json, proof.html, proof.png, and return the proof.

    Every step's results are files; what is there is not done again, a failed diagnosis neither: a proof is not thrown
    again until it fits. `tell` is handed one line for every seal, before the first diagnosis.
    Raises TirelabError for a folder that holds another series, and BrokenSealError for a changed answer.
    """
    _claim(series)
    seals = _seal_all(series, cores, tell)
    _diagnose_all(series, cores, second=False)
    _run_tests(series, cores)
    _diagnose_all(series, cores, second=True)
    proof = Proof(series.seed, _score_all(series, seals, cores))
    write_json(series.folders.root / "proof.json", numbers(proof))
    (series.folders.root / "proof.html").write_text(page(proof), encoding="utf-8")
    overview(proof.scores, proof.command).savefig(series.folders.root / "proof.png", dpi=110)
    return proof


def _claim(series: Series) -> None:
    path = series.folders.root / "settings.json"
    wanted = {"schema": SCHEMA, "seed": series.seed, "kind": series.kind}
    if not path.exists():
        try:
            write_json(path, wanted)
        except OSError as error:
            raise TirelabError(
                f"{series.folders.root}: cannot be written ({error.strerror}); name another with --out"
            ) from None
    elif (found := read_json(path)).get("schema") != SCHEMA:
        raise TirelabError(
            f"{series.folders.root} holds trials of another version of this rig; name another folder with --out"
        )
    elif found != wanted:
        raise TirelabError(
            f"{series.folders.root} holds the trials of seed {found.get('seed')}, kind {found.get('kind')}; "
            "give that seed, or another folder with --out"
        )


def _seal_all(series: Series, cores: Cores, tell: Told) -> dict[str, str]:
    folders = series.folders
    seals = read_seals(folders)
    tasks = {
        key: (folders, series.seed, number, series.kind)
        for key, number in series.keys.items()
        if key not in seals
    }
    for done in work(draw_and_seal, tasks, cores, "sealing answers"):
        if done.value is None:
            raise TirelabError(f"trial {done.key} cannot be drawn: {done.error}")
        add_seal(folders, done.key, done.value)
        seals[done.key] = done.value
    for key in series.keys:
        tell(f"{key}  {seals[key]}")
    return {key: seals[key] for key in series.keys}


def _diagnose_all(series: Series, cores: Cores, *, second: bool) -> None:
    folders = series.folders
    tasks: dict[str, tuple[Any, ...]] = {}
    for key in series.keys:
        recordings = folders.recordings(key, "train")
        if second:
            if not folders.test(key).exists():
                continue
            recordings.append(folders.test(key))
        if not folders.outcome(key, second=second).exists():
            tasks[key] = (
                series.diagnoser,
                recordings,
                folders.tire(key),
                folders.verdict(key, second=second),
            )
    title = "diagnosing with the suggested test" if second else "diagnosing"
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


def _run_tests(series: Series, cores: Cores) -> None:
    folders = series.folders
    tasks: dict[str, tuple[Any, ...]] = {}
    for key, number in series.keys.items():
        stated = _verdict(folders, key)
        suggested = stated.separating_test if stated is not None else None
        tried = folders.test(key).exists() or folders.outcome(key, second=True).exists()
        if suggested is not None and not tried:
            tasks[key] = (folders, series.seed, number, series.kind, suggested)
    for done in work(run_suggested_test, tasks, cores, "running suggested tests"):
        if done.error is not None:
            write_json(folders.outcome(done.key, second=True), {"error": done.error, "seconds": None})


def _score_all(series: Series, seals: dict[str, str], cores: Cores) -> tuple[Score, ...]:
    folders = series.folders
    for key in series.keys:
        opened(folders, key, seals[key])
    tasks = {key: (folders, key, seals[key]) for key in series.keys if not folders.score(key).exists()}
    for done in work(score_trial, tasks, cores, "scoring"):
        if done.error is not None:
            raise TirelabError(f"trial {done.key} cannot be scored: {done.error}")
    return tuple(Score.from_json(read_json(folders.score(key))) for key in series.keys)


def score_trial(folders: Folders, key: str, seal: str) -> None:
    """Open the answer of a trial, check its seal, and write the score."""
    answer = opened(folders, key, seal)
    outcome = read_json(folders.outcome(key))
    stated = _verdict(folders, key)
    error = outcome["error"]
    measured = None
    places: tuple[Any, ...] = ()
    if stated is not None:
        places = place_scores(
            answer["where"], stated.places, [read_recording(p) for p in folders.recordings(key, "train")]
        )
        try:
            believed = read_tire(folders.tire(key))
            measured = held_out(
                believed,
                believed if stated.tire is None else read_tire(stated.tire),
                stated.corrected_fmu,
                [read_recording(p) for p in folders.recordings(key, "heldout")],
                answer["files"],
            )
        except Exception as failure:
            error = f"its corrected tire fails on held-out recordings: {type(failure).__name__}: {failure}"
    told = None
    if stated is not None and stated.alternatives:
        told = separation(right_sets(answer), stated, _verdict(folders, key, second=True))
    score = Score(
        trial=key,
        kind=answer["kind"],
        right=right_sets(answer),
        verdict=None if stated is None else stated.names,
        alternatives=() if stated is None else stated.alternatives,
        confidence=None if stated is None else stated.confidence,
        error=error,
        sizes=sizes_over_noise(answer),
        places=places,
        held_out=measured,
        separation=told,
        seconds=outcome["seconds"] or 0.0,
    )
    write_json(folders.score(key), score.to_json())


def _verdict(folders: Folders, key: str, *, second: bool = False) -> Stated | None:
    """The verdict on a trial, None where there is none or the diagnosis failed."""
    outcome = folders.outcome(key, second=second)
    if not outcome.exists() or read_json(outcome)["error"] is not None:
        return None
    return read_stated(folders.verdict(key, second=second))
