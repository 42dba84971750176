"""tirelab compare: an FMU replayed on a recording."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click
from radialtire import TireModel, read_tire

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, reading_options
from .output import Output, example, output_options


@click.command(
    "compare", cls=SentenceCommand, epilog=example("tirelab compare ride.csv --fmu dist/BicycleTire.fmu")
)
@click.argument("recording", type=FILE)
@click.option("--fmu", type=FILE, help="The tire as an FMU: native code, use only one that you trust.")
@click.option(
    "--tire", type=FILE, help="The tire as a tire file, instead of an FMU.  [default: the article's tire]"
)
@output_options("out")
@reading_options
def command(recording: Path, fmu: Path | None, tire: Path | None, output: Output, reading: Reading) -> None:
    """Replay a tire's FMU on RECORDING and say how far the forces differ, and where most."""
    from ..computing.staging import staged
    from ..fmu.foreign import tire_inside
    from ..fmu.replay import description_of, replay
    from ..recordings.zero import refuse_far_zeros
    from ..report.comparison import compare, plot

    if fmu is not None and tire is not None:
        raise TirelabError("--fmu and --tire both name a tire; give one of them")
    believed = fmu or (TireModel() if tire is None else read_tire(tire))
    part = isinstance(believed, TireModel) and believed.is_part
    recorded = (reading.of_part() if part else reading)(recording)
    if recorded.far_zero:
        inside = believed if isinstance(believed, TireModel) else tire_inside(believed)
        if inside is not None and not inside.is_part:
            refuse_far_zeros([recorded])
    for note in recorded.notes:
        output.note(note)
    with tempfile.TemporaryDirectory(prefix="tirelab_") as folder:
        if isinstance(believed, TireModel):
            file, against = _packed(believed, Path(folder)), believed.name
        else:
            file, against = believed, str(believed)
            description_of(file)  # a file that is no FMU is refused before anything is said to run
            output.stage(f"{file} is native code: it now runs with your rights")
        output.stage(f"replaying {against} on {recorded.name}")
        result = compare(recorded, replay(file, recorded))
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


def _packed(tire: TireModel, folder: Path) -> Path:
    """Pack a tire for this machine alone: without Python inside, which is faster, where there is a binary for it."""
    import fmpy

    from ..fmu.build import build_fmu
    from ..fmu.native.make import PLATFORMS
    from ..fmu.native.pack import build_native_fmu

    if fmpy.platform in {platform.fmi2 for platform in PLATFORMS}:
        return build_native_fmu(tire, folder).path
    return build_fmu(tire, folder).path
