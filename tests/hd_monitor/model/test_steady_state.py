"""Harmonic balance against an independent solution, against time integration, and against its own equation."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests import oracle
from tests.oracle import table_1

from hd_monitor.errors import ParameterError
from hd_monitor.model import (
    Dynamics,
    Oscillator,
    ParametricModel,
    StiffnessSeries,
    Torque,
    gauss_times,
    line_pairs,
    scale_defects,
    steady_state,
)
from hd_monitor.model.simulation import constant_speed, simulate
from hd_monitor.reducer import Mount, Reducer


def integrated_period(model: ParametricModel, speed_rpm: float, steps_per_second: float = 16_000.0):
    """Two-sided lines of θ'' by output order, from time integration over one exact period after it has settled."""
    cs, fs = (round(x) for x in model.reducer.output_orders)
    common = math.gcd(cs, fs, model.torque.load_order) if model.torque.load_fluctuation else math.gcd(cs, fs)
    omega = math.tau * speed_rpm / 60.0 / model.reducer.reduction
    period = math.tau / common / omega
    settle = math.ceil(30.0 / (model.dynamics.damping_ratio * model.dynamics.angular_frequency) / period)
    steps = math.ceil(period * steps_per_second)
    times = np.linspace(0.0, (settle + 1) * period, (settle + 1) * steps + 1)
    between = omega * gauss_times(times)
    oscillator = Oscillator(model.dynamics, model.stiffness_fluctuation(between), period / steps)
    x, v = oscillator.respond(
        model.torque_at(between) / model.dynamics.inertia, (float(model.static_deflection(0.0)), 0.0)
    )
    last = slice(settle * steps, (settle + 1) * steps)
    acceleration = model.acceleration(omega * times[last], x[last], v[last])
    spectrum = np.fft.rfft(acceleration) / steps
    return {order: spectrum[order // common] for order in range(0, common * (steps // 2), common)}


@pytest.mark.parametrize("speed_rpm", sorted(oracle.LINES))
def test_lines_agree_with_an_independent_solution(speed_rpm):
    for pair, expected in zip(line_pairs(oracle.MODEL, speed_rpm), oracle.LINES[speed_rpm], strict=True):
        for line, printed in zip(pair, expected, strict=True):
            last_digit = 0.005 if printed > 10 else 0.00005
            assert abs(line - printed) <= oracle.RK4_ERROR * printed + last_digit


@pytest.mark.parametrize("speed_rpm", [400.0, 850.0, 1600.0, 3000.0])
def test_agrees_with_time_integration(speed_rpm):
    state = steady_state(oracle.MODEL, speed_rpm, combination_order=11)
    lines = integrated_period(oracle.MODEL, speed_rpm)
    largest = max(map(abs, lines.values()))
    for k in (1, 2, 3, 4):
        for order in (160 * k, 162 * k):
            assert state.acceleration_phasor(order) == pytest.approx(2 * lines[order], abs=2e-6 * largest)


def test_the_default_order_of_combinations_is_enough():
    """physics.md promises 2e-4 to 2e-3 of the largest line with |p| + |q| up to 7."""
    for speed in (400.0, 1600.0, 3000.0):
        wide = steady_state(oracle.MODEL, speed, combination_order=13)
        narrow = steady_state(oracle.MODEL, speed)
        largest = np.abs(wide.acceleration).max()
        for order in narrow.orders:
            difference = narrow.acceleration_phasor(order) - wide.acceleration_phasor(order)
            assert abs(difference) < 2e-4 * largest


@pytest.mark.parametrize("load_order", [1, 2])
def test_a_load_fluctuation_agrees_with_time_integration(load_order):
    model = table_1(
        torque=Torque(mean=10.0, load_fluctuation=5.0, load_phase=0.8, load_order=load_order, drive_fluctuation=1.0)
    )
    state = steady_state(model, 750.0, combination_order=11)
    lines = integrated_period(model, 750.0)
    largest = max(abs(line) for order, line in lines.items() if order)
    for base in (160, 162, 320, 322, 324, 486):
        for order in (base - load_order, base, base + load_order):
            assert state.acceleration_phasor(order) == pytest.approx(2 * lines.get(order, 0.0), abs=1e-4 * largest)


def test_a_load_at_the_difference_mirrors_the_lines():
    """Figure 9: with Mp2 at ωo1 - ωo2 the lines 2ωo2 - ωo1 and 2ωo1 - ωo2 appear beside the pair.

    They are there without a load too, but in second order of β: a small defect shows which is which.
    """
    small = scale_defects(table_1(), 0.01)
    with_load = steady_state(replace(small, torque=Torque(load_fluctuation=5.0)), 750.0)
    without = steady_state(small, 750.0)
    for mirror in (158, 164):
        assert abs(with_load.acceleration_phasor(mirror)) > 20 * abs(without.acceleration_phasor(mirror))


def test_satisfies_the_equation_of_motion():
    """Eq. 3 at any instant, with the series put in: nothing else is being solved."""
    model = table_1(torque=Torque(mean=10.0, drive_fluctuation=2.0, load_fluctuation=3.0))
    state = steady_state(model, 1100.0, combination_order=15)
    t = np.linspace(0.0, 0.7, 400)
    waves = np.exp(1j * np.outer(t, state.orders * state.output_speed))
    theta = (waves @ state.displacement).real
    velocity = (waves @ (1j * state.orders * state.output_speed * state.displacement)).real
    acceleration = (waves @ state.acceleration).real
    expected = model.acceleration(state.output_speed * t, theta, velocity)
    np.testing.assert_allclose(acceleration, expected, atol=1e-8 * np.abs(acceleration).max())


def test_without_a_defect_there_is_only_the_deflection():
    model = ParametricModel()
    state = steady_state(model, 750.0)
    assert state.displacement[state.orders == 0][0] == pytest.approx(10.0 / model.dynamics.stiffness)
    assert state.acceleration_rms == 0.0


def test_the_drive_ripple_falls_on_the_circular_splines_line():
    """In the rig's mount two per motor revolution are z1 cycles per output revolution: a small one is linear in H."""
    model = ParametricModel(torque=Torque(mean=0.0, drive_fluctuation=2.0))
    state = steady_state(model, 750.0)
    receptance = model.dynamics.receptance(25.0)
    expected = -((math.tau * 25.0) ** 2) * 2.0 / model.dynamics.stiffness * receptance
    assert state.acceleration_phasor(160) == pytest.approx(complex(expected), rel=1e-9)


