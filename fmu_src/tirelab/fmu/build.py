"""A tire file -> BicycleTire.fmu, a correction -> Correction.fmu; byte for byte the same for the same source.

pythonfmu packs the embedded sources and describes them; then its archive is written anew with what it lacks: a Linux
binary for hosts that are not Python, documentation, licences, an icon, and a GUID made from the content.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import importlib.util
import json
import re
import sys
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import radialtire
from pythonfmu import FmuBuilder
from radialtire import FLAT_RADIUS, TireModel
from radialtire.tirefile import to_text

from ..errors import TirelabError, check_tire_given
from . import documentation
from .archive import MODEL, check_fmu, content_guid, named_for_xml, write_archive, xml_text
from .loader import Compiler, compile_loader

SHELL = "bicycle_tire_fmu"
CORRECTION_SHELL, CORRECTION = "tire_correction_fmu", "Correction"
PHYSICS, DESCRIPTION = "radialtire", "fmu_description"
WRAPPER = "resources/pythonfmu"
BUILD_TIME = ("__main__", "builder", "csvbuilder", "deploy", "osutil")
"""Modules of pythonfmu that make FMUs and that no FMU needs."""


@dataclass(frozen=True)
class BuiltFmu:
    """An FMU that was written: its path, its GUID, and what compiled its Linux binary (None: it is pythonfmu's)."""

    path: Path
    guid: str
    compiler: Compiler | None


@dataclass(frozen=True)
class Correction:
    """What a simulation lacks, as the FMU of `tire_correction_fmu`.

    believed: the law of the simulation; corrected: the tire with the effects that it lacks
    surface_radius [m]: the ground where a host gives none
    moves: whether the simulation is given the deflection after the effects that act before it
    """

    believed: TireModel
    corrected: TireModel
    surface_radius: float
    moves: bool

    def to_dict(self) -> dict[str, object]:
        """Return the content of correction.json."""
        return {
            "believed": json.loads(to_text(named_for_xml(self.believed))),
            "corrected": json.loads(to_text(named_for_xml(self.corrected))),
            "surface_radius": min(self.surface_radius, FLAT_RADIUS),
            "moves": self.moves,
        }


def build_fmu(tire: TireModel, folder: Path | str, *, with_loader: bool = True) -> BuiltFmu:
    """Write `folder`/BicycleTire.fmu for `tire` and return what was written.

    with_loader: compile the Linux binary for hosts that are not Python, if there is a compiler; an FMU without it has
    pythonfmu's, which runs in Python hosts only
    Raises TirelabError where the folder cannot be written, a compiler fails, or the FMU is not valid FMI 2.0, TypeError
    for what is no tire.
    """
    check_tire_given(tire)
    tire = named_for_xml(tire)
    content = _Content(SHELL, MODEL, "tire.json", to_text(tire))
    return _built(
        content, Path(folder), with_loader, lambda d: documentation.pages(tire, d, _wrapper_license())
    )


def build_correction(correction: Correction, folder: Path) -> BuiltFmu:
    """Write `folder`/Correction.fmu and return what was written; errors as of `build_fmu`."""
    text = json.dumps(correction.to_dict(), indent=2)
    content = _Content(CORRECTION_SHELL, CORRECTION, "correction.json", text)
    return _built(content, folder, True, lambda d: documentation.notices(_wrapper_license()))


@dataclass(frozen=True)
class _Content:
    """What differs from one FMU to the next: the module of its interface, the name of its binaries, its data."""

    shell: str
    model: str
    file: str
    text: str


def _built(
    content: _Content,
    folder: Path,
    with_loader: bool,
    pages: Callable[[ElementTree.Element], dict[str, bytes]],
) -> BuiltFmu:
    """Write an FMU; pages: gives its documentation from its description."""
    with tempfile.TemporaryDirectory(prefix="tirelab_") as name:
        work = Path(name)
        members = _packed(content, work)
        compiler = compile_loader(work / "loader.so") if with_loader else None
        if compiler is not None:
            members[f"binaries/linux64/{content.model}.so"] = (work / "loader.so").read_bytes()

        description = ElementTree.fromstring(members.pop("modelDescription.xml"))
        members |= pages(description)
        guid = content_guid(members, description)
        description.set("guid", guid)
        members["resources/guid.txt"] = f"{guid}\n".encode()
        members["modelDescription.xml"] = xml_text(description)
        path = write_archive(members, folder / f"{content.model}.fmu", check_fmu)
    return BuiltFmu(path, guid, compiler)


def _sources(shell: str) -> dict[str, bytes]:
    """The files that go into the FMU, by their names in the source tree."""
    package = Path(radialtire.__file__).parent
    found = {f"{PHYSICS}/{f.relative_to(package).as_posix()}": f.read_bytes() for f in package.rglob("*.py")}
    for module in (DESCRIPTION, shell):
        spec = importlib.util.find_spec(module)
        assert spec is not None
        assert spec.origin is not None
        found[f"{module}.py"] = Path(spec.origin).read_bytes()
    return dict(sorted(found.items()))


def _packed(content: _Content, work: Path) -> dict[str, bytes]:
    """Let pythonfmu pack the sources and return the members of its archive.

    Two FMUs in one process share one table of modules: the names carry a hash of the content, or the second would run
    the code of the first.
    """
    shell = content.shell
    sources = _sources(shell)
    digest = hashlib.sha256(b"".join(name.encode() + b"\0" + data + b"\0" for name, data in sources.items()))
    mark = digest.hexdigest()[:12]
    stage = work / "stage"
    for name, data in sources.items():
        target = stage / re.sub(rf"^({PHYSICS}|{DESCRIPTION}|{shell})\b", rf"\1_{mark}", name)
        target.parent.mkdir(parents=True, exist_ok=True)
        own = rf"^from ({PHYSICS}|{DESCRIPTION})\b"
        text = re.sub(own, rf"from \1_{mark}", data.decode(), flags=re.MULTILINE)
        target.write_text(text, encoding="utf-8")
    (stage / content.file).write_text(content.text, encoding="utf-8")

    script = stage / f"{shell}_{mark}.py"
    path_before, modules_before = list(sys.path), set(sys.modules)
    try:
        beside = [f"{PHYSICS}_{mark}", f"{DESCRIPTION}_{mark}.py", content.file]
        archive = FmuBuilder.build_FMU(
            script, dest=work / "packed", project_files=[stage / name for name in beside]
        )
    finally:
        sys.path[:] = path_before
        for module in [m for m in sys.modules if m not in modules_before and mark in m]:
            del sys.modules[module]
    with zipfile.ZipFile(archive) as packed:
        members = {
            n: packed.read(n) for n in packed.namelist() if "__pycache__" not in n and not n.endswith("/")
        }
    for name in BUILD_TIME:
        del members[f"{WRAPPER}/{name}.py"]
    face = members[f"{WRAPPER}/__init__.py"].decode()
    members[f"{WRAPPER}/__init__.py"] = re.sub(
        rf"^from \.({'|'.join(BUILD_TIME)}) import .*\n", "", face, flags=re.MULTILINE
    ).encode()
    return members


def _wrapper_license() -> str:
    """The licence text that pythonfmu was installed with."""
    for file in importlib.metadata.files("pythonfmu") or ():
        if file.name.upper().startswith("LICENSE"):
            return file.read_text()
    raise TirelabError(
        "pythonfmu is installed without its licence, which the FMU must carry; install it again"
    )
