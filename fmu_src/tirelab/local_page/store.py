"""Uploaded recordings and finished diagnoses in one folder, under names of our own.

    DIR/uploads/0001.csv       the file as it came, with its suffix where that is a plain word
    DIR/uploads/0001.toml      its name in reports and how it is to be read, as `recordings.metadata` has it
    DIR/uploads/0001.json      what the user calls it, and what it is used for
    DIR/diagnoses/0001/        what `tirelab diagnose` writes

A name from outside never becomes a path: it is kept as text, and shown as text.
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO, Protocol

from ..errors import TirelabError

SUFFIX = re.compile(r"\.[a-z][a-z0-9]{0,7}")
"""A suffix that an upload keeps: by it and by the content `recordings.formats` finds how to read the file."""

OWN = (".json", ".toml", ".part")
"""Suffixes of what stands beside an upload."""

RESULTS = (
    "report.html",
    "tire.json",
    "BicycleTire.fmu",
    "Correction.fmu",
    "diagnosis.json",
    "separating_test.csv",
    "plots.csv",
)
"""The files of a diagnosis that can be asked for."""

USES = ("fitted", "held-out", "left out")

LONGEST_NAME, LONGEST_TEXT = 120, 200
BLOCK = 1 << 20


class Stream(Protocol):
    """What an upload is read from."""

    def read(self, size: int, /) -> bytes:
        """Return at most `size` bytes; none at the end."""
        ...


@dataclass(frozen=True)
class Upload:
    """One uploaded recording: its number, its file, what the user calls it and uses it for."""

    number: int
    file: Path
    name: str
    use: str


@dataclass(frozen=True)
class Arrived:
    """A file that was received and has no number yet: where it is, what the user calls it, its suffix."""

    file: Path
    name: str
    suffix: str


@dataclass(frozen=True)
class Store:
    """The folder of a local page."""

    folder: Path

    def prepare(self) -> None:
        """Make the folder. Raises TirelabError where it cannot be written."""
        try:
            for path in (self._uploads, self._diagnoses):
                path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise TirelabError(
                f"{self.folder} cannot be written ({error.strerror}); name another folder"
            ) from None

    @property
    def _uploads(self) -> Path:
        return self.folder / "uploads"

    @property
    def _diagnoses(self) -> Path:
        return self.folder / "diagnoses"

    def uploads(self) -> list[Upload]:
        """Return the recordings by their numbers."""
        found = []
        for told in sorted(self._uploads.glob("[0-9][0-9][0-9][0-9].json")):
            content = json.loads(told.read_text(encoding="utf-8"))
            found.append(
                Upload(
                    int(told.stem),
                    self._uploads / f"{told.stem}{content['suffix']}",
                    content["name"],
                    content["use"],
                )
            )
        return found

    def upload(self, number: int) -> Upload:
        """Return the recording of that number. Raises TirelabError where there is none."""
        found = [u for u in self.uploads() if u.number == number]
        if not found:
            raise TirelabError("there is no such recording; load the page again")
        return found[0]

    def arrive(self, name: str, stream: Stream, size: int) -> Arrived:
        """Write `size` bytes of a stream aside.

        Raises TirelabError, and leaves nothing, where the stream ends early.
        """
        shown = clean_name(name)
        suffix = PurePosixPath(shown).suffix.lower()
        if suffix in OWN or not SUFFIX.fullmatch(suffix):
            suffix = ""
        descriptor, aside = tempfile.mkstemp(prefix=".part-", dir=self._uploads)
        try:
            with os.fdopen(descriptor, "wb") as file:
                _copy(stream, file, size, shown)
        except BaseException:
            Path(aside).unlink(missing_ok=True)
            raise
        return Arrived(Path(aside), shown, suffix)

    def keep(self, arrived: Arrived) -> Upload:
        """Give what arrived a number; not at the same time as another."""
        number = max((u.number for u in self.uploads()), default=0) + 1
        upload = Upload(number, self._uploads / f"{number:04d}{arrived.suffix}", arrived.name, "fitted")
        os.replace(arrived.file, upload.file)
        self.settings(upload, {}, {}, "")
        self._tell(upload)
        return upload

    def use(self, upload: Upload, use: str) -> None:
        """Say what a recording is used for, one of USES. Raises TirelabError for another use."""
        if use not in USES:
            raise TirelabError(f"a recording is one of {', '.join(USES)}")
        self._tell(Upload(upload.number, upload.file, upload.name, use))

    def settings(
        self, upload: Upload, columns: Mapping[str, str], units: Mapping[str, str], radius: str
    ) -> None:
        """Write a recording's name and how it is to be read; texts that are empty are left to the file."""
        lines = [f"name = {_toml(self._apart(upload))}"]
        lines += [f"radius = {_toml(radius)}"] if radius else []
        for table, values in (("columns", columns), ("units", units)):
            given = {channel: text for channel, text in values.items() if text}
            if given:
                lines += [f"[{table}]", *(f"{channel} = {_toml(text)}" for channel, text in given.items())]
        beside = upload.file.with_suffix(".toml")
        beside.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")

    def remove(self, upload: Upload) -> None:
        """Delete a recording with what stands beside it."""
        for suffix in (upload.file.suffix, ".toml", ".json"):
            upload.file.with_suffix(suffix).unlink(missing_ok=True)

    def next_diagnosis(self) -> tuple[int, Path]:
        """Return the number and the folder of a new diagnosis; the folder is not made."""
        number = max((n for n, _ in self.diagnoses()), default=0) + 1
        return number, self._diagnoses / f"{number:04d}"

    def diagnoses(self) -> list[tuple[int, Path]]:
        """Return numbers and folders of the finished diagnoses."""
        found = self._diagnoses.glob("[0-9][0-9][0-9][0-9]/diagnosis.json")
        return sorted((int(file.parent.name), file.parent) for file in found)

    def result(self, number: int, name: str) -> Path | None:
        """Return a file of a diagnosis, one of RESULTS; None where there is none."""
        if name not in RESULTS:
            return None
        file = self._diagnoses / f"{number:04d}" / name
        return file if file.is_file() else None

    def _apart(self, upload: Upload) -> str:
        """Return what an upload is called in reports, told apart from others of the same name by its number."""
        earlier = {_stem(u.name) for u in self.uploads() if u.number < upload.number}
        stem = _stem(upload.name)
        return f"{stem} ({upload.number})" if stem in earlier else stem

    def _tell(self, upload: Upload) -> None:
        content = {"name": upload.name, "use": upload.use, "suffix": upload.file.suffix}
        told = upload.file.with_suffix(".json")
        aside = told.with_suffix(".part")
        aside.write_text(json.dumps(content), encoding="utf-8")
        os.replace(aside, told)


