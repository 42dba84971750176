"""The limits of a rig, from a file and from options."""

import math
from pathlib import Path

import pytest
from tirelab.errors import TirelabError
from tirelab.planning.rig import KEYS, Rig, read_rig

FILE = """
stroke = "18 mm"
speed = "0.2 m/s"
surfaces = ["flat", "25.4 cm"]
pressures = "2 bar, 3 bar"
time = "4 min"
sampling = "100 Hz"
noise = "1.5 lbf"
force = "0.8 kN"
"""


def test_a_file_says_it_all(tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(FILE)
    rig = read_rig(tmp_path / "rig.toml", {})
    assert (rig.stroke, rig.speed, rig.time, rig.sampling) == pytest.approx((0.018, 0.2, 240.0, 0.01))
    assert rig.surfaces == (math.inf, 0.254)
    assert rig.pressures == pytest.approx((2e5, 3e5))
    assert rig.noise == pytest.approx(1.5 * 4.4482216152605)
    assert rig.force == rig.test_limits.force == pytest.approx(800.0)


def test_options_go_over_the_file(tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(FILE)
    rig = read_rig(tmp_path / "rig.toml", {"stroke": "10mm", "surfaces": "-50.8cm", "noise": None})
    assert (rig.stroke, rig.surfaces, rig.speed) == (0.01, (-0.508,), 0.2)


def test_without_either_the_defaults_hold() -> None:
    assert read_rig(None, dict.fromkeys(KEYS)) == Rig()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"stroke": "20"}, "--stroke: '20' is not a number with a unit; write for instance 20mm"),
        ({"speed": "20mm"}, "--speed: '20mm': 'mm' is not a unit of speed"),
        ({"noise": "-3N"}, "--noise: '-3N' is not positive"),
        ({"force": "80kg"}, "--force: '80kg': 'kg' is not a unit of force"),
        ({"surfaces": "flat,25.4"}, "--surfaces: radius '25.4' has no unit"),
        ({"surfaces": ""}, "--surfaces: radius '' cannot be read"),
        ({"sampling": "fast"}, "--sampling: sampling 'fast' cannot be read"),
        ({"time": "1s", "sampling": "10Hz"}, "are 10 samples, and a plan needs 100"),
        ({"time": "10s", "speed": "1mm/s"}, "the rig moves 10 mm, less than 16 cycles of 20 mm"),
        ({"time": "300s", "stroke": "2000mm"}, "the rig moves 30000 mm, less than"),
    ],
)
def test_bad_limits_are_told_in_a_sentence(given: dict[str, str], words: str) -> None:
    with pytest.raises(TirelabError) as told:
        read_rig(None, given)
    assert words in str(told.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("stroke = 20", "stroke: 20 is not a number with a unit"),
        ("depth = '20 mm'", "'depth' is not known here; the keys are stroke, speed, surfaces"),
        ("stroke = ", "is not TOML"),
        ("stroke = " + "9" * 5000, "is not TOML"),
        ("surfaces = [" + "9" * 400 + "]", "is not TOML (surfaces is an integer of more than 64 bits)"),
        ("stroke = " + "[" * 20_000, "is not TOML"),
        ("surfaces = 3", "surfaces: 3 is no list; write for instance flat,25.4cm"),
    ],
)
def test_a_bad_file_is_told_with_its_key(content: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(content)
    with pytest.raises(TirelabError, match=r"rig\.toml") as told:
        read_rig(tmp_path / "rig.toml", {})
    assert words in str(told.value)


def test_a_test_after_a_diagnosis_takes_a_minute_at_most() -> None:
    assert Rig(time=300.0).test_limits.longest == 60.0
    assert Rig(time=40.0, surfaces=(0.2,)).test_limits.longest == 40.0
    assert Rig(surfaces=(0.2,)).test_limits.surfaces == (0.2,)
