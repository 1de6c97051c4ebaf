"""Positions and velocities that contradict each other, with the mistake that explains it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.acquisition.agreement import compare_motion
from hd_monitor.acquisition.record import JointSamples
from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.limitation import LimitationCode

TIMES = np.arange(1000) / 1000.0
REDUCTION = 80.0


def agreement(angle, speed, times=TIMES):
    samples = JointSamples(times=times, angle=angle, speed=speed, effort=np.zeros(times.size))
    return compare_motion(samples, minimum_speed=0.01, reduction=REDUCTION)


def contradiction(angle, speed, times=TIMES):
    found = agreement(angle, speed, times)
    assert found.moves
    return found.contradiction


@given(
    amplitude=st.floats(0.05, 3.0),
    rate=st.floats(0.1, 6.0),
    phase=st.floats(0.0, 6.3),
    period=st.sampled_from([0.001, 0.01, 0.05]),
    noise=st.floats(0.0, 0.1),
    seed=st.integers(0, 99),
)
def test_true_motion_with_noisy_velocities_is_accepted(amplitude, rate, phase, period, noise, seed):
    times = np.arange(0.0, 1.0, period)
    speed = amplitude * rate * np.cos(rate * times + phase)
    noisy = speed + noise * amplitude * rate * np.random.default_rng(seed).standard_normal(times.size)
    assert agreement(amplitude * np.sin(rate * times + phase), noisy, times).contradiction is None


def test_velocities_filtered_late_are_accepted():
    angle, late = np.sin(4.0 * TIMES), 4.0 * np.cos(4.0 * (TIMES - 0.05))
    assert contradiction(angle, late) is None


def test_a_standing_joint_contradicts_nothing():
    rng = np.random.default_rng(1)
    still = agreement(1e-5 * rng.standard_normal(TIMES.size), 1e-3 * rng.standard_normal(TIMES.size))
    assert still == (False, None)


def test_a_joint_that_turns_past_the_end_of_its_range_contradicts_nothing():
    angle = 3.0 * TIMES + 2.0
    assert contradiction(np.mod(angle + np.pi, 2.0 * np.pi) - np.pi, np.full(TIMES.size, 3.0)) is None


def test_messages_without_velocity_are_left_out():
    speed = np.where(np.arange(TIMES.size) % 2, np.nan, 0.5)
    assert contradiction(0.5 * TIMES, speed) is None
    assert agreement(0.5 * TIMES, np.full(TIMES.size, np.nan)) == (False, None)


@pytest.mark.parametrize(
    ("factor", "mistake"),
    [
        (-1.0, "opposite sign"),
        (np.pi / 180.0, "velocities in deg/s"),
        (2.0 * np.pi / 60.0, "velocities in rpm"),
        (1.0 / REDUCTION, "velocities of the motor"),
        (180.0 / np.pi, "positions in degrees"),
        (REDUCTION, "positions of the motor"),
    ],
)
@pytest.mark.parametrize("swing", [False, True])
def test_the_mistake_is_named(factor, mistake, swing):
    angle = np.sin(4.0 * TIMES) if swing else 0.5 * TIMES
    speed = 4.0 * np.cos(4.0 * TIMES) if swing else np.full(TIMES.size, 0.5)
    found = contradiction(max(abs(factor), 1.0) * angle, speed * np.sign(factor) / min(abs(factor), 1.0))
    assert found.code is LimitationCode.VELOCITY_UNIT
    assert found.values["ratio"] == pytest.approx(factor, rel=0.05)
    assert mistake in describe_limitation(found)


@pytest.mark.parametrize(
    ("angle", "speed", "code"),
    [
        (0.5 * TIMES, np.zeros(TIMES.size), LimitationCode.VELOCITY_ZERO),
        (0.5 * TIMES + np.arange(TIMES.size) ** 2 % 7, np.full(TIMES.size, 0.5), LimitationCode.POSITION_JUMPS),
        (np.zeros(TIMES.size), np.full(TIMES.size, 0.5), LimitationCode.POSITION_STILL),
        (0.5 * TIMES, np.full(TIMES.size, 1.0), LimitationCode.VELOCITY_SCALE),
        (np.sin(20.0 * TIMES), 3.0 * np.sin(23.0 * TIMES), LimitationCode.MOTION_INCONSISTENT),
    ],
)
def test_other_contradictions_are_named(angle, speed, code):
    assert contradiction(angle, speed).code is code


@pytest.mark.parametrize("angle", [np.zeros(TIMES.size), np.full(TIMES.size, 3.0)])
def test_a_joint_that_stands_contradicts_nothing_at_any_minimum_speed(angle):
    samples = JointSamples(times=TIMES, angle=angle, speed=np.zeros(TIMES.size), effort=angle)
    assert compare_motion(samples, minimum_speed=0.0, reduction=REDUCTION) == (False, None)
