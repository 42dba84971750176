"""What is refused before the work, and what passes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from radialtire import PowerLaw, TireModel
from tirelab.diagnosis.request_checks import (
    beyond_fitted,
    check_apart,
    check_depth,
    check_folder,
    check_once,
    pulls_told,
)
from tirelab.errors import TirelabError
from tirelab.recordings.recording import Recording


def part(begin: float, end: float, deepest: float = 0.01, source: Path | None = None) -> Recording:
    time = np.linspace(begin, end, 50)
    none = np.zeros(50)
    return Recording("press", time, np.linspace(0.0, deepest, 50), none + np.inf, none, source=source)


def test_files_are_told_apart_by_where_they_are(tmp_path: Path) -> None:
    check_once([tmp_path / "a" / "press.csv", tmp_path / "b" / "press.csv"])
    with pytest.raises(TirelabError, match=r"press\.csv is given twice"):
        check_once([tmp_path / "a" / "press.csv", tmp_path / "b" / ".." / "a" / "press.csv"])


def test_parts_of_a_file_may_touch_nothing_of_each_other(tmp_path: Path) -> None:
    file, other = tmp_path / "press.csv", tmp_path / "other.csv"
    for path in (file, other):
        path.write_text("")
    first, second = (Path(f"{file}@{piece}") for piece in ("0s:9s", "10s:20s"))
    check_apart([(first, part(0.0, 9.0, source=file)), (second, part(10.0, 20.0, source=file))])
    check_apart([(file, part(0.0, 9.0, source=file)), (other, part(5.0, 12.0, source=other))])
    check_apart([(file, part(0.0, 9.0)), (other, part(5.0, 12.0))])
    with pytest.raises(TirelabError, match="share 5 to 9 s; give each part of a file once"):
        check_apart([(first, part(0.0, 9.0, source=file)), (second, part(5.0, 12.0, source=file))])
    one, other = (replace(part(*ends, source=file), timed=False) for ends in ((0.0, 9.0), (9.0, 12.0)))
    with pytest.raises(
        TirelabError, match=r"share 1 sample; give each part of a file once \(a range includes both ends\)"
    ):
        check_apart([(first, one), (second, other)])


def test_tests_below_one_another_share_no_rows_though_their_clocks_begin_anew(tmp_path: Path) -> None:
    file = tmp_path / "press.csv"
    file.write_text("")
    first, second, across = (Path(f"{file}@{rows}") for rows in ("2:51", "60:109", "51:80"))
    of_file = part(0.0, 9.0, source=file)
    check_apart([(first, of_file), (second, of_file)])
    check_apart([(second, of_file), (first, of_file)])
    with pytest.raises(TirelabError, match="give each part of a file once"):
        check_apart([(first, of_file), (across, of_file)])


def test_a_tire_is_pressed_and_no_deeper_than_its_wheel() -> None:
    tire, held = TireModel(), TireModel(PowerLaw(), two_sided=True, inflated=False)
    check_depth([part(0.0, 1.0, 0.3)], [], tire)
    with pytest.raises(TirelabError, match=r"no deflection is above 0.*--zero deflection=-10mm$"):
        check_depth([part(0.0, 1.0, -0.01)], [], tire)
    check_depth([part(0.0, 1.0, -0.01)], [], held)
    with pytest.raises(
        TirelabError, match=r"the deflection is 0\.4 m at 1 s, and a tire takes 0\.33 m at most"
    ):
        check_depth([part(0.0, 1.0)], [part(0.0, 1.0, 0.4)], tire)
    check_depth([part(0.0, 1.0)], [part(0.0, 1.0, 0.4)], held)


def test_a_gauge_that_stands_far_from_zero_is_asked_for_its_zero() -> None:
    """A robot's position: the force begins at 357 mm; at 0 the advice would be of no use."""
    far = part(0.0, 1.0, 0.372)
    far = replace(far, deflection=np.maximum(far.deflection, 0.357))
    with pytest.raises(TirelabError, match=r"nothing is loaded, such as --zero deflection=357mm, or choose"):
        check_depth([far], [], TireModel())
    with pytest.raises(TirelabError, match=r"nothing is loaded, or choose a range"):
        check_depth([part(0.0, 1.0, 0.372)], [], TireModel())


def test_a_folder_may_be_new_but_not_within_a_file(tmp_path: Path) -> None:
    check_folder(tmp_path / "new" / "deeper")
    (tmp_path / "taken").write_text("")
    with pytest.raises(TirelabError, match="taken is a file; name another folder with --out"):
        check_folder(tmp_path / "taken" / "out")


def test_what_only_held_out_recordings_reach_is_told() -> None:
    """A press to 10 mm, and one to 20 mm, of which half the samples lie deeper; one to 10.2 mm lies within."""
    half, whole, within = (
        Recording(
            name,
            *np.stack([np.arange(101.0), np.linspace(0.0, most, 101)]),
            np.full(101, np.inf),
            np.ones(101),
        )
        for name, most in (("half", 0.010), ("whole", 0.020), ("within", 0.0102))
    )
    (told,) = beyond_fitted([half], [within, whole])
    assert told.startswith("50 % of whole lie beyond the deflections fitted on their surface, 0 to 10 mm")
    assert beyond_fitted([whole], [half, within]) == []
    assert beyond_fitted([half], []) == []
    drum = replace(whole, surface_radius=np.full(101, 0.3))
    assert beyond_fitted([half, drum], [replace(drum, name="again")]) == []
    assert len(beyond_fitted([half, drum], [whole])) == 1


def test_a_tire_that_pulls_is_told_and_a_part_is_not() -> None:
    """Of 2000 N, 60 are more than a hundredth and 15 are not; nor is the noise, 40 N in the last."""
    x = 0.02 * (1.0 - np.abs(np.linspace(-1.0, 1.0, 1000)))

    def press(shift: float, sigma: float = 4.0) -> Recording:
        noise = sigma * np.random.default_rng(1).standard_normal(x.size)
        return Recording(f"{shift:g}", np.arange(1000.0), x, np.full(1000, np.inf), 1e5 * x + noise + shift)

    presses = [press(0.0), press(-15.0), press(-60.0), press(0.0, 40.0)]
    (told,) = pulls_told(presses, TireModel())
    assert told.startswith("the force of -60 goes down to -")
    assert "--zero force=-" in told
    assert told.endswith("if this is a part that is held at both ends, identify it with --part")
    (of_part,) = pulls_told(presses, TireModel(PowerLaw(1000.0, 1.0), inflated=False))
    assert of_part.endswith("identify it with a law that pulls, as --part power_preload or --part linear")
    assert pulls_told(presses, TireModel(two_sided=True)) == []
