"""What the messages of an input show to be wrong with it; what is merely noisy, uneven or slow is not."""

import numpy as np
import pytest

from hd_monitor.acquisition.flaws import effort_flaw, motion_flaw, vibration_flaw
from hd_monitor.acquisition.record import JointSamples
from hd_monitor.limitation import LimitationCode

RATE = 100.0
ORDER = 162.0
RNG = np.random.default_rng(7)


def samples(times=None, *, resolution=0.0, speed=None, effort=None, stamps=None):
    """Joint states of a swing that are taken at `times` [s] and stamped `stamps`."""
    times = np.arange(0.0, 2.0, 1.0 / RATE) if times is None else times
    angle = np.sin(2.0 * times)
    if resolution:
        angle = resolution * np.rint(angle / resolution)
    return JointSamples(
        times=times if stamps is None else stamps,
        angle=angle,
        speed=2.0 * np.cos(2.0 * times) if speed is None else np.full(times.size, speed),
        effort=10.0 + np.sin(times) if effort is None else effort,
    )


EVEN = np.arange(0.0, 2.0, 1.0 / RATE)
JITTERED = np.sort(EVEN + 0.005 * RNG.standard_normal(EVEN.size))


def test_coarse_positions_are_named():
    found = motion_flaw(samples(resolution=0.01), ORDER)
    assert found is not None
    assert found.code is LimitationCode.POSITION_STEPS
    assert found.values["step_rad"] == pytest.approx(0.01)


def test_jittering_stamps_are_named():
    found = motion_flaw(samples(stamps=JITTERED), ORDER)
    assert found is not None
    assert found.code is LimitationCode.MOTION_JITTER
    assert found.values["jitter_ms"] == pytest.approx(5.0, rel=0.3)


@pytest.mark.parametrize(
    "sound",
    [
        samples(),
        samples(resolution=0.001),
        samples(np.arange(0.0, 2.0, 1.0 / 512.0)),
        samples(JITTERED),
        samples(EVEN[RNG.random(EVEN.size) > 0.4]),
        samples(speed=np.nan),
        JointSamples(times=EVEN, angle=0.02 * EVEN * RATE, speed=np.full(EVEN.size, 2.0), effort=EVEN),
        JointSamples(times=EVEN, angle=np.zeros(EVEN.size), speed=np.zeros(EVEN.size), effort=EVEN),
        samples(EVEN[:0]),
    ],
    ids=["even", "fine", "fast", "sampled unevenly", "some lost", "no velocity", "steady", "standing", "none"],
)
def test_sound_motion_has_no_flaw(sound):
    assert motion_flaw(sound, ORDER) is None


@pytest.mark.parametrize(
    ("effort", "code"),
    [
        (np.repeat([8.0, 12.0, 9.0, 14.0], 50), LimitationCode.EFFORT_HELD),
        (10.0 + 20.0 * RNG.standard_normal(EVEN.size), LimitationCode.EFFORT_NOISY),
        (10.0 + RNG.standard_normal(EVEN.size), None),
        (np.full(EVEN.size, 10.0), None),
        (10.0 + 2.0 * np.sign(np.cos(2.0 * EVEN)), None),
        (np.full(EVEN.size, np.nan), None),
    ],
    ids=["held", "noisy", "sound", "constant", "friction", "none"],
)
def test_efforts_unfit_for_a_torque_are_named(effort, code):
    found = effort_flaw(samples(effort=effort))
    assert (found and found.code) == code


@pytest.mark.parametrize(("resolution", "is_coarse"), [(5.0, True), (0.5, False), (1e-3, False)])
def test_a_coarse_vibration_is_named(resolution, is_coarse):
    values = 2.0 * RNG.standard_normal(2000)
    found = vibration_flaw(resolution * np.rint(values / resolution))
    assert (found is not None) == is_coarse
