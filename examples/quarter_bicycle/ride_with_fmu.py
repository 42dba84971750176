"""The tire FMU under the quarter bicycle, step by step, against the ride integrated as one system.

    python examples/quarter_bicycle/ride_with_fmu.py --ground log --speed 5

builds the FMU of the article's tire (or takes --fmu), asks it once per step with fmpy, and tells for each step and way
of coupling how far the force and the hub's path are from the monolithic integration, and how much energy the coupling
made. The README's tables come from here.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np
from account import Account, account
from coupled import Coupling, SteppedMotion, SteppedTire, run
from fmu_tire import fmu_tire
from model import Motion
from radialtire import TireModel
from rides import GROUNDS, RideOnGround, elastic, elastic_array
from tirelab.errors import TirelabError
from tirelab.fmu.build import build_fmu

COUPLINGS: dict[str, tuple[bool, float | None]] = {
    "one after the other": (False, 0.0),
    "one after the other, with look-ahead": (False, None),
    "side by side": (True, 0.0),
    "side by side, with look-ahead": (True, None),
}
"""How the two may be coupled: whether the answer acts late, and the look-ahead (None: the coupling's lag)."""

STEPS = (4.0, 2.0, 1.0, 0.5, 0.25)
"""Steps [ms] of the table."""

FINEST = 0.125e-3
"""Distance [s] of the reference's samples: the moments that every step and look-ahead of the table needs."""


@dataclass(frozen=True)
class Outcome:
    """A stepped ride against the reference.

    force: root mean square error of the force in the loop, as a share of the reference's largest force; path: the same
    of the hub's height [m]; energies: its account
    """

    force: float
    path: float
    energies: Account


def reference(ride: RideOnGround, tire: TireModel) -> Motion:
    """Return `ride` on `tire`'s elastic law, integrated as one system."""
    return ride.integrated(elastic(tire), round(ride.duration / FINEST) + 1)


def stepped(ride: RideOnGround, tire: SteppedTire, step: float, coupling: str) -> SteppedMotion:
    """Return `ride` in steps of `step` [s] under one of COUPLINGS."""
    late, look_ahead = COUPLINGS[coupling]
    return run(
        ride.bicycle,
        ride.course,
        tire,
        step=step,
        state=ride.state,
        coupling=Coupling(look_ahead, late),
    )


def outcome(ride: RideOnGround, truth: Motion, found: SteppedMotion, tire: TireModel) -> Outcome:
    """Return how far `found` is from `truth`; both rides on `tire`'s elastic law."""
    within = found.asked <= truth.time[-1]
    force = found.radial_force[within] - np.interp(found.asked[within], truth.time, truth.radial_force)
    path = found.hub_height - np.interp(found.time, truth.time, truth.hub_height)
    return Outcome(
        float(np.sqrt(np.mean(force**2)) / truth.radial_force.max()),
        float(np.sqrt(np.mean(path**2))),
        account(ride.bicycle, ride.ground, elastic_array(tire), found, speed=ride.speed, start=ride.start),
    )


@click.command()
@click.option("--ground", type=click.Choice(list(GROUNDS)), default="log", show_default=True)
@click.option("--speed", default=5.0, show_default=True, help="Speed [m/s].")
@click.option("--step", "steps", multiple=True, type=float, help="Step [ms]; may be repeated.")
@click.option(
    "--fmu", type=click.Path(path_type=Path), help="The FMU of the article's tire.  [default: built]"
)
def main(ground: str, speed: float, steps: tuple[float, ...], fmu: Path | None) -> None:
    """Ride over GROUND on the FMU of the article's tire and tell what the step costs."""
    tire = TireModel()
    try:
        with tempfile.TemporaryDirectory(prefix="tirelab_") as folder:
            path = build_fmu(tire, Path(folder)).path if fmu is None else fmu
            ride = GROUNDS[ground](tire, speed)
            truth = reference(ride, tire)
            largest = float(truth.radial_force.max())
            drive, damped = float(truth.drive[-1]), float(truth.damped[-1])
            low, high = truth.fork_travel
            click.echo(
                f"{ride.name}: {ride.duration:g} s, largest force {largest:.0f} N, largest deflection "
                f"{1e3 * truth.deflection.max():.1f} mm, fork {1e3 * low:.0f} to {1e3 * high:.0f} mm, drive "
                f"{drive:.0f} J, damped {damped:.0f} J, unaccounted for {abs(truth.imbalance).max():.0e} J"
            )
            click.echo("step [ms]  force error  path error [mm]  energy made [J]  unaccounted for [J]")
            for name in COUPLINGS:
                click.echo(name)
                for step in steps or STEPS:
                    try:
                        with fmu_tire(path) as asked:
                            found = outcome(ride, truth, stepped(ride, asked, 1e-3 * step, name), tire)
                    except TirelabError as error:
                        click.echo(f"{step:9g}  {error}")
                        continue
                    click.echo(
                        f"{step:9g}  {found.force:11.3%}  {1e3 * found.path:15.4f}  {found.energies.made:15.3f}  "
                        f"{found.energies.imbalance:19.0e}"
                    )
    except TirelabError as error:
        raise click.ClickException(str(error)) from None


if __name__ == "__main__":
    main()
