"""Cases wider than the rig's own: python tests/benchmarks/worlds.py KIND --seed S --trials N --out DIR

loud      effects 30 to 1000 times the noise: the rig's own trials with a load cell thirty times as quiet
press     the first file of a slow press: one to three triangles at one speed; the baseline is identified from it
foreign   the catalogue's physics in forms that it does not hold: uneven and root dampers, breakaway friction, a stop
          with a loop, a leak through an orifice, softening that heals
outside   what the catalogue lacks altogether

Each case is a folder as `bench_engine.py` reads it.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import concealed
import numpy as np
from concealed import drawing
from concealed.__main__ import trial_seed
from concealed.bench import Bench
from concealed.effects import BY_NAME, Scene
from concealed.effects.damping import LinearDashpot
from concealed.effects.effect import Contact, Effect
from concealed.effects.pressure import OrificeLeak
from concealed.excitation import EXCITATIONS, Reach, _cycles, _polyline
from concealed.measurement import Instrument, drawn_instrument
from concealed.motion import FloatArray, Motion
from concealed.sizing import misfit_size, resized
from concealed.tires import article_tire, believed_table, contact_patch_tire, deviating_tire
from concealed.trial import Record, recorded
from radialtire import TireModel, write_tire
from tirelab.identify.identification import identify
from tirelab.recordings.recording import Recording
from tirelab.validation.baseline import believed_tire

QUIETER = 30.0


@dataclass(frozen=True)
class UnevenDamper(LinearDashpot):
    """c v loading, r c v unloading, as real dampers are."""

    ratio: float = 2.0

    @classmethod
    def drawn(cls, rng: np.random.Generator, scene: Scene) -> UnevenDamper:
        """One and a half to three times stiffer on the way back."""
        return cls(300.0, rng.uniform(1.5, 3.0))

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        v = contact.motion.rate
        return self.strength * np.where(v > 0.0, v, self.ratio * v) * contact.touching


@dataclass(frozen=True)
class RootDamper(LinearDashpot):
    """c v0 sgn(v) (|v| / v0)^(1/2), linear near rest."""

    reference: float = 0.1

    @classmethod
    def drawn(cls, rng: np.random.Generator, scene: Scene) -> RootDamper:
        """At the typical rate."""
        return cls(300.0, scene.typical_rate)

    def parallel(self, contact: Contact) -> FloatArray:
        """Damping force [N]."""
        u = contact.motion.rate / self.reference
        return self.strength * self.reference * u / (np.abs(u) + 0.01) ** 0.5 * contact.touching


@dataclass(frozen=True)
class BreakawayFriction(Effect):
    """Dahl's friction with a peak after each reversal: z (1 + p s/r exp(1 - s/r)), s the way since the reversal."""

    reach: float
    peak: float

    name: ClassVar[str] = "rate_independent_hysteresis"
    unit: ClassVar[str] = "N"
    limit: ClassVar[float] = 1e4

    @classmethod
    def drawn(cls, rng: np.random.Generator, scene: Scene) -> BreakawayFriction:
        """Peaks of a fifth to three fifths."""
        return cls(30.0, scene.deepest * rng.uniform(0.02, 0.08), rng.uniform(0.2, 0.6))

    def parallel(self, contact: Contact) -> FloatArray:
        """Friction [N]."""
        x, z, way, direction = contact.deflection, 0.0, 0.0, 1.0
        found = []
        for step in np.diff(x, prepend=min(0.0, float(x[0]))).tolist():
            if step * direction < 0.0:
                direction, way = -direction, 0.0
            way += abs(step)
            z = direction - (direction - z) * float(np.exp(-abs(step) / self.reach))
            u = way / self.reach
            found.append(z * (1.0 + self.peak * u * float(np.exp(1.0 - u))))
        return self.strength * np.array(found) * contact.touching


