"""What a table does not say is guessed by names, units and sizes, and strain and stress are not guessed at."""

from pathlib import Path

import numpy as np
import pytest
import scipy.io
from house_form import loading, write_rows
from tirelab.recordings.asking import IncompleteRecording
from tirelab.recordings.choices import Choices
from tirelab.recordings.recording import RecordingError, understand

CHANNELS = ("time", "deflection", "force")


def proposed(path: Path, part: bool = True) -> list[str]:
    """Return the words of the command that is proposed for a file."""
    with pytest.raises(IncompleteRecording) as caught:
        understand(path, Choices(part=part))
    return caught.value.words()


@pytest.mark.parametrize(
    ("size", "unit"), [(0.005, "m"), (0.4, "mm"), (4.1, "mm"), (300.0, "mm"), (8000.0, "um")]
)
def test_a_part_is_measured_in_millimetres_where_it_can_be(tmp_path: Path, size: float, unit: str) -> None:
    _, deflection, force = loading()
    rows = (size * deflection / deflection.max(), force)
    path = write_rows(tmp_path / "a.csv", "displacement,force [N]", *rows)
    assert proposed(path) == ["--units", f"deflection={unit}"]


def test_what_a_scale_weighs_is_the_force_and_the_steps_of_a_motor_are_not(tmp_path: Path) -> None:
    time, deflection, force = loading()
    rows = (1e3 * time, np.round(1600 * deflection), deflection, 3.0 * force, force)
    path = write_rows(tmp_path / "a.csv", "Millis,Steps,Travel (mm),Scale raw,Scale (grams)", *rows)
    # `Millis` is read by itself, and its unit asked for with that of the force.
    assert proposed(path) == ["--columns", "force=#5", "--units", "time=ms,force=gf"]


def test_the_clock_of_a_logger_that_was_started_anew_is_the_time(tmp_path: Path) -> None:
    """Not the force: its board began to count again, in the middle of the file."""
    _, deflection, force = loading(400)
    clock = 100.0 * (np.arange(400) % 200)
    path = write_rows(tmp_path / "a.csv", "a,b,c", clock, 10.0 * deflection, force)
    assert proposed(path)[1] == "time=#1,deflection=#2,force=#3"


def test_of_many_forces_and_gauges_the_two_that_stand_together_are_guessed(tmp_path: Path) -> None:
    """A wall under two loads with gauges on it: no name says which is the travel, and a command can be copied."""
    _, deflection, force = loading()
    rows = (2.0 * force, force, deflection, 3.0 * force, 0.1 * deflection)
    path = write_rows(tmp_path / "a.csv", "V [kN],Fh [kN],u [mm],Fv [kN],lv1 [mm]", *rows)
    assert proposed(path) == ["--columns", "deflection=#3,force=#2"]
    rows = (2.0 * force, force, deflection, 3.0 * force)
    path = write_rows(tmp_path / "b.csv", "V [kN],Fh [kN],u [mm],Fv [kN]", *rows)
    assert proposed(path) == ["--columns", "deflection=#3,force=#2"]


@pytest.mark.parametrize("unit_of_rate", [1.0, 1e-3])
@pytest.mark.parametrize("rows", ["t,x,v,F", "t,v,x,F", "t,F,x,v"])
def test_a_velocity_recorded_beside_the_travel_is_not_guessed_to_be_the_force(
    tmp_path: Path, rows: str, unit_of_rate: float
) -> None:
    """A damper in a table without headers; a velocity in m/s is smaller than the travel in mm."""
    t = np.arange(0.0, 4.0, 0.005)
    x, v = 10.0 * np.sin(np.pi * t), 10.0 * np.pi * np.cos(np.pi * t)
    noise = np.random.default_rng(1).normal(0.0, 5.0, t.size)
    columns = {"t": t, "x": x, "v": unit_of_rate * v, "F": 1200.0 * np.tanh(v / 10.0) + noise}
    order = rows.split(",")
    path = write_rows(tmp_path / "a.csv", "", *(columns[name] for name in order))
    wanted = {name: f"#{order.index(letter) + 1}" for name, letter in zip(CHANNELS, "txF", strict=True)}
    assert proposed(path)[:2] == ["--columns", ",".join(f"{n}={c}" for n, c in wanted.items())]


