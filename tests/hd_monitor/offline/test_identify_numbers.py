"""Estimates with their intervals: what the identification's covariance says of each β, of fn and of ζ."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.identification.result import Identification
from hd_monitor.offline.identify_numbers import Estimate, dynamics, harmonics
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings


def found(circular_spline: complex, flexspline: complex, std: float) -> Identification:
    return Identification(
        circular_spline=np.array([circular_spline]),
        flexspline=np.array([flexspline]),
        index=LinePair(abs(circular_spline), abs(flexspline)),
        index_std=LinePair(std, std),
        beta_covariance=np.broadcast_to(std**2 * np.eye(2), (2, 1, 2, 2)),
    )


def test_a_beta_far_above_the_noise_has_the_noises_deviation() -> None:
    (beta,) = harmonics(found(0.0, 0.1 * np.exp(0.7j), 0.001))["flexspline"]
    assert beta.beta.value == pytest.approx(0.1, rel=2e-4)
    assert beta.beta.std == pytest.approx(0.001, rel=1e-2)
    assert beta.phase == pytest.approx(0.7)
    assert beta.phase_std == pytest.approx(0.01)


def test_a_beta_within_the_noise_has_no_phase_and_an_interval_that_begins_at_nothing() -> None:
    (beta,) = harmonics(found(0.001, 0.1, 0.005))["circular_spline"]
    assert math.isnan(beta.phase)
    assert beta.beta.low == 0.0
    assert beta.beta.high >= 0.005


@pytest.mark.parametrize("size", [0.05, 0.01, 0.005, 0.002])
def test_intervals_hold_the_magnitude_as_often_as_they_say(size: float) -> None:
    std, rng = 0.002, np.random.default_rng(5)
    draws = size + std * (rng.standard_normal(1000) + 1j * rng.standard_normal(1000))
    betas = [harmonics(found(draw, 0.1, std))["circular_spline"][0].beta for draw in draws]
    covered = np.mean([beta.low <= size <= beta.high for beta in betas])
    assert 0.93 < covered < 0.98


@given(st.floats(1.0, 500.0), st.floats(1e-6, 0.3))
def test_the_interval_of_a_frequency_is_even_in_its_logarithm(value: float, share: float) -> None:
    interval = Estimate.lognormal(value, share * value)
    assert interval.low > 0.0
    assert interval.low * interval.high == pytest.approx(value**2)
    assert math.log(interval.high / value) == pytest.approx(1.959964 * share, rel=1e-6)


def test_what_was_taken_as_given_has_no_width() -> None:
    given_ones = replace(found(0.1, 0.1, 0.01), natural_frequency=55.0, damping_ratio=0.023)
    exact = JointSettings.from_mapping(
        {"dynamics.natural_frequency_uncertainty": 0.0, "dynamics.damping_uncertainty": 0.0}
    ).uncertainty
    for (estimate, learnt), value in zip(dynamics(given_ones, exact).values(), (55.0, 0.023), strict=True):
        assert (estimate.std, estimate.low, estimate.high) == (0.0, value, value)
        assert not learnt
