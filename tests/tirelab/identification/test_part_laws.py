"""Each law is found from what it makes itself, and the one that made the readings is the first."""

import numpy as np
import pytest
from part_readings import BOTH, MADE, X, recording
from tirelab.errors import TirelabError
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


def test_two_constants_that_take_each_others_place_are_known_no_better_than_their_exponent() -> None:
    """A logarithm is F0 + A x^B for B near 0, where A B and F0 + A are known alone: A is known as well as B is."""
    x = np.geomspace(1e-3, 0.03, 2000)
    fits = {fit.name: fit for fit in fit_laws([recording(x, 40.0 + 5.0 * np.log(x), 0.5)])}
    (_, a, of_a, _), (_, b, of_b, _), (_, _, of_preload, _) = fits["power_preload"].constants
    assert abs(b) < 0.1
    assert of_a / abs(a) == pytest.approx(of_b / abs(b), rel=0.1)
    assert of_preload == pytest.approx(of_a, rel=0.1)


def test_one_surface_at_a_time() -> None:
    flat = recording(X, 90e3 * X)
    bump = Recording("bump", flat.time, X, np.full(X.size, 0.25), flat.force)
    with pytest.raises(TirelabError, match="on 2 surfaces; the laws are compared on one surface"):
        fit_laws([flat, bump])
