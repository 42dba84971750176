"""Rides: the path under a load against the law solved by hand, and what cannot be ridden."""

from pathlib import Path

import numpy as np
import pytest
from radialtire import CATALOGUE, PowerLaw, TireModel
from tirelab.errors import TirelabError
from tirelab.terrain import (
    HubPath,
    Limit,
    flat,
    force_at,
    from_function,
    ground_from,
    hub_positions,
    iso8608,
    log,
    place,
    ride,
    rolling_path,
    sine,
    write_ride,
)
from tirelab.terrain.profile import Floats

WHEEL = 0.33


def flat_law(deflection: Floats, surface_radius: Floats) -> Floats:
    """Return the article's force on flat ground, F = 550.9 x^1.422, x in cm."""
    force: Floats = 550.9 * (100.0 * deflection) ** 1.422
    return force


def radius_law(deflection: Floats, surface_radius: Floats) -> Floats:
    """Return a law that is softer on bumps and stiffer in dips, of no tire."""
    force: Floats = 550.9 * (100.0 * deflection) ** 1.422 * np.exp(-0.05 / surface_radius)
    return force


@pytest.mark.parametrize("grade", [0.0, 0.3])
def test_load_on_a_plane(grade: float) -> None:
    """On a grade the force is normal to the ground: its upward part is F cos, so F = load / cos."""
    ground = ground_from(from_function(lambda s: grade * s, 4.0))
    result = ride(ground, flat_law, speed=5.0, load=600.0)
    force = 600.0 * np.hypot(1.0, grade)
    np.testing.assert_allclose(result.radial_force, force, rtol=1e-5)
    np.testing.assert_allclose(result.contact.deflection, 0.01 * (force / 550.9) ** (1.0 / 1.422), rtol=1e-5)
    np.testing.assert_allclose(result.vertical_force, 600.0, rtol=1e-5)
    np.testing.assert_allclose(result.horizontal_force, -600.0 * grade, rtol=1e-5, atol=1e-6)
    assert result.time[-1] == pytest.approx(np.ptp(result.contact.position) / 5.0)
    assert result.report.doubtful == 0.0


@pytest.mark.parametrize("road_class", ["C", "E"])
def test_load_on_rough_ground_is_carried_everywhere(road_class: str) -> None:
    ground = ground_from(iso8608(road_class, 60.0, 3))
    result = ride(ground, radius_law, speed=5.0, load=500.0)
    carried = np.abs(result.vertical_force / 500.0 - 1.0) < 1e-4
    # Where contact leaps from place to place there may be no such height; those moments are rare and flagged.
    assert np.mean(carried) > 0.999
    assert np.all(result.limits[~carried] != 0)


def test_load_over_a_log_holds_back_first_and_pushes_then() -> None:
    result = ride(ground_from(place(flat(4.0), log(), 2.0)), flat_law, speed=3.0, load=500.0)
    forward, position = result.horizontal_force, result.contact.position
    assert forward[position < 1.9].min() < -400.0
    assert forward[position > 2.1].max() > 400.0
    # A wheel sunk by 9.3 mm touches the log first where the cosine is (Rw - 9.3 mm - R) / (Rw + R): 59.1 degrees.
    steepest = np.degrees(np.max(np.abs(result.contact.inclination)))
    assert 57.0 < steepest < 59.2


def test_path_that_is_given() -> None:
    ground = ground_from(flat(4.0))
    position = np.linspace(0.5, 3.5, 31)
    hub = WHEEL - 0.01 * np.cos(position)
    result = ride(ground, flat_law, speed=2.0, hub_path=HubPath(hub, position))
    np.testing.assert_allclose(result.contact.deflection, 0.01 * np.cos(position), atol=1e-12)
    lifted = np.cos(position) <= 0.0
    assert np.all(result.radial_force[lifted] == 0.0)
    np.testing.assert_allclose(
        result.radial_force[~lifted], 550.9 * np.cos(position[~lifted]) ** 1.422, rtol=1e-9
    )
    np.testing.assert_array_equal((result.limits & Limit.AIRBORNE) != 0, lifted)
    np.testing.assert_allclose(result.time, (position - 0.5) / 2.0)
    np.testing.assert_allclose(result.rolling_height, WHEEL)


def test_force_is_asked_with_the_mean_radius_and_only_on_the_ground() -> None:
    asked: list[tuple[Floats, Floats]] = []

    def spy(deflection: Floats, surface_radius: Floats) -> Floats:
        asked.append((deflection, surface_radius))
        return np.full(deflection.size, 7.0)

    ground = ground_from(sine(8.0, (0.05, 2.0)))
    hub = np.full(hub_positions(ground).size, WHEEL + 0.04)
    result = ride(ground, spy, speed=1.0, hub_path=HubPath(hub))
    assert np.all(asked[0][0] > 0.0)
    loaded = result.contact.deflection > 0.0
    assert asked[0][0].size == np.count_nonzero(loaded) < loaded.size
    # Only the crests reach the wheel: 0.05 (2 pi / 2)^2 /m, of which the mean over a contact of 16 cm lacks 1 %.
    assert asked[0][1].min() == pytest.approx(1.0 / (0.05 * np.pi**2) / 0.99, rel=2e-3)
    assert np.all(result.radial_force == np.where(loaded, 7.0, 0.0))


