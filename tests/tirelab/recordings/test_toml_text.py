"""TOML as its standard has it: 64 bits are read exactly, and what is longer is refused by its key."""

from __future__ import annotations

import pytest
from tirelab.recordings.toml_text import parse_toml


def test_the_integers_of_the_standard_are_read() -> None:
    text = "a = 9223372036854775807\nb = [-9223372036854775808, 1.5]\nc = true\n"
    assert parse_toml(text) == {"a": 2**63 - 1, "b": [-(2**63), 1.5], "c": True}


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("rows = 9223372036854775808", "rows"),
        ("rows = -9223372036854775809", "rows"),
        ("rows = 1" + "0" * 400, "rows"),
        ("rows = 0x" + "f" * 5000, "rows"),
        ("rows = [1, [2, 1" + "0" * 400 + "]]", "rows"),
        ('[files."a.csv"]\nrows = 1' + "0" * 400, "files.a.csv.rows"),
        ("[[files]]\nrows = 1" + "0" * 400, "files.rows"),
    ],
)
def test_a_longer_one_is_refused_by_its_key(text: str, key: str) -> None:
    with pytest.raises(ValueError, match=f"^{key} is an integer of more than 64 bits$"):
        parse_toml(text)


def test_what_is_no_toml_is_an_error_of_the_value() -> None:
    with pytest.raises(ValueError, match="Invalid value"):
        parse_toml("rows = ")