def clean_name(name: str) -> str:
    """Return a name from outside as a text to show: its last part, printable, not too long."""
    last = name.replace("\\", "/").rpartition("/")[2]
    shown = "".join(c if c.isprintable() else "?" for c in last).strip()
    if len(shown) > LONGEST_NAME:
        stem, dot, suffix = shown.rpartition(".")
        shown = f"{stem[: LONGEST_NAME - 10]}...{dot}{suffix[-8:]}"
    return shown or "recording"


def clean_texts(values: Any, known: tuple[str, ...]) -> dict[str, str]:
    """Return assignments that came from outside: texts by known names. Raises TirelabError for anything else."""
    if not isinstance(values, Mapping):
        raise TirelabError("columns and units are texts by channel")
    found = {}
    for name, text in values.items():
        if name not in known or not isinstance(text, str) or not clean_text(text):
            raise TirelabError(f"columns and units are short printable texts, by {', '.join(known)}")
        found[str(name)] = text.strip()
    return found


def clean_text(text: object) -> bool:
    """Whether something is a short printable text."""
    return isinstance(text, str) and len(text) <= LONGEST_TEXT and text.isprintable()


def _stem(name: str) -> str:
    return name.rpartition(".")[0] or name


def _toml(text: str) -> str:
    # printable texts are checked before: what is left to escape is the same in JSON and TOML
    return json.dumps(text, ensure_ascii=False)


def _copy(stream: Stream, file: BinaryIO, size: int, name: str) -> None:
    left = size
    while left > 0:
        block = stream.read(min(left, BLOCK))
        if not block:
            raise TirelabError(f"{name} did not arrive whole; drop it again")
        file.write(block)
        left -= len(block)


__all__ = ["RESULTS", "USES", "Store", "Upload", "clean_name", "clean_text", "clean_texts"]
