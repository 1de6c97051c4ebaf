"""Periods are handed out once, in order, complete, whatever the inputs do."""

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.acquisition.stream import LATENESS, StampedBuffer
from hd_monitor.acquisition.timeline import Period, Timeline
from hd_monitor.sources import Quantity

SECOND = 1_000_000_000
STEP = 10_000_000


def feed(buffer: StampedBuffer, start: float, stop: float) -> None:
    stamps = np.arange(round(start * SECOND), round(stop * SECOND), STEP, dtype=np.int64)
    buffer.add(stamps, np.zeros((stamps.size, 1)))


def drain(timeline: Timeline) -> list[Period]:
    return list(iter(timeline.next, None))


def bounds_of(period: Period) -> tuple[int, int, bool]:
    return period.start, period.end, period.cut


def timeline_of_two() -> tuple[Timeline, StampedBuffer, StampedBuffer]:
    one, other = StampedBuffer(1), StampedBuffer(1)
    buffers = {Quantity.VIBRATION: one, Quantity.MOTION: other}
    return Timeline(buffers, buffers, SECOND, 2 * SECOND), one, other


def test_periods_start_at_whole_multiples_and_wait_for_both_inputs() -> None:
    timeline, one, other = timeline_of_two()
    feed(one, 10.3, 12.2)
    assert drain(timeline) == []
    feed(other, 10.6, 12.5)
    periods = drain(timeline)
    assert [(p.start // SECOND, p.end // SECOND, p.cut) for p in periods] == [(10, 11, True), (11, 12, False)]
    assert [p.epoch // SECOND for p in periods] == [10, 10]


def test_a_period_is_complete_only_when_late_samples_cannot_come_any_more() -> None:
    timeline, one, other = timeline_of_two()
    for buffer in (one, other):
        feed(buffer, 10.0, 11.0 + LATENESS / SECOND)  # the last stamp is one step short
    assert drain(timeline) == []
    for buffer in (one, other):
        feed(buffer, 11.0 + LATENESS / SECOND, 11.2)
    assert len(drain(timeline)) == 1


def test_a_silent_input_is_not_waited_for_longer_than_the_timeout() -> None:
    timeline, one, other = timeline_of_two()
    feed(one, 10.0, 11.5)
    feed(other, 10.0, 11.5)
    feed(one, 11.5, 16.0)
    assert [p.end // SECOND for p in drain(timeline)] == [11, 12, 13]


def test_time_without_any_data_is_jumped_over() -> None:
    timeline, one, other = timeline_of_two()
    for start in (10.0, 500.0):
        feed(one, start, start + 1.5)
        feed(other, start, start + 1.5)
    assert [p.end // SECOND for p in drain(timeline)] == [11, 12, 501]


def test_after_a_clock_set_back_the_new_time_base_is_taken() -> None:
    timeline, one, other = timeline_of_two()
    for start in (100.0, 20.0):
        feed(one, start, start + 2.5)
        feed(other, start, start + 2.5)
    assert [(p.end // SECOND, p.cut) for p in drain(timeline)] == [
        (101, True),
        (102, False),
        (103, False),
        (21, True),
        (22, False),
    ]


def test_one_input_whose_clock_alone_is_set_back_does_not_block_forever() -> None:
    timeline, one, other = timeline_of_two()
    feed(one, 100.0, 102.5)
    feed(other, 100.0, 102.5)
    feed(one, 20.0, 26.0)
    assert [p.end // SECOND for p in drain(timeline)][-1] >= 23


@given(
    cuts=st.lists(st.floats(0.0, 8.0), max_size=6),
    first=st.booleans(),
)
def test_grouping_and_interleaving_do_not_matter(cuts: list[float], first: bool) -> None:
    whole, one, other = timeline_of_two()
    feed(one, 10.0, 18.0)
    feed(other, 10.0, 18.0)
    expected = [bounds_of(period) for period in drain(whole)]
    timeline, one, other = timeline_of_two()
    bounds = [0.0, *sorted(cuts), 8.0]
    periods = []
    for start, stop in itertools.pairwise(bounds):
        for buffer in (one, other) if first else (other, one):
            feed(buffer, 10.0 + start, 10.0 + stop)
            periods += drain(timeline)
    assert [bounds_of(period) for period in periods] == expected
