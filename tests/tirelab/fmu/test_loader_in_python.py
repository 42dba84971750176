"""The FMU's Linux binary in a host that is Python itself: every function, through fmpy in a fresh process."""

import subprocess
import sys
import textwrap
from pathlib import Path

from loader_bench import GUID, Bench, unpacked


def in_python(bench: Bench, code: str, *arguments: object) -> str:
    """Run code in a fresh Python, with fmpy's slave `tire` of an unpacked FMU and its logger's `messages`."""
    start = f"""
        import sys, threading
        from fmpy.fmi2 import (
            FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2String, fmi2ValueReference
        )
        path = list(sys.path)
        messages = []
        def log(environment, instance, status, category, text):
            messages.append((status, category.decode(), text.decode()))
        callbacks = fmi2CallbackFunctions(logger=fmi2CallbackLoggerTYPE(log))
        def make(folder={str(bench.fmu)!r}):
            slave = FMU2Slave(
                guid={GUID!r}, unzipDirectory=folder, modelIdentifier="BicycleTire", instanceName="tire",
            )
            slave.instantiate(callbacks=callbacks)
            return slave
        def caught(call, *words):
            try:
                call(*words)
            except Exception as error:
                return str(error)
        def begin(slave):
            slave.setupExperiment(stopTime=1.0, tolerance=1e-6)
            slave.enterInitializationMode()
            slave.exitInitializationMode()
            return slave
        tire = begin(make())
    """
    text = textwrap.dedent(start) + textwrap.dedent(code)
    command = [sys.executable, "-I", "-W", "ignore", "-c", text, *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert result.stderr == ""
    assert result.returncode == 0
    return result.stdout


def test_values_of_every_type_in_a_python_host(bench: Bench) -> None:
    in_python(
        bench,
        """
        tire.setReal([0], [0.01])
        assert tire.getReal([2, 0]) == [550.9, 0.01], "a get after a set needs no step"
        tire.setReal([0, 1], [0.02, 0.5])
        assert tire.getReal([0, 1]) == [0.02, 0.5]
        tire.setInteger([3], [-7])
        tire.setBoolean([4], [1])
        tire.setString([5], ["ä %"])
        assert tire.getInteger([3]) == [-7]
        assert tire.getBoolean([4]) == [1]
        assert tire.getString([5]) in (["ä %"], ["ä %".encode()]), "text or bytes, by fmpy's version"
        assert tire.getReal([]) == []
        tire.doStep(0.5, 0.25)
        assert tire.getInteger([3]) == [-6]
        assert tire.getRealStatus(2) == 0.75
        assert tire.getBooleanStatus(3) is False
        tire.terminate()
        tire.reset()
        begin(tire)
        assert tire.getReal([0]) == [0.0]
        tire.freeInstance()
        assert sys.path == path, "the host's path is left alone"
        """,
    )


def test_states_in_a_python_host(bench: Bench) -> None:
    in_python(
        bench,
        """
        tire.setReal([0], [0.01])
        state = tire.getFMUstate()
        tire.setReal([0], [0.02])
        text = tire.serializeFMUstate(state)
        tire.setFMUstate(state)
        assert tire.getReal([0]) == [0.01]
        tire.setReal([0], [0.03])
        again = tire.deSerializeFMUstate(text)
        tire.setFMUstate(again)
        assert tire.getReal([0]) == [0.01]
        tire.freeFMUstate(state)
        tire.freeFMUstate(again)
        tire.freeInstance()
        """,
    )


def test_errors_leave_the_instance_alive(bench: Bench) -> None:
    """An exception is an Error with its text, False is a Discard, and good input works again after either."""
    in_python(
        bench,
        """
        assert messages == [], "a success is not told with logging off"
        assert "status 3" in caught(tire.setReal, [0, 1], [0.01, 0.0])
        assert messages.pop() == (3, "logStatusError", "set_real: ValueError: radius 0 m is 100 %% wrong")
        assert "status 2" in caught(tire.setReal, [0, 1], [0.01, -1.0])
        assert "status 3" in caught(tire.getReal, [99]) and "KeyError" in messages.pop()[2]
        assert "status 3" in caught(tire.getInteger, [0]) and "TypeError" in messages.pop()[2]
        latin = (fmi2ValueReference * 1)(5), 1, (fmi2String * 1)(b"\\xff")
        assert "status 3" in caught(tire.fmi2SetString, tire.component, *latin)
        assert "UnicodeDecodeError" in messages.pop()[2]
        tire.setReal([0, 1], [float("nan"), 1.0])
        assert "status 2" in caught(tire.doStep, 0.0, 0.1)
        assert messages.pop() == (2, "logStatusDiscard", "deflection nan m is 100 %% no number")
        tire.setReal([0, 1], [0.01, 1.0])
        tire.doStep(0.0, 0.1)
        assert tire.getReal([2]) == [550.9]
        assert messages == []
        tire.setDebugLogging(True, [])
        tire.reset()
        tire.setReal([0], [0.01])
        status, category, text = messages.pop()
        assert (status, category, text[:18]) == (0, "logAll", "100 %% made from /")
        tire.freeInstance()
        """,
    )


def test_unsupported_functions_say_so(bench: Bench) -> None:
    in_python(
        bench,
        """
        for call, words in (
            (tire.getDirectionalDerivative, ([2], [0], [1.0])),
            (tire.setRealInputDerivatives, ([0], [1], [0.0])), (tire.getRealOutputDerivatives, ([2], [1])),
        ):
            assert "status 3" in caught(call, *words)
            status, category, text = messages.pop()
            assert (status, category) == (3, "logStatusError")
            assert text.startswith("fmi2") and text.endswith(" is not supported")
        assert "status 3" in caught(tire.cancelStep)
        assert messages.pop()[2] == 'fmi2CancelStep is not allowed in the state "stepComplete"'
        # by the standard a status that cannot be retrieved is fmi2Discard
        for call, kind in ((tire.getStatus, 0), (tire.getIntegerStatus, 0), (tire.getStringStatus, 1)):
            assert "status 2" in caught(call, kind)
        assert messages == []
        tire.freeInstance()
        """,
    )


def test_threads_and_closed_libraries_in_a_python_host(bench: Bench, tmp_path: Path) -> None:
    """Threads end after the library is closed that they have used."""
    copies = [unpacked(tmp_path / str(i), bench.loader) for i in range(3)]
    in_python(
        bench,
        """
        forces = []
        def work(folder):
            for _ in range(20):
                slave = begin(make(folder))
                slave.setReal([0], [0.01])
                forces.append(slave.getReal([2])[0])
                slave.freeInstance()
        for _ in range(2):
            threads = [threading.Thread(target=work, args=[folder]) for folder in sys.argv[1:]]
            [thread.start() for thread in threads]
            [thread.join() for thread in threads]
        assert forces == [550.9] * 120
        """,
        *copies,
    )


def test_a_broken_slave_is_refused_with_its_exception(bench: Bench, tmp_path: Path) -> None:
    folder = unpacked(tmp_path / "fmu", bench.loader)
    (folder / "resources" / "plain_tire.py").write_text("import no_such_module\n")
    result = bench.attempt("run", 0.01, fmu=folder)
    assert result.returncode == 1
    assert result.stdout == (
        "[tire, 3, logStatusError] fmi2Instantiate: ModuleNotFoundError: No module named 'no_such_module'\n"
    )
