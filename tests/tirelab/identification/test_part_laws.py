"""Each law is found from what it makes itself, and the one that made the readings is the first."""

import numpy as np
import pytest
from part_readings import BOTH, MADE, X, recording
from tirelab.errors import TirelabError
from tirelab.identification.both_ways import loop_state
from tirelab.identification.part_laws import fit_laws
from tirelab.identification.table import law_table, with_uncertainty
from tirelab.recordings.recording import Recording


@pytest.mark.parametrize("start", [-0.05, -0.02])
def test_a_part_that_is_only_pulled_has_its_line_too(start: float) -> None:
    """A gauge whose zero is above the whole stroke: no deflection is positive, and half of the largest was not seen."""
    x = np.linspace(start, start + 0.015, 600)
    fits = {fit.name: fit for fit in fit_laws([recording(x, 30.0 + 2e4 * x)])}
    assert fits["linear"].rmse == pytest.approx(2.0, rel=0.08)
    assert fits["linear"].value("k") == pytest.approx(20.0, rel=0.01)
    assert fits["linear"].value("F0") == pytest.approx(30.0, abs=4.0)
    assert all(np.isfinite(fit.rmse) for fit in fits.values())
    # the laws with a gap have no force here, so nothing determines their constants
    assert law_table(tuple(fits.values())).row_count == len(fits)
    assert with_uncertainty(0.0, 0.0) == "0 ± 0"
    assert "00000" not in with_uncertainty(1.3e27, 1.6e28)
    assert with_uncertainty(1234567.0, 25000.0) == "1235000 ± 25000"
    assert with_uncertainty(8550760.0, 4.2) == "8550760 ± 4"
    # A in N/cm^B of a steep power of a large deflection
    assert with_uncertainty(1.2346e-66, 5.6e-68) == "(1.235 ± 0.056)·10⁻⁶⁶"
    assert with_uncertainty(1.3e27, 1.6e28) == "1.3·10²⁷ ± 1.6·10²⁸"
    assert with_uncertainty(3e-9, 1e-17) == "3·10⁻⁹ ± 1·10⁻¹⁷"
    assert len(with_uncertainty(5e-324, 5e-324)) < 60


def test_the_corners_of_a_curve_do_not_lie_in_holds() -> None:
    """Ninety-five of a hundred samples are read in three holds, whose gauge has a noise of 0.01 mm."""
    way = np.linspace(0.0, 0.02, 300)
    holds = np.repeat([0.005, 0.01, 0.015], 1900) + np.random.default_rng(1).normal(0.0, 1e-5, 5700)
    x = np.concatenate([way, holds])
    found = {fit.name: fit for fit in fit_laws([recording(x, 1e4 * x + 3e5 * x**2)])}["piecewise"]
    between = np.diff(found.at)
    assert len(found.at) > 5
    assert between.max() < 3.0 * between.min()


def test_a_curve_has_its_corners_where_the_force_changes() -> None:
    """A rod that yields after a hundredth of its way: 15 kN there, 19 kN at the end, and 1 N of noise."""
    x = np.linspace(0.0, 0.01, 5000)
    force = np.minimum(1.5e8 * x, 1.5e4 + 4e5 * (x - 1e-4)) + np.random.default_rng(3).normal(
        0.0, 1.0, x.size
    )
    found = {fit.name: fit for fit in fit_laws([recording(x, force)])}["piecewise"]
    # Corners every tenth of the way miss the yield by 2.4 kN over a part of it: more than 300 N of all.
    assert found.rmse < 60.0
    assert found.at[1] == pytest.approx(1e-4, rel=0.05)


def test_a_curve_is_the_middle_of_a_loop_at_its_turns_too() -> None:
    """Dry friction of 20 N and a fifth of the force, which turns within 0.2 mm: 120 N to either side at the top.

    Lines through all samples are off by half of that there, and 2 N of noise move ten lines by less than 1 N.
    """
    way = np.linspace(0.0, 0.02, 1500)
    x = np.concatenate([way, way[::-1], way, way[::-1]])
    elastic = 1.5e4 * x + 5e5 * x**2
    force = elastic + loop_state(x, 1e-4) * (20.0 + 0.2 * elastic)
    fits = fit_laws([recording(x, force)])
    found = {fit.name: fit for fit in fits}["piecewise"]
    assert "piecewise goes amid the loop of both ways" in str(law_table(fits).caption)
    assert "loop" not in str(law_table(fit_laws([recording(way, elastic[:1500])])).caption)
    middle = np.interp(way, found.at, [value for _, value, _, _ in found.constants])
    assert middle == pytest.approx(1.5e4 * way + 5e5 * way**2, abs=2.0)
    # What is stated to be left is what the curve alone leaves: the loop.
    assert found.rmse == pytest.approx(
        float(np.sqrt(np.mean((force - np.interp(x, way, middle)) ** 2))), rel=0.01
    )


