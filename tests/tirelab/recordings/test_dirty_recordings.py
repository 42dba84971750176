"""Files made dirty at random: nothing crashes, nothing is dropped silently, every error names its place."""

import math
import re
import string
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import scipy.io
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st
from tirelab.recordings.formats import careful, delimited
from tirelab.recordings.formats.layout import find_layout
from tirelab.recordings.formats.table import Wanted
from tirelab.recordings.recording import Recording, RecordingError, read_recording

HEADER = "time [s],deflection [cm],radius [cm],force [N]"
ROWS = 40
CHANNELS = ("time", "deflection", "radius", "force")

# One file is enough for all examples of a test: each overwrites it.
dirty = settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])

WORDS_WITH_A_MEANING = {"na", "null", "none", "flat", "infinite", "∞", "sep"}
WORDS_WITH_A_MEANING |= {"nil", "ol", "ovl", "ovld", "ofl", "err", "error", "invalid", "overload", "overflow"}


def means_nothing(text: str) -> bool:
    """Whether a text is neither a number to Python nor one of the words that a cell may hold."""
    try:
        float(text)
    except ValueError:
        return text.strip().lower() not in WORDS_WITH_A_MEANING
    return not text.isascii() or "_" in text


not_numbers = st.one_of(
    st.sampled_from(
        ["oops", "1.2.3", "1_000", "0x1F", "--1", "1e", "=1+1", "12 N", "true", "#DIV/0!", "\u0661"]
    ),
    st.text(st.characters(categories=["Lu", "Ll", "So", "Sm"]), min_size=1, max_size=8),
).filter(means_nothing)
LEFT_OUT = ["-", "---", "#NV", "<NA>", "OVERLOAD", "OL", "Err"]
blanks = st.sampled_from(["", " ", "nan", "NaN", "NA", "n/a", "#N/A", "null", "None", '""', *LEFT_OUT])


def clean_rows() -> list[list[str]]:
    """A triangle on the flat law, row by row, as text."""
    x = 2.5 * (1.0 - np.abs(np.linspace(-1.0, 1.0, ROWS)))
    return [[f"{i / 5:.1f}", f"{x[i]:.5f}", "inf", f"{550.9 * x[i] ** 1.422:.3f}"] for i in range(ROWS)]


def as_text(rows: list[list[str]]) -> str:
    return "\n".join([HEADER, *(",".join(row) for row in rows)]) + "\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "dirty.csv"


def outcome(path: Path, **options: Any) -> Recording | str:
    """The recording, or the one sentence that refuses it; anything else raised fails the test."""
    try:
        return read_recording(path, **options)
    except RecordingError as error:
        said = str(error)
    assert "\n" not in said
    assert path.name in said
    return said


def said_of_rows(notes: tuple[str, ...]) -> set[int]:
    """The rows that notes name as skipped."""
    skipped = [note for note in notes if note.startswith("skipped")]
    return {int(number) for note in skipped for number in re.findall(r"row (\d+)", note)}


@dirty
@given(
    st.dictionaries(st.integers(0, ROWS - 1), st.tuples(st.sampled_from([0, 1, 2, 3]), blanks), max_size=4)
)
def test_blank_cells_cost_their_row_and_are_named(path: Path, spoiled: dict[int, tuple[int, str]]) -> None:
    rows = clean_rows()
    for row, (column, blank) in spoiled.items():
        rows[row][column] = blank
    path.write_text(as_text(rows), encoding="utf-8")
    recording = outcome(path)
    assert isinstance(recording, Recording)
    kept = [row for i, row in enumerate(rows) if i not in spoiled]
    np.testing.assert_array_equal(recording.time, [float(row[0]) for row in kept])
    np.testing.assert_array_equal(recording.force, [float(row[3]) for row in kept])
    # Row 1 of the file is the header.
    assert said_of_rows(recording.notes) == {row + 2 for row in spoiled}


@dirty
@given(st.integers(0, ROWS - 1), st.sampled_from([0, 1, 2, 3]), not_numbers)
def test_text_among_the_numbers_is_named_by_row_column_and_value(
    path: Path, row: int, column: int, text: str
) -> None:
    assume((row, column) != (ROWS - 1, 0))  # there it may be a line of statistics, see below
    rows = clean_rows()
    rows[row][column] = text
    path.write_text(as_text(rows), encoding="utf-8")
    said = outcome(path)
    assert isinstance(said, str)
    assert f"row {row + 2}, column {HEADER.split(',')[column]!r}" in said
    assert "is not a number" in said


@dirty
@given(not_numbers)
def test_text_before_the_numbers_of_the_last_row_is_said(path: Path, text: str) -> None:
    """As a line of statistics below the table, which is left out, or refused as any other row."""
    rows = clean_rows()
    rows[-1][0] = text
    path.write_text(as_text(rows), encoding="utf-8")
    found = outcome(path)
    if isinstance(found, str):
        assert f"row {ROWS + 1}, column 'time [s]'" in found
    else:
        assert len(found) == ROWS - 1
        assert [note for note in found.notes if f"row {ROWS + 1} (" in note]


