"""The quarter bicycle: rest, free fall, small oscillations and energies, each against its closed form."""

from types import ModuleType

import numpy as np
import pytest
from scipy.linalg import expm
from tirelab.errors import TirelabError
from tirelab.terrain import Ground, contact, flat, from_function, ground_from, iso8608, log, place, sine

GRAVITY = 9.80665
WHEEL = 0.33


@pytest.fixture(scope="module")
def model(example: dict[str, ModuleType]) -> ModuleType:
    return example["model"]


def flat_law(deflection: float, surface_radius: float) -> float:
    """Return the article's force on flat ground, F = 550.9 x^1.422, x in cm."""
    return float(550.9 * (100.0 * deflection) ** 1.422)


def flat_law_energy(deflection: np.ndarray) -> np.ndarray:
    """Return the energy in that tire [J]: 550.9 x^2.422 / 2.422 N cm."""
    energy: np.ndarray = 0.01 * 550.9 / 2.422 * (100.0 * np.maximum(deflection, 0.0)) ** 2.422
    return energy


def level() -> Ground:
    return ground_from(flat(20.0, 0.005))


def test_rest_on_flat_ground(model: ModuleType) -> None:
    bicycle = model.QuarterBicycle()
    state = model.at_rest(bicycle, level(), flat_law, 5.0)
    weight = (32.0 + 3.5) * GRAVITY
    assert WHEEL - state[2] == pytest.approx(0.01 * (weight / 550.9) ** (1.0 / 1.422), rel=1e-9)
    assert state[2] - state[0] == pytest.approx(32.0 * GRAVITY / 18e3, rel=1e-12)
    np.testing.assert_array_equal(state[[1, 3]], 0.0)
    np.testing.assert_allclose(bicycle.accelerations(state, weight), 0.0, atol=1e-9)


def test_fork_sags_as_its_makers_ask(model: ModuleType) -> None:
    sag = model.QuarterBicycle().sprung_mass * GRAVITY / model.QuarterBicycle().fork_stiffness
    assert 0.15 < sag / 0.100 < 0.30


def test_who_stands_still_stays(model: ModuleType) -> None:
    motion = model.integrate(
        model.QuarterBicycle(), model.Course(level(), 5.0, 1.0, 0.5), flat_law, samples=11
    )
    np.testing.assert_allclose(
        motion.states, np.broadcast_to(motion.states[0], motion.states.shape), atol=1e-8
    )
    assert motion.lift_offs.size == motion.landings.size == 0
    np.testing.assert_allclose(motion.radial_force, model.QuarterBicycle().weight, rtol=1e-6)


def test_free_fall_until_the_wheel_lands(model: ModuleType) -> None:
    """Both masses fall together, the fork hanging free: h = h0 - g t^2 / 2, until 5 cm are gone."""
    hub = WHEEL + 0.05
    motion = model.integrate(
        model.QuarterBicycle(),
        model.Course(level(), 3.0, 1.0, 0.15),
        flat_law,
        state=np.array([hub, 0.0, hub, 0.0]),
    )
    landing = np.sqrt(2.0 * 0.05 / GRAVITY)
    np.testing.assert_allclose(motion.landings, [landing], rtol=1e-9)
    falling = motion.time < landing
    np.testing.assert_allclose(
        motion.hub_height[falling], hub - 0.5 * GRAVITY * motion.time[falling] ** 2, atol=1e-12
    )
    assert np.all(motion.radial_force[falling] == 0.0)
    assert motion.radial_force.max() > 2.0 * model.QuarterBicycle().weight