def test_a_small_defect_is_the_first_order_formula():
    """For small β the line is β·M0/Kav passed through the resonator."""
    beta = 1e-5
    model = ParametricModel(flexspline=StiffnessSeries((beta,), (0.4,)))
    state = steady_state(model, 900.0)
    frequency = 162 * state.output_speed / math.tau
    deflection = model.torque.mean / model.dynamics.stiffness
    expected = (math.tau * frequency) ** 2 * deflection * beta * np.exp(0.4j) * model.dynamics.receptance(frequency)
    assert state.acceleration_phasor(162) == pytest.approx(complex(expected), rel=1e-4)


def test_the_series_is_real():
    state = steady_state(table_1(), 750.0)
    np.testing.assert_array_equal(state.orders, -state.orders[::-1])
    np.testing.assert_allclose(state.displacement, state.displacement[::-1].conj(), atol=1e-18)


def test_the_rms_is_that_of_the_lines():
    state = steady_state(table_1(), 750.0)
    amplitudes = [abs(state.acceleration_phasor(order)) for order in state.orders if order > 0]
    assert state.acceleration_rms == pytest.approx(math.sqrt(sum(a * a for a in amplitudes) / 2))


def test_other_orders_have_no_amplitude():
    assert steady_state(table_1(), 750.0).acceleration_phasor(161) == 0j


def test_frequencies_agree_with_the_reducer():
    state = steady_state(table_1(), 750.0)
    for order, frequency in ((160, 25.0), (162, 25.3125)):
        assert order in state.orders
        assert order * state.output_speed / math.tau == pytest.approx(frequency)


def test_the_direction_of_rotation_does_not_matter_without_phases():
    assert line_pairs(table_1(), 750.0) == line_pairs(table_1(), -750.0)


def test_turning_back_with_phases_agrees_with_time_integration():
    # these phases are not a mere shift of the origin: the defects differ between the directions
    model = replace(oracle.MODEL, flexspline=StiffnessSeries((0.06, 0.03, 0.02), (0.0, 1.0, -2.0)))
    state = steady_state(model, -1600.0, combination_order=11)
    run = simulate(model, constant_speed(model.reducer, -1600.0), duration=9.0, rate=8000.0)
    last = slice(-12_000, None)  # 1.5 s are 40 wave-generator revolutions: a whole period
    for order in (160, 162, 320, 324):
        line = 2.0 * np.mean(run.acceleration[last] * np.exp(-1j * order * run.output_angle[last]))
        assert abs(state.acceleration_phasor(order)) == pytest.approx(abs(line), abs=1e-4 * 33.0)
    back, forth = (line_pairs(model, speed)[2] for speed in (-1600.0, 1600.0))
    assert back.flexspline != pytest.approx(forth.flexspline, rel=1e-3)


def test_the_other_mount_has_the_same_lines_per_output_revolution():
    reducer = Reducer(flexspline_teeth=200, circular_spline_teeth=202, mount=Mount.FLEXSPLINE_FIXED)
    model = table_1(reducer=reducer, dynamics=Dynamics(natural_frequency=30.0))
    state = steady_state(model, 600.0, combination_order=11)
    lines = integrated_period(model, 600.0)
    largest = max(abs(line) for order, line in lines.items() if order)
    for order in (200, 202, 400, 404):
        assert state.acceleration_phasor(order) == pytest.approx(2 * lines[order], abs=1e-5 * largest)


@pytest.mark.parametrize("speed", [0.0, math.nan, math.inf])
def test_a_speed_without_lines_is_refused(speed):
    with pytest.raises(ParameterError, match="speed"):
        steady_state(table_1(), speed)
