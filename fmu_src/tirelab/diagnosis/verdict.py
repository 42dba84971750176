"""The verdict: the effects that are missing, the confidence, the alternatives and why, and what stays unexplained."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from radialtire import TireModel
from radialtire.tirefile import to_text

from ..errors import TirelabError
from ..estimation.findings import Evidence, NamedEffect, Remainder
from ..names import REFITTED_LAW, UNKNOWN, plain
from ..preprocessing.motion import FloatArray
from ..preprocessing.samples import Recorded
from ..recordings.recording import Recording
from ..report.titles import headline, more_than_noise
from ..simulation.channels import measured_of
from ..simulation.simulate import simulate
from .alternatives import Alternative
from .contradiction import Contradiction
from .discriminating_test import DiscriminatingTest
from .effect_figures import LawChange, effect_size, law_changes, load_of, sketch_of
from .localization import Span, law_corrected
from .outcome import alternative_detail, finite, page_content
from .residual_model import ResidualModel

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..report.loops import Case


SCHEMA = 2
"""Version of the keys of diagnosis.json: all keys of 1 stay and mean what they meant."""


@dataclass(frozen=True)
class NotNamed:
    """A set that reduces the error of the fitted recordings and is not named.

    left, held_out [N]: what its tire leaves of them, and of the data that were held out of this set
    held_out_before [N]: what nothing leaves there; refused: whether the set is worse than that
    """

    names: tuple[str, ...]
    left: float
    held_out: float
    held_out_before: float
    refused: bool


@dataclass(frozen=True)
class FitErrors:
    """Noise and root mean square errors [N]; held_out_by: what was held out (see `acceptance.HeldOut`).

    held_out_noise_free, after_noise_free: held_out_after and after where the tire is given the noise-free deflection
    not_named: where nothing is corrected, what would reduce the error of the fitted recordings
    """

    noise: float
    before: float
    after: float
    held_out_before: float
    held_out_after: float
    held_out_by: str
    held_out_noise_free: float = float("nan")
    after_noise_free: float = float("nan")
    not_named: NotNamed | None = None

    @property
    def left(self) -> float:
        """Error [N] of the tire without that caused by the noise of the deflection reading."""
        return min(error for error in (self.after, self.after_noise_free) if not math.isnan(error))


@dataclass(frozen=True)
class Verdict:
    """The answer of a diagnosis.

    effects: those that the baseline lacks; doubted: further effects of the likeliest fit that are more probably absent,
    and therefore not named; confidence: probability of the verdict, 0 to 1; grounds: the numbers on which it rests
    alternatives: other sets, likeliest first; remainder: what the corrected tire leaves beyond the noise
    unexplained_by: coordinates on which an unexplained remainder depends; residual_models: its regressions over them
    summary: sentences for a reader; not_compared: those of them about samples that were left out; contradiction: the
    recording that contradicts the others, None where none does
    where: places of the misfit before the correction, or of the residual of the refitted law where other effects are
    missing too; fit: errors before and after; tire: the corrected one
    evidence: all fitted sets; test: the one that separates an alternative from the verdict, None where no motion within
    the rig's limits does (the summary then says so)
    compared: number of fitted sets; evaluations: simulations of all recordings in the final fit
    recordings, held_out: those that were fitted and those that were not; baseline: the tire that was corrected
    """

    effects: tuple[NamedEffect, ...]
    doubted: tuple[NamedEffect, ...]
    confidence: float
    grounds: Mapping[str, float]
    alternatives: tuple[Alternative, ...]
    remainder: Remainder
    unexplained_by: tuple[str, ...]
    residual_models: tuple[ResidualModel, ...]
    summary: str
    not_compared: tuple[str, ...]
    where: tuple[Span, ...]
    fit: FitErrors
    tire: TireModel
    evidence: tuple[Evidence, ...]
    test: DiscriminatingTest | None
    compared: int
    evaluations: int
    contradiction: Contradiction | None = None
    recordings: tuple[Recorded, ...] = field(default=(), repr=False, compare=False)
    held_out: tuple[Recorded, ...] = field(default=(), repr=False, compare=False)
    baseline: TireModel = field(default=TireModel(), repr=False, compare=False)

    @property
    def unexplained(self) -> bool:
        """Whether something acts that no effect explains."""
        return bool(self.unexplained_by)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effects, with "unknown" where something stays unexplained."""
        return (*(e.name for e in self.effects), *((UNKNOWN,) if self.unexplained else ()))

    def __repr__(self) -> str:
        fit = self.fit
        left = more_than_noise(fit.left, fit.noise)
        names, changed = [e.name for e in self.effects], [e.name for e in self.effects if e.in_baseline]
        said = headline(names, self.unexplained, False, left, changed).removesuffix(".")
        alternatives = f", {len(self.alternatives)} alternative" if self.alternatives else ""
        return (
            f"Verdict({said!r}, {100.0 * self.confidence:.0f} % sure, {plain(fit.before, 3)} -> "
            f"{plain(fit.after, 3)} N, noise {plain(fit.noise, 3)} "
            f"N{alternatives}{'s' if len(self.alternatives) > 1 else ''})"
        )

    def _repr_html_(self) -> str:
        from ..report.verdict_table import verdict_table  # a notebook alone needs it

        return verdict_table(self.to_dict())

    def to_dict(self) -> dict[str, Any]:
        """Return the content of diagnosis.json: plain values that JSON can hold, None for a number that is not known.

        The errors are those of the simulated tires; the files beside diagnosis.json are None, for none is written. The
        regressions of something unknown are under "corrections", which is absent where nothing is unknown.
        """
        regressed = (
            {"corrections": [c.to_dict() for c in self.residual_models]} if self.residual_models else {}
        )
        return finite(
            {
                "schema": SCHEMA,
                "verdict": {
                    "effects": [self._effect_to_dict(e) for e in self.effects],
                    "doubted": [
                        {"name": e.name, "probability": e.probability, "grounds": dict(e.grounds)}
                        for e in self.doubted
                    ],
                    "confidence": self.confidence,
                    "grounds": dict(self.grounds),
                    "alternatives": [list(r.names) for r in self.alternatives],
                    "alternative_details": [
                        alternative_detail([e.name for e in self.effects], a) for a in self.alternatives
                    ],
                    "unexplained": self.unexplained,
                    "remainder": self.remainder.to_dict(),
                    "summary": self.summary,
                    "not_compared": list(self.not_compared),
                    "contradiction": None if self.contradiction is None else self.contradiction.to_dict(),
                    "separating_test": None if self.test is None else self.test.to_dict(),
                    **regressed,
                },
                "where": [s.to_dict() for s in self.where],
                "fit": {
                    "noise": self.fit.noise,
                    "before": self.fit.before,
                    "after": self.fit.after,
                    "held_out_before": self.fit.held_out_before,
                    "held_out_after": self.fit.held_out_after,
                    "after_noise_free": self.fit.after_noise_free,
                    "held_out_noise_free": self.fit.held_out_noise_free,
                    "load": load_of(self.recordings),
                },
                "held_out_by": self.fit.held_out_by,
                "baseline_tire": json.loads(to_text(self.baseline)),
                "corrected_tire": json.loads(to_text(self.tire)),
                "tire": None,
                "corrected_fmu": None,
                "report": None,
                "data": None,
            }
        )

    def _effect_to_dict(self, effect: NamedEffect) -> dict[str, Any]:
        """Return an entry of `effects` in diagnosis.json."""
        entry = {
            "name": effect.name,
            "parameters": {
                name: {"value": e.value, "std": e.std, "unit": e.unit}
                for name, e in effect.parameters.items()
            },
            "share": effect.share,
            "probability": effect.probability,
            "grounds": dict(effect.grounds),
            "in_baseline": effect.in_baseline,
            "size": effect_size(effect.name, self.tire, self.baseline, self.recordings),
        }
        if effect.name == REFITTED_LAW:
            # A curve has no A and B; those of the power law below it are next to nothing.
            entry["law"] = [] if self.baseline.curve else [change.to_dict() for change in self._law()]
        return entry

    def page_content(self) -> dict[str, Any]:
        """Return what the report shows besides the content of diagnosis.json (see `report.page.write_report`)."""
        return {
            **page_content(self.evidence, self.alternatives, self.residual_models, self.test),
            "tire_before": self.baseline.name,
            "tire_after": self.tire.name,
            "located": self._located(),
            "law_changes": [
                {"radius": c.radius, "deflection": c.deflection.tolist(), "difference": c.difference.tolist()}
                for c in self._law()
            ],
            "sketches": {
                e.name: {
                    "deflection": s.deflection.tolist(),
                    "force": s.force.tolist(),
                    "varied": {parameter: force.tolist() for parameter, force in s.varied.items()},
                }
                for e in self.effects
                if (s := sketch_of(e.name, self.tire, self.recordings)) is not None
            },
        }

    def _law(self) -> tuple[LawChange, ...]:
        """Return the change of the law on every surface; nothing where the law was not refitted."""
        refitted = [e for e in self.effects if e.name == REFITTED_LAW]
        if not refitted:
            return ()
        return law_changes(self.baseline, self.tire, refitted[0].parameters, self.recordings)

    def _located(self) -> list[FloatArray]:
        """Return the residuals [N] in which the places of `where` lie, one array for each recording."""
        before = [r.force - simulate(self.baseline, r) for r in self.recordings]
        named = [e.name for e in self.effects]
        return law_corrected(self.recordings, before, self.baseline, self.tire, named)

    def report(self, path: Path | str) -> None:
        """Write the page that `tirelab diagnose` writes, with the forces of the simulated corrected tire, to `path`.

        Raises TirelabError where the file cannot be written, or the verdict does not carry its recordings.
        """
        from ..report.page import write_report  # matplotlib takes long to import

        fitted, kept = self._recordings(), tuple(map(_recording, self.held_out))
        write_report(
            Path(path),
            {**self.to_dict(), **self.page_content()},
            fitted,
            _forces(self.baseline, fitted),
            _forces(self.tire, fitted),
            held_out=(kept, _forces(self.baseline, kept), _forces(self.tire, kept)) if kept else None,
        )

    def plot_loops(self, axes: Axes | None = None, recording: str | None = None) -> Axes:
        """Draw force over deflection, recorded and simulated before and after the correction, and return the axes.

        axes: to draw on, None for those of a new figure; recording: name of the recording, None for the one with the
        largest error before the correction. Raises TirelabError where no recording has that name.
        """
        from ..report.loops import plot_loops  # matplotlib takes long to import

        cases = self._cases(recording)
        return plot_loops(max(cases, key=lambda c: c.excess), axes)

    def plot_residuals(self, axes: Axes | None = None, over: str = "time") -> Axes:
        """Draw the recorded minus the simulated force, before and after the correction, and return the axes.

        axes: to draw on, None for those of a new figure; over: "time" (every sample), "deflection" or "rate" (means).
        Raises TirelabError for another `over`.
        """
        from ..report.residuals import plot_residuals  # matplotlib takes long to import

        return plot_residuals(self._cases(), self.fit.noise, axes, over)

    def _recordings(self) -> tuple[Recording, ...]:
        if not self.recordings:
            raise TirelabError("this verdict does not carry its recordings; diagnose them again")
        return tuple(map(_recording, self.recordings))

    def _cases(self, name: str | None = None) -> list[Case]:
        """Return the recordings, or the one of that name, with the simulated forces."""
        from ..report.loops import Case  # matplotlib takes long to import

        chosen = [r for r in (*self._recordings(), *map(_recording, self.held_out)) if r.name == name]
        if name is not None and not chosen:
            known = ", ".join(r.name for r in (*self.recordings, *self.held_out))
            raise TirelabError(f"no recording is named {name}; this verdict carries {known}")
        return [
            Case(r, simulate(self.baseline, r), simulate(self.tire, r)) for r in chosen or self._recordings()
        ]


def _recording(recorded: Recorded) -> Recording:
    """Return what was diagnosed as a Recording, which the report and the plots draw."""
    if isinstance(recorded, Recording):
        return recorded
    r = recorded
    plain = Recording(r.name, r.time, r.deflection, r.surface_radius, r.force)
    return replace(plain, **measured_of(r))  # type: ignore[arg-type]


def _forces(tire: TireModel, recordings: Sequence[Recording]) -> list[FloatArray]:
    return [simulate(tire, r) for r in recordings]