def test_small_oscillations_are_those_of_the_linear_system(model: ModuleType) -> None:
    """About rest the tire is a spring of F B / x; ten micrometres of 7 mm bend its line by 0.03 %."""
    bicycle = model.QuarterBicycle()
    rest = model.at_rest(bicycle, level(), flat_law, 1.0)
    spring = bicycle.weight * 1.422 / (WHEEL - rest[2])
    k, c, m_s, m_u = bicycle.fork_stiffness, bicycle.fork_damping, bicycle.sprung_mass, bicycle.unsprung_mass
    linear = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-k / m_s, -c / m_s, k / m_s, c / m_s],
            [0.0, 0.0, 0.0, 1.0],
            [k / m_u, c / m_u, -(k + spring) / m_u, -c / m_u],
        ]
    )
    push = np.array([0.0, 0.0, 1e-5, 0.0])
    motion = model.integrate(
        bicycle,
        model.Course(level(), 2.0, 1.0, 0.2),
        flat_law,
        state=rest + push,
        samples=41,
        tolerance=1e-10,
    )
    expected = np.array([expm(linear * t) @ push for t in motion.time])
    largest = np.abs(expected).max(axis=0)
    np.testing.assert_allclose((motion.states - rest) / largest, expected / largest, atol=2e-3)


@pytest.mark.parametrize("speed", [3.0, 8.0])
def test_energy_is_accounted_for_over_a_log(model: ModuleType, speed: float) -> None:
    ground = ground_from(place(flat(10.0), log(0.05), 3.0), 0.002)
    motion = model.integrate(
        model.QuarterBicycle(), model.Course(ground, speed, 2.3, 1.8 / speed), flat_law, samples=401
    )
    moved = np.ptp(motion.energy)
    assert moved > 50.0
    assert motion.lift_offs.size >= 1
    # The integrator's own tolerance, 1e-7, over some thousand steps and the leaps of the contact.
    assert np.max(np.abs(motion.imbalance)) < 1e-5 * moved
    # What the rider pays goes into the fork's damper but for what is still in motion, and never comes back.
    assert np.all(np.diff(motion.damped) > -1e-7 * moved)
    assert motion.drive[-1] > 0.8 * motion.damped[-1]


def test_tire_gives_back_what_it_stored(model: ModuleType) -> None:
    """F ddeflection, summed along the way with the contact's angle, against the energy its deflection alone tells.

    Wavy ground keeps one contact; the two differ by the error of the sampled geometry.
    """
    ground = ground_from(sine(12.0, (0.02, 1.5), spacing=0.002), 0.002)
    motion = model.integrate(
        model.QuarterBicycle(), model.Course(ground, 5.0, 1.0, 0.4), flat_law, samples=201
    )
    energy = flat_law_energy(motion.deflection)
    assert energy.max() > 2.0
    np.testing.assert_allclose(motion.stored, energy - energy[0], atol=1e-4 * energy.max())


def test_tighter_tolerance_changes_nothing_that_matters(model: ModuleType) -> None:
    ground = ground_from(place(flat(8.0), log(0.05), 2.5), 0.002)
    loose, tight = (
        model.integrate(
            model.QuarterBicycle(),
            model.Course(ground, 5.0, 1.5, 0.4),
            flat_law,
            samples=201,
            tolerance=t,
        )
        for t in (1e-5, 1e-8)
    )
    np.testing.assert_allclose(loose.hub_height, tight.hub_height, atol=2e-6)


def test_a_slope_is_paid_for(model: ModuleType) -> None:
    """Uphill at a constant speed the drive lifts the weight, with the power W v tan(slope)."""
    grade, speed = 0.1, 4.0
    ground = ground_from(from_function(lambda s: grade * s, 6.0, 0.005))
    bicycle = model.QuarterBicycle()
    state = model.at_rest(bicycle, ground, flat_law, 1.0) + np.array([0.0, grade * speed, 0.0, grade * speed])
    motion = model.integrate(
        bicycle, model.Course(ground, speed, 1.0, 0.5), flat_law, state=state, samples=11
    )
    np.testing.assert_allclose(
        motion.drive, bicycle.weight * grade * speed * motion.time, rtol=1e-6, atol=1e-6
    )


def test_tire_too_soft_to_stand_on(model: ModuleType) -> None:
    with pytest.raises(TirelabError, match="does not carry 348 N"):
        model.at_rest(model.QuarterBicycle(), level(), lambda x, r: 100.0 * x, 1.0)


