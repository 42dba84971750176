"""QuarterBicycle.fmu, and the SSP archive in which it rides on BicycleTire.fmu; the same bytes for the same ride.

    python examples/quarter_bicycle/pack.py --ground log --speed 5 --out dist

writes dist/QuarterBicycle.ssp: SystemStructure.ssd (System Structure and Parameterization 1.0) and the two FMUs.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
import uuid
import zipfile
from dataclasses import asdict
from pathlib import Path
from xml.etree import ElementTree

import bicycle as bicycle_module
import click
import fmpy.validation
import quarter_bicycle_fmu as shell
import wheel as wheel_module
from coupled import lag
from pythonfmu import FmuBuilder
from radialtire import TireModel, read_tire
from rides import GROUNDS, RideOnGround
from tirelab.errors import TirelabError
from tirelab.fmu.build import build_fmu
from tirelab.fmu.loader import compile_loader

MODEL, TIRE, SYSTEM = "QuarterBicycle", "BicycleTire", "QuarterBicycle.ssp"
LINUX_BINARY = f"binaries/linux64/{MODEL}.so"
EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date of every archive member: the earliest a ZIP can hold."""

SSC = "http://ssp-standard.org/SSP1/SystemStructureCommon"
SSD = "http://ssp-standard.org/SSP1/SystemStructureDescription"
SSV = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
OSP = "http://opensimulationplatform.com/SSP/OSPAnnotations"

CONNECTORS: dict[str, dict[str, tuple[str, str]]] = {
    TIRE: {"deflection": ("input", "m"), "surface_radius": ("input", "m"), "radial_force": ("output", "N")},
    MODEL: {
        "radial_force": ("input", "N"),
        **{n: ("output", unit) for n, (unit, _) in shell.OUTPUTS.items()},
    },
}
"""Kind and unit of each component's connectors; a master that runs one after the other begins with the tire."""

CONNECTIONS = (
    (MODEL, TIRE, "deflection"),
    (MODEL, TIRE, "surface_radius"),
    (TIRE, MODEL, "radial_force"),
)
"""From, to and the connector, which has the same name on both sides."""


def pack_bicycle(ride: RideOnGround, folder: Path, *, step: float) -> Path:
    """Write `folder`/QuarterBicycle.fmu for `ride`, whose masters step by `step` [s] unless set otherwise."""
    with tempfile.TemporaryDirectory(prefix="tirelab_") as name:
        members = _packed(_ride_json(ride, step), Path(name))
        binary = Path(name) / "loader.so"
        if compile_loader(binary) is not None:
            members[LINUX_BINARY] = binary.read_bytes()
    description = ElementTree.fromstring(members.pop("modelDescription.xml"))
    description.set("guid", "")
    digest = hashlib.sha256(ElementTree.tostring(description))
    for member in sorted(members):
        digest.update(member.encode() + b"\0" + hashlib.sha256(members[member]).digest())
    description.set("guid", "{" + str(uuid.UUID(bytes=digest.digest()[:16], version=5)) + "}")
    members["modelDescription.xml"] = _text(description)
    path = _write(members, folder / f"{MODEL}.fmu")
    problems = fmpy.validation.validate_fmu(str(path))
    if problems:
        raise TirelabError(f"{path} is not a valid FMU: {problems[0]}; report this with the ride")
    return path


def pack_system(
    ride: RideOnGround,
    tire: TireModel,
    folder: Path,
    *,
    step: float = 0.5e-3,
    look_ahead: float | None = None,
) -> Path:
    """Write `folder`/QuarterBicycle.ssp, `ride` on `tire`, and return its path.

    look_ahead [s]: None takes one and a half steps, for masters that run the two FMUs side by side
    """
    ahead = lag(step, late=True) if look_ahead is None else look_ahead
    with tempfile.TemporaryDirectory(prefix="tirelab_") as name:
        fmus = (
            pack_bicycle(ride, Path(name), step=step),
            build_fmu(tire, Path(name)).path,
        )
        members = {f"resources/{fmu.name}": fmu.read_bytes() for fmu in fmus}
    members["SystemStructure.ssd"] = _text(structure(ride, step, ahead))
    return _write(members, folder / SYSTEM)


