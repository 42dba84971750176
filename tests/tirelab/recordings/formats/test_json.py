"""The recording comes the same from JSON, in rows, lines or columns, and what is none is refused."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from one_recording import COLUMNS, SAMPLES, TIME, assert_the_recording, refusal
from tirelab.recordings.recording import read_recording
from tirelab.recordings.units import split_header

LISTS = {name: np.asarray(values).tolist() for name, values in COLUMNS.items()}
ROWS = [dict(zip(LISTS, row, strict=True)) for row in zip(*LISTS.values(), strict=True)]


def described(name: str) -> dict[str, dict[str, Any]]:
    """The channels as objects of their own, with their units beside the lists."""
    parts = {text: split_header(text) for text in LISTS}
    return {
        bare: {name: bare if name == "name" else 3, "unit": unit, "values": LISTS[text]}
        for text, (bare, unit) in parts.items()
    }


WRITTEN: dict[str, Callable[[], str]] = {
    "rows.json": lambda: json.dumps(ROWS),
    "columns.json": lambda: json.dumps({"operator": "me", "short": [1, 2], **LISTS}),
    "named.json": lambda: json.dumps({"rig": {"load cell": 3}, "samples": ROWS}),
    "inside.json": lambda: json.dumps({"source": {"year": 2014}, "test": {"name": "A", "read": LISTS}}),
    "sources beside.json": lambda: json.dumps(
        {
            "source": [{"year": 2014, "page": 3}, {"year": 2015, "page": 8}],
            "test": LISTS,
            "steps": [[1, 2], [3, 4]],
        }
    ),
    "channels.json": lambda: json.dumps({"test": "A", "channels": list(described("name").values())}),
    "channels by key.json": lambda: json.dumps({"test": "A", **described("remark")}),
    "numbered.json": lambda: json.dumps({name: dict(enumerate(values)) for name, values in LISTS.items()}),
    "numbered rows.json": lambda: json.dumps(dict(enumerate(ROWS, 100))),
    "rows inside.json": lambda: json.dumps({"test": {"read": ROWS}}),
    "names above.json": lambda: json.dumps([list(LISTS), *(list(row.values()) for row in ROWS)]),
    "split.json": lambda: json.dumps(
        {
            "columns": list(LISTS),
            "index": list(range(SAMPLES)),
            "data": [list(row.values()) for row in ROWS],
        }
    ),
    "table.json": lambda: json.dumps(
        {
            "schema": {
                "fields": [
                    {"name": "index", "type": "integer"},
                    *({"name": n, "type": "number"} for n in LISTS),
                ],
                "primaryKey": ["index"],
                "pandas_version": "1.4.0",
            },
            "data": [{"index": i, **row} for i, row in enumerate(ROWS)],
        }
    ),
    "lines.jsonl": lambda: "\n".join(map(json.dumps, ROWS)),
    "lines.ndjson": lambda: "\n".join(map(json.dumps, ROWS)) + "\n",
}


class TestJson:
    @pytest.mark.parametrize("name", WRITTEN)
    def test_columns_with_units_in_their_names(self, tmp_path: Path, name: str) -> None:
        (tmp_path / name).write_text(WRITTEN[name](), encoding="utf-8")
        assert_the_recording(read_recording(tmp_path / name, radius="flat"))

    @pytest.mark.parametrize("inside", [False, True])
    def test_rows_of_numbers_are_named_by_their_place(self, tmp_path: Path, inside: bool) -> None:
        rows = [list(row.values()) for row in ROWS]
        (tmp_path / "a.json").write_text(json.dumps({"rig": 3, "data": rows} if inside else rows))
        assert "column 1" in refusal(tmp_path / "a.json")
        columns = {channel: f"#{i + 1}" for i, channel in enumerate(("time", "deflection", "force"))}
        units = {"time": "s", "deflection": "mm", "force": "N"}
        found = read_recording(tmp_path / "a.json", columns=columns, units=units, radius="flat")
        np.testing.assert_allclose(found.time, TIME, atol=1e-12)
        assert found.force.size == SAMPLES

    def test_a_point_in_a_key_belongs_to_it_and_keys_of_one_name_are_told_apart(self, tmp_path: Path) -> None:
        time, deflection, force = (np.asarray(values).tolist() for values in COLUMNS.values())
        both = {
            "t.": {"time [s]": time, "Displ. [mm]": deflection},
            "a": {"load": force},
            "b": {"load": force},
        }
        (tmp_path / "a.json").write_text(json.dumps(both), encoding="utf-8")
        columns = {"deflection": "Displ.", "force": "a.load"}
        found = read_recording(tmp_path / "a.json", columns=columns, units={"force": "N"}, radius="flat")
        assert found.deflection.max() == pytest.approx(1e-3 * max(deflection))

    def test_what_a_sample_does_not_have_is_blank(self, tmp_path: Path) -> None:
        force = next(name for name in LISTS if "orce" in name)
        rows = [{n: v for n, v in row.items() if i != 8 or n != force} for i, row in enumerate(ROWS)]
        (tmp_path / "a.json").write_text(json.dumps(rows), encoding="utf-8")
        recording = read_recording(tmp_path / "a.json", radius="flat")
        assert "skipped for want of force: sample 9" in recording.notes
        np.testing.assert_allclose(recording.time, np.delete(TIME, 8), atol=1e-12)

    def test_channels_of_one_name_are_told_apart(self, tmp_path: Path) -> None:
        channels = [*described("name").values(), {"name": "force", "unit": "kN", "values": [0.0] * SAMPLES}]
        channels = [{**one, "name": one["name"].lower()} for one in channels]
        (tmp_path / "a.json").write_text(json.dumps(channels), encoding="utf-8")
        assert "'3.force [kN]'" in refusal(tmp_path / "a.json", columns={"force": "load"})

    @pytest.mark.parametrize(
        ("held", "said"),
        [
            ({"a": ROWS, "b": ROWS}, "holds 2 tables; write one list of samples"),
            ({"a": {"b": ROWS}, "c": ROWS}, "holds 2 tables; write one list of samples"),
            ({"rig": 3}, "no table is found in it"),
            (5, "no table is found in it"),
            ([1.0] * SAMPLES, "no table is found in it"),
            ([[1.0, 2.0], [1.0]], "no table is found in it"),
        ],
    )
    def test_what_is_no_table_is_told(self, tmp_path: Path, held: Any, said: str) -> None:
        (tmp_path / "a.json").write_text(json.dumps(held), encoding="utf-8")
        assert said in refusal(tmp_path / "a.json")

    def test_what_is_cut_short_is_told(self, tmp_path: Path) -> None:
        (tmp_path / "a.json").write_text(json.dumps(ROWS)[:-20], encoding="utf-8")
        assert "cannot be read as JSON" in refusal(tmp_path / "a.json")
