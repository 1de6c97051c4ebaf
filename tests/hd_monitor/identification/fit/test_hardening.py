import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import quad

from hd_monitor.identification.fit.hardening import LEVELS, Hardening

UNIT = 3e-4
VALUES = arrays(np.float64, len(LEVELS) - 1, elements=st.floats(-0.8, 0.8))
TWISTS = arrays(np.float64, 7, elements=st.floats(-5.0 * UNIT, 5.0 * UNIT))


def law(values):
    return Hardening(values=np.asarray(values), unit=UNIT)


def test_without_hardening_the_torque_is_the_twist():
    twist = UNIT * np.linspace(-3.0, 3.0, 11)
    plain = law(np.zeros(len(LEVELS) - 1))
    assert plain.is_linear
    np.testing.assert_array_equal(plain.torque(twist), twist)
    np.testing.assert_array_equal(plain.twist(twist), twist)
    np.testing.assert_array_equal(plain.slope(twist), 1.0)


def test_slope_at_the_levels():
    values = [-0.4, -0.3, -0.1, 0.2]
    np.testing.assert_allclose(law(values).slope(UNIT * np.asarray(LEVELS)), np.exp([-0.4, -0.3, -0.1, 0.0, 0.2]))
    np.testing.assert_allclose(law(values).slope(np.array([-9.0 * UNIT])), np.exp(0.2))


@given(VALUES, TWISTS)
def test_torque_is_the_integral_of_the_slope_and_odd(values, twists):
    hard = law(values)
    corners = UNIT * np.asarray(LEVELS)
    for twist in twists:
        expected = quad(lambda t: hard.slope(np.array(t)), 0.0, twist, points=corners[corners < abs(twist)][1:])[0]
        assert hard.torque(np.array(twist)) == pytest.approx(expected, rel=2e-3, abs=1e-9)
    np.testing.assert_array_equal(hard.torque(-twists), -hard.torque(twists))


@given(VALUES, TWISTS)
def test_twist_is_the_inverse_of_torque(values, twists):
    hard = law(values)
    np.testing.assert_allclose(hard.twist(hard.torque(twists)), twists, atol=2e-3 * UNIT)


@given(VALUES, TWISTS)
def test_derivatives_are_those_of_the_torque(values, twists):
    step = 1e-5
    found = law(values).derivatives(twists)
    for place in range(len(LEVELS) - 1):
        change = step * np.eye(len(LEVELS) - 1)[place]
        expected = (law(values + change).torque(twists) - law(values - change).torque(twists)) / (2.0 * step)
        np.testing.assert_allclose(found[:, place], expected, rtol=1e-5, atol=1e-6 * UNIT)
