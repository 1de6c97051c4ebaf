"""Probabilities of the components against what the Gaussian says."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from hd_monitor.diagnosis.probability import component_probabilities, name_component
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.identification.result import Identification
from hd_monitor.reducer import LinePair


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
    assert sum(component_probabilities(evidence(cs, fs, std, r), 0.05, 0.87)) == pytest.approx(1.0)


@given(cs=st.floats(0.0, 0.2), fs=st.floats(0.0, 0.2), r=st.floats(-0.99, 0.99))
def test_exact_indexes_leave_no_doubt(cs: float, fs: float, r: float) -> None:
    odds = component_probabilities(evidence(cs, fs, 0.0, r), 0.05, 0.87)
    assert odds.of(name_component(LinePair(cs, fs), 0.05, 0.87)) == 1.0


@pytest.mark.parametrize("r", [-0.9, 0.0, 0.9])
@pytest.mark.parametrize("difference", [0.0, 0.01, 0.02, 0.04])
def test_order_of_two_large_indexes_as_the_normal_distribution_says(r: float, difference: float) -> None:
    std = 0.01
    odds = component_probabilities(evidence(0.5 + difference, 0.5, std, r), 0.05, 1.0)
    expected = norm.cdf(difference / (std * np.sqrt(2.0 * (1.0 - r))))
    assert odds.circular_spline == pytest.approx(expected, abs=2e-3)


def test_share_above_a_limit_as_the_normal_distribution_says() -> None:
    odds = component_probabilities(evidence(0.06, 0.0, 0.01), 0.05, 0.87)
    assert 1.0 - odds.none == pytest.approx(norm.cdf(1.0), abs=2e-3)
