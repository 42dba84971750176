"""Many tasks on all cores or on a Dask cluster; one that fails, or kills its process, stops no other.

Reference: joblib, `Parallel` with `return_as="generator_unordered"`; its Dask backend, distributed.Client.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import joblib
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from ..errors import TirelabError, missing_library

Value = TypeVar("Value")

TASKS_PER_PROCESS = 2
"""Tasks dispatched for each process: one is running, the others wait."""


@dataclass(frozen=True)
class Cores:
    """Where tasks run: in `jobs` processes of this machine (1: in this one), or on the Dask cluster at `dask`.

    quiet: whether no progress is shown, in a terminal either

    The workers of a cluster must see the same folders under the same names as this machine.
    """

    jobs: int | None = None
    dask: str | None = None
    quiet: bool = False

    def __post_init__(self) -> None:
        if self.jobs is not None and self.jobs < 1:
            raise TirelabError(f"--jobs {self.jobs} is not allowed; give 1 or more processes")
        if self.jobs is not None and self.dask is not None:
            raise TirelabError("--jobs and --dask exclude each other; give one of them")

    @property
    def processes(self) -> int:
        """Number of tasks that run at once on this machine."""
        return self.jobs or joblib.cpu_count()


@dataclass(frozen=True)
class Done(Generic[Value]):
    """A task that ended: its key, and its value or the error that ended it."""

    key: str
    value: Value | None
    error: str | None


def work(
    function: Callable[..., Value], tasks: Mapping[str, tuple[Any, ...]], cores: Cores, title: str
) -> Iterator[Done[Value]]:
    """Yield what `function(*arguments)` gives for every key of `tasks`, in the order in which they end.

    Shows a progress bar named `title` on a terminal. An exception ends its own task only. Where a process dies, the
    tasks that it may have held are run again one by one, and only those whose process dies again fail.
    Raises TirelabError where the Dask cluster cannot be reached.
    """
    deaths = _deaths(cores)
    with _progress(cores.quiet) as bar, _backend(cores) as parallel:
        row = bar.add_task(title, total=len(tasks))
        left = dict(tasks)
        while left:
            try:
                for done in parallel(function, dict(left)):
                    del left[done.key]
                    bar.advance(row)
                    yield done
            except deaths:
                suspects = list(left)[: TASKS_PER_PROCESS * cores.processes]
                for key in suspects:
                    yield _alone(function, key, left.pop(key), parallel, deaths)
                    bar.advance(row)


_Parallel = Callable[[Callable[..., Any], Mapping[str, tuple[Any, ...]]], Iterator[Done[Any]]]


def _alone(
    function: Callable[..., Value],
    key: str,
    arguments: tuple[Any, ...],
    parallel: _Parallel,
    deaths: tuple[type[Exception], ...],
) -> Done[Value]:
    try:
        return next(iter(parallel(function, {key: arguments})))
    except deaths as death:
        return Done(
            key, None, f"its process died ({type(death).__name__}): out of memory, or a crash in native code"
        )


def _deaths(cores: Cores) -> tuple[type[Exception], ...]:
    """Exceptions that are raised where a process dies."""
    from joblib.externals.loky.process_executor import BrokenProcessPool

    if cores.dask is None:
        return (BrokenProcessPool,)
    try:
        from distributed import KilledWorker  # here: the import takes half a second
    except ImportError:
        raise TirelabError(missing_library("--dask", "Dask", "'dask[distributed]'")) from None
    return (BrokenProcessPool, KilledWorker)


@contextmanager
def _backend(cores: Cores) -> Iterator[_Parallel]:
    if cores.dask is None and cores.processes == 1:
        yield _in_this_process
        return
    # joblib replaces a process that grew large and warns of it; no task is lost
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs", category=UserWarning)
    with _client(cores.dask) if cores.dask else joblib.parallel_config("loky", inner_max_num_threads=1):

        def parallel(
            function: Callable[..., Any], tasks: Mapping[str, tuple[Any, ...]]
        ) -> Iterator[Done[Any]]:
            pool = joblib.Parallel(
                n_jobs=-1 if cores.dask else max(cores.processes, 2),
                batch_size=1,
                pre_dispatch=f"{TASKS_PER_PROCESS}*n_jobs",
                return_as="generator_unordered",
            )
            return iter(pool(joblib.delayed(_guarded)(function, key, a) for key, a in tasks.items()))

        yield parallel


def _in_this_process(
    function: Callable[..., Any], tasks: Mapping[str, tuple[Any, ...]]
) -> Iterator[Done[Any]]:
    for key, arguments in tasks.items():
        yield _guarded(function, key, arguments)


def _guarded(function: Callable[..., Any], key: str, arguments: tuple[Any, ...]) -> Done[Any]:
    try:
        return Done(key, function(*arguments), None)
    except Exception as error:
        return Done(key, None, f"{type(error).__name__}: {error}")


@contextmanager
def _client(address: str) -> Iterator[None]:
    from distributed import Client

    try:
        client = Client(address, timeout=10)
    except (OSError, ValueError) as error:
        raise TirelabError(f"no Dask cluster answers at {address} ({error}); check the address") from None
    with client, joblib.parallel_config("dask"):
        yield


def _progress(quiet: bool) -> Progress:
    console = Console(stderr=True)
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
        disable=quiet or not console.is_terminal,
    )
