"""The numbers behind a picture as a table that the page carries and a reader can save."""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_LINK = Markup(
    '<p class="caption numbers"><a download="{name}.csv" href="data:text/csv;base64,{data}">{name}.csv</a></p>'
)


def table_link(name: str, head: Sequence[str], rows: Iterable[Sequence[str | float]]) -> Markup:
    """Return a link under a picture that saves a table as `name`.csv, its numbers to six digits."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([[c if isinstance(c, str) else f"{c:.6g}" for c in row] for row in rows])
    return _LINK.format(name=name, data=base64.b64encode(text.getvalue().encode()).decode("ascii"))


def curves_link(name: str, axes: Axes) -> Markup:
    """Return a link to the points of every curve on `axes` that has a label; the columns are the axes'."""
    rows = [
        (str(line.get_label()), x, y)
        for line in axes.lines
        if not str(line.get_label()).startswith("_")
        for x, y in np.column_stack([line.get_xdata(), line.get_ydata()]).tolist()
    ]
    return table_link(name, ("curve", axes.get_xlabel(), axes.get_ylabel()), rows)


def cells_link(name: str, across: FloatArray, up: tuple[str, FloatArray], mean: FloatArray) -> Markup:
    """Return a link to the cells of a map that hold samples.

    across: the edges of its columns [mm]; up: what its rows are with their edges; mean: residual [N] of every cell
    """
    what, edges = up
    rows = [
        (across[i], across[i + 1], edges[j], edges[j + 1], mean[i, j])
        for i, j in np.argwhere(np.isfinite(mean))
    ]
    head = ("deflection from [mm]", "to [mm]", f"{what} from", f"{what} to", "mean residual [N]")
    return table_link(name, head, rows)
