"""The folder of the local page: names from outside are text, never paths."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from tirelab.errors import TirelabError
from tirelab.local_page.store import Store, Upload, clean_name, clean_texts
from tirelab.recordings.metadata import read_sidecar
from tirelab.recordings.recording import read_recording


@pytest.fixture
def store(tmp_path: Path) -> Store:
    made = Store(tmp_path / "desk")
    made.prepare()
    return made


def received(store: Store, name: str, content: bytes) -> Upload:
    return store.keep(store.arrive(name, io.BytesIO(content), len(content)))


def files(store: Store) -> set[str]:
    return {p.relative_to(store.folder).as_posix() for p in store.folder.rglob("*") if p.is_file()}


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("slow.csv", "slow.csv"),
        ("../../etc/passwd.csv", "passwd.csv"),
        ("C:\\rig\\..\\slow.csv", "slow.csv"),
        ("/absolute.csv", "absolute.csv"),
        ("<img src=x onerror=alert(1)>.csv", "<img src=x onerror=alert(1)>.csv"),
        ("a\x00b\nc.csv", "a?b?c.csv"),
        ("", "recording"),
    ],
)
def test_a_name_is_kept_as_text_and_the_file_has_a_number(store: Store, name: str, shown: str) -> None:
    assert clean_name(name) == shown
    if name:
        upload = received(store, name, b"12345")
        assert upload.name == shown
        assert upload.file == store.folder / "uploads" / "0001.csv"
        assert files(store) == {"uploads/0001.csv", "uploads/0001.json", "uploads/0001.toml"}
        assert store.uploads() == [upload]


def test_a_long_name_keeps_its_suffix() -> None:
    shown = clean_name("x" * 500 + ".csv")
    assert len(shown) <= 130
    assert shown.endswith(".csv")


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("page.html", "0001.html"),
        ("noname", "0001"),
        ("x.csv/", "0001"),
        ("x.json", "0001"),
        ("x.toml", "0001"),
        ("a.<b>", "0001"),
        ("a.123", "0001"),
    ],
)
def test_a_suffix_is_kept_where_it_is_a_plain_word_and_none_of_ours(
    store: Store, name: str, file: str
) -> None:
    assert received(store, name, b"12345").file.name == file
    assert files(store) == {f"uploads/{file}", "uploads/0001.json", "uploads/0001.toml"}


def test_what_does_not_arrive_whole_is_not_kept(store: Store) -> None:
    with pytest.raises(TirelabError, match="did not arrive whole"):
        store.arrive("slow.csv", io.BytesIO(b"123"), 5)
    assert files(store) == set()


def test_numbers_go_on_and_a_removed_recording_leaves_nothing(store: Store) -> None:
    first, second = (received(store, f"{n}.csv", b"1") for n in "ab")
    assert (first.number, second.number) == (1, 2)
    store.settings(second, {"force": "#2"}, {}, "")
    store.remove(second)
    assert files(store) == {"uploads/0001.csv", "uploads/0001.json", "uploads/0001.toml"}


def test_a_recording_is_called_by_its_name_wherever_it_is_read(store: Store) -> None:
    table = b"time [s],deflection [m],force [N]\n" + b"".join(
        b"%d,0.0%d,%d\n" % (i, i, 50 * i) for i in range(9)
    )
    names = ['<b>"slow", 2 bar.csv', "fast.csv", "fast.csv"]
    uploads = [received(store, name, table) for name in names]
    store.settings(uploads[2], {}, {}, "flat")
    read = [read_recording(upload.file, radius="flat").name for upload in uploads]
    assert read == ['<b>"slow", 2 bar', "fast", "fast (3)"]


def test_settings_are_the_sidecar_that_the_reader_reads(store: Store) -> None:
    upload = received(store, "slow.csv", b"1")
    odd = 'Load "cell" \\ Ω'
    store.settings(upload, {"force": odd, "deflection": "-#2"}, {"force": "lbf"}, "25.4 cm")
    told = read_sidecar(upload.file)
    assert dict(told.columns) == {"force": odd, "deflection": "-#2"}
    assert dict(told.units) == {"force": "lbf"}
    assert told.radius == "25.4 cm"
    store.settings(upload, {}, {}, "")
    assert read_sidecar(upload.file).columns == {}


@pytest.mark.parametrize(
    "values", [{"mass": "m"}, {"force": 3}, {"force": "a\nb"}, {"force": "x" * 300}, "text", None]
)
def test_settings_that_are_no_short_texts_are_refused(values: object) -> None:
    with pytest.raises(TirelabError, match=r"by channel|short printable"):
        clean_texts(values, ("force",))


@pytest.mark.parametrize(
    "name", ["../../tire.json", "other.txt", "", "report.html/", "..", "diagnosis.json\x00"]
)
def test_only_files_of_a_diagnosis_are_given_out(store: Store, name: str) -> None:
    folder = store.folder / "diagnoses" / "0001"
    folder.mkdir()
    for file in ("diagnosis.json", "other.txt"):
        (folder / file).write_text("{}")
    assert store.result(1, name) is None
    assert store.result(2, "diagnosis.json") is None
    assert store.result(1, "diagnosis.json") == folder / "diagnosis.json"
    assert store.diagnoses() == [(1, folder)]


def test_a_use_is_one_of_three(store: Store) -> None:
    upload = received(store, "slow.csv", b"1")
    store.use(upload, "held-out")
    assert store.upload(1).use == "held-out"
    with pytest.raises(TirelabError, match="a recording is one of"):
        store.use(upload, "../fitted")


def test_a_folder_that_cannot_be_written_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(TirelabError, match="cannot be written"):
        Store(tmp_path / "taken").prepare()
