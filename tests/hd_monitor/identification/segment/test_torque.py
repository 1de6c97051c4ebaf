"""The known torque: the true part of a measured torque remains, its noise does not."""

import numpy as np
import pytest

from hd_monitor.identification.segment.torque import own_acceleration, regress_torque

PERIOD = 1e-3  # s
TIMES = np.arange(4000) * PERIOD
MEAN, NOISE = 20.0, 0.2  # N·m: a joint's effort with a per cent of noise


def noise(seed, rate=125.0):
    """Noise of joint states at a rate [Hz], interpolated to the vibration's samples."""
    joint = np.arange(0.0, TIMES[-1] + 2.0 / rate, 1.0 / rate)
    return np.interp(TIMES, joint, NOISE * np.random.default_rng(seed).standard_normal(joint.size))


def steady(speed=2.0):
    return 0.3 + speed * TIMES, np.full(TIMES.size, speed)


def strokes():
    """There and back over 1.6 rad in 4 s."""
    return 0.8 * np.sin(0.5 * np.pi * TIMES), 0.4 * np.pi * np.cos(0.5 * np.pi * TIMES)


def smoothed(torque, motion):
    angle, speed = motion
    return regress_torque(torque, angle, speed, own_acceleration(speed, PERIOD), PERIOD)


def test_noise_on_a_constant_torque_is_removed_except_its_mean():
    """The mean of 500 joint states is known to a twentieth of the noise; nothing else may be left of it."""
    for seed in range(20):
        result = smoothed(MEAN + noise(seed), steady())
        assert np.std(result) < 0.05 * NOISE
        assert np.mean(result) == pytest.approx(MEAN, abs=4.0 * NOISE / np.sqrt(500.0))


def test_noise_of_the_speed_is_not_mistaken_for_friction():
    angle, speed = steady()
    noisy = speed + 0.004 * np.random.default_rng(3).standard_normal(speed.size)
    assert np.std(smoothed(MEAN + noise(4), (angle, noisy))) < 0.05 * NOISE


@pytest.mark.parametrize("order", [1, 2])
def test_gravity_and_load_stay(order):
    angle, speed = steady()
    truth = MEAN + 5.0 * np.cos(order * angle + 0.4)
    error = smoothed(truth + noise(5), (angle, speed)) - truth
    assert np.sqrt(np.mean(error**2)) < 0.2 * NOISE


def test_frictions_change_of_sign_stays_sharp():
    angle, speed = strokes()
    truth = MEAN + 3.0 * np.tanh(speed / (0.03 * np.abs(speed).max()))
    error = smoothed(truth + noise(6), (angle, speed)) - truth
    # smoothing over 0.08 s alone would leave some 40 % of the 6 N·m step at the reversal
    assert np.abs(error).max() < 1.5 * NOISE


def test_a_slow_process_force_stays():
    truth = MEAN + 4.0 * np.sin(2.0 * np.pi * 0.37 * TIMES)
    error = smoothed(truth + noise(7), steady()) - truth
    assert np.sqrt(np.mean(error[200:-200] ** 2)) < 0.5 * NOISE


def test_a_torque_without_noise_passes_unchanged():
    angle, speed = steady()
    assert smoothed(np.full(TIMES.size, MEAN), (angle, speed)) == pytest.approx(MEAN)
    truth = MEAN + 5.0 * np.cos(angle)
    assert smoothed(truth, (angle, speed)) == pytest.approx(truth, abs=1e-3)


def test_own_acceleration_is_the_speeds_slope():
    _, speed = strokes()
    truth = np.gradient(speed, PERIOD)
    found = own_acceleration(speed, PERIOD)
    assert found[100:-100] == pytest.approx(truth[100:-100], abs=2e-3 * np.abs(truth).max())
    assert not own_acceleration(np.full(100, 1.5), PERIOD).any()
