"""The columns of recordings at a point of the search, and the products by which sets of them are compared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from ..preprocessing.kinematics import BoolArray, FloatArray, IndexArray
from ..preprocessing.noise_model import Noise, first_guess
from .evidence import Products, discounted, products_of
from .families import LAGS, Family
from .lag import lagged
from .place import Place, Point, nearest, place_at
from .scene import Record, Scene


@dataclass(frozen=True)
class Built:
    """One recording's columns of every family at a point, and what they are to explain."""

    place: Place
    columns: dict[str, FloatArray]
    residual: FloatArray
    raw: dict[str, FloatArray]


def build(scene: Scene, point: Point, families: Sequence[Family], quick: bool = False) -> list[Built]:
    """Return the columns of `families` for each recording, around `point`, and the residual there.

    quick: whether columns read late may be interpolated between the thin samples
    """
    if point.lag <= 0.0:
        return [_build(scene, r, point, families) for r in scene.records]
    late = _build_late_quickly if quick else _build_late
    return [late(scene, r, point, families) for r in scene.records]


def _build(scene: Scene, record: Record, point: Point, families: Sequence[Family]) -> Built:
    place = place_at(record.thin, scene, point)
    whole = place
    if record.thin is not record and any(f.remembers for f in families):
        whole = replace(place_at(record, scene, point), rows=record.rows)
    raw = {f.name: f.build(whole) if f.remembers else f.build(place) for f in families}
    columns, force = raw, place.elastic
    if point.lifted is not None:
        on_ground = ~point.lifted[record.number]
        force = force * on_ground
        if not on_ground.all():
            columns = {
                f.name: raw[f.name] if f.after_lag else raw[f.name] * on_ground[:, None] for f in families
            }
    return Built(place, columns, record.thin.force - force, raw)


def _build_late(scene: Scene, record: Record, point: Point, families: Sequence[Family]) -> Built:
    """Build with a lag, for which every sample is needed."""
    place = place_at(record, scene, point)
    rows = record.rows
    force = place.elastic
    on_ground = np.ones(force.size, dtype=bool)
    if point.lifted is not None:
        on_ground = ~nearest(record, point.lifted[record.number])
    read = _through_reading(record.time, force * on_ground, point)
    raw, columns = {}, {}
    for f in families:
        own = f.build(place)
        raw[f.name] = own[rows]
        if f.name == "force_lag":
            # Away from no lag its slope alone is a column: the other lags are reached by moving the point.
            own = np.zeros_like(own)
            own[:, 0] = np.gradient(read, record.time)
            own[:, -1] = np.gradient(own[:, 0], record.time)
        elif not f.after_lag:
            own = _through_reading(record.time, own * on_ground[:, None], point)
        columns[f.name] = own[rows]
    return Built(place_at(record.thin, scene, point), columns, record.thin.force - read[rows], raw)


def _build_late_quickly(scene: Scene, record: Record, point: Point, families: Sequence[Family]) -> Built:
    """Build with a lag for a screening: the columns, not the residual, are read late from the thin samples alone."""
    exact = _build_late(scene, record, point, [f for f in families if f.name == "force_lag"])
    plain = _build(scene, record, point, [f for f in families if f.name != "force_lag"])
    late = {f.name for f in families if not f.after_lag}
    columns = {
        name: _through_reading(record.thin.time, values, point) if name in late else values
        for name, values in plain.columns.items()
    }
    return Built(plain.place, columns | exact.columns, exact.residual, plain.raw | exact.raw)


def _through_reading(time: FloatArray, values: FloatArray, point: Point) -> FloatArray:
    if point.lag <= 0.0:
        return values
    flat = values[:, None] if values.ndim == 1 else values
    return lagged(time, flat, point.lag, point.stages).reshape(values.shape)


def lifted_from_force(scene: Scene) -> tuple[BoolArray, ...]:
    """Return where each recording reads no force although the bare law has some: a first guess of lift-off."""
    found = []
    for whole in scene.records:
        record = whole.thin
        elastic = record.elastic(record.motion.deflection)
        sigma = first_guess(record.force - elastic).innovation
        # A load cell whose zero is off reads less than nothing, a tire in the air reads nothing.
        found.append((np.abs(median_filter(record.force, 3)) < 2.0 * sigma) & (elastic > 4.0 * sigma))
    return tuple(found)


def lifted_at(
    built: Sequence[Built],
    point: Point,
    families: Sequence[Family],
    coefficients: Sequence[FloatArray],
    groups: Sequence[IndexArray],
) -> tuple[BoolArray, ...]:
    """Return where the force of the point and its families would be a pull."""
    acting = [not f.after_lag and f.name not in ("force_lag", "inertia") for f in families]
    return tuple(
        _summed(b.raw, b.place.elastic, point, families, coefficients, groups, acting) <= 0.0 for b in built
    )


