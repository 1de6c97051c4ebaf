"""The Magnus-4 scan: its order, its identities and its refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hd_monitor.errors import ParameterError
from hd_monitor.model import Dynamics, Oscillator, gauss_times

DYNAMICS = Dynamics(natural_frequency=3.0, damping_ratio=0.04)
OMEGA = DYNAMICS.angular_frequency
START = (0.3, -2.0)


def fluctuation(t):
    return 0.3 * np.cos(11.0 * t + 0.4) + 0.1 * np.sin(23.0 * t)


def forcing(t):
    return 40.0 * np.cos(7.0 * t) - 90.0 * t


def steady_damping(t):
    return 2 * DYNAMICS.damping_ratio * OMEGA + 0.0 * t


def varying_damping(t):
    return 2.0 + np.sin(9.0 * t)


def integrate(steps: int, duration: float = 2.0, damping=steady_damping):
    times = np.linspace(0.0, duration, steps + 1)
    between = gauss_times(times)
    given = None if damping is steady_damping else damping(between)
    return Oscillator(DYNAMICS, fluctuation(between), duration / steps, given).respond(forcing(between), START)


def exact(times, k=fluctuation, u=forcing, start=START, damping=steady_damping):
    def slope(t, state):
        x, v = state
        return v, u(t) - damping(t) * v - OMEGA**2 * (1 + k(t)) * x

    solution = solve_ivp(slope, (0.0, times[-1]), start, "DOP853", times, rtol=1e-12, atol=1e-14)
    return solution.y


@pytest.mark.parametrize("damping", [steady_damping, varying_damping])
def test_order_of_convergence_is_four(damping):
    """Halving the step divides the error by 16, with stiffness, forcing and damping varying."""
    reference = exact([2.0], damping=damping)[:, -1]
    errors = []
    for steps in (100, 200, 400, 800):
        response = integrate(steps, damping=damping)
        errors.append(
            math.hypot(response.displacement[-1] - reference[0], (response.velocity[-1] - reference[1]) / OMEGA)
        )
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 4.0, atol=0.1)


def test_agrees_with_a_generic_solver_at_every_step():
    times = np.linspace(0.0, 2.0, 3201)
    response = integrate(3200)
    displacement, velocity = exact(times)
    np.testing.assert_allclose(response.displacement, displacement, atol=1e-8 * np.abs(displacement).max())
    np.testing.assert_allclose(response.velocity, velocity, atol=1e-8 * np.abs(velocity).max())


def test_constant_coefficients_are_integrated_exactly():
    """One exponential a step: the step's length does not matter."""
    zeta = DYNAMICS.damping_ratio
    damped = OMEGA * math.sqrt(1 - zeta**2)
    t = np.linspace(0.0, 3.0, 301)
    response = Oscillator(DYNAMICS, np.zeros((2, 300)), 0.01).respond(np.zeros((2, 300)), (1.0, 0.0))
    expected = np.exp(-zeta * OMEGA * t) * (np.cos(damped * t) + zeta / math.sqrt(1 - zeta**2) * np.sin(damped * t))
    np.testing.assert_allclose(response.displacement, expected, atol=1e-12)


def test_a_constant_force_at_its_deflection_stays_there():
    u, k = 50.0, 0.2
    rest = u / (OMEGA**2 * (1 + k))
    response = Oscillator(DYNAMICS, np.full((2, 1000), k), 0.005).respond(np.full((2, 1000), u), (rest, 0.0))
    np.testing.assert_allclose(response.displacement, rest, rtol=1e-12)
    np.testing.assert_allclose(response.velocity, 0.0, atol=1e-10)


@given(st.integers(1, 90), st.integers(0, 2**31), st.sampled_from([0.0, 0.02, 0.7, 3.0]))
def test_response_is_the_product_of_the_steps(steps, seed, damping):
    """The sums over blocks do the arithmetic of a loop over steps, whatever their number and however damped."""
    rng = np.random.default_rng(seed)
    k, u = rng.uniform(-0.9, 0.9, (2, steps)), rng.normal(size=(2, steps))
    h = rng.uniform(1e-3, 0.02, steps)
    dynamics = replace(DYNAMICS, damping_ratio=damping)
    whole = Oscillator(dynamics, k, h).respond(u, START)
    state = np.array(START)
    chained = [state]
    for n in range(steps):
        one = Oscillator(dynamics, k[:, n : n + 1], h[n]).respond(u[:, n : n + 1], state)
        state = np.array([one.displacement[-1], one.velocity[-1]])
        chained.append(state)
    np.testing.assert_allclose(np.stack([whole.displacement, whole.velocity], axis=1), chained, rtol=1e-10, atol=1e-12)


