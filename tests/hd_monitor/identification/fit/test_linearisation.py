import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.fit.linearisation import Predictor
from hd_monitor.identification.fit.unknowns import Unknowns
from hd_monitor.identification.segment.segment import SegmentBuilder
from hd_monitor.model import Dynamics
from hd_monitor.reducer import Reducer

REDUCER, DYNAMICS = Reducer(), Dynamics()
UNKNOWNS = Unknowns(harmonics=2, load_orders=(1, 2), transmission_error=1.0)
RATE, TORQUE = 1000.0, 10.0
BUILDER = SegmentBuilder(reducer=REDUCER, harmonics=2, load_orders=(1, 2), natural_frequency=55.0)
PREDICTOR = Predictor(unknowns=UNKNOWNS, given=DYNAMICS, reference_torque=TORQUE)


def motion(times):
    """A stroke there and back: angle [rad], speed [rad/s] and acceleration [rad/s²]."""
    return 0.4 * np.sin(2.0 * times) + 0.3, 0.8 * np.cos(2.0 * times), -1.6 * np.sin(2.0 * times)


def values_at_random(seed):
    rng = np.random.default_rng(seed)
    values = UNKNOWNS.zero()
    values[UNKNOWNS.stiffness] = 0.05 * rng.standard_normal(8)
    values[UNKNOWNS.load] = rng.standard_normal(4)
    values[UNKNOWNS.displacement] = 0.4 * rng.standard_normal(8)
    values[UNKNOWNS.frequency], values[UNKNOWNS.damping] = 0.03, -0.2
    values[UNKNOWNS.torque], values[UNKNOWNS.inertia] = 0.1, 0.6
    values[UNKNOWNS.delay], values[UNKNOWNS.drift] = 0.002, 1e-3
    values[UNKNOWNS.hardening] = -0.3, -0.2, -0.1, 0.1
    return values


def segment(acceleration, builder=BUILDER):
    times = np.arange(acceleration.size) / RATE
    angle, speed, _ = motion(times)
    record = Record(
        start=0.0,
        period=1.0 / RATE,
        acceleration=acceleration,
        angle=angle,
        speed=speed,
        torque=np.full(times.size, TORQUE),
    )
    return builder.build([record], None)


def test_prediction_agrees_with_an_adaptive_integrator():
    """Stiffness that depends on twist and lines, errors, two loads, other dynamics, torque, lag and inertia at once."""
    values = values_at_random(1)
    parts = ("circular_spline", "flexspline", "load", "circular_spline_error", "flexspline_error")
    phasors = {part: UNKNOWNS.phasors(values, getattr(UNKNOWNS, part)) for part in parts}
    dynamics = UNKNOWNS.dynamics(DYNAMICS, values)
    omega, zeta = dynamics.angular_frequency, dynamics.damping_ratio

    def angle_after_lag(t):
        return motion(t + values[UNKNOWNS.delay] + values[UNKNOWNS.drift] * t)[0]

    def stiffness(t):
        late = angle_after_lag(t)
        total = 1.0
        for order, series in zip(
            REDUCER.output_orders, (phasors["circular_spline"], phasors["flexspline"]), strict=True
        ):
            total += sum((b * np.exp(1j * k * order * late)).real for k, b in enumerate(series, start=1))
        return total

    def error(t):
        """e [rad] and its rate [rad/s] at the angle that the output has after the lag."""
        late, speed = angle_after_lag(t), motion(t)[1]
        total, rate = 0.0, 0.0
        for order, part in zip(REDUCER.output_orders, parts[3:], strict=True):
            for k, b in enumerate(phasors[part] / 2.0 * np.pi / 180.0 / 60.0, start=1):
                turning = b * np.exp(1j * k * order * late)
                total, rate = total + turning.real, rate + (1j * k * order * speed * turning).real
        return total, rate

    def drive(t):
        angle, _, own = motion(t)
        load = sum((b * np.exp(1j * m * angle)).real for m, b in zip((1, 2), phasors["load"], strict=True))
        torque = TORQUE * np.exp(values[UNKNOWNS.torque]) + TORQUE * load
        return torque / DYNAMICS.inertia - values[UNKNOWNS.inertia] * own

    # The restoring torque by its definition: stiffness between the levels of twist, integrated finely
    unit = TORQUE / DYNAMICS.stiffness
    twists = unit * np.linspace(0.0, 30.0, 300_001)
    local = np.exp(np.interp(twists / unit, [0.0, 0.25, 0.5, 1.0, 2.0], [-0.3, -0.2, -0.1, 0.0, 0.1]))
    restoring = cumulative_trapezoid(local, x=twists, initial=0)

    def acceleration(t, x, v):
        e, de = error(t)
        wound = np.copysign(np.interp(abs(x + e), twists, restoring), x + e)
        return drive(t) - 2.0 * zeta * omega * (v + de) - omega**2 * stiffness(t) * wound

    times = np.arange(1200) / RATE
    start = [drive(0.0) / omega**2, 0.1]
    solution = solve_ivp(
        lambda t, y: (y[1], acceleration(t, *y)), (0.0, times[-1]), start, "DOP853", times, rtol=1e-10, atol=1e-14
    )
    measured = np.array([acceleration(t, *y) for t, y in zip(times, solution.y.T, strict=True)])
    line = PREDICTOR.linearise(segment(measured), values)
    # the two starting values are free, so a right prediction leaves nothing
    assert np.abs(line.residual).max() < 2e-3 * np.std(measured)


