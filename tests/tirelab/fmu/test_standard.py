"""What the FMI standard says of each call in each state, of times, and of masters that try a refused step again."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from loader_bench import Bench, guid_of, unpacked_archive
from radialtire import CATALOGUE, TireModel
from tirelab.fmu.build import build_fmu
from tirelab.fmu.native.pack import build_native_fmu

Run = Callable[..., Any]

CO_SIMULATION_STATES = ("instantiated", "initialization", "stepComplete", "terminated", "error")

CO_SIMULATION = """
fmi2GetTypesPlatform         |x |x |x |x |x
fmi2GetVersion               |x |x |x |x |x
fmi2SetDebugLogging          |x |x |x |x |x
fmi2SetupExperiment          |x |  |  |  |
fmi2EnterInitializationMode  |x |  |  |  |
fmi2ExitInitializationMode   |  |x |  |  |
fmi2Terminate                |  |  |x |  |
fmi2Reset                    |x |x |x |x |x
fmi2GetReal                  |  |2 |x |x |7
fmi2GetInteger               |  |2 |x |x |7
fmi2GetBoolean               |  |2 |x |x |7
fmi2GetString                |  |2 |x |x |7
fmi2SetReal                  |1 |3 |6 |  |
fmi2SetInteger               |1 |3 |6 |  |
fmi2SetBoolean               |1 |3 |6 |  |
fmi2SetString                |1 |3 |6 |  |
fmi2GetFMUstate              |x |x |x |x |7
fmi2SetFMUstate              |x |x |x |x |x
fmi2FreeFMUstate             |x |x |x |x |x
fmi2SerializedFMUstateSize   |x |x |x |x |x
fmi2SerializeFMUstate        |x |x |x |x |x
fmi2DeSerializeFMUstate      |x |x |x |x |x
fmi2GetDirectionalDerivative |  |x |x |x |7
fmi2SetRealInputDerivatives  |x |x |x |  |
fmi2GetRealOutputDerivatives |  |  |x |x |7
fmi2DoStep                   |  |  |x |  |
fmi2CancelStep               |  |  |  |  |
fmi2GetStatus                |  |  |x |x |
fmi2GetRealStatus            |  |  |x |x |
fmi2GetIntegerStatus         |  |  |x |x |
fmi2GetBooleanStatus         |  |  |x |x |
fmi2GetStringStatus          |  |  |x |x |
"""
"""FMI 2.0.5, section 4.2.4: the columns of states that an FMU can be in which makes or refuses its steps at once.

Numbers are conditions on the variable (inputs, outputs and tunable parameters meet them) and on what values are for.
"""


def cells(table: str, states: tuple[str, ...]) -> list[tuple[str, str, bool]]:
    found = []
    for line in table.strip().splitlines():
        name, *marks = (part.strip() for part in line.split("|"))
        assert len(marks) == len(states), line
        found += [
            (name.removeprefix("fmi2"), state, mark != "") for state, mark in zip(states, marks, strict=True)
        ]
    return found


@pytest.fixture(scope="module")
def in_each_state(run_host: Run, either_fmu: Path) -> dict[str, Any]:
    answers = json.loads(run_host("in_each_state.py", either_fmu, job=None))
    assert isinstance(answers, dict)
    return answers


def test_each_call_in_each_state_of_co_simulation(in_each_state: dict[str, Any]) -> None:
    """After an error the standard leaves reset and saved states; a good value is taken here beside it."""
    answers = in_each_state["CoSimulation"]
    assert {name for name, _, _ in cells(CO_SIMULATION, CO_SIMULATION_STATES)} == set(answers)
    for name, state, allowed in cells(CO_SIMULATION, CO_SIMULATION_STATES):
        status, message = answers[name][state]
        refused = f"fmi2{name} is not allowed in the state" in message
        if allowed:
            assert not refused, (name, state)
        elif state != "error":
            assert refused, (name, state)
            assert status == 3


NAN_AFTER_HALF_A_SECOND = """
    import sys
    for name in ("radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description"):
        sys.modules[name] = None
    import numpy as np
    from fmpy import simulate_fmu
    columns = [("time", float), ("deflection", float), ("surface_radius", float)]
    rows = [(0.0, 0.01, 1e5), (0.5, 0.01, 1e5), (0.5, {value}, {radius}), (1.0, {value}, {radius})]
    try:
        simulate_fmu(
            sys.argv[1], input=np.array(rows, dtype=columns), output=["radial_force"], stop_time=1.0,
            output_interval=0.1, fmi_type="CoSimulation",
        )
    except Exception as error:
        print(error)