def beside_at(
    built: Sequence[Built],
    point: Point,
    families: Sequence[Family],
    coefficients: Sequence[FloatArray],
    groups: Sequence[IndexArray],
) -> tuple[FloatArray, ...]:
    """Return what the families add to the elastic force [N] before the reading reaches its ceiling."""
    acting = [f.name != "saturation" for f in families]
    return tuple(
        _summed(b.columns, np.zeros_like(b.residual), point, families, coefficients, groups, acting)
        for b in built
    )


def _summed(
    columns: Mapping[str, FloatArray],
    start: FloatArray,
    point: Point,
    families: Sequence[Family],
    coefficients: Sequence[FloatArray],
    groups: Sequence[IndexArray],
    acting: Sequence[bool],
) -> FloatArray:
    """Return `start` [N] and on top of it what the acting families add to what the point already holds."""
    force: FloatArray = start.copy()
    for f, values, group, acts in zip(families, coefficients, groups, acting, strict=True):
        if acts:
            held = pointed(point, f.name, columns[f.name].shape[1])
            force += columns[f.name][:, group] @ (values - held[group])
    return force


def pointed(point: Point, name: str, columns: int) -> FloatArray:
    """Return the coefficients of family `name` that the point already holds."""
    values = np.zeros(columns)
    if name == "recalibration":
        values = point.shape[:, 0:2].ravel()
    elif name == "shape":
        values = point.shape[:, 2:4].ravel()
    elif name == "deflection_offset":
        values = np.array([point.offset])
    elif name == "series_compliance":
        values[0] = -point.compliance
    elif name == "force_lag":
        values = np.zeros(columns)
        values[0] = -point.lag
    return values


def moved(point: Point, name: str, values: FloatArray, group: IndexArray) -> Point:
    """Return the point with the coefficients of family `name` taken up, as far as one step may go."""
    if name in ("recalibration", "shape"):
        shape = point.shape.copy()
        powers = slice(0, 2) if name == "recalibration" else slice(2, 4)
        old = shape[:, powers]
        shape[:, powers] = old + np.clip(values.reshape(old.shape) - old, -0.6, 0.6)
        return replace(point, shape=shape)
    if name == "deflection_offset":
        return replace(point, offset=point.offset + float(np.clip(values[0] - point.offset, -3e-3, 3e-3)))
    if name == "series_compliance":
        return replace(point, compliance=float(np.clip(-values[0], 0.0, point.compliance * 2.0 + 3e-6)))
    if name == "force_lag":
        if group[0] == 0:
            return replace(point, lag=float(np.clip(-values[0], 0.0, 2.0 * point.lag + 0.02)))
        # One of the finite lags: its coefficient is near -1 where it is the right one.
        lag, _ = LAGS[int(group[0]) - 1]
        return replace(point, lag=lag * float(np.clip(-values[0], 0.3, 1.5)))
    return point


@dataclass(frozen=True)
class Layout:
    """Where the columns of each family stand in the matrix, and its variants."""

    families: dict[str, Family]
    start: dict[str, int]
    count: dict[str, int]
    variants: dict[str, list[IndexArray]]

    def whole(self, name: str) -> IndexArray:
        """Return all column numbers of a family."""
        return np.arange(self.start[name], self.start[name] + self.count[name])


def layout_of(built: Sequence[Built], families: Sequence[Family]) -> Layout:
    """Return the layout of the families' columns."""
    start, count, variants, at = {}, {}, {}, 0
    for f in families:
        width = built[0].columns[f.name].shape[1]
        start[f.name], count[f.name] = at, width
        variants[f.name] = [np.asarray(v) + at for v in f.variants(width)]
        at += width
    return Layout({f.name: f for f in families}, start, count, variants)


def measure(
    built: Sequence[Built], noises: Sequence[Noise], families: Sequence[Family], point: Point
) -> Products:
    """Return the products of all columns, with the coefficients that the point holds given back to the data."""
    columns, data, along, along_data, parts = [], [], [], [], []
    for b, noise in zip(built, noises, strict=True):
        held = b.residual.copy()
        for f in families:
            values = pointed(point, f.name, b.columns[f.name].shape[1])
            if np.any(values):
                held += b.columns[f.name] @ values
        # The data go along as one more column, so that there is one to whiten where no family is asked.
        both = np.concatenate([*(b.columns[f.name] for f in families), held[:, None]], axis=1)
        white = noise.whitened(both)
        columns.append(white[:, :-1])
        data.append(white[:, -1])
        constant, part = noise.mean_drift
        along.append(constant @ columns[-1])
        along_data.append(constant @ data[-1])
        parts.append(part)
    plain = {
        f.name: sum(
            (
                b.columns[f.name].T @ b.columns[f.name] / n.level**2
                for b, n in zip(built, noises, strict=True)
            ),
            np.zeros(()),
        )
        for f in families
        if f.like_noise
    }
    p = discounted(
        products_of(np.concatenate(columns), np.concatenate(data)),
        np.stack(along),
        np.array(along_data),
        np.array(parts),
    )
    return replace(p, plain=plain)
