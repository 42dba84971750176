"""What a diagnosis delivers, in a reader's words: a corrected tire, or a correction that runs beside a simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Delivered:
    """this: what is corrected, in a sentence ("the tire", "model.fmu"); kind: what is tested, "tire" or "part"
    beside: whether it is a correction beside a simulation
    use, leave: what to do where the correction, or what was there before, is all that is needed
    files: the files that are to be used, each with its title
    """

    this: str
    kind: str
    use: str
    leave: str
    files: tuple[tuple[str, str | None], ...]
    beside: bool = False


def delivered_of(diagnosis: Mapping[str, Any]) -> Delivered:
    """Return what is delivered by a diagnosis: the content of diagnosis.json, with "delivered" on a page of which
    "correction" is something else.
    """
    found = diagnosis.get("delivered") or diagnosis.get("correction")
    if not (isinstance(found, Mapping) and "simulation" in found):
        files = (("Tire", diagnosis.get("tire")), ("FMU", diagnosis.get("corrected_fmu")))
        baseline = diagnosis.get("baseline_tire") or {}
        # one that holds no air is no tire, also where it is loose before a gap and so has one side
        kind = "part" if baseline.get("two_sided") or baseline.get("inflated") is False else "tire"
        return Delivered(
            f"the {kind}", kind, f"Nothing: use this {kind}.", f"Nothing: use the baseline {kind}.", files
        )
    name = found["simulation"] or "your simulation"
    if found["system"] is None:
        use = f"Nothing: add the output additional_force of {found['fmu']} to the force of {name}."
    else:
        use = f"Nothing: use {found['system']}, which couples {name} with {found['fmu']}."
    files = (("Correction FMU", found["fmu"]), ("Coupled system (SSP)", found["system"]))
    return Delivered(name, "part", use, f"Nothing: use {name} as it is.", files, beside=True)