def test_wheel_that_never_lands() -> None:
    ground = ground_from(flat(3.0))
    result = ride(ground, flat_law, speed=1.0, hub_path=HubPath(np.full(hub_positions(ground).size, 1.0)))
    assert np.all(result.radial_force == 0.0)
    assert result.report.share(Limit.AIRBORNE) == 1.0


def test_what_cannot_be_ridden() -> None:
    ground = ground_from(flat(3.0))
    height = np.full(hub_positions(ground).size, 0.32)
    with pytest.raises(TirelabError, match="speed 0 m/s"):
        ride(ground, flat_law, speed=0.0, load=500.0)
    with pytest.raises(TirelabError, match="load -1 N"):
        ride(ground, flat_law, speed=1.0, load=-1.0)
    with pytest.raises(TirelabError, match="give one of the two"):
        ride(ground, flat_law, speed=1.0)
    with pytest.raises(TirelabError, match="give one of the two"):
        ride(ground, flat_law, speed=1.0, load=500.0, hub_path=HubPath(height))
    with pytest.raises(TirelabError, match=r"the tire cannot carry 1e\+06 N at s = 0\.\d+ m"):
        ride(ground, flat_law, speed=1.0, load=1e6)
    with pytest.raises(TirelabError, match=r"the hub goes backwards after s = 1\.5 m"):
        ride(ground, flat_law, speed=1.0, hub_path=HubPath(np.full(3, 0.33), np.array([1.0, 1.5, 1.4])))
    with pytest.raises(TirelabError, match="the tire's force is not a number at s = "):
        ride(ground, lambda x, r: np.full(x.size, np.nan), speed=1.0, hub_path=HubPath(height))


def test_load_path_stands_on_the_rolling_path_when_the_tire_is_stiff() -> None:
    ground = ground_from(iso8608("B", 30.0, 1))
    result = ride(ground, lambda x, r: 1e9 * x, speed=1.0, load=500.0)
    # 500 N at 1e9 N/m: half a micrometre, below the error of the rolling path itself.
    np.testing.assert_allclose(result.contact.hub_height, rolling_path(ground), atol=2e-6)


def test_a_ride_on_a_tire_has_its_law_and_is_written(tmp_path: Path) -> None:
    # F = 550.9 x^1.422 is 550.9 N at 1 cm on flat ground; at 1 kN on 1500 N/cm the tire is pressed by 2/3 cm
    result = ride(ground_from(flat(4.0)), TireModel(), speed=2.0, load=550.9)
    np.testing.assert_allclose(result.contact.deflection, 0.01, rtol=1e-6)
    soft = ride(ground_from(flat(4.0)), TireModel(law=PowerLaw(1500.0, 1.0)), speed=2.0, load=1000.0)
    np.testing.assert_allclose(soft.contact.deflection, 2.0 / 300.0, rtol=1e-6)
    write_ride(soft, tmp_path / "soft.csv")
    table = np.genfromtxt(tmp_path / "soft.csv", delimiter=",", skip_header=1)
    np.testing.assert_allclose(table[:, 3], soft.contact.deflection, rtol=1e-8)
    np.testing.assert_allclose(table[:, 0], 0.5 * (table[:, 1] - table[0, 1]), atol=1e-8)
    with pytest.raises(TirelabError, match=r"absent.*; name a file that can be written"):
        write_ride(soft, tmp_path / "absent" / "soft.csv")


def test_a_tire_of_half_the_pressure_sinks_in_deeper() -> None:
    """Of a thin toroid F is in proportion to p: half the pressure needs 2^(1/B) of the deflection for the same load."""
    effect = CATALOGUE["inflation_pressure"]
    tire = TireModel(PowerLaw(500.0, 1.4), ((effect, (1.0, 3e5, 1.0)),))
    ground = ground_from(flat(4.0))
    depths = [
        float(ride(ground, force_at(tire, {"pressure": p}), speed=5.0, load=500.0).contact.deflection[5])
        for p in (3e5, 1.5e5)
    ]
    assert depths[0] == pytest.approx(0.01, rel=1e-5)
    assert depths[1] / depths[0] == pytest.approx(2.0 ** (1.0 / 1.4), rel=1e-5)


def test_a_tire_that_says_nothing_of_the_pressure_is_not_ridden_at_one() -> None:
    with pytest.raises(TirelabError, match="does not say how its force depends on the pressure"):
        force_at(TireModel(), {"pressure": 3e5})