@given(st.integers(2, 200), st.integers(1, 199), st.integers(0, 2**31))
def test_can_be_cut_anywhere(steps, cut, seed):
    cut = min(cut, steps - 1)
    rng = np.random.default_rng(seed)
    k, u = rng.uniform(-0.3, 0.3, (2, steps)), rng.normal(size=(2, steps))
    whole = Oscillator(DYNAMICS, k, 0.01).respond(u, START)
    first = Oscillator(DYNAMICS, k[:, :cut], 0.01).respond(u[:, :cut], START)
    at_cut = (first.displacement[-1], first.velocity[-1])
    second = Oscillator(DYNAMICS, k[:, cut:], 0.01).respond(u[:, cut:], at_cut)
    for all_of_it, before, after in zip(whole, first, second, strict=True):
        np.testing.assert_allclose(np.append(before[:-1], after), all_of_it, rtol=1e-9, atol=1e-12)


@given(st.integers(0, 2**31), st.floats(-3, 3), st.floats(-3, 3))
def test_is_linear_in_its_inputs(seed, a, b):
    rng = np.random.default_rng(seed)
    k, u, w = rng.uniform(-0.3, 0.3, (2, 64)), rng.normal(size=(2, 64)), rng.normal(size=(2, 64))
    oscillator = Oscillator(DYNAMICS, k, 0.01)
    both = oscillator.respond(np.stack([u, w, a * u + b * w], axis=2))
    np.testing.assert_allclose(
        both.displacement[:, 2], a * both.displacement[:, 0] + b * both.displacement[:, 1], atol=1e-12
    )
    np.testing.assert_allclose(both.displacement[:, 0], oscillator.respond(u).displacement, atol=1e-14)


def test_each_input_may_have_its_own_start():
    oscillator = Oscillator(DYNAMICS, np.zeros((2, 10)), 0.01)
    response = oscillator.respond(np.zeros((2, 10, 2)), [[1.0, 0.0], [0.0, 5.0]])
    assert response.displacement[0].tolist() == [1.0, 0.0]
    assert response.velocity[0].tolist() == [0.0, 5.0]
    np.testing.assert_allclose(
        response.displacement[:, 1], oscillator.respond(np.zeros((2, 10)), (0.0, 5.0)).displacement, atol=1e-15
    )


def test_the_transition_matrices_carry_a_free_motion():
    k = fluctuation(gauss_times(np.linspace(0.0, 0.5, 51)))
    oscillator = Oscillator(DYNAMICS, k, 0.01)
    response = oscillator.respond(np.zeros((2, 50)), START)
    state = np.array(START)
    for step in oscillator.transition:
        state = step @ state
    np.testing.assert_allclose(state, [response.displacement[-1], response.velocity[-1]], rtol=1e-11)


@given(st.integers(0, 2**31))
def test_the_determinant_of_a_step_is_the_damping(seed):
    """Abel's identity: det of a step is exp(-2 ζ ωn h), whatever the stiffness does."""
    k = np.random.default_rng(seed).uniform(-0.5, 0.5, (2, 30))
    determinants = np.linalg.det(Oscillator(DYNAMICS, k, 0.02).transition)
    np.testing.assert_allclose(determinants, math.exp(-2 * DYNAMICS.damping_ratio * OMEGA * 0.02), rtol=1e-12)


def test_zero_steps_keep_the_start():
    response = Oscillator(DYNAMICS, np.zeros((2, 0)), 0.01).respond(np.zeros((2, 0)), START)
    assert response.displacement.tolist() == [START[0]]
    assert response.velocity.tolist() == [START[1]]


def test_gauss_times_are_the_two_points_of_each_step():
    """They integrate a cubic exactly, which is what makes them Gauss points."""
    ends = np.array([0.0, 0.3, 1.0])
    points = gauss_times(ends)
    integral = (0.5 * np.diff(ends) * (points**3).sum(axis=0)).sum()
    assert integral == pytest.approx(0.25, rel=1e-14)


@pytest.mark.parametrize("step", [0.0, -0.01, 1.1 / OMEGA, math.nan])
def test_steps_that_do_not_resolve_the_oscillation_are_refused(step):
    with pytest.raises(ParameterError, match="natural frequency of 3 Hz"):
        Oscillator(DYNAMICS, np.zeros((2, 5)), step)


def test_a_fluctuation_of_the_wrong_shape_is_refused():
    with pytest.raises(ParameterError, match="Gauss points"):
        Oscillator(DYNAMICS, np.zeros(10), 0.01)


def test_a_forcing_of_the_wrong_length_is_refused():
    with pytest.raises(ParameterError, match="made for 10 steps"):
        Oscillator(DYNAMICS, np.zeros((2, 10)), 0.01).respond(np.zeros((2, 9)))
