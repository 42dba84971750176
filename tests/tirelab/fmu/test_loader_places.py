"""Where the FMU's Linux binary finds its resources and its Python, and what it says when it finds none."""

import os
import re
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Mapping
from pathlib import Path
from urllib.parse import quote

import pytest
from loader_bench import FORCE_1_CM, Bench, numbers, unpacked
from tirelab.fmu.loader import Compiler


@pytest.mark.parametrize("locale", ["C", "C.UTF-8"])
@pytest.mark.parametrize(
    "write",
    [
        lambda path: f"file://{quote(path)}",
        lambda path: f"file:{quote(path).replace('%C3%A4', '%c3%a4')}",
        lambda path: f"FILE://localhost{quote(path)}/",
        lambda path: f"file://{path}",
        lambda path: path,
        lambda path: "-",
    ],
    ids=["uri", "short uri", "localhost", "unencoded uri", "path", "none"],
)
def test_any_folder_and_any_way_to_write_it(
    bench: Bench, tmp_path: Path, write: Callable[[str], str], locale: str
) -> None:
    folder = unpacked(tmp_path / "ä #" / "50%20 %zz+;", bench.loader)
    text = bench.run(
        "run", 0.01, fmu=folder, uri=write(str(folder / "resources")), environment={"LC_ALL": locale}
    )
    assert numbers(text) == pytest.approx([FORCE_1_CM] * 2, rel=1e-15)


@pytest.mark.parametrize(
    "uri", ["file:///nowhere/100%25", "file://elsewhere/resources", "/nowhere/%", "file:"]
)
def test_a_wrong_folder_is_refused(bench: Bench, uri: str) -> None:
    result = bench.attempt("run", 0.01, uri=uri)
    assert result.returncode == 1
    assert result.stdout == (
        "[tire, 3, logStatusError] fmi2Instantiate: FileNotFoundError: "
        f"no slavemodule.txt in the resource location {uri!r}\n"
    )


def ask_slave(bench: Bench, folder: Path, expression: str, environment: Mapping[str, str]) -> str:
    """Let the slave say in a message what an expression is in its interpreter."""
    fmu = unpacked(folder, bench.loader)
    module = fmu / "resources" / "plain_tire.py"
    said = f"self.log(repr({expression}), Fmi2Status.warning)"
    text = module.read_text().replace('self.log(f"100 % made from {self.resources}")', f"import sys; {said}")
    module.write_text(text)
    return bench.run("cycles", 1, fmu=fmu, environment=environment).splitlines()[0].partition("] ")[2]


def shared_library() -> Path | None:
    """The libpython of the running interpreter, if it has one."""
    name = f"libpython{sys.version_info[0]}.{sys.version_info[1]}.so.1.0"
    folders = [sysconfig.get_config_var("LIBDIR") or "", os.path.join(sys.base_prefix, "lib")]
    return next((Path(folder, name) for folder in folders if Path(folder, name).exists()), None)


needs_libpython = pytest.mark.skipif(shared_library() is None, reason="this Python has no shared library")


@needs_libpython
def test_the_virtual_environment_comes_first(bench: Bench, tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "ä v"], check=True)
    environment = {"VIRTUAL_ENV": str(tmp_path / "ä v"), "TIRELAB_LIBPYTHON": ""}
    said = ask_slave(bench, tmp_path / "fmu", "(sys.prefix, sys.base_prefix)", environment)
    assert said == repr((str(tmp_path / "ä v"), sys.base_prefix))


@needs_libpython
def test_a_library_that_is_named_explicitly(bench: Bench, tmp_path: Path) -> None:
    """Its standard library is found in spite of PYTHONHOME, and file names are UTF-8 whatever the locale."""
    environment = {
        "TIRELAB_LIBPYTHON": str(shared_library()),
        "PYTHONHOME": "/nowhere",
        "LC_ALL": "C",
        "PATH": "",
    }
    expression = "(sys.base_prefix, sys.getfilesystemencoding(), __import__('json').__name__)"
    said = ask_slave(bench, tmp_path / "fmu", expression, environment)
    assert said == repr((sys.base_prefix, "utf-8", "json"))


REFUSED = r"\[tire, 3, logStatusError\] no usable Python library among "
ADVICE = r"; install Python 3\.10 or newer .*, or set TIRELAB_LIBPYTHON to .*\n"


def test_a_named_library_that_is_none_is_refused(bench: Bench) -> None:
    result = bench.attempt("run", 0.01, environment={"TIRELAB_LIBPYTHON": "/nowhere/100%/libpython.so"})
    assert result.returncode == 1
    tried = r"TIRELAB_LIBPYTHON=/nowhere/100%/libpython\.so \(.*cannot open shared object file.*\)"
    assert re.fullmatch(REFUSED + tried + ADVICE, result.stdout)


def test_a_python_that_is_too_old_is_refused(bench: Bench, compiler: Compiler, tmp_path: Path) -> None:
    """The tire needs Python 3.10; the library tells its version and nothing else."""
    source, library = tmp_path / "old.c", tmp_path / "libpython3.9.so.1.0"
    source.write_text('const char *Py_GetVersion(void) { return "3.9.18"; }\n')
    subprocess.run([*compiler.command, "-shared", "-fPIC", "-o", library, source], check=True)
    result = bench.attempt("run", 0.01, environment={"TIRELAB_LIBPYTHON": str(library)})
    assert result.returncode == 1
    tried = rf"TIRELAB_LIBPYTHON={re.escape(str(library))} \(not Python 3\.10 or newer\)"
    assert re.fullmatch(REFUSED + tried + ADVICE, result.stdout)


def test_without_any_python_one_sentence_tells_what_was_tried(bench: Bench, tmp_path: Path) -> None:
    program = tmp_path / "python3"
    program.write_text("#!/bin/sh\necho; echo /opt/static/python3\n")
    program.chmod(0o755)
    for minor in range(10, 16):
        (tmp_path / f"libpython3.{minor}.so.1.0").write_text("no library")
    folder = str(tmp_path)
    environment = {
        "PATH": folder,
        "LD_LIBRARY_PATH": folder,
        "VIRTUAL_ENV": "/nowhere",
        "TIRELAB_LIBPYTHON": "",
    }
    result = bench.attempt("run", 0.01, environment=environment)
    assert result.returncode == 1
    tried = (
        r'TIRELAB_LIBPYTHON \(not set\), "\$VIRTUAL_ENV/bin/python" \(none, or too old\), '
        r"python3 \(without shared library: /opt/static/python3\), "
        r"python \(none, or too old\), the system's libpython3\.10 to 3\.15"
    )
    assert re.fullmatch(REFUSED + tried + ADVICE, result.stdout)
