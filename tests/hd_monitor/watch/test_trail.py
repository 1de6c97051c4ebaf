"""The history of a joint stays bounded, and forgets no peak."""

import math

from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.watch.trail import CAPACITY, MARKS, Step, Trail


def trail_of(severities: list[float]) -> Trail:
    trail = Trail()
    for stamp, severity in enumerate(severities):
        trail = trail.then(Step(stamp, severity, "E" if severity > 1.0 else "."))
    return trail


def test_a_long_history_keeps_its_length_its_order_and_its_worst() -> None:
    severities = [0.1] * 5000
    severities[1234] = 3.0
    trail = trail_of(severities)
    assert CAPACITY // 2 < len(trail.steps) <= CAPACITY
    assert [step.stamp for step in trail.steps] == sorted({step.stamp for step in trail.steps})
    assert [step.severity for step in trail.steps if step.mark == "E"] == [3.0]
    (worst,) = [step for step in trail.steps if step.mark == "E"]
    assert worst.stamp <= 1234 < worst.stamp + trail.merged


@given(st.lists(st.sampled_from([0.1, 2.0]), min_size=1, max_size=1500), st.integers(1, 80))
def test_columns_fit_their_width_and_keep_the_worst(severities: list[float], width: int) -> None:
    columns = trail_of(severities).columns(width)
    assert 0 < len(columns) <= width
    assert max(step.severity for step in columns) == max(severities)
    assert columns[0].stamp == 0


def test_an_unknown_reading_hides_no_known_one() -> None:
    (step,) = Trail((Step(0, math.nan, "?"), Step(1, 0.5, "W"))).columns(1)
    assert step == Step(0, 0.5, "W")
    assert list(MARKS) == ["?", ".", "W", "E"]
