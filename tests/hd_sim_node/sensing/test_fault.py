"""A failing sensor falls silent, repeats itself, or fades."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle import table_1

from hd_sim_node.drive.rig import Rig
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.accelerometer import Accelerometer, SensorSettings
from hd_sim_node.sensing.fault import Fault, FaultSettings

RATE = 1000.0
TURNING = SpeedProgramme(times=[0.0, 1.0], speeds=[1600.0, 1600.0])
NOISY = SensorSettings(noise=0.5, offset=0.2)


def measured(cuts, *, sensor=NOISY, **fault):
    rig = Rig(table_1(), TURNING, rate=RATE)
    accelerometer = Accelerometer(sensor, FaultSettings(**fault), rate=RATE, seed=1)
    return np.concatenate([accelerometer.measure(rig.advance(count)) for count in cuts])


def test_a_dead_sensor_leaves_noise_and_offset():
    alive, dead = measured([4000]), measured([4000], fault="dead", fault_after=1.0)
    np.testing.assert_array_equal(dead[:1000], alive[:1000])
    noise = measured([4000], sensor=SensorSettings(gain=0.0, noise=0.5, offset=0.2))
    np.testing.assert_array_equal(dead[1000:], noise[1000:])
    assert alive[1000:].std() > 2 * noise[1000:].std()


@pytest.mark.parametrize("cuts", [[1000], [100] * 10, [450, 50, 500], [1, 499, 1, 499]])
def test_a_stuck_sensor_repeats_its_last_value(cuts):
    values = measured(cuts, fault="stuck", fault_after=0.5)
    assert np.unique(values[:500]).size == 500
    assert np.all(values[500:] == values[499])


def test_one_that_is_stuck_from_the_start_repeats_its_first_value():
    values = measured([10, 90], fault="stuck")
    assert np.all(values == measured([1])[0])


def test_a_dying_sensor_fades():
    silent = SensorSettings(noise=0.0)
    alive, dying = (
        measured([4000], sensor=silent, fault=f, fault_after=1.0, fault_time=2.0) for f in ("none", "dying")
    )
    left = np.clip(1.0 - (np.arange(4000) / RATE - 1.0) / 2.0, 0.0, 1.0)
    dropped = dying == 0.0
    np.testing.assert_allclose(dying[~dropped], (left * alive)[~dropped], rtol=1e-12)
    assert not dropped[:1000].any()
    # The share of dropouts grows evenly to a tenth: a twentieth on average.
    assert np.count_nonzero(dropped[1000:3000]) == pytest.approx(100, abs=4 * 10)


def test_a_dying_sensors_noise_grows_tenfold():
    noise = measured([60_000], sensor=SensorSettings(gain=0.0, noise=0.5), fault="dying", fault_time=30.0)
    alive = noise[30_000:][noise[30_000:] != 0.0]
    assert alive.std() == pytest.approx(5.0, rel=4 / np.sqrt(2 * alive.size))
    assert alive.size / 30_000 == pytest.approx(0.9, abs=4 * np.sqrt(0.09 / 30_000))


def test_two_of_the_same_seed_lose_the_same_samples():
    times = np.arange(1000) / RATE
    chosen = FaultSettings(fault="dying", fault_time=0.001)
    one, three = (Fault(chosen, seed=4).interrupt(times, np.ones(shape)) for shape in ((1000,), (1000, 3)))
    np.testing.assert_array_equal(np.stack([one] * 3, axis=1), three)
    assert 0 < np.count_nonzero(one == 0.0) < 200


@settings(max_examples=20)
@given(
    st.lists(st.integers(1, 200), min_size=1, max_size=6),
    st.sampled_from(["none", "dead", "stuck", "dying"]),
    st.floats(0.0, 0.5),
    st.floats(0.01, 1.0),
)
def test_cuts_do_not_change_a_failure(cuts, fault, after, time):
    chosen = {"fault": fault, "fault_after": after, "fault_time": time}
    np.testing.assert_allclose(measured(cuts, **chosen), measured([sum(cuts)], **chosen), atol=1e-8)
