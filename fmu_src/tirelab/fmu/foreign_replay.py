"""Anybody's FMU on a recording: its force for the recorded deflection, from a process that can be ended.

An FMU is native code that runs with the rights of whoever starts it. The process keeps its crashes, its hangs and its
output apart from ours; it does not confine it.
"""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray
from radialtire import FLAT_RADIUS

from ..errors import TirelabError
from ..simulation.channels import Sampled
from .foreign import ForeignFmu
from .unpacking import unpack

EVEN = 1e-6
"""Part of an interval by which steps of one length may differ: an FMU that takes no others cannot tell."""

SILENT = "it said nothing"

FloatArray = NDArray[np.float64]
Progress = Callable[[str], None]


def native_code(fmu: ForeignFmu) -> str:
    """Return what is said before an FMU is loaded."""
    return f"{fmu.path} is native code: it now runs in a process of its own, with your rights"


def replay_foreign(
    fmu: ForeignFmu, motion: Sampled, name: str, timeout: float, progress: Progress
) -> FloatArray:
    """Return the FMU's force [N] at every sample of `motion`, compression positive.

    name: of the recording, for messages; timeout [s]: after which the FMU is ended
    An FMU that takes steps of one length only gets even ones; its force is interpolated to uneven times.
    Raises TirelabError with the FMU's last message where it fails, crashes or takes longer.
    """
    even = _evened(fmu, motion.time)
    inputs = {fmu.deflection: motion.deflection}
    if fmu.radius is not None:
        inputs[fmu.radius] = np.clip(motion.surface_radius, -FLAT_RADIUS, FLAT_RADIUS)
    columns = [_at(even, motion.time, values) / terminal.factor for terminal, values in inputs.items()]
    table = np.column_stack([even, *columns])
    job = {
        "kind": fmu.kind,
        "version": fmu.version,
        "inputs": {terminal.name: terminal.reference for terminal in inputs},
        "output": fmu.force.reference,
    }
    with tempfile.TemporaryDirectory(prefix="tirelab_", ignore_cleanup_errors=True) as folder:
        place = Path(folder)
        unpack(fmu.path, place / "fmu")
        (place / "job.json").write_text(json.dumps(job), encoding="utf-8")
        np.save(place / "inputs.npy", table)
        _followed(_Watch(fmu.path, name, len(table), timeout, progress), place)
        force = np.load(place / "force.npy", allow_pickle=False) * fmu.force.factor
    if not np.all(np.isfinite(force)):
        row = int(np.flatnonzero(~np.isfinite(force))[0])
        raise TirelabError(
            f"{fmu.path} gives no number for {name} at {even[row]:g} s; check what it needs as inputs"
        )
    return np.asarray(np.interp(motion.time, even, force), dtype=float)


def _evened(fmu: ForeignFmu, times: FloatArray) -> FloatArray:
    """Return times [s] of even steps where the FMU needs them."""
    steps = np.diff(times)
    step = float(np.median(steps))
    if not fmu.even_steps or float(np.max(np.abs(steps - step))) <= EVEN * step:
        return times
    count = int(np.ceil((times[-1] - times[0]) / step))
    return np.asarray(times[0] + step * np.arange(count + 1))


def _at(wanted: FloatArray, times: FloatArray, values: FloatArray) -> FloatArray:
    """Return values on straight lines between `times` [s], and on the last of them beyond its end."""
    beyond = 2.0 * times[-1] - times[-2], 2.0 * values[-1] - values[-2]
    return np.asarray(np.interp(wanted, np.append(times, beyond[0]), np.append(values, beyond[1])))


@dataclass(frozen=True)
class _Watch:
    """What is known of a replay: the FMU, the recording and its samples, the time limit [s], and whom to tell."""

    fmu: Path
    recording: str
    samples: int
    timeout: float
    progress: Progress

    def refusal(self, what: str, said: str) -> TirelabError:
        """Return the error of an FMU that failed."""
        said = " ".join(said.split())
        return TirelabError(f"{self.fmu} {what} on {self.recording}; its last message: {said}")


def _followed(watch: _Watch, folder: Path) -> None:
    """Run the process of `folder` to its end; raises TirelabError where it fails or takes too long."""
    last = ""
    with open(folder / "printed.txt", "w+", encoding="utf-8", errors="replace") as printed:
        with _started(folder, printed) as (process, lines):
            end = time.monotonic() + watch.timeout
            failed = None
            while True:
                line = _next(lines, end)
                if line is None:
                    break
                if not line:
                    raise watch.refusal(
                        f"was ended after {watch.timeout:g} s (see --fmu-timeout)", last or _last(printed)
                    )
                content = json.loads(line)
                if "sample" in content:
                    done = 100 * content["sample"] // watch.samples
                    watch.progress(f"replaying {watch.fmu.name} on {watch.recording}: {done} %")
                failed = content.get("failed", failed)
                last = content.get("message", last) or last
            status = process.wait()
        if failed is not None:
            raise watch.refusal(f"failed ({failed.splitlines()[0]})", last or _last(printed))
        if status != 0 or not (folder / "force.npy").is_file():
            crash = f"signal {-status}" if status < 0 else f"exit status {status}"
            raise watch.refusal(f"ended its process ({crash})", last or _last(printed))


@contextmanager
def _started(
    folder: Path, printed: IO[str]
) -> Iterator[tuple[subprocess.Popen[str], queue.Queue[str | None]]]:
    """Give a process and the lines it says, None at their end; the process is gone when the block ends."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tirelab.fmu.foreign_process", str(folder)],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=printed,
        text=True,
        encoding="utf-8",
        start_new_session=True,
    )
    assert process.stdout is not None
    lines: queue.Queue[str | None] = queue.Queue()
    stream = process.stdout

    def listen() -> None:
        for line in stream:
            lines.put(line)
        lines.put(None)

    listener = threading.Thread(target=listen, daemon=True)
    listener.start()
    try:
        yield process, lines
    finally:
        if process.poll() is None:
            with suppress(OSError):  # with what it started, where the system has such groups
                os.killpg(process.pid, signal.SIGKILL) if hasattr(os, "killpg") else process.kill()
        process.wait()
        listener.join(timeout=5.0)
        stream.close()


def _next(lines: queue.Queue[str | None], end: float) -> str | None:
    """Return the next line; None where there will be no more, nothing where none came before `end` [s]."""
    try:
        line = lines.get(timeout=max(end - time.monotonic(), 0.0))
    except queue.Empty:
        return ""
    return "" if line is not None and time.monotonic() > end else line


def _last(printed: IO[str]) -> str:
    """Return the last line that the FMU printed."""
    printed.seek(0)
    lines = [line.strip() for line in printed.read().splitlines() if line.strip()]
    return lines[-1] if lines else SILENT
