"""The article's claims are judged as arithmetic on the printed equations judges them."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from radialtire import SECOND_READING, Hull1996
from tirelab.article import Outcome, check_article, draw, summary, to_csv, to_json
from tirelab.article.figures import coefficient_figure, force_figure
from tirelab.cli.article import command


@pytest.fixture(scope="module")
def outcomes() -> dict[str, Outcome]:
    return {o.claim.name: o for o in check_article()}


# what the issue and pencil and paper say of each claim: verdicts with E0 = 0.2519 and with E0 = 0.02519
VERDICTS = {
    "pressure": ("not reproduced", "not reproduced"),
    "largest radius": ("reproduced", "reproduced"),
    "rating": ("not reproduced", "not reproduced"),
    "hysteresis in pounds": ("not reproduced", "not reproduced"),
    "flat law": ("reproduced", "reproduced"),
    "decay E0": ("not reproduced", "not reproduced"),
    "quality of the fits": ("not computable", "not computable"),
    "error on convex surfaces": ("not reproduced", "reproduced"),
    "error on concave surfaces": ("not reproduced", "not reproduced"),
    "hysteresis": ("reproduced", "reproduced"),
    "hysteresis averaged": ("reproduced", "reproduced"),
    "least of the largest stiffnesses": ("not reproduced", "reproduced"),
    "greatest of the largest stiffnesses": ("not reproduced", "not reproduced"),
    "wheel in series": ("not reproduced", "not reproduced"),
    "force over bumps": ("reproduced", "reproduced"),
    "force in dips": ("reproduced", "reproduced"),
    "edge": ("not reproduced", "not reproduced"),
    "dip of the wheel's radius": ("not reproduced", "not reproduced"),
    "shift by 1 mm": ("not reproduced", "not reproduced"),
    "preload": ("reproduced", "reproduced"),
}


@pytest.mark.parametrize(("name", "verdicts"), VERDICTS.items())
def test_a_claim_is_judged(outcomes: dict[str, Outcome], name: str, verdicts: tuple[str, str]) -> None:
    assert outcomes[name].verdicts == verdicts


# worked out by hand from the printed equations
NUMBERS = {
    "error on concave surfaces": 100.0 * 116.0 / 1432.76,  # A = 557.34, B = 1.47102 at -50.8 cm, x = 1.9 cm
    "error on convex surfaces": 100.0 * 193.0 / 2052.9,  # A = 550.34, B = 1.41827 at 25.4 cm, x = 2.53 cm
    "hysteresis": 100.0 / 0.065,
    "wheel in series": 8.5,  # 1.7e5 of 2e6
    "preload": 1.0385,  # (22 / 550.9)^(1 / 1.422) cm
    "edge": 2.0**1.1751,  # B = 1.422 - 0.2469
    "least of the largest stiffnesses": 100.0 * 305.586 * 1.27**0.2218,
    "deflection kept small for the force": (2240.0 / 588.928) ** (1.0 / 1.492758),  # at -38.1 cm
}


@pytest.mark.parametrize(("name", "value"), NUMBERS.items())
def test_its_number_is_that_of_the_printed_equations(
    outcomes: dict[str, Outcome], name: str, value: float
) -> None:
    found = outcomes[name].findings[0]
    assert found is not None
    assert found.value == pytest.approx(value, rel=2e-4)


def test_the_second_reading_is_computed_beside_the_first(outcomes: dict[str, Outcome]) -> None:
    # A = 550.9 - 337.8 e^(-0.02519 25.4) = 372.74, F = 372.74 2.53^1.41827 = 1390.4 N
    found = outcomes["error on convex surfaces"].findings[1]
    assert found is not None
    assert found.value == pytest.approx(100.0 * 193.0 / 1390.4, rel=2e-4)
    assert {name for name, o in outcomes.items() if o.depends_on_reading} >= {
        "error on convex surfaces",
        "least of the largest stiffnesses",
        "loads on concave surfaces",
    }
    assert not outcomes["error on concave surfaces"].depends_on_reading


def test_averaging_the_branches_halves_the_error_of_hysteresis(outcomes: dict[str, Outcome]) -> None:
    # a loop of 100 N: its mean is 50 N from either branch, one branch is 100 N from the other; the power law follows
    # a constant of 50 N in part only
    found = outcomes["hysteresis averaged"].findings[0]
    assert found is not None
    assert found.value == pytest.approx(2.0, rel=0.15)


def test_a_claim_that_is_not_plainly_reproduced_says_why(outcomes: dict[str, Outcome]) -> None:
    for outcome in outcomes.values():
        if set(outcome.verdicts) != {"reproduced"}:
            assert outcome.claim.remark


def test_every_printed_number_is_in_the_article(shared: Path, outcomes: dict[str, Outcome]) -> None:
    article = next((shared / "article").glob("*.txt"))
    text = re.sub(r"\s+", "", article.read_text(encoding="utf-8"))
    spelled = {"2.3e4": "2.3x10^4", "1.7e5": "1.7xl0^5", "2e6": "2xl0^6"}
    for outcome in outcomes.values():
        for number in re.findall(r"(?<![A-Za-z\d])\d+(?:\.\d+)?(?:e\d)?", outcome.claim.printed):
            assert spelled.get(number, number) in text, (outcome.claim.name, number)


def test_the_outcomes_are_written_as_csv_and_json(outcomes: dict[str, Outcome]) -> None:
    every = tuple(outcomes.values())
    rows = list(csv.DictReader(io.StringIO(to_csv(every))))
    entries = json.loads(to_json(every))
    assert [row["claim"] for row in rows] == [entry["claim"] for entry in entries] == list(outcomes)
    assert rows[0]["verdict, E0 = 0.2519 /cm"] == "not reproduced"
    assert entries[0]["readings"]["E0 = 0.2519 /cm"]["computed"] == "344.7 kPa"
    assert summary(every).startswith(f"{len(every)} claims; with E0 = 0.2519 /cm: ")


def test_figure_1_and_2_show_the_law_and_no_measured_points() -> None:
    for which in (0, 1):
        figure = coefficient_figure(which, "", "")
        concave, convex = figure.axes
        curve = convex.lines[0]
        at = np.asarray(curve.get_xdata(), dtype=float)
        expected = [Hull1996().coefficients(r / 100.0)[which] for r in at]
        np.testing.assert_array_equal(np.asarray(curve.get_ydata(), dtype=float), expected)
        assert len(np.asarray(concave.lines[1].get_xdata())) == 3
        assert len(np.asarray(convex.lines[1].get_xdata())) == 10
        assert "measured points are not in the article's text" in figure.get_supxlabel()
    second = coefficient_figure(0, "", "").axes[1].lines[2]
    A = Hull1996(convex_coefficient_decay=SECOND_READING).coefficients(0.62)[0]
    assert np.asarray(second.get_ydata(), dtype=float)[-1] == A


def test_figure_3_has_its_three_panels() -> None:
    figure = force_figure()
    assert [axes.get_title() for axes in figure.axes] == ["A: flat", "B: convex", "C: concave"]
    law = figure.axes[0].lines[0]
    x, y = (np.asarray(v, dtype=float) for v in law.get_data())
    np.testing.assert_allclose(y, 550.9 * x**1.422, rtol=1e-12)
    assert "not in the article's text" in figure.get_supxlabel()


def test_the_figures_are_drawn(tmp_path: Path) -> None:
    paths = draw(tmp_path / "figures")
    assert [path.name for path in paths] == ["figure1.png", "figure2.png", "figure3.png"]
    for path in paths:
        assert path.read_bytes().startswith(b"\x89PNG")
        assert path.stat().st_size > 20_000


def test_the_command_writes_everything(tmp_path: Path) -> None:
    done = CliRunner().invoke(command, ["--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert {path.name for path in tmp_path.iterdir()} == {
        "article.csv",
        "article.json",
        "figure1.png",
        "figure2.png",
        "figure3.png",
    }
    assert "not computable" in done.output
    first = json.loads((tmp_path / "article.json").read_text(encoding="utf-8"))[0]
    assert first["readings"]["E0 = 0.2519 /cm"]["value"] == pytest.approx(344.738, abs=5e-4)


def test_a_folder_that_cannot_be_written_is_told_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = CliRunner().invoke(command, ["--out", str(tmp_path / "file" / "inside")])
    assert done.exit_code == 2
    assert "cannot be written" in done.output
