import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_monitor.acquisition.record import JointSamples, Record
from hd_monitor.orders.joint_segment import (
    HIGHEST_SHARE,
    LONGEST,
    LOWEST_FREQUENCY,
    JointSegmentCutter,
    one_speed,
    samples_of_records,
)

ORDERS = (200.0, 202.0)


def samples(times, speed, *, with_speed=True, effort=None):
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(times))])
    return JointSamples(
        times=times,
        angle=angle,
        speed=speed if with_speed else np.full(times.size, np.nan),
        effort=np.cos(200.0 * angle) if effort is None else effort,
    )


def part(whole, chosen):
    return JointSamples(
        times=whole.times[chosen], angle=whole.angle[chosen], speed=whole.speed[chosen], effort=whole.effort[chosen]
    )


def swinging(rate=100.0, seconds=40.0, **options):
    times = np.arange(0.0, seconds, 1.0 / rate)
    return samples(times, 0.8 * np.cos(0.5 * times), **options)


def cut(whole, source="joint_effort", orders=ORDERS, minimum=0.03):
    cutter = JointSegmentCutter(source, orders, minimum)
    return cutter.add(whole) + cutter.finish()


def test_segments_keep_to_one_direction_and_alternate():
    segments = cut(swinging())
    assert [segment.direction for segment in segments] == [1, -1, 1, -1, 1, -1, 1]
    for segment in segments:
        assert np.all(segment.direction * np.diff(segment.angle) > 0.0)
        assert segment.speed.min() >= LOWEST_FREQUENCY * math.tau / 202.0
        assert segment.duration <= LONGEST


@settings(max_examples=40)
@given(st.lists(st.integers(0, 4000), max_size=12), st.booleans(), st.sampled_from([100.0, 500.0]))
def test_the_segments_do_not_depend_on_how_the_messages_are_chunked(cuts, with_speed, rate):
    whole = swinging(rate, 20.0, with_speed=with_speed)
    expected = cut(whole)
    cutter, found = JointSegmentCutter("joint_effort", ORDERS, 0.03), []
    for chosen in np.split(np.arange(len(whole)), sorted(min(c, len(whole)) for c in cuts)):
        found += cutter.add(part(whole, chosen))
    found += cutter.finish()
    assert len(found) == len(expected) > 0
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one.values, other.values)
        np.testing.assert_allclose(one.speed, other.speed, rtol=1e-12)
        np.testing.assert_array_equal(one.starts, other.starts)


def test_an_endless_rotation_is_cut_into_pieces():
    times = np.arange(0.0, 20.0, 0.01)
    segments = cut(samples(times, np.full(times.size, 0.5)))
    assert [round(segment.duration) for segment in segments] == [6, 6, 6, 2]
    assert sum(segment.values.size for segment in segments) == times.size


def test_lines_above_nyquist_are_left_out_and_counted():
    times = np.arange(0.0, 30.0, 0.01)
    speed = 0.3 + 0.1 * times  # up to 3.3 rad/s: 105 Hz at 100 Hz
    cutter = JointSegmentCutter("joint_effort", ORDERS, 0.03)
    segments = cutter.add(samples(times, speed)) + cutter.finish()
    limit = HIGHEST_SHARE * 100.0 * math.tau / 200.0
    assert max(segment.speed.max() for segment in segments) <= limit
    assert cutter.too_fast == pytest.approx(30.0 - (limit - 0.3) / 0.1, abs=0.2)
    assert cutter.turning == pytest.approx(30.0, abs=0.1)


def test_missing_messages_start_a_new_run_but_not_a_new_segment():
    whole = swinging()
    keep = np.ones(len(whole), dtype=bool)
    keep[100:105] = False
    keep[130] = False
    first = cut(part(whole, keep))[0]
    assert np.flatnonzero(first.starts).tolist() == [0, 100]  # one message missing is within the tolerance of stamps


