"""The motion between joint states: exact for smooth motion, unknown in holes and outside."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.acquisition.motion import MotionTrack, TorqueTrack, even_stamps


def fed(times: np.ndarray, rows: np.ndarray, chunk: int = 10_000) -> MotionTrack:
    track = MotionTrack()
    for first in range(0, times.size, chunk):
        track.extend(times[first : first + chunk], rows[first : first + chunk])
    return track


@given(coefficients=st.tuples(*[st.floats(-1.0, 1.0)] * 4), chunk=st.integers(1, 120))
def test_cubic_motion_is_exact(coefficients: tuple[float, ...], chunk: int) -> None:
    curve = np.polynomial.Polynomial(coefficients)
    times = np.sort(np.random.default_rng(2).uniform(0.0, 1.0, 120))
    rows = np.column_stack([curve(times), curve.deriv()(times), np.full(120, 7.0)])
    inside = np.linspace(times[0], times[-1], 333)
    angle, _, torque = fed(times, rows, chunk).at(inside)
    assert np.allclose(angle, curve(inside), atol=1e-12)
    assert np.allclose(torque, 7.0)


def test_a_wrapping_joint_is_unwrapped() -> None:
    times = np.arange(0.0, 10.0, 0.01)
    true = 2.0 * times
    wrapped = (true + np.pi) % (2 * np.pi) - np.pi
    rows = np.column_stack([wrapped, np.full_like(true, 2.0), np.zeros_like(true)])
    angle = fed(times, rows, 7).at(times[:-1] + 0.005).angle
    assert np.allclose(angle, true[:-1] + 0.01, atol=1e-9)


def test_holes_and_the_outside_are_unknown() -> None:
    times = np.r_[0.0:1.0:0.01, 2.0:3.0:0.01]
    rows = np.column_stack([times, np.ones_like(times), np.zeros_like(times)])
    angle = fed(times, rows).at(np.array([-0.1, 0.5, 1.5, 2.5, 3.5]))[0]
    assert np.array_equal(np.isnan(angle), [True, False, True, False, True])


def test_missing_velocity_is_differentiated_and_missing_effort_stays_unknown() -> None:
    times = np.arange(0.0, 1.0, 0.01)
    rows = np.column_stack([np.sin(times), np.full_like(times, np.nan), np.full_like(times, np.nan)])
    motion = fed(times, rows).at(times[5:-5] + 0.003)
    assert np.allclose(motion.angle, np.sin(times[5:-5] + 0.003), atol=1e-6)
    assert np.allclose(motion.speed, np.cos(times[5:-5] + 0.003), atol=1e-3)
    assert np.isnan(motion.torque).all()


def test_bad_messages_are_left_out_and_counted() -> None:
    times = np.array([0.0, 0.01, 0.01, 0.02, 0.03])
    rows = np.column_stack([[0.0, 0.01, 9.0, np.nan, 0.03], np.ones(5), np.zeros(5)])
    track = MotionTrack()
    assert track.extend(times, rows).tolist() == [True, True, False, False, True]
    assert track.at(np.array([0.02])).angle == pytest.approx(0.02)


def moving(times: np.ndarray) -> np.ndarray:
    return np.column_stack([np.sin(times), np.cos(times), np.zeros_like(times)])


@given(seed=st.integers(0, 2**32), jitter=st.floats(1e-4, 1.5e-3))
def test_jitter_of_stamps_is_removed(seed: int, jitter: float) -> None:
    sampled = np.arange(100) * 0.01
    stamped = np.sort(sampled + np.random.default_rng(seed).normal(0.0, jitter, 100))
    evened = even_stamps(stamped, moving(sampled))
    # what is left is the error of a line fitted to the stamps: at most 2 sigma / sqrt(N) at its ends; five of them
    assert np.abs(evened - sampled).max() < 5 * 2 * jitter / np.sqrt(100)


@given(seed=st.integers(0, 2**32), unevenness=st.floats(1e-4, 3e-3))
def test_truly_uneven_sampling_keeps_its_stamps(seed: int, unevenness: float) -> None:
    sampled = np.sort(np.arange(100) * 0.01 + np.random.default_rng(seed).normal(0.0, unevenness, 100))
    assert np.array_equal(even_stamps(sampled, moving(sampled)), sampled)


def test_single_missing_efforts_are_bridged() -> None:
    times = np.arange(0.0, 1.0, 0.01)
    effort = 5.0 + times
    effort[::3] = np.nan
    torque = fed(times, np.column_stack([times, np.ones_like(times), effort])).at(times[2:-3]).torque
    assert np.allclose(torque, 5.0 + times[2:-3])


@pytest.mark.parametrize("chunk", [1, 7, 1000])
def test_a_torque_is_linear_between_its_samples_and_unknown_in_holes(chunk: int) -> None:
    times = np.r_[0.0:1.0:0.01, 2.0:3.0:0.01]
    torque = 5.0 + 2.0 * times
    torque[[10, 50]] = np.nan  # single missing values are bridged
    track = TorqueTrack()
    for first in range(0, times.size, chunk):
        track.extend(times[first : first + chunk], torque[first : first + chunk, None])
    asked = np.array([-0.1, 0.0, 0.105, 0.5, 0.985, 1.5, 2.0, 2.5, 3.5])
    expected = 5.0 + 2.0 * asked
    expected[[0, 5, 8]] = np.nan
    np.testing.assert_allclose(track.at(asked), expected, rtol=1e-12)
    track.forget(2.505)
    np.testing.assert_allclose(track.at(np.array([2.495])), [5.0 + 2.0 * 2.495])
    assert np.isnan(TorqueTrack().at(asked)).all()
