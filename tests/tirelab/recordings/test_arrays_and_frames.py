"""Recordings of arrays and data frames: the same values, notes and refusals as for a file of the same numbers."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pytest
import tirelab
from house_form import loading, write_rows
from tirelab.recordings.recording import Recording, RecordingError, read_recording

TIME, DEFLECTION_CM, FORCE = loading()
DEFLECTION = DEFLECTION_CM / 100.0
HEADERS = ("Time [s]", "Stroke [mm]", "Load [kN]")
TABLE = dict(zip(HEADERS, (TIME, 10.0 * DEFLECTION_CM, FORCE / 1000.0), strict=True))
FRAMES = {"pandas": pd.DataFrame, "polars": pl.DataFrame}


@pytest.fixture(params=FRAMES)
def frame_of(request: pytest.FixtureRequest) -> Any:
    return FRAMES[request.param]


def refused(make: Any, *arguments: Any, **options: Any) -> str:
    with pytest.raises(RecordingError) as caught:
        make(*arguments, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert "--" not in message
    return message


class TestArrays:
    def test_arrays_in_si(self) -> None:
        recording = Recording.from_arrays(TIME, DEFLECTION, FORCE, "flat", name="slow")
        assert (recording.name, recording.source, len(recording)) == ("slow", None, 101)
        np.testing.assert_array_equal(recording.time, TIME)
        np.testing.assert_array_equal(recording.deflection, DEFLECTION)
        np.testing.assert_array_equal(recording.force, FORCE)
        assert np.all(np.isinf(recording.surface_radius))
        assert recording.notes == ("surface radius flat as given",)

    @pytest.mark.parametrize(
        ("given", "radius"),
        [
            ("flat", np.inf),
            (np.inf, np.inf),
            (-np.inf, np.inf),
            (0.254, 0.254),
            (np.float32(0.5), 0.5),
            (np.array(-0.25), -0.25),
            (1, 1.0),
            ("25.4 cm", 0.254),
            ("-50.8cm", -0.508),
        ],
        ids=str,
    )
    def test_one_radius_for_all_samples(self, given: Any, radius: float) -> None:
        recording = Recording.from_arrays(TIME, DEFLECTION, FORCE, surface_radius=given)
        np.testing.assert_array_equal(recording.surface_radius, np.full(101, radius))

    def test_a_radius_for_each_sample(self) -> None:
        radius = np.where(np.arange(101) < 50, np.inf, -0.3)
        recording = Recording.from_arrays(TIME, DEFLECTION, FORCE, radius)
        np.testing.assert_array_equal(recording.surface_radius, radius)

    @pytest.mark.parametrize("radius", ["radius", "surface_radius"])
    @pytest.mark.parametrize("value", [25.4, np.full(101, 25.4)], ids=["one", "each"])
    def test_units(self, radius: str, value: Any) -> None:
        recording = Recording.from_arrays(
            1000.0 * TIME,
            10.0 * DEFLECTION_CM,
            FORCE / 1000.0,
            value,
            units={"time": "ms", "deflection": "mm", "force": "kN", radius: "cm"},
        )
        np.testing.assert_allclose(recording.time, TIME, rtol=1e-15)
        np.testing.assert_allclose(recording.deflection, DEFLECTION, rtol=1e-15)
        np.testing.assert_allclose(recording.force, FORCE, rtol=1e-15)
        np.testing.assert_allclose(recording.surface_radius, 0.254, rtol=1e-15)

    def test_flat_with_a_unit_is_flat(self) -> None:
        recording = Recording.from_arrays(TIME, DEFLECTION, FORCE, np.inf, units={"radius": "cm"})
        assert np.all(np.isinf(recording.surface_radius))

    def test_the_callers_arrays_stay_what_they_are(self) -> None:
        time, deflection, force = 1000.0 * TIME, -DEFLECTION, -FORCE
        kept = [array.copy() for array in (time, deflection, force)]
        recording = Recording.from_arrays(time, deflection, force, "flat", units={"time": "ms"})
        time += 1.0
        force[:] = 0.0
        assert recording.time[0] == 0.0
        np.testing.assert_array_equal(recording.force, FORCE)
        np.testing.assert_array_equal(time - 1.0, kept[0])
        np.testing.assert_array_equal(deflection, kept[1])

    @pytest.mark.parametrize(("x", "f"), [(-1, 1), (1, -1), (-1, -1)])
    def test_signs_are_turned_as_for_a_file(self, tmp_path: Path, x: int, f: int) -> None:
        header = "time [s],deflection [cm],force [N]"
        path = write_rows(tmp_path / "turned.csv", header, TIME, x * DEFLECTION_CM, f * FORCE)
        file = read_recording(path, radius="flat")
        recording = Recording.from_arrays(TIME, x * DEFLECTION, f * FORCE, "flat")
        assert recording.notes == file.notes
        assert any("turned in sign" in note for note in recording.notes)
        np.testing.assert_allclose(recording.force, file.force, rtol=1e-5)

    def test_lists_integers_masks_and_dates(self) -> None:
        force = np.ma.masked_array(FORCE, mask=np.arange(101) == 7)
        when = np.datetime64("2026-01-01T12:00:00") + np.arange(101) * np.timedelta64(200, "ms")
        recording = Recording.from_arrays(when, list(DEFLECTION), force, "flat")
        assert len(recording) == 100
        assert recording.time[-1] == pytest.approx(20.0)
        assert "skipped for want of force: sample 8" in recording.notes
        counted = Recording.from_arrays(range(101), DEFLECTION, FORCE.astype(np.int32), "flat")
        assert counted.time[-1] == 100.0

    @pytest.mark.parametrize(
        ("change", "sentence"),
        [
            (
                {"surface_radius": None},
                'slow: the radius of the surface is not known; give surface_radius="flat"',
            ),
            ({"surface_radius": {}}, "the radius of the surface is not known"),
            ({"surface_radius": 0.0}, "radius '0.0' is no radius"),
            ({"surface_radius": "25"}, "radius '25' has no unit"),
            ({"surface_radius": "0"}, "radius '0' is no radius; write flat"),
            ({"surface_radius": np.zeros(101)}, "sample 1, column 'radius': 0 is no radius"),
            ({"time": TIME[:-1]}, "unequal numbers of samples ('time' 100, 'deflection' 101, 'force' 101)"),
            ({"time": np.roll(TIME, 1)}, "sample 2, column 'time': time goes back from 20 s to 0 s"),
            ({"force": np.where(TIME == 1.0, np.inf, FORCE)}, "sample 6, column 'force': inf is no force"),
            ({"force": ["a"] * 101}, "slow, column 'force': holds text, 'a' the first, not numbers"),
            ({"force": FORCE > 0.0}, "holds true and false"),
            ({"force": None}, "slow, force: is NoneType, not one value per sample; give an array or a list"),
            ({"force": iter(FORCE)}, "not one value per sample"),
            ({"deflection": 3.0}, "slow, deflection: is float, not one value per sample"),
            ({"force": FORCE[:, None]}, "slow, force: has the shape (101, 1); give one value per sample"),
            ({"deflection": 10.0 * DEFLECTION_CM}, "25 m is deeper than a wheel; correct its unit"),
            ({"deflection": np.full(101, 0.01)}, "is 0.01 m in every row; name the column that moves"),
            ({"units": {"force": "kg"}}, "did you mean kgf?"),
            ({"units": {"load": "N"}}, "'load' is no channel"),
            ({"units": {"pressure": "bar"}}, "there is no array of pressure"),
            ({"force": np.full(101, np.nan)}, "101 of 101 rows have no value"),
            ({"time": [], "deflection": [], "force": []}, "no rows"),
        ],
    )
    def test_what_is_refused(self, change: dict[str, Any], sentence: str) -> None:
        given = {"time": TIME, "deflection": DEFLECTION, "force": FORCE, "surface_radius": "flat", **change}
        message = refused(Recording.from_arrays, **given, name="slow")
        assert message.startswith("slow")
        assert sentence in message

    def test_signs_in_doubt_are_refused_with_the_way_to_say_them(self) -> None:
        # The distance to the ground in place of the deflection: the force falls with it.
        message = refused(Recording.from_arrays, TIME, DEFLECTION.max() - DEFLECTION, FORCE, "flat")
        assert (
            'Recording.from_dataframe(frame, columns={"deflection": "-deflection", "force": "+force"})'
            in message
        )


class TestFrames:
    def test_a_frame_is_read_like_the_file_of_its_columns(self, frame_of: Any, tmp_path: Path) -> None:
        pl.DataFrame(TABLE).write_csv(tmp_path / "slow.csv")
        file = read_recording(tmp_path / "slow.csv", radius="25.4 cm")
        recording = Recording.from_dataframe(frame_of(TABLE), name="slow", radius="25.4 cm")
        assert (recording.name, recording.notes, recording.source) == (file.name, file.notes, None)
        for (_, mine), (_, of_file) in zip(recording.channels(), file.channels(), strict=True):
            np.testing.assert_array_equal(mine, of_file)
        np.testing.assert_allclose(recording.force, FORCE, rtol=1e-15)

    def test_optional_channels_and_the_radius(self, frame_of: Any) -> None:
        frame = frame_of({**TABLE, "Rb [in]": [10.0] * 101, "Inflation pressure [psi]": [50.0] * 101})
        recording = Recording.from_dataframe(frame)
        assert recording.name == "recording"
        assert recording.surface_radius[0] == pytest.approx(0.254)
        assert recording.pressure is not None
        assert recording.pressure[0] == pytest.approx(344738.0, abs=1.0)

    def test_columns_and_units_are_named_as_for_a_file(self, frame_of: Any) -> None:
        frame = frame_of({"a": TIME, "b": -DEFLECTION_CM, "c": FORCE})
        recording = Recording.from_dataframe(
            frame,
            columns={"time": "a", "deflection": "-B", "force": "#3"},
            units={"time": "s", "deflection": "cm", "force": "N"},
            radius=np.inf,
        )
        np.testing.assert_allclose(recording.deflection, DEFLECTION, rtol=1e-15)
        assert "deflection turned in sign, as asked" in recording.notes

    def test_rows_without_a_value_are_skipped(self, frame_of: Any) -> None:
        force: list[float | None] = list(TABLE["Load [kN]"])
        force[3] = None
        recording = Recording.from_dataframe(frame_of({**TABLE, "Load [kN]": force}), radius="flat")
        assert "skipped for want of force: sample 4" in recording.notes

    def test_dates_are_seconds_from_the_first(self, frame_of: Any) -> None:
        when = pd.date_range("2026-01-01", periods=101, freq="200ms").to_numpy().astype("datetime64[us]")
        recording = Recording.from_dataframe(frame_of({**TABLE, "Time [s]": when}), radius="flat")
        np.testing.assert_allclose(recording.time, TIME, rtol=1e-12)

    def test_the_frame_stays_what_it_is(self, frame_of: Any) -> None:
        frame = frame_of({**TABLE, "Load [kN]": -FORCE})
        Recording.from_dataframe(frame, radius="flat", units={"force": "N"})
        np.testing.assert_array_equal(frame["Load [kN]"].to_numpy(), -FORCE)

    @pytest.mark.parametrize(
        ("change", "sentence"),
        [
            ({}, 'or give radius="flat"'),
            (
                {"Load [kN]": ["a"] * 101},
                "column 'Load [kN]': holds text, 'a' the first, not numbers; name another",
            ),
            ({"Force [N]": FORCE}, 'may each be the force; say which with columns={"force": "#3"}'),
            ({"Load [kN]": FORCE > 1.0}, "holds true and false"),
        ],
    )
    def test_what_is_refused(self, frame_of: Any, change: dict[str, Any], sentence: str) -> None:
        radius = "flat" if change else None
        message = refused(Recording.from_dataframe, frame_of({**TABLE, **change}), name="slow", radius=radius)
        assert message.startswith("slow")
        assert sentence in message

    def test_a_unit_that_is_not_there_is_asked_for(self, frame_of: Any) -> None:
        frame = frame_of({"time": TIME, "deflection": DEFLECTION, "force": FORCE})
        message = refused(Recording.from_dataframe, frame, radius="flat")
        assert "no unit for 'time', 'deflection', 'force'" in message
        assert 'units={"time": "s", "deflection": "' in message

    def test_a_column_that_is_not_there_is_asked_for(self, frame_of: Any) -> None:
        message = refused(Recording.from_dataframe, frame_of({"time [s]": TIME}), radius="flat")
        assert 'name it with columns={"deflection": "NAME", "force": "NAME"}' in message

    @pytest.mark.parametrize("thing", [None, [1.0], {"time": [1.0]}, "slow.csv", np.zeros((3, 3))], ids=repr)
    def test_what_is_no_frame_is_refused(self, thing: object) -> None:
        assert "is no data frame; give one of pandas or polars" in refused(Recording.from_dataframe, thing)


class TestPandas:
    """What pandas alone has: an index, missing values in integers, repeated and stacked names, time zones."""

    @pytest.mark.parametrize("name", ["Time [s]", "time"])
    def test_an_index_with_a_name_is_a_column(self, name: str) -> None:
        frame = pd.DataFrame(TABLE).set_index("Time [s]").rename_axis(name)
        recording = Recording.from_dataframe(frame, radius="flat", units={"time": "s"})
        np.testing.assert_array_equal(recording.time, TIME)

    @pytest.mark.parametrize(
        "index",
        [
            pd.to_timedelta(TIME, unit="s"),
            pd.date_range("2026-01-01", periods=101, freq="200ms"),
            pd.date_range("2026-01-01", periods=101, freq="200ms", tz="Europe/Zurich"),
        ],
        ids=["durations", "dates", "zoned"],
    )
    def test_an_index_of_dates_or_durations_is_the_time(self, index: Any) -> None:
        frame = pd.DataFrame(TABLE, index=None).drop(columns="Time [s]").set_index(index)
        recording = Recording.from_dataframe(frame, radius="flat")
        np.testing.assert_allclose(recording.time, TIME, rtol=1e-9)

    def test_dates_with_a_time_zone(self) -> None:
        when = pd.Series(pd.date_range("2026-03-29", periods=101, freq="200ms", tz="Europe/Zurich"))
        recording = Recording.from_dataframe(pd.DataFrame({**TABLE, "Time [s]": when}), radius="flat")
        np.testing.assert_allclose(recording.time, TIME, rtol=1e-9)

    @pytest.mark.parametrize("kind", ["Float64", "object", "float32"])
    def test_every_kind_of_number(self, kind: str) -> None:
        force = pd.Series(TABLE["Load [kN]"]).astype(kind)
        if kind != "float32":
            force[5] = pd.NA
        recording = Recording.from_dataframe(pd.DataFrame({**TABLE, "Load [kN]": force}), radius="flat")
        assert len(recording) == (101 if kind == "float32" else 100)
        np.testing.assert_allclose(recording.force[-1], FORCE[-1], rtol=1e-6, atol=1e-9)

    def test_python_dates_are_dates(self) -> None:
        when = pd.Series(pd.date_range("2026-01-01", periods=101, freq="200ms").to_pydatetime(), dtype=object)
        frame = pd.DataFrame({**TABLE, "Time [s]": when})
        np.testing.assert_allclose(Recording.from_dataframe(frame, radius="flat").time, TIME, rtol=1e-9)

    def test_text_among_missing_values_is_refused(self) -> None:
        force = pd.Series([None, "x"] * 50 + [None], dtype=object)
        frame = pd.DataFrame({**TABLE, "Load [kN]": force})
        assert "holds text, 'x' the first" in refused(Recording.from_dataframe, frame, radius="flat")

    def test_a_column_without_any_value_is_refused(self) -> None:
        frame = pd.DataFrame({**TABLE, "Load [kN]": pd.Series([None] * 101, dtype=object)})
        assert "101 of 101 rows have no value for force" in refused(
            Recording.from_dataframe, frame, radius="flat"
        )

    def test_a_unit_in_the_name_and_another_one_in_the_first_row_are_asked_about(self) -> None:
        columns = {"Time [s]": ("s", TIME), "Stroke [cm]": ("cm", DEFLECTION_CM), "Load [kN]": ("N", FORCE)}
        frame = pd.DataFrame({name: [unit, *map(str, values)] for name, (unit, values) in columns.items()})
        assert "unknown unit 'kN or N' of force" in refused(Recording.from_dataframe, frame, radius="flat")
        recording = Recording.from_dataframe(frame, radius="flat", units={"force": "N"})
        np.testing.assert_allclose(recording.force, FORCE, rtol=1e-12)

    def test_names_with_a_level_of_units(self) -> None:
        frame = pd.DataFrame(np.stack([TIME, DEFLECTION_CM, FORCE, FORCE], axis=1))
        levels = [("Time", "s"), ("Stroke", "cm"), ("Load", "N"), ("Load", "raw")]
        frame.columns = pd.MultiIndex.from_tuples(levels)
        recording = Recording.from_dataframe(frame, radius="flat")
        np.testing.assert_array_equal(recording.force, FORCE)

    def test_one_of_two_columns_of_the_same_name_is_taken_by_its_number(self) -> None:
        frame = pd.DataFrame(np.stack([TIME, DEFLECTION_CM, FORCE, 0.0 * FORCE], axis=1))
        frame.columns = ["Time [s]", "Stroke [cm]", "Load [N]", "Load [N]"]
        assert "#3" in refused(Recording.from_dataframe, frame, radius="flat")
        recording = Recording.from_dataframe(frame, radius="flat", columns={"force": "#3"})
        np.testing.assert_array_equal(recording.force, FORCE)

    def test_pandas_is_not_imported_by_the_tool(self) -> None:
        found = {Path(m.__file__ or "") for n, m in sys.modules.items() if n.startswith("tirelab.recordings")}
        assert found
        for file in found:
            assert "import pandas" not in file.read_text(encoding="utf-8")


class TestPolars:
    def test_a_lazy_frame_is_collected(self) -> None:
        recording = Recording.from_dataframe(pl.LazyFrame(TABLE), radius="flat")
        np.testing.assert_allclose(recording.force, FORCE, rtol=1e-15)

    def test_lists_are_refused(self) -> None:
        frame = pl.DataFrame({**TABLE, "Load [kN]": [[1.0]] * 101})
        assert "holds lists, not numbers" in refused(Recording.from_dataframe, frame, radius="flat")

    def test_what_gives_arrow_data_is_a_frame(self) -> None:
        frame = pl.DataFrame(TABLE)

        class Foreign:
            def __arrow_c_stream__(self, requested_schema: object = None) -> object:
                return frame.__arrow_c_stream__(requested_schema)

        recording = Recording.from_dataframe(Foreign(), radius="flat")
        np.testing.assert_allclose(recording.force, FORCE, rtol=1e-15)


class TestDescription:
    def test_a_recording_in_one_line(self) -> None:
        time = np.linspace(0.0, 60.0, 1200)
        deflection = 0.0251 * np.sin(np.pi * time / 60.0) ** 2
        force = 2007.0 * (deflection / 0.0251) ** 1.4
        recording = Recording("slow", time, deflection, np.full(1200, np.inf), force)
        assert repr(recording) == "Recording('slow', 1200 samples, 60 s, 0 to 25.1 mm, flat, up to 2007 N)"

    @pytest.mark.parametrize(
        ("radius", "text"),
        [
            (np.full(101, 0.254), "radius 25.4 cm"),
            (np.where(np.arange(101) < 50, np.inf, -0.3), "radius -30 cm, flat"),
            (np.linspace(0.1, 0.9, 101), "101 surface radii"),
        ],
    )
    def test_its_surface(self, radius: np.ndarray, text: str) -> None:
        assert f", {text}, up to" in repr(Recording("a", TIME, DEFLECTION, radius, FORCE))

    def test_a_constant_deflection(self) -> None:
        recording = Recording("a", TIME, np.full(101, 0.01), np.full(101, np.inf), FORCE)
        assert "10 to 10 mm" in repr(recording)

    def test_a_table_for_a_notebook_is_escaped(self) -> None:
        recording = Recording(
            "<b>slow</b>",
            TIME,
            DEFLECTION,
            np.full(101, np.inf),
            FORCE,
            speed=np.zeros(101),
            notes=("a < b & c",),
        )
        html = recording._repr_html_()
        assert html.startswith("<table>")
        assert "&lt;b&gt;slow&lt;/b&gt;" in html
        assert "a &lt; b &amp; c" in html
        for text in ("101", "20 s", "0 to 25 mm", "flat", "speed", "recorded"):
            assert text in html

    def test_it_is_short(self) -> None:
        assert len(repr(Recording.from_arrays(TIME, DEFLECTION, FORCE, "flat"))) < 120

    def test_it_is_what_tirelab_offers(self) -> None:
        assert tirelab.Recording is Recording