@pytest.mark.parametrize("place", range(UNKNOWNS.size))
def test_jacobian_is_the_derivative_of_the_prediction(place):
    values = values_at_random(place)
    rng = np.random.default_rng(place)
    plan = segment(rng.standard_normal(700))
    step = 1e-6 if place in (UNKNOWNS.delay, UNKNOWNS.drift) else 1e-4
    change = np.zeros(UNKNOWNS.size)
    change[place] = step
    here = PREDICTOR.linearise(plan, values)
    ahead, behind = (PREDICTOR.linearise(plan, values + sign * change) for sign in (1.0, -1.0))
    slope = (ahead.predicted - behind.predicted) / (2.0 * step)
    # the starting values are fitted along: compare but for the free vibrations
    both = np.stack([slope, here.jacobian[:, place]], axis=1)
    both -= here.free @ np.linalg.lstsq(here.free, both, rcond=None)[0]
    error = np.linalg.norm(both[:, 0] - both[:, 1]) / np.linalg.norm(both[:, 1])
    assert error < 0.03


def test_lines_after_a_lag_are_those_of_the_later_angle():
    path = segment(np.ones(400)).at_steps
    times = np.arange(400) / RATE
    inner = slice(20, -20)  # at the ends the acceleration is one-sided
    later = path.lines_after(0.004, 0.0)[inner]
    orders = [k * order for order in REDUCER.output_orders for k in (1, 2)]
    expected = np.exp(1j * np.multiply.outer(motion(times[inner] + 0.004)[0], orders))
    # by speed and acceleration: to the third order of the lag, a phase of 1e-5 rad
    np.testing.assert_allclose(later[:, [0, 1, 4, 5]], expected.real, atol=2e-5)
    np.testing.assert_allclose(later[:, [2, 3, 6, 7]], -expected.imag, atol=2e-5)


def test_moving_on_without_a_simulation_is_right_to_second_order():
    """Half the step, a quarter of the difference from what a simulation there says."""
    rng = np.random.default_rng(5)
    values = values_at_random(4)
    values[UNKNOWNS.hardening] = 0.0  # its law has corners
    part = segment(3.0 * rng.standard_normal(1200))
    here = PREDICTOR.linearise(part, values)
    step = 4e-3 * rng.standard_normal(UNKNOWNS.size) * UNKNOWNS.mask(UNKNOWNS.stiffness, UNKNOWNS.load)
    differences = []
    for size in (1.0, 0.5):
        there = PREDICTOR.linearise(part, values + size * step)
        moved = here.moved(part, size * step)
        differences.append(np.linalg.norm(moved.residual - there.residual))
        # what is measured is the sum of the two, wherever the linearisation stands
        np.testing.assert_allclose(
            (moved.predicted + moved.residual)[part.used], (here.predicted + here.residual)[part.used], atol=1e-9
        )
    assert differences[0] < 0.05 * np.linalg.norm(here.jacobian @ step)
    assert differences[0] / differences[1] == pytest.approx(4.0, rel=0.1)
