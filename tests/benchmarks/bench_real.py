"""The engine on recordings that others made: python tests/benchmarks/bench_real.py REAL [--only TEXT] [--given]

REAL holds the folders told in examples/real_recordings.py, programmed_spring_static
(github.com/harrislab-brown/CyberDiver, data/validation, CC BY-SA 4.0) and vhb4910, an acrylic elastomer that is pulled
(github.com/Chongran-Zhao/VHB4910_data, to be cited, no licence told). More files of the same repositories may lie
beside theirs; a folder that is not there is passed over. Dampers, pistons and springs are read as they are; errors of
indentations are printed in nanonewtons. For dampers and pistons, plain least squares on the same fitted samples are
printed too. With --given, the diagnosis is given the held-out samples as such, as `tirelab diagnose --held-out` does.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from radialtire import PowerLaw, TireModel

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples"))
from indentations import indentation, power_law_fit, read_hysitron, recorded
from real_recordings import part
from scipy.optimize import minimize_scalar
from strokes import piston_recording, preloaded, signed
from tirelab.diagnosis.diagnose import diagnose
from tirelab.identification.part_laws import fit_laws
from tirelab.identification.part_tire import tire_of
from tirelab.recordings.recording import Recording, read_recording
from tirelab.simulation.simulate import simulate

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Real:
    """fitted: samples of `whole` that are fitted; kept: held-out ones; unit [N]: of what is printed.

    moving: whether plain least squares of a strut (`strut`) mean something for it
    """

    name: str
    whole: Recording
    fitted: slice
    kept: slice
    tire: TireModel
    unit: float
    reference: str
    moving: bool = False


def law(coefficient: float, exponent: float) -> TireModel:
    """A power law."""
    return TireModel(PowerLaw(coefficient, exponent), tested_range=None)


def damper(folder: Path, name: str, reference: str) -> Real:
    """A damper; the straight line through the fitted half is believed."""
    columns = {"time": "Tout", "deflection": "dist", "force": "forc"}
    own = signed(folder / f"{name}.mat", columns, {"time": "s", "deflection": "mm", "force": "N"})
    half = len(own) // 2
    fitted = part(own, slice(0, half))
    line = next(fit for fit in fit_laws([fitted]) if fit.name == "linear")
    return Real(
        name, own, slice(0, half), slice(half, None), tire_of(line, [fitted], name), 1.0, reference, True
    )


def piston(path: Path, reference: str) -> Real:
    """A piston at constant pressure: its mean force is believed."""
    own = piston_recording(path)
    half = len(own) // 2
    tire = preloaded(float(own.force[:half].mean()))
    return Real(own.name, own, slice(0, half), slice(half, None), tire, 1.0, reference, True)


def springs(path: Path) -> list[Real]:
    """Presses of a body that an actuator makes a spring, side by side in one file, samples without times.

    Believed is the stiffness in the file's name (`15npmm`: 15 N/mm), or where that is a limit of the force
    (`10n_threshold`) the straight line through what the body does below seven tenths of its peak.
    """
    rows = []
    for line in path.read_text(encoding="latin-1").splitlines():
        words = line.replace(";", ",").split(",")
        try:
            rows.append([float(w) if w.strip() else np.nan for w in words])
        except ValueError:
            continue
    width = max(len(r) for r in rows)
    table = np.array([r + [np.nan] * (width - len(r)) for r in rows])
    given = re.search(r"_(\d+)npmm", path.stem)
    found = []
    for trial in range(width // 2):
        x, f = table[:, 2 * trial], table[:, 2 * trial + 1]
        good = np.isfinite(x) & np.isfinite(f)
        x, f = 1e-3 * x[good], f[good]
        x, f = x * np.sign(x[np.argmax(np.abs(x))]), f * np.sign(f[np.argmax(np.abs(f))])
        name = f"{path.stem.removeprefix('static_force_test_')}, {trial + 1}"
        stiffness = 10.0 * float(given[1]) if given else 0.01 * _rise(x, f)
        own = replace(recorded(name, np.arange(x.size, dtype=float), x, f), timed=False)
        whole = slice(0, None)
        reference = "gap + series spring 0.214 / 0.225" if given and given[1] == "15" else ""
        found.append(Real(name, own, whole, whole, law(stiffness, 1.0), 1.0, reference))
    return found


def _rise(x: FloatArray, f: FloatArray) -> float:
    """Return the slope [N/m] of the straight line through the way in, between one and seven tenths of the peak."""
    way_in = np.arange(x.size) < np.argmax(f > 0.9 * f.max())
    rising = way_in & (f > 0.1 * f.max()) & (f < 0.7 * f.max())
    return float(np.polyfit(x[rising], f[rising], 1)[0])


def elastomer(path: Path, slow: Path) -> Real:
    """An elastomer, pulled; the straight line through its slowest loop to the same stretch is believed."""
    own, slowest = (read_recording(p, radius="flat") for p in (path, slow))
    line = next(fit for fit in fit_laws([slowest]) if fit.name == "linear")
    name = f"{'hold' if 'relaxation' in str(path) else 'loop'} {path.stem}"
    whole = slice(0, None)
    return Real(name, own, whole, whole, tire_of(line, [slowest], name), 1.0, "relaxation")


def indented(name: str, path: Path) -> Real:
    """Approach, hold and half the withdrawal of a sphere pressed into a soft body."""
    found = indentation(path)
    half = (found.turned + len(found.recording)) // 2
    fitted, kept = slice(0, half), slice(half, None)
    reference = "relaxation, 0.03 (approach and hold)"
    return Real(name, found.recording, fitted, kept, law(found.coefficient, 1.5), 1e-9, reference)


def indenter(folder: Path) -> Real:
    """Loading of a pyramid with a compliant machine; enlarged, since A at 1 cm would be beyond its bound."""
    columns, _ = read_hysitron(folder / "Exp-50mN_0000.hld")
    force, depth, t = columns["Force_µN"], columns["Disp_nm"], columns["Time_s"]
    peak = int(np.argmax(force))
    start = int(np.flatnonzero(force[:peak] < 300.0)[-1])
    s = slice(start, peak)
    a, b, zero = power_law_fit(depth[s] - depth[start], force[s])
    x = (depth[s] - depth[start] - zero) * 5e-5
    r = recorded("indenter", t[s], x, force[s] * 4e-2)
    return Real(
        "indenter",
        r,
        slice(0, None, 2),
        slice(1, None, 2),
        law(a * 4e-2 / (100.0 * 5e-5) ** b, b),
        4e-2,
        "compliance cannot be shown",
    )


def reals(root: Path) -> Iterator[Callable[[], Real]]:
    """Yield what makes each."""
    mr, air, afm = (
        root / "mr_damper_sine",
        root / "pneumatic_cylinder_pressure_friction",
        root / "afm_creep_brain_gel",
    )
    references = {
        "ensaio.A.1": "preload + Coulomb + viscous 81 / 106",
        "ensaio1": "k, c, Dahl 6.5",
        "ensaio1.2": "k, c, Dahl 18.5",
        "O-ring_1bar": "constant + Coulomb 0.96, + pressure 0.46",
        "O-ring_5bar": "viscous 0.98 / 1.21; Dahl 1.6 / 1.9",
        "O-ring_7bar": "Coulomb 1.83",
    }
    for path in sorted(mr.glob("*.mat")):
        yield lambda p=path: damper(mr, p.stem, references.get(p.stem, ""))  # type: ignore[misc]
    for path in sorted(air.glob("*bar.csv")):
        yield lambda p=path: piston(p, references.get(p.stem, ""))  # type: ignore[misc]
    for path in sorted((root / "programmed_spring_static").glob("*.csv")):
        for i in range(3):
            yield lambda p=path, i=i: springs(p)[i]  # type: ignore[misc]
    acrylic = root / "vhb4910"
    loops = acrylic / "uniaxial-loading-unloading" / "original_data"
    holds = acrylic / "single-step-relaxation" / "original_data"
    for path in (*sorted(loops.glob("*.csv")), *sorted(holds.glob("*.csv"))):
        # Files are named 0d03_1d5_1: strain rate, stretch, repetition; holds by their stretch alone.
        stretch = path.stem if path.parent == holds else path.stem.split("_")[1]
        if (slow := loops / f"0d01_{stretch}.csv") != path and slow.exists():
            yield lambda p=path, slow=slow: elastomer(p, slow)  # type: ignore[misc]
    if afm.exists():
        yield lambda: indented("brain", afm / "force-save-2021.06.30-12.04.16.071.txt")
        yield lambda: indented("gel", afm / "force-save-2021.06.30-13.48.08.425.txt")
    if (nano := root / "nanoindent_series_compliance_drift").exists():
        yield lambda: indenter(nano)


def strut(recording: Recording, fitted: slice) -> FloatArray:
    """Return the residual [N] of F0 + k x + c v + S z by least squares on the fitted samples, z the state of a Dahl
    friction whose reach is searched for between 1e-4 and 1 of the range of the deflection.
    """
    x, force = recording.deflection, recording.force
    step = np.diff(x, prepend=x[0])
    others = [np.ones_like(x), x, np.gradient(x, recording.time)]

    def residual(reach: float) -> FloatArray:
        keep = np.exp(-np.abs(step) / (np.exp(reach) * float(np.ptp(x))))
        state, z = 0.0, np.empty_like(x)
        for i, way in enumerate(np.sign(step)):
            state = way + keep[i] * (state - way)
            z[i] = state
        columns = np.stack([*others, z], axis=1)
        values = np.linalg.lstsq(columns[fitted], force[fitted], rcond=None)[0]
        return np.asarray(force - columns @ values)

    def left(reach: float) -> float:
        return rms(residual(reach)[fitted])

    tried = np.linspace(np.log(1e-4), 0.0, 25)
    best = float(tried[np.argmin([left(reach) for reach in tried])])
    near = (best - tried[1] + tried[0], best + tried[1] - tried[0])
    return residual(float(minimize_scalar(left, bounds=near, method="bounded").x))


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    """Diagnose each."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("root", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--given", action="store_true")
    given = parser.parse_args()
    for make in reals(given.root):
        real = make()
        if given.only not in real.name:
            continue
        w, s = real.whole, real.fitted
        fitted = part(w, s)
        began = time.process_time()
        found = diagnose([fitted], real.tire, held_out=[part(w, real.kept)] if given.given else ())
        seconds = time.process_time() - began
        rows = [
            (rms((w.force - simulate(tire, w))[k]) / real.unit)
            for k in (s, real.kept)
            for tire in (real.tire, found.tire)
        ]
        noise = found.fit.noise / real.unit
        print(
            f"{real.name:12s} {' + '.join(found.names) or 'nothing missing'}, {100.0 * found.confidence:.0f} % sure: "
            f"fitted {rows[0]:.4g} -> {rows[1]:.4g}, held-out {rows[2]:.4g} -> {rows[3]:.4g}, noise {noise:.3g}; "
            f"{seconds:.1f} s   [{real.reference}]"
        )
        if real.moving:
            plain = strut(w, s)
            fit, other = (rms(plain[samples]) / real.unit for samples in (s, real.kept))
            print(
                f"             least squares, F0 + k x + c v + Dahl: fitted {fit:.4g}, held-out {other:.4g}"
            )
        for effect in found.effects:
            print(
                f"             {effect.name}: probability {effect.probability:.2f}, share {effect.share:.3f}"
            )
        others = [" + ".join(a.names) or "nothing" for a in found.alternatives[:6]]
        print(f"             alternatives: {'; '.join(others) or 'none'}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
