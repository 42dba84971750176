"""The recording that the tests of reading write to files, and what a refusal of such a file says."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from tirelab.recordings.recording import RecordingError, read_recording

HOUSE_FORM = "time [s],deflection [cm],radius [cm],force [N]"


def loading(samples: int = 101) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time [s], deflection [cm] and force [N] of one triangle on the article's flat law, 550.9 x^1.422."""
    time = np.arange(samples) / 5.0
    deflection = 2.5 * (1.0 - np.abs(np.linspace(-1.0, 1.0, samples)))
    return time, deflection, 550.9 * deflection**1.422


def write_rows(path: Path, header: str, *columns: Sequence[float], separator: str = ",") -> Path:
    rows = [separator.join(f"{value:.6g}" for value in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path


def edited(path: Path, line: int, text: str) -> Path:
    """The file with one line, counted from 1 as in an editor, replaced."""
    lines = path.read_text(encoding="utf-8").splitlines()
    lines[line - 1] = text
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def refusal(path: Path | str, **options: object) -> str:
    """The one sentence in which a file is refused."""
    with pytest.raises(RecordingError) as caught:
        read_recording(path, **options)  # type: ignore[arg-type]
    message = str(caught.value)
    assert "\n" not in message
    assert Path(path).name in message
    return message