@dirty
@given(st.integers(1, ROWS - 1), st.integers(0, ROWS - 2))
def test_time_out_of_order_is_named_by_its_row(path: Path, late: int, earlier: int) -> None:
    assume(earlier < late)
    rows = clean_rows()
    rows[late][0] = rows[earlier][0]
    path.write_text(as_text(rows), encoding="utf-8")
    said = outcome(path)
    assert isinstance(said, str)
    assert f"row {late + 2}, column 'time [s]': time " in said


@dirty
@given(
    st.lists(
        st.sampled_from(["", ",,,", "# a, b, c, d, e, f", "  ", "0.05,,,", "\t"]), min_size=1, max_size=4
    ),
    st.integers(0, ROWS - 1),
)
def test_lines_between_the_rows_take_nothing_with_them(path: Path, between: list[str], place: int) -> None:
    lines = as_text(clean_rows()).splitlines()
    # Unlike the header, lines before the first row belong to the body.
    lines[place + 1 : place + 1] = between
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    recording = outcome(path)
    assert isinstance(recording, Recording)
    assert len(recording) == ROWS
    comments = [i + place + 2 for i, line in enumerate(between) if line.startswith("#")]
    others = {i + place + 2 for i, line in enumerate(between) if not line.startswith("#")}
    assert said_of_rows(recording.notes) == others
    for line in comments:
        assert any(note.startswith("comment lines") and str(line) in note for note in recording.notes)


@dirty
@given(
    st.sampled_from([",", ";", "\t"]),
    st.booleans(),
    st.sampled_from(["\n", "\r\n", "\r"]),
    st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1", "utf-32"]),
    st.booleans(),
    st.sampled_from(["", "\n", "\n\n", "\n# end\n"]),
)
def test_every_dialect_reads_the_same(
    path: Path, separator: str, comma: bool, end: str, encoding: str, quoted: bool, tail: str
) -> None:
    assume(separator != "," or not comma)
    rows = [HEADER.split(","), *clean_rows()]
    if comma:
        rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    if quoted:
        rows = [[f'"{cell}"' for cell in row] for row in rows]
    text = "\n".join(separator.join(row) for row in rows) + tail
    path.write_bytes(text.replace("\n", end).encode(encoding))
    recording = outcome(path)
    assert isinstance(recording, Recording)
    np.testing.assert_array_equal(recording.time, [float(row[0]) for row in clean_rows()])
    np.testing.assert_array_equal(recording.force, [float(row[3]) for row in clean_rows()])


number_like = st.one_of(
    st.floats(width=64).map(repr),
    st.floats(allow_nan=False, allow_infinity=False).map(lambda value: f"{value:.17e}"),
    st.integers(-(10**30), 10**30).map(str),
    st.text("0123456789.eE+-, \"';#_naifNIFx", max_size=12),
    st.text(max_size=6),
)


@settings(dirty, max_examples=200)
@given(st.lists(st.tuples(number_like, number_like), min_size=1, max_size=6), st.sampled_from([",", ";"]))
@example([("1.5", "2"), ("-nan", "+inf")], ",")
@example([("1", '"\n"'), ('"', '"')], ",")
@example([("0,5", "1.5")], ";")
def test_reading_by_columns_and_by_rows_agree(
    path: Path, cells: list[tuple[str, str]], separator: str
) -> None:
    """Two parsers, polars and the csv module with float(): they read the same, bit by bit."""
    text = f"a [s]{separator}b [cm]\n" + "".join(f"{x}{separator}{y}\n" for x, y in [("0.5", "1"), *cells])
    path.write_text(text, encoding="utf-8", errors="replace")
    wanted = [Wanted(0, "time"), Wanted(1, "radius")]
    try:
        layout = find_layout(path)
        whole = careful.RowReader(path, layout, wanted)
        rows = whole.read_file()
        whole.cells.decimal_mark()
        by_rows: Any = (rows.values, [f"row {line}" for line in rows.lines])
    except RecordingError as error:
        by_rows = str(error)
    try:
        table = delimited.DelimitedTable(path)
        columns = table.read(wanted)
        by_columns: Any = (columns.values, [columns.place(i) for i in range(len(columns.values[0]))])
    except RecordingError as error:
        by_columns = str(error)
    if isinstance(by_rows, str):
        assert by_columns == by_rows
        return
    # Empty lines at the very end are rows of nothing to one, and nothing to the other.
    filled = len(by_columns[1])
    assert by_columns[1] == by_rows[1][:filled]
    for fast, slow in zip(by_columns[0], by_rows[0], strict=True):
        np.testing.assert_array_equal(fast, slow[:filled])
        assert np.all(np.isnan(slow[filled:]))


@dirty
@given(st.binary(max_size=400), st.sampled_from([".csv", ".tsv", ".txt"]))
@example(b"\xff\xfe", ".csv")
@example(b"\xef\xbb\xbf", ".csv")
@example(b"\xff\xfe\x00\x00", ".csv")
@example(b'"', ".csv")
@example(b"sep=,", ".csv")
def test_any_bytes_called_text_are_refused_or_read(tmp_path: Path, content: bytes, suffix: str) -> None:
    path = tmp_path / f"dirty{suffix}"
    path.write_bytes(content)
    outcome(path)


