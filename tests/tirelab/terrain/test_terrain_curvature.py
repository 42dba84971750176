"""Curvature against circles, sines and parabolas, whose radius of curvature is known in closed form."""

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline
from tirelab.errors import TirelabError
from tirelab.terrain import Profile, from_function, ground_from, sine
from tirelab.terrain.curvature import radius_of, smoothed_heights


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("radius", [0.5, 5.0])
def test_circle_has_its_radius_everywhere(radius: float, sign: float) -> None:
    half = 0.8 * radius
    spacing = radius / 100.0
    profile = from_function(
        lambda s: sign * (np.sqrt(radius**2 - (s - half) ** 2) - radius), 2.0 * half, spacing
    )
    ground = ground_from(profile, spacing)
    inner = np.abs(ground.s - half) < 0.7 * radius
    # A cubic spline's second derivative on a circle is off by (turn per point)^2 / 12: at 45 degrees, 1.7e-5.
    np.testing.assert_allclose(ground.curvature[inner] * radius * sign, 1.0, rtol=1e-4)
    np.testing.assert_allclose(ground.radius[inner], sign * radius, rtol=1e-4)
    angle = np.arcsin(np.clip((ground.s - half) / radius, -1.0, 1.0))
    np.testing.assert_allclose(ground.direction[inner], -sign * angle[inner], atol=1e-5)
    ends = np.flatnonzero(inner)[[0, -1]]
    # Length and angle are two ways to the same arc.
    np.testing.assert_allclose(np.ptp(ground.arc[ends]), radius * np.ptp(angle[ends]), rtol=1e-6)


def test_error_on_a_circle_falls_with_the_square_of_the_spacing() -> None:
    errors = []
    for spacing in (0.02, 0.01, 0.005):
        profile = from_function(lambda s: np.sqrt(0.25 - (s - 0.4) ** 2), 0.8, spacing)
        ground = ground_from(profile, spacing)
        inner = np.abs(ground.s - 0.4) < 0.25
        errors.append(np.max(np.abs(0.5 * ground.curvature[inner] - 1.0)))
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)


def test_sine() -> None:
    amplitude, wave = 0.05, 2.0 * np.pi / 1.5
    ground = ground_from(sine(6.0, (amplitude, 1.5), spacing=0.005), 0.005)
    slope = amplitude * wave * np.cos(wave * ground.s)
    exact = amplitude * wave**2 * np.sin(wave * ground.s) / (1.0 + slope**2) ** 1.5
    inner = (ground.s > 0.1) & (ground.s < 5.9)
    # Error of the spline: (wave spacing)^2 / 12 = 4e-5 of the largest curvature.
    np.testing.assert_allclose(ground.curvature[inner], exact[inner], atol=1e-4 * exact.max())


def test_parabola_is_concave_with_its_vertex_radius() -> None:
    ground = ground_from(from_function(lambda s: 0.7 * (s - 1.0) ** 2, 2.0, 0.01), 0.01)
    exact = -1.4 / (1.0 + (1.4 * (ground.s - 1.0)) ** 2) ** 1.5
    inner = np.abs(ground.s - 1.0) < 0.9
    np.testing.assert_allclose(ground.curvature[inner], exact[inner], atol=1e-4)
    assert ground.radius[np.argmin(np.abs(ground.s - 1.0))] == pytest.approx(-1.0 / 1.4, rel=1e-4)


def test_a_ramp_is_flat_whatever_its_grade() -> None:
    ground = ground_from(from_function(lambda s: 0.3 * s, 3.0))
    assert np.all(np.isposinf(ground.radius))
    np.testing.assert_allclose(ground.direction, np.arctan(0.3))


def test_flat_counts_as_convex_without_end() -> None:
    np.testing.assert_array_equal(
        radius_of(np.array([0.0, -0.0, 1e-9, -2.0])), [np.inf, np.inf, np.inf, -0.5]
    )


