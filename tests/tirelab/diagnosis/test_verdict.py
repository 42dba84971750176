"""The verdict as a value in Python: how it prints, what it writes, what it draws."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from drives import flat_force
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from tirelab.diagnosis.verdict import Verdict
from tirelab.errors import TirelabError
from tirelab.report import first_screen
from tirelab.simulation.simulate import simulate


class Cells(HTMLParser):
    """The texts of the cells of a table, and the tags with their styles."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.cells: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag in ("th", "td", "caption"):
            self.cells.append("")

    def handle_data(self, data: str) -> None:
        if self.cells:
            self.cells[-1] += data


def _others(verdict: Verdict) -> str:
    number = len(verdict.alternatives)
    return f", {number} alternative{'s' if number > 1 else ''}" if number else ""


def test_the_repr_is_one_short_line(damped_run, complete_verdict, one_rate_verdict):
    fit = damped_run.verdict.fit
    assert repr(damped_run.verdict) == (
        f"Verdict('Left out: viscous damping', {100 * damped_run.verdict.confidence:.0f} % sure, "
        f"{fit.before:.3g} -> {fit.after:.3g} N, noise {fit.noise:.3g} N{_others(damped_run.verdict)})"
    )
    assert repr(complete_verdict).startswith("Verdict('Nothing is missing', ")
    assert repr(one_rate_verdict).endswith(f" N{_others(one_rate_verdict)})")
    assert len(repr(one_rate_verdict)) < 160


def test_the_table_of_a_notebook_states_the_verdict(one_rate_verdict):
    table = Cells(one_rate_verdict._repr_html_())
    assert table.tags[0] == "table"
    assert set(table.tags) <= {"table", "caption", "tbody", "tr", "th", "td"}
    assert table.cells[0] == first_screen.headline(one_rate_verdict.to_dict())
    rows = dict(zip(table.cells[1::2], table.cells[2::2], strict=True))
    assert rows["recommended next test"] == one_rate_verdict.test.sentence
    fit = one_rate_verdict.fit
    assert rows["RMS error"] == f"{fit.before:.1f} N → {fit.after:.2f} N; the noise is {fit.noise:.2f} N"
    assert rows["held-out RMS error"].endswith(f"({fit.held_out_by})")
    titles = f"{table.cells[0]} {rows['alternative models']}".lower()
    assert "viscous damping" in titles
    assert "friction loop" in titles or "rate-independent hysteresis" in titles


def test_names_cannot_become_markup_in_a_notebook(damped_run):
    fit = replace(damped_run.verdict.fit, held_out_by="recording <script>alert(1)</script> & more")
    text = replace(damped_run.verdict, fit=fit)._repr_html_()
    assert "<script>" not in text
    assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; more" in text


def test_the_dictionary_is_the_content_of_diagnosis_json(damped_run):
    """But for the files, which are not written, and the errors: of the simulation here, of the FMU there."""
    written = json.loads((damped_run.out / "diagnosis.json").read_text())
    stated = json.loads(json.dumps(damped_run.verdict.to_dict(), allow_nan=False))
    assert list(stated) == list(written)
    if test := written["verdict"]["separating_test"]:
        assert test.pop("file") == "separating_test.csv"
    for name in ("schema", "verdict", "where", "held_out_by"):
        assert stated[name] == written[name]
    assert stated["fit"] == pytest.approx(written["fit"], rel=1e-9)
    assert (stated["tire"], stated["corrected_fmu"], stated["report"]) == (None, None, None)


def test_the_page_of_a_verdict_is_that_of_the_command(damped_run, tmp_path: Path):
    """But for what repeats the command, and the files that are not written."""
    damped_run.verdict.report(tmp_path / "page.html")
    own, other = (
        [
            re.sub(r' <span class="drive">Drive <a href="separating_test.csv".*?</a>[.]</span>', "", line)
            for line in path.read_text(encoding="utf-8").splitlines()
            if line.startswith(("<h", "<tr", "<p")) and "explore-keys" not in line
        ]
        for path in (tmp_path / "page.html", damped_run.out / "report.html")
    )
    assert len(own) > 20
    assert own == other
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "BicycleTire.fmu" not in page
    assert "separating_test.csv" not in page
    assert "None" not in page


