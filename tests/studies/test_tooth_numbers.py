"""Wrong tooth numbers are noticed before they can lead to a wrong name, and right ones are never doubted."""

import pytest
from tests.studies.tooth_numbers import NEIGHBOURS, SHIFTS, judge_case, judge_joint

SEED, CASES, PARTS = 7, 20, 4


@pytest.mark.parametrize("part", range(PARTS))
def test_teeth_with_a_sensor(part):
    """Wrong teeth lead to no wrong name but where they are off by 2 over too little travel to separate the lines."""
    outcomes = [outcome for number in range(part, CASES, PARTS) for outcome in judge_case(number, SEED)]
    right = [outcome for outcome in outcomes if not outcome.shift]
    assert all(outcome.is_named and not outcome.is_wrong and not outcome.doubted for outcome in right)
    wrong = [outcome for outcome in outcomes if outcome.is_wrong]
    assert all(abs(outcome.shift) == 2 for outcome in wrong)
    assert len(wrong) <= 1
    doubted = sum(outcome.doubted for outcome in outcomes)
    assert doubted >= 0.9 * (len(outcomes) - len(right))
    assert len(outcomes) == len(SHIFTS) * CASES // PARTS


def test_neighbouring_teeth_without_a_sensor():
    outcomes = [outcome for number in range(CASES) for outcome in judge_joint(number, SEED)]
    right = [outcome for outcome in outcomes if not outcome.shift]
    assert not any(outcome.doubted or outcome.is_wrong for outcome in right)
    assert len(outcomes) == len(NEIGHBOURS) * CASES
