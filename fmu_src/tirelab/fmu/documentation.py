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

Linux (x86-64)
    - the shared library of Python (libpython3.x.so): Debian and Ubuntu have it in the package libpython3-dev or
      python3-dev, conda brings it along. A host that is itself a Python (fmpy) needs none. The library is looked for
      with the python3 on PATH; the environment variable TIRELAB_LIBPYTHON names one outright.
    - glibc 2.32 and libstdc++ of GCC 12 (GLIBCXX_3.4.30) or newer, for the library of pythonfmu.

Windows (x86-64)
    - python3.dll and python3x.dll of one installation of Python on PATH
    - the Microsoft Visual C++ Redistributable 2015-2022
"""


def pages(tire: TireModel, description: ElementTree.Element, wrapper_license: str) -> dict[str, bytes]:
    """Return the documentation's files by their names in the FMU.

    description: the model description, whose variables the page lists
    wrapper_license: the licence of pythonfmu, whose code the FMU carries
    """
    here = resources.files(__package__)
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    page = environment.from_string((here / "index.html.jinja").read_text(encoding="utf-8"))
    variables = [
        {**variable.attrib, **variable[0].attrib, "type": variable[0].tag}
        for variable in description.iterfind("ModelVariables/ScalarVariable")
    ]
    tirelab_license = (here / "license.txt").read_text(encoding="utf-8")
    return {
        "documentation/index.html": page.render(tire=tire, variables=variables).encode(),
        "documentation/externalDependencies.txt": NEEDS.encode(),
        "documentation/licenses/license.txt": tirelab_license.encode(),
        "documentation/licenses/pythonfmu.txt": wrapper_license.encode(),
        "model.png": (here / "model.png").read_bytes(),
    }
