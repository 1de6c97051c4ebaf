import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from hd_monitor.orders.line_orders import LineOrders
from hd_monitor.orders.regression import line_columns, solve
from hd_monitor.orders.segment_products import clipped_fit, products_of_columns

PAIR = np.array([160.0, 162.0])


def arc(degrees, samples=1500, start=0.3):
    return start + np.linspace(0.0, math.radians(degrees), samples)


def lines(angle, orders, phasors):
    return np.exp(1j * np.multiply.outer(angle, orders)) @ np.asarray(phasors)


def fit_lines(values, angle, orders, trend=None):
    """Fit lines to samples without whitening; the trend is a constant and a drift unless given."""
    wanted = LineOrders.around(orders, math.tau / np.ptp(angle))
    columns = np.column_stack([line_columns(angle, wanted.every), values])
    drift = np.column_stack([np.ones(values.size), np.arange(values.size)])
    products = products_of_columns(columns, drift if trend is None else trend, wanted)
    return None if products is None else solve(products, wanted)


@given(
    st.floats(40.0, 700.0),
    st.lists(st.complex_numbers(min_magnitude=1e-3, max_magnitude=10.0), min_size=4, max_size=4),
    st.lists(st.floats(-5.0, 5.0), min_size=3, max_size=3),
    st.integers(0, 2**32 - 1),
)
def test_phasors_are_exact_without_noise_at_any_speed(degrees, phasors, trend, seed):
    rng = np.random.default_rng(seed)
    orders = np.array([158.0, 160.0, 162.0, 324.0])
    # Ever changing speed, and half of it backwards.
    angle = arc(degrees, 1200) + 0.02 * np.sin(np.linspace(0.0, 9.0, 1200) + rng.uniform(0, 6))
    angle[600:] = angle[600:][::-1]
    time = np.linspace(-1.0, 1.0, 1200)
    values = lines(angle, orders, phasors).real + np.polynomial.polynomial.polyval(time, trend)
    fit = fit_lines(values, angle, orders, trend=np.polynomial.polynomial.polyvander(time, 2))
    np.testing.assert_allclose(fit.phasors, phasors, atol=1e-6)
    assert fit.rows == 1200


def study(degrees, runs, noise, *, orders=PAIR, seed=0):
    """Errors (real parts, then imaginary ones), variances claimed and floors, one row a run with random phases."""
    rng = np.random.default_rng(seed)
    angle = arc(degrees)
    errors, claimed, floors = [], [], []
    for _ in range(runs):
        phasors = np.array([1.0, 0.5]) * np.exp(1j * rng.uniform(0.0, math.tau, 2))
        fit = fit_lines(lines(angle, orders, phasors).real + noise(rng, angle.size), angle, orders)
        error = fit.phasors - phasors
        errors.append(np.concatenate([error.real, error.imag]))
        claimed.append(np.diag(fit.covariance))
        floors.append(fit.noise * math.sqrt(fit.floor))
    return np.array(errors), np.array(claimed), np.array(floors)


def white(rng, size):
    return 0.5 * rng.standard_normal(size)


@pytest.mark.parametrize(("separation", "factor"), [(0.25, 5.3), (0.5, 1.68), (0.75, 1.10), (1.0, 1.0), (2.0, 1.0)])
def test_is_unbiased_with_the_theoretical_variance(separation, factor):
    """Separations in lines' resolutions of 180°: the variance factor is 1 / (1 - sinc²)."""
    runs = 600
    errors, claimed, floors = study(180.0 * separation, runs, white)
    theory = 2.0 * 0.5**2 / 1500 / (1.0 - np.sinc(separation) ** 2)
    assert theory == pytest.approx(factor * 2.0 * 0.5**2 / 1500, rel=0.01)
    # Each mean within five standard errors; the variance's relative standard error is sqrt(2 / numbers), and the four
    # errors of a run count as two because close lines' errors go together.
    assert np.abs(errors.mean(axis=0)).max() < 5.0 * math.sqrt(theory / runs)
    assert np.mean(errors**2) == pytest.approx(theory, rel=4.0 * math.sqrt(2.0 / (2 * runs)))
    # The claim's overdispersion is that of its floor, from at least 12 degrees of freedom.
    assert claimed.mean() == pytest.approx(theory, rel=4.0 * math.sqrt(2.0 / (12 * runs)) + 0.01)
    assert np.mean(floors**2) == pytest.approx(0.25, rel=4.0 * math.sqrt(2.0 / (12 * runs)))


def test_intervals_cover_at_their_confidence_with_the_floors_degrees_of_freedom():
    rng = np.random.default_rng(8)
    angle, hits, runs = arc(90.0), 0, 1500
    for _ in range(runs):
        fit = fit_lines(lines(angle, PAIR, [0.3, 0.2j]).real + white(rng, angle.size), angle, PAIR)
        error = (fit.phasors[0].real - 0.3) / math.sqrt(fit.covariance[0, 0])
        hits += abs(error) < stats.t.ppf(0.975, fit.freedom)
    assert hits / runs == pytest.approx(0.95, abs=4.0 * math.sqrt(0.95 * 0.05 / runs))


