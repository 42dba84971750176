"""Compiles the FMU's Linux binary, loader.c, with whatever C compiler there is.

ziglang takes some seconds, so what it made is kept: it brings its own headers and libraries, and makes the same bytes
of the same sources anywhere. The machine's own compiler is quick, and its output depends on more than can be known.
"""

import hashlib
import importlib.metadata
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from ..errors import TirelabError
from ..simulation.cache_folder import keep, private_folder

SOURCES = ("loader.c", "interpreter.c")
OLDEST_GLIBC = "2.17"
"""RHEL 7 and manylinux2014: older than any Linux that has Python 3.9 packages."""

NO_COMPILER = (
    "There is no C compiler for Linux on x86-64 here, so on Linux the FMU will work only in tools that are "
    "Python themselves: install one with `python -m pip install ziglang`, or a cc, and build again."
)
"""The sentence for the user when `compile_loader` returns None."""

_SWAYS = ("C_INCLUDE_PATH", "CPATH", "LIBRARY_PATH", "SOURCE_DATE_EPOCH", "ZIG_LIB_DIR")
"""Environment variables that change what ziglang makes."""

# No build id, paths or symbols: one compiler makes the same bytes of the same source, wherever it lies.
_FLAGS = ("-std=c11", "-O2", "-shared", "-fPIC", "-pthread", "-s", "-Wl,--build-id=none")


@dataclass(frozen=True)
class Compiler:
    """A C compiler that makes libraries for Linux on x86-64."""

    name: str
    """What to call it, with its version if known."""
    command: tuple[str, ...]
    """The words of its command, before those of the task."""
    glibc: str | None
    """The oldest C library on which its libraries run; None means the one of this machine."""


def find_compiler() -> Compiler | None:
    """Choose ziglang, if it is installed for the running Python, else the machine's $CC, cc, gcc or clang."""
    if importlib.util.find_spec("ziglang") is not None:
        command = (sys.executable, "-m", "ziglang", "cc", "-target", f"x86_64-linux-gnu.{OLDEST_GLIBC}")
        return Compiler(f"ziglang {importlib.metadata.version('ziglang')}", command, OLDEST_GLIBC)
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        return None
    for candidate in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        words = shlex.split(candidate)
        if words and shutil.which(words[0]):
            return Compiler(candidate, tuple(words), None)
    return None


def compile_loader(destination: Path, compiler: Compiler | None = None) -> Compiler | None:
    """Compile loader.c into the library `destination`, and say what compiled it.

    The machine's own compiler counts on Linux on x86-64 only; ziglang makes the library on any machine, and where it
    has made it before, that is taken.

    Parameters
    ----------
    destination
        The file to write, such as `binaries/linux64/BicycleTire.so`; its folder must exist.
    compiler
        The compiler to use; by default the one of `find_compiler`.

    Returns
    -------
    The compiler, or None when there is none (then nothing is written; `NO_COMPILER` says what to do).

    Raises
    ------
    TirelabError
        When the compiler fails, with its first error.
    """
    compiler = compiler or find_compiler()
    if compiler is None:
        return None
    kept = _kept(compiler)
    if kept is not None and kept.is_file():
        shutil.copyfile(kept, destination)
        return compiler
    command = [*compiler.command, *_FLAGS, "-o", str(destination.resolve()), *SOURCES, "-ldl"]
    with tempfile.TemporaryDirectory(prefix="tirelab_") as cache:
        # ziglang would otherwise leave some 50 MB in the user's home.
        environment = {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache, **os.environ}
        folder = Path(__file__).parent
        try:
            result = subprocess.run(command, cwd=folder, env=environment, capture_output=True)
        except OSError as error:
            raise TirelabError(f"The C compiler {compiler.name} cannot be run: {error}.") from None
    if result.returncode:
        lines = result.stderr.decode(errors="replace").strip().splitlines()
        lines.append(f"exit status {result.returncode}")
        first = next((line for line in lines if "error" in line), lines[0]).strip()
        raise TirelabError(f"The C compiler {compiler.name} cannot compile the FMU's Linux binary: {first}")
    if kept is not None:
        keep(kept, destination.read_bytes())
    return compiler


def _kept(compiler: Compiler) -> Path | None:
    """Return where the library that `compiler` makes is kept, there or not yet, or None where it is not."""
    folder = private_folder("loader") if compiler.glibc is not None else None
    if folder is None:
        return None
    here = Path(__file__).parent
    digest = hashlib.sha256()
    for path in sorted([*here.glob("*.c"), *here.glob("*.h")]):
        digest.update(path.name.encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    sways = [f"{name}={os.environ.get(name)}" for name in _SWAYS]
    digest.update("\0".join([compiler.name, *compiler.command, *_FLAGS, *SOURCES, *sways]).encode())
    return folder / f"{digest.hexdigest()[:32]}.so"
