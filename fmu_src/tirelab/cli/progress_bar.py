"""The live line of a command in a terminal: its stage, how far it is, the time spent and the time left."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    SpinnerColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text

EARLY = 0.04
"""Before this part of the work nothing is said of the time left: too little of it is known."""


class TimeLeft(ProgressColumn):
    """The time left, from the time spent when the present stage began and its part of the whole."""

    def render(self, task: Task) -> Text:
        """Return "about 20 s left", or nothing where it is too early to say."""
        return Text(time_left(task.completed, task.fields["since"], time.monotonic() - task.fields["began"]))


def time_left(done: float, spent: float, now: float) -> str:
    """Return the time left in words.

    done: part of the work before the present stage, 0 to 1; spent [s]: until that stage; now [s]: since the start
    """
    if done < EARLY:
        return ""
    left = max(spent / done - now, 0.0)
    return f"about {left:.0f} s left" if left < 90.0 else f"about {left / 60.0:.0f} min left"


@contextmanager
def live(console: Console, shares: Mapping[str, float]) -> Iterator[Callable[[str], None]]:
    """Give a function that shows a stage. shares: as for `output.progress`."""
    columns = [SpinnerColumn(), TextColumn("{task.description}", markup=False)]
    if shares:
        columns += [BarColumn(bar_width=20), TimeElapsedColumn(), TimeLeft()]
    else:
        columns += [TimeElapsedColumn()]
    start = time.monotonic()
    with Progress(*columns, console=console, transient=True) as shown:
        task = shown.add_task("starting", total=1.0 if shares else None, began=start, since=0.0)

        def show(sentence: str) -> None:
            done = next((part for begin, part in shares.items() if sentence.startswith(begin)), None)
            if done is None:
                shown.update(task, description=sentence)
            else:
                shown.update(task, description=sentence, completed=done, since=time.monotonic() - start)

        yield show
