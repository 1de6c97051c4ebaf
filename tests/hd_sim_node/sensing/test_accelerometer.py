"""The virtual accelerometer's disturbances have the statistics that their parameters say."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import table_1

from hd_monitor.model import ParametricModel
from hd_sim_node.drive.rig import Rig
from hd_sim_node.drive.surroundings import Surroundings
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.accelerometer import Accelerometer, SensorSettings

RATE = 1000.0
COUNT = 100_000
PERFECT = SensorSettings(noise=0.0)
QUIET = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 0.0])


def still(count=COUNT):
    """A stretch without any vibration, so that only the sensor's own doing shows."""
    return Rig(ParametricModel(), QUIET, rate=RATE).advance(count)


def measured(seed=0, count=COUNT, **values):
    return Accelerometer(replace(PERFECT, **values), rate=RATE, seed=seed).measure(still(count))


def test_a_perfect_sensor_puts_out_the_acceleration():
    rig = Rig(ParametricModel(), SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 600.0], cycles=1), rate=RATE)
    chunk = rig.advance(500)
    np.testing.assert_array_equal(Accelerometer(PERFECT, rate=RATE).measure(chunk), chunk.acceleration)


def test_it_feels_the_outputs_own_acceleration_where_that_counts():
    ramp = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 600.0], cycles=1)
    chunk = Rig(ParametricModel(), ramp, rate=RATE, surroundings=Surroundings(rigid_body=True)).advance(500)
    felt = Accelerometer(PERFECT, rate=RATE).measure(chunk)
    np.testing.assert_allclose(felt - chunk.acceleration, 600.0 * np.pi / 30.0 / 80.0, rtol=1e-9)


def test_noise_is_white_and_of_its_standard_deviation():
    noise = measured(noise=0.3)
    # Of N values the sample deviation itself deviates by 1/sqrt(2 N), the mean by 1/sqrt(N): four of them.
    assert noise.std() == pytest.approx(0.3, rel=4 / np.sqrt(2 * COUNT))
    assert noise.mean() == pytest.approx(0.0, abs=4 * 0.3 / np.sqrt(COUNT))
    neighbours = np.corrcoef(noise[:-1], noise[1:])[0, 1]
    assert neighbours == pytest.approx(0.0, abs=4 / np.sqrt(COUNT))


def test_offset_is_added():
    np.testing.assert_allclose(measured(count=10, offset=-2.5), -2.5, atol=1e-9)


def test_spikes_come_at_their_rate_and_size():
    spikes = measured(spike_rate=20.0, spike_size=50.0)
    hit = spikes[np.abs(spikes) > 1e-6]
    expected = 20.0 * COUNT / RATE
    assert hit.size == pytest.approx(expected, abs=4 * np.sqrt(expected))
    assert hit.std() == pytest.approx(50.0, rel=4 / np.sqrt(2 * expected))


def test_clipping_stops_at_full_scale():
    clipped = measured(noise=1.0, full_scale=0.8)
    assert np.abs(clipped).max() == 0.8
    assert np.mean(np.abs(clipped) == 0.8) == pytest.approx(0.4237, abs=0.01)


def test_values_are_multiples_of_the_resolution():
    coarse = measured(count=1000, noise=1.0, resolution=0.25)
    np.testing.assert_allclose(coarse / 0.25, np.round(coarse / 0.25), atol=1e-12)
    assert np.unique(coarse).size > 10


def test_the_gain_is_a_factor_on_the_signal_alone():
    moving = SpeedProgramme(times=[0.0, 1.0], speeds=[900.0, 900.0])
    chunk = Rig(table_1(), moving, rate=RATE).advance(500)
    settings = SensorSettings(noise=0.3, offset=2.0)
    noise = Accelerometer(replace(settings, gain=0.0), rate=RATE).measure(chunk)
    wrong = Accelerometer(replace(settings, gain=-1.2), rate=RATE).measure(chunk)
    np.testing.assert_allclose(wrong - noise, -1.2 * chunk.acceleration, atol=1e-12)


def test_the_seed_decides():
    assert np.array_equal(measured(seed=3, count=50, noise=1.0), measured(seed=3, count=50, noise=1.0))
    assert not np.array_equal(measured(seed=3, count=50, noise=1.0), measured(seed=4, count=50, noise=1.0))


def test_one_disturbance_leaves_the_others_alone():
    plain, spiky = (measured(count=5000, noise=1.0, spike_rate=rate) for rate in (0.0, 20.0))
    assert 50 < np.count_nonzero(plain != spiky) < 150
