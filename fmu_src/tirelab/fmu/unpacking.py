"""An archive unpacked into one folder, and nowhere else."""

from __future__ import annotations

import zipfile
from pathlib import Path, PurePosixPath

from ..errors import TirelabError

LARGEST = 8 << 30
"""Bytes of an archive's content above which it is refused: an FMU with its libraries has some hundred megabytes."""


def unpack(archive: Path, folder: Path) -> None:
    """Unpack an FMU or an SSP into `folder`.

    Raises TirelabError where a member's name leads out of the folder, or the content is larger than LARGEST;
    BadZipFile and OSError where the archive cannot be read.
    """
    with zipfile.ZipFile(archive) as members:
        for name in members.namelist():
            parts = PurePosixPath(name)
            if parts.is_absolute() or ".." in parts.parts or "\\" in name or ":" in name:
                raise TirelabError(
                    f"{archive} holds the file {name!r}, which leads out of the folder it is unpacked into; do not use "
                    "this archive, and ask where it comes from"
                )
        size = sum(member.file_size for member in members.infolist())
        if size > LARGEST:
            raise TirelabError(
                f"{archive} unpacks to {size / 1e9:.0f} GB; an archive of {LARGEST / 1e9:.0f} GB is the largest read"
            )
        members.extractall(folder)
