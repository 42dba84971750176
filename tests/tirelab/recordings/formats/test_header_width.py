"""Headers that name more or fewer columns than the rows hold."""

from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.formats.layout import find_layout
from tirelab.recordings.recording import RecordingError, read_recording


def test_a_header_that_names_more_columns_than_the_rows_hold(tmp_path: Path) -> None:
    """A logger whose last sensor is not plugged in."""
    rows = "".join(f"{0.1 * i:g},{2.0 * i:g},{0.5 * i:g}\n" for i in range(40))
    path = tmp_path / "a.csv"
    path.write_text("Millis,Load_Cell,Linear_Pot,Velocity,Thermocouple\n" + rows, encoding="utf-8")
    units = {"time": "s", "force": "N", "deflection": "mm"}
    found = read_recording(path, radius="flat", units=units)
    np.testing.assert_allclose(found.force, 2.0 * np.arange(40))
    np.testing.assert_allclose(found.deflection, 5e-4 * np.arange(40))
    assert "row 1 names 'Velocity' and 'Thermocouple' too, of which the rows hold nothing" in found.notes


def test_units_above_the_numbers_without_names_are_taken(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_text("ms,mm,N\n" + "".join(f"{100 * i},{0.5 * i:g},{2.0 * i:g}\n" for i in range(40)))
    with pytest.raises(RecordingError, match=r"name it with --columns time=#1,deflection=#2,force=#3$"):
        read_recording(path, radius="flat")
    columns = {"time": "#1", "deflection": "#2", "force": "#3"}
    found = read_recording(path, radius="flat", columns=columns)
    np.testing.assert_allclose(found.time, 0.1 * np.arange(40))
    np.testing.assert_allclose(found.deflection, 5e-4 * np.arange(40))


@pytest.mark.parametrize("lines", [10, 299, 600])
def test_a_table_below_many_lines_about_the_test_is_found(tmp_path: Path, lines: int) -> None:
    path = tmp_path / "a.csv"
    above = "".join(f"Parameter {i};{1.5 * i:g}\n" for i in range(lines))
    rows = "".join(f"{0.1 * i:g};{0.5 * i:g};{2.0 * i:g}\n" for i in range(400))
    path.write_text(f"{above}time [s];stroke [mm];force [N]\n{rows}")
    found = read_recording(path, radius="flat")
    np.testing.assert_allclose(found.force, 2.0 * np.arange(400))
    assert len(found.provenance) > 1


@pytest.mark.parametrize("mark", ["#", "# ", "%", "% ", "//", "! ", "; ", "* ", ">> "])
def test_what_stands_before_the_names_is_no_part_of_the_first(tmp_path: Path, mark: str) -> None:
    path = tmp_path / "a.txt"
    rows = "".join(f"{0.1 * i:g}\t{0.5 * i:g}\t{2.0 * i:g}\n" for i in range(40))
    path.write_text(f"{mark}time [s]\tstroke [mm]\tforce [N]\n{rows}")
    np.testing.assert_allclose(read_recording(path, radius="flat").time, 0.1 * np.arange(40))


@pytest.mark.parametrize(
    "names",
    [
        "s,mm,kN\nTime,Stroke,Load\n",
        "# Time,Stroke,Load\n# s,mm,kN\n",
        "# Time,Stroke,Load\n# [s],[mm],[kN]\n",
    ],
)
def test_units_above_the_names_and_in_a_second_comment_are_taken(tmp_path: Path, names: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(names + "".join(f"{0.1 * i:g},{0.5 * i:g},{2.0 * i:g}\n" for i in range(40)))
    found = read_recording(path, radius="flat")
    np.testing.assert_allclose(found.force, 2000.0 * np.arange(40))
    np.testing.assert_allclose(found.deflection, 5e-4 * np.arange(40))


def test_a_clock_of_twelve_hours_goes_on_after_twelve(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    clock = [f"{12 if i < 30 else 1}:{(30 + i) % 60:02d}:00" for i in range(60)]
    rows = "".join(f"{clock[i]},{0.5 * i:g},{2.0 * i:g}\n" for i in range(60))
    path.write_text("Time,stroke [mm],force [N]\n" + rows)
    found = read_recording(path, radius="flat")
    np.testing.assert_allclose(found.time, 60.0 * np.arange(60))
    assert "the clock passes twelve at row 32: twelve hours added from there on" in found.notes


def test_a_header_that_names_fewer_columns_than_the_rows_hold_is_said(tmp_path: Path) -> None:
    rows = "".join(f"{0.1 * i:g},{2.0 * i:g},{0.5 * i:g}\n" for i in range(40))
    path = tmp_path / "a.csv"
    path.write_text("time [s],force [N]\n" + rows, encoding="utf-8")
    columns = {"time": "#1", "force": "#2", "deflection": "#3"}
    units = {"time": "s", "force": "N", "deflection": "mm"}
    found = read_recording(path, radius="flat", columns=columns, units=units)
    assert "row 1 names 2 columns and the rows hold 3: its names are not taken" in found.notes


def test_a_header_with_a_column_of_events_that_few_rows_have(tmp_path: Path) -> None:
    """A data logger's text: settings, names of no channel, a clock of half a day, and the start in the first row."""
    clock = ["11:59:59.900 AM", "11:59:59.950 AM", "12:00:00.000 PM", "12:00:00.050 PM"]
    clock += [f"12:00:{0.1 + 0.05 * i:06.3f} PM" for i in range(36)]
    lines = [f"  {i + 1},   05/13/2022 {time}, {0.01 * i:.4f}, {0.5 * i:.4f}" for i, time in enumerate(clock)]
    for row, event in ((0, "DAQ Start"), (17, "DAQ Pause"), (18, "DAQ Resume"), (39, "DAQ Pause")):
        lines[row] += f", {event}"
    above = ["Header Size:  7", "Sampling Interval:  0.05", "Sample Count:  40"]
    names = "Sample Number, Date/Time, CHANNEL0, CHANNEL1, Events"
    path = tmp_path / "a.txt"
    path.write_text("\n".join([*above, names, *lines]) + "\n", encoding="utf-8")
    layout = find_layout(path)
    assert [header.name for header in layout.headers] == [name.strip() for name in names.split(",")]
    columns = {"time": "Date/Time", "deflection": "CHANNEL0", "force": "CHANNEL1"}
    units = {"deflection": "10mm", "force": "980.665N"}
    found = read_recording(path, radius="flat", columns=columns, units=units)
    np.testing.assert_allclose(found.time, 0.05 * np.arange(40), atol=1e-9)
    np.testing.assert_allclose(found.deflection, 1e-4 * np.arange(40))
    np.testing.assert_allclose(found.force, 490.3325 * np.arange(40))
