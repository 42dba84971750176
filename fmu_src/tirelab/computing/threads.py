"""Linear algebra in one thread: on the small matrices of a fit more threads cost CPU time and save none.

OpenBLAS starts a thread on every core, and each of them spins while it waits: a diagnosis of two recordings of 16 000
samples took 36 s of CPU with two threads and 18 s with one, at the same wall time.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit the linear algebra of numpy and scipy to one thread; also a decorator.

    The limit applies to the whole process. OpenBLAS may ignore it where it is set outside of the main thread: then
    the linear algebra has as many threads as before, and the same results.
    """
    # here, since only fits need them; scipy's library must be loaded, or it would not be found
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        yield
