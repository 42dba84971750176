"""A part of the catalogue for tests that are about something else: a diagnosis then takes a second or two, not ten."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import pytest
from radialtire import CATALOGUE
from tirelab.diagnosis import diagnosis_run
from tirelab.diagnosis.diagnose import catalogue_names, diagnose


def rivals(*names: str) -> tuple[str, ...]:
    """Return the named effects and those that the catalogue says may pass for one of them."""
    near = {other for name in names for other in CATALOGUE[name].imitators}
    return tuple(name for name in catalogue_names() if name in near.union(names))


@contextmanager
def looking_for(*names: str) -> Iterator[None]:
    """Let `tirelab diagnose` find the named effects only: it has no option for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(diagnosis_run, "diagnose", partial(diagnose, catalogue=names))
        yield