def test_the_floor_is_measured_around_the_lines_not_over_the_band():
    """Red noise: the band's standard deviation would claim errors many times too large or too small."""

    def red(rng, size):
        return np.convolve(rng.standard_normal(size + 20), np.ones(21), mode="valid")

    errors, claimed, _ = study(360.0, 400, red)
    assert np.mean(claimed) == pytest.approx(np.mean(errors**2), rel=0.2)
    size = 1500
    frequency = 161.0 / size  # cycles per sample: 161 cycles over 360°
    gain = abs(np.sum(np.exp(-2j * math.pi * frequency * np.arange(21)))) ** 2
    assert np.mean(errors**2) == pytest.approx(2.0 * gain / size, rel=0.2)
    assert gain < 0.5 * 21.0  # so the test could tell the difference


def test_spikes_hardly_widen_errors_and_the_covariance_accounts_for_it():
    def spiky(rng, size):
        return white(rng, size) + 40.0 * rng.standard_normal(size) * (rng.random(size) < 0.02)

    errors, claimed, _ = study(180.0, 300, spiky)
    theory = 2.0 * 0.25 / 1500
    assert np.mean(errors**2) < 1.25 * theory
    # So the test can fail: with all of the spikes' power the errors would be more than 50 times as large
    assert np.mean(spiky(np.random.default_rng(0), 100_000) ** 2) > 50.0 * 0.25
    assert claimed.mean() == pytest.approx(np.mean(errors**2), rel=0.15)


def test_trend_terms_are_removed_even_if_linearly_dependent():
    angle = arc(180.0)
    friction = np.where(np.arange(angle.size) % 500 < 250, 1.0, -1.0)
    gravity = np.sin(angle)
    values = lines(angle, PAIR, [0.2, 0.1]).real + 7.0 * friction + 20.0 * gravity + 3.0
    trend = np.column_stack([friction, gravity, friction + gravity, np.ones_like(angle), np.zeros_like(angle)])
    fit = fit_lines(values, angle, PAIR, trend=trend)
    np.testing.assert_allclose(fit.phasors, [0.2, 0.1], atol=1e-9)


def test_strokes_over_one_arc_add_signal_to_noise_ratio_but_no_resolution():
    one = arc(90.0)
    many = np.concatenate([one, one[::-1]] * 8)
    rng = np.random.default_rng(4)
    single = fit_lines(white(rng, one.size), one, PAIR)
    pooled = fit_lines(white(rng, many.size), many, PAIR)
    shapes = [np.trace(fit.covariance) / (fit.noise**2 * fit.floor) for fit in (pooled, single)]
    assert shapes[0] / shapes[1] == pytest.approx(1.0 / 16.0, rel=1e-3)


def test_the_chance_is_uniform_for_noise_alone():
    rng = np.random.default_rng(6)
    angle = arc(360.0, 800)
    chances = [fit_lines(white(rng, angle.size), angle, PAIR).chances[1] for _ in range(800)]
    assert stats.kstest(chances, "uniform").pvalue > 1e-3


def test_amplitudes_and_their_standard_deviations():
    errors, _, _ = study(180.0, 500, white)
    angle = arc(180.0)
    fit = fit_lines(lines(angle, PAIR, [1.0, 0.5j]).real + white(np.random.default_rng(1), angle.size), angle, PAIR)
    np.testing.assert_allclose(fit.amplitudes, np.abs(fit.phasors))
    np.testing.assert_allclose(fit.amplitude_stds, errors.std(), rtol=0.35)


@settings(max_examples=30)
@given(st.floats(1e-6, 1e6), st.floats(0.2, 5.0))
def test_the_result_scales_with_the_unit_and_the_angle(unit, gear):
    rng = np.random.default_rng(9)
    angle = arc(100.0, 700)
    values = lines(angle, PAIR, [1.0, 0.5]).real + white(rng, angle.size)
    one = fit_lines(values, angle, PAIR)
    other = fit_lines(unit * values, gear * angle, PAIR / gear)
    np.testing.assert_allclose(other.phasors, unit * one.phasors, rtol=1e-5, atol=1e-6 * unit)
    np.testing.assert_allclose(other.noise, unit * one.noise, rtol=1e-3)
    np.testing.assert_allclose(other.floor, one.floor, rtol=1e-3)


def test_columns_follow_the_phasor_convention():
    angle = arc(30.0, 50)
    np.testing.assert_allclose(line_columns(angle, [3.0]) @ [0.6, 0.8], ((0.6 + 0.8j) * np.exp(3j * angle)).real)


@pytest.mark.parametrize(
    ("angle", "orders"), [(arc(1e-4), PAIR), (arc(90.0), [160.0, 160.0 + 1e-10])], ids=["travel", "orders"]
)
def test_lines_that_are_not_separated_are_not_fitted(angle, orders):
    assert fit_lines(white(np.random.default_rng(1), angle.size), angle, orders) is None


def test_a_signal_that_does_not_change_is_not_fitted():
    assert fit_lines(np.zeros(100), arc(90.0, 100), PAIR) is None


def test_the_clipped_fit_equals_that_of_the_clean_signal():
    rng = np.random.default_rng(10)
    columns = rng.standard_normal((400, 3))
    signal = columns @ [1.0, -2.0, 0.5] + 0.1 * rng.standard_normal(400)
    dirty = signal + 50.0 * (rng.random(400) < 0.03)
    fit, residual = clipped_fit(columns, dirty)
    np.testing.assert_allclose(fit, columns @ [1.0, -2.0, 0.5], atol=0.1)
    assert np.abs(residual).max() < 1.0
