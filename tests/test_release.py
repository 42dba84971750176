"""Wheel and source archive as a user gets them: built, installed into fresh environments, run without the checkout.

Needs a package registry. Interpreters are looked for as `python3.N` on the path, among those of pyenv, and in
TIRELAB_PYTHONS, a list of interpreters or of the folders that hold them; one that is not there is skipped.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from email.parser import Parser
from pathlib import Path
from typing import NamedTuple

import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

pytestmark = pytest.mark.slow

VERSIONS = ("3.10", "3.11", "3.12", "3.13")

CARRIED = (
    "tirelab/py.typed",
    "radialtire/py.typed",
    "bicycle_tire_fmu.py",
    "fmu_description.py",
    "tirelab/diagnosis/calibration.json",
    "tirelab/report/report.html.jinja",
    "tirelab/report/uplot/uPlot.iife.min.js",
    "tirelab/local_page/page.js",
    "tirelab/fmu/native/binaries/fmi2/x86_64-linux/BicycleTire.so",
    "tirelab/fmu/native/binaries/fmi2/x86_64-windows/BicycleTire.dll",
    "tirelab/fmu/native/binaries/fmi2/aarch64-darwin/BicycleTire.dylib",
    "tirelab/fmu/native/binaries/fmi3/x86_64-linux/BicycleTire.so",
)
"""Files without which an installed tirelab would fail at work, not at its start."""


class Built(NamedTuple):
    """The two archives of a release, and the files that they were made of."""

    tree: Path
    wheel: Path
    source: Path


def done(*words: str | Path, cwd: Path) -> str:
    """Run a program away from the checkout and return what it printed; it must succeed."""
    environment = {
        k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV")
    }
    ended = subprocess.run(
        list(map(str, words)),
        cwd=cwd,
        env={**environment, "PIP_NO_CACHE_DIR": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, f"{words}\n{ended.stdout[-2000:]}\n{ended.stderr[-4000:]}"
    return ended.stdout


@pytest.fixture(scope="module")
def built(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Built:
    """Source archive from the files that git knows, wheel from the source archive."""
    pytest.importorskip("build")
    folder = tmp_path_factory.mktemp("release")
    listed = done("git", "-C", repository, "ls-files", "-z", cwd=folder).split("\0")
    for name in filter(None, listed):
        if (repository / name).is_file():
            target = folder / "tree" / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(repository / name, target)
    done(sys.executable, "-m", "build", "--outdir", folder / "dist", folder / "tree", cwd=folder)
    (wheel,) = (folder / "dist").glob("*.whl")
    (source,) = (folder / "dist").glob("*.tar.gz")
    return Built(folder / "tree", wheel, source)


@pytest.fixture(scope="module")
def version(repository: Path) -> str:
    """The version, from the one place where it is written."""
    settings = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))
    return str(settings["project"]["version"])


def interpreter(version: str) -> Path | None:
    """Return an interpreter of a version, None where there is none."""
    if version == f"{sys.version_info.major}.{sys.version_info.minor}":
        return Path(sys.executable)
    name = f"python{version}"
    places = [Path(p) for p in os.environ.get("TIRELAB_PYTHONS", "").split(os.pathsep) if p]
    candidates = [p / name if p.is_dir() else p for p in places if p.is_dir() or p.name == name]
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    candidates += sorted(root.glob(f"versions/{version}*/bin/{name}"))
    candidates += [Path(which)] if (which := shutil.which(name)) else []
    return next((p for p in candidates if p.is_file() and _runs(p, version)), None)


def _runs(python: Path, version: str) -> bool:
    """Whether an interpreter is one: pyenv leaves scripts of that name for versions that are not chosen."""
    told = subprocess.run([python, "--version"], capture_output=True, text=True, check=False)
    return told.returncode == 0 and told.stdout.startswith(f"Python {version}.")


def installed(python: Path, archive: Path, folder: Path) -> Path:
    """Install an archive into a fresh environment, and return its interpreter."""
    done(python, "-m", "venv", "--without-pip", folder / "venv", cwd=folder)
    fresh = folder / "venv" / "bin" / "python"
    done(sys.executable, "-m", "pip", "--python", fresh, "install", "-q", archive, cwd=folder)
    return fresh


def works(python: Path, version: str, repository: Path, folder: Path) -> None:
    """Diagnose the example's recordings and pack both kinds of FMU with nothing of the checkout in reach."""
    shutil.copytree(repository / "examples" / "recordings" / "press", folder / "press")
    told = done(python, "-I", "-m", "tirelab", "--version", cwd=folder)
    assert told.split()[-1] == version
    words = ("diagnose", "press", "--out", "out", "--json", "--quiet")
    found = json.loads(done(python, "-I", "-m", "tirelab", *words, cwd=folder))
    assert "rate_independent_hysteresis" in [effect["name"] for effect in found["verdict"]["effects"]]
    for name in ("report.html", "tire.json", "BicycleTire.fmu", "diagnosis.json", "plots.csv"):
        assert (folder / "out" / name).stat().st_size > 100
    assert "uPlot" in (folder / "out" / "report.html").read_text(encoding="utf-8")
    words = ("build", "--native", "--tire", "out/tire.json", "--out", "native", "--json", "--quiet")
    assert json.loads(done(python, "-I", "-m", "tirelab", *words, cwd=folder))["binaries"]
    words = ("compare", "press/fast.csv", "--fmu", "native/BicycleTire.fmu", "--json", "--quiet")
    assert json.loads(done(python, "-I", "-m", "tirelab", *words, cwd=folder))["rmse"] < 10.0  # 6 N of noise
    where = done(
        python,
        "-I",
        "-c",
        "import tirelab, bicycle_tire_fmu as f; print(tirelab.__file__, f.__file__)",
        cwd=folder,
    )
    assert all(str(folder / "venv") in place for place in where.split())


