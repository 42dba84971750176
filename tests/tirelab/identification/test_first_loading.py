"""Where the first loading lies far above the later ones, the law is identified from the first one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray
from radialtire import read_tire
from tirelab.cli import main
from tirelab.identification.first_loading import first_loading, recording_of
from tirelab.recordings.recording import Recording

Array = NDArray[np.float64]

TIME = np.arange(0.0, 60.0, 0.02)
SMALL = 0.002 * (1.0 - np.abs(1.0 - 2.0 * (TIME[:1000] / 10.0 % 1.0)))
LARGE = 0.02 * (1.0 - np.abs(1.0 - 2.0 * (TIME[:2000] / 20.0 % 1.0)))
STROKE = np.concatenate([SMALL, LARGE])
"""Two triangles to 2 mm in 10 s each, two to 20 mm in 20 s each: the first of these loads from 20 s to 30 s."""


def pressed(softened: float, friction: float, x: Array = STROKE, *, timed: bool = True) -> Recording:
    """Return a part of 20 N/mm that keeps a share of its force below the largest deflection it has seen, under dry
    friction [N] and 0.1 N of noise.
    """
    time = TIME[: x.size]
    most = np.maximum.accumulate(x)
    force = 2e4 * x * np.where(x < most, 1.0 - softened, 1.0) + friction * np.sign(np.gradient(x))
    force += 0.1 * np.random.default_rng(4).standard_normal(x.size)
    return Recording("foam", time, x, np.full(x.size, np.inf), force, timed=timed)


def test_a_softening_part_has_a_first_loading_and_when_it_was() -> None:
    """Half of the force is lost: from 2 to 20 mm, that is 10 N/mm x (root mean square of x)."""
    found = first_loading(pressed(0.5, 2.0))
    assert found is not None
    assert (found.begins, found.ends) == pytest.approx((20.0, 30.0), abs=0.05)
    alone = recording_of(found, pressed(0.5, 2.0))
    assert np.ptp(alone.deflection) == pytest.approx(0.02, rel=0.01)
    assert np.all(np.diff(alone.deflection) > 0.0)
    x = np.linspace(2.0, 20.0, 1001)
    assert found.above == pytest.approx(10.0 * np.sqrt(np.mean(x**2)), rel=0.02)
    assert found.loop == pytest.approx(4.0, rel=0.02)


@pytest.mark.parametrize(
    "recording",
    [
        pressed(0.0, 20.0),
        pressed(0.02, 20.0),
        pressed(0.5, 2.0, STROKE[:1500]),
        pressed(0.5, 2.0, SMALL[:500]),
        pressed(0.5, 2.0, timed=False),
        pressed(0.5, 2.0, -STROKE),
    ],
    ids=["friction", "hardly softer", "no later one", "one cycle", "no time", "pulled"],
)
def test_other_parts_have_none(recording: Recording) -> None:
    assert first_loading(recording) is None


def test_what_is_proposed_finds_the_law_of_the_first_loading(tmp_path: Path) -> None:
    foam = pressed(0.5, 2.0)
    file, out = tmp_path / "foam.csv", tmp_path / "part.json"
    rows = np.column_stack([foam.time, 1e3 * foam.deflection, foam.force])
    header = "time [s],deflection [mm],load [N]"
    np.savetxt(file, rows, delimiter=",", header=header, comments="")
    words = ["--columns", "deflection=+deflection [mm],force=+load [N]", "--out", str(out)]
    for part in ("linear", "compare"):
        said = CliRunner().invoke(main, ["identify", str(file), *words, "--part", part]).output
        assert "the first loading of foam.csv lies 1" in said
        assert "foam.csv@20s:30s" in said
    done = CliRunner().invoke(main, ["identify", f"{file}@20s:30s", *words, "--part", "linear"])
    assert done.exit_code == 0, done.output
    assert "first loading" not in done.output
    # 20 N/mm is 200 N/cm. Friction is in the preload, and the first 2 mm are soft already: 10 N less there.
    assert read_tire(out).law.coefficient == pytest.approx(200.0, rel=0.02)  # type: ignore[attr-defined]


def test_a_first_loading_ends_where_a_long_hold_begins() -> None:
    """A ramp of 5 s, a hold of 12 s in which the gauge trembles, and cycles: the law is that of the ramp."""
    held = np.full(600, 0.02) + 2e-6 * np.random.default_rng(6).standard_normal(600)
    ramp, cycle = np.linspace(0.0, 0.02, 250), LARGE[:1000]
    found = first_loading(pressed(0.5, 2.0, np.concatenate([ramp, held, cycle[500:], cycle])))
    assert found is not None
    assert (found.begins, found.ends) == pytest.approx((0.0, 5.0), abs=0.15)
