"""Records become segments: joined where they follow each other, ended where they do not, dropped where too short."""

import math

import numpy as np

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.segment.assembly import SHORTEST, SegmentAssembler

RATE, SPEED, MINIMUM = 1000.0, 1.0, 0.1  # Hz, rad/s, rad/s


def record(start, seconds, *, continues=True, speed=SPEED, torque=5.0, angle=None):
    times = start + np.arange(round(seconds * RATE)) / RATE
    return Record(
        start=start,
        period=1.0 / RATE,
        acceleration=np.sin(times),
        angle=speed * times if angle is None else np.full(times.size, angle),
        speed=np.full(times.size, speed),
        torque=np.full(times.size, torque),
        continues=continues,
    )


def test_records_that_follow_each_other_make_one_segment():
    collector = SegmentAssembler(MINIMUM)
    first, second = record(0.0, 1.0, continues=False), record(1.0, 1.0)
    assert collector.add(first, 2.0) == []
    assert collector.add(second, 2.0) == [[first, second]]
    assert collector.duration == 0.0
    assert collector.flush() == []


def test_a_gap_ends_a_segment():
    collector = SegmentAssembler(MINIMUM)
    first, second = record(0.0, 1.0, continues=False), record(5.0, 1.0, continues=False)
    collector.add(first, 4.0)
    assert collector.add(second, 4.0) == [[first]]
    assert collector.flush() == [[second]]


def test_a_standing_joint_ends_a_segment_and_is_left_out():
    collector = SegmentAssembler(MINIMUM)
    first = record(0.0, 1.0, continues=False)
    collector.add(first, 4.0)
    assert collector.add(record(1.0, 1.0, speed=0.0), 4.0) == [[first]]
    assert collector.duration == 0.0


def test_unknown_motion_ends_a_segment_and_is_left_out():
    collector = SegmentAssembler(MINIMUM)
    first = record(0.0, 1.0, continues=False)
    collector.add(first, 4.0)
    assert collector.add(record(1.0, 1.0, angle=math.nan), 4.0) == [[first]]
    assert collector.duration == 0.0


def test_known_and_unknown_torque_never_mix():
    collector = SegmentAssembler(MINIMUM)
    known, unknown = record(0.0, 1.0, continues=False), record(1.0, 1.0, torque=math.nan)
    collector.add(known, 4.0)
    assert collector.add(unknown, 4.0) == [[known]]
    assert collector.flush() == [[unknown]]


def test_what_is_too_short_is_dropped():
    collector = SegmentAssembler(MINIMUM)
    collector.add(record(0.0, 0.8 * SHORTEST, continues=False), 4.0)
    assert collector.flush() == []


def test_a_segment_of_hardly_any_samples_is_dropped():
    collector = SegmentAssembler(MINIMUM)
    empty = record(0.0, 1.0, continues=False)
    empty.acceleration[60:] = math.nan
    collector.add(empty, 4.0)
    assert collector.flush() == []
