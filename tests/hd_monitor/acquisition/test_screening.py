"""Bad samples are found, counted and left out; good vibration passes untouched."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.oracle import table_1

from hd_monitor.acquisition.screening import screen
from hd_monitor.model.simulation import simulate

TIMES = np.arange(1000) * 1e-3


@pytest.fixture(scope="module", params=[(2000.0, 0.4, 0.15), (3000.0, 4.0, 1.9)], ids=["fast reversals", "slow ramps"])
def strokes(request: pytest.FixtureRequest) -> np.ndarray:
    """8 s of vibration [rad/s²] at 1 kHz from strokes through the resonance: speed [rpm], length and ramp [s]."""
    speed, length, ramp = request.param
    grid = np.linspace(0.0, 8.0, 80_001)
    corners = [0.0, ramp, length - ramp, length, length + ramp, 2.0 * length - ramp, 2.0 * length]
    turning = np.interp(grid % (2.0 * length), corners, [0, 1, 1, 0, -1, -1, 0]) * speed * math.tau / 60.0 / 80.0
    angle = np.cumsum(turning) * grid[1]
    response = simulate(table_1(), lambda times: np.interp(times, grid, angle), duration=8.0, rate=8000.0)
    return response.acceleration[::8] + np.random.default_rng(3).normal(0.0, 0.2, 8000)


def left_out(vibration: np.ndarray) -> list[int]:
    """Places of the samples left out, each second screened by itself as a monitor does."""
    seconds = [screen(part).values for part in np.split(vibration, 8)]
    return np.flatnonzero(np.isnan(np.concatenate(seconds))).tolist()


@given(
    frequency=st.floats(1.0, 330.0),
    amplitude=st.floats(1e-6, 1e6),
    noise=st.floats(0.0, 1.0),
    seed=st.integers(0, 2**32),
)
def test_vibration_passes_untouched(frequency: float, amplitude: float, noise: float, seed: int) -> None:
    values = np.sin(2 * np.pi * frequency * TIMES + 0.3) + np.random.default_rng(seed).normal(0.0, noise, TIMES.size)
    screened = screen(amplitude * values)
    assert np.array_equal(screened.values, amplitude * values)
    assert screened[1:] == (0, 0, 0, 0)


@given(places=st.sets(st.integers(2, 330), min_size=1, max_size=8), sign=st.sampled_from([-1.0, 1.0]))
def test_only_spikes_are_found(places: set[int], sign: float) -> None:
    values = np.sin(2 * np.pi * 56.0 * TIMES) + np.random.default_rng(1).normal(0.0, 0.1, TIMES.size)
    where = 3 * np.array(sorted(places))
    values[where] += sign * 20.0
    screened = screen(values)
    assert np.flatnonzero(np.isnan(screened.values)).tolist() == where.tolist()
    assert screened.spikes == where.size


@given(size=st.floats(5.0, 1000.0), time_constant=st.floats(0.02, 0.3))
def test_a_growing_level_is_not_a_spike(size: float, time_constant: float) -> None:
    level = 1.0 + size / (1.0 + np.exp(-(TIMES - 0.6) / time_constant))  # a resonance passed on the way
    assert screen(level * np.sin(2 * np.pi * 56.0 * TIMES)).spikes == 0


def test_strokes_through_the_resonance_pass_untouched(strokes: np.ndarray) -> None:
    assert left_out(strokes) == []


@pytest.mark.parametrize("size", [3.0, 10.0, 30.0])
def test_only_the_spikes_of_strokes_are_left_out(strokes: np.ndarray, size: float) -> None:
    rng = np.random.default_rng(4)
    places = np.sort(rng.choice(strokes.size, 25, replace=False))
    spiked = strokes.copy()
    spiked[places] += size * strokes.std() * rng.choice([-1.0, 1.0], 25)
    assert left_out(spiked) == places.tolist()


@pytest.mark.parametrize(
    ("place", "shape"),
    [(0, [1.0]), (1, [1.0]), (999, [1.0]), (0, [1.0, 1.0]), (500, [1.0, 1.0]), (500, [1.0, -1.0]), (500, [1.0] * 3)],
)
def test_spikes_in_a_row_and_at_the_ends_are_left_out(strokes: np.ndarray, place: int, shape: list[float]) -> None:
    places = 4000 + np.arange(place, place + len(shape))
    spiked = strokes.copy()
    spiked[places] += 10.0 * strokes.std() * np.array(shape)
    assert left_out(spiked) == places.tolist()


def test_spikes_beside_a_missing_sample_are_left_out(strokes: np.ndarray) -> None:
    spoilt = strokes[4000:5000].copy()
    spoilt[[500, 501]] = np.nan, 100.0 * strokes.std()
    spoilt[504] = 100.0 * strokes.std()
    screened = screen(spoilt)
    assert (screened.not_finite, screened.spikes) == (1, 2)
    assert np.flatnonzero(np.isnan(screened.values)).tolist() == [500, 501, 504]


def test_not_finite_values_are_left_out() -> None:
    values = np.sin(2 * np.pi * 56.0 * TIMES)
    values[[3, 500, 800]] = np.nan, np.inf, -1e300  # the last has no finite square
    screened = screen(values)
    assert screened.not_finite == 3
    assert np.flatnonzero(np.isnan(screened.values)).tolist() == [3, 500, 800]


@pytest.mark.parametrize("full_scale", [0.0, 0.8])
def test_clipped_samples_are_left_out(full_scale: float) -> None:
    values = np.clip(np.sin(2 * np.pi * 20.0 * TIMES), -0.8, 0.8)
    at_stop = np.abs(values) == 0.8
    screened = screen(values, full_scale=full_scale)
    assert screened.clipped == at_stop.sum()
    assert np.array_equal(np.isnan(screened.values), at_stop)


def test_a_stuck_sensor_is_noticed_only_while_the_joint_turns() -> None:
    values = np.sin(2 * np.pi * 56.0 * TIMES)
    values[300:700] = values[300]
    assert screen(values).stuck == 400
    assert screen(values, turning=False).stuck == 0
