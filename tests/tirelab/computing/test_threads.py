"""One thread for linear algebra, and as many as before when it is over."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import numpy as np
import pytest
import scipy.linalg
from threadpoolctl import threadpool_info, threadpool_limits
from tirelab.computing.threads import one_thread


def threads() -> set[int]:
    """Numbers of threads of the libraries that are loaded."""
    return {library["num_threads"] for library in threadpool_info()}


@pytest.fixture(autouse=True)
def two_threads() -> Iterator[None]:
    """Two threads before each test, whatever the environment says."""
    scipy.linalg.inv(np.linalg.inv(np.eye(3)))
    with threadpool_limits(limits=2):
        if threads() != {2}:
            pytest.skip("the linear algebra of this machine has no second thread")
        yield


def test_the_libraries_of_numpy_and_scipy_are_found() -> None:
    # an older threadpoolctl finds none of them, and would limit nothing
    assert len(threadpool_info()) >= 2


def test_within_there_is_one_thread_and_afterwards_there_are_two() -> None:
    with one_thread():
        assert threads() == {1}
    assert threads() == {2}


def test_an_error_ends_it() -> None:
    with pytest.raises(ZeroDivisionError), one_thread():
        raise ZeroDivisionError
    assert threads() == {2}


def test_it_may_be_asked_for_within_itself() -> None:
    with one_thread():
        with one_thread():
            pass
        assert threads() == {1}
    assert threads() == {2}


def test_a_function_can_have_it() -> None:
    assert one_thread()(threads)() == {1}
    assert one_thread()(threads)() == {1}
    assert threads() == {2}


def test_outside_of_the_main_thread_it_leaves_no_limit_behind() -> None:
    done: list[bool] = []

    def work() -> None:
        with one_thread():
            done.append(bool(np.isclose(np.linalg.det(np.eye(50)), 1.0)))

    worker = threading.Thread(target=work)
    worker.start()
    worker.join(10.0)
    assert done == [True]
    assert threads() == {2}


def test_a_product_of_matrices_is_the_same() -> None:
    # integers below 2^53 have no rounding, in whatever order they are summed
    random = np.random.default_rng(0)
    a, b = random.integers(-1000, 1000, (2, 300, 300)).astype(float)
    with one_thread():
        product = a @ b
    assert np.array_equal(product, a.astype(np.int64) @ b.astype(np.int64))
