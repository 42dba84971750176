"""Pictures of rides: written, of the right kind, and coloured where the ride is in doubt."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from PIL import Image
from tirelab.errors import TirelabError
from tirelab.terrain import Ride, animate_ride, draw_ride, flat, ground_from, iso8608, log, place, ride
from tirelab.terrain.profile import Floats


def flat_law(deflection: Floats, surface_radius: Floats) -> Floats:
    """Return the article's force on flat ground, F = 550.9 x^1.422, x in cm."""
    force: Floats = 550.9 * (100.0 * deflection) ** 1.422
    return force


@pytest.fixture(scope="module")
def over_a_log() -> Ride:
    return ride(ground_from(place(flat(4.0), log(), 2.0), 0.005), flat_law, speed=5.0, load=500.0)


def red_pixels(path: Path) -> int:
    """Return how many pixels have the strong red of a limit's own line."""
    pixels = imread(path)[..., :3]
    return int(
        np.count_nonzero(np.all(np.abs(pixels - np.array([0xD1, 0x49, 0x5B]) / 255.0) < 0.01, axis=-1))
    )


def test_picture_of_a_doubtful_ride_has_red_in_it(tmp_path: Path, over_a_log: Ride) -> None:
    draw_ride(over_a_log, tmp_path / "log.png")
    assert red_pixels(tmp_path / "log.png") > 500


def test_picture_of_a_ride_without_doubt_has_none(tmp_path: Path) -> None:
    result = ride(ground_from(flat(4.0)), flat_law, speed=5.0, load=500.0)
    draw_ride(result, tmp_path / "flat.png", "nothing to see")
    assert red_pixels(tmp_path / "flat.png") == 0


def test_picture_of_a_long_ride(tmp_path: Path) -> None:
    draw_ride(ride(ground_from(iso8608("B", 50.0, 1)), flat_law, speed=5.0, load=500.0), tmp_path / "b.png")
    height, width = imread(tmp_path / "b.png").shape[:2]
    assert width == 1200
    assert 600 < height < 1200


def test_animation_has_the_frames_it_was_asked_for(tmp_path: Path, over_a_log: Ride) -> None:
    animate_ride(over_a_log, tmp_path / "log.gif", frames=4, frames_per_second=10)
    with Image.open(tmp_path / "log.gif") as picture:
        assert picture.n_frames == 4
        assert picture.info["duration"] == 100


def test_no_state_of_pyplot_is_touched() -> None:
    code = "import sys, tirelab.terrain; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_places_that_cannot_be_written(tmp_path: Path, over_a_log: Ride) -> None:
    with pytest.raises(TirelabError, match="No such file or directory; name a file that can be written"):
        draw_ride(over_a_log, tmp_path / "none" / "log.png")
    with pytest.raises(TirelabError, match="name a file that can be written"):
        animate_ride(over_a_log, tmp_path / "none" / "log.gif", frames=2)
    with pytest.raises(TirelabError, match="1 frames; give 2 to 400"):
        animate_ride(over_a_log, tmp_path / "log.gif", frames=1)
