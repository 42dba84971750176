"""MATLAB .mat files: version 7 and older are read with SciPy, version 7.3 as the HDF5 that it is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..origin import Origin
from .hdf5 import Hdf5Table
from .libraries import reading_with
from .table import Columns, FloatArray, Header, Wanted, numbers, of_one_length, sample_place

MOST_COLUMNS = 64
"""A matrix with more columns than this is a picture or a map, not a set of channels."""


def matlab_table(path: Path) -> MatlabTable | Hdf5Table:
    """The vectors of a .mat file of either kind: one of version 7.3 is HDF5 within."""
    with path.open("rb") as file:
        later = b"MATLAB 7.3" in file.read(128)
    return Hdf5Table(path, "; or in MATLAB, save it with save(..., '-v7')") if later else MatlabTable(path)


class MatlabTable:
    """The vectors of a .mat file: by name, in structs as data.force, a matrix column as x_F:2 (from 0)."""

    time_axis: int | None = None

    def __init__(self, path: Path) -> None:
        self.path = path
        # Variables are opened one by one: the shapes say which may be channels before anything is loaded.
        with reading_with(path, "a .mat file"):
            self.shapes = [(name, shape, kind) for name, shape, kind in _scipy_io().whosmat(str(path))]
            structs = [name for name, _, kind in self.shapes if kind == "struct"]
            self.structs = dict(_fields(_load(path, structs))) if structs else {}
        self.columns: list[tuple[str, int | None]] = []
        self.samples: list[int] = []
        plain = [(name, shape) for name, shape, kind in self.shapes if kind != "struct"]
        for name, shape in [*plain, *((name, array.shape) for name, array in self.structs.items())]:
            self._add(name, shape)

    def _add(self, name: str, shape: tuple[int, ...]) -> None:
        if len(shape) != 2 or max(shape) < 2 or min(shape) < 1 or min(shape) > MOST_COLUMNS:
            return
        parts: list[int | None] = [None] if min(shape) == 1 else list(range(min(shape)))
        self.columns += [(name, part) for part in parts]
        self.samples += [max(shape)] * len(parts)

    @property
    def headers(self) -> Sequence[Header]:
        """The vectors and matrix columns that hold more than one number; a .mat file gives no units."""
        names = [name if part is None else f"{name}:{part}" for name, part in self.columns]
        return [Header(name, None, name) for name in names]

    def bytes_needed(self, columns: int) -> int:
        """The longest vectors, as stored and as float64."""
        return max(self.samples, default=0) * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The vectors wanted; refused when their lengths differ."""
        headers = self.headers
        names = {self.columns[want.index][0] for want in wanted}
        with reading_with(self.path, "a .mat file"):
            loaded = _load(self.path, sorted(names - self.structs.keys()))
        values: list[FloatArray] = []
        for want in wanted:
            name, part = self.columns[want.index]
            array = np.asarray(self.structs[name] if name in self.structs else loaded[name])
            along = array if array.shape[0] == max(array.shape) else array.T
            column = along[:, part or 0]
            values.append(numbers(Origin(self.path.name), headers[want.index], column, want.channel))
        of_one_length(Origin(self.path.name), [headers[want.index] for want in wanted], values)
        return Columns(tuple(values), sample_place)


def _scipy_io() -> Any:
    # Imported here because it takes a sixth of a second that only readers of .mat files need.
    import scipy.io

    return scipy.io


def _load(path: Path, names: Sequence[str]) -> dict[str, Any]:
    if not names:
        return {}
    loaded: dict[str, Any] = _scipy_io().loadmat(str(path), variable_names=list(names))
    return {name: value for name, value in loaded.items() if not name.startswith("__")}


def _fields(structs: dict[str, Any]) -> Iterator[tuple[str, NDArray[Any]]]:
    for name, value in structs.items():
        if not isinstance(value, np.ndarray):
            continue
        if value.dtype.names and value.size == 1:
            inner = value.reshape(-1)[0]
            yield from _fields({f"{name}.{field}": inner[field] for field in value.dtype.names})
        elif value.dtype.names is None and value.ndim == 2:
            yield name, value