def test_a_velocity_beside_a_travel_that_is_named_is_not_guessed_to_be_the_force(tmp_path: Path) -> None:
    """A motor's log: its position is known by name, and its torque is no word for a force."""
    t = np.arange(0.0, 4.0, 0.005)
    x, v = 10.0 * np.sin(np.pi * t), 10.0 * np.pi * np.cos(np.pi * t)
    path = write_rows(tmp_path / "a.csv", "time,position,velocity,torque", t, x, v, 3.0 * np.sin(x / 10.0))
    assert proposed(path)[:2] == ["--columns", "force=#4"]


def test_of_two_columns_the_one_that_goes_one_way_alone_is_the_deflection(tmp_path: Path) -> None:
    """Foam that is crushed: its force falls over its plateau and is the smaller number; the steps are uneven."""
    crushed = np.cumsum(np.random.default_rng(2).exponential(0.6, 300) ** 2)
    force = 5.0 * np.tanh(crushed / 20.0) - 0.01 * crushed
    for name, columns in (("a.csv", (force, crushed)), ("b.csv", (-crushed, force))):
        path = write_rows(tmp_path / name, "a,b", *columns)
        own = "deflection=#2,force=#1" if name == "a.csv" else "deflection=#1,force=#2"
        assert own in proposed(path)[1]


def test_what_a_recorded_velocity_is_the_rate_of_is_the_deflection_however_large(tmp_path: Path) -> None:
    """A sine of 50 with a force of 0.8 at most: by their sizes the force would be the deflection."""
    time = np.linspace(0.0, 4.0, 400)
    moved = 50.0 * np.sin(2.0 * np.pi * time)
    rows = (
        time,
        moved,
        np.gradient(moved, time),
        0.8 * np.tanh(np.cos(2.0 * np.pi * time) + 0.4 * moved / 50.0),
    )
    path = write_rows(tmp_path / "a.csv", "a,b,c,d", *rows)
    assert proposed(path)[1] == "time=#1,deflection=#2,force=#4"


def test_a_force_that_goes_with_the_rate_is_still_guessed(tmp_path: Path) -> None:
    """A linear damper of 31 N s/m: its force is as much like the rate as a rate is, but not of its size."""
    t = np.arange(0.0, 4.0, 0.005)
    x, v = 10.0 * np.sin(np.pi * t), 10.0 * np.pi * np.cos(np.pi * t)
    path = write_rows(tmp_path / "a.csv", "", t, x, 31.0 * v, 20.0 + 0.001 * t)
    assert proposed(path)[:2] == ["--columns", "time=#1,deflection=#2,force=#3"]


