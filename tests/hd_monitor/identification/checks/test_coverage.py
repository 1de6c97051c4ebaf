"""How much motion was seen: sums that add up, whatever the segments are cut into."""

import math

import numpy as np
import pytest

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.checks.coverage import Coverage
from hd_monitor.identification.segment.segment import SegmentBuilder
from hd_monitor.reducer import Reducer

BUILDER = SegmentBuilder(reducer=Reducer(), harmonics=1, load_orders=(1, 2), natural_frequency=55.0)
RATE = 400.0  # Hz


def segment(start, speed):
    """A segment at the given speeds [rad/s], one a sample, from the output angle `start` [rad] on."""
    noise = np.random.default_rng(1).standard_normal(speed.size)
    record = Record(
        start=0.0,
        period=1.0 / RATE,
        acceleration=noise,
        angle=start + np.cumsum(speed) / RATE,
        speed=speed,
        torque=np.full(speed.size, 5.0),
    )
    return BUILDER.build([record], None)


def test_nothing_seen_means_no_motion():
    assert (Coverage().span, Coverage().mean_speed, Coverage().speed_varies) == (0.0, 0.0, False)


def test_a_way_there_and_back_covers_its_range_once():
    there, back = segment(0.0, np.full(800, 0.5)), segment(1.0, np.full(800, -0.5))
    seen = Coverage().plus(there).plus(back)
    assert seen.span == pytest.approx(1.0, abs=0.01)
    assert seen.way == pytest.approx(2.0)
    assert seen.time == pytest.approx(4.0)
    assert seen.mean_speed == pytest.approx(0.5)
    assert not seen.speed_varies


def test_speeds_of_several_segments_count_as_varying():
    slow, fast = segment(0.0, np.full(800, 0.5)), segment(0.0, np.full(800, 0.6))
    assert not Coverage().plus(slow).speed_varies
    assert not Coverage().plus(fast).speed_varies
    assert Coverage().plus(slow).plus(fast).speed_varies  # 9 % of the mean
    assert Coverage().plus(slow).plus(fast).top_speed == pytest.approx(0.6)


def test_a_run_up_varies_and_ripple_does_not():
    times = np.arange(800) / RATE
    assert Coverage().plus(segment(0.0, 0.3 + 0.2 * times)).speed_varies
    assert not Coverage().plus(segment(0.0, 0.5 + 0.01 * np.sin(math.tau * 3.0 * times))).speed_varies