def test_a_page_that_cannot_be_written_is_one_sentence(damped_run, tmp_path: Path):
    with pytest.raises(TirelabError, match="cannot be written"):
        damped_run.verdict.report(tmp_path / "no" / "page.html")


def test_what_is_no_recording_is_reported_and_drawn_too(unequal_verdict, tmp_path: Path):
    unequal_verdict.report(str(tmp_path / "page.html"))
    assert "ride 2" in (tmp_path / "page.html").read_text(encoding="utf-8")
    assert isinstance(unequal_verdict.plot_residuals(), Axes)


def test_a_verdict_without_its_recordings_says_so(damped_run, tmp_path: Path):
    bare = replace(damped_run.verdict, recordings=())
    assert bare == damped_run.verdict
    for ask in (bare.plot_loops, bare.plot_residuals, lambda: bare.report(tmp_path / "page.html")):
        with pytest.raises(TirelabError, match="does not carry its recordings"):
            ask()


def test_the_loops_are_drawn_on_the_axes_that_are_given(damped_run):
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert damped_run.verdict.plot_loops(left) is left
    assert damped_run.verdict.plot_residuals(right) is right
    assert left.get_xlabel() == "deflection [mm]"
    assert left.get_ylabel() == "force [N]"
    assert left.get_title() == "ride"
    assert [t.get_text() for t in left.get_legend().get_texts()] == ["recorded", "before", "after"]
    assert damped_run.verdict.plot_loops(recording="kept").get_title() == "kept"


def test_the_loop_before_the_correction_is_the_articles_law(damped_run):
    axes = damped_run.verdict.plot_loops()
    x, y = axes.lines[0].get_data()
    drawn = np.isfinite(x)
    assert drawn.sum() > 50
    assert y[drawn] == pytest.approx(flat_force(x[drawn] / 1e3), rel=1e-9)


def test_new_axes_come_without_the_state_of_pyplot(damped_run):
    first, second = damped_run.verdict.plot_loops(), damped_run.verdict.plot_loops()
    assert first.figure is not second.figure
    assert plt.get_fignums() == []


def test_residuals_over_time_are_recorded_minus_simulated(complete_verdict: Verdict):
    """Nothing is missing: one line, and the noise as a band about zero."""
    axes = complete_verdict.plot_residuals()
    (recording,) = complete_verdict.recordings
    residual = recording.force - simulate(complete_verdict.baseline, recording)
    drawn = np.concatenate([line.get_ydata() for line in axes.lines if len(line.get_ydata()) > 100])
    assert drawn.max() == pytest.approx(residual.max())
    assert drawn.min() == pytest.approx(residual.min())
    labels = [t.get_text() for t in axes.get_legend().get_texts()]
    assert labels == ["simulated", "noise of one sample"]


@pytest.mark.parametrize(
    ("over", "label"), [("deflection", "deflection [mm]"), ("rate", "rate [mm/s], unloading < 0 < loading")]
)
def test_residuals_are_drawn_over_other_coordinates(damped_run, over: str, label: str):
    axes = damped_run.verdict.plot_residuals(over=over)
    assert axes.get_xlabel() == label
    assert axes.get_ylabel() == "mean residual [N]"


def test_a_plot_of_what_there_is_not_is_refused(damped_run):
    with pytest.raises(TirelabError, match="over 'colour'; choose one of time, deflection, rate"):
        damped_run.verdict.plot_residuals(over="colour")
    with pytest.raises(TirelabError, match="no recording is named none; this verdict carries ride, kept"):
        damped_run.verdict.plot_loops(recording="none")
