"""Tires as files: what is written is read back exactly, and what is wrong is said with its place."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from driving import tire_with
from radialtire import (
    CATALOGUE,
    Hull1996,
    ParameterError,
    PowerLaw,
    TestedRange,
    TireFileError,
    TireModel,
    parameters_of,
    read_tire,
    with_parameters,
    write_tire,
)
from radialtire.tirefile import from_text, to_text

TIRES = [
    TireModel(),
    TireModel(PowerLaw(1500.0, 1.0), tested_range=None, name="road", source="quoted"),
    TireModel(Hull1996(flat_coefficient=600.1), tested_range=TestedRange(force_max=0.1 + 0.2)),
    tire_with(*((name, effect.nominal) for name, effect in CATALOGUE.items()), reading_noise=8e-6),
]


def written(tmp_path: Path, content: Any) -> Path:
    path = tmp_path / "tire.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


@pytest.mark.parametrize("tire", TIRES)
def test_what_is_written_is_read_back_exactly(tire: TireModel, tmp_path: Path) -> None:
    write_tire(tire, tmp_path / "tire.json")
    assert read_tire(tmp_path / "tire.json") == tire


def test_a_folder_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(
        TireFileError, match=r"none.tire\.json: its folder is not there; make it, or name another"
    ):
        write_tire(TireModel(), tmp_path / "none" / "tire.json")


def test_a_tire_of_law_and_schema_alone_has_the_starts(tmp_path: Path) -> None:
    tire = read_tire(written(tmp_path, {"schema": 1, "law": {"name": "hull1996"}}))
    assert tire == TireModel(tested_range=None, name="", source="")


def test_effects_of_a_file_may_stand_in_any_order(tmp_path: Path) -> None:
    effects = [
        {"name": "inertia", "parameters": {"mass": 2}},
        {"name": "viscous_damping", "parameters": {"damping": 300.0}},
        {"name": "deflection_offset"},
    ]
    tire = read_tire(written(tmp_path, {"schema": 1, "law": {"name": "power_law"}, "effects": effects}))
    assert [effect.name for effect, _ in tire.effects] == ["deflection_offset", "viscous_damping", "inertia"]
    assert [values for _, values in tire.effects] == [(0.0,), (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0), (2.0,)]


LAW = {"name": "hull1996"}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("{", "not JSON (Expecting property name enclosed in double quotes: line 1 column 2 (char 1))"),
        ("[" * 100_000, "not JSON (maximum recursion depth exceeded"),
        ([], "the tire must be an object with law, schema, not []"),
        ({"law": LAW}, "no entry 'schema' in the tire; add it"),
        ({"schema": 1}, "no entry 'law' in the tire; add it"),
        ({"schema": 2, "law": LAW}, "schema 2 is not 1; use the version that wrote the file"),
        (
            {"schema": 1, "law": LAW, "colour": "red"},
            "unknown entry 'colour' in the tire; known are curve, effects, inflated, law",
        ),
        ({"schema": 1, "law": LAW, "name": 5}, "name must be text, not 5"),
        ({"schema": 1, "law": "hull1996"}, "the law must be an object with name, not 'hull1996'"),
        ({"schema": 1, "law": {"name": "hook"}}, "unknown law 'hook'; known are hull1996, power_law"),
        ({"schema": 1, "law": {"name": ["hull1996"]}}, "unknown law ['hull1996']"),
        (
            {"schema": 1, "law": {**LAW, "parameters": {"A": 1}}},
            "unknown entry 'A' in the parameters of hull1996",
        ),
        (
            {"schema": 1, "law": {**LAW, "parameters": {"flat_exponent": "1"}}},
            "flat_exponent = '1' is not a number; it must lie between 0.1 and 10",
        ),
        ({"schema": 1, "law": LAW, "effects": {}}, "effects must be a list, not {}"),
        (
            {"schema": 1, "law": {"name": "recalibrated", "base": LAW, "surfaces": {}}},
            "surfaces must be a list, not {}",
        ),
        (
            {"schema": 1, "law": LAW, "effects": ["inertia"]},
            "an effect must be an object with name, not 'inertia'",
        ),
        ({"schema": 1, "law": LAW, "effects": [{"name": "magic"}]}, "unknown effect 'magic'; known are"),
        ({"schema": 1, "law": LAW, "effects": [{"name": None}]}, "unknown effect None; known are"),
        (
            {"schema": 1, "law": LAW, "effects": [{"name": "inertia"}, {"name": "inertia"}]},
            "an effect occurs twice in inertia, inertia; keep one of each",
        ),
        (
            {"schema": 1, "law": LAW, "effects": [{"name": "inertia", "parameters": {"mass": -1}}]},
            "mass = -1 is not allowed; it must lie between 0 and 1e+06 kg",
        ),
        ({"schema": 1, "law": LAW, "reading_noise": "much"}, "reading_noise = 'much' is not a number"),
        (
            {"schema": 1, "law": LAW, "tested_range": {"force_max": 1.0}},
            "no entry 'curvature_max' in tested_range",
        ),
        (
            '{"schema": 1, "law": {"name": "hull1996"}, "tested_range": {"curvature_min": -1, "curvature_max": NaN, '
            '"deflection_max": 1, "force_max": 1}}',
            "tested_range curvature_max = nan is not a finite number",
        ),
        (
            '{"schema": 1, "law": {"name": "hull1996"}, "tested_range": {"curvature_min": true, "curvature_max": 1, '
            '"deflection_max": 1, "force_max": 1}}',
            "tested_range curvature_min = True is not a finite number",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_place(content: Any, said: str, tmp_path: Path) -> None:
    path = written(tmp_path, content)
    with pytest.raises(TireFileError) as refusal:
        read_tire(path)
    assert str(refusal.value).startswith(f"{path}: ")
    assert said in str(refusal.value)


BEYOND = 10**400
"""An integer beyond every double: JSON has no bound for it."""


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ({"law": {**LAW, "parameters": {"flat_exponent": BEYOND}}}, "flat_exponent = inf is not allowed"),
        ({"effects": [{"name": "inertia", "parameters": {"mass": -BEYOND}}]}, "mass = -inf is not allowed"),
        ({"reading_noise": BEYOND}, "reading_noise = inf is not allowed"),
        (
            {
                "tested_range": {
                    "curvature_min": 0,
                    "curvature_max": 1,
                    "deflection_max": 1,
                    "force_max": BEYOND,
                }
            },
            "tested_range force_max = inf is not a finite number",
        ),
        (
            {"learned_remainder": {"by": "deflection", "at": [0, BEYOND], "force": [0, 1]}},
            "learned_remainder has a value that is no finite number",
        ),
        (
            {
                "law": {
                    "name": "recalibrated",
                    "base": LAW,
                    "surfaces": [{"radius": 1, "change": BEYOND, "exponent_change": 0}],
                }
            },
            "the change of the law at the radius 1 m, inf and 0, is not allowed",
        ),
    ],
)
def test_an_integer_beyond_every_double_is_refused_by_its_key(
    content: dict[str, Any], said: str, tmp_path: Path
) -> None:
    path = written(tmp_path, {"schema": 1, "law": LAW, **content})
    with pytest.raises(TireFileError, match=f"^{re.escape(str(path))}: ") as refusal:
        read_tire(path)
    assert said in str(refusal.value)


def test_so_is_one_of_more_digits_than_python_reads(tmp_path: Path) -> None:
    path = written(tmp_path, '{"schema": 1, "law": {"name": "hull1996"}, "preload": 1' + "0" * 5000 + "}")
    with pytest.raises(TireFileError, match="preload = inf is not allowed"):
        read_tire(path)


def test_a_file_that_is_not_there_is_said_so(tmp_path: Path) -> None:
    with pytest.raises(TireFileError, match=r"No such file or directory; name a tire file that can be read$"):
        read_tire(tmp_path / "none.json")


def test_a_file_that_is_not_text_is_said_so(tmp_path: Path) -> None:
    path = tmp_path / "tire.json"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(TireFileError, match="not UTF-8 text; a tire file is JSON in UTF-8"):
        read_tire(path)


def test_parameters_are_named_by_their_owner() -> None:
    tire = tire_with(("viscous_damping", (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)))
    found = {name: value for name, (_, value) in parameters_of(tire).items()}
    assert found["law.flat_exponent"] == 1.422
    assert found["viscous_damping.damping"] == 300.0
    assert found["reading_noise"] == 0.0
    assert len(found) == len(Hull1996.parameters) + 8


def test_the_noise_of_the_reading_is_a_parameter_where_a_rate_is_looked_at() -> None:
    tire = tire_with(("inertia", (2.0,)), reading_noise=8e-6)
    assert with_parameters(tire, {"reading_noise": 0.0}) == tire_with(("inertia", (2.0,)))
    with pytest.raises(ParameterError, match="reading_noise = -1 is not allowed"):
        with_parameters(tire, {"reading_noise": -1.0})
    assert "reading_noise" not in parameters_of(TireModel())
    assert "reading_noise" not in parameters_of(tire_with(("force_offset", (5.0,))))


def test_parameters_can_be_replaced_by_name() -> None:
    tire = tire_with(("viscous_damping", (300.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)), ("inertia", (2.0,)))
    other = with_parameters(tire, {"viscous_damping.damping": 1.0, "law.flat_coefficient": 600.0})
    assert (
        other.effects
        == tire_with(("viscous_damping", (1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)), ("inertia", (2.0,))).effects
    )
    assert other.law == Hull1996(flat_coefficient=600.0)
    assert with_parameters(tire, {}) == tire


def test_a_replacement_outside_its_bounds_is_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"mass = -2 is not allowed; it must lie between 0 and 1e\+06 kg"
    ):
        with_parameters(tire_with(("inertia", (2.0,))), {"inertia.mass": -2.0})


def test_a_parameter_that_does_not_exist_is_not_made_up() -> None:
    with pytest.raises(KeyError, match=r"inertia\.mass"):
        with_parameters(TireModel(), {"inertia.mass": 2.0})


def test_a_part_without_air_says_so_in_its_file() -> None:
    part = TireModel(inflated=False)
    assert from_text(to_text(part)) == part
    assert from_text(to_text(TireModel())).inflated
    assert "inflated" not in to_text(TireModel())
    with pytest.raises(TireFileError, match="inflated must be true or false, not 0"):
        from_text(to_text(part).replace('"inflated": false', '"inflated": 0'))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (
            {"curvature_min": 5, "curvature_max": -5},
            "curvature_min = 5 is more than curvature_max = -5; exchange the two",
        ),
        ({"deflection_max": -1}, "deflection_max = -1 is not allowed; it must be above 0"),
        ({"force_max": 0}, "force_max = 0 is not allowed; it must be above 0"),
        (
            {"deflection_max": 20},
            "deflection_max = 20 m is not allowed; it must be at most 0.33 m: is it in mm?",
        ),
    ],
)
def test_a_tested_range_in_which_nothing_can_lie_is_refused(changed: dict[str, float], said: str) -> None:
    tested = {"curvature_min": -1, "curvature_max": 1, "deflection_max": 0.02, "force_max": 100}
    with pytest.raises(TireFileError, match=f"^tested_range {re.escape(said)}$"):
        from_text(json.dumps({"schema": 1, "law": LAW, "tested_range": {**tested, **changed}}))


def test_a_part_may_have_been_pulled_alone_and_far() -> None:
    pulled = TireModel(PowerLaw(10.0, 1.0), (), TestedRange(-1e-5, 1e-5, -0.01, -5.0), two_sided=True)
    assert from_text(to_text(pulled)) == pulled
    long = TireModel(PowerLaw(10.0, 1.0), (), TestedRange(-1e-5, 1e-5, 2.0, 5.0), inflated=False)
    assert from_text(to_text(long)) == long


def test_an_entry_that_stands_twice_is_refused() -> None:
    twice = '{"schema": 1, "law": {"name": "power_law", "parameters": {"exponent": 1.4, "exponent": 1.0}}}'
    with pytest.raises(TireFileError, match=r"^the entry 'exponent' stands twice in one object; keep one"):
        from_text(twice)


def test_a_schema_is_a_number() -> None:
    with pytest.raises(TireFileError, match="schema True is not 1; use the version that wrote the file"):
        from_text('{"schema": true, "law": {"name": "hull1996"}}')


def test_a_file_with_the_mark_of_its_encoding_is_read(tmp_path: Path) -> None:
    path = written(tmp_path, "\ufeff" + to_text(TireModel()))
    assert path.read_bytes().startswith(b"\xef\xbb\xbf")
    assert read_tire(path) == TireModel()
