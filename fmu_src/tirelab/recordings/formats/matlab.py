"""MATLAB .mat files: version 7 and older are read with SciPy, version 7.3 as the HDF5 that it is."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..origin import Origin
from ..units import split_header
from .hdf5 import Hdf5Table
from .libraries import reading_with
from .table import (
    Columns,
    FloatArray,
    Header,
    RecordingError,
    Wanted,
    numbers,
    of_one_length,
    of_other_length,
    sample_place,
    with_others_blank,
)

MOST_COLUMNS = 64
"""A matrix with more columns than this is a picture or a map, not a set of channels."""


_COUNTED = re.compile(r"[({]\d+[)}]$")

LOGGED = ("time", "signals")
"""Fields of a struct in which Simulink logs signals: each of them has its numbers in `values`, its name in `label`."""

SCIPYS_OWN = ("__function_workspace__",)
"""Variables that SciPy adds to those of a file."""


def matlab_table(path: Path) -> MatlabTable | Hdf5Table:
    """The vectors of a .mat file of either kind: one of version 7.3 is HDF5 within."""
    with path.open("rb") as file:
        later = b"MATLAB 7.3" in file.read(128)
    return Hdf5Table(path, "; or in MATLAB, save it with save(..., '-v7')") if later else MatlabTable(path)


class MatlabTable:
    """The vectors of a .mat file: by name, in structs as data.force, a matrix column as x_F:2 (from 0); of several
    structs or cells as data(2).force and force{2}, as MATLAB counts them.
    """

    time_axis: int | None = None

    def __init__(self, path: Path) -> None:
        self.path = path
        # Variables are opened one by one: the shapes say which may be channels before anything is loaded.
        with reading_with(path, "a .mat file"):
            self.shapes = _shapes(path)
            opened = [name for name, _, kind in self.shapes if kind in ("struct", "cell")]
            self.opened = _one_clock(_fields(_load(path, opened))) if opened else {}
        self.columns: list[tuple[str, int | None]] = []
        self.samples: list[int] = []
        plain = [(name, shape) for name, shape, kind in self.shapes if kind not in ("struct", "cell")]
        for name, shape in [*plain, *((name, array.shape) for name, array in self.opened.items())]:
            self._add(name, shape)

    def _add(self, name: str, shape: tuple[int, ...]) -> None:
        sizes = [n for n in shape if n != 1]  # Simulink logs a scalar signal as 1 x 1 x samples
        if not 1 <= len(sizes) <= 2 or min(sizes) < 1 or (len(sizes) == 2 and min(sizes) > MOST_COLUMNS):
            return
        parts: list[int | None] = [None] if len(sizes) == 1 else list(range(min(sizes)))
        self.columns += [(name, part) for part in parts]
        self.samples += [max(sizes)] * len(parts)

    @property
    def headers(self) -> Sequence[Header]:
        """The vectors and matrix columns that hold more than one number; a .mat file gives no units."""
        headers = []
        for name, part in self.columns:
            after = "" if part is None else f":{part}"
            bare, unit = split_header(_COUNTED.sub("", name.rpartition(".")[2]) + after)
            headers.append(Header(bare, unit, name + after))
        return headers

    def bytes_needed(self, columns: int) -> int:
        """The longest vectors, as stored and as float64."""
        return max(self.samples, default=0) * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The vectors wanted; refused when their lengths differ, but for those that can be done without."""
        headers = self.headers
        names = {self.columns[want.index][0] for want in wanted}
        with reading_with(self.path, "a .mat file"):
            loaded = _load(self.path, sorted(names - self.opened.keys()))
        values: list[FloatArray] = []
        for want in wanted:
            name, part = self.columns[want.index]
            array = np.atleast_2d(np.squeeze(self.opened[name] if name in self.opened else loaded[name]))
            along = array if array.shape[0] == max(array.shape) else array.T
            column = along[:, part or 0]
            values.append(numbers(Origin(self.path.name), headers[want.index], column, want.channel))
        own = [headers[want.index] for want in wanted]
        together, left_out = with_others_blank(own, values, of_other_length(wanted, values))
        of_one_length(Origin(self.path.name), own, together)
        return Columns(together, sample_place, left_out)


