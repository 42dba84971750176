"""A small co-simulation master: it rides an SSP archive with fmpy, one unit after the other or side by side.

    python examples/quarter_bicycle/cosimulate.py dist/QuarterBicycle.ssp --step 0.5

fmpy's own `simulate_ssp` starts every connection at 0, which is no radius of any surface; this one hands over the
initial outputs first.
"""

from __future__ import annotations

import tempfile
import zipfile
from contextlib import ExitStack
from pathlib import Path

import click
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.ssp.ssd import read_ssd
from numpy.typing import NDArray
from tirelab.errors import TirelabError
from tirelab.fmu.replay import NO_REASON, OpenFmu, opened

Table = dict[str, NDArray[np.float64]]
"""Time [s] and every output as COMPONENT.NAME; shape (n,)."""


def cosimulate(ssp: Path, *, step: float, duration: float, one_after_the_other: bool = False) -> Table:
    """Run the system of `ssp` for `duration` [s] in steps of `step` [s] and return what its units put out.

    one_after_the_other: each unit, in the archive's order, steps on what those before it have just put out; otherwise
    all step at once on what was put out before. The rows are the moments at which the steps begin.
    Raises TirelabError where a unit refuses a step.
    """
    system = read_ssd(str(ssp)).system
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="tirelab_")))
        with zipfile.ZipFile(ssp) as archive:
            archive.extractall(folder)
        units: dict[str, OpenFmu] = {}
        for component in system.elements:
            unit = units[component.name] = stack.enter_context(opened(folder / component.source))
            unit.instance.setupExperiment(startTime=0.0)
            for binding in component.parameterBindings:
                for parameter in binding.parameterValues[0].parameters if binding.parameterValues else []:
                    unit.instance.setReal([unit.references[parameter.name]], [float(parameter.value)])
            unit.instance.enterInitializationMode()
        connections = [
            (c.startElement, c.startConnector, c.endElement, c.endConnector) for c in system.connections
        ]
        outputs = [
            (component.name, connector.name)
            for component in system.elements
            for connector in component.connectors
            if connector.kind == "output"
        ]

        def get(name: str, variable: str) -> float:
            return float(units[name].instance.getReal([units[name].references[variable]])[0])

        def hand_over(to: str | None = None) -> None:
            values = [(c, get(c[0], c[1])) for c in connections if to in (None, c[2])]
            for (_, _, target, variable), value in values:
                units[target].instance.setReal([units[target].references[variable]], [value])

        for _ in units:  # what one unit makes of another's initial outputs
            hand_over()
        for unit in units.values():
            unit.instance.exitInitializationMode()

        count = round(duration / step) + 1
        table: Table = {f"{name}.{variable}": np.empty(count) for name, variable in outputs}
        table["time"] = step * np.arange(count, dtype=np.float64)
        for i in range(count):
            if one_after_the_other:
                hand_over(next(iter(units)))
            for name, variable in outputs:
                table[f"{name}.{variable}"][i] = get(name, variable)
            for name in units:
                if one_after_the_other:
                    hand_over(name)
                try:
                    units[name].instance.doStep(i * step, step)
                except FMICallException:
                    reason = units[name].messages()[-1] if units[name].messages() else NO_REASON
                    raise TirelabError(f"{name} refused the step from {i * step:g} s: {reason}") from None
            if not one_after_the_other:
                hand_over()
    return table


@click.command()
@click.argument("ssp", type=click.Path(path_type=Path))
@click.option("--step", default=0.5, show_default=True, help="Step [ms].")
@click.option("--duration", default=0.3, show_default=True, help="Duration [s].")
@click.option("--one-after-the-other", is_flag=True, help="Instead of side by side.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("ride.csv"), show_default=True)
def main(ssp: Path, step: float, duration: float, one_after_the_other: bool, out: Path) -> None:
    """Ride SSP with fmpy and write the outputs of its units as CSV."""
    try:
        table = cosimulate(ssp, step=1e-3 * step, duration=duration, one_after_the_other=one_after_the_other)
        np.savetxt(
            out, np.column_stack(list(table.values())), delimiter=",", header=",".join(table), comments=""
        )
    except (TirelabError, OSError) as error:
        raise click.ClickException(str(error)) from None
    click.echo(f"{out}: {table['time'].size} moments")


if __name__ == "__main__":
    main()