@pytest.mark.parametrize("pause", [0.6, 5.0])
def test_a_long_pause_ends_a_segment(pause):
    times = np.arange(0.0, 4.0, 0.01)
    times[200:] += pause
    assert len(cut(samples(times, np.full(times.size, 0.5)))) == 2


def test_rows_without_the_signal_are_left_out():
    whole = swinging()
    whole.effort[50:60] = np.nan
    first = cut(whole)[0]
    assert np.isfinite(first.values).all()
    assert first.values.size == cut(swinging())[0].values.size - 10


def test_missing_speeds_follow_from_the_positions():
    known, unknown = cut(swinging()), cut(swinging(with_speed=False))
    assert len(known) == len(unknown)
    for one, other in zip(known, unknown, strict=True):
        assert one.direction == other.direction
        assert other.speed == pytest.approx(other.speed)
        assert abs(one.values.size - other.values.size) <= 6
        assert other.speed.max() == pytest.approx(one.speed.max(), rel=0.01)


@pytest.mark.parametrize("rate", [500.0, 1000.0, 2000.0])
def test_fast_samples_are_averaged_and_the_columns_allow_for_it(rate):
    whole = swinging(rate)
    segments = cut(whole)
    assert segments[0].averaged == int(rate / 250.0)
    for segment in segments:
        # The signal is cos(200 angle) exactly, so the column must be the averaged signal.
        np.testing.assert_allclose(segment.columns([200.0])[:, 0], segment.values, atol=1e-3)
        assert np.abs(np.cos(200.0 * segment.angle) - segment.values).max() > 0.01


def test_averages_do_not_span_gaps():
    whole = swinging(1000.0)
    keep = np.ones(len(whole), dtype=bool)
    keep[300:302] = False
    keep[500:600] = False
    for segment in cut(part(whole, keep)):
        np.testing.assert_allclose(segment.columns([200.0])[:, 0], segment.values, atol=2e-2)


@pytest.mark.parametrize("with_speed", [True, False])
def test_positions_may_wrap(with_speed):
    times = np.arange(0.0, 30.0, 0.01)
    whole = samples(times, 0.5 + 0.3 * np.cos(0.3 * times), with_speed=with_speed)
    wrapped = JointSamples(
        times=times, angle=np.mod(whole.angle + math.pi, math.tau) - math.pi, speed=whole.speed, effort=whole.effort
    )
    cutter, found = JointSegmentCutter("joint_effort", ORDERS, 0.03), []
    for chosen in np.array_split(np.arange(times.size), 17):
        found += cutter.add(part(wrapped, chosen))
    found += cutter.finish()
    expected = cut(whole)
    assert len(found) == len(expected) > 3
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one.angle, other.angle, atol=1e-9)
        np.testing.assert_allclose(one.speed, other.speed, atol=1e-9)


def test_velocity_can_be_the_signal():
    whole = swinging()
    first = cut(whole, source="joint_velocity")[0]
    np.testing.assert_array_equal(first.values, first.speed * first.direction)


def test_records_become_samples():
    record = Record(
        start=2.0,
        period=0.001,
        acceleration=np.arange(5.0),
        angle=np.ones(5),
        speed=np.full(5, 2.0),
        torque=np.full(5, np.nan),
    )
    both = samples_of_records([record, record])
    assert len(both) == 10
    np.testing.assert_array_equal(both.effort[:5], record.acceleration)
    assert len(samples_of_records([])) == 0


def test_one_speed_is_recognised():
    times = np.arange(0.0, 30.0, 0.01)
    assert one_speed(cut(samples(times, np.full(times.size, 0.5)))) == pytest.approx(0.5)
    assert math.isnan(one_speed(cut(swinging())))
    assert math.isnan(one_speed([]))


def test_no_samples_make_no_segments():
    cutter = JointSegmentCutter("joint_effort", ORDERS, 0.03)
    assert cutter.add(part(swinging(), slice(0, 0))) == []
    assert cutter.add(part(swinging(), slice(0, 1))) == []
    assert cutter.finish() == []
