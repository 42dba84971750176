"""tirelab compare: an FMU replayed on a recording."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from radialtire import TireModel, read_tire

from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, fmu_options, reading_options, simulation_of
from .output import Output, example, output_options

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..fmu.foreign import Simulation
    from ..recordings.recording import Recording


@click.command(
    "compare", cls=SentenceCommand, epilog=example("tirelab compare ride.csv --fmu dist/BicycleTire.fmu")
)
@click.argument("recording", type=FILE)
@click.option(
    "--fmu",
    type=FILE,
    help="The simulation as an FMU, made by any tool: native code, use one that you trust.",
)
@click.option(
    "--tire", type=FILE, help="The tire as a tire file, instead of an FMU.  [default: the article's tire]"
)
@fmu_options
@output_options("out")
@reading_options
def command(recording: Path, output: Output, reading: Reading, **named: Any) -> None:
    """Replay a tire's FMU on RECORDING and say how far the forces differ, and where most."""
    from ..computing.staging import staged
    from ..fmu.foreign import Simulation, tire_inside
    from ..recordings.zero import refuse_far_zeros
    from ..report.comparison import compare, plot

    asked = simulation_of(**named)
    simulation = (
        asked if isinstance(asked, Simulation) else TireModel() if asked is None else read_tire(asked)
    )
    tire = tire_inside(simulation.fmu) if isinstance(simulation, Simulation) else simulation
    part = tire is simulation and tire.is_part
    recorded = (reading.of_part() if part else reading)(recording)
    if tire is not None and not tire.is_part:
        refuse_far_zeros([recorded])
    for note in recorded.notes:
        output.note(note)
    against, force = _replayed(simulation, recorded, output, ours=tire is not None)
    result = compare(recorded, force)
    picture = f"{recorded.name}.compare.png"
    with staged(output.out) as folder:
        plot(result, folder / picture)
    lines = [f"{recorded.name} against {against}", *result.sentences(), f"plot: {output.out / picture}"]
    content = {
        "recording": recorded.name,
        "against": against,
        "samples": len(recorded),
        "rmse": result.rmse,
        "peak": result.peak,
        "at": {
            "time": float(recorded.time[result.at]),
            "deflection": float(recorded.deflection[result.at]),
        },
        "plot": str(output.out / picture),
    }
    output.result(lines, content)


def _replayed(
    simulation: Simulation | TireModel, recorded: Recording, output: Output, *, ours: bool
) -> tuple[str, NDArray[np.float64]]:
    """Return what a simulation is called, and its force [N] at every sample; ours: whether its FMU holds a tire."""
    from ..fmu.foreign import read_foreign
    from ..fmu.foreign_replay import native_code, replay_foreign
    from ..fmu.replay import description_of, replay
    from ..fmu.unpacking import description_in

    if isinstance(simulation, TireModel):
        output.stage(f"replaying {simulation.name} on {recorded.name}")
        with tempfile.TemporaryDirectory(prefix="tirelab_") as folder:
            return simulation.name, replay(_packed(simulation, Path(folder)), recorded)
    file = simulation.fmu
    if ours and not description_in(file, validate=False, again="build it again").fmiVersion.startswith("3"):
        description_of(file)  # a file that is no FMU is refused before anything is said to run
        output.stage(f"{file} is native code: it now runs with your rights")
        output.stage(f"replaying {file} on {recorded.name}")
        return str(file), replay(file, recorded)
    model = read_foreign(simulation)
    for note in model.notes:
        output.note(note)
    output.stage(native_code(model))
    whole = recorded.whole
    force = replay_foreign(model, whole, recorded.name, simulation.timeout, output.stage)
    return str(file), force[len(whole) - len(recorded) :]


def _packed(tire: TireModel, folder: Path) -> Path:
    """Pack a tire for this machine alone: without Python inside, which is faster, where there is a binary for it."""
    import fmpy

    from ..fmu.build import build_fmu
    from ..fmu.native.make import PLATFORMS
    from ..fmu.native.pack import build_native_fmu

    if fmpy.platform in {platform.fmi2 for platform in PLATFORMS}:
        return build_native_fmu(tire, folder).path
    return build_fmu(tire, folder).path
