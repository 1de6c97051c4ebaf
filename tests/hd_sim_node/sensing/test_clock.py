"""The sensor's clock drifts, its stamps jitter, and a FIFO bunches them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor.errors import ParameterError
from hd_monitor.model import ParametricModel
from hd_sim_node.drive.rig import Rig
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.clock import Clock, ClockSettings

RATE = 1000.0
QUIET = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 0.0])


def stamped(count=1000, *cuts, seed=0, **values):
    rig, clock = Rig(ParametricModel(), QUIET, rate=RATE), Clock(ClockSettings(**values), rate=RATE, seed=seed)
    pieces = [clock.stamp(rig.advance(n)) for n in cuts or (count,)]
    return [np.concatenate(column) for column in zip(*pieces, strict=True)]


def test_a_right_clocks_stamps_are_the_sampling_instants():
    for stamps in stamped(1000):
        assert stamps.dtype == np.int64
        assert stamps.tolist() == [n * 1_000_000 for n in range(1000)]


def test_jitter_has_its_standard_deviation_and_does_not_add_up():
    count = 100_000
    stamps, _, due = stamped(count, jitter=2e-4, clock_offset=0.003)
    times = np.arange(count) / RATE
    error = stamps * 1e-9 - times
    assert error.mean() == pytest.approx(0.003, abs=4 * 2e-4 / np.sqrt(count))
    assert error.std() == pytest.approx(2e-4, rel=4 / np.sqrt(2 * count))
    assert abs(np.corrcoef(error, times)[0, 1]) < 4 / np.sqrt(count)
    np.testing.assert_array_equal(due, np.arange(count) * 1_000_000)


def test_a_fast_clock_counts_longer_periods_and_says_so():
    chosen = ClockSettings(clock_drift=50.0, clock_offset=-2.0)
    sampled, read, due = stamped(20_000, clock_drift=50.0, clock_offset=-2.0)
    np.testing.assert_array_equal(sampled, read)
    np.testing.assert_array_equal(sampled, np.arange(20_000) * 1_000_050 - 2_000_000_000)
    np.testing.assert_array_equal(due, np.arange(20_000) * 1_000_000)
    assert Clock(chosen, rate=RATE).period == pytest.approx(1.00005e-3, rel=1e-12)


def test_a_fifo_stamps_its_samples_when_it_is_read_out():
    sampled, read, due = stamped(96, fifo=32, fifo_spacing=2e-5)
    np.testing.assert_array_equal(sampled, np.arange(96) * 1_000_000)
    np.testing.assert_array_equal(read[:32], 31_000_000 + 20_000 * np.arange(32))
    np.testing.assert_array_equal(read[32:64] - read[:32], 32_000_000)
    np.testing.assert_array_equal(due, read)
    assert np.all(read >= sampled)


@settings(max_examples=25)
@given(
    st.lists(st.integers(1, 100), min_size=2, max_size=6),
    st.integers(1, 70),
    st.floats(-300.0, 300.0),
    st.floats(0.0, 1e-3),
)
def test_cuts_do_not_change_stamps(cuts, fifo, drift, jitter):
    values = {"fifo": fifo, "clock_drift": drift, "jitter": jitter, "clock_offset": 0.1}
    for whole, cut in zip(stamped(sum(cuts), **values), stamped(0, *cuts, **values), strict=True):
        np.testing.assert_array_equal(whole, cut)


def test_jitter_is_the_seeds():
    first, again, other = (stamped(100, seed=seed, jitter=1e-3)[0] for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.any(first != other)


def test_a_fifo_that_fills_faster_than_it_is_read_is_refused():
    slow = ClockSettings(fifo=8, fifo_spacing=2e-3)
    with pytest.raises(ParameterError, match=r"fifo_spacing = 0\.002 s is longer than the 0\.001 s"):
        slow.check(RATE)
    replace(slow, fifo=1).check(RATE)
    slow.check(500.0)
