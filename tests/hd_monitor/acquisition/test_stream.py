"""Buffers hand out everything once, up to a time, and decide lateness and clock jumps by their own stamps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.acquisition.stream import CLOCK_JUMP, LATENESS, MOST_AT_ONCE, MOST_EPOCHS, StampedBuffer

MS = 1_000_000


def buffer_of(stamps: list[int], chunk: int = 1000) -> StampedBuffer:
    buffer = StampedBuffer(1)
    for first in range(0, len(stamps), chunk):
        part = np.array(stamps[first : first + chunk], dtype=np.int64)
        buffer.add(part, part[:, None].astype(float))
    return buffer


@given(
    steps=st.lists(st.integers(0, 40), min_size=1, max_size=60), chunk=st.integers(1, 60), until=st.integers(0, 2000)
)
def test_take_splits_consistently_however_it_was_fed(steps: list[int], chunk: int, until: int) -> None:
    stamps = (np.cumsum(steps) * MS).tolist()
    buffer = buffer_of(stamps, chunk)
    early, late = buffer.take(until * MS), buffer.take(2**62)
    assert early.stamps.tolist() == [s for s in stamps if s < until * MS]
    assert late.stamps.tolist() == [s for s in stamps if s >= until * MS]
    assert np.array_equal(early.values[:, 0], early.stamps)


@given(
    noise=st.lists(st.integers(-200, 200), min_size=2, max_size=80),
    chunks=st.tuples(st.integers(1, 80), st.integers(1, 80)),
)
def test_lateness_does_not_depend_on_chunks(noise: list[int], chunks: tuple[int, int]) -> None:
    stamps = [(20 * i + n + 1000) * MS for i, n in enumerate(noise)]
    one, other = (buffer_of(stamps, chunk) for chunk in chunks)
    assert (one.late, one.disordered, one.jumps) == (other.late, other.disordered, other.jumps)
    assert one.take(2**62).stamps.tolist() == other.take(2**62).stamps.tolist()


def test_a_sample_in_time_is_kept_and_a_late_one_dropped() -> None:
    newest = 10 * LATENESS
    buffer = buffer_of([newest, newest - LATENESS, newest - LATENESS - 1])
    assert (buffer.disordered, buffer.late) == (1, 1)
    assert buffer.take(2**62).stamps.size == 2


@given(chunk=st.integers(1, 130))
def test_a_clock_set_back_opens_a_new_time_base(chunk: int) -> None:
    before, after = [100 * CLOCK_JUMP, 100 * CLOCK_JUMP + MS], [20 * MS * i for i in range(120)]
    buffer = buffer_of(before + after, chunk)
    assert buffer.jumps == 1
    assert buffer.jumped
    assert buffer.take(2**62).stamps.tolist() == before
    buffer.pass_jump()
    assert buffer.newest == after[-1]
    assert buffer.take(2**62).stamps.tolist() == after


@given(place=st.integers(1, 118), leap=st.sampled_from([-3600, -5, 3600, 86400 * 365]), chunk=st.integers(1, 130))
def test_only_the_stray_stamp_is_dropped(place: int, leap: int, chunk: int) -> None:
    stamps = [4000 * CLOCK_JUMP + 20 * MS * i for i in range(120)]
    astray = [*stamps[:place], stamps[place] + leap * CLOCK_JUMP, *stamps[place + 1 :]]
    buffer = buffer_of(astray, chunk)
    assert (buffer.jumps, buffer.late, buffer.jumped) == (1, 1, False)
    assert buffer.take(2**62).stamps.tolist() == stamps[:place] + stamps[place + 1 :]


@given(chunk=st.integers(1, 130))
def test_a_long_pause_loses_nothing(chunk: int) -> None:
    stamps = [(0 if i < 60 else 7200 * 10**9) + 20 * MS * i for i in range(120)]
    buffer = buffer_of(stamps, chunk)
    assert (buffer.jumps, buffer.late) == (0, 0)
    assert buffer.take(2**62).stamps.tolist() == stamps


def test_the_earliest_sample_can_be_seen_without_taking_it() -> None:
    buffer = buffer_of([30 * MS, 20 * MS, 40 * MS])
    assert buffer.peek_first().stamps.tolist() == [20 * MS]
    assert buffer.take(2**62).stamps.size == 3
    assert buffer.peek_first().stamps.size == 0


def held(buffer: StampedBuffer) -> int:
    """Samples handed out by a buffer that is emptied, jumps of the clock included."""
    count = buffer.take(2**62).stamps.size
    while buffer.jumped:
        buffer.pass_jump()
        count += buffer.take(2**62).stamps.size
    return count


@pytest.mark.parametrize("leap", [0, -5, 3600])
def test_stamps_that_stand_still_do_not_fill_the_memory(leap: int) -> None:
    stamps = [4000 * CLOCK_JUMP, 4000 * CLOCK_JUMP + 900 * MS] + [
        (4000 + leap) * CLOCK_JUMP + 900 * MS
    ] * 3 * MOST_AT_ONCE
    buffer = buffer_of(stamps, 50)
    dropped, kept = buffer.dropped, held(buffer)
    assert dropped + kept + buffer._suspected == len(stamps)
    assert kept < 1.1 * MOST_AT_ONCE


def test_stamps_that_go_on_after_standing_still_are_taken() -> None:
    stamps = [CLOCK_JUMP] * 3 * MOST_AT_ONCE + [CLOCK_JUMP + MS * i for i in range(1, 200)]
    buffer = buffer_of(stamps, 50)
    assert buffer.take(2**62).stamps[-1] == stamps[-1]


def test_a_clock_that_keeps_jumping_back_fills_a_few_epochs_only() -> None:
    run = [20 * MS * i for i in range(60)]
    stamps = [(1000 - 10 * jump) * CLOCK_JUMP + stamp for jump in range(40) for stamp in run]
    buffer = buffer_of(stamps, 20)
    assert buffer.jumps == 39
    assert buffer.dropped == (40 - MOST_EPOCHS) * len(run)
    assert held(buffer) == MOST_EPOCHS * len(run)
