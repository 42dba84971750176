"""The rig's table of A and B as a tire of the tool."""

from __future__ import annotations

import math
from pathlib import Path

import concealed
import pytest
from radialtire import TireModel, read_tire, write_tire
from tirelab.errors import TirelabError
from tirelab.validation.baseline import baseline_tire

ROWS = [
    {"radius [cm]": -38.1, "A": 600.0, "B": 1.5},
    {"radius [cm]": "inf", "A": 500.0, "B": 1.4},
    {"radius [cm]": 1.27, "A": 300.0, "B": 1.25},
]


def test_a_table_keeps_its_numbers_through_a_tire_file(tmp_path: Path) -> None:
    write_tire(baseline_tire({"law": "table", "surfaces": ROWS}), tmp_path / "tire.json")
    law = read_tire(tmp_path / "tire.json").law
    for radius, A, B in ((-0.381, 600.0, 1.5), (math.inf, 500.0, 1.4), (0.0127, 300.0, 1.25)):
        # the logarithm and its inverse cost a few units in the last place
        assert law.coefficients(radius) == pytest.approx((A, B), rel=1e-14)


def test_the_article_of_the_rig_is_ours() -> None:
    trial = concealed.draw(7)  # a seed whose baseline is the article's tire
    assert trial.baseline_source == "hull1996"
    assert baseline_tire(concealed.baseline_table(trial)) == TireModel()


def test_another_reading_of_the_article_is_refused() -> None:
    with pytest.raises(TirelabError, match="reading of the print"):
        baseline_tire({"law": "hull1996", "surfaces": ROWS})


def test_an_unknown_law_is_refused() -> None:
    with pytest.raises(TirelabError, match="'pacejka'"):
        baseline_tire({"law": "pacejka", "surfaces": ROWS})