def test_points_need_not_be_evenly_spaced() -> None:
    s = np.sort(np.random.default_rng(1).uniform(0.0, 4.0, 2000))
    s = s[np.concatenate([[True], np.diff(s) > 1e-4])]
    ground = ground_from(Profile(s, 0.1 * np.sin(3.0 * s)), 0.01)
    exact = 0.9 * np.sin(3.0 * ground.s) / (1.0 + (0.3 * np.cos(3.0 * ground.s)) ** 2) ** 1.5
    inner = (ground.s > 0.2) & (ground.s < 3.8)
    # Gaps of up to 2 cm: (3 x 0.02)^2 / 12 = 3e-4, and the jumps of spacing cost a few times that.
    np.testing.assert_allclose(ground.curvature[inner], exact[inner], atol=3e-3)


def test_smoothing_is_scipys_smoothing_spline() -> None:
    generator = np.random.default_rng(0)
    s = np.sort(generator.uniform(0.0, 10.0, 400))
    z = np.sin(s) + 0.01 * generator.normal(size=s.size)
    weight = np.concatenate([[s[1] - s[0]], s[2:] - s[:-2], [s[-1] - s[-2]]]) / 2.0
    spline = make_smoothing_spline(s, z, w=weight, lam=(0.5 / (2.0 * np.pi)) ** 4)
    np.testing.assert_allclose(smoothed_heights(s, z, 0.5), spline(s), atol=1e-8)


@pytest.mark.parametrize(("wavelength", "kept"), [(0.2, 1 / 2), (0.4, 16 / 17), (0.8, 256 / 257)])
def test_smoothing_keeps_the_stated_share_of_a_wave(wavelength: float, kept: float) -> None:
    s = np.linspace(0.0, 20.0, 4001)
    wave = np.sin(2.0 * np.pi * s / wavelength)
    smooth = smoothed_heights(s, wave, 0.2)
    inner = (s > 2.0) & (s < 18.0)
    share = np.dot(smooth[inner], wave[inner]) / np.dot(wave[inner], wave[inner])
    # 40 points per wave: the sum stands for the integral to (2 pi / 40)^2 / 12 = 0.2 %.
    assert share == pytest.approx(kept, rel=3e-3)


def test_noise_that_smoothing_lets_through() -> None:
    """White noise of sigma every h leaves a curvature of variance 2 sigma^2 h (2 pi)^4 l^-5 J, J = pi / (8 sqrt 2).

    J is the integral of u^4 / (1 + u^4)^2 over u = l n from 0 to infinity; it stands for a sum when l is long beside h.
    """
    sigma, h, length = 1e-3, 0.01, 0.4
    s = np.arange(200_000) * h
    z = sigma * np.random.default_rng(2).normal(size=s.size)
    ground = ground_from(Profile(s, z, smoothing_length=length), h)
    inner = slice(100, -100)
    expected = 2.0 * sigma**2 * h * (2.0 * np.pi) ** 4 / length**5 * np.pi / (8.0 * np.sqrt(2.0))
    # About 2000 m / 0.4 m = 5000 independent values: 1 % of the standard deviation.
    assert np.std(ground.curvature[inner]) == pytest.approx(np.sqrt(expected), rel=0.04)


def test_a_long_smoothing_length_is_still_exact_on_a_line() -> None:
    s = np.arange(20_000) * 0.01
    np.testing.assert_allclose(smoothed_heights(s, 0.05 * s, 50.0), 0.05 * s, atol=1e-9)


def test_curve_that_folds_back_is_refused_with_its_place() -> None:
    s = np.array([0.0, 1.0, 2.0, 2.2, 2.4, 2.6, 3.0, 4.0, 5.0])
    z = np.array([0.0, 0.0, 0.0, 1.9, 0.0, 1.9, 1.9, 1.9, 1.9])
    with pytest.raises(TirelabError, match=r"folds back near s = 2\.\d+ m"):
        ground_from(Profile(s, z), 0.01)


@pytest.mark.parametrize(
    ("spacing", "smoothing_length"),
    [(0.0, 0.0), (-1.0, 0.0), (np.nan, 0.0), (0.01, -1.0), (0.01, np.nan), (1e-8, 0.0)],
)
def test_bad_resolution_is_refused(spacing: float, smoothing_length: float) -> None:
    with pytest.raises(TirelabError):
        ground_from(sine(3.0, (0.1, 1.0)), spacing, smoothing_length)
