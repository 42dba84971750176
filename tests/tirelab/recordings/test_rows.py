"""Rows that lack a value: skipped with a note, refused where they are many, and placed where they stand in the file."""

from collections.abc import Mapping

import numpy as np
import pytest
from tirelab.recordings.formats import Columns, Header, RecordingError
from tirelab.recordings.origin import Origin
from tirelab.recordings.rows import MOST_NAMED, Rows, complete_rows

NAN = np.nan


def rows_of(**columns: np.ndarray | list[float]) -> Rows:
    headers: Mapping[str, Header] = {name: Header(name, None, f"{name} [x]") for name in columns}
    values = tuple(np.array(column, dtype=float) for column in columns.values())
    return complete_rows(Origin("a.csv"), headers, Columns(values, lambda i: f"row {i + 2}"))


def with_gaps(samples: int, *missing: int) -> np.ndarray:
    values = np.arange(samples, dtype=float)
    values[list(missing)] = NAN
    return values


def test_complete_rows_are_handed_on_as_they_are() -> None:
    rows = rows_of(time=[0.0, 1.0], force=[5.0, 6.0])
    assert rows.notes == ()
    assert rows.kept is None
    np.testing.assert_array_equal(rows.values["force"], [5.0, 6.0])
    assert rows.place(1) == "row 3"


def test_a_row_that_lacks_a_value_is_skipped_and_named() -> None:
    rows = rows_of(time=np.arange(20.0), force=with_gaps(20, 3), deflection=with_gaps(20, 3, 7))
    assert rows.notes == ("skipped for want of force and deflection: row 5, row 9",)
    np.testing.assert_array_equal(rows.values["time"], np.delete(np.arange(20.0), [3, 7]))
    # The fourth row that is left was the fifth.
    assert rows.place(3) == "row 6"
    assert str(rows.error(3, "force", "is odd")) == "a.csv, row 6, column 'force [x]': is odd"


def test_an_error_of_a_channel_without_a_column_names_the_row_alone() -> None:
    rows = rows_of(time=[0.0, 1.0], force=[5.0, 6.0])
    assert str(rows.error(0, "radius", "is odd")) == "a.csv, row 2: is odd"


def test_empty_rows_are_no_rows() -> None:
    rows = rows_of(time=with_gaps(10, 4, 5, 6), force=with_gaps(10, 4, 5, 6))
    assert rows.notes == ("skipped as empty: row 6, row 7, row 8",)
    assert len(rows.values["time"]) == 7


@pytest.mark.parametrize("mark", [9.9e37, 9.91e37, -9.9e37, 3.402823e38, 1.797693134862315e308])
def test_the_numbers_that_instruments_write_for_no_reading_are_blank(mark: float) -> None:
    force = np.arange(40.0)
    force[[5, 7]] = mark, NAN
    rows = rows_of(time=np.arange(40.0), force=force)
    assert rows.notes == ("skipped for want of force: row 7, row 9",)


def test_many_skipped_rows_are_counted() -> None:
    missing = range(0, 400, 16)
    rows = rows_of(time=np.arange(400.0), force=with_gaps(400, *missing))
    assert rows.notes[0].endswith(f"and {len(missing) - MOST_NAMED} more")
    assert rows.notes[0].count("row") == MOST_NAMED


def test_columns_that_were_not_recorded_together_are_refused() -> None:
    with pytest.raises(RecordingError, match=r"3 of 20 rows have no value for force \(row 2 the first\)"):
        rows_of(time=np.arange(20.0), force=with_gaps(20, 0, 1, 2))


def test_an_optional_channel_with_many_blanks_is_left_out() -> None:
    rows = rows_of(time=np.arange(20.0), force=np.ones(20), speed=with_gaps(20, 1, 2, 3))
    assert rows.notes == ("speed left out: 3 of 20 rows have no value for it",)
    assert set(rows.values) == {"time", "force"}
    assert len(rows.values["time"]) == 20


def test_an_optional_channel_with_few_blanks_costs_their_rows() -> None:
    rows = rows_of(time=np.arange(20.0), force=np.ones(20), speed=with_gaps(20, 1))
    assert rows.notes == ("skipped for want of speed: row 3",)
    assert len(rows.values["speed"]) == 19


@pytest.mark.parametrize(
    ("columns", "sentence"),
    [
        ({"time": [], "force": []}, "has a header and no rows below it"),
        ({"time": [NAN], "force": [NAN]}, "has no row with a value in every column"),
        ({"time": [1.0], "force": [1.0]}, "has a single row with a value in every column"),
    ],
)
def test_too_few_rows_are_refused(columns: dict[str, list[float]], sentence: str) -> None:
    with pytest.raises(RecordingError, match=sentence):
        rows_of(**columns)


def test_a_row_written_twice_is_kept_once_and_named() -> None:
    rows = rows_of(time=[0.0, 1.0, 1.0, 2.0], force=[5.0, 6.0, 6.0, 7.0])
    assert rows.notes == ("skipped as equal to the row before, its time among it: row 4",)
    np.testing.assert_array_equal(rows.values["force"], [5.0, 6.0, 7.0])
    assert rows.place(2) == "row 5"
    # two forces at one time are no copy: which is right is not decided here
    other = rows_of(time=[0.0, 1.0, 1.0, 2.0], force=[5.0, 6.0, 6.5, 7.0])
    assert other.kept is None
    # without a clock nothing says that equal readings are one
    assert rows_of(force=[5.0, 5.0, 6.0]).kept is None


@pytest.mark.parametrize(("force", "skipped"), [(49.5, ["row 52"]), (90.0, [])])
def test_of_two_rows_at_one_rounded_time_the_first_is_kept_where_both_are_of_the_motion(
    force: float, skipped: list[str]
) -> None:
    """A reading that is far from those around it may be a row of another place: which is right is not decided here."""
    time, deflection, read = (np.insert(np.arange(100.0), 50, own) for own in (49.0, 49.5, force))
    rows = rows_of(time=time, deflection=deflection, force=read)
    said = "skipped as at the time of the row before, to which the clock is rounded: "
    assert rows.notes == tuple(said + row for row in skipped)


def test_rows_before_the_clock_runs_are_skipped_and_named() -> None:
    rows = rows_of(time=[0.0, 0.0, 0.0, 0.1, 0.2], force=[5.0, 5.5, 6.0, 7.0, 8.0])
    assert rows.notes == ("skipped as before the clock runs: row 2, row 3",)
    np.testing.assert_array_equal(rows.values["time"], [0.0, 0.1, 0.2])
    np.testing.assert_array_equal(rows.values["force"], [6.0, 7.0, 8.0])
    assert rows.place(0) == "row 4"
    # one row alone is one of them where nothing has moved
    one = rows_of(time=[0.0, 0.0, 0.5], deflection=[1.0, 1.0, 2.0], force=[-43.4, -43.5, 524.7])
    assert one.notes == ("skipped as before the clock runs: row 2",)
    assert rows_of(time=[0.0, 0.0, 0.5], deflection=[1.0, 1.1, 2.0], force=[5.0, 5.5, 6.0]).kept is None
    # one row alone, a clock that is coarser than the samples, and one that never runs
    assert rows_of(time=[0.0, 0.0, 0.1], force=[5.0, 5.5, 6.0]).kept is None
    assert rows_of(time=[0.0, 0.0, 1.0, 1.0, 2.0], force=[5.0, 5.5, 6.0, 7.0, 8.0]).kept is None
    assert rows_of(time=[0.0, 0.0, 0.0], force=[5.0, 5.5, 6.0]).kept is None
