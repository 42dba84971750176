"""Work on several processes and on a Dask cluster: what fails, or kills its process, stops nothing else."""

from __future__ import annotations

import os
import signal
import warnings
from typing import Any

import pytest
from tirelab.computing.workers import Cores, Done, work
from tirelab.errors import TirelabError


def reciprocal(number: float) -> float:
    if number == 13.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return 1.0 / number


def collected(cores: Cores, numbers: dict[str, float]) -> dict[str, Done[float]]:
    return {
        done.key: done for done in work(reciprocal, {k: (n,) for k, n in numbers.items()}, cores, "working")
    }


def test_an_exception_ends_its_own_task_only() -> None:
    found = collected(Cores(1), {"two": 2.0, "zero": 0.0, "four": 4.0})
    assert {key: done.value for key, done in found.items()} == {"two": 0.5, "zero": None, "four": 0.25}
    assert found["zero"].error is not None
    assert found["zero"].error.startswith("ZeroDivisionError")


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="a system without SIGKILL")
def test_a_process_that_dies_takes_nobody_along() -> None:
    numbers = {str(n): float(n) for n in (1, 2, 13, 4, 0, 8, 10, 16)}
    found = collected(Cores(2), numbers)
    assert {key: done.value for key, done in found.items()} == {
        key: None if key in ("13", "0") else 1.0 / n for key, n in numbers.items()
    }
    assert "ZeroDivisionError" in str(found["0"].error)
    assert "process died" in str(found["13"].error)


def test_a_dask_cluster_gives_the_same_answers(cluster: Any) -> None:
    numbers = {str(n): float(n) for n in range(6)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        there = collected(Cores(dask=cluster.scheduler_address), numbers)
    assert there == collected(Cores(1), numbers)


def test_a_cluster_that_does_not_answer_is_a_sentence() -> None:
    pytest.importorskip("distributed")
    with pytest.raises(TirelabError, match="no Dask cluster answers at"):
        collected(Cores(dask="not an address"), {"one": 1.0})


@pytest.mark.parametrize("arguments", [{"jobs": 0}, {"jobs": 2, "dask": "tcp://host:8786"}])
def test_where_to_work_is_said_once(arguments: dict[str, Any]) -> None:
    with pytest.raises(TirelabError):
        Cores(**arguments)
