"""A part of the catalogue for tests that are about something else: a diagnosis then takes a second or two, not ten."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial

import pytest
from radialtire import CATALOGUE
from tirelab.diagnosis import diagnosis_run, moved_simulation
from tirelab.diagnosis.asked import Asked
from tirelab.diagnosis.diagnose import catalogue_names, diagnose, diagnosed
from tirelab.diagnosis.verdict import Verdict


def rivals(*names: str) -> tuple[str, ...]:
    """Return the named effects and those that the catalogue says may pass for one of them."""
    near = {other for name in names for other in CATALOGUE[name].imitators}
    return tuple(name for name in catalogue_names() if name in near.union(names))


@contextmanager
def looking_for(*names: str) -> Iterator[None]:
    """Let `tirelab diagnose` find the named effects only: it has no option for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(diagnosis_run, "diagnose", partial(diagnose, catalogue=names))
        patch.setattr(moved_simulation, "diagnosed", partial(_diagnosed_of, names))
        yield


def _diagnosed_of(names: tuple[str, ...], asked: Asked) -> Verdict:
    allowed = names if asked.catalogue is None else [name for name in names if name in asked.catalogue]
    return diagnosed(replace(asked, catalogue=allowed))