@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize(("look_ahead", "order"), [(0.0, 1.0), (None, 2.0)])
def test_stepped_ride_approaches_the_monolithic_one(
    example: dict[str, ModuleType], look_ahead: float | None, order: float, late: bool
) -> None:
    model, coupled = example["model"], example["coupled"]
    ground = ground_from(sine(8.0, (0.01, 1.5), spacing=0.002), 0.002)
    bicycle = model.QuarterBicycle()
    course = model.Course(ground, speed=4.0, start=1.0, duration=0.4)
    truth = model.integrate(bicycle, course, flat_law, samples=801)

    def tire(time: float, deflection: float, surface_radius: float) -> float:
        return flat_law(deflection, surface_radius) if deflection > 0.0 else 0.0

    errors = []
    for step in (0.002, 0.001, 0.0005):
        stepped = coupled.run(
            bicycle,
            course,
            tire,
            step=step,
            state=truth.states[0],
            coupling=coupled.Coupling(look_ahead, late),
        )
        at = np.round(stepped.time / 5e-4).astype(int)
        errors.append(np.sqrt(np.mean((stepped.states[:, 2] - truth.hub_height[at]) ** 2)))
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    # Halving the step halves, or quarters, the error; a tenth of it is still of the next order at 2 ms.
    np.testing.assert_allclose(rates, order, atol=0.25)
    assert errors[-1] < (5e-4 if order == 1.0 else 1e-5)


def test_held_force_is_integrated_exactly(example: dict[str, ModuleType]) -> None:
    """Two steps are one of twice the length, both masses fall, and scipy's matrix exponential says the same."""
    quarter = example["bicycle"].QuarterBicycle()
    once, twice = (example["bicycle"].held_step(quarter, h) for h in (0.01, 0.02))
    moved, pushed, fallen = map(np.array, (once.moved, once.pushed, once.fallen))
    np.testing.assert_allclose(moved @ moved, twice.moved, atol=1e-11)
    np.testing.assert_allclose(moved @ fallen + fallen, twice.fallen, atol=1e-12)
    np.testing.assert_allclose(moved @ pushed + pushed, twice.pushed, atol=1e-12)
    np.testing.assert_allclose(fallen[[0, 2]], -0.5 * GRAVITY * 1e-4, rtol=1e-9)
    k, c, m_s, m_u = 18e3, 0.5 * np.sqrt(18e3 * 32.0), 32.0, 3.5
    system = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-k / m_s, -c / m_s, k / m_s, c / m_s],
            [0.0, 0.0, 0.0, 1.0],
            [k / m_u, c / m_u, -k / m_u, -c / m_u],
        ]
    )
    # Velocities per metre are up to 200 1/s, of which the last digits go.
    np.testing.assert_allclose(moved, expm(0.01 * system), atol=1e-11)


def test_bad_step(example: dict[str, ModuleType]) -> None:
    with pytest.raises(TirelabError, match="step 0 s of a ride of 1 s"):
        example["coupled"].run(
            example["model"].QuarterBicycle(),
            example["model"].Course(level(), 1.0, 1.0, 1.0),
            lambda t, x, r: 0.0,
            step=0.0,
            state=np.zeros(4),
        )


def test_one_wheel_and_many_meet_the_ground_alike(example: dict[str, ModuleType]) -> None:
    """The scalar contact of the FMU against the vectorised one: the same formulas, so the same to a few last digits."""
    for ground in (
        ground_from(iso8608("E", 12.0, 3), 0.005),
        ground_from(place(flat(6.0), log(0.05), 3.0), 0.002),
    ):
        random = np.random.default_rng(7)
        position = random.uniform(1.0, 5.0, 400)
        below = np.interp(position, ground.s, ground.z)
        height = below + 0.33 + random.uniform(-0.06, 0.06, position.size)
        touch = contact(ground, position, height)
        track = example["model"].track_of(ground, 1.0, 5.0)
        met = [example["wheel"].meet(track, s, h, 0.33) for s, h in zip(position, height, strict=True)]
        assert {bool(m.deflection > 0.0) for m in met} == {True, False}
        np.testing.assert_allclose([m.deflection for m in met], touch.deflection, atol=1e-12)
        np.testing.assert_allclose([m.inclination for m in met], touch.inclination, atol=1e-11)
        # The curvature is a quotient of differences over a section of at least a centimetre.
        np.testing.assert_allclose(
            [1.0 / m.surface_radius for m in met], 1.0 / touch.surface_radius, atol=1e-9
        )
