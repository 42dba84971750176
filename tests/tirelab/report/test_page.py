"""The report as a file: complete, self-contained, accessible, safe from what recordings are called, and small."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drives import long_ride
from tirelab.errors import TirelabError
from tirelab.recordings.recording import Recording
from tirelab.report import explore
from tirelab.report.page import write_report

HOSTILE = (
    "<script>alert(1)</script> \"'& $x_y$ <img src=http://a.invalid onerror=alert(2)> {{ 7*7 }} 轮胎 \x1b[31m"
)
"""A name that would run, load, compute or colour something wherever it is not escaped."""

KINDS = ("nothing", "one", "two", "alternatives", "unknown")


FILES = ("tire.json", "BicycleTire.fmu", "separating_test.csv", "plots.csv", "diagnosis.json")
"""The files beside the report, the only ones that it may lead to."""


class Elements(HTMLParser):
    """The page's elements with their attributes and the elements around each, and the text of each kind."""

    VOID = frozenset({"meta", "br", "img", "link", "input"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[tuple[str, dict[str, str | None], tuple[str, ...]]] = []
        self.texts: dict[str, list[str]] = {}
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs), tuple(self.open)))
        if tag not in self.VOID:
            self.open.append(tag)
            self.texts.setdefault(tag, []).append("")

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs), tuple(self.open)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open, f"</{tag}> closes nothing"
        assert self.open[-1] == tag, f"</{tag}> closes <{self.open[-1]}>"
        self.open.pop()

    def handle_data(self, data: str) -> None:
        for tag in set(self.open):
            self.texts[tag][-1] += data


@pytest.fixture(scope="module")
def pages(reports: dict[str, Path]) -> dict[str, str]:
    """The report of every kind of diagnosis, as text."""
    return {name: path.read_text(encoding="utf-8") for name, path in reports.items()}


def written(path: Path, made: Any) -> str:
    write_report(path, made.diagnosis, made.recordings, made.before, made.after, held_out=made.held_out)
    return path.read_text(encoding="utf-8")


TABLE = "data:text/csv;base64,"
"""The numbers behind a picture, in the page itself."""


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_is_well_formed_and_needs_nothing_else(pages: dict[str, str], kind: str) -> None:
    page = Elements(pages[kind])
    assert page.open == []
    tags = {tag for tag, _, _ in page.found}
    assert not tags & {"iframe", "link", "object", "embed", "base", "form"}
    scripts = [a for tag, a, _ in page.found if tag == "script"]
    assert scripts == [{"type": "application/json", "id": "explore-data"}, {}]
    for tag, attributes, _ in page.found:
        assert not [name for name in attributes if name.startswith("on")]
        for name in ("src", "href", "xlink:href", "srcset", "action", "data"):
            value = attributes.get(name)
            own = name == "href" and tag == "a" and (value in FILES or str(value).startswith(TABLE))
            assert own or value is None or value.startswith(("#", "data:image/png;base64,")), (
                tag,
                name,
                value,
            )
    styles = " ".join([*page.texts["style"], *(a.get("style") or "" for _, a, _ in page.found)])
    assert "@import" not in styles
    elsewhere = pages[kind].replace(str(explore.script().text), "")
    assert set(re.findall(r"url\((.)", elsewhere)) <= {"#"}
    assert len(pages[kind]) < 2e6


@pytest.mark.parametrize("kind", KINDS)
def test_inner_references_meet_one_element_each(pages: dict[str, str], kind: str) -> None:
    page = Elements(pages[kind])
    identities = [a["id"] for _, a, _ in page.found if "id" in a]
    assert len(identities) == len(set(identities))
    wanted = set(re.findall(r'url\(#([^)]+)\)|href="#([^"]+)"|aria-labelledby="([^"]+)"', pages[kind]))
    assert {name for names in wanted for name in names if name} <= set(identities)


@pytest.mark.parametrize("kind", KINDS)
def test_pictures_have_words_and_tables_have_headers(pages: dict[str, str], kind: str) -> None:
    page = Elements(pages[kind])
    pictures = [a for tag, a, _ in page.found if tag == "svg"]
    assert len(pictures) >= 7
    for attributes in pictures:
        assert attributes["role"] == "img"
        assert len(attributes["aria-label"] or "") > 20
    assert all("scope" in a for tag, a, _ in page.found if tag == "th")
    tables = [tag for tag, _, _ in page.found].count("table")
    assert tables == len(page.texts["caption"])
    headings = [int(tag[1]) for tag, _, _ in page.found if re.fullmatch("h[1-6]", tag)]
    assert headings.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(headings))