@dataclass(frozen=True)
class LoopedStop(Effect):
    """A stop that gives back less than it takes: k u loading, g k u unloading, a smooth knee."""

    onset: float
    back: float

    name: ClassVar[str] = "bottoming"
    unit: ClassVar[str] = "N/m"
    limit: ClassVar[float] = 1e8

    @classmethod
    def drawn(cls, rng: np.random.Generator, scene: Scene) -> LoopedStop:
        """Reached by a tenth or so of the samples."""
        return cls(1e5, scene.deflection_quantile(rng.uniform(0.8, 0.93)), rng.uniform(0.7, 0.9))

    def parallel(self, contact: Contact) -> FloatArray:
        """Force of the stop [N]."""
        deep = np.maximum(contact.deflection - self.onset, 0.0)
        turning = 0.5 * (1.0 + np.tanh(contact.motion.rate / 2e-3))
        return self.strength * deep * (self.back + (1.0 - self.back) * turning)


@dataclass(frozen=True)
class HealingSoftening(Effect):
    """Softening below the largest deflection, which heals with time: x_max decays towards x."""

    heals: float

    name: ClassVar[str] = "mullins_softening"
    unit: ClassVar[str] = "1"
    limit: ClassVar[float] = 0.6

    @classmethod
    def drawn(cls, rng: np.random.Generator, scene: Scene) -> HealingSoftening:
        """Heals in half to three times the recording."""
        return cls(0.1, scene.longest * rng.uniform(0.5, 3.0))

    def softening(self, contact: Contact) -> FloatArray:
        """Factor on the elastic force."""
        keep, largest, found = float(np.exp(-contact.motion.step / self.heals)), 0.0, []
        for x in np.maximum(contact.deflection, 0.0).tolist():
            largest = max(x, largest * keep)
            found.append((largest - x) / max(largest, 1e-9))
        return 1.0 - self.strength * -np.expm1(-5.0 * np.array(found))


FOREIGN = {
    UnevenDamper: ("many_rates_triangle", "sweep", "multisine", "ride"),
    RootDamper: ("many_rates_triangle", "sweep", "multisine", "ride"),
    BreakawayFriction: ("many_rates_triangle", "ride", "multisine", "growing_triangle"),
    LoopedStop: ("article_triangle", "growing_triangle", "ride", "hits"),
    OrificeLeak: ("article_triangle", "growing_triangle", "many_rates_triangle"),
    HealingSoftening: ("growing_triangle", "article_triangle", "many_rates_triangle"),
}

FIRST_FILES = (
    *6 * ("rate_independent_hysteresis",),
    *2 * ("viscoelastic_relaxation", "mullins_softening", "series_compliance", ""),
    "viscous_damping",
    "bottoming",
    "deflection_offset",
)


def loud(seed: int, out: Path) -> None:
    """Write a loud trial of the rig."""
    drawing.SIZES = (QUIETER, 1000.0)  # type: ignore[misc]
    drawing.drawn_instrument = lambda rng: _quiet(drawn_instrument(rng))
    kinds = ("single", "masked", "pair", "single")
    trial = concealed.draw(seed, kind=kinds[seed % 4])
    concealed.write(trial, out)
    write_tire(believed_tire(concealed.believed(trial)), out / "tire.json")
    floors = [(f.samples, f.floor_rmse) for name, f in trial.answer.files.items() if name.startswith("train")]
    sizes = {name: size.raw for name, size in trial.answer.sizes.items()}
    _key(out, [list(r) for r in trial.answer.right], floors, trial.answer.kind, sizes)


def outside(seed: int, out: Path) -> None:
    """Write an open trial of the rig."""
    trial = concealed.draw(seed, kind="open")
    concealed.write(trial, out)
    write_tire(believed_tire(concealed.believed(trial)), out / "tire.json")
    floors = [(f.samples, f.floor_rmse) for name, f in trial.answer.files.items() if name.startswith("train")]
    right = [[n for n in r if n != "unknown"] + ["unknown"] for r in trial.answer.right]
    _key(out, right, floors, next(iter(trial.answer.hidden)), {})


