"""The page of a proof in a browser: phone, dark, contrast, titled pictures, and no judgement by a handful of trials."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from browser import CONTRAST, Watched, browser
from tirelab.validation.acceptance_criteria import Criterion
from tirelab.validation.metrics import Mean, Rate
from tirelab.validation.page import Proof, judged, page, too_few


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def proof(score: Callable[..., Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A proof of thirty trials, most of them right, one of them with names that would be markup."""
    names = ("viscous_damping", "inertia", "rate_independent_hysteresis", "unknown", "none")
    kinds = ("single", "pair", "masked", "open", "none")
    made = [
        score(
            kinds[i % 5],
            names[i % 5],
            names[(i + (i % 7 == 0)) % 5],
            trial=f"{i:04d}",
            alternatives=[names[(i + 1) % 5]],
            sizes={names[i % 5]: 3.0 + i} if i % 5 < 3 else {},
        )
        for i in range(30)
    ]
    made.append(score("single", "<script>alert(1)</script>", "<img/src=x>", trial="0030"))
    path = tmp_path_factory.mktemp("proof") / "proof.html"
    path.write_text(page(Proof(1, tuple(made))), encoding="utf-8")
    return path


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_fits_and_can_be_read(chromium: Any, proof: Path, scheme: str, width: int) -> None:
    shown = Watched(chromium, viewport={"width": width, "height": 844}, color_scheme=scheme)
    shown.page.goto(proof.as_uri())
    shown.page.locator("summary").click()
    assert shown.page.evaluate("() => document.documentElement.scrollWidth") <= width
    assert shown.page.evaluate(CONTRAST) == []
    assert shown.said == []
    assert all(url.startswith("file:") for url in shown.asked)
    assert shown.page.locator("img, script").count() == 0
    dark = (
        shown.page.evaluate("() => getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)"
    )
    assert dark == (scheme == "dark")
    shown.context.close()


def test_every_picture_has_a_title_and_words(chromium: Any, proof: Path) -> None:
    shown = Watched(chromium)
    shown.page.goto(proof.as_uri())
    assert shown.page.locator("figure").count() == 5
    assert shown.page.locator("figure figcaption").count() == 5
    labels = shown.page.locator("figure svg").evaluate_all(
        "found => found.map(e => e.getAttribute('aria-label'))"
    )
    assert len(labels) == 5
    assert all(len(label) > 20 for label in labels)
    shown.context.close()


def test_an_interval_that_is_too_wide_is_no_judgement(score: Callable[..., Any]) -> None:
    """0 of 9 has the Wilson interval 0 to 30 %, 0 of 40 that of 0 to 9 %."""
    assert too_few(Rate(0, 9))
    assert not too_few(Rate(0, 40))
    few = Proof(1, tuple(score("none", "none", "none", trial=f"{i}") for i in range(9)))
    said = {c.figure: judged(c) for c in few.criteria}
    assert said["false alarms where nothing is hidden"] == "too few trials"
    assert said["unknown recognised outside the catalogue"] == "not measured"
    assert "too few trials" in page(few)
    wide, narrow = (
        Criterion("a score", Mean(0.3, (low, 0.5), 9), 0.2, at_least=False) for low in (0.1, 0.25)
    )
    assert (judged(wide), judged(narrow)) == ("too few trials", "fail")
    many = Proof(1, tuple(score("none", "none", "none", trial=f"{i}") for i in range(40)))
    assert {judged(c) for c in many.criteria if c.figure == "false alarms where nothing is hidden"} == {
        "pass"
    }
