"""Archives of others: read without running anything, unpacked into one folder and nowhere else."""

from __future__ import annotations

import lzma
import shutil
import zipfile
import zlib
from pathlib import Path, PurePosixPath

import fmpy
from fmpy.model_description import ModelDescription

from ..errors import TirelabError
from ..names import plain

LARGEST = 8 << 30
"""Bytes of an archive's content above which it is refused: an FMU with its libraries has some hundred megabytes."""

LARGEST_TEXT = 64 << 20
"""The same of a member that is read as a text."""

DAMAGE = (
    OSError,
    EOFError,
    KeyError,
    NotImplementedError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
)
"""What zipfile raises for an archive that is cut, changed, encrypted or compressed in an unknown way."""


def unpack(archive: Path, folder: Path) -> None:
    """Unpack an FMU or an SSP into `folder`.

    Raises TirelabError where it cannot be read, a member's name leads out of the folder, or the content is larger than
    LARGEST or than what the disk has left.
    """
    try:
        with zipfile.ZipFile(archive) as members:
            for name in members.namelist():
                parts = PurePosixPath(name)
                if parts.is_absolute() or ".." in parts.parts or "\\" in name or ":" in name:
                    raise TirelabError(
                        f"{archive} holds the file {name!r}, which leads out of the folder it is unpacked into; do not "
                        "use this archive, and ask where it comes from"
                    )
            size = sum(member.file_size for member in members.infolist())
            if size > LARGEST:
                raise TirelabError(
                    f"{archive} unpacks to {size / 1e9:.0f} GB; an archive of {LARGEST / 1e9:.0f} GB is the largest "
                    "that is read"
                )
            free = shutil.disk_usage(folder if folder.exists() else folder.parent).free
            if size > free:
                raise TirelabError(
                    f"{archive} unpacks to {plain(size / 1e9, 2)} GB, and {folder.parent} has "
                    f"{plain(free / 1e9, 2)} GB left; make room, or name another folder in the environment variable "
                    "TMPDIR"
                )
            members.extractall(folder)
    except DAMAGE as error:
        raise TirelabError(f"{archive} cannot be unpacked ({damage(error)}); export it again") from None


def text_in(archive: Path, member: str) -> tuple[str | None, frozenset[str]]:
    """Return the text of a member of an FMU, None where there is none, and the names of all members.

    Raises TirelabError where it cannot be read, is no text, or is larger than LARGEST_TEXT.
    """
    try:
        with zipfile.ZipFile(archive) as members:
            names = frozenset(members.namelist())
            if member not in names:
                return None, names
            size = members.getinfo(member).file_size
            if size > LARGEST_TEXT:
                raise TirelabError(
                    f"{archive}: its {member} has {size / 1e6:.0f} MB, and such a file has a few kB; do not use this "
                    "archive, and ask where it comes from"
                )
            return members.read(member).decode("utf-8"), names
    except FileNotFoundError:
        raise TirelabError(f"{archive} does not exist; check the path") from None
    except UnicodeDecodeError:
        raise TirelabError(f"{archive}: its {member} is not UTF-8 text; export it again") from None
    except DAMAGE as error:
        raise TirelabError(f"{archive} cannot be read as an FMU ({damage(error)}); export it again") from None


def description_in(archive: Path, *, validate: bool, again: str) -> ModelDescription:
    """Return what an FMU says of itself; nothing of it is run.

    validate: whether it must keep to the standard in everything; again: what to do about one that cannot be read
    Raises TirelabError where it cannot be read, or breaks the standard.
    """
    try:
        with open(archive, "rb") as file:  # fmpy would leave it open where it refuses the description
            return fmpy.read_model_description(file, validate=validate)
    except FileNotFoundError:
        raise TirelabError(f"{archive} does not exist; check the path") from None
    except DAMAGE as error:
        raise TirelabError(f"{archive} cannot be read as an FMU ({damage(error)}); {again}") from None
    except (AttributeError, TypeError):  # fmpy looks for something that is not there
        raise TirelabError(
            f"{archive}: its modelDescription.xml lacks what every FMU has, such as fmiVersion; {again}"
        ) from None
    except Exception as error:  # fmpy raises plain Exception for a description that breaks the standard
        first = " ".join(str(error).splitlines()[:2])
        raise TirelabError(f"{archive} breaks the FMI standard ({first}); {again}") from None


def damage(error: BaseException) -> str:
    """Return what is wrong with an archive, in the words of what was raised."""
    if isinstance(error, IsADirectoryError):
        return "it is a folder"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error.args[0]) if error.args else type(error).__name__
