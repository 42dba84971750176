"""What the diagnosis says of recordings that others made: python examples/real_recordings.py [DIR]

DIR (default ../shared/recordings/real beside this repository) holds the folders below. The data are not part of this
repository; they come from public ones:

afm_creep_brain_gel/
    github.com/AFM-analysis/afmformats, tests/data, commit b55004fa2a5a092c7ed64bba2971e75fe42b6075, and
    example1_creep.txt at commit 85676d0271dec3df10c56a82aef9938bf97125b8; MIT, (c) 2019 Paul Mueller
nanoindent_series_compliance_drift/
    github.com/micromechanics/micromechanics, examples/Hysitron, commit d15824d929d9cb64c35aa70ecb182a20fe9c57bf;
    MIT, (c) 2020 Steffen Brinckmann
mr_damper_sine/
    github.com/labcontrol-data/mr-damper, data, commit e42439f08b227bb08e9923ee2736bedf2f4fe59a
    (Zenodo 10.5281/zenodo.4445334); MIT, (c) 2021 Labcontrol
pneumatic_cylinder_pressure_friction/
    github.com/EvaZillen/3D-printed-pneumatic-actuator, results_pneumatic-actuator/data/friction, commit
    6e0bcb4633bd53b2a8544cdbd497c4c06539afc7; CC0, E. Zillen, H. Vallery, G. Smit

None of them is a tire. A sphere pressed into tissue follows the tire's own law with B = 1.5; the indenter's does with
B = 2. All are diagnosed in metres and newtons as they were read, and every figure is printed in the unit of its
recording. The damper and the piston pull and push: their baseline is a part that is held at both ends, a straight line
through their readings or a preload alone.
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from indentations import indentation, power_law_fit, read_hysitron, recorded
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel
from strokes import (
    gain_per_bar,
    half_loop,
    piston_recordings,
    preloaded,
    signed,
    slope_per_bar,
    smooth_rate,
)
from tirelab.diagnosis.diagnose import diagnose
from tirelab.diagnosis.verdict import Verdict
from tirelab.identification.part_laws import fit_laws
from tirelab.identification.part_tire import tire_of
from tirelab.recordings.recording import Recording
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]

HERE = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Refusal:
    """Effects that these recordings cannot show for certain, and why."""

    names: tuple[str, ...]
    why: str

    def text(self, verdict: Verdict) -> str:
        """Whether the tool claims one of them in every explanation that it offers."""
        sets = [set(verdict.names), *(set(alternative.names) for alternative in verdict.alternatives)]
        claimed = [name for name in self.names if all(name in names for names in sets)]
        if claimed:
            return f"CLAIMS {' and '.join(claimed)}, though {self.why}".replace("_", " ")
        return f"does not claim {' or '.join(self.names)}: {self.why}".replace("_", " ")


@dataclass(frozen=True)
class Finding:
    """What was found in one recording: RMSE on `held_out` samples in `unit`, before and after the correction."""

    title: str
    baseline: str
    verdict: Verdict
    held_out: str
    before: float
    after: float
    noise: float
    unit: str
    evidence: tuple[str, ...]
    refusals: tuple[Refusal, ...] = ()

    def text(self) -> str:
        """The finding in words."""
        v = self.verdict
        found = ", ".join(v.names) or "nothing is missing"
        alternatives = "; or ".join(
            " + ".join(a.names) or "nothing" for a in v.alternatives if not np.isnan(a.probability)
        )
        lines = [
            f"baseline   {self.baseline}",
            f"found      {found} (confidence {100 * v.confidence:.0f} %)".replace("_", " "),
            *([f"           could also be {alternatives}".replace("_", " ")] if alternatives else []),
            *(f"not shown  {line}".replace("_", " ") for line in self.not_shown()),
            *([f"           unknown depends on {', '.join(v.unexplained_by)}"] if v.unexplained else []),
            f"RMSE       {self.before:.3g} -> {self.after:.3g} {self.unit} on {self.held_out}; "
            f"noise {self.noise:.2g} {self.unit}",
            *(f"evidence   {line}" for line in self.evidence),
            *(f"the tool   {refusal.text(v)}" for refusal in self.refusals),
        ]
        wrapped = (
            textwrap.fill(line, 110, initial_indent="  ", subsequent_indent=13 * " ") for line in lines
        )
        return "\n".join([self.title, *wrapped])

    def not_shown(self) -> list[str]:
        """The effects that these recordings cannot show, or their size not, by the reason."""
        reasons: dict[str, list[str]] = {}
        for a in self.verdict.alternatives:
            if np.isnan(a.probability):
                reasons.setdefault(a.reason, []).extend(set(a.names) - set(self.verdict.names))
        return [f"{', '.join(names)}: {why}" for why, names in reasons.items()]


def part(recording: Recording, samples: slice) -> Recording:
    """Some samples of a recording with all its channels."""
    r = recording
    pressure = None if r.pressure is None else r.pressure[samples]
    channels = (r.time, r.deflection, r.surface_radius, r.force)
    return Recording(r.name, *(c[samples] for c in channels), pressure=pressure, timed=r.timed)


def baseline_law(coefficient: float, exponent: float) -> TireModel:
    """A law F = A x^B with A [N/cm^B] whose tested range is not known."""
    return TireModel(PowerLaw(coefficient, exponent), tested_range=None)


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def errors(verdict: Verdict, tire: TireModel, whole: Recording, held_out: slice) -> tuple[float, float]:
    """RMSE [N] of the baseline and of the corrected tire on some samples of a recording, simulated from its start."""
    before, after = (rms((whole.force - simulate(t, whole))[held_out]) for t in (tire, verdict.tire))
    return before, after


def brain(folder: Path) -> Finding:
    """Approach, hold and the first half of the withdrawal fitted; the rest of the withdrawal is not."""
    found = indentation(folder / "force-save-2021.06.30-12.04.16.071.txt")
    r, tire = found.recording, baseline_law(found.coefficient, 1.5)
    fitted = (found.turned + len(r)) // 2
    verdict = diagnose([part(r, slice(0, fitted))], tire)
    before, after = errors(verdict, tire, r, slice(fitted, None))
    return Finding(
        "Sphere in brain tissue (atomic force microscope)",
        "Hertz's law fitted to the approach, B = 1.5",
        verdict,
        "the second half of the withdrawal",
        1e9 * before,
        1e9 * after,
        1e9 * verdict.fit.noise,
        "nN",
        (f"held at constant force for 3 s, the indentation grows by {found.creep:.2f} um: it creeps",),
        (Refusal(("pressure_leak",), "there is no pressure; a law that fades with time is relaxation here"),),
    )


def gel(folder: Path) -> Finding:
    """One curve fitted, another of the same day and cantilever not."""
    first = indentation(folder / "force-save-2021.06.30-13.48.08.425.txt")
    other = indentation(folder / "example1_creep.txt")
    tire = baseline_law(first.coefficient, 1.5)
    verdict = diagnose([first.recording], tire)
    before, after = errors(verdict, tire, other.recording, slice(None))
    return Finding(
        "Sphere in a polymer gel (atomic force microscope)",
        "Hertz's law fitted to the approach, B = 1.5",
        verdict,
        "another curve (example1_creep), whole",
        1e9 * before,
        1e9 * after,
        1e9 * verdict.fit.noise,
        "nN",
        (
            f"held at constant force for 3 s, the indentation grows by {first.creep:.2f} um in this curve and by "
            f"{other.creep:.2f} um in the other",
        ),
    )


def indenter(folder: Path) -> Finding:
    """Loading with every other sample fitted by the exponent it seems to have; the samples between are not."""
    columns, compliance = read_hysitron(folder / "Exp-50mN_0000.hld")
    force, depth, time = columns["Force_µN"], columns["Disp_nm"], columns["Time_s"]
    peak = int(np.argmax(force))
    start = int(np.flatnonzero(force[:peak] < 300.0)[-1])
    loading = slice(start, peak)
    raw = power_law_fit(depth[loading] - depth[start], force[loading])
    own = (depth - compliance * force)[loading]
    corrected = power_law_fit(own - own[0], force[loading])
    a, b, zero = raw
    x = 1e-9 * (depth[loading] - depth[start] - zero)
    tire = baseline_law(1e-6 * a / 1e-7**b, b)
    r = recorded("loading", time[loading], x, 1e-6 * force[loading])
    verdict = diagnose([part(r, slice(0, None, 2))], tire)
    before, after = errors(verdict, tire, r, slice(1, None, 2))
    return Finding(
        "Pyramid in an unnamed specimen (nanoindenter), loading to 50 mN",
        f"the power law that fits the loading, B = {b:.2f}: {100 * before / r.force.max():.2f} % off",
        verdict,
        "the samples between those fitted",
        1e6 * before,
        1e6 * after,
        1e6 * verdict.fit.noise,
        "uN",
        (
            f"the file's header gives the machine {compliance:.5f} nm/uN, {compliance * force[peak]:.0f} nm of the "
            f"{depth[peak]:.0f} nm at the peak",
            f"with that taken off, the exponent is {corrected[1]:.2f}; theory has 2 for a pyramid",
        ),
        (
            Refusal(
                ("series_compliance",),
                "a power law of another exponent follows the loading as well, so no RMSE shows it; the header does",
            ),
        ),
    )


def damper(folder: Path, name: str) -> Finding:
    """The first half of the strokes fitted, the second half not; the baseline is a spring with a preload."""
    columns = {"time": "Tout", "deflection": "dist", "force": "forc"}
    own = signed(folder / f"{name}.mat", columns, {"time": "s", "deflection": "mm", "force": "N"})
    half = len(own) // 2
    fitted = part(own, slice(0, half))
    line = next(fit for fit in fit_laws([fitted]) if fit.name == "linear")
    tire = tire_of(line, [fitted], name)
    verdict = diagnose([fitted], tire)
    before, after = errors(verdict, tire, own, slice(half, None))
    still = int(np.flatnonzero(np.abs(np.diff(own.deflection)) > 1e-6)[0])
    at_rest = own.force[:still].mean()
    return Finding(
        f"Magnetorheological damper ({name}), {own.force.min():.0f} to {own.force.max():.0f} N",
        f"the straight line through the strokes: {line.value('k'):.2g} N/mm with a preload of {tire.preload:.0f} N",
        verdict,
        "the second half of the strokes",
        before,
        after,
        verdict.fit.noise,
        "N",
        (
            f"at rest before the first stroke it already presses with {at_rest:.0f} N: a preload",
            f"in the middle of the stroke the ways in and out are {2 * half_loop(own, 0.45):.0f} N apart: a loop",
        ),
    )


def piston(folder: Path, bar: int) -> Finding:
    """The first half of the strokes is fitted; the baseline is the mean force, without friction."""
    files = piston_recordings(folder)
    own = files[bar]
    half = len(own) // 2
    mean = float(own.force[:half].mean())
    tire = preloaded(mean)
    verdict = diagnose([part(own, slice(0, half))], tire)
    before, after = errors(verdict, tire, own, slice(half, None))
    alone, together = slope_per_bar([own]), slope_per_bar(list(files.values()))
    loops = {p: half_loop(f, 0.15) for p, f in files.items()}
    rate = 1e3 * smooth_rate(own)
    speeds = [float(np.median(np.abs(rate[sign * rate > 3.0]))) for sign in (1.0, -1.0)]
    return Finding(
        f"Pneumatic piston at {bar} bar",
        f"the mean force, {mean:.1f} N",
        verdict,
        "the second half of the strokes",
        before,
        after,
        verdict.fit.noise,
        "N",
        (
            "half the gap between the ways out and in is "
            + ", ".join(f"{loop:.1f} N at {p} bar" for p, loop in loops.items())
            + ": friction that grows with pressure",
            f"the pressure measured swings with the stroke; read as the cause it has {alone:.0f} N/bar in this file, "
            f"and {together:.1f} N/bar over all files: the swing does not make the loop",
        ),
        (
            Refusal(
                ("rate_independent_hysteresis", "viscous_damping"),
                f"each way has one speed, {speeds[0]:.0f} and {speeds[1]:.0f} mm/s: friction looks like viscosity",
            ),
            Refusal(("inflation_pressure",), "at each deflection the pressure was the same every time"),
        ),
    )


def pistons(folder: Path) -> Finding:
    """All four pressures together, of each the first half; the baseline is their mean force, whatever the pressure."""
    files = list(piston_recordings(folder).values())
    fitted, kept = zip(
        *((part(f, slice(0, len(f) // 2)), part(f, slice(len(f) // 2, None))) for f in files), strict=True
    )
    mean = float(np.mean([f.force.mean() for f in fitted]))
    tire = preloaded(mean)
    verdict = diagnose(list(fitted), tire, held_out=list(kept))
    return Finding(
        "Pneumatic piston at 1, 3, 5 and 7 bar",
        f"the mean force of all, {mean:.1f} N, whatever the pressure",
        verdict,
        "the second half of each file",
        verdict.fit.held_out_before,
        verdict.fit.held_out_after,
        verdict.fit.noise,
        "N",
        (
            f"the corrected part gains {gain_per_bar(verdict.tire, files[1]):.1f} N/bar; the means of the files "
            f"{slope_per_bar(files):.1f} N/bar",
        ),
        (Refusal(("pressure_leak", "gas_compression"), "the measured pressure does not show it"),),
    )


def findings(folder: Path) -> Iterator[Finding]:
    """What is found in every recording of the folder."""
    afm, indent, mr, air = (
        folder / name
        for name in (
            "afm_creep_brain_gel",
            "nanoindent_series_compliance_drift",
            "mr_damper_sine",
            "pneumatic_cylinder_pressure_friction",
        )
    )
    cases: list[Callable[[], Finding]] = [lambda: brain(afm), lambda: gel(afm), lambda: indenter(indent)]
    cases += [
        lambda: damper(mr, "ensaio1"),
        lambda: damper(mr, "ensaio4a"),
    ]
    cases += [lambda: piston(air, 1), lambda: piston(air, 7), lambda: pistons(air)]
    return (case() for case in cases)


def main() -> int:
    """Print what is found in the recordings of the folder given."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent / "shared" / "recordings" / "real"
    if not folder.is_dir():
        print(
            f"{folder}: there is no such folder; get the recordings as described at the top of this file",
            file=sys.stderr,
        )
        return 2
    for finding in findings(folder):
        print(finding.text(), end="\n\n", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
