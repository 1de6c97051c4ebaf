"""Whole records against the independent oracle lines, against the order of the method, and against themselves."""

import numpy as np
import pytest
from tests import oracle
from tests.oracle import table_1

from hd_monitor.errors import ParameterError
from hd_monitor.model import Torque
from hd_monitor.model.simulation import constant_speed, linear_sweep, simulate
from hd_monitor.reducer import Reducer


@pytest.mark.parametrize("speed", oracle.LINES)
def test_lines_agree_with_the_runge_kutta_oracle(speed):
    revolution = 60.0 * oracle.MODEL.reducer.reduction / speed
    settling = 3.0
    response = simulate(
        oracle.MODEL, constant_speed(oracle.MODEL.reducer, speed), duration=settling + revolution, rate=4000.0
    ).after(settling)
    size = round(revolution * response.rate)
    samples, angle = response.acceleration[:size], response.output_angle[:size]
    orders = [k * order for k in range(1, 5) for order in oracle.MODEL.reducer.output_orders]
    measured = [2.0 * abs(np.mean(samples * np.exp(-1j * order * angle))) for order in orders]
    expected = np.ravel(oracle.LINES[speed])
    assert np.abs(measured - expected).max() <= 2e-3 * expected.max()


def test_error_falls_with_the_fourth_power_of_the_step():
    model = table_1()
    motion = constant_speed(model.reducer, 1500.0)
    fine = simulate(model, motion, duration=0.4, rate=64_000.0)

    def error(rate: float) -> float:
        coarse = simulate(model, motion, duration=0.4, rate=rate)
        return float(np.abs(coarse.displacement - fine.displacement[:: round(64_000.0 / rate)]).max())

    order = np.log2(error(1000.0) / error(2000.0))
    assert order == pytest.approx(4.0, abs=0.3)


def test_acceleration_is_the_derivative_of_the_velocity():
    response = simulate(table_1(), constant_speed(Reducer(), 900.0), duration=0.5, rate=20_000.0)
    numeric = (response.velocity[2:] - response.velocity[:-2]) * response.rate / 2.0
    assert np.abs(numeric - response.acceleration[1:-1]).max() < 1e-3 * np.abs(response.acceleration).max()


def test_a_standing_joint_stays_at_its_wind_up():
    model = table_1(torque=Torque(mean=7.0))
    response = simulate(model, np.zeros_like, duration=0.2, rate=2000.0)
    assert response.displacement == pytest.approx(7.0 / (model.dynamics.stiffness * 1.22), rel=1e-9)
    assert np.abs(response.acceleration).max() < 1e-6


def test_sweep_moves_the_circular_splines_line():
    reducer = Reducer()
    motion = linear_sweep(reducer, 2.0, 0.5)
    times = np.array([10.0, 10.0 + 1e-5])
    output_frequency = np.diff(motion(times))[0] / 1e-5 / (2.0 * np.pi)
    assert output_frequency * reducer.output_orders.circular_spline == pytest.approx(2.0 + 0.5 * 10.0, rel=1e-5)


def test_the_part_after_a_time_starts_there():
    response = simulate(table_1(), constant_speed(Reducer(), 600.0), duration=1.0, rate=1000.0)
    later = response.after(0.25)
    assert later.times[0] == 0.0
    assert later.times.size == 750
    assert later.acceleration[0] == response.acceleration[250]
    assert response.after(2.0).times.size == 0


@pytest.mark.parametrize(("duration", "rate"), [(0.0, 1000.0), (-1.0, 1000.0), (1.0, 0.0), (float("nan"), 1000.0)])
def test_an_empty_simulation_is_refused(duration, rate):
    with pytest.raises(ParameterError, match="hold no samples"):
        simulate(table_1(), np.zeros_like, duration=duration, rate=rate)


def test_a_rate_too_low_for_the_resonance_is_refused():
    with pytest.raises(ParameterError, match="do not resolve"):
        simulate(table_1(), np.zeros_like, duration=1.0, rate=100.0)
