"""The separator of a table in which no block of numbers was found."""

from __future__ import annotations

from pathlib import Path

import pytest
from tirelab.recordings.formats.separator import find_separator
from tirelab.recordings.formats.table import RecordingError

FILE = Path("rig.csv")


@pytest.mark.parametrize("mark", ["\t", ";", ",", "|"])
def test_the_character_that_all_rows_confirm_separates(mark: str) -> None:
    assert find_separator(FILE, [mark.join(row) for row in (["a", "b, c"], ["x", "y"], ["u", "v"])]) == mark


def test_of_two_the_one_with_the_same_number_of_cells_separates() -> None:
    assert find_separator(FILE, ["a,b;c", "1,5;2,5,1", "3;4"]) == ";"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["words", "more words"], "no comma, semicolon"),
        (["time", '"0.1,""0.2"",3"', '"0.2,""0.3"",4"'], "each row is quoted as one cell ('0.2,"),
    ],
)
def test_where_none_separates_it_is_said_why(lines: list[str], said: str) -> None:
    with pytest.raises(RecordingError, match=r"rig\.csv") as refused:
        find_separator(FILE, lines)
    assert said in str(refused.value)
