"""The recovered clock is even, keeps every sample in its place and tolerates jitter, loss and disorder."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.acquisition.clock import recover_clock
from hd_monitor.arrays import FloatArray

PERIOD = 1e-3


def even(count: int, seed: int, jitter: float) -> FloatArray:
    stamps = 12.5 + PERIOD * np.arange(count) + np.random.default_rng(seed).normal(0.0, jitter, count)
    return np.asarray(stamps, dtype=np.float64)


def test_even_stamps_give_themselves() -> None:
    clock = recover_clock(even(500, 0, 0.0))
    assert clock is not None
    assert np.array_equal(clock.number, np.arange(500))
    assert clock.start == pytest.approx(12.5, abs=1e-12)
    assert clock.period == pytest.approx(PERIOD, rel=1e-12)
    assert clock.jitter < 1e-12


@given(seed=st.integers(0, 2**32), jitter=st.floats(0.0, 0.07), lost=st.sets(st.integers(1, 398), max_size=40))
def test_missing_samples_leave_their_places_empty(seed: int, jitter: float, lost: set[int]) -> None:
    kept = np.array(sorted(set(range(400)) - lost))
    clock = recover_clock(even(400, seed, jitter * PERIOD)[kept])
    assert clock is not None
    assert np.array_equal(clock.number, kept)


@given(seed=st.integers(0, 2**32))
def test_heavy_jitter_averages_out(seed: int) -> None:
    count, jitter = 1000, 0.4 * PERIOD
    clock = recover_clock(even(count, seed, jitter))
    assert clock is not None
    assert np.array_equal(clock.order, np.arange(count))
    assert np.array_equal(clock.number, np.arange(count))
    assert clock.jitter == pytest.approx(jitter, rel=0.2)
    # standard deviation of a fitted line's start: 2 sigma / sqrt(N); six of them
    assert abs(clock.start - 12.5) < 6 * 2 * jitter / np.sqrt(count)


@given(seed=st.integers(0, 2**32), lost=st.integers(200, 800))
def test_loss_under_heavy_jitter_is_counted_and_placed_nearly(seed: int, lost: int) -> None:
    hole = 4
    kept = np.r_[0:lost, lost + hole : 1000]
    clock = recover_clock(even(1000, seed, 0.3 * PERIOD)[kept])
    assert clock is not None
    assert clock.number[-1] == 999
    wrong = np.abs(clock.number - kept)
    assert wrong.max() <= hole
    assert np.count_nonzero(wrong) <= 41  # the hole is placed to within the smoothing: 41 samples


def test_reordered_messages_are_sorted() -> None:
    times = even(300, 0, 0.0)
    swapped = np.arange(300)
    swapped[[10, 11, 200, 203]] = swapped[[11, 10, 203, 200]]
    clock = recover_clock(times[swapped])
    assert clock is not None
    assert np.array_equal(swapped[clock.order], np.arange(300))
    assert np.array_equal(clock.number, np.arange(300))


def test_duplicates_are_left_out_and_counted() -> None:
    times = np.repeat(12.5 + PERIOD * np.arange(100), [2 if i % 10 == 0 else 1 for i in range(100)])
    clock = recover_clock(times)
    assert clock is not None
    assert clock.duplicates == 10
    assert np.array_equal(clock.number, np.arange(100))


def test_a_hole_of_seconds_keeps_its_length() -> None:
    kept = np.r_[0:300, 5300:5600]
    clock = recover_clock(even(5600, 0, 0.0)[kept])
    assert clock is not None
    assert np.array_equal(clock.number, kept)


@pytest.mark.parametrize("times", [[], [1.0], [1.0, 1.0, 1.0, 1.0], [1.0, 2.0]])
def test_too_few_stamps_give_no_clock(times: list[float]) -> None:
    assert recover_clock(np.array(times)) is None
