"""FMUs and the hosts that run them, each host in a fresh process without the project."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from radialtire import TireModel
from tirelab.fmu.build import build_fmu

HOSTS = Path(__file__).parent / "hosts"


@pytest.fixture(scope="session")
def article_fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the article's tire, with the loader where there is a compiler."""
    return build_fmu(TireModel(), tmp_path_factory.mktemp("article")).path


@pytest.fixture(scope="session")
def run_host() -> Callable[..., str]:
    """Runs a host script in isolation and returns what it printed; its failure is the test's."""
    return _run_host


@pytest.fixture(scope="session")
def run_fmpy() -> Callable[[list[Path], list[list[Any]]], list[Any]]:
    """Runs calls on instances of FMUs in one fresh process with fmpy and returns their answers."""

    def run(fmus: list[Path], calls: list[list[Any]]) -> list[Any]:
        answers = json.loads(_run_host("with_fmpy.py", job={"fmus": list(map(str, fmus)), "calls": calls}))
        assert isinstance(answers, list)
        return answers

    return run


def _run_host(script: str, *arguments: Any, job: Any, timeout: float = 120.0) -> str:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    # The oneTBB that ecospy needs is installed beside the interpreter, where the linker does not look.
    environment["LD_LIBRARY_PATH"] = str(Path(sys.prefix) / "lib")
    result = subprocess.run(
        [sys.executable, "-I", str(HOSTS / script), *map(str, arguments)],
        input=json.dumps(job),
        capture_output=True,
        text=True,
        env=environment,
        timeout=timeout,
        check=False,
    )
    assert result.returncode == 0, f"{script} exited with {result.returncode}:\n{result.stderr}"
    return result.stdout
