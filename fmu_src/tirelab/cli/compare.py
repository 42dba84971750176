"""tirelab compare: an FMU replayed on a recording."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click
from radialtire import TireModel, read_tire

from ..errors import TirelabError
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, out_option, reading_options


@click.command("compare", cls=SentenceCommand)
@click.argument("recording", type=FILE)
@click.option("--fmu", type=FILE, help="The tire as an FMU: native code, use only one that you trust.")
@click.option(
    "--tire", type=FILE, help="The tire as a tire file, instead of an FMU.  [default: the article's tire]"
)
@out_option("out")
@reading_options
def command(recording: Path, fmu: Path | None, tire: Path | None, out: Path, reading: Reading) -> None:
    """Replay a tire's FMU on RECORDING and say how far the forces differ, and where most."""
    from ..fmu.build import build_fmu
    from ..fmu.replay import replay
    from ..report.comparison import compare, plot

    if fmu is not None and tire is not None:
        raise TirelabError("--fmu and --tire both name a tire; give one of them")
    recorded = reading(recording)
    for note in recorded.notes:
        click.echo(f"note: {note}")
    with tempfile.TemporaryDirectory(prefix="tirelab_") as folder:
        if fmu is None:
            model = TireModel() if tire is None else read_tire(tire)
            fmu = build_fmu(model, Path(folder)).path
            click.echo(f"{recorded.name} against {model.name}")
        else:
            click.echo(f"{recorded.name} against {fmu}")
        result = compare(recorded, replay(fmu, recorded))
    for sentence in result.sentences():
        click.echo(sentence)
    picture = out / f"{recorded.name}.compare.png"
    try:
        out.mkdir(parents=True, exist_ok=True)
        plot(result, picture)
    except OSError as error:
        raise TirelabError(
            f"{picture} cannot be written ({error.strerror}); name another with --out"
        ) from None
    click.echo(f"plot: {picture}")