def test_the_wheel_carries_all_that_it_reads(built: Built, version: str) -> None:
    with zipfile.ZipFile(built.wheel) as wheel:
        names = set(wheel.namelist())
        (metadata,) = (n for n in names if n.endswith(".dist-info/METADATA"))
        said = Parser().parsestr(wheel.read(metadata).decode())
    assert [name for name in CARRIED if name not in names] == []
    source = built.tree / "fmu_src"
    ours = {p.relative_to(source).as_posix() for p in source.rglob("*") if p.is_file()}
    wanted = {n for n in ours if ".egg-info" not in n}
    assert wanted <= names
    assert not [n for n in names if n not in wanted and ".dist-info/" not in n]
    assert said["Version"] == version
    assert said["Requires-Python"] == ">=3.10"
    assert built.wheel.name == f"tirelab-{version}-py3-none-any.whl"


def test_the_source_archive_holds_licence_readme_and_sources(built: Built, version: str) -> None:
    with tarfile.open(built.source) as archive:
        names = {n.partition("/")[2] for n in archive.getnames()}
    assert {"LICENSE", "README.md", "pyproject.toml"} <= names
    assert {f"fmu_src/{name}" for name in CARRIED} <= names


@pytest.mark.parametrize("python_version", VERSIONS)
def test_the_wheel_works(
    python_version: str, built: Built, version: str, repository: Path, tmp_path: Path
) -> None:
    python = interpreter(python_version)
    if python is None:
        pytest.skip(f"no python{python_version} on the path or in TIRELAB_PYTHONS")
    works(installed(python, built.wheel, tmp_path), version, repository, tmp_path)


@pytest.mark.parametrize("python_version", VERSIONS)
def test_what_it_needs_can_be_had_for_each_python(python_version: str, built: Built, tmp_path: Path) -> None:
    """The packages that it needs have wheels for each of them, whether or not that interpreter is here."""
    words = ("--dry-run", "-q", "--target", tmp_path, "--only-binary", ":all:", "--python-version")
    done(sys.executable, "-m", "pip", "install", *words, python_version, built.wheel, cwd=tmp_path)


def test_the_source_archive_installs(built: Built, version: str, tmp_path: Path) -> None:
    python = installed(Path(sys.executable), built.source, tmp_path)
    assert done(python, "-I", "-m", "tirelab", "--version", cwd=tmp_path).split()[-1] == version


def test_the_pages_words_install_and_uninstall(built: Built, version: str, tmp_path: Path) -> None:
    """The lines of the page, one after the other, in a fresh environment: from the files, by the wheel, and out."""
    page = (built.tree / "examples" / "docs" / "five_minutes.md").read_text(encoding="utf-8")
    section = page.partition("## Installation and removal")[2].partition("\n## ")[0]
    from_clone, by_wheel, out = re.findall(r"```sh\n(.*?)\n```", section, re.DOTALL)
    done(sys.executable, "-m", "venv", tmp_path / "venv", cwd=tmp_path)
    python = tmp_path / "venv" / "bin" / "python"
    for line in (from_clone, by_wheel):
        done("sh", "-c", f"export PATH={python.parent}:$PATH; {line}", cwd=built.tree)
        assert done(python, "-I", "-m", "tirelab", "--version", cwd=tmp_path).split()[-1] == version
        done("sh", "-c", f"export PATH={python.parent}:$PATH; {out}", cwd=built.tree)
        assert "tirelab" not in done(python, "-m", "pip", "list", cwd=tmp_path)
