"""Compiled loops: one for each effect, stored under the content of the physics, and usable without a store."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from radialtire import CATALOGUE, TireModel
from tirelab.simulation import compiled
from tirelab.simulation.simulate import SmoothedMotion, simulate


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache folder, and no loop compiled yet."""
    monkeypatch.setenv("TIRELAB_CACHE", str(tmp_path / "cache"))
    compiled.loop.cache_clear()
    yield tmp_path / "cache"
    compiled.loop.cache_clear()


def shifted(offset: float) -> float:
    """Return what the loop of deflection_offset makes of a deflection of 0.01 m."""
    effect = CATALOGUE["deflection_offset"]
    one, answer = np.full(1, 0.01), np.empty(1)
    compiled.loop("respond_loop", effect.name, effect.respond)(
        one, (one,) * 10, (), (offset,), answer, (False, np.zeros(answer.size))
    )
    return float(answer[0])


def test_a_loop_is_compiled_once_and_stored_under_its_key(store: Path) -> None:
    assert shifted(1e-3) == pytest.approx(0.011, rel=1e-15)
    (folder,) = store.iterdir()
    assert folder.name == compiled._fingerprint()
    assert [path.name for path in folder.glob("*.py")] == ["deflection_offset.py"]
    effect = CATALOGUE["deflection_offset"]
    again = compiled.loop("respond_loop", effect.name, effect.respond)
    assert again is compiled.loop("respond_loop", effect.name, effect.respond)
    assert list(folder.rglob("*.nbi"))


def test_a_store_that_cannot_be_written_costs_only_time(store: Path) -> None:
    store.write_text("a file where the folder should be")
    assert shifted(2e-3) == pytest.approx(0.012, rel=1e-15)
    assert store.is_file()


def test_a_store_without_room_costs_only_time(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "keep", lambda path, content: False)
    assert shifted(3e-3) == pytest.approx(0.013, rel=1e-15)
    assert not list(store.rglob("*.py"))


def test_two_effects_do_not_share_a_loop() -> None:
    one, two = CATALOGUE["force_offset"], CATALOGUE["force_drift"]
    loops = [compiled.loop("respond_loop", e.name, e.respond) for e in (one, two)]
    history = (np.array([0.0, 2.0]), *(np.zeros(2) for _ in range(9)))
    answers = [np.empty(2), np.empty(2)]
    for loop, answer, values in zip(loops, answers, ((5.0,), (5.0, 0.0)), strict=True):
        loop(np.full(2, 100.0), history, (), values, answer, (False, np.zeros(answer.size)))
    # F + F0, and F + d t with t = 0 s and 2 s
    assert answers[0].tolist() == [105.0, 105.0]
    assert answers[1].tolist() == [100.0, 110.0]


def test_what_loops_call_is_compiled_once_for_all_of_them() -> None:
    effect = CATALOGUE["viscous_damping"]
    loops = [compiled.loop(name, effect.name, effect.respond) for name in ("respond_loop", "beside_loop")]
    one, other = ({n: g[n] for n in ("instant", "respond")} for g in (f.py_func.__globals__ for f in loops))
    assert one == other


@pytest.mark.slow
@pytest.mark.parametrize("names", [["deflection_lag", "viscous_damping"], ["series_compliance"]])
def test_an_array_that_may_not_be_written_to_is_no_other_type(store: Path, names: list[str]) -> None:
    """A recording's arrays may not be; those of blocks may. Each type would be compiled once more."""
    tire = TireModel(
        effects=tuple((CATALOGUE[n], tuple(p.start for p in CATALOGUE[n].parameters)) for n in names)
    )
    time = 0.01 * np.arange(50)
    arrays = [time, 0.01 * (1.0 - np.cos(time)), np.full(50, np.inf), np.sin(time), np.cos(time)]
    for writable in (True, False):
        own = [values.copy() for values in arrays]
        for values in own:
            values.setflags(write=writable)
        motion = SmoothedMotion(*own)
        simulate(tire, motion, motion)
        simulate(tire, motion)
    loops = [compiled.loop("respond_loop", n, CATALOGUE[n].respond) for n in names]
    assert [len(loop.signatures) for loop in (*loops, compiled.loop("elastic_loop", "law"))] == [1] * (
        len(names) + 1
    )


def test_the_store_is_named_after_the_content_of_the_physics(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = []
    for content in ("a = 1\n", "a = 2\n", "a = 1\n"):
        (tmp_path / "__init__.py").write_text(content)
        monkeypatch.setattr(compiled.radialtire, "__file__", str(tmp_path / "__init__.py"))
        names.append(compiled._fingerprint.__wrapped__())
    assert names[0] == names[2] != names[1]