def foreign(seed: int, out: Path) -> None:
    """Write a trial with one effect in a foreign form, 5 to 300 times the noise."""
    rng = np.random.default_rng(seed)
    form = list(FOREIGN)[int(rng.integers(len(FOREIGN)))]
    for _ in range(20):
        tire = article_tire() if rng.random() < 0.5 else deviating_tire(rng)
        surfaces = (np.inf,) if rng.random() < 0.7 else (np.inf, 0.127)
        reach = Reach(surfaces, tuple(0.02 + 0.008 * rng.random() for _ in surfaces))
        names = [str(rng.choice(FOREIGN[form])) for _ in range(1 + int(rng.random() < 0.5))]
        train = tuple(EXCITATIONS[n](rng, reach.scaled(rng.uniform(0.92, 1.0))) for n in names)
        others = tuple(EXCITATIONS[n](rng, reach.scaled(0.85)) for n in (str(rng.choice(FOREIGN[form])),))
        instrument = _louder(drawn_instrument(rng), 1.0 / float(np.exp(rng.uniform(0.0, np.log(20.0)))))
        wanted = float(np.exp(rng.uniform(np.log(5.0), np.log(300.0))))
        bench = _bench(form.drawn, rng, tire, train, instrument, wanted)
        if bench is not None:
            break
    else:
        raise RuntimeError(f"seed {seed} gave no trial")
    name = bench.effects[0].name
    baseline = believed_tire(_table(tire, reach))
    _write(out, bench, instrument, train, others, rng, baseline, [[name]], form.__name__)


def press(seed: int, out: Path) -> None:
    """Write the first recording of a slow press."""
    rng = np.random.default_rng(seed)
    for _ in range(40):
        tire = contact_patch_tire(rng) if rng.random() < 0.3 else deviating_tire(rng)
        surface = np.inf if rng.random() < 0.7 else float(rng.choice((0.0254, 0.127)))
        deep = rng.uniform(0.014, 0.026)
        speed = float(np.exp(rng.uniform(np.log(0.2e-3), np.log(5e-3))))
        motion = _triangles(rng, surface, deep, speed, int(rng.integers(1, 4)))
        other = _triangles(rng, surface, 0.9 * deep, speed, 2)
        noise = rng.uniform(1.0, 6.0)
        gauge = rng.uniform(2e-6, 12e-6)
        instrument = Instrument(white=noise, quantum=float(rng.choice((0.0, 0.5, 1.0))), gauge=gauge)
        name = str(rng.choice(FIRST_FILES))
        bench: Bench | None = Bench(tire)
        if name:
            form = BY_NAME[name][int(rng.integers(len(BY_NAME[name])))]
            wanted = float(np.exp(rng.uniform(np.log(2.0), np.log(30.0))))
            bench = _bench(form.drawn, rng, tire, (motion,), instrument, wanted)
        if bench is not None:
            break
    else:
        raise RuntimeError(f"seed {seed} gave no trial")
    right = [[name] if name else ["none"]]
    right.append([*([name] if name else []), "recalibration"])
    if name in ("series_compliance", "deflection_offset", "bottoming"):
        right += [["none"], ["recalibration"]]  # the identified law has taken it up
    made, _ = recorded(bench, instrument, motion, "train_0.csv", np.random.default_rng(seed + 1))
    baseline = identify([_as_recording(made)]).tire
    _write(
        out,
        bench,
        instrument,
        (motion,),
        (other,),
        np.random.default_rng(seed + 1),
        baseline,
        right,
        name or "none",
    )


def _triangles(rng: np.random.Generator, surface: float, deep: float, speed: float, cycles: int) -> Motion:
    period = 2.0 * deep / speed
    knots = [_cycles(deep, period, cycles)]
    rate = float(rng.choice((5.0, 10.0, 20.0, 50.0, 100.0)))
    duration = period * cycles
    rate = min(max(rate, 400.0 / duration), 16000.0 / duration)
    return _polyline("press", knots, (surface,), 1.0 / rate, 0.02 * period)


