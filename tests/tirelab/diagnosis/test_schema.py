"""diagnosis.json against the JSON Schema that documents it."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest


@pytest.fixture(scope="module")
def schema(repository: Path) -> Any:
    path = repository / "examples" / "docs" / "diagnosis.schema.json"
    found = json.loads(path.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(found)
    return found


def test_a_diagnosis_follows_its_schema(damped_run: Any, schema: Any) -> None:
    jsonschema.validate(json.loads((damped_run.out / "diagnosis.json").read_text(encoding="utf-8")), schema)


@pytest.mark.parametrize("key", ["schema", "verdict", "fit"])
def test_a_missing_key_is_found(damped_run: Any, schema: Any, key: str) -> None:
    content = json.loads((damped_run.out / "diagnosis.json").read_text(encoding="utf-8"))
    less = copy.deepcopy(content)
    del less[key]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(less, schema)
