"""What a diagnosis was made of and with: its command, and the files that it depends on with their hashes."""

from __future__ import annotations

import hashlib
import shlex
from collections.abc import Sequence
from pathlib import Path

from ..fmu.foreign import Simulation
from ..recordings.metadata import read_sidecar
from ..recordings.pieces import split_piece
from ..recordings.reading import Reading


def command_line(
    recordings: Sequence[Path],
    out: Path,
    tire: Path | Simulation | None,
    held_out: Sequence[Path],
    reading: Reading,
    rig: Path | None = None,
) -> str:
    """Return the command that repeats a diagnosis."""
    words = ["tirelab", "diagnose", *map(str, recordings)]
    if isinstance(tire, Simulation):
        words += tire.words()
    elif tire is not None:
        words += ["--tire", str(tire)]
    words += [] if rig is None else ["--rig", str(rig)]
    words += ["--out", str(out), *reading.words()]
    words += [word for file in held_out for word in ("--held-out", str(file))]
    return shlex.join(words)


def files_read(recordings: Sequence[Path], settings: Path | None, beside: Sequence[Path]) -> list[Path]:
    """Return the files that a diagnosis depends on, each once: the recordings, their settings, and those `beside`.

    settings: the file that is named for all recordings, None where each has its own
    """
    parts = [split_piece(given) for given in recordings]
    found = [file for file, _ in parts]
    if settings is not None:
        found.append(settings)
    else:
        for file, piece in parts:
            found += [file.parent / name for name in read_sidecar(file, trial=piece.trial).sources]
    return list(dict.fromkeys([*found, *beside]))


def sha256(file: Path) -> str:
    """Return the hash of a file's content, in hexadecimal."""
    with file.open("rb") as stream:
        digest = hashlib.sha256()
        while block := stream.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