def _bench(drawn, rng, tire, motions, instrument, wanted):  # type: ignore[no-untyped-def]
    bare = Bench(tire)
    scene = Scene(motions, tuple(bare.force(m) for m in motions), tire, instrument.noise)
    effect = drawn(rng, scene)
    effect = resized(Bench(tire, (effect,)), effect, motions, instrument.noise, wanted)
    bench = Bench(tire, (effect,))
    added = [m.recorded(bench.force(m) - bare.force(m)) for m in motions]
    size = misfit_size(bench, motions, added, instrument.noise)
    # Not more than a third of the tire's own force: beyond it the tire is another one.
    elastic = float(np.sqrt(np.mean(np.concatenate([m.recorded(bare.force(m)) for m in motions]) ** 2)))
    good = (
        size.raw > 0.5 * wanted and size.beyond_shape > 1.0 and size.raw * instrument.noise < 0.35 * elastic
    )
    return bench if good else None


def _quiet(instrument: Instrument) -> Instrument:
    return _louder(instrument, 1.0 / QUIETER)


def _louder(i: Instrument, factor: float) -> Instrument:
    return replace(
        i,
        white=i.white * factor,
        drifting=i.drifting * factor,
        pink=i.pink * factor,
        hum=i.hum * factor,
        quantum=i.quantum * factor,
        gauge=i.gauge * factor,
    )


def _table(tire, reach: Reach) -> dict[str, object]:  # type: ignore[no-untyped-def]
    own = believed_table(tire, reach.deepest, reach.surfaces)
    rows = [
        {"radius [cm]": "inf" if np.isinf(r) else 100.0 * r, "A": own.at(r).a, "B": own.at(r).b}
        for r in reach.surfaces
    ]
    return {"law": "table", "surfaces": rows}


def _as_recording(r: Record) -> Recording:
    return Recording(r.name, r.time, r.deflection, r.radius, r.force)


def _write(out, bench, instrument, train, others, rng, baseline: TireModel, right, kind) -> None:  # type: ignore[no-untyped-def]
    out.mkdir(parents=True, exist_ok=True)
    floors = []
    for label, motions in (("train", train), ("heldout", others)):
        for i, motion in enumerate(motions):
            made, (floor, _) = recorded(bench, instrument, motion, f"{label}_{i}.csv", rng)
            table = np.column_stack([made.time, 100.0 * made.deflection, 100.0 * made.radius, made.force])
            head = "time [s],deflection [cm],radius [cm],force [N]"
            np.savetxt(
                out / made.name,
                table,
                fmt=("%.6f", "%.6f", "%.6g", "%.5f"),
                delimiter=",",
                header=head,
                comments="",
            )
            if label == "train":
                floors.append((made.time.size, floor))
    write_tire(baseline, out / "tire.json")
    _key(out, right, floors, kind, {})


def _key(
    out: Path, right: list[list[str]], floors: list[tuple[int, float]], kind: str, sizes: dict[str, float]
) -> None:
    noise = float(np.sqrt(sum(n * f**2 for n, f in floors) / sum(n for n, _ in floors)))
    (out / "key.json").write_text(
        json.dumps({"right": right, "noise": noise, "kind": kind, "sizes": sizes}) + "\n"
    )


def main() -> None:
    """Write the cases of a kind."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    kinds = {"loud": loud, "press": press, "foreign": foreign, "outside": outside}
    parser.add_argument("kind", choices=kinds)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--trials", type=int, required=True)
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    for number in range(given.trials):
        folder = given.out / f"{given.kind}_{given.seed}_{number:03d}"
        if not (folder / "key.json").exists():
            kinds[given.kind](trial_seed(given.seed, number), folder)


if __name__ == "__main__":
    main()