@dirty
@given(st.text(string.printable, max_size=300))
def test_any_text_is_refused_or_read(path: Path, content: str) -> None:
    path.write_text(content, encoding="utf-8", newline="")
    outcome(path, radius="flat")
    path.write_text(HEADER + "\n" + content, encoding="utf-8", newline="")
    outcome(path)


@dirty
@given(st.lists(st.text(string.printable, max_size=20), min_size=4, max_size=4))
def test_any_header_is_refused_or_read(path: Path, names: list[str]) -> None:
    rows = [",".join(f'"{name}"' for name in names), *(",".join(row) for row in clean_rows())]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    numbered = {channel: f"#{i + 1}" for i, channel in enumerate(CHANNELS)}
    outcome(path)
    outcome(path, columns=numbered, units={"time": "s", "deflection": "cm", "radius": "cm", "force": "N"})


@dirty
@given(
    st.lists(st.tuples(*[st.floats(width=64) for _ in range(4)]), min_size=1, max_size=12),
    st.sampled_from(["s", "ms", "min"]),
    st.sampled_from(["m", "mm", "in"]),
    st.sampled_from(["N", "kN", "lbf"]),
)
@example([(0.0, 1e308, 1.0, 1e308), (1.0, -1e308, 1.0, -1e308)], "min", "in", "kN")
@example([(-1e308, 0.0, 1e-320, 0.0), (1e308, 5e-324, 1.0, 5e-324)], "s", "mm", "N")
def test_any_numbers_are_refused_or_make_a_sound_recording(
    path: Path, rows: list[tuple[float, ...]], time: str, length: str, force: str
) -> None:
    header = f"time [{time}],deflection [{length}],radius [{length}],force [{force}]"
    path.write_text("\n".join([header, *(",".join(map(repr, row)) for row in rows)]) + "\n", encoding="utf-8")
    recording = outcome(path)
    if isinstance(recording, Recording):
        assert np.all(np.diff(recording.time) > 0.0)
        assert np.all(np.isfinite(recording.deflection) & np.isfinite(recording.force))
        assert np.all(recording.surface_radius != 0.0)
        assert not np.any(np.isnan(recording.surface_radius))


def save_parquet(path: Path, columns: dict[str, np.ndarray]) -> None:
    pl.DataFrame(columns).write_parquet(path)


def save_mat(path: Path, columns: dict[str, np.ndarray]) -> None:
    names = ("time_s", "deflection_mm", "force_N")
    scipy.io.savemat(path, dict(zip(names, columns.values(), strict=True)), do_compression=True)


def save_mdf(path: Path, columns: dict[str, np.ndarray]) -> None:
    asammdf = pytest.importorskip("asammdf")
    time, deflection, force = columns.values()
    with asammdf.MDF(version="4.10") as mdf:
        mdf.append(
            [
                asammdf.Signal(deflection, time, unit="mm", name="deflection"),
                asammdf.Signal(force, time, unit="N", name="force"),
            ]
        )
        mdf.save(path, overwrite=True)


def save_tdms(path: Path, columns: dict[str, np.ndarray]) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([nptdms.ChannelObject("rig", name, values) for name, values in columns.items()])


def save_excel(path: Path, columns: dict[str, np.ndarray]) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(list(columns))
    for row in zip(*(values.tolist() for values in columns.values()), strict=True):
        book.active.append(list(row))
    book.save(path)
    book.close()


def damaged(content: bytes, noise: np.random.Generator) -> Iterator[bytes]:
    """The file cut short, with bytes changed, with a stretch of zeros, and with a stretch left out."""
    size = len(content)
    for _ in range(3):
        yield content[: noise.integers(1, size)]
        changed = np.frombuffer(content, dtype=np.uint8).copy()
        places = noise.integers(0, size, 4)
        changed[places] = noise.integers(0, 256, 4)
        yield changed.tobytes()
        start, length = int(noise.integers(0, size)), int(noise.integers(1, 200))
        yield content[:start] + b"\x00" * length + content[start + length :]
        yield content[:start] + content[start + length :]


@pytest.mark.parametrize(
    ("suffix", "save"),
    [
        (".parquet", save_parquet),
        (".mat", save_mat),
        (".mf4", save_mdf),
        (".tdms", save_tdms),
        (".xlsx", save_excel),
    ],
)
def test_damaged_files_of_every_kind_are_refused_or_read(
    tmp_path: Path, suffix: str, save: Callable[[Path, dict[str, np.ndarray]], None]
) -> None:
    path = tmp_path / f"dirty{suffix}"
    time = np.arange(300) / 100.0
    deflection = 12.5 * (1.0 - np.cos(2.0 * math.pi * time))
    columns = {"time [s]": time, "deflection [mm]": deflection, "force [N]": 80.0 * deflection}
    save(path, columns)
    content = path.read_bytes()
    assert isinstance(outcome(path, radius="flat"), Recording)
    for spoiled in damaged(content, np.random.default_rng(1996)):
        path.write_bytes(spoiled)
        outcome(path, radius="flat")
