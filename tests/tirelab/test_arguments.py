"""What is no recording, no tire or no simulated force is told in one sentence with what to give."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from drives import damped
from radialtire import TireModel
from tirelab import Limits, build_fmu, compare, diagnose, identify, replay, ride
from tirelab.errors import TirelabError, check_recordings_given, check_tire_given
from tirelab.recordings.recording import Recording, RecordingError, read_recording
from tirelab.terrain import flat, ground_from

RECORDING = damped(1, samples=200)
TIRE = TireModel()
GROUND = ground_from(flat(4.0))

CALLS: dict[str, tuple[Callable[..., Any], tuple[Any, ...], str]] = {
    "diagnose a path": (diagnose, ("a.csv", TIRE), "read it first: read_recording('a.csv')"),
    "diagnose paths": (diagnose, ([Path("a.csv")], TIRE), "read it first: read_recording('a.csv')"),
    "diagnose arrays": (diagnose, ([np.zeros(9)], TIRE), "Recording.from_arrays"),
    "diagnose beside a path": (diagnose, (RECORDING, "t.json"), "give read_tire('t.json')"),
    "identify a path": (identify, ("a.csv",), "read_recording('a.csv')"),
    "identify paths": (identify, (["a.csv"],), "read_recording('a.csv')"),
    "compare a path": (compare, ("a.csv", np.zeros(9)), "read_recording('a.csv')"),
    "replay several": (replay, (Path("a.fmu"), [RECORDING]), "is of type list, not a recording"),
    "columns as an option": (partial(read_recording, columns="force=#3"), ("a.csv",), '{"force": "#3"}'),
    "units as an option": (partial(Recording.from_arrays, units="force=N"), ([0.0],) * 3, '{"force": "kN"}'),
    "zero as an option": (partial(Recording.from_dataframe, zero="force=5 N"), (None,), '{"force": "5 N"}'),
    "radius as a list": (partial(read_recording, radius=[1]), ("a.csv",), 'instance radius="flat"'),
    "sampling as a list": (partial(Recording.from_dataframe, sampling=[1]), (None,), 'sampling="10 Hz"'),
    "limits as a mapping": (
        partial(diagnose, limits={}),
        (RECORDING, TIRE),
        "Limits(deepest=0.02, fastest=0.1)",
    ),
    "limits as a text": (partial(diagnose, limits="x"), (RECORDING, TIRE), "limits='x' is of type str"),
    "one name": (partial(diagnose, catalogue="inertia"), (RECORDING,), "give catalogue=['inertia']"),
    "no names": (partial(diagnose, catalogue=5), (RECORDING,), "catalogue='5' is of type int"),
    "identify nothing": (identify, (None,), "is of type NoneType, not a recording"),
    "ride over nothing": (
        partial(ride, speed=5.0, load=500.0),
        (None, TIRE),
        "give for instance ground_from(flat(",
    ),
    "ride on a path": (partial(ride, speed=5.0, load=500.0), (GROUND, "t.json"), "give read_tire('t.json')"),
    "a number as a name": (
        Recording,
        (5, [0.0, 1.0], [0.0, 1.0], [1.0, 1.0], [0.0, 1.0]),
        "name='5' is of type int",
    ),
    "build of nothing": (build_fmu, (None, "out"), "give read_tire(FILE) or TireModel()"),
}


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"deepest": -1.0}, "deepest=-1.0 is no limit of a rig; give a number [m] above 0"),
        ({"fastest": np.nan}, "fastest=nan is no limit of a rig; give a number [m/s] above 0"),
        ({"step": np.inf}, "step=inf is no limit"),
        ({"longest": "60"}, "longest='60' is no limit"),
        ({"start": np.nan}, "start=nan is no deflection; give a number [m]"),
    ],
)
def test_limits_that_no_rig_has_are_told(given: dict[str, Any], told: str) -> None:
    with pytest.raises(ValueError, match=re.escape(told)):
        Limits(**given)


def test_one_recording_is_identified_as_several_are() -> None:
    assert identify(RECORDING).tire == identify([RECORDING]).tire


@pytest.mark.parametrize("name", CALLS)
def test_an_argument_of_another_kind_is_told_in_one_sentence(name: str) -> None:
    function, arguments, told = CALLS[name]
    with pytest.raises(TypeError) as caught:
        function(*arguments)
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


def test_recordings_and_tires_pass() -> None:
    check_recordings_given([RECORDING, RECORDING])
    check_recordings_given([])
    check_tire_given(TIRE)


@pytest.mark.parametrize(
    ("simulated", "told"),
    [
        (np.zeros(199), "the simulated force has the shape (199,), and ride 1 has 200 samples"),
        (np.zeros((200, 1)), "has the shape (200, 1)"),
        (0.0, "has the shape ()"),
        (np.where(np.arange(200) == 3, np.nan, 0.0), "the simulated force is nan at sample 4"),
    ],
)
def test_a_simulated_force_that_cannot_be_compared_is_told(simulated: Any, told: str) -> None:
    with pytest.raises(TirelabError, match=told.replace("(", r"\(").replace(")", r"\)")):
        compare(RECORDING, simulated)


def test_a_list_of_numbers_is_compared() -> None:
    assert compare(RECORDING, RECORDING.force.tolist()).rmse == 0.0  # type: ignore[arg-type]


@pytest.mark.parametrize("given", [{"columns": {"force": 3}}, {"units": {"force": 3}}])
def test_a_number_is_taken_as_a_text(given: dict[str, Any]) -> None:
    frame = pl.DataFrame({"deflection [mm]": [0.0, 1.0], "force [N]": [0.0, 1.0]})
    with pytest.raises(RecordingError, match="'3'"):
        Recording.from_dataframe(frame, **given)
