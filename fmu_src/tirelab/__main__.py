"""The program `tirelab`, also as a module: python -m tirelab."""

from __future__ import annotations

import _thread
import signal
import sys
import threading
import time
from typing import Any, NoReturn

AGAIN = 0.01
"""Seconds after which a lost interrupt is repeated: what lost it is soon over, and if it is not, it comes back."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C was pressed.

    Python ends by the signal, not with our status, where a plain KeyboardInterrupt left code that was made from a text
    at run time, as that of dataclasses is; one of another class is not looked at.
    """


def interrupt(*_: Any) -> NoReturn:
    """End what is done now, wherever it is."""
    raise Interrupted


def repeat(lost: Any) -> None:
    """Interrupt once more where a callback or a `__del__` was interrupted, of which Python only prints the error."""
    if lost.exc_type is Interrupted:
        over = threading.Event()
        threading.Thread(target=_interrupt_after, args=(over,), daemon=True).start()
        over.set()  # an interrupt before here, while a busy machine starts the thread, would be lost too
    else:
        sys.__unraisablehook__(lost)


def _interrupt_after(over: threading.Event) -> None:
    over.wait()
    time.sleep(AGAIN)
    _thread.interrupt_main()


def main() -> None:
    """Run the command on the command line; interrupted, also while modules are loaded, end with status 1."""
    try:
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, interrupt)
            sys.unraisablehook = repeat
        from .cli import main as program

        try:
            program()
        except SystemExit:  # done: as Python ends there is nothing to interrupt, only a traceback to print
            _change_to(signal.SIG_IGN)
            raise
    except (KeyboardInterrupt, RuntimeError) as error:
        # While a class is made, Python tells an interrupt as the cause of another error.
        if not isinstance(error, KeyboardInterrupt) and not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        _change_to(signal.SIG_DFL)  # once more ends it at once
        sys.exit("\nAborted!")


def _change_to(handler: signal.Handlers) -> None:
    if signal.getsignal(signal.SIGINT) is interrupt:
        signal.signal(signal.SIGINT, handler)


if __name__ == "__main__":
    main()
