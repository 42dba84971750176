"""tirelab identify: recordings in, a tire out."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from radialtire import write_tire
from radialtire.tirefile import LAWS

from ..errors import TirelabError
from ..names import plain
from ..recordings.reading import Reading
from .options import FILE, SentenceCommand, reading_options
from .output import Output, example, output_options

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress, TaskID

    from ..identification.result import Identification
    from ..recordings.recording import Recording

PART_LAWS = ("constant", "linear", "power", "power_preload", "linear_gap", "power_gap", "piecewise")
"""Laws of `--part` that a tire file holds."""

WIDTH_LEAST = 100
"""Columns that the tables need; a narrower terminal wraps them, a file has room."""


@dataclass(frozen=True)
class _Words:
    """The recordings and how they are read, as words of the commands that are proposed.

    refused: why no diagnosis takes these recordings, "" where one does
    """

    recordings: tuple[str, ...]
    reading: tuple[str, ...]
    refused: str

    def diagnose(self, tire: Path) -> str:
        """Return the command that tells what a tire leaves out of the recordings."""
        return shlex.join(["tirelab", "diagnose", *self.recordings, *self.reading, "--tire", str(tire)])

    def then(self, tire: Path) -> str:
        """Return the end of a sentence that proposes the diagnosis after another command."""
        return "" if self.refused else f", then `{self.diagnose(tire)}`"

    def identify(self, recordings: Sequence[str], part: str, out: Path) -> str:
        """Return the command that identifies one law of a part; recordings: these or pieces of them."""
        options = [*self.reading, "--part", part, "--out", str(out)]
        return shlex.join(["tirelab", "identify", *recordings, *options])


@click.command(
    "identify", cls=SentenceCommand, epilog=example("tirelab identify recordings/*.csv --out tire.json")
)
@click.argument("recordings", metavar="RECORDING...", nargs=-1, required=True, type=FILE)
@output_options("tire.json", "The tire file written.", "FILE")
@click.option(
    "--law",
    type=click.Choice(["auto", *LAWS]),
    default="auto",
    show_default=True,
    help="The form of A(R) and B(R).",
)
@click.option(
    "--part",
    type=click.Choice(["compare", *PART_LAWS]),
    help="For any spring, also one that pulls: compare laws (linear, with gap or preload, power, polynomial, "
    "piecewise, MF-Tyre), and write the tire file of the one named.",
)
@click.option("--name", default="", help="The tire's name.")
@reading_options
def command(recordings: tuple[Path, ...], output: Output, reading: Reading, **options: Any) -> None:
    """Identify the tire that RECORDING..., files or folders of them, show, and say how sure that is.

    Writes the tire file, and beside it FILE.identification.json with uncertainties, intervals and Table 1.
    """
    from rich.console import Console

    from ..computing.staging import staged
    from ..identification.identify import identify
    from ..identification.misfit import diagnosis_refused, misfit_sentence
    from ..recordings.files import recording_files
    from ..recordings.zero import refuse_too_deep

    out, part = output.out, options["part"]
    said, reading = reading, reading.of_part() if part else reading
    if out.is_dir():
        raise TirelabError(f"{out} cannot be written (it is a folder); name a file with --out")
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDTH_LEAST
    files, skipped = recording_files(recordings, reading.columns)
    for file in skipped:
        output.note(str(file))
    with _bars(output.quiet) as bars:
        tasks: dict[str, TaskID] = {}

        def show(what: str, done: int, total: int) -> None:
            if what not in tasks:
                tasks[what] = bars.add_task(what)
                if bars.disable:
                    output.stage(what)
            bars.update(tasks[what], completed=done, total=total or None)

        read = []
        for number, path in enumerate(files):
            show("reading", number, len(files))
            read.append(reading(path))
        show("reading", len(files), len(files))
        if not part:
            refuse_too_deep(read)
        found = None if part else identify(read, law=options["law"], name=options["name"], progress=show)
    for recording in read:
        for note in recording.notes:
            output.note(f"{recording.name}: {note}")
    of_parts = all(_is_said_to_be_a_part(file, said) for file in files)
    if of_parts and not part:
        output.note(
            "the settings say that these are recordings of a part, and this is the law of a tire, that cannot pull: "
            "--part compare compares the laws of parts"
        )
    known = part and of_parts
    as_read, refused = tuple((said if known else reading).words()), diagnosis_refused(read, part=bool(part))
    words = _Words(tuple(map(str, recordings)), as_read, refused)
    if found is None:
        _part(output, console, dict(zip(files, read, strict=True)), (part, options["name"]), words)
        return
    beside = out.parent / f"{out.stem}.identification.json"
    with staged(out.parent) as folder:
        write_tire(found.tire, folder / out.name)
        (folder / beside.name).write_text(found.to_json(), encoding="utf-8")
    further = words.diagnose(out)
    told = misfit_sentence(found.rmse, found.reading_noise, further, refused=words.refused)
    misfit = told if found.misfit else ""
    if output.as_json:
        output.result((), found.to_json())
        if misfit:
            output.note(misfit)
        return
    _print(console, found)
    if misfit:
        console.print(f"- {misfit}", markup=False, soft_wrap=True)
    console.print(f"tire: {out}\nuncertainties: {beside}", soft_wrap=True)


def _part(
    output: Output, console: Console, found: dict[Path, Recording], chosen: tuple[str, str], words: _Words
) -> None:
    """Print what the laws leave of recordings of a part; write the tire file of the law that is chosen.

    chosen: the law, or "compare", and the tire's name
    """
    part, name = chosen
    recordings = list(found.values())
    from ..computing.staging import staged
    from ..identification.misfit import MISFIT, misfit_sentence
    from ..identification.part_laws import fit_laws, reading_noise
    from ..identification.part_tire import (
        CURVE,
        best_writable,
        curve_advice,
        falling,
        held_though_pressed,
        springless,
        tire_of,
    )
    from ..identification.table import law_table

    fits = fit_laws(recordings)
    tire = None if part == "compare" else output.out
    written, named = "", "the law"
    if tire is not None:
        law = next(fit for fit in fits if fit.name == part)
        model = tire_of(law, recordings, name)
        line = next(fit for fit in fits if fit.name == "linear")
        written = springless(law, model) or falling(law, line) or held_though_pressed(model, recordings)
        with staged(tire.parent) as folder:
            write_tire(model, folder / tire.name)
    else:
        best = best_writable(fits, recordings)
        law = next((fit for fit in fits if fit.name == best), None) or min(fits, key=lambda fit: fit.rmse)
        named = f"the law {law.name}"
    noise, diagnosis = reading_noise(recordings), words.diagnose(output.out)
    misfit = misfit_sentence(law.rmse, noise, diagnosis, named, words.refused)
    if tire is not None:
        reason = curve_advice(model, recordings) if misfit else ""
        if reason:
            misfit = f"{reason}: `{words.identify(words.recordings, CURVE, tire)}`{words.then(tire)}"
        misfit = _advice_on_pieces(found, part, tire, words, misfit)
    if output.as_json:
        laws = [fit.to_dict() for fit in fits]
        output.result((), {"laws": laws, "tire": None if tire is None else str(tire)})
        for note in filter(None, (written, misfit)):
            output.note(note)
        return
    console.print(law_table(fits))
    if written:
        console.print(f"- {written}", markup=False, soft_wrap=True)
    if tire is not None:
        if misfit:
            console.print(f"- {misfit}", markup=False, soft_wrap=True)
        console.print(f"tire: {tire}", soft_wrap=True)
    elif best:
        command = words.identify(words.recordings, best, output.out)
        console.print(
            f"- the law that is proposed for a tire file: `{command}`", markup=False, soft_wrap=True
        )
        then = f"{misfit} then" if misfit and not words.refused else misfit
        if advice := _advice_on_pieces(found, best, output.out, words, then):
            console.print(f"- {advice}", markup=False, soft_wrap=True)
        curve = next(fit for fit in fits if fit.name == CURVE)
        if misfit and law.rmse > MISFIT * curve.rmse:
            own = words.identify(words.recordings, CURVE, output.out)
            console.print(
                f"- a curve leaves {plain(curve.rmse, 2)} N, if loading and unloading are alike: `{own}`",
                markup=False,
                soft_wrap=True,
            )


def _advice_on_pieces(found: dict[Path, Recording], part: str, tire: Path, words: _Words, misfit: str) -> str:
    """Return the advice to identify the law from pieces of the recordings where there is one, else that on the misfit,
    "" for none; a law that fits has no first loading that is another one.
    """
    return _advice_on_holds(found, part, tire, words) or (
        misfit and (_advice_on_first_loading(found, part, tire, words) or misfit)
    )


def _advice_on_first_loading(found: dict[Path, Recording], part: str, tire: Path, words: _Words) -> str:
    """Return the advice to identify the law from the first loading, "" where it is not far from the later ones."""
    from ..identification.first_loading import first_loading, recording_of
    from ..identification.lift_off import lifts_off
    from ..identification.part_laws import fit_laws
    from ..identification.part_tire import PRESSED, tire_of
    from ..recordings.pieces import split_piece

    firsts = {path: first for path, r in found.items() if (first := first_loading(r)) is not None}
    if not firsts:
        return ""
    path, first = max(firsts.items(), key=lambda pair: pair[1].above)
    file, piece = split_piece(path)
    own = [f"{file}{piece.part}@{first.begins:.6g}s:{first.ends:.6g}s"]
    told = (
        f"the first loading of {path.name} lies {plain(first.above, 2)} N from the later ones at the same deflection "
        f"(the loop of these is {plain(first.loop, 2)} N wide): the part softens or takes a set, and this law is amid "
        "both"
    )
    loading = [recording_of(first, found[path])]
    part = "power" if part not in PRESSED and lifts_off(found.values()) else part
    try:
        tire_of(next(fit for fit in fit_laws(loading) if fit.name == part), loading, "")
    except TirelabError as refused:
        return f"{told}; the law {part} of the first loading alone is not written: {refused}"
    return f"{told}; identify the first loading, `{words.identify(own, part, tire)}`{words.then(tire)}"


def _advice_on_holds(found: dict[Path, Recording], part: str, tire: Path, words: _Words) -> str:
    """Return the advice to identify the law from the ramps before holds; "" where no recording is nearly all a hold."""
    from ..identification.part_tire import ramp_before_hold, stroke_of
    from ..recordings.formats.table import listed
    from ..recordings.pieces import split_piece

    stroke = stroke_of(list(found.values()))
    ramps = {path: ramp_before_hold(r, stroke) for path, r in found.items()}
    held, pieces = [path.name for path, ramp in ramps.items() if ramp], []
    for path, ramp in ramps.items():
        if ramp is None:
            pieces.append(str(path))
        elif ramp[0] < ramp[1]:
            file, piece = split_piece(path)
            pieces.append(f"{file}{piece.part}@{ramp[0]:.4g}s:{ramp[1]:.4g}s")
    if not held or not pieces:
        return ""
    return (
        f"nearly all of {listed(held)} is a hold, in which the force may relax, and this is its law, of no spring: "
        f"identify the way there, `{words.identify(pieces, part, tire)}`{words.then(tire)}"
    )


def _is_said_to_be_a_part(path: Path, reading: Reading) -> bool:
    """Return whether the settings of a recording say that it is one of a part; then no command has to be told."""
    from ..recordings.metadata import read_sidecar
    from ..recordings.pieces import split_piece

    file, piece = split_piece(path)
    sidecar = read_sidecar(file, reading.settings, piece.trial, piece.sheet)
    return sidecar.overruled({}, {}, reading.radius, None, {}).part


def _bars(quiet: bool) -> Progress:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=quiet or not Console(stderr=True).is_terminal,
    )


def _print(console: Console, found: Identification) -> None:
    from ..identification.table import constant_table, surface_table

    console.print(surface_table(found))
    console.print(constant_table(found))
    console.print(
        f"RMSE of the law over all samples: {plain(found.rmse, 3)} N (two stages: {plain(found.two_stage_rmse, 3)} N)"
    )
    for note in found.notes:
        if note != found.misfit:  # told with the command that looks further
            console.print(f"- {note}", markup=False, soft_wrap=True)
