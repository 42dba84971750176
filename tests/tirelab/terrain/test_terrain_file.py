"""Profiles from CSV and GPX: units, places of faults, and XML that means harm."""

from pathlib import Path

import numpy as np
import pytest
from tirelab.errors import TirelabError
from tirelab.terrain import Profile, add_roughness, iso8608, read_gpx, read_profile, read_profile_csv

METRES_PER_DEGREE = 6371008.8 * np.pi / 180.0
"""Length of a degree of latitude on the sphere of the Earth's mean radius."""


def write(folder: Path, text: str, name: str = "trail.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def gpx(*points: tuple[float, float, float], head: str = "", between: str = "") -> str:
    body = between.join(f'<trkpt lat="{a}" lon="{b}"><ele>{c}</ele></trkpt>' for a, b, c in points)
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>{head}<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1">'
        f"<trk><name>a</name><trkseg>{body}</trkseg></trk></gpx>"
    )


NORTH = [(50.0 + 1e-4 * i, 8.0, 100.0 + i) for i in range(6)]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_units_of_the_header(tmp_path: Path, separator: str) -> None:
    rows = ["s [m]|z [cm]|note", "0|1.5|start", "1|2.5|", "", "# a rest", "2|3.5|", "3|4.5|", "4|5|"]
    profile = read_profile(write(tmp_path, "\n".join(rows).replace("|", separator)))
    np.testing.assert_allclose(profile.s, [0.0, 1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(profile.z, [0.015, 0.025, 0.035, 0.045, 0.05])
    assert profile.name == "trail.csv"


def test_columns_in_any_order_with_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "trail.csv"
    path.write_bytes(b"\xef\xbb\xbfZ [in], S [ft]\r\n1,0\r\n1,1\r\n1,2\r\n1,3\r\n2,4\r\n")
    profile = read_profile_csv(path, smoothing_length=0.0)
    np.testing.assert_allclose(profile.s, 0.3048 * np.arange(5.0))
    np.testing.assert_allclose(profile.z, [0.0254] * 4 + [0.0508])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", r"trail.csv: the file is empty"),
        ("s [m],h [m]\n0,0\n", r"header: no column 'z' among 's \[m\]', 'h \[m\]'"),
        ("s,z [m]\n0,0\n", r"header: column 's' has no unit; write it in brackets, 's \[m\]'"),
        ("s [m],z [kg]\n0,0\n", r"header: 'z \[kg\]': 'kg' is not a unit of length"),
        ("s [m],z [9**9**9]\n0,0\n", r"header: 'z \[9\*\*9\*\*9\]': unknown unit '9\*\*9\*\*9' of length"),
        ("s [m],z [m]\n0,0\n\n1,abc\n", r"row 4, column z: 'abc' is not a number"),
        ("s [m],z [m]\n0,0\n1\n", r"row 3, column z: '' is not a number"),
        (
            's [m],z [m]\n0,0\n"1,5",0\n',
            r"row 3, column s: '1,5' is not a number; write one, with a decimal point",
        ),
        ("s [m],z [m]\n0,0\n1,0\n2,nan\n3,0\n4,0\n", r"row 4: z is nan"),
        ("s [m],z [m]\n0,0\n1,0\n0.5,0\n3,0\n4,0\n", r"row 4: the profile folds back"),
        (
            "s [m],z [m]\n0,0\n1,0\n1,0.3\n3,0\n4,0\n",
            r"row 4: the profile steps from z = 0 m to 0.3 m at s = 1 m",
        ),
        ("s [m],z [m]\n0,0\n", r"row 2: the profile has 1 point in all"),
        ('s [m],z [m]\n0,0\n1,"0\n2,0\n3,0\n', r"row 5, column z: '0"),
        ("s [m],z [m]\n0,0\n1," + "0" * 200_000 + "\n", r"row 3: field larger than field limit"),
        ("s [m],z [m]\n", r"the profile has 0 points in all"),
    ],
)
def test_faults_are_told_with_their_row(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence) as caught:
        read_profile_csv(write(tmp_path, text))
    assert "\n" not in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(TirelabError, match="No such file"):
        read_profile(tmp_path / "none.csv")
    with pytest.raises(TirelabError, match="No such file"):
        read_profile(tmp_path / "none.gpx")
    (tmp_path / "latin.csv").write_bytes(b"s [m],z [m]\n0,\xe9\n")
    with pytest.raises(TirelabError, match="not UTF-8 text at byte 14"):
        read_profile(tmp_path / "latin.csv")


