"""One diagnosis in a process of its own, which says its stages line by line and can be interrupted."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ..errors import TirelabError
from .store import Upload


@dataclass(frozen=True)
class Order:
    """What is to be diagnosed: files, their names, the baseline's file or None for the article's, the folder."""

    fitted: tuple[str, ...]
    held_out: tuple[str, ...]
    names: tuple[tuple[str, str], ...]
    tire: str | None
    out: str

    @classmethod
    def of(cls, uploads: Sequence[Upload], tire: Path | None, out: Path) -> Order:
        """Return the order for uploads as they are used. Raises TirelabError where none is to be fitted."""
        fitted = tuple(str(u.file) for u in uploads if u.use == "fitted")
        if not fitted:
            raise TirelabError('no recording is to be fitted; drop one, or set one to "fitted"')
        return cls(
            fitted,
            tuple(str(u.file) for u in uploads if u.use == "held-out"),
            tuple((str(u.file), u.name) for u in uploads),
            None if tire is None else str(tire),
            str(out),
        )


class Job:
    """A diagnosis that runs: its stages so far, and in the end what went wrong, or nothing."""

    def __init__(self, order: Order, ended: Callable[[], None] = lambda: None) -> None:
        self.stages: list[str] = []
        self.problem: str | None = None
        self.done = False
        self._ended = ended
        self._names = {Path(file).name: name for file, name in order.names}
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            encoding="utf-8",
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(order.__dict__))
        self._process.stdin.close()
        self._thread = threading.Thread(target=self._listen, args=(self._process.stdout,), daemon=True)
        self._thread.start()

    @property
    def running(self) -> bool:
        """Whether it still works."""
        return self._thread.is_alive()

    def stop(self) -> None:
        """Interrupt it, as Ctrl-C does: what it had begun to write is taken away."""
        self.problem = self.problem or "stopped"
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM if sys.platform == "win32" else signal.SIGINT)

    def kill(self) -> None:
        """End it at once where it does not listen."""
        if self._process.poll() is None:
            self._process.kill()

    def wait(self, seconds: float) -> None:
        """Wait until it has ended, so many seconds at most."""
        self._thread.join(seconds)

    def _named(self, sentence: str) -> str:
        """Return a sentence in which each file has the user's name for it."""
        files = "|".join(map(re.escape, self._names))
        return re.sub(rf"\b(?:{files})\b", lambda found: self._names[found[0]], sentence)

    def _listen(self, lines: IO[str]) -> None:
        for line in lines:
            said = json.loads(line)
            if "stage" in said:
                self.stages.append(self._named(said["stage"]))
            elif "problem" in said:
                self.problem = self.problem or self._named(said["problem"])
            else:
                self.done = True
        self._process.wait()
        lines.close()
        if not self.done and self.problem is None:
            self.problem = "the diagnosis ended without an answer; run tirelab diagnose on the same files"
        self._ended()


def main() -> None:
    """Do the order on standard input; say each stage, and the end, as a line of JSON."""

    def say(**what: str | bool) -> None:
        print(json.dumps(what), flush=True)

    # A shell starts what runs in the background deaf to Ctrl-C, and its children too.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    order = Order(**json.loads(sys.stdin.read()))
    try:
        from ..diagnosis.diagnosis_run import run_diagnosis

        run_diagnosis(
            [Path(file) for file in order.fitted],
            Path(order.out),
            tire=None if order.tire is None else Path(order.tire),
            held_out=[Path(file) for file in order.held_out],
            progress=lambda sentence: say(stage=sentence),
        )
    except (TirelabError, ValueError) as error:
        say(problem=str(error))
    except KeyboardInterrupt:
        say(problem="stopped")
    else:
        say(done=True)


if __name__ == "__main__":
    main()