def _scipy_io() -> Any:
    # Imported here because it takes a sixth of a second that only readers of .mat files need.
    import scipy.io

    return scipy.io


def _shapes(path: Path) -> list[tuple[str, tuple[int, ...], str]]:
    """Return name, shape and kind of the variables, of a file with an object of a class those of its arrays."""
    try:
        return [*_scipy_io().whosmat(str(path))]
    except TypeError:  # SciPy does not list such a file, but loads the rest of it
        loaded: dict[str, Any] = _scipy_io().loadmat(str(path))
    opaque = _scipy_io().matlab.MatlabOpaque
    own = [(n, v) for n, v in loaded.items() if isinstance(v, np.ndarray) and n not in SCIPYS_OWN]
    arrays = [(n, v) for n, v in own if not isinstance(v, opaque)]
    if own and not arrays:
        raise RecordingError(_unopened(path, own[0][1]))
    return [
        (n, v.shape, "struct" if v.dtype.names else "cell" if v.dtype.hasobject else "") for n, v in arrays
    ]


def _unopened(path: Path, objects: NDArray[Any]) -> str:
    """Return what to say of a file that holds nothing but objects of classes, the first of them first."""
    name, _, kind, _ = (v.decode() if isinstance(v, bytes) else v for v in objects.ravel()[0])
    text = kind in ("table", "timetable")
    instead = (
        f"write{kind}({name}, '{path.stem}.csv')" if text else "save the vectors of numbers that it holds"
    )
    return f"{path.name}: {name} is a {kind}, which only MATLAB opens; there, {instead}, and read what that writes"


def _load(path: Path, names: Sequence[str]) -> dict[str, Any]:
    if not names:
        return {}
    loaded: dict[str, Any] = _scipy_io().loadmat(str(path), variable_names=list(names))
    return {name: value for name, value in loaded.items() if name in names}


def _one_clock(arrays: Iterable[tuple[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    """Return the arrays by their names, the same time of several structs once."""
    found: dict[str, NDArray[Any]] = {}
    clocks: list[NDArray[Any]] = []
    for name, array in arrays:
        if name.endswith(".time"):
            if any(np.array_equal(array, clock) for clock in clocks):
                continue
            clocks.append(array)
        found[name] = array
    return found


def _named(struct: str, signals: NDArray[Any]) -> dict[str, Any]:
    """Return the signals of a struct by their labels, by their numbers where these do not tell them apart."""
    labels = signals["label"] if "label" in (signals.dtype.names or ()) else np.full(len(signals), "")
    own = ["".join(map(str, np.ravel(label))) for label in labels]
    return {
        f"{struct}.{label}" if label and own.count(label) == 1 else f"{struct}({number})": signal
        for number, (label, signal) in enumerate(zip(own, signals, strict=True), 1)
    }


def _fields(opened: Mapping[str, Any]) -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield the arrays of numbers in structs and cells, by their names in MATLAB; a signal that Simulink logged with
    its time by its own name.
    """
    for name, value in opened.items():
        if not isinstance(value, np.ndarray) or (value.dtype.hasobject and value.size > MOST_COLUMNS):
            continue
        one, inner = value.size == 1, value.ravel(order="F")
        if value.dtype.names:
            for i, struct in enumerate(inner, 1):
                own = name if one else f"{name}({i})"
                fields = {f"{own}.{field}": struct[field] for field in value.dtype.names}
                logged = struct["signals"].ravel(order="F") if set(LOGGED) <= set(value.dtype.names) else None
                if logged is not None and "values" in (logged.dtype.names or ()):
                    fields = {f"{own}.time": struct["time"]}
                    signals = {own: logged[0]} if len(logged) == 1 else _named(own, logged)
                    fields |= {n: signal["values"] for n, signal in signals.items()}
                yield from _fields(fields)
        elif value.dtype.hasobject:
            yield from _fields({name if one else f"{name}{{{i}}}": cell for i, cell in enumerate(inner, 1)})
        elif value.dtype.kind in "fiub":
            yield name, value
