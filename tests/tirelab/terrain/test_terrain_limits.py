"""Every limit of the article is raised by the ground that passes it, and by no other."""

import numpy as np
import pytest
from radialtire import TestedRange
from tirelab.terrain import (
    DOUBTS,
    Limit,
    Profile,
    contact,
    flat,
    from_function,
    ground_from,
    hub_positions,
    log,
    place,
    rolling_path,
    rut,
    sine,
    stick,
)
from tirelab.terrain.curvature import Ground
from tirelab.terrain.limits import SPREAD_LIMIT, limit_report, limits

WHEEL = 0.33


def flags(ground: Ground, position: float, deflection: float, force: float = 500.0) -> Limit:
    where = np.array([position])
    touch = contact(ground, where, rolling_path(ground, where) - deflection)
    return Limit(int(limits(touch, np.array([force]))[0]))


def test_flat_ground_is_in_no_doubt() -> None:
    assert flags(ground_from(flat(3.0)), 1.5, 0.02) == Limit(0)


def test_gentle_waves_are_in_no_doubt() -> None:
    ground = ground_from(sine(8.0, (0.05, 2.0)))
    path = hub_positions(ground)
    touch = contact(ground, path, rolling_path(ground) - 0.01)
    assert np.all(limits(touch, np.full(path.size, 500.0)) == 0)


def test_off_the_ground() -> None:
    assert flags(ground_from(flat(3.0)), 1.5, -0.01, 0.0) == Limit.AIRBORNE


def test_deflection_and_force_beyond_those_tested() -> None:
    ground = ground_from(flat(3.0))
    assert flags(ground, 1.5, 0.0318, 2239.0) == Limit.DEFLECTION_UNTESTED
    assert flags(ground, 1.5, 0.0317, 2241.0) == Limit.FORCE_UNTESTED


def test_smallest_bump_tested_is_no_edge_and_a_sharper_one_is() -> None:
    for radius, sharp in ((0.0135, False), (0.0115, True)):
        ground = ground_from(place(flat(4.0), stick(radius), 2.0), 0.0005)
        assert bool(flags(ground, 2.0, 0.001) & Limit.SHARP_EDGE) is sharp


@pytest.mark.parametrize("spacing", [0.01, 0.002])
@pytest.mark.parametrize(("degrees", "sharp"), [(25.0, True), (5.0, False)])
def test_corner_is_an_edge_however_finely_it_is_sampled(spacing: float, degrees: float, sharp: bool) -> None:
    slope = np.tan(np.radians(degrees) / 2.0)
    ground = ground_from(from_function(lambda s: -slope * np.abs(s - 1.5), 3.0, spacing), spacing)
    # A corner of 5 degrees is sharper than 1.27 cm when it is drawn within 2 mm, and an edge for that.
    sharp = sharp or bool(ground.curvature.max() > 1.0 / 0.0127)
    met = flags(ground, 1.5, 0.01)
    assert bool(met & Limit.SHARP_EDGE) is sharp
    assert met & Limit.DISCONTINUOUS_RADIUS


@pytest.mark.parametrize("spacing", [0.004, 0.001])
def test_radius_that_jumps(spacing: float) -> None:
    """A plane that goes over into a round hill of 25 cm without a corner: the curvature jumps by 4 /m."""

    def height(s: np.ndarray) -> np.ndarray:
        beyond = np.clip(s - 1.0, 0.0, 0.2)
        return np.where(s <= 1.2, np.sqrt(0.0625 - beyond**2) - 0.25, -0.1 - 4.0 / 3.0 * (s - 1.2))

    ground = ground_from(from_function(height, 2.0, spacing), spacing)
    met = flags(ground, 1.0, 0.005)
    assert met & Limit.DISCONTINUOUS_RADIUS
    assert not met & Limit.SHARP_EDGE
    assert flags(ground, 0.8, 0.005) == Limit(0)