def test_the_middle_of_a_loop_is_not_told_of_a_hold() -> None:
    """A ball on a gel that sticks to it: nothing up to 14 mm, 80 N at 15 mm, which decay in a long hold, and a pull of
    30 N on the way back. One straight line leaves what the hold decays by, and lines no more than it.
    """
    way = np.linspace(0.0, 0.015, 1000)
    hold = np.full(20000, 0.015)
    touch = np.maximum(way - 0.014, 0.0) / 1e-3
    back = np.where(way > 0.0138, 85.0 * (way - 0.0144) / 6e-4, 0.0)
    force = np.concatenate(
        [80.0 * touch, 80.0 - 25.0 * (1.0 - np.exp(-np.linspace(0.0, 5.0, 20000))), back[::-1]]
    )
    x = np.concatenate([way, hold, way[::-1]])
    found = {fit.name: fit for fit in fit_laws([recording(x, force)])}
    assert found["piecewise"].rmse < found["polynomial"].rmse


def test_few_deflections_far_apart_have_laws() -> None:
    """Two steps of a gauge, none near half of the largest deflection."""
    x = np.repeat([0.0, 0.02], 300)
    fits = {fit.name: fit for fit in fit_laws([recording(x, 4e4 * x)])}
    assert fits["linear"].value("k") == pytest.approx(40.0, rel=0.01)


def test_a_law_with_a_gap_leaves_no_more_than_a_straight_line_though_its_beginning_was_not_recorded() -> None:
    """A fibre at lengths of 0.95 to 1.18 mm that pulls from 0.9 mm on: at the zero of its length it would be slack."""
    x = np.linspace(0.00095, 0.00118, 400)
    fits = {fit.name: fit for fit in fit_laws([recording(x, 9e3 * (100.0 * x - 0.09) ** 2)])}
    assert fits["linear_gap"].rmse < fits["constant"].rmse
    assert fits["power_gap"].rmse == pytest.approx(2.0, rel=0.08)
    assert fits["power_gap"].value("x0") == pytest.approx(0.9, abs=0.2)


@pytest.mark.parametrize("name", MADE)
def test_the_law_that_made_the_readings_is_found(name: str) -> None:
    x, force, constants = MADE[name]
    fits = {fit.name: fit for fit in fit_laws([recording(x, force)])}
    if name == "piecewise":  # its corners do not lie on the knots
        x, force = BOTH, np.interp(BOTH, np.linspace(-0.02, 0.02, 6), [-300.0, -10.0, 0.0, 5.0, 300.0, 900.0])
        fits = {fit.name: fit for fit in fit_laws([recording(x, force)])}
    assert next(iter(fits)) == name
    found = fits[name]
    assert found.rmse == pytest.approx(2.0, rel=0.08)
    for symbol, value in constants.items():
        spread = {s: u for s, _, u, _ in found.constants}[symbol]
        assert abs(found.value(symbol) - value) < 4.0 * spread + 1e-9
        assert spread < 0.1 * abs(value) + 1.0


def test_the_uncertainties_of_a_stiff_short_part_are_those_of_its_noise() -> None:
    """A stroke of 1 mm: A is 1e4 times the exponent, and a change of 1 N/cm^B of it is next to nothing.

    Expected is the bound of Cramér and Rao at the true constants, which are of one size: A in 1e4 N/cm^B, x0 in mm.
    """
    x, noise = np.linspace(0.0, 9e-4, 800), 0.5
    true = np.array([2.7, 2.57, 0.15])

    def force(constants: np.ndarray) -> np.ndarray:
        return np.asarray(
            1e4 * constants[0] * np.maximum(100.0 * x - 0.1 * constants[2], 0.0) ** constants[1]
        )

    steps = 1e-6 * np.eye(3)
    slopes = np.stack([(force(true + step) - force(true - step)) / 2e-6 for step in steps], axis=1)
    bound = noise * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    (fit,) = [fit for fit in fit_laws([recording(x, force(true), noise)]) if fit.name == "power_gap"]
    stated = np.array([deviation for _, _, deviation, _ in fit.constants]) / np.array([1e4, 1.0, 1.0])
    np.testing.assert_allclose(stated, bound, rtol=0.2)


