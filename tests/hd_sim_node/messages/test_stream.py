"""A simulation against a clock: nothing early, nothing twice, nothing lost, pauses and changes of pace included."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hd_sim_node.messages.stream import Stream
from hd_sim_node.settings import RigSettings
from hd_sim_node.simulation import Simulation

SECOND = 1_000_000_000
SETTINGS = RigSettings.from_mapping({"programme": "fixed", "duration": 2.0, "seed": 1})


def stream(scale=1.0):
    return Stream(Simulation(SETTINGS), scale)


def reference():
    return [(due, topic, row) for stretch in Simulation(SETTINGS) for due, topic, row in stretch.schedule()]


def handed(stream, clock):
    return [(topic, row) for _, topic, row in stream.due(clock)]


def test_hands_out_nothing_before_it_is_started():
    assert handed(stream(), 100.0) == []


@settings(max_examples=30)
@given(st.lists(st.floats(0.0, 0.7), min_size=1, max_size=10), st.sampled_from([0.5, 1.0, 8.0]))
def test_hands_out_each_message_once_when_it_is_due(waits, scale):
    source = stream(scale)
    source.start(50.0, 7 * SECOND)
    clock, got = 50.0, []
    everything = reference()
    for wait in [*waits, 1e3]:
        clock += wait
        got += handed(source, clock)
        elapsed = round((clock - 50.0) * scale * SECOND)
        assert got == [(topic, row) for due, topic, row in everything if due <= elapsed]
    assert source.ended
    assert handed(source, clock + 10.0) == []


def test_stamps_start_at_the_moment_of_the_start():
    source = stream()
    source.start(50.0, 7 * SECOND)
    assert source.epoch == 7 * SECOND


def test_a_pause_moves_the_stamps_but_loses_nothing():
    source = stream()
    source.start(50.0, 7 * SECOND)
    first = handed(source, 50.5)
    source.pause()
    assert handed(source, 60.0) == []
    source.start(60.0, 17 * SECOND)
    # The newest message was due at 0.499 s or 0.5 s, and that moment is now.
    assert source.epoch == pytest.approx(16.5 * SECOND, abs=0.002 * SECOND)
    rest = handed(source, 100.0)
    assert first + rest == [(topic, row) for _, topic, row in reference()]


def test_another_pace_counts_from_the_moment_of_the_change():
    source = stream(1.0)
    source.start(0.0, 0)
    handed(source, 0.5)
    source.set_scale(2.0, 0.5)
    handed(source, 0.9)
    assert source.position == pytest.approx(1.3, abs=0.011)


def test_lag_is_what_the_clock_is_ahead_by():
    """As when publishing is broken off because it takes too long."""
    source = stream(2.0)
    source.start(0.0, 0)
    for _ in source.due(0.5):
        if source.position >= 0.2:
            break
    assert source.lag(0.5) == pytest.approx(0.5 - 0.1, abs=0.011)
    handed(source, 0.5)
    assert source.lag(0.5) == 0.0


def test_lag_is_none_at_the_end():
    source = stream()
    source.start(0.0, 0)
    handed(source, 10.0)
    assert source.lag(20.0) == 0.0
