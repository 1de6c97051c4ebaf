import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import binom

from hd_monitor.identification.fit.indexes import stiffness_indexes
from hd_monitor.identification.fit.unknowns import Unknowns

UNKNOWNS = Unknowns(harmonics=3, load_orders=(2,))


def draw(truth, covariance, count, seed):
    rng = np.random.default_rng(seed)
    noise = rng.multivariate_normal(np.zeros(len(truth)), covariance, count)
    return [stiffness_indexes(UNKNOWNS, truth + row, covariance) for row in noise]


def vector(circular, flex):
    values = UNKNOWNS.zero()
    values[UNKNOWNS.circular_spline] = circular / np.sqrt(6.0)
    values[UNKNOWNS.flexspline] = flex / np.sqrt(6.0)
    return values


def covariance_at_random(seed, size):
    """Of the stiffness unknowns, which alone make the indexes."""
    count = UNKNOWNS.stiffness.stop
    root = np.random.default_rng(seed).standard_normal((count, count)) * size
    covariance = np.zeros((UNKNOWNS.size, UNKNOWNS.size))
    covariance[:count, :count] = root @ root.T / count
    return covariance


def test_without_noise_it_is_the_root_sum_square():
    values = vector(0.06, 0.03)
    result = stiffness_indexes(UNKNOWNS, values, np.zeros((UNKNOWNS.size, UNKNOWNS.size)))
    assert tuple(result.index) == pytest.approx((0.06, 0.03))
    assert tuple(result.std) == (0.0, 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_intervals_cover_and_correlation_is_that_of_the_errors(seed):
    # a few per cent of the indexes: the intervals are right to first order
    covariance, truth = covariance_at_random(seed, 0.002), vector(0.07, 0.05)
    results = draw(truth, covariance, 4000, seed + 10)
    index = np.array([r.index for r in results])
    std = np.array([r.std for r in results])
    hits = np.abs(index - [0.07, 0.05]) < 1.96 * std
    low, high = binom.interval(1.0 - 1e-6, 4000, 0.95)
    assert ((low <= hits.sum(axis=0)) & (hits.sum(axis=0) <= high)).all()
    # the square has no bias; its root has one of second order, minus variance over twice the index
    bias = index.mean(axis=0) - [0.07, 0.05] + index.var(axis=0) / [0.14, 0.10]
    assert (np.abs(bias) < 5.0 * index.std(axis=0) / np.sqrt(4000)).all()
    measured = np.corrcoef(index.T)[0, 1]
    assert np.mean([r.correlation for r in results]) == pytest.approx(measured, abs=5.0 / np.sqrt(4000))


def test_noise_alone_gives_no_index_that_its_std_does_not_explain():
    covariance = covariance_at_random(5, 0.01)
    results = draw(UNKNOWNS.zero(), covariance, 2000, 6)
    beyond = np.mean([[i > 1.96 * s for i, s in zip(r.index, r.std, strict=True)] for r in results])
    assert beyond < 0.05


@given(st.floats(0.0, 0.2), st.floats(0.0, 0.2), st.integers(0, 1000), st.floats(1e-6, 0.1))
@settings(max_examples=60, deadline=None)
def test_results_are_always_finite_and_in_range(circular, flex, seed, size):
    result = stiffness_indexes(UNKNOWNS, vector(circular, flex), covariance_at_random(seed, size))
    assert min(result.index) >= 0.0
    assert min(result.std) > 0.0
    assert np.isfinite([*result.index, *result.std, result.correlation]).all()
    assert -1.0 <= result.correlation <= 1.0


def test_systematic_errors_widen_the_interval_and_leave_the_index():
    values = vector(0.03, 0.08)
    noise = 1e-6 * np.eye(UNKNOWNS.size)
    direction = np.zeros(UNKNOWNS.size)
    direction[UNKNOWNS.stiffness] = 0.1 * values[UNKNOWNS.stiffness]  # all β may be wrong by 10 % together
    alone, widened = (stiffness_indexes(UNKNOWNS, values, noise, s) for s in (None, np.outer(direction, direction)))
    assert widened.index == alone.index
    for index, before, after in zip(alone.index, alone.std, widened.std, strict=True):
        # the root of |β|² plus its standard deviation: at a tenth of the index 5 % below the usual one
        assert after == pytest.approx(np.hypot(before, 0.1 * index), rel=0.06)
    assert widened.correlation > 0.9 > 0.1 > abs(alone.correlation)


def test_a_line_left_to_its_prior_is_not_zero_and_takes_nothing_from_the_others():
    """The sensor hears all but the flexspline's third harmonic, of which nothing but its prior is known."""
    values, prior_std = vector(0.02, 0.10), 0.3
    values[UNKNOWNS.flexspline][[2, 5]] = 0.0
    noise, prior = 1e-8 * np.eye(UNKNOWNS.size), np.zeros(UNKNOWNS.size)
    prior[UNKNOWNS.flexspline][[2, 5]] = prior_std**2
    heard = stiffness_indexes(UNKNOWNS, values, noise)
    found = stiffness_indexes(UNKNOWNS, values, noise, np.diag(prior))
    assert found.index == heard.index
    assert found.std.circular_spline == heard.std.circular_spline
    # its mean square adds to that of what is heard: index and deviation together reach it
    assert found.index.flexspline + found.std.flexspline > np.hypot(heard.index.flexspline, np.sqrt(2.0) * prior_std)
