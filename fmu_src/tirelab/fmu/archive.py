"""An FMU as an archive: the same bytes for the same content, and a GUID made from it."""

from __future__ import annotations

import hashlib
import re
import uuid
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import fmpy.validation
from radialtire import TireModel

from ..computing.staging import staged
from ..errors import TirelabError

MODEL = "BicycleTire"
"""The model identifier: the name of the binaries."""

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date of every archive member: the earliest a ZIP can hold."""


NO_XML = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"
"""What no XML document can hold (XML 1.0, 2.2): characters that control a terminal, halves of a pair."""


def named_for_xml(tire: TireModel) -> TireModel:
    """Return a tire with a question mark for each character of its name and source that no description can hold."""
    name, source = (re.sub(NO_XML, "?", text) for text in (tire.name, tire.source))
    return replace(tire, name=name, source=source)


def content_guid(members: dict[str, bytes], description: ElementTree.Element, key: str = "guid") -> str:
    """Return a GUID that is the same for the same content, and another for any other.

    key: the attribute of the description that will hold it
    """
    description.set(key, "")
    digest = hashlib.sha256(ElementTree.tostring(description))
    for name in sorted(members):
        digest.update(name.encode() + b"\0" + hashlib.sha256(members[name]).digest())
    return "{" + str(uuid.UUID(bytes=digest.digest()[:16], version=5)) + "}"


def xml_text(root: ElementTree.Element) -> bytes:
    """Return a document as it stands in the archive."""
    ElementTree.indent(root)
    text: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text + b"\n"


def check_fmu(path: Path) -> None:
    """Raise TirelabError where an FMU breaks the standard."""
    problems = fmpy.validation.validate_fmu(str(path))
    if problems:
        raise TirelabError(f"{path.name} is not a valid FMU: {problems[0]}; report this with the tire file")


def write_archive(members: dict[str, bytes], path: Path, check: Callable[[Path], None]) -> Path:
    """Write an archive that passes `check`, so that nobody sees half of one or a bad one, and return its path.

    Raises TirelabError where the folder cannot be written.
    """
    with staged(path.parent) as folder:
        written = folder / path.name
        with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            for name in sorted(members):
                info = zipfile.ZipInfo(name, EPOCH)
                info.compress_type = zipfile.ZIP_DEFLATED
                info.external_attr = 0o644 << 16
                archive.writestr(info, members[name])
        check(written)
    return path
