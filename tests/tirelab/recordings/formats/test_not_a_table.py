"""Text that is no table yet is refused with a command that makes one of it, which is run here."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from one_recording import refusal
from tirelab.recordings.recording import read_recording

X = 20.0 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 201)))
F = 900.0 * (X / 10.0) ** 1.45
T = 100.0 * np.arange(201)


@pytest.mark.parametrize(
    "form",
    [
        "t:{:.0f},x:{:.4f},F:{:.3f}",
        "t={:.0f} x={:.4e} F={:.6e}",
        "Time: {:.0f} ms\tTravel: {:.4f} mm\tLoad: {:.3f} N",
        "Test time: {:.0f}; Machine travel: {:.4f}; Load cell: {:.3f}",
    ],
)
def test_names_before_the_numbers_are_taken_off_by_the_command(form: str, tmp_path: Path) -> None:
    path = tmp_path / "a b.log"
    path.write_text(
        "\n".join(["boot: ready", *(form.format(*row) for row in zip(T, X, F, strict=True))]) + "\n"
    )
    said = refusal(path, radius="flat")
    assert "row 2: each number has its name before it" in said
    command = said.partition("make columns of them: ")[2]
    subprocess.run(["sh", "-c", command], check=True)
    table = tmp_path / "a b.table.csv"
    lines = table.read_text().splitlines()
    table.write_text("\n".join([lines[0], *lines[2:]]) + "\n")  # without the words of the boot
    columns = {"time": "#1", "deflection": "+#2", "force": "+#3"}
    units = {"time": "ms", "deflection": "mm", "force": "N"}
    found = read_recording(table, columns=columns, units=units, radius="flat")
    np.testing.assert_allclose(found.time, 1e-3 * T)
    np.testing.assert_allclose(found.deflection, 1e-3 * X, atol=1e-6)
    np.testing.assert_allclose(found.force, F, atol=1e-2)


def test_commas_that_are_decimal_and_separate_too(tmp_path: Path) -> None:
    rows = [f"{t:.1f},{x:.3f},{f:.2f}".replace(".", ",") for t, x, f in zip(T, X, F, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["Zeit,Weg,Kraft", *rows]) + "\n")
    said = refusal(tmp_path / "a.csv", radius="flat")
    assert "row 2: has 6 cells where row 1 names 3 columns: commas are decimal and separate" in said


def test_commas_between_thousands_without_quotes(tmp_path: Path) -> None:
    rows = [f"{t / 1e3:.1f},{x:.3f},{f:,.2f}" for t, x, f in zip(T, X, F, strict=True)]
    first = next(i for i, f in enumerate(F) if f >= 1000.0) + 2
    (tmp_path / "a.csv").write_text("\n".join(["Time (s),Travel (mm),Load (N)", *rows]) + "\n")
    said = refusal(tmp_path / "a.csv", radius="flat")
    assert f"row {first}: has 4 cells where row 1 names 3 columns, as many as the rows above it hold" in said
    assert "if commas stand between thousands" in said


def test_a_quoted_number_that_may_have_either_mark_says_so(tmp_path: Path) -> None:
    rows = [f'{t / 1e3:.1f},{x:.3f},"{round(f):,}"' for t, x, f in zip(T, X, F, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["Time (s),Travel (mm),Load (N)", *rows]) + "\n")
    assert "may have a decimal comma or a thousands mark" in refusal(tmp_path / "a.csv", radius="flat")
