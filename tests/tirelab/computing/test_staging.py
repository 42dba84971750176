"""Files that appear whole or not at all."""

from __future__ import annotations

import errno
import os
import signal
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from tirelab.computing.staging import staged
from tirelab.errors import TirelabError


def test_files_appear_when_all_are_written(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    with staged(out) as folder:
        (folder / "a.txt").write_text("a")
        assert not (out / "a.txt").exists()
        (folder / "b.txt").write_text("b")
    assert sorted(f.name for f in out.iterdir()) == ["a.txt", "b.txt"]


@pytest.mark.parametrize("end", [KeyboardInterrupt, ValueError, SystemExit])
def test_what_is_interrupted_leaves_nothing(tmp_path: Path, end: type[BaseException]) -> None:
    def interrupted() -> None:
        with staged(tmp_path / "deep" / "out") as folder:
            (folder / "a.txt").write_text("half")
            raise end

    with pytest.raises(end):
        interrupted()
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_said(tmp_path: Path) -> None:
    def filled() -> None:
        with staged(tmp_path / "out") as folder:
            (folder / "a.txt").write_text("half")
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(
        TirelabError, match=r"out cannot be written \(No space left on device\); name another"
    ):
        filled()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="there a signal that a program sends itself ends it")
def test_ctrl_c_between_two_files_waits_for_the_second(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace = os.replace

    def replaced(source: Path, target: Path) -> None:
        replace(source, target)
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(os, "replace", replaced)

    def written() -> None:
        with staged(tmp_path / "out") as folder:
            (folder / "a.txt").write_text("a")
            (folder / "b.txt").write_text("b")

    # where the tests run behind a terminal, as with nohup, it is ignored
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            written()
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert sorted(f.name for f in (tmp_path / "out").iterdir()) == ["a.txt", "b.txt"]


@pytest.mark.skipif(sys.platform == "win32", reason="there a signal that a program sends itself ends it")
def test_ctrl_c_that_is_ignored_stays_ignored(tmp_path: Path) -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with staged(tmp_path / "out") as folder:
            (folder / "a.txt").write_text("a")
            os.kill(os.getpid(), signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
    assert (tmp_path / "out" / "a.txt").is_file()


def test_a_thread_writes_without_the_handlers_of_signals(tmp_path: Path) -> None:
    def write() -> None:
        with staged(tmp_path) as folder:
            (folder / "a.txt").write_text("a")

    with ThreadPoolExecutor(1) as threads:
        threads.submit(write).result()
    assert (tmp_path / "a.txt").is_file()


def test_what_stood_there_stays_until_it_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    (tmp_path / "other.txt").write_text("other")
    with staged(tmp_path) as folder:
        (folder / "a.txt").write_text("new")
        assert (tmp_path / "a.txt").read_text() == "old"
    assert {f.name: f.read_text() for f in tmp_path.iterdir()} == {"a.txt": "new", "other.txt": "other"}


def test_a_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with (
        pytest.raises(TirelabError, match="name another folder with --out"),
        staged(tmp_path / "taken" / "out"),
    ):
        pytest.fail("it began to write")


def test_folders_are_moved_file_by_file(tmp_path: Path) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "other.txt").write_text("other")
    with staged(tmp_path) as folder:
        (folder / "deep").mkdir()
        (folder / "deep" / "a.txt").write_text("a")
    assert {f.name for f in (tmp_path / "deep").iterdir()} == {"a.txt", "other.txt"}
    assert [f.name for f in tmp_path.iterdir()] == ["deep"]
