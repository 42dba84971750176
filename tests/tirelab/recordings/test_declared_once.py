"""Which files an effect takes, and which a channel takes: what examples/docs/contributing.md says is counted."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from radialtire import CATALOGUE, CHANNELS
from tirelab.recordings.channels import CHANNELS as RECORDED
from tirelab.recordings.rows import OPTIONAL


def named_in(path: Path, names: set[str]) -> bool:
    """Whether the code of a module has one of these names, docstrings and comments not counted."""
    text = path.read_text(encoding="utf-8")
    if not any(name in text for name in names):
        return False
    tree = ast.parse(text)
    prose = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr)}
    for node in ast.walk(tree):
        said = {getattr(node, field, None) for field in ("id", "attr", "arg", "name", "module")}
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            said.add(node.target.id)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in prose:
            said.add(node.value)
        if said & names:
            return True
    return False


def files_that_name(source: Path, names: set[str]) -> set[str]:
    """The modules of the tool and of what is embedded; the independent rig states its own physics."""
    found = (p for room in ("radialtire", "tirelab") for p in (source / room).rglob("*.py"))
    found = (*found, *source.glob("*.py"))
    return {p.relative_to(source).as_posix() for p in found if named_in(p, names)}


@pytest.fixture
def source(repository: Path) -> Path:
    return repository / "fmu_src"


@pytest.fixture
def page(repository: Path) -> tuple[str, str]:
    """What the page says of an effect, and of one with a channel of its own."""
    text = (repository / "examples" / "docs" / "contributing.md").read_text(encoding="utf-8")
    without, _, own = text.partition("## How many files")[2].partition("An effect with a channel of its own ")
    return without, own.partition("Search, ranking")[0]


def paths_in(text: str) -> set[str]:
    """The modules that a text names, as paths below fmu_src."""
    paths = re.findall(r"`([\w/]+\.py)`", text)
    return {p.removeprefix("fmu_src/") if p.startswith("fmu_src/") else f"tirelab/{p}" for p in paths}


def test_an_effect_takes_its_file_and_a_line(source: Path, page: tuple[str, str]) -> None:
    found = files_that_name(source, {"inflation_pressure", "INFLATION_PRESSURE"})
    assert found == paths_in(page[0])
    assert page[0].lstrip().startswith("an effect takes\n\nAn effect takes two files.")


def test_a_channel_takes_the_files_that_the_page_lists(source: Path, page: tuple[str, str]) -> None:
    (reader,) = (name for name, e in CATALOGUE.items() if e.reads and e.reads.channel == "temperature")
    found = files_that_name(source, {"temperature", "tire_temperature"})
    assert found == paths_in(page[1])
    assert f"radialtire/effects/{reader}.py" in found
    # and the line of the catalogue
    assert page[1].lstrip().startswith("takes twelve.")
    assert len(found) + 1 == 12


def test_the_readers_know_every_channel_that_an_effect_may_read() -> None:
    units = {channel.name: channel.unit for channel in RECORDED}
    assert {channel.name: channel.unit for channel in CHANNELS}.items() <= units.items()
    assert {channel.name for channel in CHANNELS} <= set(OPTIONAL)


def test_a_name_would_be_found(tmp_path: Path) -> None:
    module = tmp_path / "module.py"
    for line in ("a.heat = 1", "def f(heat): ...", "f(heat=1)", 'x = "heat"', "heat: float", "import heat"):
        module.write_text(f'"""heat"""\n{line}\n')
        assert named_in(module, {"heat"}), line
    module.write_text('"""heat"""\n# heat\n')
    assert not named_in(module, {"heat"})