def test_quick_change_is_not_a_jump_when_it_is_resolved() -> None:
    ground = ground_from(sine(4.0, (0.008, 0.5), spacing=0.002), 0.002)
    met = flags(ground, 1.95, 0.01)
    assert met & Limit.CHANGING_RADIUS
    assert not met & Limit.DISCONTINUOUS_RADIUS


def test_concave_radius_tighter_than_the_tightest_tested() -> None:
    for radius, tight in ((0.40, False), (0.36, True)):
        ground = ground_from(
            from_function(lambda s, r=radius: -np.sqrt(r**2 - (s - 0.34) ** 2), 0.68, 0.0005), 0.001
        )
        where = np.array([0.34])
        # A wheel of 20 cm, for one of 33 cm does not fit between the ends.
        touch = contact(ground, where, rolling_path(ground, where, 0.2) - 0.005, 0.2)
        assert bool(limits(touch, np.array([500.0]), 0.2)[0] & Limit.TIGHT_CONCAVE) is tight


def test_several_contacts() -> None:
    ground = ground_from(place(flat(4.0), rut(0.1, 0.3), 2.0), 0.002)
    assert flags(ground, 2.0, 0.005) & Limit.SEVERAL_CONTACTS
    log_and_ground = ground_from(place(flat(4.0), log(), 2.0))
    where = 2.0 - np.sqrt(0.43**2 - 0.23**2)
    assert flags(log_and_ground, where, 0.005) & Limit.SEVERAL_CONTACTS


def test_ground_data_coarser_than_the_contact() -> None:
    s = np.arange(0.0, 20.1, 0.5)
    coarse = ground_from(Profile(s, 0.05 * np.sin(s)), 0.01)
    assert flags(coarse, 10.0, 0.01) & Limit.COARSE_GROUND
    smoothed = ground_from(Profile(np.arange(0.0, 20.0, 0.01), np.zeros(2000), smoothing_length=1.0))
    assert flags(smoothed, 10.0, 0.01) == Limit.COARSE_GROUND
    fine = ground_from(Profile(np.arange(0.0, 20.0, 0.01), np.zeros(2000), smoothing_length=0.05))
    assert flags(fine, 10.0, 0.0001) == Limit(0)


def articles_force(deflection: float, curvature: np.ndarray, decay: float) -> np.ndarray:
    """Return equations 2, 5 and 6 as printed, `decay` being the constant of 5a [1/cm]."""
    with np.errstate(divide="ignore"):
        radius = 100.0 / curvature
    convex = np.maximum(radius, 0.0)
    concave = np.minimum(radius, 0.0)
    a = np.where(
        radius > 0.0, 550.9 - 337.8 * np.exp(-decay * convex), 550.9 + 7822.0 * np.exp(0.1398 * concave)
    )
    b = np.where(
        radius > 0.0, 1.422 - 0.2469 * np.exp(-0.1651 * convex), 1.422 + 0.2128 * np.exp(0.0289 * concave)
    )
    force: np.ndarray = a * (100.0 * deflection) ** b
    return force


@pytest.mark.parametrize(("decay", "bound"), [(0.2519, 0.135), (0.02519, 0.21)])
def test_spread_limit_is_where_the_law_feels_its_own_error(decay: float, bound: float) -> None:
    """Over everything tested, the ends of a contact at the limit differ in force by at most the article's 13.5 %."""
    worst = 0.0
    for mean in np.concatenate([np.linspace(-2.5, 2.5, 101), np.geomspace(2.5, 75.0, 101)]):
        half = 0.5 * SPREAD_LIMIT * (1.0 / WHEEL + mean)
        ends = mean + half * np.array([-1.0, 1.0])
        if ends[0] < -1.0 / 0.381 or ends[1] > 1.0 / 0.0127:
            continue
        for deflection in (0.005, 0.0127, 0.02, 0.03175):
            force = articles_force(deflection, np.array([ends[0], mean, ends[1]]) + 1e-12, decay)
            worst = max(worst, float(np.max(np.abs(force / force[1] - 1.0))))
    assert 0.8 * bound < worst <= bound


