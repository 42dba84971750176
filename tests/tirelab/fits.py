"""Fits of known effects to a simulated ride, without the search before them."""

from __future__ import annotations

import numpy as np
from drives import Drive, read, ride
from radialtire import CATALOGUE, TireModel
from tirelab.engine.refit import Case, Refit, refit
from tirelab.engine.scene import Scene, scene_of
from tirelab.preprocessing.dataset import dataset_of
from tirelab.preprocessing.noise_model import Noise
from tirelab.simulation.simulate import simulate, smoothed_motion

BARE = TireModel()
NOISE = 5.0
"""[N]"""


def with_effect(name: str, **values: float) -> TireModel:
    """Return the article's tire with one effect, its parameters at their start but for `values`."""
    effect = CATALOGUE[name]
    return TireModel(effects=((effect, tuple(values.get(p.name, p.start) for p in effect.parameters)),))


def ridden(seed: int, tire: TireModel) -> Drive:
    """Return the recording of a ride on a tire, with NOISE."""
    time, deflection, _ = ride(seed)
    bare = read("ride", time, deflection, np.zeros(time.size), seed, noise=0.0)
    return read("ride", time, deflection, simulate(tire, bare), seed, noise=NOISE)


def fitted(recording: Drive, tire: TireModel, names: list[str]) -> tuple[Refit, list[Case], Scene]:
    """Return the fit of the effects `names`, those of `tire` and others that are not there, its cases and scene."""
    scene = scene_of(dataset_of([recording], BARE))
    (record,) = scene.records
    ones = np.ones(record.rows.size)
    noise = Noise(NOISE, NOISE, np.ones(1), ones, ones)
    smooth = smoothed_motion(recording, record.motion)
    cases = [Case(recording, smooth, recording.force, noise, record.rows, 0.0 * ones)]
    elastic = simulate(BARE, recording)[record.rows]
    part = simulate(tire, recording)[record.rows] - elastic
    own = [e.name for e, _ in tire.effects]
    parts = {n: [part if n in own else -1e-3 * elastic] for n in names}
    found = refit(BARE, names, parts, np.zeros((1, 2)), cases, scene.radii, scene.deepest, scene.highest)
    return found, cases, scene
