"""Loss, duplicates and lateness of messages have the rates that their parameters say."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_sim_node.messages.transport import Transport, TransportSettings

COUNT = 40_000
DUE = np.arange(COUNT) * 1_000_000


def dispatch(due=DUE, seed=0, **values):
    return Transport(TransportSettings(**values), seed=seed).dispatch(due)


def rate_error(rate):
    """Four standard deviations of a counted fraction."""
    return 4 * np.sqrt(rate * (1 - rate) / COUNT)


def test_a_perfect_transport_sends_everything_in_time():
    due, row = dispatch()
    np.testing.assert_array_equal(due, DUE)
    np.testing.assert_array_equal(row, np.arange(COUNT))


def test_loss():
    sent = dispatch(loss=0.03).row
    assert np.unique(sent).size == sent.size
    assert 1 - sent.size / COUNT == pytest.approx(0.03, abs=rate_error(0.03))


def test_duplicates():
    sent = dispatch(duplicates=0.05).row
    counts = np.bincount(sent, minlength=COUNT)
    assert set(counts.tolist()) == {1, 2}
    assert np.mean(counts == 2) == pytest.approx(0.05, abs=rate_error(0.05))


def test_late_messages_let_later_ones_pass():
    sent = dispatch(late=0.02).row
    np.testing.assert_array_equal(np.sort(sent), np.arange(COUNT))
    overtaken = np.maximum.accumulate(sent) > sent
    assert np.mean(overtaken) == pytest.approx(0.02, abs=rate_error(0.02) + 0.002)
    behind = np.argsort(sent) - np.arange(COUNT)
    assert 1 <= behind.max() <= 5


@given(
    st.integers(0, 50),
    st.floats(0, 1),
    st.floats(0, 1),
    st.floats(0, 1),
    st.integers(0, 1000),
)
def test_messages_are_sent_by_due_time_within_the_stretch(count, loss, duplicates, late, seed):
    due, row = dispatch(DUE[:count], seed=seed, loss=loss, duplicates=duplicates, late=late)
    assert due.size == row.size
    assert np.all(np.diff(due) >= 0)
    assert np.all(due >= DUE[:count][row])
    if due.size:
        assert due[-1] <= DUE[count - 1]
    assert np.bincount(row, minlength=count).max(initial=0) <= 2


@given(st.lists(st.integers(1, 60), min_size=1, max_size=6))
def test_cuts_do_not_change_which_messages_are_lost(cuts):
    settings = TransportSettings(loss=0.2, duplicates=0.2)
    total = sum(cuts)
    whole = Transport(settings, seed=4, topic="t").dispatch(DUE[:total]).row
    cut = Transport(settings, seed=4, topic="t")
    starts = np.cumsum([0, *cuts])
    rows = [cut.dispatch(DUE[a:b]).row + a for a, b in pairwise(starts)]
    np.testing.assert_array_equal(np.concatenate(rows), whole)


def test_topics_fail_independently():
    settings = TransportSettings(loss=0.5)
    first = Transport(settings, topic="a").dispatch(DUE).row
    second = Transport(settings, topic="b").dispatch(DUE).row
    both = np.intersect1d(first, second).size / COUNT
    assert both == pytest.approx(0.25, abs=rate_error(0.25))