def test_report() -> None:
    bits = np.array([0, 1, 1 | 4, 0, 256, 0, 0, 0, 0, 0], dtype=np.uint16)
    report = limit_report(bits, 12.0)
    assert report.share(Limit.SHARP_EDGE) == pytest.approx(0.2)
    assert report.share(Limit.CHANGING_RADIUS) == pytest.approx(0.1)
    assert report.share(Limit.AIRBORNE) == pytest.approx(0.1)
    assert report.doubtful == pytest.approx(0.2)
    words = report.sentences()
    assert words[0] == "The article's model cannot be trusted along 20.0 % of the 12.0 m ridden:"
    assert words[1].startswith("20.0 % sharp edge")
    assert len(words) == 4


def test_report_of_a_ride_without_doubt() -> None:
    assert limit_report(np.zeros(5, dtype=np.uint16), 3.0).sentences() == (
        "The article's model holds along all of the 3.0 m ridden.",
    )
    airborne = limit_report(np.full(4, Limit.AIRBORNE.value, dtype=np.uint16), 3.0)
    assert airborne.doubtful == 0.0
    assert len(airborne.sentences()) == 2


def test_a_little_doubt_is_never_rounded_to_none() -> None:
    bits = np.zeros(10_000, dtype=np.uint16)
    bits[0] = Limit.SHARP_EDGE.value
    assert "less than 0.1 %" in limit_report(bits, 100.0).sentences()[0]


def test_only_the_air_is_no_doubt() -> None:
    assert Limit(sum(Limit)) == DOUBTS | Limit.AIRBORNE
    assert not DOUBTS & Limit.AIRBORNE


def test_a_tires_own_range_is_what_counts() -> None:
    """On a crest of 3.3 m (0.3 /m): outside a range of flat ground, within one to 1 m; and ground of 100 m is flat."""
    flat_alone, to_a_metre = TestedRange(-1e-5, 1e-5, 0.02, 600.0), TestedRange(-1e-5, 1.0, 0.02, 600.0)

    def met(height: float, tested: TestedRange | None, deflection: float = 0.01) -> Limit:
        ground = ground_from(sine(8.0, (height, 2.0)))
        where = np.array([2.5])  # a crest
        touch = contact(ground, where, rolling_path(ground, where) - deflection)
        return Limit(int(limits(touch, np.array([500.0]), WHEEL, tested)[0]))

    assert met(0.03, flat_alone) == Limit.SURFACE_UNTESTED
    assert met(0.03, to_a_metre) == Limit(0)
    assert met(0.001, flat_alone) == Limit(0)
    assert met(0.03, to_a_metre, 0.021) == Limit.DEFLECTION_UNTESTED
    assert met(0.03, None, 0.021) == Limit(0)


def test_an_edge_is_sharper_than_any_ground_tested() -> None:
    ground = ground_from(place(flat(4.0), stick(0.0115), 2.0), 0.0005)
    where = np.array([2.0])
    touch = contact(ground, where, rolling_path(ground, where) - 0.001)
    on_sticks = TestedRange(-1e-5, 1.0 / 0.008, 0.02, 600.0)
    assert limits(touch, np.array([50.0]))[0] & Limit.SHARP_EDGE
    assert not limits(touch, np.array([50.0]), WHEEL, on_sticks)[0] & Limit.SHARP_EDGE
    words = limit_report(np.array([Limit.SHARP_EDGE.value]), 3.0, on_sticks).sentences()
    assert words[0].startswith(
        "This tire was measured to 2 cm and 600 N on ground that is flat to 0.8 cm convex;"
    )
    assert words[1] == "100.0 % sharp edge in contact (radius below 0.8 cm, or a corner)"
