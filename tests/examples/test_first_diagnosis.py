"""The notebook of a first diagnosis: stored without outputs, and every cell runs and shows what it says."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

nbformat = pytest.importorskip("nbformat")
NOTEBOOK = "first_diagnosis.ipynb"


@pytest.fixture(scope="module")
def cells(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """The cells of the notebook as a kernel left them, run in a copy of the folder."""
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    folder = tmp_path_factory.mktemp("notebook")
    shutil.copytree(repository / "examples" / "recordings", folder / "recordings")
    notebook = nbformat.read(repository / "examples" / NOTEBOOK, as_version=4)
    resources = {"metadata": {"path": str(folder)}}
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources=resources).execute()
    assert (folder / "corrected" / "BicycleTire.fmu").is_file()
    assert "</html>" in (folder / "corrected" / "report.html").read_text(encoding="utf-8")
    return list(notebook.cells)


def shown(cell: Any, kind: str) -> list[str]:
    """What a cell shows as one kind of data."""
    return [o["data"][kind] for o in cell.outputs if "data" in o and kind in o["data"]]


def test_the_notebook_is_stored_without_outputs(repository: Path) -> None:
    stored = nbformat.read(repository / "examples" / NOTEBOOK, as_version=4)
    nbformat.validate(stored)
    assert len(stored.cells) == 5
    for cell in stored.cells:
        assert cell.outputs == []
        assert cell.execution_count is None


def test_the_verdict_is_shown_as_a_table(cells: list[Any]) -> None:
    (table,) = shown(cells[1], "text/html")
    assert "Friction loop, " in table
    assert shown(cells[1], "text/plain")[0].startswith(
        "Verdict('Left out: friction loop (rate-independent hysteresis)', "
    )


def test_loops_and_residuals_are_drawn(cells: list[Any]) -> None:
    (picture,) = shown(cells[2], "image/png")
    assert len(picture) > 10_000


def test_the_fmu_follows_the_held_out_recording(cells: list[Any]) -> None:
    """The recordings have 6 N of noise and 100 N of friction: with it the error is that of the noise."""
    text = "".join(o["text"] for o in cells[3].outputs if o["output_type"] == "stream")
    rmse = float(text.split("RMSE ")[1].split(" N")[0])
    assert 5.5 < rmse < 6.6
    assert "rate_independent_hysteresis" in shown(cells[4], "text/plain")[0]