"""


@pytest.mark.parametrize("fmu", ["Python", "FMI 2", "FMI 3"])
@pytest.mark.parametrize(
    ("value", "radius", "word"),
    [
        ("np.nan", "1e5", "deflection = nan"),
        ("0.01", "0.0", "surface_radius = 0"),
        ("22.0", "1e5", "deflection = 22"),
    ],
)
def test_fmpys_simulation_ends_by_itself_after_an_input_that_no_tire_has(
    three_fmus: dict[str, Path], fmu: str, value: str, radius: str, word: str
) -> None:
    """It retries a discarded step for ever: half a gigabyte of messages in ten minutes."""
    code = textwrap.dedent(NAN_AFTER_HALF_A_SECOND.format(value=value, radius=radius))
    done = subprocess.run(
        [sys.executable, "-I", "-c", code, str(three_fmus[fmu])], capture_output=True, text=True, timeout=120
    )
    assert "status 3" in done.stdout
    assert (done.stdout + done.stderr).count(word) == 1


@pytest.fixture(scope="module")
def tire(either_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return unpacked_archive(either_fmu, tmp_path_factory.mktemp("standard"))


def test_a_master_that_retries_what_is_discarded_ends(bench: Bench, tire: Path) -> None:
    message, status = bench.run("retry", fmu=tire).splitlines()
    assert message.startswith("[tire, 3, logStatusError] deflection = nan m is not allowed")
    assert int(status) == 3


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text[: len(text) // 2], "tire.json"),
        (lambda text: re.sub(r'"schema": *\d+', '"schema": 99', text), "99"),
    ],
    ids=["truncated", "another version"],
)
def test_a_tire_file_that_is_not_whole_or_of_another_version_is_told(
    bench: Bench, article_fmu: Path, tmp_path: Path, change: Callable[[str], str], words: str
) -> None:
    fmu = unpacked_archive(article_fmu, tmp_path / "fmu")
    file = fmu / "resources" / "tire.json"
    text = file.read_text(encoding="utf-8")
    file.write_text(change(text), encoding="utf-8")
    assert file.read_text(encoding="utf-8") != text
    result = bench.attempt("run", 0.01, fmu=fmu)
    assert result.returncode == 1
    assert words in result.stdout
    assert result.stdout.count("\n") == 1
    assert "Traceback" not in result.stdout


@pytest.mark.parametrize("guid", ["{00000000-0000-5000-8000-000000000000}", "", None])
def test_another_guid_is_refused(tire: Path, guid: str | None) -> None:
    with pytest.raises(AssertionError, match=r"GUID (\{0|NULL| )?.*is not that of this FMU"):
        with_instance(tire, "None", guid=guid)


def test_the_last_successful_time_is_a_number_from_the_start(tire: Path) -> None:
    """The start of the experiment before the first step, the end of a step after it, 0 after a reset."""
    printed = with_instance(
        tire,
        """[
            begin(2.0), real_status(),
            library.fmi2DoStep(tire, c_double(2.0), c_double(0.5), 1), real_status(),
            library.fmi2DoStep(tire, c_double(2.5), c_double(float("nan")), 1), real_status(),
            library.fmi2Reset(tire), begin(0.0), real_status(),
        ]""",
    )
    begun, first, stepped, second, refused, third, reset, again, fourth = json.loads(printed)
    assert (begun, stepped, refused, reset, again) == (0, 0, 3, 0, 0)
    assert (first, second, third, fourth) == (2.0, 2.5, 2.5, 0.0)


def test_a_step_past_the_stop_time_is_refused(tire: Path) -> None:
    """FMI 2.0.5, 2.1.5: fmi2Error; a step that ends there as a host adds its times up is made."""
    printed = with_instance(
        tire,
        """[
            library.fmi2SetupExperiment(tire, 0, c_double(0), c_double(1.0), 1, c_double(0.5)),
            library.fmi2SetupExperiment(tire, 0, c_double(0), c_double(0.0), 1, c_double(float("nan"))),
            library.fmi2SetupExperiment(tire, 0, c_double(0), c_double(0.0), 1, c_double(0.3)),
            library.fmi2EnterInitializationMode(tire), library.fmi2ExitInitializationMode(tire),
            [library.fmi2DoStep(tire, c_double(t), c_double(0.1), 1) for t in (0.0, 0.1, 0.1 + 0.1 + 1e-12)],
            library.fmi2DoStep(tire, c_double(0.3), c_double(0.1), 1), real_status(),
            library.fmi2Reset(tire), begin(0.0), library.fmi2DoStep(tire, c_double(0.0), c_double(9.0), 1), messages,
        ]""",
    )
    early, missing, *begun, steps, past, reached, reset, again, free, messages = json.loads(printed)
    assert (early, missing, begun, steps, past) == (3, 3, [0, 0, 0], [0, 0, 0], 3)
    assert reached == pytest.approx(0.3, rel=1e-9)
    assert (reset, again, free) == (0, 0, 0)
    assert [message.partition("is not allowed")[0] for message in messages] == [
        "stopTime = 0.5 s ",
        "stopTime = nan s ",
        "communicationStepSize = 0.10000000000000001 s ",
    ]
    assert "after stopTime = 0.29999999999999999 s" in messages[2]


def test_unknown_references_are_refused(tire: Path) -> None:
    printed = with_instance(
        tire,
        """[begin(0.0)] + [
            [library.fmi2GetReal(tire, (c_uint * 1)(vr), c_size_t(1), (c_double * 1)()),
             library.fmi2SetReal(tire, (c_uint * 1)(vr), c_size_t(1), (c_double * 1)(1.0)), len(messages)]
            for vr in (4, 15, 2**31, 2**32 - 1)
        ] + [library.fmi2GetBoolean(tire, (c_uint * 1)(2), c_size_t(1), (c_int * 1)())]""",
    )
    begun, *answers, boolean = json.loads(printed)
    assert (begun, boolean) == (0, 3)
    assert answers == [[3, 3, 2], [3, 3, 4], [3, 3, 6], [3, 3, 8]]


@pytest.mark.parametrize("build", [build_fmu, build_native_fmu], ids=["Python", "native"])
def test_the_stiffness_where_the_contact_begins_is_that_of_the_air(
    run_fmpy: Run, tmp_path: Path, build: Callable[..., Any]
) -> None:
    """At x = 0, coming from the air, a damper's jump over the difference's width would be 4e8 N/m."""
    for name in ("viscous_damping", "rate_independent_hysteresis"):
        effect = CATALOGUE[name]
        fmu = build(TireModel(effects=((effect, effect.nominal),)), tmp_path / name).path
        calls: list[list[object]] = []
        for i, x in enumerate((-0.02, -0.01, 0.0)):
            calls += [[0, "set", {"deflection": x}], [0, "step", 0.1 * i, 0.1]]
        assert run_fmpy([fmu], [*calls, [0, "get", ["radial_stiffness", "radial_force"]]])[-1] == [0.0, 0.0]


def test_the_first_instance_starts_no_other_program(bench: Bench, article_fmu: Path, tmp_path: Path) -> None:
    """Where the library is beside the program, there is no need of a shell and of a second interpreter."""
    program = Path(sys.executable).resolve()
    library = program.parents[1] / "lib" / f"lib{program.name}.so.1.0"
    if not library.is_file():
        pytest.skip("this Python has no shared library beside it")
    (tmp_path / "python3").symlink_to(program)
    (tmp_path / "python").write_text(f"#!/bin/sh\ntouch {tmp_path}/started\n")
    (tmp_path / "python").chmod(0o755)
    alone = {"PATH": str(tmp_path), "VIRTUAL_ENV": "", "TIRELAB_LIBPYTHON": ""}
    assert (
        float(bench.run("first", fmu=unpacked_archive(article_fmu, tmp_path / "fmu"), environment=alone))
        > 0.0
    )
    assert not (tmp_path / "started").exists()


INSTANCE = """
    import json, sys
    from ctypes import *
    for name in ("radialtire", "tirelab", "bicycle_tire_fmu", "fmu_description"):
        sys.modules[name] = None
    from pathlib import Path
    folder = Path(sys.argv[1])
    messages = []
    @CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)
    def log(_environment, _instance, _status, _category, text):
        messages.append(text.decode())
    class Callbacks(Structure):
        _fields_ = [("logger", type(log)), ("rest", c_void_p * 4)]
    c_library = CDLL(None)
    callbacks = Callbacks(log, (c_void_p * 4)(cast(c_library.calloc, c_void_p), cast(c_library.free, c_void_p)))
    library = CDLL(str(folder / "binaries" / "linux64" / "BicycleTire.so"))
    library.fmi2Instantiate.restype = c_void_p
    guid = {guid!r}
    given = None if guid is None else guid.encode()
    resources = (folder / "resources").as_uri().encode()
    tire = library.fmi2Instantiate(b"tire", 1, given, resources, byref(callbacks), 0, 0)
    if not tire:
        sys.exit("no instance: " + messages[0])
    tire = c_void_p(tire)
    def begin(start):
        return (
            library.fmi2SetupExperiment(tire, 0, c_double(0), c_double(start), 0, c_double(0))
            | library.fmi2EnterInitializationMode(tire) | library.fmi2ExitInitializationMode(tire)
        )
    def real_status():
        value = c_double()
        library.fmi2GetRealStatus(tire, 2, byref(value))
        return value.value
    print(json.dumps({expression}))
    library.fmi2FreeInstance(tire)
"""


def with_instance(folder: Path, expression: str, *, guid: str | None = "own") -> str:
    """Evaluate `expression` beside a new instance of an unpacked FMU, in a fresh process."""
    code = textwrap.dedent(INSTANCE).format(
        guid=guid_of(folder) if guid == "own" else guid, expression=" ".join(expression.split())
    )
    done = subprocess.run(
        [sys.executable, "-I", "-c", code, str(folder)], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