def test_gpx_north_by_degrees(tmp_path: Path) -> None:
    profile = read_profile(write(tmp_path, gpx(*NORTH), "hill.gpx"))
    np.testing.assert_allclose(profile.s, 1e-4 * METRES_PER_DEGREE * np.arange(6.0), rtol=1e-9)
    np.testing.assert_allclose(profile.z, 100.0 + np.arange(6.0))
    assert profile.smoothing_length == 50.0


def test_gpx_east_shrinks_with_the_cosine_of_latitude(tmp_path: Path) -> None:
    east = [(60.0, 8.0 + 1e-4 * i, 0.0) for i in range(6)]
    profile = read_gpx(write(tmp_path, gpx(*east), "hill.gpx"))
    assert profile.length == pytest.approx(5e-4 * METRES_PER_DEGREE * 0.5, rel=1e-6)


def test_standing_still_is_merged_and_told(tmp_path: Path) -> None:
    jitter = [(*NORTH[2][:2], 108.0), (NORTH[2][0] + 5e-6, 8.0 - 4e-6, 108.0)]
    profile = read_gpx(write(tmp_path, gpx(*NORTH[:3], *jitter, *NORTH[3:]), "hill.gpx"))
    assert profile.z[2] == pytest.approx((102.0 + 2 * 108.0) / 3.0)
    np.testing.assert_allclose(profile.s, 1e-4 * METRES_PER_DEGREE * np.arange(6.0), rtol=1e-9)
    assert profile.notes[0].startswith("2 of 8 track points")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (gpx(), "no track points"),
        (gpx(*NORTH)[:-8], "not well-formed XML"),
        (gpx(*NORTH, between="</trkseg><trkseg>"), "a second track segment begins"),
        (gpx((91.0, 0.0, 0.0)), r"lat = 91 is not within 90 degrees"),
        (gpx(("x", 0.0, 0.0)), r"track point 1: lat 'x' is not a number"),  # type: ignore[arg-type]
        (gpx((0.0, 0.0, "nan")), r"track point 1: elevation 'nan' is not a number"),  # type: ignore[arg-type]
        (gpx(*NORTH).replace("<ele>102.0</ele>", ""), r"track point 3 has no elevation"),
        (gpx(*NORTH[:3]), r"the profile has 3 points in all"),
    ],
)
def test_gpx_faults(tmp_path: Path, text: str, sentence: str) -> None:
    with pytest.raises(TirelabError, match=sentence):
        read_gpx(write(tmp_path, text, "hill.gpx"))


@pytest.mark.parametrize(
    "head",
    [
        '<!DOCTYPE gpx [<!ENTITY a "1"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>',
        '<!DOCTYPE gpx SYSTEM "http://example.org/gpx.dtd">',
        '<!DOCTYPE gpx [<!ENTITY x SYSTEM "file:///etc/passwd">]>',
    ],
)
def test_gpx_with_a_document_type_is_refused(tmp_path: Path, head: str) -> None:
    with pytest.raises(TirelabError, match="line 1: a document type declaration is not allowed"):
        read_gpx(write(tmp_path, gpx(*NORTH, head=head), "bomb.gpx"))


def test_roughness_is_added_to_hills(tmp_path: Path) -> None:
    hills = Profile(np.linspace(0.0, 50.0, 11), 0.1 * np.linspace(0.0, 50.0, 11), "hill", 20.0)
    rough = iso8608("C", 40.0, 1)
    both = add_roughness(hills, rough)
    assert both.length == pytest.approx(40.0)
    # A line is its own smoothing spline, so the hill comes back exactly.
    np.testing.assert_allclose(both.z - rough.z, 0.1 * both.s, atol=1e-9)
    assert any("smoothed over 20 m" in note for note in both.notes)
