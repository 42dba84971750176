"""The memory there is: as Linux reports it, half of what is installed elsewhere, and an assumption at last."""

import os
from pathlib import Path

import pytest
from tirelab.recordings.memory import ASSUMED, memory_available, readable_size


def meminfo(monkeypatch: pytest.MonkeyPatch, text: str | None) -> None:
    def read(path: Path, **options: object) -> str:
        if text is None:
            raise FileNotFoundError(2, "No such file", str(path))
        return text

    monkeypatch.setattr(Path, "read_text", read)


def test_what_linux_reports(monkeypatch: pytest.MonkeyPatch) -> None:
    meminfo(monkeypatch, "MemTotal:  16000 kB\nMemFree:  100 kB\nMemAvailable:    8000 kB\n")
    assert memory_available() == 8000 * 1024


@pytest.mark.parametrize("text", [None, "MemTotal:  16000 kB\n"])
def test_half_of_what_is_installed_elsewhere(monkeypatch: pytest.MonkeyPatch, text: str | None) -> None:
    meminfo(monkeypatch, text)
    sizes = {"SC_PHYS_PAGES": 1000, "SC_PAGE_SIZE": 4096}
    monkeypatch.setattr(os, "sysconf", sizes.__getitem__, raising=False)
    assert memory_available() == 1000 * 4096 // 2


def test_an_assumption_where_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(name: str) -> int:
        raise ValueError(name)

    meminfo(monkeypatch, None)
    monkeypatch.setattr(os, "sysconf", unknown, raising=False)
    assert memory_available() == ASSUMED


@pytest.mark.parametrize(
    ("size", "text"),
    [
        (0, "0 B"),
        (999, "999 B"),
        (1000, "1 kB"),
        (2_100_000, "2.1 MB"),
        (2.1e9, "2.1 GB"),
        (3e12, "3e+03 GB"),
    ],
)
def test_sizes_as_people_write_them(size: float, text: str) -> None:
    assert readable_size(size) == text