def test_each_kind_says_its_verdict_in_plain_words(pages: dict[str, str]) -> None:
    said = {name: Elements(text).texts["h1"][0].replace("\xa0", " ") for name, text in pages.items()}
    assert said["nothing"] == "Nothing is missing"
    assert said["one"] == "Viscous damping, 4 % of the load"
    assert said["two"] == "Friction loop and deflection offset; law refitted"
    assert said["alternatives"] == "Undecided: friction loop, viscous damping or relaxation + refitted law"
    assert said["unknown"] == "Something unknown, < 1 % of the load"


def test_the_first_screen_leads_to_the_files(pages: dict[str, str]) -> None:
    page = Elements(pages["alternatives"])
    links = [a["href"] for tag, a, around in page.found if tag == "a" and "header" in around]
    assert set(links) == set(FILES)
    text = " ".join(page.texts["header"][0].split())
    for words in (
        "One of several possibilities: 46 %",
        "Record triangles at three rates to 22.0 mm",
        "Noise floor",
    ):
        assert words in text
    assert "Nothing: use this tire." in page_text(pages["one"])


def page_text(page: str) -> str:
    """The text of the first screen."""
    return " ".join(Elements(page).texts["header"][0].split())


def test_alternatives_have_reasons_and_a_test(pages: dict[str, str]) -> None:
    page = Elements(pages["alternatives"])
    cells = [" ".join(text.split()) for text in page.texts["tbody"]]
    assert "Not decided: no hold. What decides: Hold 10 s at 14 mm. + series spring7 %" in cells
    assert (
        "Not decided: one speed only. What decides: Repeat at 30 mm/s. viscous damping instead of friction loop30 %"
        in cells
    )
    text = page.texts["main"][0]
    for words in ("Recommended next test", "22.0 mm", "250 mm/s", "flat ground", "separating_test.csv"):
        assert words in text
    assert "Recommended next test" not in Elements(pages["one"]).texts["main"][0]


def test_parameters_have_value_deviation_unit_and_meaning(pages: dict[str, str]) -> None:
    text = Elements(pages["two"]).texts["main"][0]
    for words in ("30.10 ± 0.60 N", "1.020 ± 0.040 mm", "half the loop's height", "0.800 ± 0.021 mm"):
        assert words in text
    # 30.1 ± 1.96 * 0.6 N, 0.8 ± 1.96 * 0.021 mm
    for words in ("28.92 to 31.28 N", "0.759 to 0.841 mm"):
        assert words in text


def test_a_refitted_law_is_told_by_its_coefficients(pages: dict[str, str]) -> None:
    page = Elements(pages["two"])
    rows = [" ".join(text.split()) for text in page.texts["tr"]]
    assert "flat ground550.9600.0 ± 1.21.4221.3800 ± 0.0040" in rows
    labels = [a["aria-label"] for tag, a, _ in page.found if tag == "svg"]
    assert "Force of the refitted law less that of the baseline over the deflection." in labels
    assert "log factor on A" not in page.texts["main"][0]
    assert "bend" in page.texts["main"][0]


def test_each_parameter_has_a_sketch(pages: dict[str, str]) -> None:
    page = Elements(pages["two"])
    labels = [a["aria-label"] or "" for tag, a, _ in page.found if tag == "svg"]
    assert len([label for label in labels if "half as large again" in label]) == 4


def test_what_is_unknown_is_shown_with_its_warning(pages: dict[str, str]) -> None:
    text = Elements(pages["unknown"]).texts["main"][0]
    assert (
        "A regression of the remaining force over the deflection. It is a description, not physics." in text
    )
    assert "88 %" in text
    assert "differ by 3.1 N" in text


def test_held_out_recordings_are_told_apart(kinds: dict[str, Any], tmp_path: Path) -> None:
    made = kinds["one"]
    kept = Elements(written(tmp_path / "kept.html", made)).texts["main"][0]
    assert "Held-out\n" in kept
    fit = {**made.diagnosis["fit"], "held_out_before": None, "held_out_after": None}
    without = replace(made, diagnosis={**made.diagnosis, "fit": fit}, held_out=None)
    text = Elements(written(tmp_path / "none.html", without)).texts["main"][0]
    assert "Held-out\n" not in text
    assert "No data was held out" in text


def test_a_part_is_no_tire_on_its_page(kinds: dict[str, Any], tmp_path: Path) -> None:
    made = kinds["one"]
    of_part = made.diagnosis | {"baseline_tire": {"two_sided": True}}
    write_report(tmp_path / "r.html", of_part, made.recordings, made.before, made.after)
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    for said in (
        "Baseline part: ",
        "the force that the baseline part does not explain",
        "<dt>Corrected part</dt>",
    ):
        assert said in page
    assert "baseline tire" not in page
    assert "Corrected tire" not in page


