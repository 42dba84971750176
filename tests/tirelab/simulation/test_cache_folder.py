"""What is kept between runs is run again, so nobody else may be able to put it there."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

import pytest
from tirelab.simulation.cache_folder import cache_folder, keep, private_folder

pytestmark = pytest.mark.skipif(
    sys.platform == "win32", reason="Windows has no owners and modes of this kind"
)


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The cache's folder, not made yet."""
    monkeypatch.setenv("TIRELAB_CACHE", str(tmp_path / "new" / "cache"))
    return tmp_path / "new" / "cache"


def test_a_new_folder_is_the_users_alone(cache: Path) -> None:
    before = os.umask(0)
    try:
        assert private_folder("part") == cache / "part"
    finally:
        os.umask(before)
    assert [stat.S_IMODE(folder.stat().st_mode) for folder in (cache, cache / "part")] == [0o700, 0o700]


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777])
@pytest.mark.parametrize("part", ["", "part"])
def test_a_folder_that_others_may_write_to_is_not_used(cache: Path, part: str, mode: int) -> None:
    assert private_folder("part") is not None
    (cache / part).chmod(mode)
    assert private_folder("part") is None


def test_a_folder_of_somebody_else_is_not_used(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert private_folder("part") is not None
    user = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: user + 1)
    assert private_folder("part") is None


def test_a_folder_that_cannot_be_made_is_not_used(cache: Path) -> None:
    cache.parent.mkdir()
    cache.write_text("a file")
    assert private_folder("part") is None


def test_a_user_without_a_home_keeps_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("TIRELAB_CACHE", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(sys, "prefix", sys.base_prefix)
    monkeypatch.setattr(Path, "home", nowhere)
    assert private_folder("part") is None


def test_outside_a_virtual_environment_it_is_the_users(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("TIRELAB_CACHE", raising=False)
    monkeypatch.setattr(sys, "prefix", sys.base_prefix)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_folder() == tmp_path / "tirelab"
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    assert cache_folder() == tmp_path / ".cache" / "tirelab"
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "venv"))
    assert cache_folder() == tmp_path / "venv" / "var" / "tirelab"


def test_what_is_kept_is_whole_or_not_there(tmp_path: Path) -> None:
    assert keep(tmp_path / "kept", b"content")
    assert (tmp_path / "kept").read_bytes() == b"content"
    (tmp_path / "folder").mkdir()
    assert not keep(tmp_path / "folder", b"content")
    assert not keep(tmp_path / "absent" / "kept", b"content")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "kept"]
