"""Makes what is shipped: the kernel's C, and the binaries of the native FMU for five platforms and two versions of FMI.

    python -m tirelab.fmu.native.make

It takes ziglang (the extra `loader`), half a minute for a platform the first time, and writes beside this file. The
same sources and the same ziglang give the same bytes in any folder; a test compares them with what is shipped.
`binaries/made_from.json` keeps the version of ziglang, for another one may give other bytes, and the sources' hash.
"""

from __future__ import annotations

import hashlib
import importlib.util
import itertools
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from ...errors import TirelabError
from .kernel import sources

HERE = Path(__file__).parent
BINARIES = HERE / "binaries"
MADE_FROM = BINARIES / "made_from.json"
MODEL = "BicycleTire"
VERSIONS = (2, 3)
"""The versions of FMI, each with binaries of its own: they differ by one file, which is the interface."""

HEADERS = (HERE.parent / "fmi2.h", HERE.parent / "fmi2_states.h", *sorted(HERE.glob("*.h")))
"""The first two belong to the Python FMU's loader too."""

FLAGS = ("-std=c99", "-shared", "-ffp-contract=off", "-fvisibility=hidden", "-s", "-Wall", "-Werror")
"""No contraction of a product and a sum into one rounding: the numbers are those of Python."""


@dataclass(frozen=True)
class Platform:
    """One platform: its names in FMI 2 and FMI 3, the target of ziglang, the library's ending, its flags."""

    fmi2: str
    fmi3: str
    target: str
    ending: str
    flags: tuple[str, ...]
    more: str | None = None
    """A C file beside the sources that this binary needs."""

    def folder(self, fmi: int) -> str:
        """Return the name of its folder in an FMU of a version of FMI."""
        return self.fmi3 if fmi == 3 else self.fmi2

    def library(self, fmi: int) -> Path:
        """Return where its binary for a version of FMI is kept."""
        return BINARIES / f"fmi{fmi}" / self.fmi3 / f"{MODEL}.{self.ending}"


_NO_TABLES = ("-fno-asynchronous-unwind-tables", "-fno-unwind-tables")
_ELF = ("-fPIC", *_NO_TABLES, "-Wl,--build-id=none", "-lm")
_SMALL = ("-Os", "-Xclang", "-Oz")
"""For size: five platforms go into one FMU, and the most used one is compiled for speed."""

_FAST = ("-O2", "-fno-unroll-loops", "-mllvm", "-inline-threshold=25")
"""As fast as a plain -O2, and a sixth smaller."""

_MACH_O = ("-fPIC", *_SMALL, *_NO_TABLES, f"-Wl,-install_name,@rpath/{MODEL}.dylib")
_WINDOWS = (*_SMALL, "-rtlib=none")
"""Without ziglang's own library of the compiler: exp, log, sin, cos come from Windows, as pow does."""

PLATFORMS = (
    Platform("linux64", "x86_64-linux", "x86_64-linux-gnu.2.17", "so", (*_FAST, *_ELF)),
    Platform("aarch64-linux", "aarch64-linux", "aarch64-linux-gnu.2.17", "so", (*_SMALL, *_ELF)),
    Platform("win64", "x86_64-windows", "x86_64-windows-gnu", "dll", _WINDOWS, "windows_stack.c"),
    Platform("darwin64", "x86_64-darwin", "x86_64-macos.11.0", "dylib", _MACH_O),
    Platform("aarch64-darwin", "aarch64-darwin", "aarch64-macos.11.0", "dylib", _MACH_O),
)


def c_files(fmi: int) -> tuple[str, ...]:
    """Return the names of the C sources for a version of FMI."""
    return ("kernel.c", "tire.c", "instance.c", f"fmi{fmi}.c")


def source_files(fmi: int) -> dict[str, bytes]:
    """Return every C source and header for a version of FMI, by its name."""
    paths = [*(HERE / name for name in c_files(fmi)), *HEADERS]
    return {path.name: path.read_bytes() for path in sorted(paths, key=lambda path: path.name)}


def made_from() -> dict[str, str]:
    """Return the version of ziglang that is installed, and the SHA-256 of all that the binaries are made of."""
    digest = hashlib.sha256()
    for fmi in VERSIONS:
        for name, content in source_files(fmi).items():
            digest.update(f"{fmi} {name} {len(content)}\n".encode() + content)
    for platform in PLATFORMS:
        own = (HERE / platform.more).read_bytes() if platform.more else b""
        digest.update(repr((platform, FLAGS, len(own))).encode() + own)
    return {"ziglang": metadata.version("ziglang"), "sources": digest.hexdigest()}


def write_kernel(folder: Path = HERE) -> None:
    """Translate the kernel."""
    for name, text in sources().items():
        (folder / name).write_text(text, encoding="utf-8")


def compile_for(platform: Platform, fmi: int, destination: Path, cache: Path | None = None) -> None:
    """Compile the binary of one platform and version of FMI; raises TirelabError where ziglang cannot do that."""
    if importlib.util.find_spec("ziglang") is None:
        raise TirelabError("ziglang is not installed; python -m pip install 'tirelab[loader]'")
    with tempfile.TemporaryDirectory(prefix="tirelab_") as name:
        work = Path(name)
        for file, content in source_files(fmi).items():
            (work / file).write_bytes(content)
        if platform.more:
            shutil.copy(HERE / platform.more, work)
        kept = str(cache or work / "cache")
        environment = {"ZIG_GLOBAL_CACHE_DIR": kept, "ZIG_LOCAL_CACHE_DIR": kept, **os.environ}
        library = f"{MODEL}.{platform.ending}"
        command = [sys.executable, "-m", "ziglang", "cc", "-target", platform.target, *FLAGS, "-o", library]
        done = subprocess.run(
            [*command, *c_files(fmi), *filter(None, [platform.more]), *platform.flags],
            cwd=work,
            env=environment,
            capture_output=True,
            text=True,
        )
        if done.returncode:
            raise TirelabError(
                f"ziglang cannot compile the binary for {platform.fmi3}: {done.stderr.strip()}"
            )
        destination.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(work / library, destination)


def main(words: Sequence[str]) -> None:
    """Write the kernel and the binaries; `words` are platforms in FMI 3's names, all where there is none."""
    write_kernel()
    with tempfile.TemporaryDirectory(prefix="tirelab_") as cache:  # ziglang makes a platform's C library once
        for platform, fmi in itertools.product(PLATFORMS, VERSIONS):
            if not words or platform.fmi3 in words:
                library = platform.library(fmi)
                compile_for(platform, fmi, library, Path(cache))
                print(f"{library}: {library.stat().st_size} bytes", flush=True)
    if not words:
        MADE_FROM.write_text(json.dumps(made_from(), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
