"""Why a document cannot be used, in words."""

from __future__ import annotations

import json

import pytest
from tirelab.errors import missing_library, what_is_wrong


def wrong(text: str) -> str:
    """Read a number below "a" in a JSON document as a reader of files does."""
    try:
        json.loads(text)["a"] + 0
    except Exception as error:
        return what_is_wrong(error)
    raise AssertionError("nothing is wrong with it")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('{"a": 1,\n b}', "not JSON at line 2, column 2"),
        ('{"b": 1}', "it has no entry 'a'"),
        ('{"a": "one"}', "an entry is of another kind than it should be"),
        ("[1]", "an entry is of another kind than it should be"),
    ],
)
def test_a_damaged_document_is_told_without_a_programmers_words(text: str, told: str) -> None:
    assert wrong(text) == told


def test_a_sentence_of_our_own_stays() -> None:
    assert what_is_wrong(ValueError("schema 9 is none of 1, 2")) == "schema 9 is none of 1, 2"


def test_a_missing_library_is_told_with_its_command() -> None:
    assert missing_library("reading TDMS", "nptdms", "npTDMS").endswith("python -m pip install npTDMS")