def test_names_notes_and_files_cannot_become_markup(kinds: dict[str, Any], tmp_path: Path) -> None:
    made = kinds["unknown"]
    named = [
        replace(r, name=HOSTILE, notes=(HOSTILE, HOSTILE), source=Path(HOSTILE.replace("/", "|")))
        for r in made.recordings
    ]
    where = [{**made.diagnosis["where"][0], "by": HOSTILE, "unit": HOSTILE, "label": HOSTILE}]
    odd = {
        "name": HOSTILE,
        "parameters": {HOSTILE: {"value": 1.0, "std": None, "unit": HOSTILE}},
        "share": 1.0,
    }
    diagnosis = {
        **made.diagnosis,
        "where": where,
        "verdict": {
            **made.diagnosis["verdict"],
            "summary": HOSTILE,
            "effects": [odd],
            "alternatives": [[HOSTILE]],
            "alternative_details": [
                {"difference": HOSTILE, "probability": 0.1, "reason": HOSTILE, "action": HOSTILE}
            ],
            "separating_test": {"waveform": HOSTILE, "sentence": HOSTILE, "file": HOSTILE},
        },
        "tire_before": HOSTILE,
        "tire_after": HOSTILE,
        "reasons": [HOSTILE],
        "warnings": [HOSTILE],
        "command": HOSTILE,
        "evidence": [{"effects": [HOSTILE], "log_evidence": 0.0, "remark": HOSTILE}],
    }
    text = written(tmp_path / "hostile.html", replace(made, diagnosis=diagnosis, recordings=named))
    plain = written(tmp_path / "plain.html", made)
    page = Elements(text)
    assert page.open == []
    tags = [tag for tag, _, _ in page.found]
    assert tags.count("script") == 2
    assert "img" not in tags
    assert {tag for tag, _, _ in Elements(plain).found} | {"article"} >= set(tags) - {"figcaption"}
    assert "alert(1)" in page.texts["main"][0]
    assert "{{ 7*7 }}" in page.texts["main"][0]


def test_file_names_that_are_no_text_are_written_all_the_same(kinds: dict[str, Any], tmp_path: Path) -> None:
    made = kinds["one"]
    odd = [replace(r, name="\udcff", source=Path("\udcff.csv")) for r in made.recordings]
    assert "\\udcff" in written(tmp_path / "odd.html", replace(made, recordings=odd))


def test_the_same_diagnosis_gives_the_same_bytes(kinds: dict[str, Any], tmp_path: Path) -> None:
    made = kinds["alternatives"]
    assert written(tmp_path / "a.html", made) == written(tmp_path / "b.html", made)


@pytest.mark.parametrize("samples", [10_000, pytest.param(1_000_000, marks=pytest.mark.slow)])
def test_many_samples_stay_a_small_file(kinds: dict[str, Any], tmp_path: Path, samples: int) -> None:
    """The pictures have as many points as those of a hundredth of the samples."""
    write_report(tmp_path / "r.html", kinds["one"].diagnosis, *long_ride(samples))
    assert (tmp_path / "r.html").stat().st_size < 2e6


@pytest.mark.parametrize("samples", [2, 3, 7, 40])
def test_recordings_of_a_few_samples_are_drawn(kinds: dict[str, Any], tmp_path: Path, samples: int) -> None:
    write_report(tmp_path / "r.html", kinds["one"].diagnosis, *long_ride(samples))
    assert "</html>" in (tmp_path / "r.html").read_text()


def test_a_still_and_perfect_recording_is_drawn(kinds: dict[str, Any], tmp_path: Path) -> None:
    time_ = np.arange(50.0)
    still = Recording("still", time_, np.full(50, 0.01), np.full(50, np.inf), np.full(50, 100.0))
    force = np.full(50, 100.0)
    fit = {"noise": 0.0, "before": 0.0, "after": 0.0, "held_out_before": None, "held_out_after": None}
    diagnosis = {**kinds["nothing"].diagnosis, "fit": fit}
    write_report(tmp_path / "r.html", diagnosis, [still], [force], [force])
    assert "</html>" in (tmp_path / "r.html").read_text()


def test_arrays_that_do_not_fit_are_refused(kinds: dict[str, Any], tmp_path: Path) -> None:
    made = kinds["one"]
    with pytest.raises(TirelabError, match="give one of each"):
        write_report(tmp_path / "r.html", made.diagnosis, made.recordings, made.before[:1], made.after)
    bad = [made.after[0][:-1], made.after[1]]
    with pytest.raises(TirelabError, match="one finite value for each of its 8000 samples"):
        write_report(tmp_path / "r.html", made.diagnosis, made.recordings, made.before, bad)
    with pytest.raises(TirelabError, match="cannot be written"):
        write_report(tmp_path / "no" / "r.html", made.diagnosis, made.recordings, made.before, made.after)