def structure(ride: RideOnGround, step: float, look_ahead: float) -> ElementTree.Element:
    """Return the SystemStructure.ssd of `ride` (SSP 1.0)."""
    for prefix, namespace in (("ssc", SSC), ("ssd", SSD), ("ssv", SSV), ("osp", OSP)):
        ElementTree.register_namespace(prefix, namespace)

    def add(
        parent: ElementTree.Element, tag: str, namespace: str = SSD, /, **attributes: str
    ) -> ElementTree.Element:
        return ElementTree.SubElement(parent, f"{{{namespace}}}{tag}", attributes)

    root = ElementTree.Element(
        f"{{{SSD}}}SystemStructureDescription",
        {"version": "1.0", "name": MODEL, "description": ride.name},
    )
    system = add(root, "System", name="Ride")
    elements = add(system, "Elements")
    for component, connectors in CONNECTORS.items():
        element = add(
            elements,
            "Component",
            name=component,
            type="application/x-fmu-sharedlibrary",
            source=f"resources/{component}.fmu",
        )
        listed = add(element, "Connectors")
        for name, (kind, unit) in connectors.items():
            add(add(listed, "Connector", name=name, kind=kind), "Real", SSC, unit=unit)
        if component == MODEL:
            values = add(add(add(element, "ParameterBindings"), "ParameterBinding"), "ParameterValues")
            parameters = add(
                add(values, "ParameterSet", SSV, version="1.0", name="coupling"), "Parameters", SSV
            )
            parameter = add(parameters, "Parameter", SSV, name="look_ahead")
            add(parameter, "Real", SSV, value=f"{look_ahead:.17g}", unit="s")
    connections = add(system, "Connections")
    for source, target, name in CONNECTIONS:
        add(
            connections,
            "Connection",
            startElement=source,
            startConnector=name,
            endElement=target,
            endConnector=name,
        )
    units = add(root, "Units")
    for unit in sorted(
        {unit for connectors in CONNECTORS.values() for _, unit in connectors.values()} | {"s"}
    ):
        add(add(units, "Unit", SSC, name=unit), "BaseUnit", SSC, **shell.UNITS[unit])
    experiment = add(root, "DefaultExperiment", startTime="0", stopTime=f"{ride.duration:g}")
    annotation = add(add(experiment, "Annotations"), "Annotation", SSC, type="com.opensimulationplatform")
    add(add(annotation, "Algorithm", OSP), "FixedStepAlgorithm", OSP, baseStepSize=f"{step:g}")
    return root


def _ride_json(ride: RideOnGround, step: float) -> str:
    track, bicycle = ride.track, asdict(ride.bicycle)
    parameters = {
        "look_ahead": 0.0,
        "speed": ride.speed,
        **{name: bicycle[name] for name in shell.PARAMETERS if name in bicycle},
    }
    content = {
        "name": ride.name,
        "start": ride.start,
        "duration": ride.duration,
        "step": step,
        "wheel_radius": ride.bicycle.wheel_radius,
        "parameters": parameters,
        "state": [float(value) for value in ride.state],
        "ground": asdict(track),
    }
    return json.dumps(content)


def _packed(ride: str, work: Path) -> dict[str, bytes]:
    """Let pythonfmu pack the sources and return the members of its archive.

    FMUs in one process share one table of modules, so the modules' names carry a hash of their content.
    """
    sources = {
        module.__name__: Path(module.__file__ or "").read_text(encoding="utf-8")
        for module in (shell, bicycle_module, wheel_module)
    }
    mark = hashlib.sha256("\0".join(sources.values()).encode()).hexdigest()[:12]
    stage = work / "stage"
    stage.mkdir()
    for name, text in sources.items():
        for other in sources:
            text = text.replace(f"\nfrom {other} import ", f"\nfrom {other}_{mark} import ")
        (stage / f"{name}_{mark}.py").write_text(text, encoding="utf-8")
    (stage / "ride.json").write_text(ride, encoding="utf-8")
    script, *others = (stage / f"{name}_{mark}.py" for name in sources)
    path_before, modules_before = list(sys.path), set(sys.modules)
    try:
        archive = FmuBuilder.build_FMU(
            script, dest=work / "packed", project_files=[*others, stage / "ride.json"]
        )
    finally:
        sys.path[:] = path_before
        for module_name in [m for m in sys.modules if m not in modules_before and mark in m]:
            del sys.modules[module_name]
    with zipfile.ZipFile(archive) as packed:
        return {
            n: packed.read(n) for n in packed.namelist() if "__pycache__" not in n and not n.endswith("/")
        }


def _text(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    text: bytes = ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text + b"\n"


def _write(members: dict[str, bytes], path: Path) -> Path:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            for name in sorted(members):
                info = zipfile.ZipInfo(name, EPOCH)
                info.compress_type = zipfile.ZIP_DEFLATED
                info.external_attr = 0o644 << 16
                archive.writestr(info, members[name])
    except OSError as error:
        raise TirelabError(f"{path} cannot be written ({error.strerror}); name another with --out") from None
    return path


@click.command()
@click.option("--ground", type=click.Choice(list(GROUNDS)), default="log", show_default=True)
@click.option("--speed", default=5.0, show_default=True, help="Speed [m/s].")
@click.option("--step", default=0.5, show_default=True, help="The master's step [ms].")
@click.option("--tire", type=click.Path(path_type=Path), help="Tire file.  [default: the article's tire]")
@click.option("--out", type=click.Path(path_type=Path), default=Path("dist"), show_default=True)
def main(ground: str, speed: float, step: float, tire: Path | None, out: Path) -> None:
    """Write OUT/QuarterBicycle.ssp: a ride over GROUND as a system of two FMUs."""
    model = TireModel() if tire is None else read_tire(tire)
    try:
        ride = GROUNDS[ground](model, speed)
        click.echo(pack_system(ride, model, out, step=1e-3 * step))
    except TirelabError as error:
        raise click.ClickException(str(error)) from None


if __name__ == "__main__":
    main()
