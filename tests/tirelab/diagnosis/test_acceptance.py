"""The correction judged on held-out data.

What is delivered is never worse than something simpler: each guarantee is broken on purpose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drives import Drive, damped, flat_force
from radialtire import CATALOGUE, TireModel
from tirelab.diagnosis.acceptance import CONSIDERED, accept, without_unlikely
from tirelab.diagnosis.held_out import HeldOut, Part, validation_on
from tirelab.names import REFITTED_LAW
from tirelab.preprocessing.samples import raw_dataset_of
from tirelab.regressors.excitation import Excitation

FITTED, KEPT = damped(1, samples=2000), damped(2, samples=2000)
BARE = damped(3, damping=0.0, samples=2000)
"""A ride on the baseline tire: any damping is wrong on it."""


def damper(damping: float) -> TireModel:
    return TireModel(effects=((CATALOGUE["viscous_damping"], (damping, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)),))


@dataclass(frozen=True)
class Made:
    """An explanation by hand: names and what the written tire leaves [N], as read and with noise-free deflection."""

    names: tuple[str, ...]
    left: float
    tire: TireModel
    left_noise_free: float = field(default=0.0, kw_only=True)
    odds: tuple[tuple[tuple[str, ...], float], ...] = field(default=(((), 0.0),), kw_only=True)

    @property
    def evidence(self) -> list[Any]:
        return [SimpleNamespace(names=names, log_evidence=value) for names, value in self.odds]

    @property
    def effects(self) -> tuple[str, ...]:
        return self.names

    @property
    def model(self) -> Any:
        return SimpleNamespace(tire=self.tire, baseline=TireModel(), names=self.names)

    def with_parts(self) -> Made:
        return self

    @property
    def residuals(self) -> tuple[Any, ...]:
        return (np.full(FITTED.time.size, self.left),)

    @property
    def compared(self) -> tuple[Any, ...]:
        return (np.ones(FITTED.time.size, dtype=bool),)

    @property
    def error(self) -> float:
        return self.left

    @property
    def error_left(self) -> float:
        return self.left_noise_free

    @property
    def noise_free(self) -> tuple[Any, ...]:
        return (np.full(FITTED.time.size, self.left_noise_free),)


@dataclass(frozen=True)
class Ranked:
    """Explanations, the likeliest first, of recordings on so many surfaces; near: whether all are nearly as likely."""

    sets: tuple[Made, ...]
    surfaces: int = 1
    near: bool = False

    @property
    def excitation(self) -> Excitation:
        return Excitation(0.0, 1.0, surfaces=self.surfaces)

    def was_fitted(self, names: Sequence[str]) -> bool:
        return any(set(s.names) == set(names) for s in self.sets)

    def is_near(self, names: Sequence[str], other: Sequence[str]) -> bool:
        return self.was_fitted(names) and self.near

    def in_order(self, most: int) -> list[tuple[str, ...]]:
        return [s.names for s in self.sets[:most]]

    def of(self, names: Sequence[str]) -> Made:
        return next(s for s in self.sets if set(s.names) == set(names))


def made(names: str, left: float, damping: float = 0.0, *, part: bool = False) -> Made:
    tire = damper(damping) if damping else TireModel()
    return Made(tuple(names.split()), left, replace(tire, two_sided=part))


def delivered(*sets: Made, held_out: Drive = KEPT, surfaces: int = 1, near: bool = False) -> Any:
    before = [FITTED.force - flat_force(FITTED.deflection)]
    ranked: Any = Ranked(sets, surfaces, near)
    return accept(ranked, validation_on([FITTED], [held_out], raw_dataset_of([FITTED], TireModel()), before))


def test_the_likeliest_set_is_delivered() -> None:
    chosen, held_out = delivered(
        made("viscous_damping", 5.0, 500.0), made("inertia", 5.0, 400.0), made("", 15.0)
    )
    assert chosen.names == ("viscous_damping",)
    # The damping with which the held-out ride was made leaves its noise of 5 N, and that of the reading's rate.
    assert held_out.noise_free == pytest.approx(5.0, rel=0.05)
    assert held_out.after < 0.5 * held_out.before


@pytest.mark.parametrize(("left", "names"), [(5.2, ("inertia", "force_lag")), (10.0, ("viscous_damping",))])
def test_a_set_that_leaves_clearly_more_than_a_smaller_one_is_refused(
    left: float, names: tuple[str, ...]
) -> None:
    chosen, _ = delivered(
        made("inertia force_lag", left, 500.0), made("viscous_damping", 5.0, 500.0), made("", 15.0)
    )
    assert chosen.names == names


@pytest.mark.parametrize(("with_damping", "names"), [(4.1, ("inertia",)), (3.9, ("viscous_damping",))])
def test_the_noise_of_the_reading_refutes_no_effect_that_magnifies_it(
    with_damping: float, names: tuple[str, ...]
) -> None:
    """Inertia leaves 6 N where it is given the acceleration of a noisy reading, and 4 N without that noise."""
    inertia = replace(made("inertia", 6.0, 500.0), left_noise_free=4.0)
    damping = replace(made("viscous_damping", 5.0, 500.0), left_noise_free=with_damping)
    chosen, _ = delivered(inertia, damping, made("", 15.0))
    assert chosen.names == names


def test_a_set_gives_way_to_the_one_that_leaves_less_and_not_to_a_likelier_smaller_one_that_leaves_more() -> (
    None
):
    chosen, _ = delivered(
        made("inertia force_lag", 6.0, 500.0),
        made("inertia", 9.0, 500.0),
        made("viscous_damping force_lag", 5.0, 500.0),
        made("viscous_damping", 12.0, 500.0),
        made("", 15.0),
    )
    assert chosen.names == ("viscous_damping", "force_lag")


def test_a_set_that_leaves_more_than_a_larger_one_is_not_refused() -> None:
    chosen, _ = delivered(
        made("viscous_damping", 6.0, 500.0), made("inertia force_lag", 5.0, 500.0), made("", 15.0)
    )
    assert chosen.names == ("viscous_damping",)


def test_a_set_that_is_worse_than_the_baseline_on_held_out_data_is_refused() -> None:
    chosen, held_out = delivered(made("viscous_damping", 5.0, 500.0), made("", 15.0), held_out=BARE)
    assert chosen.names == ()
    assert held_out.after == held_out.before == pytest.approx(5.0, rel=0.05)


def test_in_the_place_of_a_refused_set_comes_the_next_one() -> None:
    chosen, _ = delivered(
        made("viscous_damping", 5.0, 5000.0), made("inertia", 5.0, 500.0), made("", 15.0), held_out=KEPT
    )
    assert chosen.names == ("inertia",)


LAW_AND_DAMPER = {REFITTED_LAW, "viscous_damping"}


@pytest.mark.parametrize(
    ("part", "near", "surfaces", "names"),
    [
        (True, True, 1, LAW_AND_DAMPER),  # the law alone is nearly as likely as with the spring
        (True, False, 1, LAW_AND_DAMPER | {"series_compliance"}),  # no law follows what the spring does
        (True, True, 2, LAW_AND_DAMPER | {"series_compliance"}),  # two surfaces tell a spring from a law
        (
            False,
            True,
            1,
            LAW_AND_DAMPER | {"series_compliance"},
        ),  # a tire's law has the shape that was measured
    ],
)
def test_on_one_surface_a_static_effect_stands_beside_the_law_of_a_part_only_where_no_law_does_it(
    part: bool, near: bool, surfaces: int, names: set[str]
) -> None:
    together = made(f"{REFITTED_LAW} series_compliance viscous_damping", 5.0, 500.0, part=part)
    plain = made(f"{REFITTED_LAW} viscous_damping", 5.2, 500.0, part=part)
    chosen, _ = delivered(together, plain, made("", 15.0), surfaces=surfaces, near=near)
    assert set(chosen.names) == names


def test_nothing_is_always_accepted() -> None:
    chosen, held_out = delivered(made("", 15.0), made("viscous_damping", 5.0, 500.0))
    assert chosen.names == ()
    assert held_out.after == held_out.before
    wrong = [made(name, 5.0, 5000.0) for name in list(CATALOGUE)[: CONSIDERED + 2]]
    assert delivered(*wrong, made("", 15.0))[0].names == ()


def foretold(before: float, after: float, by: str = "time block 9-12 s") -> HeldOut:
    """A quarter of 80 samples was held out."""
    experiment = raw_dataset_of([FITTED], TireModel()).experiments[0]

    def part(samples: int) -> Part:
        each = np.ones(samples)
        return Part(experiment, before * each, after * each, after * each, each > 0.0)

    return HeldOut(by, (part(60),), (part(20),))


@pytest.mark.parametrize(
    ("behind", "after", "names"),
    [
        (4.0, 5.0, ("inertia",)),  # 30 samples / 4 x ln 2 = 5.2, more than by how much it is less likely
        (6.0, 5.0, ()),
        (4.0, 9.0, ()),
        (0.5, 9.0, ("inertia",)),
    ],
)
def test_where_the_likeliest_set_is_refused_what_is_foretold_counts_against_the_baseline_too(
    behind: float, after: float, names: tuple[str, ...]
) -> None:
    sets = [made("viscous_damping", 5.0), made("", 15.0), made("inertia", 5.0), made("force_lag", 5.0)]
    sets[1] = replace(sets[1], odds=(((), 0.0), (("inertia",), -behind), (("force_lag",), -behind)))
    of = {"viscous_damping": 20.0, "": 10.0, "inertia": after, "force_lag": 9.9}
    ranked: Any = Ranked(tuple(sets))
    assert accept(ranked, lambda e: foretold(10.0, of[" ".join(e.model.names)]))[0].model.names == names
    given = accept(ranked, lambda e: foretold(10.0, of[" ".join(e.model.names)], "recordings given"))
    assert given[0].model.names == ()


@pytest.mark.parametrize("left", [30.0, 15.2])
def test_what_is_worse_than_nothing_where_it_was_fitted_is_refused_however_unlikely_nothing_is(
    left: float,
) -> None:
    worse = [made(name, left, 500.0) for name in list(CATALOGUE)[: CONSIDERED + 2]]
    assert delivered(*worse, made("", 15.0))[0].names == ()


@dataclass(frozen=True)
class Accepted(Made):
    """The set that was accepted, among all that were fitted."""

    ranked: Ranked

    def was_fitted(self, names: Sequence[str]) -> bool:
        return self.ranked.was_fitted(names)

    def of(self, names: Sequence[str]) -> Made:
        found = self.ranked.of(names)
        return accepted(found, self.ranked)


def accepted(one: Made, ranked: Ranked) -> Accepted:
    return Accepted(one.names, one.left, one.tire, ranked, left_noise_free=one.left_noise_free)


def likely_part(held_out: Drive, *sets: Made, **probabilities: float) -> set[str]:
    """Return what is named of the first of the sets."""

    first: Any = accepted(sets[0], Ranked(sets))
    before = [FITTED.force - flat_force(FITTED.deflection)]
    validate = validation_on([FITTED], [held_out], raw_dataset_of([FITTED], TireModel()), before)
    return set(without_unlikely(first, validate(first), probabilities, validate)[0].names)


PAIR = made("viscous_damping bottoming", 5.0, 500.0)
ALONE = made("viscous_damping", 5.2, 500.0)


def test_an_effect_that_is_less_likely_than_not_is_not_named() -> None:
    assert likely_part(KEPT, PAIR, ALONE, viscous_damping=0.99, bottoming=0.4) == {"viscous_damping"}
    assert likely_part(KEPT, PAIR, ALONE, viscous_damping=0.99, bottoming=0.6) == set(PAIR.names)


def test_an_effect_without_which_no_more_is_left_is_not_named_however_likely_it_is() -> None:
    """A ceiling of the force, say, that a better optimum of the others does without."""
    better, elsewhere = made("viscous_damping", 4.9, 500.0), made("viscous_damping", 4.9, 430.0)
    assert likely_part(KEPT, PAIR, better, viscous_damping=0.99, bottoming=0.9) == {"viscous_damping"}
    # Held-out data tell that it is needed.
    assert likely_part(KEPT, PAIR, elsewhere, viscous_damping=0.99, bottoming=0.9) == set(PAIR.names)


def test_an_effect_that_magnifies_the_noise_of_the_reading_is_not_needless_for_that() -> None:
    """A mass leaves more where it is given the acceleration of a noisy reading, and half without that noise."""
    pair = replace(made("viscous_damping inertia", 5.0, 500.0), left_noise_free=2.0)
    alone = replace(made("viscous_damping", 4.9, 500.0), left_noise_free=4.0)
    assert likely_part(KEPT, pair, alone, viscous_damping=0.99, inertia=0.9) == set(pair.names)


def test_an_unlikely_effect_is_named_where_the_others_leave_clearly_more() -> None:
    poor = made("viscous_damping", 9.0, 500.0)
    assert likely_part(KEPT, PAIR, poor, viscous_damping=0.99, bottoming=0.4) == set(PAIR.names)


def test_an_unlikely_effect_is_named_where_the_set_without_it_was_not_fitted() -> None:
    assert likely_part(KEPT, PAIR, viscous_damping=0.99, bottoming=0.4) == set(PAIR.names)


def test_an_unlikely_effect_is_named_where_the_others_are_worse_than_nothing_on_held_out_data() -> None:
    wrong = made("viscous_damping", 5.2, 5000.0)
    assert likely_part(KEPT, PAIR, wrong, viscous_damping=0.99, bottoming=0.4) == set(PAIR.names)


def test_of_several_unlikely_effects_the_least_likely_go_first() -> None:
    only_bottoming = made("bottoming", 5.2, 500.0)
    found = likely_part(KEPT, PAIR, only_bottoming, ALONE, made("", 15.0), viscous_damping=0.2, bottoming=0.4)
    assert found == {"bottoming"}
