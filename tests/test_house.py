"""The house stays one that a newcomer can walk through: few rooms, few levels, one direction."""

from __future__ import annotations

import house
import pytest


@pytest.fixture(scope="module")
def measured() -> house.House:
    return house.measure()


def test_no_import_runs_in_a_circle(measured: house.House) -> None:
    assert house.circle_in(measured.rooms) == []
    assert house.circle_in(measured.files) == []


def test_there_are_few_rooms_on_few_levels(measured: house.House) -> None:
    assert len(measured.rooms) <= 26
    assert max(measured.levels().values()) <= 9
    assert len(measured.flat) <= 5, measured.flat


def test_every_import_runs_down(measured: house.House) -> None:
    levels = measured.levels()
    up = [(a, b) for a, others in measured.rooms.items() for b in others if levels[b] >= levels[a]]
    assert up == []


def test_no_function_takes_too_much_and_no_frozen_value_can_change() -> None:
    assert house.long_functions() == []
    assert house.mutable_fields() == []


def test_a_circle_is_found() -> None:
    graph = {"a": frozenset({"b"}), "b": frozenset({"c"}), "c": frozenset({"a"}), "d": frozenset({"a"})}
    assert house.circle_in(graph) == ["a", "b", "c", "a"]
    assert house.circle_in({"a": frozenset({"b"}), "b": frozenset()}) == []
