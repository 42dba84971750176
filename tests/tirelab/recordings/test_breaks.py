"""A part that breaks or tears is doubted where it does; what is released, rubs or comes back is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from house_form import write_rows
from tirelab.recordings.choices import Choices
from tirelab.recordings.jumps import break_doubt
from tirelab.recordings.recording import understand

TIME = np.arange(0.0, 20.0, 0.01)
CYCLES = 5e-3 * np.sin(2.0 * np.pi * TIME)

PULL = np.linspace(0.0, 8e-3, 500)
TAKEN = np.append(9000.0 * np.minimum(PULL / 1e-3, 1.0)[:480] + 1e5 * PULL[:480], np.full(20, 12.0))


RELEASED = TAKEN[479] * np.linspace(1.0, 0.0, 20)


def test_a_part_that_breaks_is_doubted_at_the_first_sample_without_force() -> None:
    ((at, said),) = break_doubt(PULL, TAKEN)
    assert at == 480
    assert said.startswith(
        "the force falls within 5 samples to less than a tenth of the largest one, and does not"
    )
    assert said.endswith("give the range before it, as in FILE@1:480")
    # The rig springs back, and a sample is read as it falls; the signs are the other way.
    falls = np.append(TAKEN[:480], [4000.0, 900.0, *TAKEN[482:]])
    ((at, _),) = break_doubt(-np.append(PULL[:480], PULL[480:] - 0.4e-3), -falls)
    assert at == 481


@pytest.mark.parametrize("kept", [0.6, 0.2])
@pytest.mark.parametrize("after", [2, 4, 60])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_part_that_tears_and_carries_on_is_doubted(kept: float, after: int, sign: float) -> None:
    """It takes a tenth more over the whole, after a jolt as its grips close, and tears as it is pulled on."""
    force = np.append(TAKEN[:480], kept * TAKEN[479] * np.ones(after)) + 2.0 * np.cos(
        np.arange(480.0 + after)
    )
    force[5:7] += [3000.0, 1500.0]
    pull = np.linspace(0.0, 8e-3 * force.size / 500, force.size)
    ((at, said),) = break_doubt(sign * pull, sign * force)
    assert at == 480
    assert f"samples by {100.0 * (1.0 - kept):.0f} % and does not come back" in said
    assert said.endswith("as in FILE@1:480")
    assert break_doubt(np.append(pull[:478], np.full(force.size - 478, pull[477])), force) == ()


@pytest.mark.parametrize(
    ("deflection", "force"),
    [
        (PULL, TAKEN[:480].repeat(2)[:500]),
        (PULL[:481], TAKEN[:481]),
        (np.append(PULL[:480], np.linspace(7.6e-3, 7e-3, 20)), np.append(TAKEN[:480], RELEASED)),
        (CYCLES, 1e5 * CYCLES),
        (CYCLES[::9], 1e5 * CYCLES[::9]),
        (CYCLES, 500.0 * np.cos(2.0 * np.pi * TIME)),
        (CYCLES, 500.0 * np.sign(np.cos(2.0 * np.pi * TIME))),
        (PULL, np.append(TAKEN[:200], TAKEN[200] * np.exp(-np.arange(300.0) / 60.0))),
        (PULL, np.append(TAKEN[:200], [*np.zeros(100), *TAKEN[300:480], *TAKEN[460:480]])),
        (PULL, np.zeros(500)),
    ],
    ids=[
        "none",
        "one sample",
        "released",
        "elastic",
        "few",
        "damper",
        "friction",
        "slow",
        "comes back",
        "nothing",
    ],
)
def test_what_comes_back_or_is_released_did_not_break(deflection: np.ndarray, force: np.ndarray) -> None:
    assert break_doubt(deflection, force) == ()


def test_the_break_is_told_with_its_row(tmp_path: Path) -> None:
    header = "time [s],deflection [mm],force [N]"
    path = write_rows(tmp_path / "a.csv", header, 0.1 * np.arange(500.0), 1e3 * PULL, TAKEN)
    doubts = understand(path, Choices(part=True)).recording.doubts
    (told,) = [doubt for doubt in doubts if "does not come back" in doubt]
    assert "row 482, column 'force" in told
