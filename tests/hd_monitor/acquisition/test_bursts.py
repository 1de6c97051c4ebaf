"""Samples stamped as a FIFO is read out go back to when they were taken; two mixed publishers are not taken for one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.acquisition.bursts import find_bursts, interleaved
from hd_monitor.acquisition.clock import recover_clock
from hd_monitor.arrays import FloatArray

PERIOD = 1e-3
COUNT = 1000


def read_out(size: int, spacing: float, jitter: float = 0.0, seed: int = 0) -> FloatArray:
    """Stamps [s] of samples taken every `PERIOD` and read out when `size` of them are there."""
    index = np.arange(COUNT)
    late = np.random.default_rng(seed).normal(0.0, jitter, COUNT)[index // size]
    return np.asarray((index // size * size + size - 1) * PERIOD + index % size * spacing + late)


@given(
    size=st.sampled_from([2, 3, 4, 8, 16, 32, 100, 200]),
    spacing=st.sampled_from([1e-6, 2e-5, 1e-4, 4e-4]),
    first=st.integers(0, 60),
    last=st.integers(940, COUNT),
)
def test_a_fifo_is_placed_where_it_sampled(size: int, spacing: float, first: int, last: int) -> None:
    clock = recover_clock(read_out(size, spacing)[first:last])
    assert clock is not None
    assert clock.burst == size
    assert clock.number.tolist() == list(range(last - first))
    assert clock.period == pytest.approx(PERIOD, rel=1e-9)
    assert clock.start == pytest.approx(first * PERIOD, abs=1e-9)


def test_a_fifo_stamped_all_at_once_loses_nothing() -> None:
    clock = recover_clock(read_out(16, 0.0))
    assert clock is not None
    assert (clock.burst, clock.duplicates, clock.order.size) == (16, 0, COUNT)


@given(seed=st.integers(0, 2**32))
def test_unsteady_read_outs_average_out(seed: int) -> None:
    jitter = 2e-4
    bursts = find_bursts(read_out(16, 2e-5, jitter, seed))
    assert bursts is not None
    assert bursts.number[-1] == COUNT - 1
    assert abs(bursts.start) < 6 * 2 * jitter / np.sqrt(COUNT // 16)


def test_lost_bursts_leave_a_hole() -> None:
    index = np.arange(COUNT)
    kept = (index // 16 != 20) & (index // 16 != 41) & (index // 16 != 42)
    bursts = find_bursts(read_out(16, 2e-5)[kept])
    assert bursts is not None
    assert np.array_equal(bursts.number, index[kept])


@given(
    jitter=st.floats(0.0, 2.0),
    loss=st.floats(0.0, 0.6),
    seed=st.integers(0, 2**32),
    ordered=st.booleans(),
)
def test_jitter_and_loss_by_chance_are_no_bursts(jitter: float, loss: float, seed: int, ordered: bool) -> None:
    rng = np.random.default_rng(seed)
    times = PERIOD * (np.arange(COUNT) + rng.normal(0.0, jitter, COUNT))[rng.random(COUNT) >= loss]
    assert find_bursts(np.sort(times) if ordered else times) is None


def test_messages_that_come_twice_stay_duplicates() -> None:
    clock = recover_clock(np.repeat(PERIOD * np.arange(COUNT), 2))
    assert clock is not None
    assert (clock.burst, clock.duplicates) == (1, COUNT)


@pytest.mark.parametrize("size", [2, 3])
def test_publishers_in_turn_are_no_fifo(size: int) -> None:
    rng = np.random.default_rng(1)
    number = np.arange(COUNT)
    own = np.sin(0.2 * (number // size) + 2.0 * (number % size)) + rng.normal(0.0, 0.1, COUNT)
    twice = np.sin(0.2 * (number // size)) + rng.normal(0.0, 0.001, COUNT)
    fifo = np.sin(0.2 * number) + rng.normal(0.0, 0.1, COUNT)
    noise = rng.normal(0.0, 1.0, COUNT)
    found = [interleaved(values, number, size) for values in (own, twice, fifo, noise)]
    assert found == [True, True, False, False]
