"""Draw a trial, write its recordings, and seal its answer before anybody diagnoses."""

from __future__ import annotations

import hashlib
import shutil
from typing import Any

import concealed
from concealed.__main__ import trial_seed
from radialtire import write_tire

from ..errors import TirelabError
from .baseline import believed_tire
from .folders import Folders, read_json


class BrokenSealError(TirelabError):
    """An answer that is not the one that was sealed."""


def draw_and_seal(folders: Folders, seed: int, number: int, kind: str | None) -> str:
    """Write recordings, believed tire and answer of one trial, and return the SHA-256 of the answer's bytes."""
    trial = concealed.draw(trial_seed(seed, number), kind=kind)
    key = key_of(number)
    shutil.rmtree(folders.trial(key), ignore_errors=True)
    concealed.write(trial, folders.trial(key))
    folders.tire(key).parent.mkdir(parents=True, exist_ok=True)
    write_tire(believed_tire(concealed.baseline_table(trial)), folders.tire(key))
    return concealed.write_answer(trial, folders.sealed(key))


def key_of(number: int) -> str:
    """Return the name of a trial in all folders."""
    return f"{number:04d}"


def read_seals(folders: Folders) -> dict[str, str]:
    """Return the SHA-256 of every answer that was sealed so far."""
    if not folders.seals.exists():
        return {}
    lines = folders.seals.read_text(encoding="ascii").splitlines()
    return {line.rpartition("/")[2].removesuffix(".json"): line[:64] for line in lines if line}


def add_seal(folders: Folders, key: str, seal: str) -> None:
    """Record the SHA-256 of a sealed answer."""
    with folders.seals.open("a", encoding="ascii") as file:
        file.write(f"{seal}  {folders.sealed(key).relative_to(folders.root).as_posix()}\n")


def opened(folders: Folders, key: str, seal: str) -> dict[str, Any]:
    """Return the answer behind a seal; raises BrokenSealError where its bytes are not those that were sealed."""
    path = folders.sealed(key)
    try:
        found = hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise BrokenSealError(
            f"{path}: {error.strerror or error}; start the proof anew in another folder"
        ) from None
    if found != seal:
        raise BrokenSealError(
            f"{path}: its SHA-256 is {found}, the seal says {seal}: the answer was changed; start the proof anew in "
            "another folder"
        )
    return read_json(path)
