"""The samples that a page carries, and the library that draws them."""

from __future__ import annotations

import base64
import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drives import long_ride
from tirelab.recordings.recording import Recording
from tirelab.report import explore
from tirelab.report.loops import Case
from tirelab.report.page import write_report

CHANNELS = ("time", "deflection", "surface_radius", "force")


def case(samples: int, seed: int = 1) -> Case:
    rng = np.random.default_rng(seed)
    time = 3.0 + np.arange(samples) * 1e-3
    deflection = 0.01 - 0.01 * np.cos(time)
    force = 9e4 * deflection + rng.normal(0.0, 5.0, samples)
    return Case(
        Recording("r", time, deflection, np.full(samples, np.inf), force),
        9e4 * deflection,
        9.1e4 * deflection,
    )


def unpacked(channel: dict) -> np.ndarray:
    levels = np.frombuffer(base64.b64decode(channel["data"]), "<u2")
    return channel["low"] + channel["step"] * levels


def test_all_samples_of_a_short_recording_are_carried_to_half_a_step() -> None:
    made = case(3000)
    (packed,) = explore.explored([("fitted", made)], 5.0, False, 50_000)["recordings"]
    assert (packed["kept"], packed["thinned"]) == (3000, False)
    time = np.frombuffer(base64.b64decode(packed["time"]), "<f4")
    assert time == pytest.approx(made.recording.time - 3.0, abs=1e-6)
    for name, values in (
        ("force", made.recording.force),
        ("before", made.before),
        ("after", made.after),
        ("deflection", 1e3 * made.recording.deflection),
    ):
        assert np.max(np.abs(unpacked(packed[name]) - values)) <= 0.5001 * np.ptp(values) / 65535


def test_of_a_long_recording_every_moment_keeps_its_extremes() -> None:
    made = case(200_000)
    kept = explore.chosen_samples(made, 6000)
    assert kept.size <= 6002
    assert np.all(np.diff(kept) > 0)
    assert (kept[0], kept[-1]) == (0, 199_999)
    for values in (
        made.recording.force,
        made.recording.force - made.before,
        made.recording.force - made.after,
    ):
        for block in np.array_split(np.arange(200_000), 1000):
            own = kept[(kept >= block[0]) & (kept <= block[-1])]
            assert values[own].max() == values[block].max()
            assert values[own].min() == values[block].min()


def test_recordings_share_the_room_by_their_length() -> None:
    found = explore.explored([("fitted", case(300_000)), ("held-out", case(100_000))], 5.0, False, 50_000)
    assert found["total"] == 400_000
    assert 25_000 < found["kept"] <= 50_008
    long, short = (r["kept"] for r in found["recordings"])
    assert long / short == pytest.approx(3.0, rel=0.1)


@pytest.mark.parametrize(("count", "samples"), [(20, 50_000), (1, 1_000_000), (1, 80_000)])
def test_a_page_is_under_2_mb_and_uses_what_is_left(
    kinds: dict[str, Any], tmp_path: Path, count: int, samples: int
) -> None:
    path = tmp_path / "long.html"
    ((whole,), (before,), (after,)) = long_ride(count * samples)
    pieces = [slice(i * samples, (i + 1) * samples) for i in range(count)]
    rides = [
        replace(whole, name=f"ride {i}", **{k: getattr(whole, k)[p] for k in CHANNELS})
        for i, p in enumerate(pieces)
    ]
    write_report(path, kinds["one"].diagnosis, rides, [before[p] for p in pieces], [after[p] for p in pieces])
    size = path.stat().st_size
    assert size < 2e6
    carried = json.loads(path.read_text().partition('id="explore-data">')[2].partition("</script>")[0])
    assert carried["kept"] == samples or size > 1.8e6
    assert (carried["kept"] == count * samples) == (samples == 80_000)


def test_a_still_channel_is_carried() -> None:
    still = Case(
        Recording("s", np.arange(9.0), np.full(9, 0.01), np.full(9, np.inf), np.full(9, 100.0)),
        np.full(9, 100.0),
        np.full(9, 100.0),
    )
    (packed,) = explore.explored([("fitted", still)], 0.0, True, 50_000)["recordings"]
    assert np.array_equal(unpacked(packed["force"]), np.full(9, 100.0))


def test_the_script_is_the_one_that_its_hash_allows() -> None:
    script = explore.script()
    digest = hashlib.sha256(str(script.text).encode()).digest()
    assert script.hash == f"sha256-{base64.b64encode(digest).decode()}"
    assert "</script" not in script.text


def test_the_library_is_the_published_one() -> None:
    """The hashes of the files in the npm package uplot 1.6.32, which the README beside them states."""
    folder = Path(explore.__file__).parent / "uplot"
    readme = (folder / "README.md").read_text(encoding="utf-8")
    for name, start in (
        ("uPlot.iife.min.js", "19c8d4c6ad88929a"),
        ("uPlot.min.css", "df630c6a8d6f8eea"),
        ("LICENSE", "8f989229699b4fe2"),
    ):
        digest = hashlib.sha256((folder / name).read_bytes()).hexdigest()
        assert digest.startswith(start)
        assert f"{digest}  {name}" in readme
    assert "(v1.6.32)" in (folder / "uPlot.iife.min.js").read_text(encoding="utf-8")[:100]
