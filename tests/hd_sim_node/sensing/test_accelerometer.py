"""The virtual accelerometer's disturbances have the statistics that their parameters say."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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


@pytest.mark.parametrize("cuts", [[1000], [100] * 10, [450, 50, 500], [1, 499, 1, 499]])
def test_a_stuck_sensor_repeats_its_last_value(cuts):
    rig = Rig(ParametricModel(), QUIET, rate=RATE)
    sensor = Accelerometer(SensorSettings(noise=1.0, stuck_after=0.5), rate=RATE, seed=1)
    values = np.concatenate([sensor.measure(rig.advance(count)) for count in cuts])
    assert np.unique(values[:500]).size == 500
    assert np.all(values[500:] == values[499])


def test_stamps_are_the_sampling_instants():
    stamps = Accelerometer(PERFECT, rate=RATE).stamps(still(1000))
    assert stamps.dtype == np.int64
    assert stamps.tolist() == [n * 1_000_000 for n in range(1000)]


def test_jitter_has_its_standard_deviation_and_does_not_add_up():
    chunk = still()
    stamps = Accelerometer(replace(PERFECT, jitter=2e-4, delay=0.003), rate=RATE).stamps(chunk)
    error = stamps * 1e-9 - chunk.times
    assert error.mean() == pytest.approx(0.003, abs=4 * 2e-4 / np.sqrt(COUNT))
    assert error.std() == pytest.approx(2e-4, rel=4 / np.sqrt(2 * COUNT))
    assert abs(np.corrcoef(error, chunk.times)[0, 1]) < 4 / np.sqrt(COUNT)


DISTURBED = SensorSettings(noise=0.2, spike_rate=30.0, spike_size=5.0, jitter=1e-4, full_scale=2.0)


@settings(max_examples=20)
@given(st.lists(st.integers(1, 200), min_size=1, max_size=6))
def test_cuts_do_not_change_the_random_numbers(cuts):
    whole = Accelerometer(DISTURBED, rate=RATE, seed=5)
    chunk = still(sum(cuts))
    rig = Rig(ParametricModel(), QUIET, rate=RATE)
    cut = Accelerometer(DISTURBED, rate=RATE, seed=5)
    values, stamps = [], []
    for count in cuts:
        piece = rig.advance(count)
        values.append(cut.measure(piece))
        stamps.append(cut.stamps(piece))
    np.testing.assert_allclose(np.concatenate(values), whole.measure(chunk), atol=1e-9)
    np.testing.assert_array_equal(np.concatenate(stamps), whole.stamps(chunk))


def test_the_seed_decides():
    assert np.array_equal(measured(seed=3, count=50, noise=1.0), measured(seed=3, count=50, noise=1.0))
    assert not np.array_equal(measured(seed=3, count=50, noise=1.0), measured(seed=4, count=50, noise=1.0))


def test_one_disturbance_leaves_the_others_alone():
    plain, jittered = measured(count=50, noise=1.0), measured(count=50, noise=1.0, jitter=1.0)
    np.testing.assert_array_equal(plain, jittered)
