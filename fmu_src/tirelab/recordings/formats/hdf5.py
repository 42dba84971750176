"""HDF5 files, and MATLAB files of version 7.3, read with h5py; units come from the attributes of the datasets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..origin import Origin
from ..units import split_header
from .libraries import load_library, reading_with
from .table import (
    Columns,
    FloatArray,
    Header,
    Wanted,
    numbers,
    of_one_length,
    of_other_length,
    sample_place,
    with_others_blank,
)

MOST_COLUMNS = 64
"""A matrix with more columns than this is a picture or a map, not a set of channels."""

MOST_DATASETS = 2000
"""Most datasets of a file that are searched."""

UNIT_KEYS = ("unit", "units", "unit_string")
"""Attributes of a dataset that state its unit, in small letters."""

BLANKS = ("_FillValue", "missing_value")
SCALE, OFFSET = "scale_factor", "add_offset"
PACKED = (*BLANKS, SCALE, OFFSET)
"""Attributes of a dataset whose values are packed, as netCDF files have them."""


@dataclass(frozen=True)
class _Place:
    """Where a column stands: the dataset, and its column of a matrix or its field of a table."""

    dataset: str
    part: int | str | None = None


class Hdf5Table:
    """The vectors of an HDF5 file by path, log/force; a matrix column as log/x:2 (from 0), a field as log.force."""

    time_axis: int | None = None

    def __init__(self, path: Path, instead: str = "") -> None:
        """instead: what else can be done where the library is not installed."""
        self.path = path
        self.library = load_library(path, "h5py", "h5py", instead)
        self.places: list[_Place] = []
        self.headers: list[Header] = []
        self.samples = 0
        with reading_with(path, "HDF5"), self.library.File(path, "r") as file:
            found: list[str] = []
            file.visititems(lambda name, item: _note(found, name, item))
            for name in found:
                self._add(name, file[name])

    def _add(self, name: str, dataset: Any) -> None:
        text = name.removeprefix("/")
        if dataset.dtype.names:
            if dataset.ndim == 1:
                fields = [n for n in dataset.dtype.names if dataset.dtype[n].kind in "fiu"]
                self._keep(dataset.shape[0], [(_Place(name, n), f"{text}.{n}", n) for n in fields], None)
            return
        shape = tuple(int(n) for n in dataset.shape if n != 1)
        if dataset.dtype.kind not in "fiu" or not 1 <= len(shape) <= 2 or min(shape) < 1:
            return
        stated = {str(key).lower(): _as_text(value) for key, value in dataset.attrs.items()}
        unit = next((stated[key] for key in UNIT_KEYS if stated.get(key)), None)
        bare = text.rsplit("/", 1)[-1]
        if len(shape) == 1:
            self._keep(max(shape), [(_Place(name), text, bare)], unit)
        elif min(shape) <= MOST_COLUMNS:
            parts = [(_Place(name, k), f"{text}:{k}", f"{bare}:{k}") for k in range(min(shape))]
            self._keep(max(shape), parts, unit)

    def _keep(self, samples: int, columns: Sequence[tuple[_Place, str, str]], unit: str | None) -> None:
        self.samples = max(self.samples, samples)
        for place, text, bare in columns:
            name, in_name = split_header(bare)
            self.places.append(place)
            self.headers.append(Header(name, unit or in_name, text))

    def bytes_needed(self, columns: int) -> int:
        """The longest vectors, as stored and as float64."""
        return self.samples * columns * 8 * 2

    def read(self, wanted: Sequence[Wanted]) -> Columns:
        """The vectors wanted; refused when their lengths differ, but for those that can be done without."""
        values: list[FloatArray] = []
        notes: list[str] = []
        headers = [self.headers[want.index] for want in wanted]
        with reading_with(self.path, "HDF5"), self.library.File(self.path, "r") as file:
            for want, header in zip(wanted, headers, strict=True):
                place = self.places[want.index]
                dataset = file[place.dataset]
                array = np.squeeze(dataset[place.part] if isinstance(place.part, str) else dataset[()])
                if array.ndim == 2:
                    along = array if array.shape[0] == max(array.shape) else array.T
                    array = along[:, int(place.part or 0)]
                column = numbers(Origin(self.path.name), header, array, want.channel)
                column, said = _unpacked(column, dataset.attrs)
                values.append(column)
                notes += [f"{header.text}: {said}"] if said else []
        together, left_out = with_others_blank(headers, values, of_other_length(wanted, values))
        of_one_length(Origin(self.path.name), headers, together)
        return Columns(together, sample_place, (*notes, *left_out))


def _unpacked(values: FloatArray, attributes: Any) -> tuple[FloatArray, str]:
    """Return the values that packed ones stand for, blanks as NaN, and what was done: CF Conventions 1.11, 2.5 and 8.1.

    A blank is what `_FillValue` or `missing_value` says; a value is the packed one times `scale_factor` plus
    `add_offset`.
    """
    stated = {name: np.asarray(attributes[name]).reshape(-1) for name in PACKED if name in attributes}
    told = {n: float(v[0]) for n, v in stated.items() if v.size == 1 and v.dtype.kind in "fiu"}
    blank = np.zeros(values.size, dtype=bool)
    for name in BLANKS:
        blank |= values == told.pop(name, np.nan)
    said = f"{int(blank.sum())} blanks by its attributes" if blank.any() else ""
    if told:
        values = values * told.get(SCALE, 1.0) + told.get(OFFSET, 0.0)
        said = ", ".join([*(f"{n} {v:g} applied" for n, v in told.items()), *([said] if said else [])])
    return np.where(blank, np.nan, values), said


def _note(found: list[str], name: str, item: Any) -> None:
    """Note the name of a dataset; what MATLAB keeps for itself begins with #."""
    if hasattr(item, "dtype") and not name.startswith("#") and len(found) < MOST_DATASETS:
        found.append(name)


def _as_text(value: Any) -> str:
    """Return an attribute as text: h5py gives str, bytes, or an array of one of them."""
    item = np.asarray(value).reshape(-1)
    first = item[0] if item.size == 1 else ""
    return first.decode("utf-8", "replace").strip() if isinstance(first, bytes) else str(first).strip()
