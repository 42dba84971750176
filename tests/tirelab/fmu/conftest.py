"""FMUs and the hosts that run them, each host in a fresh process without the project."""

from __future__ import annotations

import json
import os
import subprocess
import sys
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


def run_host(script: str, *arguments: Any, job: Any, timeout: float = 120.0) -> str:
    """Run a host script in isolation and return what it printed; its failure is the test's."""
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


def run_fmpy(fmus: list[Path], calls: list[list[Any]]) -> list[Any]:
    """Run the calls on instances of the FMUs in one fresh process and return their answers."""
    answers = json.loads(run_host("with_fmpy.py", job={"fmus": list(map(str, fmus)), "calls": calls}))
    assert isinstance(answers, list)
    return answers
