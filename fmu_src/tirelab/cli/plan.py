"""tirelab plan: what to record, before any test or after a diagnosis."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click
from radialtire import TireModel, read_tire

from ..errors import TirelabError
from ..names import in_seconds, plain
from .option_group import option_group
from .options import FILE, SentenceCommand, check_files
from .output import Output, example, output_options, progress

if TYPE_CHECKING:
    from ..planning.plan import RecordingPlan

WIDTH = 110
"""Width of the table where the output is no terminal."""

PLAN = "plan.json"


@dataclass(frozen=True)
class RigOptions:
    """The limits of the rig as they are typed, over those of a rig.toml."""

    rig: Path | None
    stroke: str | None
    speed: str | None
    surfaces: str | None
    pressures: str | None
    time: str | None
    sampling: str | None
    noise: str | None
    force: str | None


def _share(context: click.Context, parameter: click.Parameter, text: str) -> float:
    try:
        value = float(text.strip().removesuffix("%")) / 100.0
    except ValueError:
        value = 0.0
    if not text.strip().endswith("%") or not 0.0 < value <= 1.0:
        raise click.BadParameter(f"{text!r} is no part of the peak force; write for instance 2%")
    return value


@click.command(
    "plan",
    cls=SentenceCommand,
    epilog=example(
        "tirelab plan --stroke 20mm --speed 100mm/s --surfaces flat,25.4cm --time 5min --noise 5N --out plan",
        "tirelab plan --rig rig.toml --from diagnosis --out next",
    ),
)
@option_group(
    "limits",
    RigOptions,
    click.option("--rig", type=FILE, help="TOML file with the limits below; an option goes over it."),
    click.option("--stroke", metavar="LENGTH", help="Largest deflection.  [default: 20mm]"),
    click.option("--speed", metavar="SPEED", help="Fastest motion.  [default: 100mm/s]"),
    click.option("--surfaces", metavar="R,...", help="Surfaces: flat,25.4cm,-50.8cm.  [default: flat]"),
    click.option("--pressures", metavar="P,...", help="Pressures that can be held: 2bar,3bar."),
    click.option("--time", metavar="TIME", help="Of driving, all recordings together.  [default: 5min]"),
    click.option("--sampling", metavar="RATE", help="Samples of force and deflection.  [default: 200Hz]"),
    click.option("--noise", metavar="FORCE", help="Standard deviation of one force sample.  [default: 5N]"),
    click.option("--force", metavar="FORCE", help="Largest that press and load cell take: 2kN."),
)
@click.option(
    "--tire", type=FILE, help="The believed tire.  [default: that of the diagnosis, or the article's]"
)
@click.option(
    "--from",
    "diagnosis",
    type=FILE,
    metavar="DIAGNOSIS",
    help="Tell the verdict of this diagnosis.json, or folder, from its alternatives. Stroke, surfaces and noise are "
    "those recorded if not said.",
)
@click.option(
    "--size",
    default="2%",
    show_default=True,
    callback=_share,
    metavar="PART",
    help="Size of an effect that is to be found: its largest response, of the peak force.",
)
@output_options("plan")
def command(
    limits: RigOptions, tire: Path | None, diagnosis: Path | None, size: float, output: Output
) -> None:
    """Choose the shortest recordings, within a rig's limits, that tell the effects apart.

    Writes a drive file for each (CSV), plan.json and plan.png; says effect by effect with which probability it is
    named, and which effects stay confused.
    """
    check_files(path for path in (limits.rig, tire, diagnosis) if path is not None)
    from ..computing.staging import staged
    from ..planning.follow_up import follow_up, read_diagnosed
    from ..planning.output import write_plan
    from ..planning.plan import plan_recordings
    from ..planning.rig import Rig, read_rig

    typed = asdict(limits)
    diagnosed = None if diagnosis is None else read_diagnosed(diagnosis)
    rig = read_rig(typed.pop("rig"), typed, Rig() if diagnosed is None else diagnosed.rig)
    believed = None if diagnosed is None else diagnosed.tire
    model = read_tire(tire) if tire is not None else believed or TireModel()
    with progress(output.quiet) as show:
        if diagnosed is None:
            plan = plan_recordings(model, rig, size, show)
        else:
            plan = follow_up(diagnosed, model, rig, size, show)
        if not plan.drives:
            raise TirelabError(_nothing(plan))
        show("writing and drawing the plan")
        with staged(output.out) as folder:
            write_plan(plan, folder)
            (folder / PLAN).write_text(json.dumps(plan.to_dict(), indent=2) + "\n", encoding="utf-8")
    output.result(_lines(plan, output.out), plan.to_dict())


def _nothing(plan: RecordingPlan) -> str:
    """Return why there is nothing to record."""
    told, possible, _ = plan.told
    if told and told == possible:
        return (
            f"the recordings tell them apart already where an effect has {100.0 * plan.size:g} % of the peak force; "
            "give a smaller --size to look for less"
        )
    return (
        "no motion within these limits tells any two of them apart; give a larger --stroke, a faster --speed, "
        "more --time or another surface"
    )


def _lines(plan: RecordingPlan, out: Path) -> list[str]:
    from ..planning.plan import SIZES, file_name

    told, possible, asked = plan.told
    rig = plan.rig
    lines = [
        f"{plan.tire}: to {plain(1e3 * rig.stroke, 4)} mm and {plan.peak:.0f} N, at up to {1e3 * rig.speed:g} mm/s, "
        f"{1.0 / rig.sampling:g} Hz, {rig.noise:g} N of noise",
        *([] if math.isinf(rig.force) else [f"the force stays within {plain(rig.force, 4)} N"]),
        f"{len(plan.drives)} recording{'s' if len(plan.drives) > 1 else ''}, {in_seconds(plan.seconds)} s of "
        f"{rig.time:g} s:",
        *(
            f"  {out / file_name(number, drive)}: {in_seconds(drive.duration)} s, "
            f"to {plain(1e3 * drive.fastest, 3)} mm/s"
            for number, drive in enumerate(plan.drives, 1)
        ),
        f"{told} of {asked} pairs are told apart in 19 of 20 tests at {100.0 * plan.size:g} % of the peak force; "
        f"{possible} can be within these limits",
        *_beside(plan),
        "",
        "probability that an effect is named and nothing else, by its largest response over the peak force:",
    ]
    lines += _table(plan, [f"{100.0 * size:g} %" for size in SIZES])
    if plan.silent:
        lines.append(f"no response within these limits: {', '.join(map(_title, plan.silent))}")
    if len(rig.pressures) > 1:
        lines.append(
            "every other effect is told apart beside a gain with the pressure that is not known; each pressure is "
            "driven at least once: record the pressure"
        )
    else:
        from ..planning.responses import HELD

        lines.append(
            f"{_title(HELD.name)}: recordings at two pressures show it, give those that can be held: --pressures "
            "2bar,3bar"
        )
    return [
        *lines,
        f"written: {out / PLAN}, {out / 'plan.png'} and the drive files",
        "drive each file as a recording of its own, rest between them, and diagnose all of them together",
    ]


def _beside(plan: RecordingPlan) -> list[str]:
    """Return the line on effects beside another one, where they were asked for."""
    from ..planning.separation import LOUDER

    told, possible, asked = plan.told_beside
    if not asked:
        return []
    return [
        f"{told} of {asked} are named beside another effect that is {LOUDER:g} times as large; {possible} can be"
    ]


def _table(plan: RecordingPlan, sizes: list[str]) -> list[str]:
    """Return the rows of the table: each effect, with which probability it is named, what it stays confused with."""
    import io

    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="")
    table.add_column("effect")
    for size in sizes:
        table.add_column(size, justify="right")
    table.add_column("stays confused with (*: whatever is driven)")
    for row in plan.rows:
        names = [f"{_title(n)}{'*' if n in row.hopeless else ''}" for n in row.confused]
        table.add_row(_title(row.effect), *(f"{100.0 * p:.0f} %" for p in row.named), ", ".join(names))
    text = io.StringIO()
    Console(file=text, width=WIDTH, color_system=None, markup=False, highlight=False).print(table)
    return [line.rstrip() for line in text.getvalue().splitlines()]


def _title(name: str) -> str:
    from ..report.titles import short_title

    return " + ".join(short_title(part) for part in name.split(" + ")) if name else "nothing"