def test_times_in_the_plural_are_a_time(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(
        tmp_path / "a.csv", "times(s),displacement [mm],force [N]", time, 1e3 * deflection, force
    )
    found = understand(path, Choices(part=True)).recording
    assert found.timed
    np.testing.assert_allclose(np.ptp(found.time), np.ptp(time))


@pytest.mark.parametrize("columns", ["A,B", "B,A"])
def test_what_a_drive_moves_evenly_is_the_deflection_however_large(tmp_path: Path, columns: str) -> None:
    force = loading()[2]
    there_and_back = 191.0 * (50.0 - np.abs(np.arange(101) - 50.0))
    rows = (there_and_back, force / 1e3) if columns == "A,B" else (force / 1e3, there_and_back)
    words = proposed(write_rows(tmp_path / "a.csv", columns, *rows))
    moved = "#1" if columns == "A,B" else "#2"
    assert words[1].startswith(f"deflection={moved},")
    assert words[3] == "deflection=um,force=N"


@pytest.mark.parametrize(
    "header",
    [
        "Time (s),True Strain,True Stress (MPa)",
        "Zeit (s),Dehnung (%),Spannung (MPa)",
        "Time (s),Engineering strain,Engineering stress",
        "TestID,Volume_Fraction,Strain,Stress,Density",
    ],
)
def test_strain_and_stress_are_neither_and_said_to_be(tmp_path: Path, header: str) -> None:
    rows = (*loading(), *loading())[: header.count(",") + 1]
    path = write_rows(tmp_path / "a.csv", header, *rows)
    with pytest.raises(
        RecordingError, match=r"says? strain or stress, which are neither deflection nor force"
    ) as caught:
        understand(path, Choices(part=True))
    assert not isinstance(caught.value, IncompleteRecording)


def test_a_strain_that_is_a_length_may_be_the_deflection(tmp_path: Path) -> None:
    path = write_rows(tmp_path / "a.csv", "Time (s),Strain gauge travel (mm),Load (N)", *loading())
    assert understand(path, Choices(part=True)).plan.matches["deflection"].index == 1
    path = write_rows(tmp_path / "b.csv", "Time (s),Strain 1 (mm),Load (N)", *loading())
    assert proposed(path) == ["--columns", "deflection=#2"]


def test_the_index_of_a_data_frame_is_no_deflection(tmp_path: Path) -> None:
    """A gripper that closes on a fruit: the first column is the index that pandas writes, without a name."""
    time, deflection, force = loading()
    rows = (np.arange(float(len(time))), time, force, 2.0 + deflection)
    path = write_rows(tmp_path / "a.csv", ",Time (s),Force (N),Finger", *rows)
    assert proposed(path) == ["--columns", "deflection=#4", "--units", "deflection=mm"]
    path = write_rows(tmp_path / "b.csv", ",Time (s),Force (N),Pos", *rows)
    assert proposed(path) == ["--units", "deflection=mm"]


def test_of_several_columns_in_millimetres_the_one_beside_the_force_is_the_deflection(tmp_path: Path) -> None:
    """A switch pressed: its raw readings, and beside them the same worked out and sorted by the way."""
    time, deflection, force = loading()
    header = "t (s),Raw X (mm),Raw Force (N),Pressed,Corrected X (mm),Corrected force (N)"
    path = write_rows(tmp_path / "a.csv", header, time, deflection, force, 0.0 * time, deflection, force)
    with pytest.raises(IncompleteRecording) as caught:
        understand(path, Choices(columns={"force": "#3"}, part=True))
    assert caught.value.words() == ["--columns", "force=#3,deflection=#2"]


def test_what_was_sampled_another_number_of_times_is_not_guessed(tmp_path: Path) -> None:
    """A dynamometer: beside its readings a file holds what they should be, at other angles."""
    time, deflection, force = loading()
    run = {"clock": time, "angle": deflection, "torque": force}
    scipy.io.savemat(tmp_path / "a.mat", {"asked": force[::2], "run": run})
    assert proposed(tmp_path / "a.mat")[1] == "time=#2,deflection=#3,force=#4"


def test_of_vectors_without_a_time_the_longest_are_guessed(tmp_path: Path) -> None:
    """Beside its readings a file holds what was worked out of each of nine specimens."""
    _, deflection, force = loading()
    scipy.io.savemat(
        tmp_path / "a.mat", {"all": np.arange(18.0).reshape(9, 2), "one": deflection, "two": force}
    )
    assert proposed(tmp_path / "a.mat")[1] == "time=,deflection=#3,force=#4"


AXES = "disp_x_mm,disp_y_mm,disp_z_mm,Rx_deg,Ry_deg,Rz_deg,Fx_N,Fy_N,Fz_N"


def test_a_column_in_millimetres_is_no_clock_however_evenly_it_rises(tmp_path: Path) -> None:
    """A spine sheared by a robot: nine columns of six axes and no time, the first of which rises all the way."""
    rising = np.linspace(0.02, 1.05, 60)
    small = np.sin(np.arange(60.0))
    rows = (
        rising,
        0.1 * small,
        0.3 * rising**2,
        small,
        small,
        small,
        80.0 * rising**1.5,
        small,
        9.0 * rising,
    )
    assert proposed(write_rows(tmp_path / "a.csv", AXES, *rows)) == ["--columns", "deflection=#3"]


def test_the_deflection_is_along_the_axis_of_the_force(tmp_path: Path) -> None:
    time, deflection, force = loading()
    rows = (time, 3.0 * time, deflection, force)
    assert proposed(write_rows(tmp_path / "a.csv", "time [s],pose x [mm],pose z [mm],Fz [N]", *rows)) == [
        "--columns",
        "deflection=#3",
    ]


@pytest.mark.parametrize("sign", ["_", " "])
def test_a_name_that_ends_in_a_word_is_guessed_before_sizes(tmp_path: Path, sign: str) -> None:
    """A fatigue machine's table, where the count of cycles is larger than the load."""
    time, deflection, force = loading()
    names = "time [s],Machine_Load,Machine_Displacement,Machine_N_cycles".replace("_", sign)
    cycles = np.floor(1e4 * time)
    path = write_rows(tmp_path / "a.csv", names, time, 1e-3 * force, 1e3 * deflection, cycles)
    assert proposed(path)[:2] == ["--columns", "deflection=#3,force=#2"]


def test_a_name_that_begins_with_a_word_is_guessed_before_sizes(tmp_path: Path) -> None:
    time, deflection, force = loading()
    rows = (time, np.sin(time), 1e-3 * force, 1e3 * deflection)
    path = write_rows(tmp_path / "a.csv", "time [s],P_inlet,Force_data,z_meas", *rows)
    assert proposed(path)[1].endswith("force=#3")


def test_a_column_that_holds_anything_is_guessed_at_without_a_warning(
    tmp_path: Path, recwarn: pytest.WarningsRecorder
) -> None:
    time, deflection, force = loading()
    diverged = 10.0 ** np.linspace(0.0, 300.0, time.size)
    path = write_rows(tmp_path / "a.csv", "time [s],a,b,c", time, 1e3 * deflection, force, diverged)
    assert proposed(path)[:2] == ["--columns", "deflection=#2,force=#3"]
    assert not recwarn.list


@pytest.mark.parametrize(("angle", "torque"), [("deg", "Nm"), ("rad", "N m"), ("°", "lbf ft")])
def test_an_angle_and_a_torque_are_guessed_to_stand_for_a_deflection_and_a_force(
    tmp_path: Path, angle: str, torque: str
) -> None:
    time, deflection, force = loading()
    names = f"time [s],Torque [{torque}],Twist [{angle}],Energy [J]"
    path = write_rows(tmp_path / "a.csv", names, time, 1e-3 * force, 1e3 * deflection, 2e-3 * force)
    assert proposed(path)[:4] == ["--columns", "deflection=#3,force=#2", "--units", "deflection=mm,force=N"]


@pytest.mark.parametrize(
    ("header", "columns"),
    [
        ("torque,angle", "deflection=#2,force=#1"),
        ("Drehwinkel,Drehmoment", "deflection=#1,force=#2"),
        ("tau_des,pos_meas,tau_meas", "force=#3"),
    ],
)
def test_an_angle_and_a_torque_are_guessed_by_their_names_too(
    tmp_path: Path, header: str, columns: str
) -> None:
    """Without units, and whichever has the larger numbers; what was asked for is no reading."""
    *_, force = loading()
    rows = (1e-3 * force, force, 2e-3 * force)[: header.count(",") + 1]
    path = write_rows(tmp_path / "a.csv", header, *rows)
    assert proposed(path)[1].endswith(columns)


def test_a_symbol_in_small_letters_goes_before_the_place_of_a_column(tmp_path: Path) -> None:
    """An acceleration, a velocity and the force of a damper; by their order the acceleration was the force."""
    t = np.arange(0.0, 4.0, 0.005)
    x, v, a = 10.0 * np.sin(t), 10.0 * np.cos(t), -10.0 * np.sin(t)
    path = write_rows(tmp_path / "a.csv", "t [s],x [mm],a,f", t, x, a, 2.0 * x + 0.5 * v)
    assert proposed(path) == ["--columns", "force=#4", "--units", "force=N"]
    path = write_rows(tmp_path / "b.csv", "t [s],x [mm],v,load2b", t, x, v, 2.0 * x + 0.5 * v)
    assert proposed(path) == ["--columns", "force=#4", "--units", "force=N"]


def test_of_sensors_in_one_word_the_first_of_each_kind_is_guessed(tmp_path: Path) -> None:
    _, deflection, force = loading()
    rows = (0.1 * force, force, deflection, 2.0 * deflection)
    path = write_rows(tmp_path / "a.csv", "ForceArrayA,ForceArrayB,PositionArrayA,PositionArrayB", *rows)
    assert proposed(path) == ["--columns", "deflection=#3,force=#1", "--units", "deflection=mm,force=N"]


def test_an_acceleration_beside_a_force_is_no_deflection(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(tmp_path / "a.csv", "Time (s),Acceleration,Load (N)", time, deflection, force)
    assert proposed(path) == ["--columns", "deflection=NAME"]


def test_a_gauge_that_rests_is_no_deflection_and_asked_about_where_it_is_given(tmp_path: Path) -> None:
    """Two hundred readings at five values; a gauge of twenty steps follows the motion."""
    time, deflection, force = loading(200)
    coarse = {n: np.round(n * deflection / deflection.max()) / 10.0 for n in (4, 20)}
    still = write_rows(tmp_path / "a.csv", "Time (s),Gauge A,Load (N)", time, coarse[4], force)
    assert proposed(still) == ["--columns", "deflection=NAME"]
    steps = write_rows(tmp_path / "b.csv", "Time (s),Gauge A,Load (N)", time, coarse[20], force)
    assert proposed(steps)[:2] == ["--columns", "deflection=#2"]
    for path, doubted in ((still, True), (steps, False)):
        choices = Choices(part=True, columns={"deflection": "#2"}, units={"deflection": "mm"})
        doubts = understand(path, choices).recording.doubts
        assert any("takes 5 values in 200 readings" in said for said in doubts) == doubted


def test_what_was_asked_for_is_no_reading(tmp_path: Path) -> None:
    """A ventilator and a test lung: the pressure that was set, before the one that was read."""
    time, deflection, force = loading()
    names = "time(sec),pc_setpoint,lung,volume"
    path = write_rows(tmp_path / "a.csv", names, time, np.sign(deflection - 1.0), force, 900.0 * force)
    assert proposed(path)[:2] == ["--columns", "deflection=#3,force=#4"]
    path = write_rows(tmp_path / "b.csv", "time [s],set_point,volume", time, np.sign(force - 9.0), force)
    assert proposed(path)[:2] == ["--columns", "deflection=NAME,force=NAME"]


def test_the_number_of_a_test_is_no_reading(tmp_path: Path) -> None:
    time, deflection, force = loading()
    path = write_rows(tmp_path / "a.csv", "TestID,Way,Cell,run_id", 7.0 + 0.0 * time, deflection, force, time)
    assert proposed(path)[1] == "deflection=#2,force=#3"


def test_what_counts_the_rows_is_no_force(tmp_path: Path) -> None:
    """As pandas writes its index into a file of HDF5, beside the block of values."""
    time, deflection, force = loading()
    path = write_rows(tmp_path / "a.csv", "axis1,b0,b1,b2", np.arange(time.size), time, deflection, force)
    assert proposed(path)[:2] == ["--columns", "time=#2,deflection=#3,force=#4"]


def test_a_time_that_is_no_number_is_refused_and_no_unit_of_it_asked_for(tmp_path: Path) -> None:
    rows = [f"20250603T1405{i / 10:04.1f},{0.1 * i:.1f},{4.0 * i:.1f}" for i in range(100)]
    (tmp_path / "a.csv").write_text("\n".join(["Time,Travel (mm),Load (N)", *rows]) + "\n")
    with pytest.raises(
        RecordingError, match=r"row 2, column 'Time': '20250603T140500.0' is not a number"
    ) as caught:
        understand(tmp_path / "a.csv", Choices(part=True))
    assert not isinstance(caught.value, IncompleteRecording)