@pytest.mark.parametrize(("length", "load"), [(1e-6, 1e-9), (1e-3, 1e4), (50.0, 1e-3)])
@pytest.mark.parametrize("name", MADE)
def test_parts_of_any_size_are_fitted_alike(name: str, length: float, load: float) -> None:
    """A nanometre and a piconewton, or metres: what a law leaves grows with the load, the order of the laws stays."""
    x, force, _ = MADE[name]
    read = recording(x, force)
    usual, other = fit_laws([read]), fit_laws([recording(length * x, load * read.force, noise=0.0)])
    left = {fit.name: fit.rmse for fit in usual}
    for fit in other:
        assert fit.rmse == pytest.approx(load * left[fit.name], rel=1e-4), fit.name
    first, same = usual[0], {fit.name: fit for fit in other}[usual[0].name]
    assert other[0].bic == pytest.approx(same.bic, abs=1.0)
    powers = {"N": 0, "N/mm": -1, "N/mm^2": -2, "N/mm^3": -3}
    for symbol, value, deviation, unit in first.constants if first.name != "piecewise" else ():
        _, changed, spread, _ = next(c for c in same.constants if c[0] == symbol)
        factor = {"mm": length, "1": 1.0}.get(unit, load)
        factor *= length ** (-same.value("B") if unit == "N/cm^B" else powers.get(unit, 0))
        # a difference of 1e-3 of the uncertainty is no other constant
        assert changed == pytest.approx(factor * value, rel=1e-6, abs=1e-3 * spread), symbol
        if unit != "N/cm^B":
            assert spread == pytest.approx(factor * deviation, rel=1e-2), symbol


@pytest.mark.parametrize("length", [1e-9, 1.0])
def test_a_law_as_steep_as_a_wall_has_its_exponent_in_any_unit(length: float) -> None:
    """An exponent of hundreds: of nanometres, its A in N/cm^B is beyond all numbers."""
    x = np.linspace(0.9, 1.0, 400)
    wall = recording(length * x, 1e3 * x**400.0, noise=1.0)
    fits = {fit.name: fit for fit in fit_laws([wall])}
    assert all(np.isfinite(value) for fit in fits.values() for _, value, _, _ in fit.constants)
    _, exponent, deviation, _ = fits["power"].constants[1]
    # dF/dA = x^400 and dF/dB = 1000 x^400 ln x: (J^T J)^-1 for 1 N of noise
    slopes = np.stack([x**400.0, 1e3 * x**400.0 * np.log(x)], axis=1)
    expected = float(np.sqrt(np.linalg.inv(slopes.T @ slopes)[1, 1]))
    assert exponent == pytest.approx(400.0, abs=4.0 * expected)
    assert deviation == pytest.approx(expected, rel=0.1)


def test_preload_is_a_gap_below_zero() -> None:
    force = 80e3 * (X + 0.002)
    fits = {fit.name: fit for fit in fit_laws([recording(X, force)])}
    assert fits["linear_gap"].value("x0") == pytest.approx(-2.0, abs=0.05)
    assert fits["linear"].value("F0") == pytest.approx(160.0, abs=1.0)


def test_the_pressure_of_mf_tyre() -> None:
    pressure = np.repeat([2e5, 3e5, 4e5], 300)
    x = np.tile(np.linspace(0.0, 0.02, 300), 3)
    force = (50e3 * x + 1e6 * x**2) * (1.0 + 0.7 * (pressure / 3e5 - 1.0))
    (fit,) = [f for f in fit_laws([recording(x, force, pressure=pressure)]) if f.name == "mf_tyre"]
    assert fit.value("q1") == pytest.approx(50.0, rel=0.01)
    assert fit.value("q2") == pytest.approx(1.0, rel=0.02)
    assert fit.value("p") == pytest.approx(0.7, abs=0.01)
    assert fit.rmse == pytest.approx(2.0, rel=0.08)


def test_constants_that_nothing_determines_have_no_uncertainty() -> None:
    """A force that falls has no gap: the line through the mean begins anywhere."""
    x = np.linspace(0.0, 0.03, 400)
    falling = {fit.name: fit for fit in fit_laws([recording(x, 900.0 / (1.0 + 300.0 * x) ** 2)])}
    beginning = falling["linear_gap"].constants[1]
    assert np.isinf(beginning[2])
    assert falling["linear_gap"].to_dict()["constants"]["x0"]["std"] is None
    assert all(np.isfinite(std) for _, _, std, _ in falling["polynomial"].constants)


def test_one_surface_at_a_time() -> None:
    flat = recording(X, 90e3 * X)
    bump = Recording("bump", flat.time, X, np.full(X.size, 0.25), flat.force)
    with pytest.raises(TirelabError, match="on 2 surfaces; the laws are compared on one surface"):
        fit_laws([flat, bump])
