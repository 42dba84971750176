"""What an FMU says of itself: documentation, licences, what it needs, and its icon."""

from __future__ import annotations

from importlib import resources
from xml.etree import ElementTree

import jinja2
from radialtire import TireModel

NEEDS = """\
This FMU runs Python code. It needs

everywhere
    Python 3.10 or newer; the standard library is enough, no package has to be installed.

Linux (x86-64, glibc 2.17 or newer; newer where the binary was compiled by a machine's own compiler)
    - in a host that is itself a Python (fmpy): nothing more
    - in any other host: Python's shared library, libpython3.x.so.1.0. Debian and Ubuntu have it in the package
      libpython3.x, conda brings it along. It is looked for in this order: the path in the environment variable
      TIRELAB_LIBPYTHON, the Python of the active virtual environment, python3 and python on PATH, the system's.

Windows (x86-64)
    - python3.dll and python3x.dll of one installation of Python on PATH
    - the Microsoft Visual C++ Redistributable 2015-2022
"""


NATIVE_NEEDS = """\
This FMU needs nothing but the C library of the system: glibc 2.17 or newer on Linux (x86-64, aarch64), Windows 10 or
newer (x86-64), macOS 11 or newer (x86-64, arm64). For other platforms its sources compile with any C99 compiler:

    cc -std=c99 -O2 -ffp-contract=off -shared -fPIC -o BicycleTire.so *.c -lm
"""


ICON = """\
<?xml version='1.0' encoding='UTF-8'?>
<fmiTerminalsAndIcons fmiVersion="3.0">
  <GraphicalRepresentation>
    <CoordinateSystem x1="-100" y1="-100" x2="100" y2="100" suggestedScalingFactorTo_mm="0.1" />
    <Icon x1="-100" y1="-100" x2="100" y2="100" />
  </GraphicalRepresentation>
</fmiTerminalsAndIcons>
"""
"""Where FMI 3.0 has the icon."""


def pages(
    tire: TireModel, description: ElementTree.Element, wrapper_license: str | None, *, fmi: int = 2
) -> dict[str, bytes]:
    """Return the documentation's files by their names in the FMU.

    description: the model description of FMI 2.0, whose variables the page lists; fmi: the version of the FMU
    wrapper_license: the licence of pythonfmu, where the FMU carries its code; a native FMU has None
    """
    here = resources.files(__package__)
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    page = environment.from_string((here / "index.html.jinja").read_text(encoding="utf-8"))
    variables = [
        {**variable.attrib, **variable[0].attrib, "type": variable[0].tag}
        for variable in description.iterfind("ModelVariables/ScalarVariable")
    ]
    native = wrapper_license is None
    found = notices(wrapper_license) | {
        "documentation/index.html": page.render(
            tire=tire, variables=variables, native=native, fmi=fmi
        ).encode(),
    }
    icon = (here / "model.png").read_bytes()
    if fmi == 3:
        found["terminalsAndIcons/icon.png"] = icon
        found["terminalsAndIcons/terminalsAndIcons.xml"] = ICON.encode()
    else:
        found["model.png"] = icon
    return found


def notices(wrapper_license: str | None) -> dict[str, bytes]:
    """Return the licences and what the FMU needs, by their names in the FMU; wrapper_license: as for `pages`."""
    tirelab_license = (resources.files(__package__) / "license.txt").read_text(encoding="utf-8")
    found = {
        "documentation/externalDependencies.txt": (
            NATIVE_NEEDS if wrapper_license is None else NEEDS
        ).encode(),
        "documentation/licenses/license.txt": tirelab_license.encode(),
    }
    if wrapper_license is not None:
        found["documentation/licenses/pythonfmu.txt"] = wrapper_license.encode()
    return found
