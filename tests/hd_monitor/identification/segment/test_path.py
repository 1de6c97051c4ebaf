"""The path along a motion: against scipy's Hermite spline and plain cosines, at points given one by one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from hd_monitor.identification.segment.path import Motion, paths_along, powers
from hd_monitor.model.oscillator import gauss_times
from hd_monitor.reducer import Mount, Reducer

STEP, START = 1e-3, 0.4  # s


def motion(seed: int, samples: int) -> Motion:
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(samples)
    angle = rng.uniform(-3.0, 3.0) + 2.0 * np.sin(3.0 * time + rng.uniform(0.0, 6.0))
    speed = np.gradient(angle, STEP) if samples > 1 else np.zeros(samples)
    return Motion(angle, speed, rng.normal(size=samples), rng.normal(size=samples), STEP, START)


@given(
    seed=st.integers(0, 1000),
    samples=st.integers(2, 40),
    substeps=st.integers(1, 5),
    harmonics=st.integers(1, 4),
    mount=st.sampled_from(Mount),
)
def test_lines_and_loads_are_those_of_the_angle_between_the_samples(
    seed: int, samples: int, substeps: int, harmonics: int, mount: Mount
) -> None:
    known, reducer, loads = motion(seed, samples), Reducer(mount=mount), (1, 2, 5)
    time = STEP * np.arange(samples)
    spline = CubicHermiteSpline(time, known.angle, known.speed)
    grid = STEP * np.arange((samples - 1) * substeps + 1) / substeps
    for path, points in zip(
        paths_along(known, reducer, harmonics, loads, substeps), (grid, gauss_times(grid)), strict=True
    ):
        q = spline(points)
        orders = [[k * order for k in range(1, harmonics + 1)] for order in reducer.output_orders]
        expected = [f(order * q) for own in orders for f in (np.cos, _minus_sine) for order in own]
        np.testing.assert_allclose(path.lines, np.stack(expected, axis=-1), atol=1e-10)
        np.testing.assert_allclose(path.rates, [order for own in orders for _ in range(2) for order in own])
        turning = [f(order * q) for f in (np.cos, _minus_sine) for order in loads]
        np.testing.assert_allclose(path.loads, np.stack(turning, axis=-1), atol=1e-12)
        np.testing.assert_allclose(path.time, START + points, atol=1e-12)
        for given_there, name in ((path.torque, "torque"), (path.speed, "speed"), (path.acceleration, "acceleration")):
            np.testing.assert_allclose(given_there, np.interp(points, time, getattr(known, name)), atol=1e-12)


def _minus_sine(angle: np.ndarray) -> np.ndarray:
    return -np.sin(angle)


def test_the_grid_begins_and_ends_with_the_samples() -> None:
    known = motion(3, 20)
    nodes, _ = paths_along(known, Reducer(), 1, (), 3)
    np.testing.assert_array_equal(nodes.torque[::3], known.torque)


def test_lines_after_a_delay_are_those_of_the_angle_then() -> None:
    known = motion(5, 30)
    later = 2e-4 * known.speed + 0.5 * 2e-4**2 * known.acceleration
    turned = known._replace(angle=known.angle + later)
    now, _ = paths_along(known, Reducer(), 3, (1,), 1)
    then, _ = paths_along(turned, Reducer(), 3, (1,), 1)
    np.testing.assert_allclose(now.lines_after(2e-4, 0.0), then.lines, atol=1e-10)


def test_a_delay_that_drifts_is_at_each_instant_that_of_its_time() -> None:
    now, _ = paths_along(motion(5, 30), Reducer(), 3, (1,), 1)
    drifting = now.lines_after(2e-4, 1e-3)
    for place, time in enumerate(now.time):
        np.testing.assert_allclose(drifting[place], now.lines_after(2e-4 + 1e-3 * time, 0.0)[place], atol=1e-12)


def test_powers_are_repeated_products() -> None:
    unit = np.exp(1j * np.array([0.1, math.pi]))
    for number, power in enumerate(powers(unit, 4)):
        assert power == pytest.approx(unit**number, abs=1e-14)
