"""The files of a plan: read back as the rig and the reader of recordings would."""

import math
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from small_rig import RIG
from tirelab.planning.menu import drive_of
from tirelab.planning.output import draw_plan, write_drive
from tirelab.planning.plan import Answer, RecordingPlan, Row
from tirelab.planning.separation import Question
from tirelab.regressors.signature import LAW
from tirelab.validation.follow_up_test import read_test

DRIVE = drive_of("fast triangles", 0.25, -0.508, RIG, 2e5)


def test_a_drive_file_has_time_deflection_surface_and_pressure(tmp_path: Path) -> None:
    write_drive(DRIVE, tmp_path / "drive.csv")
    table = pl.read_csv(tmp_path / "drive.csv")
    assert table.columns == ["time [s]", "deflection [mm]", "surface_radius [cm]", "pressure [kPa]"]
    assert table["deflection [mm]"].to_numpy() == pytest.approx(1e3 * DRIVE.deflection, abs=1e-6)
    assert set(table["surface_radius [cm]"]) == {-50.8}
    assert set(table["pressure [kPa]"]) == {200.0}


def test_the_rig_of_the_blind_trials_reads_it(tmp_path: Path) -> None:
    flat = drive_of("slow triangles", 0.25, math.inf, RIG)
    write_drive(flat, tmp_path / "drive.csv")
    time, deflection, radius = read_test(tmp_path / "drive.csv")
    assert time == pytest.approx(flat.time)
    assert deflection == pytest.approx(flat.deflection, abs=1e-9)
    assert np.isinf(radius).all()


def test_the_picture_is_drawn(tmp_path: Path) -> None:
    questions = (
        Question("inertia", frozenset({LAW}), 0.02, nested=True),
        Question("inertia", frozenset({LAW, "force_drift"}), 0.02, nested=False),
        Question(LAW, frozenset(), 0.02, nested=True),
    )
    found = ((0.99, True), (0.6, False), (0.97, True))
    answers = tuple(Answer(q, *answer) for q, answer in zip(questions, found, strict=True))
    rows = (Row("inertia", (0.1, 0.5, 0.9), ("force_drift",), ()),)
    plan = RecordingPlan(RIG, "a tire", 0.02, (DRIVE,), rows, answers, (), 1500.0)
    draw_plan(plan, tmp_path / "plan.png")
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
