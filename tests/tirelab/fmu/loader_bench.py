"""The bench of the FMU's Linux binary: a host in C, a native FMU, and FMUs of the slave plain_tire."""

import os
import shutil
import subprocess
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote
from xml.etree import ElementTree

import pytest
import pythonfmu

HERE = Path(__file__).parent
LIBRARY = Path("binaries", "linux64", "BicycleTire.so")
GUID = "{8c4e810f-3df3-4a00-8276-176fa3c9f000}"
FORCE_1_CM, FORCE_2_CM = 550.9, 550.9 * 2**1.422


def unpacked(folder: Path, library: Path) -> Path:
    """Lay out an unpacked FMU of the slave plain_tire.py around a library."""
    resources = folder / "resources"
    resources.mkdir(parents=True)
    (folder / LIBRARY).parent.mkdir(parents=True)
    shutil.copy(library, folder / LIBRARY)
    shutil.copy(HERE / "plain_tire.py", resources)
    (resources / "slavemodule.txt").write_text("plain_tire\n")
    package = resources / "pythonfmu"
    package.mkdir()
    for module in Path(pythonfmu.__file__).parent.glob("*.py"):
        shutil.copy(module, package)
    return folder


def unpacked_archive(fmu: Path, folder: Path) -> Path:
    """Unpack an FMU into a folder."""
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    return folder


def guid_of(fmu: Path) -> str:
    """The GUID of an unpacked FMU, FMI 3.0's token; that of the slave plain_tire has no description."""
    description = fmu / "modelDescription.xml"
    if not description.is_file():
        return GUID
    root = ElementTree.parse(description).getroot()
    return root.get("guid") or root.get("instantiationToken", "")


def numbers(text: str) -> list[float]:
    """The numbers that the host printed, one a line."""
    return [float(line) for line in text.splitlines()]


@dataclass(frozen=True)
class Bench:
    """What is compiled once for all tests."""

    host: Path
    native: Path
    loader: Path
    fmu: Path

    def command(self, *mode: object, fmu: Path | None = None, uri: str | None = None) -> list[str]:
        """The words that run the C host on an FMU."""
        fmu = fmu or self.fmu
        uri = uri or f"file://{quote(str(fmu / 'resources'))}"
        return [str(self.host), str(fmu / LIBRARY), uri, guid_of(fmu), "0,1,2", *map(str, mode)]

    def attempt(
        self,
        *mode: object,
        fmu: Path | None = None,
        uri: str | None = None,
        environment: Mapping[str, str] | None = None,
        seconds: float = 120.0,
    ) -> subprocess.CompletedProcess[str]:
        """Run the C host, well or not; it is ended after so many seconds."""
        command = self.command(*mode, fmu=fmu, uri=uri)
        variables = {**os.environ, **(environment or {})}
        return subprocess.run(command, capture_output=True, text=True, timeout=seconds, env=variables)

    def run(
        self,
        *mode: object,
        fmu: Path | None = None,
        uri: str | None = None,
        environment: Mapping[str, str] | None = None,
        seconds: float = 120.0,
    ) -> str:
        """Run the C host, which must end well and complain of nothing; return what it printed."""
        result = self.attempt(*mode, fmu=fmu, uri=uri, environment=environment, seconds=seconds)
        if "no usable Python library" in result.stdout:
            pytest.skip(result.stdout)
        assert result.stderr == ""
        assert result.returncode == 0
        return result.stdout
