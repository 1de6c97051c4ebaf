"""Probabilities of the components against what the Gaussian says."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from hd_monitor.diagnosis.probability import (
    beyond,
    component_probabilities,
    find_cause,
    index_probabilities,
    name_component,
    severity,
)
from hd_monitor.diagnosis.verdict import Cause, Component
from hd_monitor.identification.result import Identification
from hd_monitor.reducer import LinePair
from hd_monitor.settings import DiagnosisSettings

LIMITS = DiagnosisSettings()


def evidence(cs: float, fs: float, std: float, correlation: float = 0.0) -> Identification:
    nothing = np.zeros(3, dtype=complex)
    return Identification(
        circular_spline=nothing,
        flexspline=nothing,
        index=LinePair(cs, fs),
        index_std=LinePair(std, std),
        index_correlation=correlation,
    )


@pytest.mark.parametrize(
    ("cs", "fs", "component"),
    [
        (0.049, 0.049, Component.NONE),
        (0.06, 0.049, Component.CIRCULAR_SPLINE),
        (0.02, 0.051, Component.FLEXSPLINE),
        (0.10, 0.10, Component.BOTH),
        (0.10, 0.0875, Component.BOTH),
        (0.10, 0.0865, Component.CIRCULAR_SPLINE),
        (0.052, 0.0499, Component.CIRCULAR_SPLINE),
    ],
)
def test_naming_rule_of_the_contract(cs: float, fs: float, component: Component) -> None:
    assert name_component(LinePair(cs, fs), 0.05, 0.87) is component


@given(cs=st.floats(0.0, 0.2), fs=st.floats(0.0, 0.2), std=st.floats(1e-5, 0.1), r=st.floats(-1.0, 1.0))
def test_probabilities_add_up(cs: float, fs: float, std: float, r: float) -> None:
    assert sum(component_probabilities(evidence(cs, fs, std, r), LIMITS, 0.05)) == pytest.approx(1.0)


@given(cs=st.floats(0.0, 0.2), fs=st.floats(0.0, 0.2), r=st.floats(-0.99, 0.99))
def test_exact_indexes_leave_no_doubt(cs: float, fs: float, r: float) -> None:
    odds = component_probabilities(evidence(cs, fs, 0.0, r), LIMITS, 0.05)
    assert odds.of(name_component(LinePair(cs, fs), 0.05, 0.87)) == 1.0


@pytest.mark.parametrize("r", [-0.9, 0.0, 0.9])
@pytest.mark.parametrize("difference", [0.0, 0.01, 0.02, 0.04])
def test_order_of_two_large_indexes_as_the_normal_distribution_says(r: float, difference: float) -> None:
    std = 0.01
    odds = component_probabilities(evidence(0.5 + difference, 0.5, std, r), replace(LIMITS, both_ratio=1.0), 0.05)
    expected = norm.cdf(difference / (std * np.sqrt(2.0 * (1.0 - r))))
    assert odds.circular_spline == pytest.approx(expected, abs=2e-3)


def test_share_above_a_limit_as_the_normal_distribution_says() -> None:
    odds = component_probabilities(evidence(0.06, 0.0, 0.01), LIMITS, 0.05)
    assert 1.0 - odds.none == pytest.approx(norm.cdf(1.0), abs=2e-3)


def test_each_spline_is_beyond_its_limit_as_the_normal_distribution_says() -> None:
    found = beyond(evidence(0.04, 0.07, 0.02, correlation=0.5), LIMITS, 0.05)
    assert found == pytest.approx((norm.cdf(-0.5), norm.cdf(1.0)), abs=2e-3)


@pytest.mark.parametrize("correlation", [-1.0, 0.0])
def test_a_spline_is_beyond_its_limit_by_index_or_transmission_error(correlation: float) -> None:
    odds = beyond(with_errors(0.05, 1.5, 0.5, correlation), LIMITS, 0.05)
    # Opposite errors: one of the two is always beyond
    assert odds.flexspline == pytest.approx(1.0 if correlation else 0.75, abs=0.02)
    assert odds.circular_spline == 0.0


def test_the_indexes_alone_leave_transmission_errors_out() -> None:
    found = with_errors(0.01, 15.0, 0.1, 0.0)
    assert component_probabilities(found, LIMITS, 0.05).flexspline == 1.0
    assert index_probabilities(found, LIMITS, 0.05).none == 1.0


def with_errors(stiffness: float, error: float, std: float, correlation: float) -> Identification:
    """A flexspline whose index and transmission error [arcmin] have errors, of this size in limits, that correlate."""
    joint = np.eye(4)
    joint[1, 3] = joint[3, 1] = correlation
    return replace(
        evidence(0.0, stiffness, 1e-6),
        index_std=LinePair(1e-6, std * LIMITS.warn_index),
        transmission_error=LinePair(0.0, error),
        transmission_error_std=LinePair(1e-6, std * LIMITS.warn_transmission_error),
        correlation=joint,
    )


@pytest.mark.parametrize(
    ("stiffness", "error", "cause"),
    [
        (0.08, 0.5, Cause.STIFFNESS),
        (0.01, 3.2, Cause.TRANSMISSION_ERROR),
        (0.10, 2.0, Cause.STIFFNESS),
        (0.06, 4.0, Cause.TRANSMISSION_ERROR),
    ],
)
def test_the_cause_is_the_reading_beyond_its_limit(stiffness: float, error: float, cause: Cause) -> None:
    found = with_errors(stiffness, error, 0.02, 0.0)
    assert find_cause(found, LIMITS, LIMITS.warn_index) is cause
    assert component_probabilities(found, LIMITS, LIMITS.warn_index).flexspline == 1.0
    expected = max(stiffness, error / LIMITS.warn_transmission_error * LIMITS.warn_index)
    assert severity(found, LIMITS).flexspline == pytest.approx(expected)


def test_either_of_two_readings_that_the_data_cannot_separate_accuses_the_part() -> None:
    """What one of them lacks the other has: together they are beyond the limit, alone neither is for sure."""
    found = with_errors(0.075, 2.25, 1.0, -0.999)
    assert component_probabilities(found, LIMITS, LIMITS.warn_index).flexspline > LIMITS.confidence
    assert find_cause(found, LIMITS, LIMITS.warn_index) is Cause.EITHER
