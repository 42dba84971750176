"""The FMU's Linux binary in a host written in C: its lives, its threads, its memory."""

import signal
import subprocess
import time
from pathlib import Path

import pytest
import pythonfmu
from loader_bench import FORCE_1_CM, FORCE_2_CM, GUID, LIBRARY, Bench, numbers, unpacked


def test_lives_twice_in_a_c_host(bench: Bench) -> None:
    # one power and one product, each rounded once by either C library: 4 units in the last place
    expected = pytest.approx([FORCE_1_CM, FORCE_2_CM, 0.0] * 2, rel=1e-15, abs=0)
    assert numbers(bench.run("run", 0.01, 0.02, -0.01)) == expected


def test_pythonfmus_own_library_does_not_open_in_a_c_host(bench: Bench, tmp_path: Path) -> None:
    """The reason for the loader; when this fails, pythonfmu has got better."""
    own = Path(pythonfmu.__file__).parent / "resources" / "binaries" / "linux64" / "libpythonfmu-export.so"
    result = bench.attempt("run", 0.01, fmu=unpacked(tmp_path / "fmu", own))
    assert result.returncode == 1
    assert "_Py_NoneStruct" in result.stderr


def test_a_discarded_step_is_told_once_and_forgotten(bench: Bench) -> None:
    """With logging off; '%' comes through a host that reads the message as a printf format."""
    message, status, force = bench.run("bad").splitlines()
    assert message == "[tire, 2, logStatusDiscard] deflection nan m is 100 % no number"
    assert int(status) == 2
    assert float(force) == pytest.approx(FORCE_1_CM, rel=1e-15)


def test_a_host_without_a_logger(bench: Bench) -> None:
    assert bench.run("silent") == ""


def test_four_threads_at_once(bench: Bench) -> None:
    bench.run("threads", 4)


def test_an_instance_handed_through_threads_leaves_nothing_behind(bench: Bench) -> None:
    # a thread state of Python 3.11 and later is 16 kB, so that 400 would be 6.4 MB
    assert int(bench.run("relay", 400)) < 1000


def test_memory_of_1000_instances(bench: Bench) -> None:
    assert int(bench.run("cycles", 1000)) < 15_000


def test_opened_and_closed_many_times(bench: Bench) -> None:
    assert int(bench.run("reopen", 30)) < 1000


def test_memory_of_many_steps(bench: Bench) -> None:
    # one lost reference a step would be at least 16 bytes: 4.8 MB
    assert int(bench.run("steps", 300_000)) < 500


@pytest.mark.slow
def test_memory_of_a_million_steps(bench: Bench) -> None:
    assert int(bench.run("steps", 1_000_000)) < 500


def test_ends_from_another_thread(bench: Bench) -> None:
    """pythonfmu's way would hang here: Python waits for the end of the thread that started it."""
    bench.run("elsewhere")


def test_ends_in_the_child_of_a_fork(bench: Bench) -> None:
    bench.run("fork")


def test_two_fmus_do_not_disturb_each_other(bench: Bench, tmp_path: Path) -> None:
    """Same names of modules, other law; and both start Python at the same time."""
    other = unpacked(tmp_path / "other", bench.loader)
    module = other / "resources" / "plain_tire.py"
    module.write_text(module.read_text().replace("550.9, 1.422", "718.5, 1.4"))
    text = bench.run("two", other / LIBRARY, f"file://{other}/resources", GUID)
    assert numbers(text) == pytest.approx([FORCE_1_CM, 718.5] * 2, rel=1e-15)


def test_control_c_stays_the_hosts(bench: Bench) -> None:
    def heard() -> None:  # a program that was started in the background would ignore it
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    command = bench.command("steps", 10**9)
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, preexec_fn=heard) as process:
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        try:
            assert process.wait(120) == -signal.SIGINT
        finally:
            process.kill()
