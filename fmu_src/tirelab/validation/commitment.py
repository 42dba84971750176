"""Draw a trial, write its recordings, and commit to its answer by a hash before any diagnosis."""

from __future__ import annotations

import hashlib
import shutil
from typing import Any

import concealed
from concealed.__main__ import trial_seed
from radialtire import write_tire

from ..errors import TirelabError
from .baseline import baseline_tire
from .folders import Folders, read_json, write_json


class ChangedAnswerError(TirelabError):
    """An answer whose SHA-256 is not its commitment hash."""


def draw_and_commit(folders: Folders, seed: int, number: int, kind: str | None) -> dict[str, str]:
    """Write recordings, baseline tire and answer of one trial, and return commitment hashes by the key of their file.

    The sets that count as right by the rig's own fits have a file and a hash of their own, see `derived_key`.
    """
    trial = concealed.draw(trial_seed(seed, number), kind=kind)
    key = trial_key(number)
    shutil.rmtree(folders.trial(key), ignore_errors=True)
    concealed.write(trial, folders.trial(key))
    folders.tire(key).parent.mkdir(parents=True, exist_ok=True)
    write_tire(baseline_tire(concealed.baseline_table(trial)), folders.tire(key))
    commitment = concealed.write_answer(trial, folders.sealed(key))
    derived = folders.sealed(derived_key(key))
    write_json(derived, {"right": [list(names) for names in concealed.derived_right(trial)]})
    return {key: commitment, derived_key(key): hashlib.sha256(derived.read_bytes()).hexdigest()}


def trial_key(number: int) -> str:
    """Return the name of a trial in all folders."""
    return f"{number:04d}"


def derived_key(key: str) -> str:
    """Return the key of the file with the right sets of a trial by the rig's own fits."""
    return f"{key}.derived"


def read_commitments(folders: Folders) -> dict[str, str]:
    """Return the commitment hashes recorded so far."""
    if not folders.commitments.exists():
        return {}
    lines = folders.commitments.read_text(encoding="ascii").splitlines()
    return {line.rpartition("/")[2].removesuffix(".json"): line[:64] for line in lines if line}


def add_commitment(folders: Folders, key: str, commitment: str) -> None:
    """Record the commitment hash of an answer."""
    with folders.commitments.open("a", encoding="ascii") as file:
        file.write(f"{commitment}  {folders.sealed(key).relative_to(folders.root).as_posix()}\n")


def opened(folders: Folders, key: str, commitment: str) -> dict[str, Any]:
    """Return the answer; raises ChangedAnswerError where its SHA-256 is not the commitment hash."""
    path = folders.sealed(key)
    try:
        found = hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise ChangedAnswerError(
            f"{path}: {error.strerror or error}; start the proof again in another folder"
        ) from None
    if found != commitment:
        raise ChangedAnswerError(
            f"{path}: its SHA-256 is {found}, its commitment hash is {commitment}: the answer was changed; start the "
            "proof again in another folder"
        )
    return read_json(path)
